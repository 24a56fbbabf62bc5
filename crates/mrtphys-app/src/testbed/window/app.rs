//! The testbed's window as a whole: what is where, and what the menus and keys do.

use super::action::Action;
use super::desk::Desk;
use super::export::Export;
use super::files::{Files, Purpose};
use super::gallery::Gallery;
use super::help::Help;
use super::jobs::Jobs;
use super::leaving::{Answer, Leaving, losses};
use super::messages::Messages;
use super::opening::{Changes, Opened, Opening, Origin, Watch};
use super::panel::Panel;
use super::pending::Pending;
use super::preferences::Preferences;
use super::status::{Beside, Status};
use super::transport::Transport;
use super::trouble::Trouble;
use super::viewport::Viewport;
use super::{keys, menu, save};
use crate::testbed::session::{Command, Session};
use eframe::egui;
use mrtphys_view::Theme;
use std::path::PathBuf;
use std::time::{Duration, Instant};

/// How the window begins.
pub struct Beginning {
    /// the scene's session, standing still
    pub session: Session,
    /// where it comes from
    pub origin: Origin,
    /// what the command line changes about it
    pub changes: Option<Changes>,
    /// whether the gallery is shown
    pub gallery: bool,
    /// whether it stands still
    pub paused: bool,
    /// a file for tests
    pub status: Option<PathBuf>,
}

/// The program.
pub struct Testbed {
    pub(super) desk: Desk,
    panel: Panel,
    pub(super) viewport: Viewport,
    transport: Transport,
    gallery: Gallery,
    trouble: Trouble,
    help: Help,
    messages: Messages,
    pub(super) jobs: Jobs,
    files: Files,
    pub(super) export: Export,
    pub(super) preferences: Preferences,
    saved: Preferences,
    origin: Origin,
    /// of the scene that the program was started with
    changes: Option<(Origin, Changes)>,
    opening: Option<Opening>,
    leaving: Leaving,
    /// the window may close
    may_close: bool,
    /// a text or a number was being typed in the last picture
    typing: bool,
    watch: Watch,
    status: Option<Status>,
    going: Pending<bool>,
    session_trouble: Option<String>,
    side_panel: bool,
    below: bool,
    /// where the picture is
    picture: egui::Rect,
    driver: String,
    window_title: String,
}

impl Testbed {
    /// Made once, with the window's graphics device.
    pub fn new(
        cc: &eframe::CreationContext<'_>,
        begin: Beginning,
    ) -> Result<Testbed, Box<dyn std::error::Error + Send + Sync>> {
        let name = begin.origin.name();
        let path = begin.origin.path().map(std::path::Path::to_path_buf);
        let mut desk = Desk::new(begin.session, name, path.clone());
        desk.probes = super::probe::Probes::new(begin.status.is_some());
        let render = cc.wgpu_render_state.as_ref().ok_or("the window has no graphics device")?;
        let info = render.adapter.get_info();
        let viewport = Viewport::new(render, &desk)?;
        let mut preferences = Preferences::load();
        let saved = preferences.clone();
        let mut watch = Watch::default();
        watch.set(path.as_deref());
        preferences.recent_of(path.as_deref());
        desk.look.theme = if preferences.dark { Theme::Dark } else { Theme::Light };
        super::appearance::apply(&cc.egui_ctx, &preferences);
        if !begin.paused {
            desk.send(Command::Go(true));
        }
        Ok(Testbed {
            desk,
            panel: Panel::new(),
            viewport,
            transport: Transport::default(),
            gallery: Gallery::new(begin.gallery),
            trouble: Trouble::default(),
            help: Help::default(),
            messages: Messages::default(),
            jobs: Jobs::default(),
            files: Files::default(),
            export: Export::new(),
            preferences,
            saved,
            changes: begin.changes.map(|c| (begin.origin.clone(), c)),
            origin: begin.origin,
            opening: None,
            leaving: Leaving::default(),
            may_close: false,
            typing: false,
            watch,
            status: begin.status.map(Status::new),
            going: Pending::default(),
            session_trouble: None,
            side_panel: true,
            below: false,
            picture: egui::Rect::ZERO,
            window_title: String::new(),
            driver: format!("{} ({:?})", info.name, info.backend),
        })
    }

