//! The picture of one world: drawn when something in it has changed, and shown from its texture otherwise.

use super::drawing::{self, Moment, Scales, View};
use super::seeing::Seeing;
use crate::testbed::session::{Report, Side};
use eframe::egui;
use eframe::egui_wgpu::RenderState;
use mrtphys_view::{Camera, Canvas, Frame, Look, Poses, Renderer, ViewError};
use std::sync::Arc;
use std::time::{Duration, Instant};

/// Everything that a picture depends on.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Key {
    view: View,
    report: u64,
    part: f64,
}

/// A texture with a picture.
struct Shown {
    canvas: Canvas,
    id: egui::TextureId,
}

/// The picture of one world.
pub struct Picture {
    shown: Option<Shown>,
    frame: Frame,
    between: Poses,
    /// the stage and the report of `between`
    placed: Option<(u64, f64)>,
    key: Option<Key>,
    scales: Scales,
}

impl Picture {
    /// Nothing yet.
    pub fn new(camera: Camera, look: Look) -> Picture {
        Picture {
            shown: None,
            frame: Frame::new(camera, look),
            between: Poses::default(),
            placed: None,
            key: None,
            scales: Scales::default(),
        }
    }

    /// Moves the bodies to where they are at this part of the way between the last two frames.
    pub fn place(&mut self, report: &Report, side: &Side, part: f64) {
        if self.placed == Some((report.number, part)) {
            return;
        }
        place(side, part, &mut self.between);
        self.placed = Some((report.number, part));
    }

    /// Where the bodies are in the picture, in the order of the stage.
    pub fn poses(&self) -> &Poses {
        &self.between
    }

    /// The texture, if there is a picture.
    pub fn texture(&self) -> Option<egui::TextureId> {
        self.shown.as_ref().map(|s| s.id)
    }

    /// Whether the picture would be another one.
    pub fn is_stale(&self, report: &Report, part: f64, view: &View) -> bool {
        self.key != Some(Key { view: *view, report: report.number, part })
    }

    /// Draws the picture. Says how long it took, where that can be known: in software. `seeing` learns what was drawn.
    ///
    /// # Errors
    /// The driver cannot draw it.
    pub fn draw(
        &mut self,
        renderer: &mut Renderer,
        render: &RenderState,
        (report, side, part): (&Report, &Side, f64),
        view: &View,
        seeing: Option<&mut Seeing>,
    ) -> Result<Option<Duration>, ViewError> {
        let start = Instant::now();
        self.key = Some(Key { view: *view, report: report.number, part });
        self.place(report, side, part);
        let told = drawing::fill(&mut self.frame, &moment(side, &self.between), view, &mut self.scales);
        if let Some(seeing) = seeing {
            (seeing.drawn, seeing.legends) = (told.drawn, told.legends);
        }
        let software = renderer.gpu().is_software;
        let smooth = view.look.smooth.unwrap_or(!software);
        self.canvas(renderer, render, view.size, smooth)?;
        if let Some(shown) = &mut self.shown {
            renderer.draw(&self.frame, &shown.canvas)?;
        }
        if !software {
            return Ok(None);
        }
        // The window's own drawing would wait for this anyway; a driver that gave way is heard of at the next picture.
        let _ = render.device.poll(eframe::wgpu::PollType::wait_indefinitely());
        Ok(Some(start.elapsed()))
    }

    /// A texture of this size and smoothness.
    fn canvas(
        &mut self,
        renderer: &Renderer,
        render: &RenderState,
        (w, h): (u32, u32),
        smooth: bool,
    ) -> Result<(), ViewError> {
        let samples = if smooth { 4 } else { 1 };
        if self.shown.as_ref().is_some_and(|s| s.canvas.size() == (w, h) && s.canvas.samples() == samples) {
            return Ok(());
        }
        let canvas = Canvas::new(renderer.gpu(), w, h, smooth)?;
        let mut textures = render.renderer.write();
        if let Some(old) = self.shown.take() {
            textures.free_texture(&old.id);
        }
        let view = canvas.encoded_view();
        let id = textures.register_native_texture(&render.device, &view, eframe::wgpu::FilterMode::Linear);
        self.shown = Some(Shown { canvas, id });
        Ok(())
    }

    /// The same picture, to be drawn elsewhere: at another size, say.
    pub fn copy(&self, side: &Side, part: f64, view: &View) -> Frame {
        let (mut frame, mut poses) = (Frame::new(view.camera, view.look), Poses::default());
        place(side, part, &mut poses);
        drawing::fill(&mut frame, &moment(side, &poses), view, &mut self.scales.clone());
        frame
    }

    /// Gives the texture back.
    pub fn release(&mut self, render: &RenderState) {
        if let Some(old) = self.shown.take() {
            render.renderer.write().free_texture(&old.id);
        }
        self.key = None;
    }
}

/// The bodies at this part of the way between the last two frames.
fn place(side: &Side, part: f64, poses: &mut Poses) {
    let (before, shot) = (&side.before, &side.shot);
    // Between two frames with other bodies there is nothing.
    let from = if Arc::ptr_eq(&before.stage, &shot.stage) { &before.poses } else { &shot.poses };
    poses.set_between(from, &shot.poses, part);
}

fn moment<'a>(side: &'a Side, poses: &'a Poses) -> Moment<'a> {
    let is_tree = drawing::is_tree(&side.numbers.settings);
    Moment { stage: &side.shot.stage, poses, extras: &side.extras, is_tree }
}
