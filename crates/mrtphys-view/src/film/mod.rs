//! Where pictures go: a file each, or a film.

mod gif;
#[cfg(feature = "mp4")]
mod mp4;

pub use self::gif::Gif;
#[cfg(feature = "mp4")]
pub use mp4::Mp4;

use crate::error::ViewError;
use crate::image::Image;
use std::io::Write;
use std::path::PathBuf;

/// Pictures one after the other, all of the same size.
pub trait Film {
    /// Adds a picture.
    ///
    /// # Errors
    /// The picture has another size than the first, or cannot be encoded or written.
    fn put(&mut self, image: &Image) -> Result<(), ViewError>;

    /// Ends the film. Without this the file may be unreadable; with it, it is whole however many pictures there were, from
    /// one upwards.
    ///
    /// # Errors
    /// There was no picture, or what is left cannot be written.
    fn finish(&mut self) -> Result<(), ViewError>;
}

/// A picture as the bytes of a PNG file.
///
/// # Errors
/// The image is not one: its bytes do not match its size.
pub fn png_bytes(image: &Image) -> Result<Vec<u8>, ViewError> {
    let mut bytes = Vec::new();
    write_png(image, &mut bytes)?;
    Ok(bytes)
}

/// Writes a picture as PNG, without the opacity: it is the same everywhere.
///
/// # Errors
/// The image's bytes do not match its size, or it cannot be written.
pub fn write_png(image: &Image, to: impl Write) -> Result<(), ViewError> {
    let refused = |e: png::EncodingError| match e {
        png::EncodingError::IoError(e) => ViewError::Write(e),
        e => ViewError::Film(format!("the picture cannot be written as PNG: {e}")),
    };
    let rgb: Vec<u8> = image.rgba.chunks_exact(4).flat_map(|p| [p[0], p[1], p[2]]).collect();
    let mut encoder = png::Encoder::new(to, image.width, image.height);
    encoder.set_color(png::ColorType::Rgb);
    encoder.set_depth(png::BitDepth::Eight);
    encoder.set_source_srgb(png::SrgbRenderingIntent::Perceptual);
    encoder.set_compression(png::Compression::Balanced);
    let mut writer = encoder.write_header().map_err(refused)?;
    writer.write_image_data(&rgb).map_err(refused)?;
    writer.finish().map_err(refused)
}

/// A folder of pictures `frame_00000.png`, `frame_00001.png`, and so on.
pub struct Folder {
    path: PathBuf,
    count: u64,
}

impl Folder {
    /// In this folder, which is made if it is not there.
    ///
    /// # Errors
    /// The folder cannot be made.
    pub fn create(path: impl Into<PathBuf>) -> Result<Folder, ViewError> {
        let path = path.into();
        std::fs::create_dir_all(&path)?;
        Ok(Folder { path, count: 0 })
    }
}

impl Film for Folder {
    fn put(&mut self, image: &Image) -> Result<(), ViewError> {
        let bytes = png_bytes(image)?;
        std::fs::write(self.path.join(format!("frame_{:05}.png", self.count)), bytes)?;
        self.count += 1;
        Ok(())
    }

    fn finish(&mut self) -> Result<(), ViewError> {
        not_empty(self.count)
    }
}

fn not_empty(pictures: u64) -> Result<(), ViewError> {
    if pictures > 0 { Ok(()) } else { Err(ViewError::Film("a film without a picture".into())) }
}

/// That a picture has the size of the film and the bytes of that size.
fn check_size(image: &Image, width: u32, height: u32) -> Result<(), ViewError> {
    let whole = image.rgba.len() as u64 == 4 * u64::from(image.width) * u64::from(image.height);
    if (image.width, image.height) == (width, height) && whole {
        return Ok(());
    }
    let (w, h) = (image.width, image.height);
    Err(ViewError::Film(format!("a picture of {w} x {h} pixels does not belong into a film of {width} x {height}")))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A disk that moves to the right over a gradient.
    pub fn picture(number: u32, width: u32, height: u32) -> Image {
        let mut image = Image::filled(width, height, [0; 3]);
        for y in 0..height {
            for x in 0..width {
                let (dx, dy) = (f64::from(x) - 10.0 - 2.0 * f64::from(number), f64::from(y) - f64::from(height) / 2.0);
                let inside = dx * dx + dy * dy < 64.0;
                let shade = (200 + y * 40 / height) as u8;
                let color = if inside { [0, 114, 178] } else { [shade; 3] };
                let at = 4 * (y * width + x) as usize;
                image.rgba[at..at + 3].copy_from_slice(&color);
            }
        }
        image
    }

    #[test]
    fn a_png_reads_back_bit_for_bit() {
        let image = picture(3, 61, 33);
        let bytes = png_bytes(&image).unwrap();
        let mut reader = png::Decoder::new(std::io::Cursor::new(bytes)).read_info().unwrap();
        let mut rgb = vec![0; reader.output_buffer_size().unwrap()];
        let info = reader.next_frame(&mut rgb).unwrap();
        assert_eq!((info.width, info.height, info.color_type), (61, 33, png::ColorType::Rgb));
        let read: Vec<u8> = rgb.chunks_exact(3).flat_map(|p| [p[0], p[1], p[2], 255]).collect();
        assert_eq!(read, image.rgba);
    }

    #[test]
    fn an_image_that_is_none_is_refused() {
        let wrong = Image { width: 10, height: 10, rgba: vec![0; 7] };
        assert!(matches!(png_bytes(&wrong), Err(ViewError::Film(_))));
        assert!(check_size(&wrong, 10, 10).is_err());
    }

    #[test]
    fn a_folder_counts_its_pictures() {
        let path = std::env::temp_dir().join(format!("mrtphys-folder-{}", std::process::id()));
        let mut folder = Folder::create(&path).unwrap();
        assert!(folder.finish().is_err());
        (0..3).for_each(|i| folder.put(&picture(i, 20, 10)).unwrap());
        folder.finish().unwrap();
        let mut names: Vec<_> = std::fs::read_dir(&path).unwrap().map(|e| e.unwrap().file_name()).collect();
        names.sort();
        assert_eq!(names, ["frame_00000.png", "frame_00001.png", "frame_00002.png"]);
        std::fs::remove_dir_all(path).unwrap();
    }
}
