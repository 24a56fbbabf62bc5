//! Films as H.264 in an MP4 file, which browsers, phones and presentation programs play. OpenH264 encodes, muxide packs.

use super::{Film, check_size, not_empty};
use crate::error::ViewError;
use crate::image::Image;
use muxide::api::{Muxer, MuxerBuilder, VideoCodec};
use openh264::OpenH264API;
use openh264::encoder::{
    BitRate, Encoder, EncoderConfig, FrameRate, FrameType, IntraFramePeriod, QpRange, RateControlMode, SpsPpsStrategy,
    UsageType, VuiConfig,
};
use openh264::formats::YUVBuffer;
use std::io::Write;

/// A whole picture this often \[s\]: one can jump there in a player, and nothing wrong stays for longer.
const WHOLE_EVERY: f64 = 1.0;
/// Bits a pixel by which the encoder chooses the level that it tells players; the quantizer decides how many there are.
const BITS_PER_PIXEL: f64 = 0.3;
/// Quantizer of H.264, 0 to 51: each 6 halve the precision. Here what has moved leaves less than one pixel in 100 000 wrong by
/// more than a twentieth of the range (two-gases at 640 x 360; one in 10 000 at the library's own 26).
const QUANTIZER: u8 = 20;

/// A film as MP4.
pub struct Mp4<W: Write> {
    encoder: Encoder,
    muxer: Muxer<W>,
    width: u32,
    height: u32,
    fps: f64,
    count: u64,
    whole_every: u64,
    yuv: Yuv,
    encoded: Vec<u8>,
}

impl<W: Write> Mp4<W> {
    /// Of this size, `fps` pictures a second.
    ///
    /// # Errors
    /// The width or the height is odd (colors are stored for two by two pixels), or the encoder refuses the size or rate.
    pub fn new(to: W, width: u32, height: u32, fps: f64) -> Result<Mp4<W>, ViewError> {
        if width == 0 || height == 0 || !width.is_multiple_of(2) || !height.is_multiple_of(2) {
            let text = format!("an MP4 needs an even width and an even height, not {width} x {height}");
            return Err(ViewError::Film(text));
        }
        if !(fps > 0.0 && fps <= 240.0) {
            return Err(ViewError::Film(format!("an MP4 shows at most 240 pictures a second, not {fps}")));
        }
        let bits = f64::from(width) * f64::from(height) * fps * BITS_PER_PIXEL;
        let whole_every = (fps * WHOLE_EVERY).round().max(1.0) as u64;
        let config = EncoderConfig::new()
            .usage_type(UsageType::CameraVideoRealTime)
            // The same quantizer for every picture: the mode that is named after a buffer does without the rate, and is held by
            // its range. Off, it would be the library's 26, which leaves specks about what moves.
            .rate_control_mode(RateControlMode::Bufferbased)
            .qp(QpRange::new(QUANTIZER, QUANTIZER))
            .skip_frames(false)
            .bitrate(BitRate::from_bps(bits.min(2e8) as u32))
            .max_frame_rate(FrameRate::from_hz(fps as f32))
            .sps_pps_strategy(SpsPpsStrategy::ConstantId)
            .intra_frame_period(IntraFramePeriod::from_num_frames(whole_every as u32))
            .scene_change_detect(false)
            // It takes a speck that a small body left for background, and keeps it.
            .background_detection(false)
            // One thread: the same film on every machine.
            .num_threads(1)
            .vui(VuiConfig::bt709());
        let encoder = Encoder::with_api_config(OpenH264API::from_source(), config).map_err(|e| refused(&e))?;
        let muxer = MuxerBuilder::new(to)
            .video(VideoCodec::H264, width, height, fps)
            .with_fast_start(true)
            .build()
            .map_err(|e| refused(&e))?;
        let yuv = Yuv::new(width as usize, height as usize);
        Ok(Mp4 { encoder, muxer, width, height, fps, count: 0, whole_every, yuv, encoded: Vec::new() })
    }
}

fn refused(e: &dyn std::fmt::Display) -> ViewError {
    ViewError::Film(format!("the film cannot be written as MP4: {e}"))
}

impl<W: Write> Film for Mp4<W> {
    fn put(&mut self, image: &Image) -> Result<(), ViewError> {
        check_size(image, self.width, self.height)?;
        self.yuv.set(image);
        if self.count.is_multiple_of(self.whole_every) {
            self.encoder.force_intra_frame();
        }
        let stream = self.encoder.encode(&self.yuv.buffer()).map_err(|e| refused(&e))?;
        let whole = matches!(stream.frame_type(), FrameType::IDR | FrameType::I);
        self.encoded.clear();
        stream.write_vec(&mut self.encoded);
        if self.encoded.is_empty() {
            return Err(refused(&"the encoder left a picture out"));
        }
        let time = self.count as f64 / self.fps;
        self.muxer.write_video(time, &self.encoded, whole).map_err(|e| refused(&e))?;
        self.count += 1;
        Ok(())
    }

