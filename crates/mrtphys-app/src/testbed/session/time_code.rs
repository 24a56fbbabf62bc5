//! The time code of the Animation panel.

/// Hours, minutes, seconds and frames, as the thesis's string function writes them (appendix B.3).
pub fn time_code(frame: u64, fps: u32) -> String {
    let fps = u64::from(fps.max(1));
    let seconds = frame / fps;
    let (h, m, s, f) = (seconds / 3600, seconds / 60 % 60, seconds % 60, frame % fps);
    format!("{h} h: {m} ': {s} \": {f} f")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn as_the_thesis_writes_it() {
        let vectors = include_str!("../../../../mrtphys/tests/vectors/motion.json");
        let vectors: serde_json::Value = serde_json::from_str(vectors).unwrap();
        let rows = vectors["timecode"].as_array().unwrap();
        assert!(rows.len() >= 9);
        for row in rows {
            let n = |key: &str| row[key].as_u64().unwrap();
            let expected = format!("{} h: {} ': {} \": {} f", n("h"), n("m"), n("s"), n("f"));
            assert_eq!(time_code(n("frame"), n("fps") as u32), expected);
        }
        assert_eq!(time_code(5, 0), "0 h: 0 ': 5 \": 0 f", "no frame rate is no reason to stop");
        assert_eq!(time_code(u64::MAX, 1).len(), "5124095576030431 h: 0 ': 15 \": 0 f".len());
    }
}
