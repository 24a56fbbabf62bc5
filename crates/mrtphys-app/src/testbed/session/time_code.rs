//! The time code of the Animation panel.

/// Hours, minutes, seconds and frames, as the thesis's string function writes them (appendix B.3).
pub fn time_code(frame: u64, fps: u32) -> String {
    let fps = u64::from(fps.max(1));
    let seconds = frame / fps;
    let (h, m, s, f) = (seconds / 3600, seconds / 60 % 60, seconds % 60, frame % fps);
    format!("{h} h: {m} ': {s} \": {f} f")
}
