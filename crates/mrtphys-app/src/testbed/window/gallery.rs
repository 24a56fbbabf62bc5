//! The gallery: the scenes that are built in, with pictures that are drawn in the background.

use super::action::Action;
use super::desk::Desk;
use eframe::egui;
use mrtphys::Vec3;
use mrtphys_scene::{Scene, gallery};
use mrtphys_view::{Camera, Frame, Image, Look, Poses, Renderer, Stage, Theme};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering::Relaxed};
use std::sync::mpsc::{self, Receiver};

/// Width and height of a picture \[points\].
const PICTURE: egui::Vec2 = egui::vec2(212.0, 132.0);
/// Pixels of a picture per point.
const SHARPNESS: f32 = 1.5;

/// A scene on its card.
struct Card {
    name: &'static str,
    title: String,
    line: String,
    bodies: u64,
    texture: Option<egui::TextureHandle>,
}

/// The gallery's window.
pub struct Gallery {
    /// whether it is shown
    pub open: bool,
    cards: Vec<Card>,
    search: String,
    drawing: Option<Drawing>,
    /// the theme of the pictures that are there or under way
    theme: Option<Theme>,
}

/// The thread that draws.
struct Drawing {
    receiver: Receiver<(&'static str, Image)>,
    stop: Arc<AtomicBool>,
}

impl Drop for Drawing {
    fn drop(&mut self) {
        self.stop.store(true, Relaxed);
    }
}

impl Gallery {
    /// With what the scenes say about themselves.
    pub fn new(open: bool) -> Gallery {
        let mut cards: Vec<Card> = gallery().iter().map(|(name, text)| card(name, text)).collect();
        cards.sort_by_key(|card| group(card.name));
        Gallery { open, cards, search: String::new(), drawing: None, theme: None }
    }

    /// How many pictures there are.
    pub fn drawn(&self) -> usize {
        self.cards.iter().filter(|c| c.texture.is_some()).count()
    }

    /// Shows it, if it is open.
    pub fn show(&mut self, context: &egui::Context, desk: &mut Desk) {
        self.collect(context);
        if !self.open {
            return;
        }
        if self.theme != Some(desk.look.theme) {
            self.theme = Some(desk.look.theme);
            self.drawing = Some(draw_all(desk.look.theme, context));
        }
        let room = context.content_rect();
        let mut open = self.open;
        let mut chosen = None;
        let size = egui::vec2((0.78 * room.width()).min(960.0), 0.74 * room.height());
        egui::Window::new("Gallery")
            .open(&mut open)
            .collapsible(false)
            .pivot(egui::Align2::CENTER_CENTER)
            .default_pos(room.center())
            .default_size(size)
            .show(context, |ui| chosen = self.contents(ui, desk));
        self.open = open;
        if let Some(name) = chosen {
            desk.actions.push(Action::OpenGallery(name));
            self.open = false;
        }
    }

    fn contents(&mut self, ui: &mut egui::Ui, desk: &mut Desk) -> Option<&'static str> {
        ui.horizontal(|ui| {
            ui.label("Search");
            let field = egui::TextEdit::singleline(&mut self.search).hint_text("name or title").desired_width(220.0);
            let field = ui.add(field).on_hover_text("Only scenes in whose name or description these words stand");
            desk.probes.mark("gallery.search", &field);
            let open = ui.button("Open a file...").on_hover_text("A scene of your own (Ctrl+O)");
            if open.clicked() {
                desk.actions.push(Action::OpenFile);
            }
        });
        ui.separator();
        let shown: Vec<usize> = (0..self.cards.len()).filter(|i| matches(&self.cards[*i], &self.search)).collect();
        let mut chosen = None;
        egui::ScrollArea::vertical().auto_shrink([false, false]).show(ui, |ui| {
            if shown.is_empty() {
                ui.weak("No scene of the gallery has these words.");
            }
            let gap = ui.spacing().item_spacing.x;
            let columns = (((ui.available_width() + gap) / (PICTURE.x + 14.0 + gap)).floor() as usize).max(1);
            for line in shown.chunks(columns) {
                ui.horizontal_top(|ui| {
                    for &i in line {
                        let shown = show_card(ui, &self.cards[i], desk.name == self.cards[i].name);
                        desk.probes.mark(&format!("gallery.{}", self.cards[i].name), &shown);
                        if shown.clicked() {
                            chosen = Some(self.cards[i].name);
                        }
                    }
                });
            }
        });
        chosen
    }

    /// Takes the pictures that are ready.
    fn collect(&mut self, context: &egui::Context) {
        let Some(drawing) = &self.drawing else { return };
        while let Ok((name, image)) = drawing.receiver.try_recv() {
            let Some(card) = self.cards.iter_mut().find(|card| card.name == name) else { continue };
            let size = [image.width as usize, image.height as usize];
            let pixels = egui::ColorImage::from_rgba_unmultiplied(size, &image.rgba);
            let texture = context.load_texture(name, pixels, egui::TextureOptions::LINEAR);
            card.texture = Some(texture);
        }
    }
}

fn card(name: &'static str, text: &str) -> Card {
    let scene = Scene::from_text(name, text).ok();
    let title = scene.as_ref().map(|s| s.title.clone()).filter(|t| !t.is_empty()).unwrap_or_else(|| name.into());
    let bodies = scene.map_or(0, |s| s.contents.iter().map(mrtphys_scene::scene::Content::count).sum());
    Card { name, title, line: first_comment(text), bodies, texture: None }
}