    /// What happened since the last picture, outside of the window.
    fn take_news(&mut self, context: &egui::Context) {
        if let Some(opened) = self.opening.as_ref().and_then(Opening::poll) {
            self.opening = None;
            self.opened(opened);
        }
        self.jobs.poll(&mut self.desk.messages);
        let trouble = self.desk.report().trouble.clone();
        if trouble != self.session_trouble {
            self.desk.messages.extend(trouble.clone().map(|text| super::desk::Message { is_error: true, text }));
            self.session_trouble = trouble;
        }
        if self.watch.changed(Instant::now()) && self.preferences.auto_reload {
            self.desk.actions.push(Action::Reload);
        }
        for file in context.input(|i| i.raw.dropped_files.clone()) {
            self.desk.actions.push(Action::Open(file.path().to_path_buf()));
        }
        if let Some((purpose, path)) = self.files.show(context, &mut self.desk.probes) {
            self.chosen(context, purpose, path);
        }
        if let Some(asked) = self.export.show(context, &mut self.desk, pixels(context, self.picture)) {
            let name = super::files::stem(&self.desk.name);
            self.files.ask(self.export.purpose(asked), &name, self.desk.path.as_deref());
        }
    }

    fn opened(&mut self, opened: Opened) {
        match opened.session {
            Err(found) => self.trouble.set(opened.origin, found),
            Ok(session) => {
                let (camera, running) = (self.desk.camera, self.desk.report().running);
                let path = opened.origin.path().map(std::path::Path::to_path_buf);
                self.desk.replace(session, opened.origin.name(), path);
                if opened.again {
                    self.desk.camera = camera;
                    self.desk.say(format!("{}: read again", opened.origin.name()));
                }
                if running || !opened.again {
                    self.desk.send(Command::Go(true));
                }
                self.origin = opened.origin;
                self.watch.set(self.origin.path());
                self.preferences.recent_of(self.origin.path());
                self.trouble.clear();
                (self.session_trouble, self.going) = (None, Pending::default());
            }
        }
    }

    /// The window is called after the scene.
    fn name_window(&mut self, context: &egui::Context) {
        let title = format!("{} - mrtphys", super::files::stem(&self.desk.name));
        if title != self.window_title {
            self.window_title.clone_from(&title);
            context.send_viewport_cmd(egui::ViewportCommand::Title(title));
        }
    }

    fn begin_opening(&mut self, context: &egui::Context, origin: Origin, again: bool) {
        let own = self.changes.as_ref().filter(|(of, _)| *of == origin).map(|(_, changes)| changes.clone());
        self.opening = Some(Opening::new(origin, again, own, context));
    }

    /// A file was chosen for something.
    fn chosen(&mut self, context: &egui::Context, purpose: Purpose, path: PathBuf) {
        match purpose {
            Purpose::Open => self.desk.actions.push(Action::Open(path)),
            Purpose::LoadSnapshot => save::go_on(&self.desk, path),
            Purpose::SaveScene => save::scene(self, context, path),
            Purpose::SaveSnapshot => save::snapshot(self, context, path),
            Purpose::Picture => save::picture(self, context, path),
            Purpose::Film(_) => save::film(self, context, path),
        }
    }

    /// Does what was asked for.
    fn act(&mut self, context: &egui::Context, action: Action) {
        match action {
            Action::Go => {
                let now = Instant::now();
                let go = !self.going.shown(self.desk.report().running, now);
                self.going.ask(go, now);
                self.desk.send(Command::Go(go));
            }
            Action::Step => self.desk.send(Command::Frame),
            Action::PhysicalStep => self.desk.send(Command::Step),
            Action::Back => self.desk.send(Command::Back),
            Action::Restart => self.desk.send(Command::Restart),
            Action::First => self.desk.send(Command::Seek(self.desk.report().timeline.first)),
            Action::Last => self.desk.send(Command::Seek(self.desk.report().timeline.last)),
            Action::Open(_) | Action::OpenGallery(_) if self.desk.is_unsaved() => self.leaving.ask(action),
            other => self.open(context, other),
        }
    }

    /// What concerns files.
    fn open(&mut self, context: &egui::Context, action: Action) {
        match action {
            Action::OpenFile => self.files.ask(Purpose::Open, "", self.desk.path.as_deref()),
            Action::Open(path) => match super::files::sort_of(&path) {
                super::files::Sort::Snapshot => save::go_on(&self.desk, path),
                super::files::Sort::Scene => self.begin_opening(context, Origin::File(path), false),
            },
            Action::OpenGallery(name) => self.begin_opening(context, Origin::Gallery(name.into()), false),
            Action::Reload => {
                // What is wrong is what the user has just corrected.
                let origin = self.trouble.origin().unwrap_or(&self.origin).clone();
                let again = origin == self.origin;
                self.begin_opening(context, origin, again);
            }
            Action::SaveScene => self.ask(Purpose::SaveScene),
            Action::SaveSnapshot => self.ask(Purpose::SaveSnapshot),
            Action::LoadSnapshot => self.ask(Purpose::LoadSnapshot),
            other => self.arrange(context, other),
        }
    }

