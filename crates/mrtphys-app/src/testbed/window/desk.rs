//! What all parts of the window share.

use super::action::Action;
use super::plot::Trace;
use super::probe::Probes;
use super::seeing::Seeing;
use crate::testbed::session::{Command, Report, Session, Wish};
use eframe::egui;
use mrtphys::BodyId;
use mrtphys_scene::{Diagnostics, Loaded, Scene};
use mrtphys_view::{Camera, Look};
use std::cell::Cell;
use std::path::PathBuf;
use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering::Relaxed};

/// The state of the window that is not one part's own.
pub struct Desk {
    /// what is being simulated
    pub session: Session,
    /// the name it was opened under: a gallery scene's, or a file's
    pub name: String,
    /// the file it came from, for reload and save
    pub path: Option<PathBuf>,
    /// how the picture looks
    pub look: Look,
    /// from where; the viewport moves it
    pub camera: Camera,
    /// what is drawn over the bodies, and how the user looks at them
    pub seeing: Seeing,
    /// the body whose properties are shown
    pub selected: Option<BodyId>,
    /// what reports are to contain: empty at the beginning of every picture, and whoever needs something sets it
    pub wish: Wish,
    /// what the program is to do when all parts have been shown
    pub actions: Vec<Action>,
    /// counts the scenes that were opened: what belongs to the last one is forgotten when it changes
    pub opened: u64,
    /// what is to be said to the user; shown until it is dismissed
    pub messages: Vec<Message>,
    /// whether the keys pressed now are somebody else's than the picture's: a question is open, or a number was being typed
    pub keys_taken: bool,
    /// where named controls are
    pub probes: Probes,
    /// what happened since the scene was opened, for plots
    pub trace: Trace,
    /// what was wished for last
    sent: Wish,
    /// changes by hand since the scene was opened
    changes: Cell<u64>,
    /// how many of them are saved: set by whoever has written the scene
    saved: Arc<AtomicU64>,
}

/// Something to be said.
#[derive(Clone, Debug, PartialEq)]
pub struct Message {
    /// whether something went wrong
    pub is_error: bool,
    /// what; may have several lines
    pub text: String,
}

impl Desk {
    /// A session on the desk.
    pub fn new(session: Session, name: String, path: Option<PathBuf>) -> Desk {
        let camera = session.report().sides[0].shot.stage.camera();
        Desk {
            session,
            name,
            path,
            look: Look::default(),
            camera,
            seeing: Seeing::default(),
            selected: None,
            wish: Wish::default(),
            actions: Vec::new(),
            opened: 0,
            messages: Vec::new(),
            keys_taken: false,
            probes: Probes::default(),
            trace: Trace::default(),
            sent: Wish::default(),
            changes: Cell::default(),
            saved: Arc::default(),
        }
    }

    /// Puts another session on the desk. The look stays, the camera is the new scene's.
    pub fn replace(&mut self, session: Session, name: String, path: Option<PathBuf>) {
        let old = std::mem::replace(&mut self.session, session);
        // It ends with the step that it is making; nobody waits for that.
        std::thread::spawn(move || drop(old));
        self.camera = self.session.report().sides[0].shot.stage.camera();
        (self.name, self.path, self.selected) = (name, path, None);
        (self.sent, self.opened) = (Wish::default(), self.opened + 1);
        self.trace.clear();
        (self.changes, self.saved) = (Cell::default(), Arc::default());
    }

    /// The newest report.
    pub fn report(&self) -> &Report {
        self.session.report()
    }

    /// Steers the session.
    pub fn send(&self, command: Command) {
        self.session.send(command);
    }

    /// Changes bodies or fields by hand: what would have to be made again if it were not saved. `structural` as for
    /// [`Session::edit`].
    pub fn edit(&self, structural: bool, change: impl Fn(&mut Loaded) -> Result<(), String> + Send + 'static) {
        self.changes.set(self.changes.get() + 1);
        self.session.edit(structural, change);
    }

    /// Whether there are changes by hand that are not saved.
    pub fn is_unsaved(&self) -> bool {
        self.saved.load(Relaxed) < self.changes.get()
    }

    /// To be called when the present state has been written: what was changed until now is saved.
    pub fn when_saved(&self) -> impl FnOnce() + Send + 'static {
        let (changes, saved) = (self.changes.get(), self.saved.clone());
        move || {
            saved.fetch_max(changes, Relaxed);
        }
    }

    /// Before the parts are shown: takes the newest report, and forgets what the last picture asked for.
    pub fn begin(&mut self) {
        if self.session.poll() {
            self.trace.extend(&self.session.report().sides[0].samples);
        }
        self.wish = Wish { selected: self.selected, ..Wish::default() };
        self.probes.clear();
    }

    /// After the parts were shown: asks for what they need.
    pub fn end(&mut self) {
        if self.wish != self.sent {
            self.sent = self.wish.clone();
            self.session.send(Command::Wish(self.wish.clone()));
        }
    }

    /// Says that something was done.
    pub fn say(&mut self, text: impl Into<String>) {
        self.messages.push(Message { is_error: false, text: text.into() });
    }

    /// Says that something went wrong.
    pub fn complain(&mut self, text: impl Into<String>) {
        self.messages.push(Message { is_error: true, text: text.into() });
    }
}

/// Starts a session that wakes the window. May take long: not for the thread that draws.
///
/// # Errors
/// The scene's world cannot be made.
pub fn start(scene: Scene, context: &egui::Context) -> Result<Session, Diagnostics> {
    let wake = context.clone();
    Session::start(scene, move || wake.request_repaint())
}
