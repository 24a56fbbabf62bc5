//! Asking for files: one dialog for all that is opened and saved.

use super::browser::Browser;
use super::probe::Probes;
use eframe::egui;
use std::path::{Path, PathBuf};

/// What a file is asked for.
#[derive(Clone, Debug, PartialEq)]
pub enum Purpose {
    /// a scene or a snapshot to open
    Open,
    /// where the present state goes, as a scene
    SaveScene,
    /// where the world goes
    SaveSnapshot,
    /// a snapshot to go on from
    LoadSnapshot,
    /// where the picture goes
    Picture,
    /// where the film goes: the ending, empty for a folder
    Film(&'static str),
}

/// Ending of snapshots.
pub const SNAPSHOT: &str = "snapshot";
/// How a snapshot begins.
const SNAPSHOT_MAGIC: &[u8] = b"mrtphys\0";

impl Purpose {
    fn title(&self) -> &'static str {
        match self {
            Purpose::Open => "Open a scene or a snapshot",
            Purpose::LoadSnapshot => "Go on from a snapshot",
            Purpose::SaveScene => "Save the present state as a scene",
            Purpose::SaveSnapshot => "Save a snapshot",
            Purpose::Picture => "Save the picture",
            Purpose::Film("") => "Save the film's pictures into a new folder",
            Purpose::Film(_) => "Save the film",
        }
    }

    /// Endings of the files that are shown.
    fn endings(&self) -> &'static [&'static str] {
        match self {
            Purpose::Open => &["toml", SNAPSHOT],
            Purpose::LoadSnapshot | Purpose::SaveSnapshot => &[SNAPSHOT],
            Purpose::SaveScene => &["toml"],
            Purpose::Picture => &["png"],
            Purpose::Film("gif") => &["gif"],
            Purpose::Film(_) => &["mp4"],
        }
    }

    /// The ending that a file must have to be written as what it is.
    fn ending(&self) -> Option<&'static str> {
        match self {
            Purpose::Open | Purpose::LoadSnapshot | Purpose::Film("") => None,
            Purpose::SaveScene => Some("toml"),
            Purpose::SaveSnapshot => Some(SNAPSHOT),
            Purpose::Picture => Some("png"),
            Purpose::Film(ending) => Some(ending),
        }
    }

    fn opens(&self) -> bool {
        matches!(self, Purpose::Open | Purpose::LoadSnapshot)
    }
}

/// What became of a chosen path.
#[derive(Debug, PartialEq)]
enum Chosen {
    /// it is a folder: show what is in it
    Enter(PathBuf),
    /// it is there already: ask
    Overwrite(PathBuf),
    /// this one
    Take(PathBuf),
    /// it will not do, and why
    Refuse(String),
}

/// What a path means that was typed or clicked.
fn choose(purpose: &Purpose, path: PathBuf) -> Chosen {
    if path.is_dir() {
        return Chosen::Enter(path);
    }
    if purpose.opens() {
        let missing = || Chosen::Refuse(format!("there is no file '{}'", path.display()));
        return if path.exists() { Chosen::Take(path) } else { missing() };
    }
    let path = with_ending(path, purpose.ending());
    if !path.parent().is_some_and(Path::is_dir) {
        return Chosen::Refuse(format!("there is no folder for '{}'", path.display()));
    }
    if path.exists() { Chosen::Overwrite(path) } else { Chosen::Take(path) }
}

fn has(path: &Path, ending: &str) -> bool {
    path.extension().is_some_and(|e| e.eq_ignore_ascii_case(ending))
}

fn with_ending(path: PathBuf, ending: Option<&str>) -> PathBuf {
    let Some(ending) = ending.filter(|e| !has(&path, e)) else { return path };
    let mut name = path.into_os_string();
    name.push(".");
    name.push(ending);
    name.into()
}

struct Dialog {
    purpose: Purpose,
    browser: Browser,
    name: String,
    refused: Option<String>,
    overwrite: Option<PathBuf>,
    /// the name has not had the focus yet
    fresh: bool,
}

/// The dialog.
#[derive(Default)]
pub struct Files {
    dialog: Option<Dialog>,
    /// the folder of the last file
    folder: Option<PathBuf>,
}

impl Files {
    /// Whether a file is being asked for.
    pub fn is_open(&self) -> bool {
        self.dialog.is_some()
    }

    /// Asks for a file. `name`, without an ending, is proposed for one that is to be written.
    pub fn ask(&mut self, purpose: Purpose, name: &str, scene: Option<&Path>) {
        let beside = scene.and_then(Path::parent).map(Path::to_path_buf);
        let folder = self.folder.clone().or(beside).unwrap_or_default();
        let browser = Browser::new(&folder, purpose.endings());
        let name = if purpose.opens() {
            String::new()
        } else {
            with_ending(name.into(), purpose.ending()).display().to_string()
        };
        self.dialog = Some(Dialog { purpose, browser, name, refused: None, overwrite: None, fresh: true });
    }