    fn ask(&mut self, purpose: Purpose) {
        let name = super::files::stem(&self.desk.name);
        self.files.ask(purpose, &name, self.desk.path.as_deref());
    }

    /// What concerns the window only.
    fn arrange(&mut self, context: &egui::Context, action: Action) {
        match action {
            Action::Gallery => self.gallery.open = !self.gallery.open,
            Action::Screenshot => self.export.picture = !self.export.picture,
            Action::Film => self.export.open_film(context, &self.desk),
            Action::Reveal(name) => {
                self.side_panel = true;
                self.panel.reveal(name);
            }
            Action::Selected if self.side_panel => self.panel.reveal("body"),
            Action::Selected => {}
            Action::SidePanel => self.side_panel = !self.side_panel,
            Action::Below => self.below = !self.below,
            Action::ResetCamera => self.desk.camera = self.desk.report().sides[0].shot.stage.camera(),
            Action::FitCamera => {
                let bounds = self.desk.report().sides[0].shot.stage.bounds();
                self.desk.camera.fit(&bounds, f64::from(self.picture.aspect_ratio()));
            }
            Action::Theme => self.preferences.dark = !self.preferences.dark,
            Action::Scale(steps) => self.preferences.rescale(steps),
            Action::Help => self.help.open = !self.help.open,
            Action::About => self.help.about = !self.help.about,
            Action::Quit if self.may_close => context.send_viewport_cmd(egui::ViewportCommand::Close),
            // It is asked, unless nothing would be lost.
            Action::Quit => self.leaving.ask(Action::Quit),
            _ => {}
        }
    }

    /// Whether something has to be answered before anything else.
    fn is_asking(&self) -> bool {
        self.files.is_open() || self.leaving.is_open()
    }

    /// Escape closes the foremost of the windows. Whether there was one.
    fn escape(&mut self, context: &egui::Context) -> bool {
        if !context.input(|i| i.key_pressed(egui::Key::Escape)) {
            return false;
        }
        if self.trouble.origin().is_some() {
            self.trouble.clear();
            return true;
        }
        let windows = [
            &mut self.help.about,
            &mut self.help.open,
            &mut self.export.film,
            &mut self.export.picture,
            &mut self.gallery.open,
        ];
        let foremost = windows.into_iter().find(|open| **open);
        foremost.map(|open| *open = false).is_some()
    }

    /// Asks before something is lost.
    fn ask_before_leaving(&mut self, context: &egui::Context) {
        let losses = losses(self.desk.is_unsaved(), self.jobs.count());
        let closes = context.input(|i| i.viewport().close_requested());
        if closes && !self.may_close && !losses.is_empty() {
            context.send_viewport_cmd(egui::ViewportCommand::CancelClose);
            self.leaving.ask(Action::Quit);
        }
        match self.leaving.show(context, &mut self.desk.probes, &losses) {
            Some(Answer::Go(Action::Quit)) => {
                self.may_close = true;
                self.desk.actions.push(Action::Quit);
            }
            Some(Answer::Go(action)) => self.open(context, action),
            Some(Answer::Save) => self.desk.actions.push(Action::SaveScene),
            None => {}
        }
    }

    /// Preferences that were changed take effect, and are remembered.
    fn remember(&mut self, context: &egui::Context) {
        if self.preferences == self.saved {
            return;
        }
        super::appearance::apply(context, &self.preferences);
        self.desk.look.theme = if self.preferences.dark { Theme::Dark } else { Theme::Light };
        self.saved = self.preferences.clone();
        if let Err(why) = self.preferences.save() {
            self.desk.complain(format!("preferences were not saved: {why}"));
        }
    }

