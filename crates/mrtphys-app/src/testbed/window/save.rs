//! Saving and going on: scenes, snapshots, pictures and films, written beside the simulation.

use super::app::Testbed;
use super::desk::Desk;
use super::reel::Still;
use crate::output::Whole;
use crate::testbed::session::{Command, Shot};
use eframe::egui;
use mrtphys_view::{Frame, Look, Poses};
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::time::Instant;

/// Writes the present state as a scene, seen from where the viewer is.
pub fn scene(app: &mut Testbed, context: &egui::Context, path: PathBuf) {
    let ticket = app.jobs.begin("Saving the scene", false, context);
    let camera = app.desk.camera;
    let (eye, look_at, up, fov_deg) = (camera.eye, camera.look_at, camera.up, camera.fov_deg);
    app.preferences.touch(&path);
    app.desk.send(Command::Ask(Box::new(move |studio| {
        // Physics waits for the copy only.
        let mut loaded = studio.loaded.clone();
        loaded.scene.camera = Some(mrtphys_scene::scene::Camera { eye, look_at, up, fov_deg });
        std::thread::spawn(move || {
            let text = mrtphys_scene::to_toml(&loaded).map_err(|e| e.to_string());
            ticket.end(text.and_then(|text| write(&path, text.as_bytes())).map(Some));
        });
    })));
}

/// Writes the world.
pub fn snapshot(app: &mut Testbed, context: &egui::Context, path: PathBuf) {
    let ticket = app.jobs.begin("Saving a snapshot", false, context);
    app.desk.send(Command::Ask(Box::new(move |studio| {
        let bytes = studio.loaded.world.snapshot();
        std::thread::spawn(move || ticket.end(write(&path, &bytes).map(Some)));
    })));
}

/// Goes on from a snapshot of the same scene.
pub fn go_on(desk: &Desk, path: PathBuf) {
    let change = move |loaded: &mut mrtphys_scene::Loaded| {
        let wrong = |e: &dyn std::fmt::Display| format!("cannot go on from '{}': {e}", path.display());
        let bytes = std::fs::read(&path).map_err(|e| wrong(&e))?;
        loaded.world.restore(&bytes).map_err(|e| wrong(&e))
    };
    desk.send(Command::Edit { change: Box::new(change), structural: false });
}

fn write(path: &Path, bytes: &[u8]) -> Result<String, String> {
    let file = Whole::check(path).map_err(|e| e.to_string())?;
    file.write(|to| to.write_all(bytes)).map_err(|e| e.to_string())?;
    Ok(format!("{}: saved", path.display()))
}

/// Writes what is on the screen, at the size that was chosen.
pub fn picture(app: &mut Testbed, context: &egui::Context, path: PathBuf) {
    let desk = &app.desk;
    let Some(side) = desk.report().sides.first() else { return };
    let look = Look { smooth: Some(true), ..desk.look };
    let (mut frame, mut poses) = (Frame::new(desk.camera, look), Poses::default());
    poses.set_between(&side.before.poses, &side.shot.poses, desk.report().pace.part(Instant::now()));
    side.shot.stage.fill(desk.camera, look, &poses, &mut frame);
    let still = Still { frame, size: app.export.size(), path };
    let ticket = app.jobs.begin("Drawing the picture", false, context);
    std::thread::spawn(move || ticket.end(still.make().map(Some)));
}

/// Makes a film from the recording.
pub fn film(app: &mut Testbed, context: &egui::Context, path: PathBuf) {
    let take = app.export.take(&app.desk, path);
    let ticket = app.jobs.begin(format!("Film {}", take.path.display()), true, context);
    app.desk.send(Command::Ask(Box::new(move |studio| {
        let shots: Vec<Arc<Shot>> = around((studio.shots)(), take.from, take.to);
        std::thread::spawn(move || {
            let made = take.make(&shots, &ticket);
            ticket.end(made);
        });
    })));
}

/// The frames of a range of time, with one more at either end.
fn around(shots: Vec<Arc<Shot>>, from: f64, to: f64) -> Vec<Arc<Shot>> {
    let mut found: Vec<Arc<Shot>> = Vec::new();
    for shot in shots {
        if shot.time <= from {
            found.clear();
        }
        let last = shot.time >= to;
        found.push(shot);
        if last {
            break;
        }
    }
    found
}