/// The thesis's scenes are much alike, and the benchmarks are for measuring: what shows most comes first.
fn group(name: &str) -> u8 {
    match name.split_once('/') {
        None => 0,
        Some(("thesis", _)) => 1,
        Some(_) => 2,
    }
}

/// The comment that a scene begins with, on one line.
fn first_comment(text: &str) -> String {
    let lines = text.lines().map_while(|l| l.trim_start().strip_prefix('#'));
    lines.map(str::trim).collect::<Vec<_>>().join(" ")
}

/// Whether every word that is searched for stands somewhere on the card.
fn matches(card: &Card, search: &str) -> bool {
    let there = format!("{} {} {}", card.name, card.title, card.line).to_lowercase();
    search.to_lowercase().split_whitespace().all(|word| there.contains(word))
}

fn show_card(ui: &mut egui::Ui, card: &Card, current: bool) -> egui::Response {
    let size = PICTURE + egui::vec2(14.0, 78.0);
    let (rect, response) = ui.allocate_exact_size(size, egui::Sense::click());
    let visuals = ui.style().interact_selectable(&response, current);
    ui.painter().rect(rect, 6.0, ui.visuals().faint_bg_color, visuals.bg_stroke, egui::StrokeKind::Inside);
    let picture = egui::Rect::from_min_size(rect.min + egui::vec2(7.0, 7.0), PICTURE);
    match &card.texture {
        Some(texture) => {
            let whole = egui::Rect::from_min_max(egui::pos2(0.0, 0.0), egui::pos2(1.0, 1.0));
            ui.painter().image(texture.id(), picture, whole, egui::Color32::WHITE);
        }
        None => {
            ui.painter().rect_filled(picture, 4.0, ui.visuals().extreme_bg_color);
        }
    }
    let words = egui::Rect::from_min_max(picture.left_bottom() + egui::vec2(0.0, 4.0), rect.max - egui::vec2(7.0, 4.0));
    let mut inner =
        ui.new_child(egui::UiBuilder::new().max_rect(words).layout(egui::Layout::top_down(egui::Align::Min)));
    inner.set_clip_rect(words.intersect(ui.clip_rect()));
    inner.spacing_mut().item_spacing.y = 1.0;
    let label = |text: egui::RichText| egui::Label::new(text).selectable(false);
    inner.add(label(egui::RichText::new(&card.title).strong()).wrap());
    inner.add(label(egui::RichText::new(&card.line).small()).wrap());
    let bodies = super::format::count(card.bodies);
    response.on_hover_text(format!("{}\n{}\n{bodies} bodies", card.name, card.line))
}

/// Draws all scenes as they begin, the small ones first.
fn draw_all(theme: Theme, context: &egui::Context) -> Drawing {
    let (sender, receiver) = mpsc::channel();
    let stop = Arc::new(AtomicBool::new(false));
    let (stopped, context) = (stop.clone(), context.clone());
    std::thread::spawn(move || {
        // Without a driver of their own there are no pictures, and the gallery works without.
        let Ok(mut renderer) = Renderer::new() else { return };
        let read = |(name, text): &(&'static str, &str)| Some((*name, Scene::from_text(name, text).ok()?));
        let mut scenes: Vec<(&'static str, Scene)> = gallery().iter().filter_map(read).collect();
        scenes.sort_by_key(|(_, s)| s.contents.iter().map(mrtphys_scene::scene::Content::count).sum::<u64>());
        let look = Look { theme, smooth: Some(true), ..Look::default() };
        let [w, h] = [PICTURE.x, PICTURE.y].map(|x| (x * SHARPNESS) as u32);
        let nowhere = Camera { eye: Vec3::Z, look_at: Vec3::ZERO, up: Vec3::Y, fov_deg: 45.0 };
        let (mut poses, mut frame) = (Poses::default(), Frame::new(nowhere, look));
        for (name, scene) in scenes {
            let Ok(loaded) = scene.build() else { continue };
            if stopped.load(Relaxed) {
                return;
            }
            let stage = Stage::new(&loaded);
            let mut camera = stage.camera();
            camera.fit(&stage.bounds(), f64::from(w) / f64::from(h));
            stage.read(&loaded.world, &mut poses);
            stage.fill(camera, look, &poses, &mut frame);
            let Ok(image) = renderer.render(&frame, w, h) else { return };
            if sender.send((name, image)).is_err() {
                return;
            }
            context.request_repaint();
        }
    });
    Drawing { receiver, stop }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_scene_has_a_title_and_a_line() {
        let all = Gallery::new(false);
        assert_eq!(all.cards.len(), gallery().len());
        for card in &all.cards {
            assert!(!card.title.is_empty() && !card.line.is_empty() && card.bodies > 0, "{}", card.name);
        }
    }

    #[test]
    fn all_words_must_be_there_in_any_order() {
        let all = Gallery::new(false);
        let found = |search: &str| all.cards.iter().filter(|c| matches(c, search)).map(|c| c.name).collect::<Vec<_>>();
        assert_eq!(found("").len(), gallery().len());
        assert_eq!(found("  CRADLE "), ["cradle"]);
        assert!(found("thesis cube").len() >= 7);
        assert_eq!(found("cube cradle"), [] as [&str; 0]);
    }

    #[test]
    fn the_first_comment_is_one_line() {
        assert_eq!(first_comment("# a\n#  b\nformat = 1\n# c"), "a b");
        assert_eq!(first_comment("format = 1"), "");
    }
}
