//! The picture of one world: drawn when something in it has changed, and shown from its texture otherwise.

use super::seeing::{Layer, Seeing, Sight};
use crate::testbed::session::{Report, Side};
use eframe::egui;
use eframe::egui_wgpu::RenderState;
use mrtphys::def::BroadPhaseKind;
use mrtphys::{BodyId, Vec3};
use mrtphys_view::{Camera, Canvas, Drawn, Dress, Frame, Legend, Look, Pen, Poses, Renderer, Scale, ViewError};
use std::sync::Arc;
use std::time::{Duration, Instant};

/// What a picture is drawn from, beside the report.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct View {
    /// from where
    pub camera: Camera,
    /// how
    pub look: Look,
    /// what is drawn over it
    pub sight: Sight,
    /// the outlined body
    pub selected: Option<BodyId>,
    /// the spring of the hand: from the body to the mouse \[m\]
    pub spring: Option<(Vec3, Vec3)>,
    /// width and height \[pixels\]
    pub size: (u32, u32),
}

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
    contacts: Vec<u32>,
    scales: [Scale; 3],
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
            contacts: Vec::new(),
            scales: [Scale::default(); 3],
        }
    }

    /// Moves the bodies to where they are at this part of the way between the last two frames.
    pub fn place(&mut self, report: &Report, side: &Side, part: f64) {
        if self.placed == Some((report.number, part)) {
            return;
        }
        let (before, shot) = (&side.before, &side.shot);
        // Between two frames with other bodies there is nothing.
        let from = if Arc::ptr_eq(&before.stage, &shot.stage) { &before.poses } else { &shot.poses };
        self.between.set_between(from, &shot.poses, part);
        self.placed = Some((report.number, part));
    }

    /// Takes the number of contacts of every body, in the order of the stage.
    pub fn count_contacts(&mut self, counts: &[u32]) {
        if self.contacts != counts {
            self.contacts.clear();
            self.contacts.extend_from_slice(counts);
            self.key = None;
        }
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
        self.fill(side, view, seeing);
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

    /// Gives the texture back.
    pub fn release(&mut self, render: &RenderState) {
        if let Some(old) = self.shown.take() {
            render.renderer.write().free_texture(&old.id);
        }
        self.key = None;
    }

    fn fill(&mut self, side: &Side, view: &View, seeing: Option<&mut Seeing>) {
        let (stage, extras) = (&side.shot.stage, &side.extras);
        let chosen = view.selected.and_then(|id| stage.index(id));
        let outlined: Vec<usize> = chosen.into_iter().collect();
        let sight = view.sight;
        let dress = Dress {
            coloring: sight.coloring,
            velocities: &extras.velocities,
            contacts: &self.contacts,
            most: None,
            highlight: &outlined,
        };
        let legend = stage.fill_dressed(view.camera, view.look, &dress, &self.between, &mut self.frame);
        self.frame.overlay.clear();
        let mut drawn = Vec::new();
        let mut legends: Vec<Legend> = legend.into_iter().collect();
        let pen = Pen::new(&view.camera, &stage.bounds(), view.look.theme, view.size.1);
        self.explain(side, &pen, view, &mut drawn, &mut legends);
        if let Some((held, hand)) = view.spring {
            pen.grip(&mut self.frame.overlay, held, hand);
        }
        if let Some(seeing) = seeing {
            (seeing.drawn, seeing.legends) = (drawn, legends);
        }
    }
}

impl Picture {
    /// Draws what explains the scene.
    fn explain(
        &mut self,
        side: &Side,
        pen: &Pen,
        view: &View,
        drawn: &mut Vec<(Layer, Drawn)>,
        legends: &mut Vec<Legend>,
    ) {
        let (sight, extras, stage) = (&view.sight, &side.extras, &side.shot.stage);
        let (overlay, poses) = (&mut self.frame.overlay, &self.between);
        let [impulses, speeds, spins] = &mut self.scales;
        let mut note = |layer: Layer, d: Drawn| drawn.push((layer, d));
        if sight.has(Layer::Cells) {
            let is_tree = matches!(side.numbers.settings.broad_phase, BroadPhaseKind::AdaptiveTree { .. });
            let (d, legend) = if is_tree { pen.tree(overlay, &extras.cells) } else { pen.grid(overlay, &extras.cells) };
            note(Layer::Cells, d);
            legends.push(legend);
        }
        if sight.has(Layer::Boxes) {
            note(Layer::Boxes, pen.boxes(overlay, &extras.boxes));
        }
        if sight.has(Layer::Balls) {
            note(Layer::Balls, pen.bounding_spheres(overlay, stage, poses));
        }
        let chosen = view.selected.and_then(|id| stage.index(id));
        if sight.has(Layer::Trails) {
            note(Layer::Trails, pen.trails(overlay, stage, &extras.trail, poses, None));
        } else if sight.trail_of_selected && chosen.is_some() {
            pen.trails(overlay, stage, &extras.trail, poses, chosen);
        }
        if sight.has(Layer::Velocities) {
            note(Layer::Velocities, pen.velocities(overlay, speeds, &poses.positions, &extras.velocities));
        }
        if sight.has(Layer::Spins) {
            note(Layer::Spins, pen.spins(overlay, spins, &poses.positions, &extras.velocities));
        }
        if sight.has(Layer::Impulses) {
            note(Layer::Impulses, pen.impulses(overlay, impulses, &extras.impacts));
        }
        if sight.has(Layer::Contacts) {
            note(Layer::Contacts, pen.contacts(overlay, &extras.contacts));
        }
    }
}
