//! The gallery: scenes that are built in.

macro_rules! scenes {
    ($($name:literal),+ $(,)?) => {
        &[$(($name, include_str!(concat!("../../../scenes/", $name, ".toml")))),+]
    };
}

const GALLERY: &[(&str, &str)] = scenes![
    "thesis/cube-2",
    "thesis/cube-3",
    "thesis/cube-4",
    "thesis/cube-5",
    "thesis/cube-6",
    "thesis/cube-7",
    "thesis/cube-8",
    "cradle",
    "break-shot",
    "bounce",
    "slide-to-roll",
    "superball",
    "tops",
    "u-shapes",
    "wind",
    "buoyancy",
    "planets",
    "two-gases",
    "gas-100k",
    "bench/gas-8",
    "bench/gas-16",
    "bench/gas-32",
];

/// The gallery's scenes: name (the path under `scenes/` without the ending) and text.
pub fn gallery() -> &'static [(&'static str, &'static str)] {
    GALLERY
}

/// The text of the gallery scene of this name.
pub fn gallery_scene(name: &str) -> Option<&'static str> {
    GALLERY.iter().find(|(n, _)| *n == name).map(|(_, text)| *text)
}
