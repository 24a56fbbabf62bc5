//! Saving and going on: scenes, snapshots, pictures and films, written beside the simulation.

use super::app::Testbed;
use super::desk::Desk;
use super::reel::Still;
use crate::output::Whole;
use crate::testbed::session::Command;
use eframe::egui;
use std::path::{Path, PathBuf};

/// Writes the present state as a scene, seen from where the viewer is.
pub fn scene(app: &mut Testbed, context: &egui::Context, path: PathBuf) {
    let ticket = app.jobs.begin("Saving the scene", false, context);
    let camera = app.desk.camera;
    let (eye, look_at, up, fov_deg) = (camera.eye, camera.look_at, camera.up, camera.fov_deg);
    let saved = app.desk.when_saved();
    app.preferences.touch(&path);
    app.desk.send(Command::Ask(Box::new(move |studio| {
        // Physics waits for the copy only.
        let mut loaded = studio.loaded.clone();
        loaded.scene.camera = Some(mrtphys_scene::scene::Camera { eye, look_at, up, fov_deg });
        std::thread::spawn(move || {
            let text = mrtphys_scene::to_toml(&loaded).map_err(|e| e.to_string());
            let written = text.and_then(|text| write(&path, text.as_bytes()));
            if written.is_ok() {
                saved();
            }
            ticket.end(written.map(Some));
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
    let size = app.export.size();
    let still = Still { panes: app.viewport.copy(&app.desk, size), size, theme: app.desk.look.theme, path };
    let ticket = app.jobs.begin("Drawing the picture", false, context);
    std::thread::spawn(move || ticket.end(still.make().map(Some)));
}

/// Makes a film from the recording.
pub fn film(app: &mut Testbed, context: &egui::Context, path: PathBuf) {
    let take = app.export.take(&app.desk, app.viewport.followed(), path);
    let ticket = app.jobs.begin(format!("Film {}", take.path.display()), true, context);
    app.desk.send(Command::Ask(Box::new(move |studio| {
        let frames = take.needed((studio.frames)());
        std::thread::spawn(move || {
            let made = take.make(&frames, &ticket);
            ticket.end(made);
        });
    })));
}
