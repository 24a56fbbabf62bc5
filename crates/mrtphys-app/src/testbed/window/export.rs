//! What a picture or a film is to be like, before the file is asked for.

use super::desk::Desk;
use super::files::Purpose;
use super::format::{brief, count};
use super::reel::{FILM_KINDS, MOST_PICTURES, Take};
use crate::testbed::session::Command;
use eframe::egui;
use std::path::PathBuf;
use std::sync::mpsc::{self, Receiver};

/// Largest width and height \[pixels\]; the driver may allow less.
const LARGEST: u32 = 16384;
/// Sizes to choose from.
const SIZES: [(u32, u32); 5] = [(1280, 720), (1920, 1080), (2560, 1440), (3840, 2160), (1080, 1080)];

/// What the user chose.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Asked {
    /// a picture's file is to be asked for
    Picture,
    /// a film's
    Film,
}

/// The two windows.
pub struct Export {
    /// whether the picture's is open
    pub picture: bool,
    /// whether the film's is open
    pub film: bool,
    size: (u32, u32),
    kind: usize,
    fps: u32,
    speed: f64,
    /// part of the recording that is filmed \[s\]; `None`: all of it
    range: Option<(f64, f64)>,
    /// simulated time of the first and the last frame of the recording \[s\]
    recorded: (f64, f64),
    asked: Option<Receiver<(f64, f64)>>,
}

impl Export {
    /// Closed.
    pub fn new() -> Export {
        Export {
            picture: false,
            film: false,
            size: (1280, 720),
            kind: first_kind(),
            fps: 30,
            speed: 1.0,
            range: None,
            recorded: (0.0, 0.0),
            asked: None,
        }
    }

    /// Opens the film's window, on what is recorded up to now.
    pub fn open_film(&mut self, context: &egui::Context, desk: &Desk) {
        (self.film, self.range) = (true, None);
        let (sender, receiver) = mpsc::channel();
        let context = context.clone();
        desk.send(Command::Ask(Box::new(move |studio| {
            let shots = (studio.shots)();
            if let (Some(first), Some(last)) = (shots.first(), shots.last()) {
                let _ = sender.send((first.time, last.time));
                context.request_repaint();
            }
        })));
        self.asked = Some(receiver);
    }

    /// Width and height that were chosen \[pixels\].
    pub fn size(&self) -> (u32, u32) {
        self.size
    }

    /// What the file is asked for.
    pub fn purpose(&self, asked: Asked) -> Purpose {
        match asked {
            Asked::Picture => Purpose::Picture,
            Asked::Film => Purpose::Film(FILM_KINDS[self.kind].0),
        }
    }

    /// The film that was chosen, into this file.
    pub fn take(&self, desk: &Desk, path: PathBuf) -> Take {
        let (from, to) = self.range.unwrap_or(self.recorded);
        let (fps, speed, (w, h)) = (self.fps, self.speed, self.size);
        // H.264 has no odd sizes.
        let size = if FILM_KINDS[self.kind].0 == "mp4" { ((w & !1).max(2), (h & !1).max(2)) } else { (w, h) };
        Take { from, to, fps, speed, size, camera: desk.camera, look: desk.look, path }
    }

