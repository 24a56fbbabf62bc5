//! Animated GIF. Every picture has a palette of its own for what has changed since the last one; what has not stays as it is,
//! so that nothing flickers at rest.

use super::{Film, check_size, not_empty};
use crate::error::ViewError;
use crate::image::Image;
use gif::{DisposalMethod, Encoder, EncodingError, Frame, Repeat};
use std::io::Write;

/// Most pictures a second: viewers take a delay below two hundredths for a mistake and show it five times slower.
pub const FASTEST: f64 = 50.0;
/// NeuQuant's sampling: 1 looks at every pixel, 30 at every thirtieth.
const SAMPLING: i32 = 10;
/// A pixel that differs by no more than this in each color is taken as unchanged: a step of the palette is larger.
const SAME: u8 = 1;

/// A film as an animated GIF that starts again at its end.
pub struct Gif<W: Write> {
    encoder: Encoder<W>,
    fps: f64,
    width: u16,
    height: u16,
    count: u64,
    /// the pictures so far, as they were given where they last changed
    shown: Vec<u8>,
    changed: Vec<u8>,
}

impl<W: Write> Gif<W> {
    /// Of this size, `fps` pictures a second. Delays are whole hundredths of a second that make up for each other: the film
    /// is as long as it should be.
    ///
    /// # Errors
    /// More than 50 pictures a second, a size above 65535, or the beginning cannot be written.
    pub fn new(to: W, width: u32, height: u32, fps: f64) -> Result<Gif<W>, ViewError> {
        if !(fps > 0.0 && fps <= FASTEST) {
            return Err(ViewError::Film(format!("a GIF shows at most {FASTEST} pictures a second, not {fps}")));
        }
        let too_large = |_| ViewError::Film(format!("{width} x {height} pixels are too large for a GIF"));
        let (width, height) = (u16::try_from(width).map_err(too_large)?, u16::try_from(height).map_err(too_large)?);
        let mut encoder = Encoder::new(to, width, height, &[]).map_err(refused)?;
        encoder.set_repeat(Repeat::Infinite).map_err(refused)?;
        Ok(Gif { encoder, fps, width, height, count: 0, shown: Vec::new(), changed: Vec::new() })
    }

    /// Hundredths of a second from the start to this picture.
    fn time(&self, picture: u64) -> u64 {
        (picture as f64 * 100.0 / self.fps).round() as u64
    }

    /// Makes unchanged pixels transparent, and returns the rectangle of the changed ones: left, top, width, height.
    fn compare(&mut self, image: &Image) -> (usize, usize, usize, usize) {
        let (w, h) = (usize::from(self.width), usize::from(self.height));
        self.changed.clear();
        self.changed.extend_from_slice(&image.rgba);
        if self.shown.is_empty() {
            self.shown.extend_from_slice(&image.rgba);
            return (0, 0, w, h);
        }
        let (mut left, mut top, mut right, mut bottom) = (w, h, 0, 0);
        let pixels = self.changed.chunks_exact_mut(4).zip(self.shown.chunks_exact_mut(4));
        for (i, (new, shown)) in pixels.enumerate() {
            if new.iter().zip(&*shown).all(|(a, b)| a.abs_diff(*b) <= SAME) {
                new.fill(0);
                continue;
            }
            shown.copy_from_slice(new);
            let (x, y) = (i % w, i / w);
            (left, top) = (left.min(x), top.min(y));
            (right, bottom) = (right.max(x + 1), bottom.max(y + 1));
        }
        // A picture without a change still takes its time: one transparent pixel.
        if right == 0 { (0, 0, 1, 1) } else { (left, top, right - left, bottom - top) }
    }
}