    fn finish(&mut self) -> Result<(), ViewError> {
        not_empty(self.count)?;
        self.muxer.finish_in_place().map_err(|e| refused(&e))
    }
}

/// A picture as brightness and, for two by two pixels, two color differences.
struct Yuv {
    width: usize,
    height: usize,
    planes: Vec<u8>,
}

impl Yuv {
    fn new(width: usize, height: usize) -> Yuv {
        Yuv { width, height, planes: vec![0; width * height * 3 / 2] }
    }

    /// ITU-R BT.709, the matrix that players assume for films of this kind, in the limited range (16 to 235 and 240).
    fn set(&mut self, image: &Image) {
        let (w, h) = (self.width, self.height);
        let (y_plane, colors) = self.planes.split_at_mut(w * h);
        let (u_plane, v_plane) = colors.split_at_mut(w * h / 4);
        let luma = |p: &[u8]| 0.2126 * f32::from(p[0]) + 0.7152 * f32::from(p[1]) + 0.0722 * f32::from(p[2]);
        for (y, p) in y_plane.iter_mut().zip(image.rgba.chunks_exact(4)) {
            *y = (16.5 + luma(p) * (219.0 / 255.0)) as u8;
        }
        for (i, (u, v)) in u_plane.iter_mut().zip(v_plane).enumerate() {
            let (x, y) = (i % (w / 2) * 2, i / (w / 2) * 2);
            let mut mean = [0.0f32; 3];
            for at in [y * w + x, y * w + x + 1, (y + 1) * w + x, (y + 1) * w + x + 1] {
                (0..3).for_each(|k| mean[k] += 0.25 * f32::from(image.rgba[4 * at + k]));
            }
            let bright = 0.2126 * mean[0] + 0.7152 * mean[1] + 0.0722 * mean[2];
            *u = (128.5 + (mean[2] - bright) / 1.8556 * (224.0 / 255.0)) as u8;
            *v = (128.5 + (mean[0] - bright) / 1.5748 * (224.0 / 255.0)) as u8;
        }
    }

    fn buffer(&self) -> YUVBuffer {
        YUVBuffer::from_vec(self.planes.clone(), self.width, self.height)
    }
}

#[cfg(test)]
mod tests {
    use super::super::tests::picture;
    use super::*;
    use std::process::Command;

    #[test]
    fn gray_stays_gray_and_the_range_is_limited() {
        let mut yuv = Yuv::new(2, 2);
        for (rgb, right) in [([0; 3], [16, 128, 128]), ([255; 3], [235, 128, 128]), ([255, 0, 0], [63, 102, 240])] {
            yuv.set(&Image::filled(2, 2, rgb));
            assert_eq!([yuv.planes[0], yuv.planes[4], yuv.planes[5]], right, "{rgb:?}");
        }
    }

    #[test]
    fn a_film_is_an_mp4_that_a_player_reads() {
        let path = std::env::temp_dir().join(format!("mrtphys-film-{}.mp4", std::process::id()));
        let mut film = Mp4::new(std::fs::File::create(&path).unwrap(), 160, 90, 30.0).unwrap();
        (0..70).for_each(|i| film.put(&picture(i, 160, 90)).unwrap());
        film.finish().unwrap();
        let bytes = std::fs::read(&path).unwrap();
        assert_eq!(&bytes[4..8], b"ftyp");
        for part in [&b"moov"[..], b"mdat", b"avcC"] {
            assert!(bytes.windows(4).any(|w| w == part));
        }
        let entries = "stream=codec_name,width,height,nb_read_frames,r_frame_rate,duration";
        let line = ["-v", "error", "-count_frames", "-show_entries", entries, "-of", "default=nw=1"];
        match Command::new("ffprobe").args(line).arg(&path).output() {
            Err(_) => eprintln!("SKIPPED: ffprobe is not installed, the film was not played"),
            Ok(said) => {
                let text = String::from_utf8_lossy(&said.stdout).into_owned();
                assert!(said.stderr.is_empty(), "{}", String::from_utf8_lossy(&said.stderr));
                for part in ["codec_name=h264", "width=160", "height=90", "nb_read_frames=70", "r_frame_rate=30/1"] {
                    assert!(text.contains(part), "{part}: {text}");
                }
                let duration = text.lines().find_map(|l| l.strip_prefix("duration="));
                let duration: f64 = duration.and_then(|d| d.parse().ok()).unwrap();
                assert!((duration - 70.0 / 30.0).abs() < 0.02, "{duration}");
            }
        }
        std::fs::remove_file(path).unwrap();
    }

