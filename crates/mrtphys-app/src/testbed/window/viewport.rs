//! The scene window: the picture, and what mouse and keys do in it.

use super::action::Action;
use super::ask::Inquiry;
use super::desk::Desk;
use super::detail::{self, Detail};
use super::drawing::{self, View};
use super::labels;
use super::mouse::{self, Gesture, Held};
use super::panel::throw_ball;
use super::picture::Picture;
use crate::testbed::session::{Command, Grip, Report, Side};
use eframe::egui;
use eframe::egui::{Key, Modifiers, PointerButton};
use eframe::egui_wgpu::RenderState;
use mrtphys::{BodyId, Vec3};
use mrtphys_view::{Frame, Gpu, Hit, Look, Ray, Renderer, ViewError};
use std::time::{Duration, Instant};

/// The pictures of a session's worlds.
pub struct Viewport {
    renderer: Renderer,
    pictures: Vec<Picture>,
    detail: Detail,
    /// when something last moved
    moved: Instant,
    /// how long the last picture took, where that is known
    took: Option<Duration>,
    drag: Option<Drag>,
    followed: Option<(BodyId, Vec3)>,
    hover: Hover,
    trouble: Option<String>,
    opened: u64,
}

/// A drag that is under way.
struct Drag {
    gesture: Gesture,
    held: Option<(BodyId, Held)>,
    /// the line of sight that the mouse is on
    sight: Vec3,
}

/// The body under the mouse.
#[derive(Default)]
struct Hover {
    hit: Option<Hit>,
    /// the body and the state that were asked about
    asked: Option<(BodyId, usize)>,
    /// name and velocity \[m/s\]
    about: Inquiry<(BodyId, String, Vec3)>,
}

/// Where a picture is on the screen.
#[derive(Clone, Copy)]
pub struct Pane {
    /// on the screen
    pub rect: egui::Rect,
    /// which world's
    pub side: usize,
}

impl Pane {
    /// Panes next to each other.
    pub fn split(rect: egui::Rect, sides: usize) -> Vec<Pane> {
        let sides = sides.max(1);
        let width = rect.width() / sides as f32;
        let pane = |side: usize| {
            let left = rect.left() + width * side as f32;
            let right = if side + 1 == sides { rect.right() } else { left + width - 1.0 };
            Pane { rect: egui::Rect::from_x_y_ranges(left..=right, rect.y_range()), side }
        };
        (0..sides).map(pane).collect()
    }

    /// Width to height.
    pub fn aspect(&self) -> f64 {
        f64::from(self.rect.width().max(1.0)) / f64::from(self.rect.height().max(1.0))
    }

    /// A place on the screen as parts of the picture's width and height.
    fn part(&self, at: egui::Pos2) -> (f64, f64) {
        let d = at - self.rect.min;
        (f64::from(d.x / self.rect.width().max(1.0)), f64::from(d.y / self.rect.height().max(1.0)))
    }

    /// The place on the screen of parts of the picture's width and height.
    pub fn screen(&self, (x, y): (f64, f64)) -> egui::Pos2 {
        self.rect.min + egui::vec2(x as f32 * self.rect.width(), y as f32 * self.rect.height())
    }

    /// A place on the screen from the middle of the picture, in its heights.
    fn off_middle(&self, at: egui::Pos2) -> (f64, f64) {
        let d = at - self.rect.center();
        let height = self.rect.height().max(1.0);
        (f64::from(d.x / height), f64::from(d.y / height))
    }

    fn ray(&self, desk: &Desk, at: egui::Pos2) -> Ray {
        let (x, y) = self.part(at);
        desk.camera.ray(x, y, self.aspect())
    }
}

impl Viewport {
    /// Draws with the window's own device.
    pub fn new(render: &RenderState, _desk: &Desk) -> Result<Viewport, ViewError> {
        let gpu = Gpu::new(render.device.clone(), render.queue.clone(), &render.adapter.get_info());
        Ok(Viewport {
            renderer: Renderer::with(gpu)?,
            pictures: Vec::new(),
            detail: Detail::default(),
            moved: Instant::now(),
            took: None,
            drag: None,
            followed: None,
            hover: Hover::default(),
            trouble: None,
            opened: 0,
        })
    }

