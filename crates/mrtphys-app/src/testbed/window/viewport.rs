//! The scene window: the picture, and what the mouse does in it.

use super::desk::Desk;
use eframe::egui;
use eframe::egui_wgpu::RenderState;
use mrtphys_view::{Canvas, Frame, Gpu, Poses, Renderer, ViewError};
use std::time::Instant;

/// The picture of a session's world.
pub struct Viewport {
    renderer: Renderer,
    canvas: Option<(Canvas, egui::TextureId)>,
    frame: Frame,
    between: Poses,
}

impl Viewport {
    /// Draws with the window's own device.
    pub fn new(render: &RenderState, desk: &Desk) -> Result<Viewport, ViewError> {
        let gpu = Gpu::new(render.device.clone(), render.queue.clone(), &render.adapter.get_info());
        Ok(Viewport {
            renderer: Renderer::with(gpu)?,
            canvas: None,
            frame: Frame::new(desk.camera, desk.look),
            between: Poses::default(),
        })
    }

    /// Draws the picture into the rest of the window.
    pub fn show(&mut self, ui: &mut egui::Ui, render: &RenderState, desk: &mut Desk) {
        let size = ui.available_size();
        let (rect, response) = ui.allocate_exact_size(size, egui::Sense::click_and_drag());
        let height = f64::from(rect.height().max(1.0));
        let drag = response.drag_delta();
        let (dx, dy) = (f64::from(drag.x) / height, f64::from(drag.y) / height);
        if response.dragged_by(egui::PointerButton::Primary) {
            desk.camera.orbit(dx, dy);
        } else if response.dragged_by(egui::PointerButton::Middle) {
            desk.camera.pan(dx, dy);
        } else if response.dragged_by(egui::PointerButton::Secondary) {
            desk.camera.dolly(dy);
            desk.camera.roll(dx);
        }
        let report = desk.session.report();
        let side = &report.sides[0];
        self.between.set_between(&side.before.poses, &side.shot.poses, report.pace.part(Instant::now()));
        side.shot.stage.fill(desk.camera, desk.look, &self.between, &mut self.frame);
        let pixels = rect.size() * ui.ctx().pixels_per_point();
        let (w, h) = (pixels.x.round().max(1.0) as u32, pixels.y.round().max(1.0) as u32);
        if self.canvas.as_ref().is_none_or(|(c, _)| c.size() != (w, h)) {
            let Ok(canvas) = Canvas::new(self.renderer.gpu(), w, h, false) else { return };
            let mut shown = render.renderer.write();
            let view = canvas.encoded_view();
            if let Some((_, id)) = self.canvas.take() {
                shown.free_texture(&id);
            }
            let id = shown.register_native_texture(&render.device, &view, eframe::wgpu::FilterMode::Linear);
            self.canvas = Some((canvas, id));
        }
        if let Some((canvas, id)) = &self.canvas
            && self.renderer.draw(&self.frame, canvas).is_ok()
        {
            let whole = egui::Rect::from_min_max(egui::pos2(0.0, 0.0), egui::pos2(1.0, 1.0));
            ui.painter().image(*id, rect, whole, egui::Color32::WHITE);
        }
    }
}
