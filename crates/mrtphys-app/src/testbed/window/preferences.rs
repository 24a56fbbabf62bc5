//! What is remembered from one start to the next: how the window looks, and which files were open.

use crate::output::Whole;
use serde_json::{Value, json};
use std::path::{Path, PathBuf};

/// Most files that are remembered.
const MOST_RECENT: usize = 10;
/// Sizes of letters that can be chosen \[% of the usual\].
pub const SCALES: [u32; 9] = [70, 80, 90, 100, 110, 125, 150, 175, 200];

/// The preferences.
#[derive(Clone, Debug, PartialEq)]
pub struct Preferences {
    /// dark rather than light
    pub dark: bool,
    /// size of letters \[% of the usual\]: one of [`SCALES`]
    pub scale: u32,
    /// whether a scene is read again when its file changes
    pub auto_reload: bool,
    /// files that were open, the latest first
    pub recent: Vec<PathBuf>,
}

impl Default for Preferences {
    fn default() -> Preferences {
        Preferences { dark: false, scale: 100, auto_reload: true, recent: Vec::new() }
    }
}

impl Preferences {
    /// Those of the last time. What cannot be read is as at first: preferences are no reason not to start.
    pub fn load() -> Preferences {
        let text = file().and_then(|path| std::fs::read_to_string(path).ok());
        text.map(|text| Preferences::of(&text)).unwrap_or_default()
    }

    /// Remembers them.
    ///
    /// # Errors
    /// The file cannot be written: its name and why.
    pub fn save(&self) -> Result<(), String> {
        let Some(path) = file() else { return Ok(()) };
        if let Some(folder) = path.parent() {
            std::fs::create_dir_all(folder)
                .map_err(|e| format!("cannot make the folder '{}': {e}", folder.display()))?;
        }
        let whole = Whole::check(&path).map_err(|e| e.to_string())?;
        whole.write(|to| to.write_all(self.text().as_bytes())).map_err(|e| e.to_string())
    }

    fn of(text: &str) -> Preferences {
        let first = Preferences::default();
        let Ok(value) = serde_json::from_str::<Value>(text) else { return first };
        let recent = value["recent"].as_array().into_iter().flatten().filter_map(Value::as_str).map(PathBuf::from);
        let scale = value["scale"].as_u64().and_then(|s| SCALES.into_iter().find(|x| u64::from(*x) == s));
        Preferences {
            dark: value["dark"].as_bool().unwrap_or(first.dark),
            scale: scale.unwrap_or(first.scale),
            auto_reload: value["auto_reload"].as_bool().unwrap_or(first.auto_reload),
            recent: recent.take(MOST_RECENT).collect(),
        }
    }

    fn text(&self) -> String {
        // A path that is not Unicode cannot stand in JSON, and is not remembered.
        let recent: Vec<&str> = self.recent.iter().filter_map(|p| p.to_str()).collect();
        let value = json!({"dark": self.dark, "scale": self.scale, "auto_reload": self.auto_reload, "recent": recent});
        format!("{value:#}\n")
    }

    /// A file was opened or written: it becomes the latest.
    pub fn touch(&mut self, path: &Path) {
        let path = std::path::absolute(path).unwrap_or_else(|_| path.to_path_buf());
        self.recent.retain(|p| *p != path);
        self.recent.insert(0, path);
        self.recent.truncate(MOST_RECENT);
    }

    /// A scene was opened, from a file or not.
    pub fn recent_of(&mut self, path: Option<&Path>) {
        if let Some(path) = path {
            self.touch(path);
        }
    }

    /// Larger or smaller letters by this many steps; 0: as usual.
    pub fn rescale(&mut self, steps: i8) {
        let usual = SCALES.iter().position(|s| *s == 100).unwrap_or(0);
        let now = SCALES.iter().position(|s| *s == self.scale).unwrap_or(usual);
        let next = if steps == 0 { usual } else { now.saturating_add_signed(isize::from(steps)) };
        self.scale = SCALES[next.min(SCALES.len() - 1)];
    }
}

/// Where they are kept: where the system keeps such files.
fn file() -> Option<PathBuf> {
    let folder = |name: &str| std::env::var_os(name).filter(|v| !v.is_empty()).map(PathBuf::from);
    let base = if cfg!(windows) {
        folder("APPDATA")
    } else if cfg!(target_os = "macos") {
        folder("HOME").map(|home| home.join("Library/Application Support"))
    } else {
        folder("XDG_CONFIG_HOME").or_else(|| folder("HOME").map(|home| home.join(".config")))
    };
    base.map(|base| base.join("mrtphys").join("testbed.json"))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_written_is_read() {
        let mut p = Preferences { dark: true, scale: 125, auto_reload: false, recent: Vec::new() };
        p.touch(Path::new("/a/ä \"x\".toml"));
        assert_eq!(Preferences::of(&p.text()), p);
    }

    #[test]
    fn nonsense_is_as_at_first() {
        for text in ["", "[]", "{\"scale\": 1e9, \"dark\": 3, \"recent\": [1, null]}", "\u{0}"] {
            assert_eq!(Preferences::of(text), Preferences::default(), "{text}");
        }
    }

    #[test]
    fn the_latest_file_is_first_and_there_once() {
        let mut p = Preferences::default();
        for i in 0..20 {
            p.touch(Path::new(&format!("/s/{i}.toml")));
        }
        p.touch(Path::new("/s/15.toml"));
        assert_eq!(p.recent.len(), MOST_RECENT);
        assert_eq!((p.recent[0].as_path(), p.recent[1].as_path()), (Path::new("/s/15.toml"), Path::new("/s/19.toml")));
        assert_eq!(p.recent.iter().filter(|r| r.ends_with("15.toml")).count(), 1);
    }

    #[test]
    fn letters_grow_and_shrink_within_limits() {
        let mut p = Preferences::default();
        p.rescale(1);
        assert_eq!(p.scale, 110);
        p.rescale(100);
        assert_eq!(p.scale, 200);
        p.rescale(-100);
        assert_eq!(p.scale, 70);
        p.rescale(0);
        assert_eq!(p.scale, 100);
    }
}
