//! The testbed's window as a whole.

use super::desk::{self, Desk};
use super::panel::Panel;
use super::viewport::Viewport;
use crate::testbed::session::Command;
use eframe::egui;
use mrtphys_scene::{Scene, gallery_scene};

/// The program.
pub struct Testbed {
    desk: Desk,
    panel: Panel,
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
        let name = scene.source.name.to_string();
        let desk = Desk::new(desk::start(scene, &cc.egui_ctx)?, name, None);
        let render = cc.wgpu_render_state.as_ref().ok_or("the window has no graphics device")?;
        let viewport = Viewport::new(render, &desk)?;
        desk.send(Command::Go(true));
        Ok(Testbed { desk, panel: Panel::new(), viewport })
    }
}

impl eframe::App for Testbed {
    fn ui(&mut self, ui: &mut egui::Ui, frame: &mut eframe::Frame) {
        self.desk.begin();
        egui::Panel::right("panel").default_size(300.0).show(ui, |ui| self.panel.show(ui, &mut self.desk));
        if self.panel.has_below() {
            egui::Panel::bottom("below").show(ui, |ui| self.panel.show_below(ui, &mut self.desk));
        }
        if let Some(render) = frame.wgpu_render_state() {
            egui::CentralPanel::no_frame().show(ui, |ui| self.viewport.show(ui, render, &mut self.desk));
        }
        self.desk.end();
    }
}
