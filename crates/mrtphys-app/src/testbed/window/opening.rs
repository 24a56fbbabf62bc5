//! Opening a scene: read and built on a thread of its own, so that neither the picture nor the old scene waits for it.

use super::desk;
use crate::testbed::session::Session;
use eframe::egui;
use mrtphys_scene::{Diagnostics, Scene, gallery_scene};
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::sync::mpsc::{self, Receiver, TryRecvError};
use std::time::{Duration, Instant, SystemTime};

/// Between two looks at the file of the scene.
const LOOK_EVERY: Duration = Duration::from_secs(1);

/// What the options of the command line change about a scene.
pub type Changes = Arc<dyn Fn(&mut Scene) + Send + Sync>;

/// Where a scene comes from.
#[derive(Clone, Debug, PartialEq)]
pub enum Origin {
    /// the gallery, by its name
    Gallery(String),
    /// a file
    File(PathBuf),
}

impl Origin {
    /// What it is called.
    pub fn name(&self) -> String {
        match self {
            Origin::Gallery(name) => name.clone(),
            Origin::File(path) => path.display().to_string(),
        }
    }

    /// The file, if it is one.
    pub fn path(&self) -> Option<&Path> {
        match self {
            Origin::Gallery(_) => None,
            Origin::File(path) => Some(path),
        }
    }

    /// Reads the scene.
    ///
    /// # Errors
    /// What is wrong with it, and where.
    pub fn read(&self) -> Result<Scene, Diagnostics> {
        match self {
            Origin::File(path) => Scene::load(path),
            // A name that is not in the gallery is no valid text either: the error says so.
            Origin::Gallery(name) => Scene::from_text(name, gallery_scene(name).unwrap_or_default()),
        }
    }
}

/// What came of it.
pub struct Opened {
    /// where it comes from
    pub origin: Origin,
    /// whether it is the same scene again: the camera stays, and it runs or stands as before
    pub again: bool,
    /// a session that stands still, or what is wrong with the scene
    pub session: Result<Session, Diagnostics>,
}

/// A scene that is being opened.
pub struct Opening {
    origin: Origin,
    again: bool,
    since: Instant,
    receiver: Receiver<Result<Session, Diagnostics>>,
}

impl Opening {
    /// Begins.
    pub fn new(origin: Origin, again: bool, changes: Option<Changes>, context: &egui::Context) -> Opening {
        let (sender, receiver) = mpsc::channel();
        let (from, context) = (origin.clone(), context.clone());
        std::thread::spawn(move || {
            let session = from.read().and_then(|mut scene| {
                if let Some(changes) = changes {
                    changes(&mut scene);
                }
                desk::start(scene, &context)
            });
            // Nobody listens any more where another scene was chosen meanwhile.
            let _ = sender.send(session);
            context.request_repaint();
        });
        Opening { origin, again, since: Instant::now(), receiver }
    }

    /// What is being opened, and for how long.
    pub fn progress(&self) -> (String, Duration) {
        (self.origin.name(), self.since.elapsed())
    }

    /// The result, once it is there.
    pub fn poll(&self) -> Option<Opened> {
        let session = match self.receiver.try_recv() {
            Ok(session) => session,
            Err(TryRecvError::Empty) => return None,
            Err(TryRecvError::Disconnected) => {
                let message = "the scene could not be opened: its thread broke off".to_string();
                Err(mrtphys_scene::Diagnostic::without_place(&self.origin.name(), message).into())
            }
        };
        Some(Opened { origin: self.origin.clone(), again: self.again, session })
    }
}

/// Notices that a file has changed on disk.
#[derive(Debug, Default)]
pub struct Watch {
    path: Option<PathBuf>,
    seen: Option<Trace>,
    looked: Option<Instant>,
}

/// What a file's folder says about it.
type Trace = (SystemTime, u64);

fn trace(path: &Path) -> Option<Trace> {
    let meta = std::fs::metadata(path).ok()?;
    Some((meta.modified().ok()?, meta.len()))
}

impl Watch {
    /// Watches another file, or none, as it is now.
    pub fn set(&mut self, path: Option<&Path>) {
        self.path = path.map(Path::to_path_buf);
        self.seen = path.and_then(trace);
        self.looked = None;
    }

    /// Whether the file has changed since the last time this said so. Looks no more than once a second. A file that is away
    /// for a moment, as editors leave it, has not changed yet.
    pub fn changed(&mut self, now: Instant) -> bool {
        let Some(path) = &self.path else { return false };
        if self.looked.is_some_and(|at| now.saturating_duration_since(at) < LOOK_EVERY) {
            return false;
        }
        self.looked = Some(now);
        let found = trace(path);
        let changed = found.is_some() && found != self.seen;
        if changed {
            self.seen = found;
        }
        changed
    }

    /// How long until the next look.
    pub fn next_look(&self) -> Option<Duration> {
        self.path.as_ref().map(|_| LOOK_EVERY)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_change_of_the_file_is_seen_once() {
        let folder = std::env::temp_dir().join(format!("mrtphys-watch-{}", std::process::id()));
        std::fs::create_dir_all(&folder).unwrap();
        let path = folder.join("scene.toml");
        std::fs::write(&path, "format = 1").unwrap();
        let (mut watch, mut now) = (Watch::default(), Instant::now());
        let mut look = |watch: &mut Watch| {
            now += LOOK_EVERY;
            watch.changed(now)
        };
        assert!(!look(&mut watch), "nothing is watched");
        watch.set(Some(&path));
        assert!(!look(&mut watch));
        std::fs::write(&path, "format = 1\ntitle = 'x'").unwrap();
        assert!(look(&mut watch));
        assert!(!look(&mut watch), "it is said once");
        std::fs::remove_file(&path).unwrap();
        assert!(!look(&mut watch), "it may be on its way");
        std::fs::write(&path, "format = 1\ntitle = 'other'").unwrap();
        assert!(look(&mut watch));
        std::fs::write(&path, "format = 1").unwrap();
        assert!(!watch.changed(now), "not twice in a second");
        std::fs::remove_dir_all(folder).unwrap();
    }

    #[test]
    fn an_origin_reads_what_it_names() {
        assert!(Origin::Gallery("cradle".into()).read().is_ok());
        assert!(Origin::Gallery("no such scene".into()).read().is_err());
        let missing = Origin::File("/no/such/scene.toml".into());
        assert!(missing.read().unwrap_err().to_string().contains("/no/such/scene.toml"));
    }
}