    /// Draws the pictures into the rest of the window.
    pub fn show(&mut self, ui: &mut egui::Ui, render: &RenderState, desk: &mut Desk) {
        let rect = ui.available_rect_before_wrap();
        let response = ui.allocate_rect(rect, egui::Sense::click_and_drag());
        desk.probes.mark("viewport", &response);
        if self.opened != desk.opened {
            (self.opened, self.followed, self.drag) = (desk.opened, None, None);
            self.hover = Hover::default();
        }
        let panes = Pane::split(rect, desk.report().sides.len());
        self.prepare(desk, &panes, render);
        Viewport::keys(ui, desk);
        self.mouse(ui, desk, &panes, &response);
        self.follow(desk);
        desk.seeing.sight.wish(&mut desk.wish);
        self.draw(ui, render, desk, &panes);
        self.overwrite(ui, desk, &panes, &response);
    }

    /// What is in the window, to be drawn at this size: every world's picture from its column on.
    pub fn copy(&self, desk: &Desk, size: (u32, u32)) -> Vec<(u32, Frame, u32)> {
        let report = desk.report();
        let part = report.pace.part(Instant::now());
        let columns = drawing::split(size.0, report.sides.len());
        let copy = |((side, picture), (left, width)): ((&Side, &Picture), (u32, u32))| {
            let view = View {
                camera: desk.camera,
                look: Look { smooth: Some(true), ..desk.look },
                sight: desk.seeing.sight,
                selected: desk.selected,
                spring: None,
                size: (width, size.1),
                part: 1.0,
            };
            (left, picture.copy(side, part, &view), width)
        };
        report.sides.iter().zip(&self.pictures).zip(columns).map(copy).collect()
    }

    /// Where the body is that the camera follows \[m\].
    pub fn followed(&self) -> Option<Vec3> {
        self.followed.map(|(_, at)| at)
    }

    /// As many pictures as there are worlds, the bodies where they are now.
    fn prepare(&mut self, desk: &Desk, panes: &[Pane], render: &RenderState) {
        while self.pictures.len() > panes.len() {
            if let Some(mut picture) = self.pictures.pop() {
                picture.release(render);
            }
        }
        while self.pictures.len() < panes.len() {
            self.pictures.push(Picture::new(desk.camera, desk.look));
        }
        let report = desk.report();
        let part = report.pace.part(Instant::now());
        for (picture, side) in self.pictures.iter_mut().zip(&report.sides) {
            picture.place(report, side, part);
        }
    }

    fn pick(&self, desk: &Desk, pane: Pane, at: egui::Pos2) -> Option<Hit> {
        let side = desk.report().sides.get(pane.side)?;
        side.shot.stage.pick(self.pictures.get(pane.side)?.poses(), pane.ray(desk, at))
    }

    fn keys(ui: &mut egui::Ui, desk: &mut Desk) {
        if desk.keys_taken || ui.ctx().egui_wants_keyboard_input() {
            return;
        }
        let pressed = |keys: Modifiers, key: Key| ui.input_mut(|i| i.consume_key(keys, key));
        for (axis, key) in [Key::Num1, Key::Num2, Key::Num3].into_iter().enumerate() {
            if pressed(Modifiers::SHIFT, key) {
                mouse::along_axis(&mut desk.camera, axis, true);
            } else if pressed(Modifiers::NONE, key) {
                mouse::along_axis(&mut desk.camera, axis, false);
            }
        }
        if pressed(Modifiers::NONE, Key::H) {
            desk.seeing.hand ^= true;
        }
        if pressed(Modifiers::NONE, Key::L) {
            desk.seeing.follow ^= true;
        }
        if pressed(Modifiers::NONE, Key::B) {
            throw_ball(desk);
        }
        if pressed(Modifiers::NONE, Key::Escape) {
            desk.selected = None;
        }
        if let Some(id) = desk.selected
            && pressed(Modifiers::NONE, Key::Delete)
        {
            desk.edit(true, move |loaded| loaded.world.remove_body(id).map_err(|e| e.to_string()));
            desk.selected = None;
        }
    }

