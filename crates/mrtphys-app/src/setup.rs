//! From the command line to a world that is ready to run.

use crate::cast::Cast;
use crate::choices::closest;
use crate::cli::{RunArgs, SimulationArgs};
use crate::exit::{Failure, Outcome};
use crate::plan::End;
use mrtphys::World;
use mrtphys_scene::{Scene, gallery};
use std::ffi::OsStr;
use std::path::Path;

/// A world ready to run, and what is known about it.
pub struct Ready {
    /// the scene as it was named
    pub scene: String,
    /// its title
    pub title: String,
    /// seed of its random draws
    pub seed: u64,
    /// the world, at the start of the scene or where a snapshot was taken
    pub world: World,
    /// who takes part
    pub cast: Cast,
    /// where the run ends
    pub end: End,
}

/// Reads a scene: a file, or by the name of a gallery scene. A file wins over the gallery.
pub fn load(name: &OsStr) -> Outcome<Scene> {
    let wrong = |e: mrtphys_scene::Diagnostics| Failure::Wrong(e.to_string());
    let path = Path::new(name);
    if path.exists() {
        return Scene::load(path).map_err(wrong);
    }
    let text = name.to_string_lossy();
    if let Some(entry) = gallery().iter().find(|entry| entry.0 == text) {
        return Scene::from_text(entry.0, entry.1).map_err(wrong);
    }
    let meant = closest_scene(&text);
    let tip = meant.map(|m| format!("; did you mean '{m}'?")).unwrap_or_default();
    Err(Failure::Wrong(format!(
        "'{text}': there is no such file, and no gallery scene of this name (see 'mrtphys scenes'){tip}"
    )))
}

/// The gallery scene that was probably meant, also where the folder was left out.
fn closest_scene(text: &str) -> Option<&'static str> {
    let last = |name: &'static str| name.rsplit('/').next().unwrap_or(name);
    let names = || gallery().iter().map(|entry| entry.0);
    let meant = closest(text, names().flat_map(|n| [n, last(n)]))?;
    names().find(|n| *n == meant || last(n) == meant)
}

/// Makes a scene's world.
pub fn build(scene: &Scene) -> Outcome<(World, Cast)> {
    let loaded = scene.build().map_err(|e| Failure::Wrong(e.to_string()))?;
    Ok((loaded.world, Cast::new(loaded.names)))
}

/// Reads the scene, applies the options, makes the world, and takes up a snapshot.
pub fn prepare(args: &RunArgs) -> Outcome<Ready> {
    let mut scene = load(&args.scene)?;
    apply(&args.simulation, args.fps, &mut scene);
    let (mut world, cast) = build(&scene)?;
    take_up(&args.simulation, &mut world)?;
    Ok(Ready {
        scene: args.scene.to_string_lossy().into_owned(),
        title: scene.title.clone(),
        seed: scene.seed,
        world,
        cast,
        end: args.end().unwrap_or(End::Seconds(scene.seconds)),
    })
}

/// Goes on from a snapshot, if an option says so.
pub fn take_up(args: &SimulationArgs, world: &mut World) -> Outcome {
    let Some(path) = &args.resume else { return Ok(()) };
    let wrong = |e: &dyn std::fmt::Display| Failure::Wrong(format!("--resume '{}': {e}", path.display()));
    let bytes = std::fs::read(path).map_err(|e| wrong(&e))?;
    world.restore(&bytes).map_err(|e| wrong(&e))
}

/// Options win over the scene.
pub fn apply(args: &SimulationArgs, fps: Option<u32>, scene: &mut Scene) {
    let s = &mut scene.settings;
    s.algorithm = args.algorithm.unwrap_or(s.algorithm);
    s.broad_phase = args.broad_phase.unwrap_or(s.broad_phase);
    s.impact = args.impact.unwrap_or(s.impact);
    s.friction_law = args.friction_law.unwrap_or(s.friction_law);
    s.fps = fps.unwrap_or(s.fps);
    s.steps_per_frame = args.steps_per_frame.unwrap_or(s.steps_per_frame);
    scene.seed = args.seed.unwrap_or(scene.seed);
}

#[cfg(test)]
mod tests {
    use super::closest_scene;

    #[test]
    fn a_gallery_scene_is_guessed_with_and_without_its_folder() {
        assert_eq!(closest_scene("thesis/cub-8"), Some("thesis/cube-8"));
        assert_eq!(closest_scene("cube-8"), Some("thesis/cube-8"));
        assert_eq!(closest_scene("cradel"), Some("cradle"));
        assert_eq!(closest_scene("xyz"), None);
    }
}
