//! What all parts of the window share.

use crate::testbed::session::{Command, Session};
use eframe::egui;
use mrtphys::BodyId;
use mrtphys_scene::{Diagnostics, Scene};
use mrtphys_view::{Camera, Look};
use std::path::PathBuf;

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
    /// the body whose properties are shown
    pub selected: Option<BodyId>,
    /// what is to be said to the user; shown until it is dismissed
    pub messages: Vec<Message>,
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
    /// A scene on the desk, standing still.
    ///
    /// # Errors
    /// The scene's world cannot be made.
    pub fn new(scene: Scene, context: &egui::Context) -> Result<Desk, Diagnostics> {
        let name = scene.source.name.to_string();
        let session = start(scene, context)?;
        let camera = session.report().sides[0].shot.stage.camera();
        let look = Look::default();
        Ok(Desk { session, name, path: None, look, camera, selected: None, messages: Vec::new() })
    }

    /// Puts another scene on the desk, running. The look stays, the camera is the new scene's.
    ///
    /// # Errors
    /// The scene's world cannot be made; the old one goes on.
    pub fn open(&mut self, scene: Scene, path: Option<PathBuf>, context: &egui::Context) -> Result<(), Diagnostics> {
        let name = scene.source.name.to_string();
        self.session = start(scene, context)?;
        self.camera = self.session.report().sides[0].shot.stage.camera();
        (self.name, self.path, self.selected) = (name, path, None);
        self.session.send(Command::Go(true));
        Ok(())
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

fn start(scene: Scene, context: &egui::Context) -> Result<Session, Diagnostics> {
    let wake = context.clone();
    Session::start(scene, move || wake.request_repaint())
}