    /// Small balls on their way over a bright ground, fast and slow ones; and where they are.
    fn passing(i: u32, width: u32, height: u32) -> (Image, Vec<(f64, f64)>) {
        let bounce = |x: f64, size: f64| size - 12.0 - ((x % (2.0 * size - 40.0)) - (size - 20.0)).abs();
        let place = |n: u32| {
            let (t, n) = (f64::from(i), f64::from(n));
            (bounce(31.0 * n + (0.2 + 0.45 * n) * t, width.into()), bounce(17.0 * n + 0.3 * n * t, height.into()))
        };
        let places: Vec<(f64, f64)> = (0..8).map(place).collect();
        let mut image = Image::filled(width, height, [0; 3]);
        for (k, p) in image.rgba.chunks_exact_mut(4).enumerate() {
            let at = (f64::from(k as u32 % width), f64::from(k as u32 / width));
            let cover = places.iter().map(|b| (4.0 - distance(at, *b)).clamp(0.0, 1.0)).fold(0.0, f64::max);
            let ground = 232.0 + 14.0 * at.1 / f64::from(height);
            let mix = |dark: f64| (ground + (dark - ground) * cover).round() as u8;
            p.copy_from_slice(&[mix(20.0), mix(60.0), mix(120.0), 255]);
        }
        (image, places)
    }

    fn distance(a: (f64, f64), b: (f64, f64)) -> f64 {
        (a.0 - b.0).hypot(a.1 - b.1)
    }

    #[test]
    fn what_moves_leaves_no_specks() {
        let (w, h) = (320u32, 180u32);
        let path = std::env::temp_dir().join(format!("mrtphys-specks-{}.mp4", std::process::id()));
        let mut film = Mp4::new(std::fs::File::create(&path).unwrap(), w, h, 30.0).unwrap();
        (0..60).for_each(|i| film.put(&passing(i, w, h).0).unwrap());
        film.finish().unwrap();
        let options = ["-f", "rawvideo", "-pix_fmt", "rgb24", "-"];
        let played = Command::new("ffmpeg").args(["-v", "error", "-i"]).arg(&path).args(options).output();
        std::fs::remove_file(&path).unwrap();
        let Ok(played) = played else {
            return eprintln!("SKIPPED: ffmpeg is not installed, the film was not played");
        };
        let size = (3 * w * h) as usize;
        assert_eq!(played.stdout.len(), 60 * size, "{}", String::from_utf8_lossy(&played.stderr));
        let bright = |p: &[u8]| 0.2126 * f64::from(p[0]) + 0.7152 * f64::from(p[1]) + 0.0722 * f64::from(p[2]);
        let (mut worst, mut squares): (f64, f64) = (0.0, 0.0);
        for (i, shown) in played.stdout.chunks_exact(size).enumerate() {
            let (right, balls) = passing(i as u32, w, h);
            for (k, (p, q)) in shown.chunks_exact(3).zip(right.rgba.chunks_exact(4)).enumerate() {
                let wrong = (bright(p) - bright(q)).abs();
                squares += wrong * wrong;
                let at = (f64::from(k as u32 % w), f64::from(k as u32 / w));
                if balls.iter().all(|b| distance(at, *b) > 10.0) {
                    worst = worst.max(wrong);
                }
            }
        }
        let psnr = 10.0 * (255.0 * 255.0 * 60.0 * f64::from(w * h) / squares).log10();
        assert!(worst < 16.0, "a speck {worst} off, {psnr} dB");
        assert!(psnr > 43.0, "{psnr} dB");
    }

    #[test]
    fn what_an_mp4_cannot_be_is_refused() {
        for (w, h, fps) in [(161, 90, 30.0), (160, 91, 30.0), (0, 0, 30.0), (160, 90, 0.0), (160, 90, 1e9)] {
            assert!(Mp4::new(Vec::new(), w, h, fps).is_err(), "{w} {h} {fps}");
        }
        assert!(Mp4::new(Vec::new(), 160, 90, 30.0).unwrap().finish().is_err());
        assert!(Mp4::new(Vec::new(), 160, 90, 30.0).unwrap().put(&picture(0, 80, 40)).is_err());
    }
}