impl<W: Write> Film for Gif<W> {
    fn put(&mut self, image: &Image) -> Result<(), ViewError> {
        check_size(image, self.width.into(), self.height.into())?;
        let (left, top, width, height) = self.compare(image);
        let row = 4 * usize::from(self.width);
        let rows = self.changed.chunks_exact(row).skip(top).take(height);
        let mut pixels: Vec<u8> = rows.flat_map(|r| &r[4 * left..4 * (left + width)]).copied().collect();
        let mut frame = Frame::from_rgba_speed(width as u16, height as u16, &mut pixels, SAMPLING);
        (frame.left, frame.top) = (left as u16, top as u16);
        frame.dispose = DisposalMethod::Keep;
        frame.delay = (self.time(self.count + 1) - self.time(self.count)).min(u16::MAX.into()) as u16;
        self.encoder.write_frame(&frame).map_err(refused)?;
        self.count += 1;
        Ok(())
    }

    fn finish(&mut self) -> Result<(), ViewError> {
        not_empty(self.count)?;
        self.encoder.get_mut().write_all(&[TRAILER])?;
        Ok(self.encoder.get_mut().flush()?)
    }
}

/// The byte that ends a GIF. The encoder writes it when it is dropped, but could not say that it failed; twice does no harm.
const TRAILER: u8 = 0x3b;

fn refused(e: EncodingError) -> ViewError {
    match e {
        EncodingError::Io(e) => ViewError::Write(e),
        e => ViewError::Film(format!("the picture cannot be written as GIF: {e}")),
    }
}

#[cfg(test)]
mod tests {
    use super::super::tests::picture;
    use super::*;

    fn film(count: u32, fps: f64) -> Vec<u8> {
        let mut bytes = Vec::new();
        let mut film = Gif::new(&mut bytes, 80, 40, fps).unwrap();
        (0..count).for_each(|i| film.put(&picture(i, 80, 40)).unwrap());
        film.finish().unwrap();
        drop(film);
        bytes
    }

    /// Delays, and the last picture as a viewer shows it.
    fn play(bytes: &[u8]) -> (Vec<u16>, Vec<u8>) {
        let mut options = gif::DecodeOptions::new();
        options.set_color_output(gif::ColorOutput::RGBA);
        let mut decoder = options.read_info(bytes).unwrap();
        let (w, mut delays, mut screen) = (80, Vec::new(), vec![0; 4 * 80 * 40]);
        while let Some(f) = decoder.read_next_frame().unwrap() {
            delays.push(f.delay);
            for (i, p) in f.buffer.chunks_exact(4).enumerate().filter(|(_, p)| p[3] > 0) {
                let (x, y) = (i % usize::from(f.width), i / usize::from(f.width));
                let at = 4 * ((y + usize::from(f.top)) * w + x + usize::from(f.left));
                screen[at..at + 4].copy_from_slice(p);
            }
        }
        (delays, screen)
    }

    #[test]
    fn the_last_picture_is_right_although_only_changes_are_written() {
        let (delays, screen) = play(&film(12, 25.0));
        assert_eq!(delays, [4; 12]);
        let right = picture(11, 80, 40);
        let worst = screen.iter().zip(&right.rgba).map(|(a, b)| a.abs_diff(*b)).max();
        assert!(worst <= Some(8), "{worst:?}");
    }

    #[test]
    fn delays_make_up_for_each_other() {
        let (delays, _) = play(&film(31, 30.0));
        assert!(delays.iter().all(|d| (3..=4).contains(d)));
        assert_eq!(delays.iter().take(30).sum::<u16>(), 100);
    }

    #[test]
    fn a_picture_without_change_costs_next_to_nothing() {
        let mut bytes = Vec::new();
        let mut film = Gif::new(&mut bytes, 80, 40, 10.0).unwrap();
        (0..50).for_each(|_| film.put(&picture(0, 80, 40)).unwrap());
        film.finish().unwrap();
        drop(film);
        assert_eq!(play(&bytes).0.len(), 50);
        assert!(bytes.len() < 5000, "{}", bytes.len());
    }

    #[test]
    fn what_a_gif_cannot_be_is_refused() {
        assert!(Gif::new(Vec::new(), 80, 40, 60.0).is_err());
        assert!(Gif::new(Vec::new(), 80_000, 40, 10.0).is_err());
        assert!(Gif::new(Vec::new(), 80, 40, 10.0).unwrap().finish().is_err());
        assert!(Gif::new(Vec::new(), 80, 40, 10.0).unwrap().put(&picture(0, 81, 40)).is_err());
    }
}
