//! Colors: the default ones of bodies, and those of the light and the dark theme.

/// Red, green, blue in the sRGB encoding.
pub type Rgb = [u8; 3];

/// Colors that people with any kind of color vision tell apart, and a black-and-white printer by their lightness: Okabe and
/// Ito, "Color Universal Design" (2008), without black.
pub const DISTINCT: [Rgb; 7] = [
    [0x00, 0x72, 0xb2], // blue
    [0xe6, 0x9f, 0x00], // orange
    [0x00, 0x9e, 0x73], // bluish green
    [0xd5, 0x5e, 0x00], // vermilion
    [0x56, 0xb4, 0xe9], // sky blue
    [0xcc, 0x79, 0xa7], // reddish purple
    [0xf0, 0xe4, 0x42], // yellow
];

/// What cannot move.
pub const FIXED: Rgb = [0x80, 0x86, 0x8f];

/// The kinds of shape in the order of [`DISTINCT`].
const KINDS: [&str; 4] = ["sphere", "tetrahedron", "polyhedron", "quadrangle"];

/// The color of a body whose scene says none: by the kind of its shape; kinds of others by the letters of their name.
pub fn default_color(kind: &str, fixed: bool) -> Rgb {
    if fixed {
        return FIXED;
    }
    let others = DISTINCT.len() - KINDS.len();
    let by_letters = || KINDS.len() + kind.bytes().fold(0usize, |n, b| (n * 31 + usize::from(b)) % others);
    DISTINCT[KINDS.iter().position(|k| *k == kind).unwrap_or_else(by_letters)]
}

/// A color a little lighter or darker, so that equal bodies that overlap in the picture are told apart. The number of the
/// body decides: the golden ratio spreads any range of numbers evenly.
pub fn varied(rgb: Rgb, number: usize) -> Rgb {
    let spread = (number as u32).wrapping_mul(0x9e37_79b9) >> 8;
    let factor = 0.84 + 0.32 * (f64::from(spread) / f64::from(1 << 24));
    rgb.map(|c| (f64::from(c) * factor).round().min(255.0) as u8)
}

/// Samples of the color map "viridis" (van der Walt and Smith, "A Better Default Colormap for Matplotlib", SciPy 2015; CC0) at
/// even distances. Equal steps look equal, its lightness rises from end to end, and people with any kind of color vision see it
/// nearly alike.
const VIRIDIS: [Rgb; 11] = [
    [0x44, 0x01, 0x54],
    [0x48, 0x25, 0x76],
    [0x41, 0x44, 0x87],
    [0x35, 0x60, 0x8d],
    [0x2a, 0x78, 0x8e],
    [0x21, 0x90, 0x8c],
    [0x22, 0xa8, 0x84],
    [0x43, 0xbf, 0x71],
    [0x7a, 0xd1, 0x51],
    [0xbb, 0xdf, 0x27],
    [0xfd, 0xe7, 0x25],
];

/// The color of a number from 0 to 1, by the map "viridis": 0 is dark violet, 1 bright yellow. Numbers outside look as the end
/// that they are beyond; one that is none as 0.
pub fn ramp(x: f64) -> Rgb {
    let at = x.clamp(0.0, 1.0) * (VIRIDIS.len() - 1) as f64;
    // A NaN becomes 0.
    let i = (at as usize).min(VIRIDIS.len() - 2);
    let part = if at.is_nan() { 0.0 } else { at - i as f64 };
    std::array::from_fn(|k| {
        let (a, b) = (f64::from(VIRIDIS[i][k]), f64::from(VIRIDIS[i + 1][k]));
        (a + (b - a) * part).round() as u8
    })
}

/// From the sRGB encoding to light.
pub fn to_linear(c: u8) -> f32 {
    let c = f32::from(c) / 255.0;
    if c <= 0.04045 { c / 12.92 } else { ((c + 0.055) / 1.055).powf(2.4) }
}

/// A color as light.
pub fn linear(rgb: Rgb) -> [f32; 3] {
    rgb.map(to_linear)
}

/// Light or dark.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Theme {
    /// for paper and bright rooms
    #[default]
    Light,
    /// for dark rooms
    Dark,
}

