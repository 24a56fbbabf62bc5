//! The window round a session.

mod action;
mod app;
mod ask;
mod desk;
mod detail;
mod labels;
mod mouse;
mod panel;
mod picture;
mod quantity;
mod seeing;
mod format;
#[allow(dead_code)]
mod pending;
mod probe;
mod table;
mod viewport;

use crate::exit::{Failure, Outcome};
use mrtphys_scene::Scene;

/// Opens the testbed on a scene, or with the gallery, and stays until it is closed.
///
/// # Errors
/// There is no display or no graphics driver: what to install, and what works without.
pub fn open(scene: Option<Scene>) -> Outcome {
    let native = eframe::NativeOptions {
        viewport: eframe::egui::ViewportBuilder::default().with_title("mrtphys").with_inner_size([1280.0, 800.0]),
        ..Default::default()
    };
    eframe::run_native("mrtphys", native, Box::new(|cc| Ok(Box::new(app::Testbed::new(cc, scene)?)))).map_err(|e| {
        Failure::Wrong(format!(
            "the testbed needs a display and a graphics driver ({e}); without them: 'mrtphys run SCENE' simulates, 'mrtphys render SCENE -o FILE' makes pictures and films"
        ))
    })
}