    /// Shows the dialog; the file, once it is chosen.
    pub fn show(&mut self, context: &egui::Context, probes: &mut Probes) -> Option<(Purpose, PathBuf)> {
        let dialog = self.dialog.as_mut()?;
        let mut chosen = None;
        let mut cancelled = false;
        let modal = egui::Modal::new(egui::Id::unique("files")).show(context, |ui| {
            let room = context.content_rect().size();
            ui.set_width((0.7 * room.x).min(620.0));
            if dialog.overwrite.is_some() {
                chosen = dialog.ask_overwrite(ui, probes);
            } else {
                (chosen, cancelled) = dialog.show(ui, probes, (0.5 * room.y).min(340.0));
            }
        });
        if let Some(path) = chosen {
            self.folder = path.parent().map(Path::to_path_buf);
            let purpose = self.dialog.take().map(|d| d.purpose);
            return purpose.map(|purpose| (purpose, path));
        }
        if cancelled || modal.should_close() {
            self.dialog = None;
        }
        None
    }
}

impl Dialog {
    fn ask_overwrite(&mut self, ui: &mut egui::Ui, probes: &mut Probes) -> Option<PathBuf> {
        let path = self.overwrite.clone()?;
        ui.heading("Overwrite?");
        ui.add(egui::Label::new(format!("'{}' is there already. What is in it will be lost.", path.display())).wrap());
        ui.add_space(8.0);
        let mut taken = None;
        ui.horizontal(|ui| {
            let yes = ui.button("Overwrite");
            probes.mark("files.overwrite", &yes);
            if yes.clicked() {
                taken = Some(path);
            }
            if ui.button("Back").clicked() {
                self.overwrite = None;
            }
        });
        taken
    }

    /// The file, and whether it was given up.
    fn show(&mut self, ui: &mut egui::Ui, probes: &mut Probes, height: f32) -> (Option<PathBuf>, bool) {
        ui.heading(self.purpose.title());
        ui.add_space(4.0);
        ui.horizontal(|ui| {
            if ui.button("Up").on_hover_text("The folder above").clicked() {
                self.browser.up();
            }
            let folder = egui::RichText::new(self.browser.folder().display().to_string()).monospace();
            ui.add(egui::Label::new(folder).truncate());
        });
        let clicked = self.list(ui, height);
        ui.add_space(4.0);
        let mut enter = false;
        ui.horizontal(|ui| {
            ui.label("Name");
            let width = ui.available_width();
            let field = ui.add(egui::TextEdit::singleline(&mut self.name).desired_width(width));
            let field = field.on_hover_text("A name in this folder, or a whole path");
            probes.mark("files.name", &field);
            probes.say(|| "files.name".into(), &self.name);
            enter = field.lost_focus() && ui.input(|i| i.key_pressed(egui::Key::Enter));
            if std::mem::take(&mut self.fresh) {
                field.request_focus();
            }
        });
        if let Some(why) = self.refused.as_ref().or(self.browser.trouble.as_ref()) {
            let text = egui::RichText::new(why).color(ui.visuals().error_fg_color);
            ui.add(egui::Label::new(text).wrap());
        }
        let mut cancelled = false;
        ui.horizontal(|ui| {
            let verb = if self.purpose.opens() { "Open" } else { "Save" };
            let named = !self.name.trim().is_empty();
            let ok = ui.add_enabled(named, egui::Button::new(verb));
            probes.mark("files.ok", &ok);
            enter |= ok.clicked();
            cancelled = ui.button("Cancel").clicked();
            let mut only = self.browser.only_these();
            let endings = self.purpose.endings().iter().map(|e| format!(".{e}")).collect::<Vec<_>>().join(", ");
            ui.checkbox(&mut only, format!("Only {endings}")).on_hover_text("Show only files of these endings");
            self.browser.show_only_these(only);
        });
        let wanted =
            if enter && !self.name.trim().is_empty() { Some(self.browser.path_of(&self.name)) } else { clicked };
        (wanted.and_then(|path| self.take(path)), cancelled)
    }

    fn take(&mut self, path: PathBuf) -> Option<PathBuf> {
        self.refused = None;
        match choose(&self.purpose, path) {
            Chosen::Take(path) => return Some(path),
            Chosen::Overwrite(path) => self.overwrite = Some(path),
            Chosen::Refuse(why) => self.refused = Some(why),
            Chosen::Enter(path) => {
                self.browser.go(&path);
                if self.purpose.opens() {
                    self.name.clear();
                }
            }
        }
        None
    }

