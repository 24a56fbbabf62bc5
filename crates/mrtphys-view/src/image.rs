//! A picture in memory.

/// A picture: rows from top to bottom, four bytes a pixel (red, green, blue, 255), in the sRGB encoding.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Image {
    /// pixels in a row
    pub width: u32,
    /// rows
    pub height: u32,
    /// 4 x width x height bytes
    pub rgba: Vec<u8>,
}

impl Image {
    /// A picture of one color.
    pub fn filled(width: u32, height: u32, rgb: [u8; 3]) -> Image {
        let pixel = [rgb[0], rgb[1], rgb[2], 255];
        Image { width, height, rgba: pixel.repeat(width as usize * height as usize) }
    }

    /// A pixel; `None` outside.
    pub fn pixel(&self, x: u32, y: u32) -> Option<[u8; 3]> {
        let at = 4 * (y as usize * self.width as usize + x as usize);
        let p = (x < self.width).then(|| self.rgba.get(at..at + 3)).flatten()?;
        Some([p[0], p[1], p[2]])
    }
}