    fn mouse(&mut self, ui: &mut egui::Ui, desk: &mut Desk, panes: &[Pane], response: &egui::Response) {
        let pane_at = |at: egui::Pos2| panes.iter().copied().find(|p| p.rect.contains(at)).unwrap_or(panes[0]);
        let before = desk.camera;
        if let Some(at) = response.interact_pointer_pos().or(response.hover_pos()) {
            let pane = pane_at(at);
            self.begin_drag(ui, desk, pane, response);
            self.go_on(ui, desk, (pane, at), response);
            if response.clicked() {
                desk.selected = self.pick(desk, pane, at).map(|hit| hit.body);
                if desk.selected.is_some() {
                    desk.actions.push(Action::Selected);
                }
            }
            if response.double_clicked()
                && let Some(hit) = self.pick(desk, pane, at)
            {
                desk.selected = Some(hit.body);
                desk.seeing.look_at = Some(hit.body);
            }
        }
        if self.drag.is_some() && response.drag_stopped() {
            self.let_go(desk);
        }
        self.wheel(ui, desk, &pane_at, response);
        self.hover(ui, desk, &pane_at, response);
        if desk.camera != before {
            self.moved = Instant::now();
        }
    }

    fn begin_drag(&mut self, ui: &egui::Ui, desk: &mut Desk, pane: Pane, response: &egui::Response) {
        let buttons = [PointerButton::Primary, PointerButton::Middle, PointerButton::Secondary];
        let Some(button) = buttons.into_iter().find(|b| response.drag_started_by(*b)) else { return };
        let (origin, keys) = ui.input(|i| (i.pointer.press_origin(), i.modifiers));
        let hit = origin.and_then(|at| self.pick(desk, pane, at));
        let movable = hit.filter(|h| !desk.report().sides[pane.side].shot.stage.is_fixed(h.index));
        let Some(gesture) = mouse::gesture(button, keys, desk.seeing.hand, movable.is_some()) else { return };
        let held = movable.filter(|_| gesture == Gesture::Pull).map(|hit| {
            let poses = self.pictures[pane.side].poses();
            let (x, q) = (poses.positions[hit.index], poses.orientations[hit.index]);
            desk.selected = Some(hit.body);
            (hit.body, Held::take(&desk.camera, hit.point, x, q))
        });
        let sight = desk.camera.axes().forward;
        self.drag = Some(Drag { gesture, held, sight });
    }

    fn go_on(&mut self, ui: &egui::Ui, desk: &mut Desk, (pane, at): (Pane, egui::Pos2), response: &egui::Response) {
        let Some(drag) = &mut self.drag else { return };
        if let Some((body, held)) = &mut drag.held {
            held.reach(f64::from(ui.input(|i| i.smooth_scroll_delta.y)) / f64::from(pane.rect.height()) * 0.5);
            drag.sight = pane.ray(desk, at).direction;
            let target = held.target(&desk.camera, drag.sight);
            desk.send(Command::Hold(Some(Grip { body: *body, point: held.point, target })));
        } else {
            let (d, height) = (response.drag_delta(), f64::from(pane.rect.height().max(1.0)));
            mouse::drag(&mut desk.camera, drag.gesture, f64::from(d.x) / height, f64::from(d.y) / height);
        }
    }

    /// A body that was held flies on.
    fn let_go(&mut self, desk: &Desk) {
        if self.drag.take().is_some_and(|d| d.held.is_some()) {
            desk.send(Command::Hold(None));
        }
    }

    fn wheel(&self, ui: &egui::Ui, desk: &mut Desk, pane_at: &impl Fn(egui::Pos2) -> Pane, response: &egui::Response) {
        let Some(at) = response.hover_pos().filter(|_| self.drag.is_none()) else { return };
        let (scroll, zoom) = ui.input(|i| (i.smooth_scroll_delta.y, i.zoom_delta()));
        let by = f64::from(scroll) / 400.0 + f64::from(zoom).ln() / 2.0;
        if by != 0.0 && by.is_finite() {
            let pane = pane_at(at);
            mouse::approach(&mut desk.camera, by, pane.off_middle(at));
        }
    }