    /// Shows what is open; what is to be saved, once that was chosen. `window` is the size of the picture on the screen.
    pub fn show(&mut self, context: &egui::Context, desk: &mut Desk, window: (u32, u32)) -> Option<Asked> {
        let center = context.content_rect().center();
        let (mut picture, mut film, mut asked) = (self.picture, self.film, None);
        let frame = |title: &'static str| {
            egui::Window::new(title)
                .collapsible(false)
                .resizable(false)
                .pivot(egui::Align2::CENTER_CENTER)
                .default_pos(center)
        };
        frame("Picture").open(&mut picture).show(context, |ui| {
            ui.set_width(320.0);
            egui::Grid::new("picture")
                .num_columns(2)
                .spacing([12.0, 8.0])
                .show(ui, |ui| size(ui, &mut self.size, window));
            ui.add_space(6.0);
            let save = ui.button("Save...").on_hover_text("Ask for the file, and write the picture as PNG");
            desk.probes.mark("picture.save", &save);
            if save.clicked() {
                asked = Some(Asked::Picture);
            }
        });
        frame("Film").open(&mut film).show(context, |ui| {
            ui.set_width(360.0);
            if self.film_contents(ui, desk, window) {
                asked = Some(Asked::Film);
            }
        });
        let chosen = |what| asked == Some(what);
        (self.picture, self.film) = (picture && !chosen(Asked::Picture), film && !chosen(Asked::Film));
        asked
    }

    fn film_contents(&mut self, ui: &mut egui::Ui, desk: &mut Desk, window: (u32, u32)) -> bool {
        if let Some(found) = self.asked.as_ref().and_then(|r| r.try_recv().ok()) {
            (self.recorded, self.asked) = (found, None);
        }
        desk.probes.say(|| "film.format".into(), FILM_KINDS[self.kind].0);
        let (first, last) = self.recorded;
        let whole = self.range.is_none();
        let (mut from, mut to) = self.range.unwrap_or((first, last));
        egui::Grid::new("film").num_columns(2).spacing([12.0, 8.0]).show(ui, |ui| {
            ui.label("Format");
            ui.horizontal(|ui| {
                for (i, (ending, name)) in FILM_KINDS.iter().enumerate() {
                    if *ending == "mp4" && !cfg!(feature = "mp4") {
                        continue;
                    }
                    let shown = ui.selectable_value(&mut self.kind, i, *name);
                    desk.probes.mark(&format!("film.{}", if ending.is_empty() { "folder" } else { ending }), &shown);
                }
            });
            ui.end_row();
            size(ui, &mut self.size, window);
            ui.label("Pictures per second").on_hover_text("Of the film [1/s]. The simulation is not changed");
            ui.add(egui::DragValue::new(&mut self.fps).range(1..=240)).on_hover_text("Of the film [1/s]");
            ui.end_row();
            let hint = "Simulated seconds per second of the film: 0.1 is slow motion";
            ui.label("Speed").on_hover_text(hint);
            let speed = egui::DragValue::new(&mut self.speed).range(1e-3..=1e3).speed(0.01).suffix(" \u{d7}");
            ui.add(speed).on_hover_text(hint);
            ui.end_row();
            ui.label("From").on_hover_text("Simulated time of the first picture [s]");
            let step = ((last - first) / 200.0).max(1e-6);
            ui.add(egui::DragValue::new(&mut from).range(first..=last).speed(step).suffix(" s").max_decimals(4));
            ui.end_row();
            ui.label("To").on_hover_text("Simulated time of the end [s]");
            ui.add(egui::DragValue::new(&mut to).range(from..=last).speed(step).suffix(" s").max_decimals(4));
            ui.end_row();
        });
        if !(whole && (from, to) == (first, last)) {
            self.range = Some((from, to.max(from)));
        }
        let take = self.take(desk, PathBuf::new());
        let (pictures, seconds) = (take.pictures(), take.pictures() as f64 / f64::from(self.fps));
        let fits = pictures <= MOST_PICTURES;
        let text = format!(
            "{} pictures, {} s of film. Look and camera are those of the window.",
            count(pictures),
            brief(seconds)
        );
        ui.add_space(4.0);
        ui.add(egui::Label::new(text).wrap());
        if !fits {
            ui.colored_label(
                ui.visuals().error_fg_color,
                format!("A film may have {} pictures.", count(MOST_PICTURES)),
            );
        }
        ui.add_space(6.0);
        let save = ui
            .add_enabled(fits, egui::Button::new("Save..."))
            .on_hover_text("Ask for the file, and make the film in the background");
        desk.probes.mark("film.save", &save);
        save.clicked()
    }
}

fn first_kind() -> usize {
    if cfg!(feature = "mp4") { 0 } else { 1 }
}

/// A row that asks for a size.
fn size(ui: &mut egui::Ui, size: &mut (u32, u32), window: (u32, u32)) {
    ui.label("Size").on_hover_text("Width and height [pixels]");
    ui.horizontal(|ui| {
        ui.add(egui::DragValue::new(&mut size.0).range(1..=LARGEST)).on_hover_text("Width [pixels]");
        ui.label("\u{d7}");
        ui.add(egui::DragValue::new(&mut size.1).range(1..=LARGEST)).on_hover_text("Height [pixels]");
        egui::ComboBox::from_id_salt("size").selected_text("choose").width(84.0).show_ui(ui, |ui| {
            ui.selectable_value(size, window, format!("as in the window: {} \u{d7} {}", window.0, window.1));
            for (w, h) in SIZES {
                ui.selectable_value(size, (w, h), format!("{w} \u{d7} {h}"));
            }
        });
    });
    ui.end_row();
}