    /// The entries; the one that was clicked: a folder at once, a file with a double click.
    fn list(&mut self, ui: &mut egui::Ui, height: f32) -> Option<PathBuf> {
        let mut chosen = None;
        let frame = egui::Frame::group(ui.style()).fill(ui.visuals().extreme_bg_color);
        frame.show(ui, |ui| {
            let line = ui.spacing().interact_size.y;
            let entries = self.browser.entries();
            let scroll =
                egui::ScrollArea::vertical().max_height(height).min_scrolled_height(height).auto_shrink([false, false]);
            scroll.show_rows(ui, line, entries.len().max(1), |ui, range| {
                if entries.is_empty() {
                    ui.weak("nothing to show here");
                }
                for entry in entries.get(range).unwrap_or_default() {
                    let text = if entry.is_file { entry.name.clone() } else { format!("{}/", entry.name) };
                    let text =
                        if entry.is_file { egui::RichText::new(text) } else { egui::RichText::new(text).strong() };
                    let shown = ui.selectable_label(entry.is_file && self.name == entry.name, text);
                    if shown.clicked() && entry.is_file {
                        self.name.clone_from(&entry.name);
                    }
                    if shown.clicked() && !entry.is_file || shown.double_clicked() {
                        chosen = Some(self.browser.folder().join(&entry.name));
                    }
                }
            });
        });
        chosen
    }
}

/// What a file is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Sort {
    /// scene text
    Scene,
    /// a world
    Snapshot,
}

/// Whether a dropped or chosen file is a scene or a snapshot: by its beginning, whatever it is called.
pub fn sort_of(path: &Path) -> Sort {
    use std::io::Read;
    let mut begin = Vec::new();
    let read = std::fs::File::open(path).and_then(|f| f.take(SNAPSHOT_MAGIC.len() as u64).read_to_end(&mut begin));
    if read.is_ok() && begin == SNAPSHOT_MAGIC { Sort::Snapshot } else { Sort::Scene }
}

/// A name for what is saved: the scene's, without folders.
pub fn stem(name: &str) -> String {
    let last = Path::new(name).file_stem().map(|s| s.to_string_lossy().into_owned());
    last.filter(|s| !s.is_empty()).unwrap_or_else(|| "scene".into())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_path_is_entered_taken_asked_about_or_refused() {
        let folder = std::env::temp_dir().join(format!("mrtphys-files-{}", std::process::id()));
        std::fs::create_dir_all(&folder).unwrap();
        let old = folder.join("old.png");
        std::fs::write(&old, "").unwrap();
        assert_eq!(choose(&Purpose::Picture, folder.clone()), Chosen::Enter(folder.clone()));
        assert_eq!(choose(&Purpose::Picture, folder.join("old")), Chosen::Overwrite(old.clone()));
        assert_eq!(choose(&Purpose::Picture, folder.join("new.PNG")), Chosen::Take(folder.join("new.PNG")));
        assert_eq!(choose(&Purpose::Film("mp4"), folder.join("a.b")), Chosen::Take(folder.join("a.b.mp4")));
        assert_eq!(choose(&Purpose::Film(""), folder.join("pictures")), Chosen::Take(folder.join("pictures")));
        assert_eq!(choose(&Purpose::Open, old.clone()), Chosen::Take(old));
        assert!(matches!(choose(&Purpose::Open, folder.join("none")), Chosen::Refuse(why) if why.contains("none")));
        assert!(matches!(choose(&Purpose::SaveScene, folder.join("no/x")), Chosen::Refuse(_)));
        std::fs::remove_dir_all(folder).unwrap();
    }

    #[test]
    fn a_snapshot_is_known_by_its_beginning() {
        let path = std::env::temp_dir().join(format!("mrtphys-sort-{}.toml", std::process::id()));
        let scene = mrtphys_scene::Scene::from_text("x", "format = 1").unwrap();
        std::fs::write(&path, scene.build().unwrap().world.snapshot()).unwrap();
        assert_eq!(sort_of(&path), Sort::Snapshot);
        std::fs::write(&path, "format = 1").unwrap();
        assert_eq!(sort_of(&path), Sort::Scene);
        std::fs::remove_file(&path).unwrap();
        assert_eq!(sort_of(&path), Sort::Scene, "opening it says what is wrong");
    }

    #[test]
    fn a_saved_file_is_named_after_the_scene() {
        assert_eq!([stem("thesis/cube-8"), stem("/x/y.toml"), stem("")], ["cube-8", "y", "scene"]);
    }
}
