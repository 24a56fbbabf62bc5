//! `mrtphys scenes` and `mrtphys schema`.

use crate::exit::{Failure, Outcome};
use crate::output::say;
use mrtphys_scene::{Scene, gallery};
use std::fmt::Write;

/// The gallery, a line each: name and title.
pub fn scenes() -> Outcome {
    let entries = gallery();
    let width = entries.iter().map(|entry| entry.0.len()).max().unwrap_or(0);
    let mut text = String::new();
    for entry in entries {
        let scene = Scene::from_text(entry.0, entry.1).map_err(|e| Failure::Wrong(e.to_string()))?;
        // Writing to a string cannot fail.
        let _ = writeln!(text, "{:width$}  {}", entry.0, scene.title);
    }
    say(&text)
}

/// The JSON schema of the scene format.
pub fn schema() -> Outcome {
    say(&format!("{:#}\n", mrtphys_scene::schema()))
}
