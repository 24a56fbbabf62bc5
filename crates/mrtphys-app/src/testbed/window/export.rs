//! What a picture or a film is to be like, before the file is asked for.

use super::desk::Desk;
use super::drawing::View;
use super::files::Purpose;
use super::format::{brief, count};
use super::quantity::Entry;
use super::reel::{FILM_KINDS, MOST_PICTURES, Take};
use crate::testbed::session::Command;
use eframe::egui;
use mrtphys::Vec3;
use mrtphys_view::Look;
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

/// What is in the recording.
struct Found {
    /// simulated time of the first and the last frame \[s\]
    times: (f64, f64),
    has_rival: bool,
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
    /// whether there is a rival in the recording, and whether it is to be in the film
    rival: (bool, bool),
    asked: Option<Receiver<Found>>,
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
            rival: (false, true),
            asked: None,
        }
    }

    /// Opens the film's window, on what is recorded up to now.
    pub fn open_film(&mut self, context: &egui::Context, desk: &Desk) {
        (self.film, self.range) = (true, None);
        let (sender, receiver) = mpsc::channel();
        let context = context.clone();
        desk.send(Command::Ask(Box::new(move |studio| {
            let frames = (studio.frames)();
            if let (Some(first), Some(last)) = (frames.first(), frames.last()) {
                let has_rival = frames.iter().any(|f| f.rival.is_some());
                let _ = sender.send(Found { times: (first.shot.time, last.shot.time), has_rival });
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

    /// The film that was chosen, into this file. `follow`: where the selected body is in the window, if the camera follows it.
    pub fn take(&self, desk: &Desk, follow: Option<Vec3>, path: PathBuf) -> Take {
        let (from, to) = self.range.unwrap_or(self.recorded);
        let (fps, speed, (w, h)) = (self.fps, self.speed, self.size);
        // H.264 has no odd sizes.
        let size = if FILM_KINDS[self.kind].0 == "mp4" { ((w & !1).max(2), (h & !1).max(2)) } else { (w, h) };
        let look = Look { smooth: Some(true), ..desk.look };
        let (camera, sight, selected) = (desk.camera, desk.seeing.sight, desk.selected);
        let view = View { camera, look, sight, selected, spring: None, size, part: 1.0 };
        Take { from, to, fps, speed, view, follow, rival: self.rival == (true, true), path }
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
            (self.recorded, self.rival.0, self.asked) = (found.times, found.has_rival, None);
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
            Entry::whole("", 1..=240, "Of the film [1/s]").count(ui, &mut self.fps);
            ui.end_row();
            let hint = "Simulated seconds per second of the film: 0.1 is slow motion";
            ui.label("Speed").on_hover_text(hint);
            let entry = Entry { range: 1e-3..=1e3, ..Entry::any("\u{d7}", 1.0, hint) };
            self.speed = entry.show(ui, self.speed).unwrap_or(self.speed);
            ui.end_row();
            let mut time = |label: &str, hint: &str, range: std::ops::RangeInclusive<f64>, t: &mut f64| {
                ui.label(label).on_hover_text(hint);
                let entry = Entry { range, ..Entry::any("s", last - first, hint) };
                *t = entry.show(ui, *t).unwrap_or(*t);
                ui.end_row();
            };
            time("From", "Simulated time of the first picture", first..=last, &mut from);
            time("To", "Simulated time of the end", from..=last, &mut to);
            if self.rival.0 {
                ui.label("Rival");
                ui.checkbox(&mut self.rival.1, "beside the world")
                    .on_hover_text("The world at the left, its rival at the right, from where the comparison began");
                ui.end_row();
            }
        });
        if !(whole && (from, to) == (first, last)) {
            self.range = Some((from, to.max(from)));
        }
        let take = self.take(desk, None, PathBuf::new());
        let (pictures, seconds) = (take.pictures(), take.pictures() as f64 / f64::from(self.fps));
        let fits = pictures <= MOST_PICTURES;
        let text = format!(
            "{} pictures, {} s of film. Look and camera are those of the window; names and legends are left out.",
            count(pictures),
            brief(seconds)
        );
        ui.add_space(4.0);
        ui.add(egui::Label::new(text).wrap());
        if let Some(text) = missing(&desk.seeing.sight.unrecorded()) {
            desk.probes.say(|| "film.missing".into(), &text);
            ui.add(egui::Label::new(egui::RichText::new(text).color(ui.visuals().warn_fg_color)).wrap());
        }
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

/// What is to be said of what is in the window and cannot be in a film.
fn missing(names: &[&str]) -> Option<String> {
    (!names.is_empty()).then(|| {
        let names = names.join(", ").to_lowercase();
        format!("Not in the film, because the recording has only where the bodies were: {names}. A picture has them.")
    })
}

fn first_kind() -> usize {
    if cfg!(feature = "mp4") { 0 } else { 1 }
}

/// A row that asks for a size.
fn size(ui: &mut egui::Ui, size: &mut (u32, u32), window: (u32, u32)) {
    ui.label("Size").on_hover_text("Width and height [pixels]");
    ui.horizontal(|ui| {
        Entry::whole("", 1..=LARGEST, "Width [pixels]").count(ui, &mut size.0);
        ui.label("\u{d7}");
        Entry::whole("", 1..=LARGEST, "Height [pixels]").count(ui, &mut size.1);
        egui::ComboBox::from_id_salt("size").selected_text("choose").width(84.0).show_ui(ui, |ui| {
            ui.selectable_value(size, window, format!("as in the window: {} \u{d7} {}", window.0, window.1));
            for (w, h) in SIZES {
                ui.selectable_value(size, (w, h), format!("{w} \u{d7} {h}"));
            }
        });
    });
    ui.end_row();
}
