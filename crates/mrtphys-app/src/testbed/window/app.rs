//! The testbed's window as a whole.

use super::desk::Desk;
use super::viewport::Viewport;
use crate::testbed::session::{Command, time_code};
use eframe::egui;
use mrtphys_scene::{Scene, gallery_scene};

/// The program.
pub struct Testbed {
    desk: Desk,
    viewport: Viewport,
}

impl Testbed {
    /// Made once, with the window's graphics device.
    pub fn new(
        cc: &eframe::CreationContext<'_>,
        scene: Option<Scene>,
    ) -> Result<Testbed, Box<dyn std::error::Error + Send + Sync>> {
        let scene = match scene {
            Some(scene) => scene,
            None => Scene::from_text("thesis/cube-8", gallery_scene("thesis/cube-8").ok_or("no gallery")?)?,
        };
        let desk = Desk::new(scene, &cc.egui_ctx)?;
        let render = cc.wgpu_render_state.as_ref().ok_or("the window has no graphics device")?;
        let viewport = Viewport::new(render, &desk)?;
        desk.session.send(Command::Go(true));
        Ok(Testbed { desk, viewport })
    }
}

impl eframe::App for Testbed {
    fn ui(&mut self, ui: &mut egui::Ui, frame: &mut eframe::Frame) {
        self.desk.session.poll();
        let report = self.desk.session.report();
        egui::Panel::right("panel").default_size(280.0).show(ui, |ui| {
            let numbers = &report.sides[0].numbers;
            ui.heading(&report.title);
            let label = if report.running { "Stop" } else { "Go" };
            if ui.button(label).clicked() {
                self.desk.session.send(Command::Go(!report.running));
            }
            ui.label(time_code(numbers.frame, numbers.settings.fps));
        });
        if let Some(render) = frame.wgpu_render_state() {
            egui::CentralPanel::no_frame().show(ui, |ui| self.viewport.show(ui, render, &mut self.desk));
        }
    }
}
