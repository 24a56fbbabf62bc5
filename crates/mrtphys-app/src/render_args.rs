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
    if let Some(name) = MODES.iter().find(|m| **m == text) {
        return Ok(name);
    }
    let tip = closest(text, MODES.into_iter()).map(|m| format!("; did you mean '{m}'?")).unwrap_or_default();
    Err(format!("there is {}{tip}", MODES.join(", ")))
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
    fn modes_are_those_of_the_renderer() {
        assert_eq!(mode("flat"), Ok("flat"));
        assert!(mode("hidden-lines").unwrap_err().contains("did you mean 'hidden-line'?"));
        #[cfg(feature = "view")]
        assert_eq!(MODES, mrtphys_view::Mode::ALL.map(|m| m.1));
    }
}