    /// Finds the body under the mouse, and asks who it is.
    fn hover(&mut self, ui: &egui::Ui, desk: &Desk, pane_at: &impl Fn(egui::Pos2) -> Pane, response: &egui::Response) {
        let at = response.hover_pos().filter(|_| self.drag.is_none());
        self.hover.hit = at.and_then(|at| self.pick(desk, pane_at(at), at));
        let Some(hit) = self.hover.hit else { return };
        if desk.seeing.hand || ui.input(|i| i.modifiers.alt) {
            ui.ctx().set_cursor_icon(egui::CursorIcon::Grab);
        }
        // Not the report's number: an answer may come with a report of its own.
        let now = Some((hit.body, moment(desk.report())));
        if self.hover.asked != now && !self.hover.about.is_waiting() && desk.seeing.labels {
            self.hover.asked = now;
            let id = hit.body;
            self.hover.about.ask(&desk.session, ui.ctx(), move |studio| {
                let body = studio.loaded.world.body(id);
                let name = studio.loaded.names.body_name(id).unwrap_or_default();
                (id, name, body.map_or(Vec3::ZERO, |b| b.velocity))
            });
        }
    }

    /// The camera moves with the selected body, and turns to one that was asked for.
    fn follow(&mut self, desk: &mut Desk) {
        let stage = desk.report().sides[0].shot.stage.clone();
        let poses = self.pictures[0].poses();
        let place = |id: BodyId| stage.index(id).and_then(|i| poses.positions.get(i)).copied();
        if let Some(id) = desk.seeing.look_at.take()
            && let (Some(center), Some(i)) = (place(id), stage.index(id))
        {
            mouse::look_at_ball(&mut desk.camera, center, stage.reach(i));
            self.moved = Instant::now();
        }
        let now = desk.selected.filter(|_| desk.seeing.follow).and_then(|id| place(id).map(|x| (id, x)));
        if let (Some((before, from)), Some((id, to))) = (self.followed, now)
            && before == id
        {
            mouse::follow(&mut desk.camera, from, to);
        }
        self.followed = now;
    }

    /// Draws what has changed, and sees to it that the window comes back when there is more to draw.
    fn draw(&mut self, ui: &egui::Ui, render: &RenderState, desk: &mut Desk, panes: &[Pane]) {
        let report = desk.session.report();
        let part = report.pace.part(Instant::now());
        let is_moving = part < 1.0 || report.running || self.moved.elapsed() < detail::REST;
        let factor = if is_moving { self.detail.part() } else { 1.0 };
        let mut taken = None;
        for (i, pane) in panes.iter().enumerate() {
            let view = View {
                camera: desk.camera,
                look: desk.look,
                sight: desk.seeing.sight,
                selected: desk.selected,
                spring: self.spring(desk, report, *pane),
                size: pixels(pane.rect.size() * ui.ctx().pixels_per_point(), factor, self.largest(render)),
                part: factor,
            };
            if !self.pictures[i].is_stale(report, part, &view) {
                continue;
            }
            let seeing = (i == 0).then_some(&mut desk.seeing);
            let drawn =
                self.pictures[i].draw(&mut self.renderer, render, (report, &report.sides[i], part), &view, seeing);
            match drawn {
                Ok(time) => (taken, self.trouble) = (time.map(|t| t + taken.unwrap_or_default()), None),
                Err(e) => self.trouble = Some(e.to_string()),
            }
        }
        if let Some(time) = taken {
            self.took = Some(time);
            if is_moving {
                self.detail.took(time);
            }
        }
        self.come_back(ui.ctx(), part < 1.0, is_moving && factor < 1.0 && !report.running);
    }

    /// `blends`: the next picture is another one already. `rests`: when it has stood still for a while it is drawn in full.
    fn come_back(&self, context: &egui::Context, blends: bool, rests: bool) {
        if blends {
            match self.took {
                // A graphics card draws as often as the screen shows.
                None => context.request_repaint(),
                Some(time) => context.request_repaint_after(detail::pause(time)),
            }
        } else if rests {
            context.request_repaint_after(detail::REST);
        }
    }

    fn largest(&self, render: &RenderState) -> u32 {
        render.device.limits().max_texture_dimension_2d
    }

    /// The spring from where a body is held to the mouse.
    fn spring(&self, desk: &Desk, report: &Report, pane: Pane) -> Option<(Vec3, Vec3)> {
        let drag = self.drag.as_ref()?;
        let (id, held) = drag.held?;
        let i = report.sides.get(pane.side)?.shot.stage.index(id)?;
        let poses = self.pictures.get(pane.side)?.poses();
        let end = held.end(*poses.positions.get(i)?, *poses.orientations.get(i)?);
        Some((end, held.target(&desk.camera, drag.sight)))
    }