    /// The parts that stand still: menu, player, panel, picture.
    fn lay_out(&mut self, ui: &mut egui::Ui, frame: &mut eframe::Frame) {
        let sections: Vec<_> = self.panel.titles().collect();
        let below = self.panel.has_below().then_some(self.below);
        let facts = menu::Facts { side_panel: self.side_panel, below, sections: &sections };
        egui::Panel::top("menu").show(ui, |ui| menu::show(ui, &mut self.desk, &mut self.preferences, &facts));
        egui::Panel::bottom("transport").exact_size(38.0).show(ui, |ui| self.transport.show(ui, &mut self.desk));
        if self.side_panel {
            egui::Panel::right("panel")
                .default_size(320.0)
                .size_range(310.0..=520.0)
                .show(ui, |ui| self.panel.show(ui, &mut self.desk));
        }
        if self.below && self.panel.has_below() {
            let room = ui.available_height();
            egui::Panel::bottom("below")
                .resizable(true)
                .default_size(0.32 * room)
                .size_range(80.0..=0.7 * room)
                .show(ui, |ui| self.panel.show_below(ui, &mut self.desk));
        }
        self.picture = ui.available_rect_before_wrap();
        if let Some(render) = frame.wgpu_render_state() {
            egui::CentralPanel::no_frame().show(ui, |ui| self.viewport.show(ui, render, &mut self.desk));
        }
    }

    /// The parts that float.
    fn float(&mut self, context: &egui::Context) {
        self.gallery.show(context, &mut self.desk);
        self.help.show(context, &self.driver);
        self.trouble.show(context, &mut self.desk);
        let mut said = std::mem::take(&mut self.desk.messages);
        self.messages.take(&mut said, Instant::now());
        self.desk.messages = said;
        self.messages.show(context, self.picture);
        self.jobs.show(context, self.picture);
        if let Some(opening) = &self.opening {
            let (name, since) = opening.progress();
            // What is done at once needs no word.
            if since > Duration::from_millis(300) {
                let area = egui::Area::new(egui::Id::unique("opening")).order(egui::Order::Foreground);
                area.pivot(egui::Align2::CENTER_CENTER).fixed_pos(self.picture.center()).show(context, |ui| {
                    egui::Frame::popup(ui.style()).show(ui, |ui| {
                        ui.horizontal(|ui| {
                            ui.spinner();
                            ui.label(format!("Opening {name}"));
                        });
                    });
                });
            }
            context.request_repaint_after(Duration::from_millis(100));
        }
    }

    fn write_status(&mut self, context: &egui::Context) {
        let Some(status) = &mut self.status else { return };
        let windows = [
            ("gallery", self.gallery.open),
            ("help", self.help.open),
            ("about", self.help.about),
            ("picture", self.export.picture),
            ("film", self.export.film),
            ("files", self.files.is_open()),
            ("leaving", self.leaving.is_open()),
            ("trouble", self.trouble.origin().is_some()),
        ];
        let beside = Beside {
            trouble: self.trouble.text(),
            messages: self.messages.texts().map(String::from).collect(),
            busy: self.jobs.count() + usize::from(self.opening.is_some()),
            thumbnails: self.gallery.drawn(),
            windows: windows.iter().filter(|w| w.1).map(|w| w.0).collect(),
        };
        status.write(context, &mut self.desk, &beside);
    }
}

/// A place's size on the screen \[pixels\].
fn pixels(context: &egui::Context, rect: egui::Rect) -> (u32, u32) {
    let size = rect.size() * context.pixels_per_point();
    (size.x.round().max(1.0) as u32, size.y.round().max(1.0) as u32)
}

impl eframe::App for Testbed {
    fn ui(&mut self, ui: &mut egui::Ui, frame: &mut eframe::Frame) {
        let context = ui.ctx().clone();
        self.desk.begin();
        self.take_news(&context);
        let pressed = if self.is_asking() { Vec::new() } else { keys::pressed(&context) };
        self.desk.actions.extend(pressed);
        // While something is typed, Escape ends that.
        let taken = self.typing || self.is_asking();
        self.desk.keys_taken = taken || self.escape(&context);
        self.lay_out(ui, frame);
        self.float(&context);
        self.ask_before_leaving(&context);
        for action in std::mem::take(&mut self.desk.actions) {
            self.act(&context, action);
        }
        self.remember(&context);
        self.name_window(&context);
        self.desk.end();
        self.write_status(&context);
        self.typing = context.text_edit_focused();
        if self.messages.will_change() {
            context.request_repaint_after(Duration::from_secs(1));
        }
        if let Some(pause) = self.watch.next_look() {
            context.request_repaint_after(pause);
        }
    }
}