/// The colors of a theme.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Colors {
    /// upper edge of the background
    pub sky: Rgb,
    /// lower edge
    pub base: Rgb,
    /// faces of boundaries
    pub wall: Rgb,
    /// edges of boundaries
    pub wall_edge: Rgb,
    /// lines of wireframe drawings are mixed towards this
    pub ink: Rgb,
    /// faces of hidden-line drawings
    pub paper: Rgb,
    /// outline of what is chosen
    pub accent: Rgb,
}

impl Theme {
    /// The color of a number from 0 to 1 as [`ramp`] gives it, without the end that is close to the background.
    pub fn ramp(self, x: f64) -> Rgb {
        let x = x.clamp(0.0, 1.0);
        match self {
            Theme::Light => ramp(0.95 * x),
            Theme::Dark => ramp(0.3 + 0.7 * x),
        }
    }

    /// Its colors.
    pub fn colors(self) -> Colors {
        match self {
            Theme::Light => Colors {
                sky: [0xfb, 0xfc, 0xfd],
                base: [0xdf, 0xe4, 0xea],
                wall: [0xf6, 0xf8, 0xfa],
                wall_edge: [0x8d, 0x98, 0xa5],
                ink: [0x10, 0x16, 0x20],
                paper: [0xf7, 0xf9, 0xfb],
                accent: [0xe0, 0x00, 0x5a],
            },
            Theme::Dark => Colors {
                sky: [0x14, 0x17, 0x1c],
                base: [0x2a, 0x30, 0x39],
                wall: [0x3c, 0x44, 0x50],
                wall_edge: [0x7a, 0x87, 0x98],
                ink: [0xff, 0xff, 0xff],
                paper: [0x1c, 0x20, 0x27],
                accent: [0xff, 0xd2, 0x3c],
            },
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_kind_has_its_own_color() {
        let mut seen: Vec<Rgb> = KINDS.iter().map(|k| default_color(k, false)).collect();
        seen.push(default_color("capsule", false));
        seen.push(default_color("sphere", true));
        assert_eq!(default_color("capsule", false), default_color("capsule", false));
        seen.sort_unstable();
        seen.dedup();
        assert_eq!(seen.len(), KINDS.len() + 2);
    }

    #[test]
    fn neighbours_differ_and_nothing_overflows() {
        for n in [0, 1, 41, 103_822, usize::MAX] {
            assert_ne!(varied([200, 100, 50], n), varied([200, 100, 50], n.wrapping_add(1)));
            assert!(varied([255; 3], n)[0] >= 0xd0);
        }
    }

    #[test]
    fn the_encoding_is_srgb() {
        assert_eq!((to_linear(0), to_linear(255)), (0.0, 1.0));
        assert!((to_linear(188) - 0.5029).abs() < 1e-3);
        assert!((to_linear(10) - 0.003_035).abs() < 1e-5);
    }

    /// Lightness L* of CIELAB.
    fn lightness(rgb: Rgb) -> f32 {
        let [r, g, b] = linear(rgb);
        116.0 * (0.2126 * r + 0.7152 * g + 0.0722 * b).cbrt() - 16.0
    }

    #[test]
    fn the_ramp_grows_lighter_evenly_from_end_to_end() {
        let all: Vec<f32> = (0..=100).map(|i| lightness(ramp(f64::from(i) / 100.0))).collect();
        assert!(all.windows(2).all(|w| (0.2..1.5).contains(&(w[1] - w[0]))), "{all:?}");
        assert!(all[0] < 18.0 && all[100] > 88.0);
        assert_eq!((ramp(-3.0), ramp(f64::NAN), ramp(7.0)), (ramp(0.0), ramp(0.0), ramp(1.0)));
        assert_eq!(ramp(0.5), VIRIDIS[5]);
    }

    #[test]
    fn ink_stands_out_from_paper_in_both_themes() {
        for theme in [Theme::Light, Theme::Dark] {
            let c = theme.colors();
            assert!((f32::from(c.ink[1]) - f32::from(c.paper[1])).abs() > 150.0);
        }
    }
}