    /// The pictures, and what is written over them.
    fn overwrite(&mut self, ui: &mut egui::Ui, desk: &mut Desk, panes: &[Pane], response: &egui::Response) {
        let whole = egui::Rect::from_min_max(egui::pos2(0.0, 0.0), egui::pos2(1.0, 1.0));
        for pane in panes {
            if let Some(id) = self.pictures[pane.side].texture() {
                ui.painter().image(id, pane.rect, whole, egui::Color32::WHITE);
            }
        }
        if let Some(text) = &self.trouble {
            labels::trouble(ui, response.rect, text);
        }
        if panes.len() > 1 {
            panes.iter().for_each(|pane| labels::side(ui, desk.report(), *pane));
        }
        if desk.seeing.labels {
            self.name_tags(ui, desk, panes);
        }
        labels::legends(ui, response.rect, &desk.seeing.legends);
        labels::tools(ui, response.rect, desk);
    }

    /// Name and speed of the selected body and of the one under the mouse.
    fn name_tags(&mut self, ui: &egui::Ui, desk: &Desk, panes: &[Pane]) {
        let report = desk.report();
        let mut tags: Vec<(BodyId, String, f64)> = Vec::new();
        if let Some((id, name, body)) = &report.sides[0].extras.selected
            && desk.selected == Some(*id)
        {
            tags.push((*id, name.clone(), body.velocity.length()));
        }
        let hit = self.hover.hit.map(|h| h.body).filter(|id| desk.selected != Some(*id));
        if let (Some(hit), Some((id, name, v))) = (hit, self.hover.about.answer())
            && hit == *id
        {
            tags.push((*id, name.clone(), v.length()));
        }
        let pane = panes[0];
        let (stage, poses) = (&report.sides[0].shot.stage, self.pictures[0].poses());
        for (id, name, speed) in tags {
            let Some(i) = stage.index(id) else { continue };
            let Some(&x) = poses.positions.get(i) else { continue };
            let Some(at) = desk.camera.place(x, pane.aspect()) else { continue };
            labels::name_tag(ui, pane, pane.screen(at), &name, (!stage.is_fixed(i)).then_some(speed));
        }
    }
}

/// Tells states apart: every frame and every edit has poses of its own.
fn moment(report: &Report) -> usize {
    std::sync::Arc::as_ptr(&report.sides[0].shot.poses) as usize
}

/// Pixels of a picture of this size on the screen, drawn with a part of them.
fn pixels(size: egui::Vec2, part: f32, largest: u32) -> (u32, u32) {
    let whole = |x: f32| ((x * part).round().max(1.0) as u32).clamp(1, largest.max(1));
    (whole(size.x), whole(size.y))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn panes_lie_next_to_each_other() {
        let rect = egui::Rect::from_min_size(egui::pos2(10.0, 20.0), egui::vec2(800.0, 400.0));
        assert_eq!(Pane::split(rect, 1)[0].rect, rect);
        assert_eq!(Pane::split(rect, 0).len(), 1);
        let two = Pane::split(rect, 2);
        assert!(two[0].rect.right() < two[1].rect.left() && two[1].rect.right() == rect.right());
        assert!((two[0].aspect() - two[1].aspect()).abs() < 0.01);
    }

    #[test]
    fn places_on_the_screen_and_in_the_picture_agree() {
        let pane = Pane { rect: egui::Rect::from_min_size(egui::pos2(10.0, 20.0), egui::vec2(800.0, 400.0)), side: 0 };
        let at = egui::pos2(210.0, 120.0);
        assert_eq!(pane.part(at), (0.25, 0.25));
        assert_eq!(pane.screen((0.25, 0.25)), at);
        assert_eq!(pane.off_middle(at), (-0.5, -0.25));
        assert_eq!(pane.aspect(), 2.0);
    }

    #[test]
    fn a_picture_has_pixels_whatever_the_window() {
        assert_eq!(pixels(egui::vec2(1000.0, 500.0), 0.5, 8192), (500, 250));
        assert_eq!(pixels(egui::vec2(0.0, -3.0), 1.0, 8192), (1, 1));
        assert_eq!(pixels(egui::vec2(1e9, f32::NAN), 1.0, 8192), (8192, 1));
    }
}
