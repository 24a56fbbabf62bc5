//! Options of `render`.
// The texts are those of `--help`, where [s] is a unit.
#![allow(rustdoc::broken_intra_doc_links)]

use crate::choices::closest;
use crate::cli::{SimulationArgs, seconds};
use clap::Args;
use std::ffi::OsString;
use std::path::PathBuf;

/// Largest width and height of a picture \[pixels\]; the graphics driver may allow less.
const LARGEST: u32 = 16384;
/// The names of the modes, as [`mrtphys_view::Mode`] has them.
const MODES: [&str; 5] = ["wireframe", "hidden-line", "flat", "gouraud", "phong"];

/// The names of the lighting equations, as [`mrtphys_view::Illumination`] has them.
const ILLUMINATIONS: [&str; 4] = ["ambient", "lambert", "phong", "blinn"];
/// The names of the colorings, as [`mrtphys_view::Coloring`] has them, in one word.
const COLORINGS: [&str; 6] = ["own", "speed", "spin", "kinetic-energy", "kind", "contacts"];

/// Options of `render`.
#[derive(Args, Debug)]
// Without graphics they are read, so that the refusal is about what was asked for, and not used.
#[cfg_attr(not(feature = "view"), allow(dead_code))]
pub struct RenderArgs {
    /// A scene file, or the name of a gallery scene
    pub scene: OsString,
    /// Where it goes: .png for one picture, .gif or .mp4 for a film, a folder for one .png for each picture
    #[arg(short, long, value_name = "FILE")]
    pub output: PathBuf,
    /// Simulated time of the picture, or where the film begins [s]
    #[arg(long, value_name = "S", value_parser = seconds)]
    pub at: Option<f64>,
    /// The film shows so much simulated time [s] (default: to the end of the scene)
    #[arg(long, value_name = "S", value_parser = seconds, conflicts_with = "frames")]
    pub seconds: Option<f64>,
    /// The film has so many pictures
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u64).range(1..=1_000_000))]
    pub frames: Option<u64>,
    /// Pictures per second of the film (default: 25 for .gif, else 30). Does not change the simulation
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..=240))]
    pub fps: Option<u32>,
    /// Simulated seconds per second of the film: 0.1 is slow motion
    #[arg(long, value_name = "X", default_value = "1", value_parser = speed)]
    pub speed: f64,
    /// Width and height [pixels]
    #[arg(long, value_name = "WxH", default_value = "1280x720", value_parser = size)]
    pub size: (u32, u32),
    /// wireframe, hidden-line, flat, gouraud or phong
    #[arg(long, value_name = "NAME", default_value = "phong", value_parser = mode)]
    pub mode: &'static str,
    /// Triangulation of spheres, 0 (20 triangles) to 6 (81920); default: as fine as each one's size needs
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u8).range(0..=6))]
    pub quality: Option<u8>,
    /// The lighting equation: ambient (light from everywhere), lambert (and diffuse), phong or blinn (and highlights)
    #[arg(long, value_name = "NAME", default_value = "blinn", value_parser = illumination)]
    pub illumination: &'static str,
    /// What the colors of bodies show: own (those of the scene), speed, spin, kinetic-energy, kind or contacts. What they
    /// mean is said at the end
    #[arg(long, value_name = "NAME", default_value = "own", value_parser = coloring)]
    pub color_by: &'static str,
    /// Without the shadows of the first light
    #[arg(long)]
    pub no_shadows: bool,
    /// Without boundaries
    #[arg(long)]
    pub no_walls: bool,
    /// Without the marks on spheres, by which one sees them spin
    #[arg(long)]
    pub no_marks: bool,
    /// Dark background
    #[arg(long)]
    pub dark: bool,
    /// Look from the scene's direction, but from where everything just fits into the picture
    #[arg(long)]
    pub fit: bool,
    #[command(flatten)]
    pub simulation: SimulationArgs,
}

fn speed(text: &str) -> Result<f64, String> {
    match text.parse::<f64>() {
        Ok(x) if (1e-9..=1e9).contains(&x) => Ok(x),
        _ => Err("a number from 1e-9 to 1e9 is needed".into()),
    }
}

/// Reads a width and a height.
pub fn size(text: &str) -> Result<(u32, u32), String> {
    let (w, h) = text.split_once('x').ok_or("WIDTHxHEIGHT is needed, such as 1280x720")?;
    let number = |s: &str| match s.parse::<u32>() {
        Ok(n) if (1..=LARGEST).contains(&n) => Ok(n),
        _ => Err(format!("'{s}' is not a number of pixels from 1 to {LARGEST}")),
    };
    Ok((number(w)?, number(h)?))
}

fn mode(text: &str) -> Result<&'static str, String> {
    one_of(&MODES, text)
}

fn illumination(text: &str) -> Result<&'static str, String> {
    one_of(&ILLUMINATIONS, text)
}

fn coloring(text: &str) -> Result<&'static str, String> {
    one_of(&COLORINGS, text)
}

fn one_of(names: &'static [&'static str], text: &str) -> Result<&'static str, String> {
    if let Some(name) = names.iter().find(|n| **n == text) {
        return Ok(name);
    }
    let tip = closest(text, names.iter().copied()).map(|n| format!("; did you mean '{n}'?")).unwrap_or_default();
    Err(format!("there is {}{tip}", names.join(", ")))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sizes_are_read() {
        assert_eq!(size("640x480"), Ok((640, 480)));
        for wrong in ["640", "640x", "0x4", "x", "640X480", "-1x5", "99999x5", "1x2x3"] {
            assert!(size(wrong).is_err(), "{wrong}");
        }
    }

    #[test]
    fn names_are_those_of_the_renderer() {
        assert_eq!(mode("flat"), Ok("flat"));
        assert_eq!((illumination("lambert"), coloring("kinetic-energy")), (Ok("lambert"), Ok("kinetic-energy")));
        assert!(coloring("kinetic energy").unwrap_err().contains("did you mean 'kinetic-energy'?"));
        assert!(mode("hidden-lines").unwrap_err().contains("did you mean 'hidden-line'?"));
        #[cfg(feature = "view")]
        {
            assert_eq!(MODES, mrtphys_view::Mode::ALL.map(|m| m.1));
            assert_eq!(ILLUMINATIONS, mrtphys_view::Illumination::ALL.map(|i| i.1));
            assert_eq!(COLORINGS.map(|c| c.replace('-', " ")), mrtphys_view::Coloring::ALL.map(|c| c.1));
        }
    }
}
