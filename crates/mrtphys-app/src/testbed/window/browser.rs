//! A folder on the disk, as a file dialog shows it.

use std::fs;
use std::path::{Path, PathBuf};

/// An entry of a folder.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct Entry {
    /// folders come first
    pub is_file: bool,
    /// for the order: capital letters make no difference
    lower: String,
    /// its name
    pub name: String,
}

/// A folder, and what of it is shown.
#[derive(Debug, Default)]
pub struct Browser {
    folder: PathBuf,
    entries: Vec<Entry>,
    /// why the folder cannot be read
    pub trouble: Option<String>,
    endings: Vec<&'static str>,
    only_these: bool,
}

impl Browser {
    /// In a folder, with files of these endings; none: all files.
    pub fn new(folder: &Path, endings: &[&'static str]) -> Browser {
        let mut browser = Browser { endings: endings.to_vec(), only_these: !endings.is_empty(), ..Browser::default() };
        browser.go(folder);
        browser
    }

    /// The folder.
    pub fn folder(&self) -> &Path {
        &self.folder
    }

    /// What is in it, folders first. What is hidden by its name is left out.
    pub fn entries(&self) -> &[Entry] {
        &self.entries
    }

    /// Goes to a folder. One that cannot be read is shown empty, with the reason.
    pub fn go(&mut self, folder: &Path) {
        let folder = if folder.as_os_str().is_empty() { Path::new(".") } else { folder };
        self.folder =
            fs::canonicalize(folder).or_else(|_| std::path::absolute(folder)).unwrap_or_else(|_| folder.into());
        self.read();
    }

    /// Looks again.
    pub fn read(&mut self) {
        self.trouble = None;
        self.entries.clear();
        match fs::read_dir(&self.folder) {
            Err(e) => self.trouble = Some(format!("cannot read '{}': {e}", self.folder.display())),
            Ok(found) => {
                let entries = found.flatten().filter_map(|e| entry(&e.path(), &e.file_name().to_string_lossy()));
                let is_shown = |e: &Entry| !e.is_file || !self.only_these || self.is_wanted(Path::new(&e.name));
                self.entries = entries.filter(is_shown).collect();
                self.entries.sort();
            }
        }
    }

    /// Goes to the folder above.
    pub fn up(&mut self) {
        if let Some(above) = self.folder.parent().map(Path::to_path_buf) {
            self.go(&above);
        }
    }

    /// Whether only files of the endings are shown.
    pub fn only_these(&self) -> bool {
        self.only_these
    }

    /// Shows only files of the endings, or all.
    pub fn show_only_these(&mut self, on: bool) {
        if on != self.only_these {
            self.only_these = on;
            self.read();
        }
    }

    fn is_wanted(&self, path: &Path) -> bool {
        let ending = path.extension().map(|e| e.to_string_lossy().to_lowercase());
        ending.is_some_and(|e| self.endings.contains(&e.as_str()))
    }

    /// The path that a typed name means: from this folder on, unless it is one from the root.
    pub fn path_of(&self, name: &str) -> PathBuf {
        let name = name.trim();
        let home = || std::env::var_os("HOME").or_else(|| std::env::var_os("USERPROFILE")).map(PathBuf::from);
        match name.strip_prefix("~/") {
            Some(rest) => home().map_or_else(|| self.folder.join(name), |home| home.join(rest)),
            None => self.folder.join(name),
        }
    }
}

fn entry(path: &Path, name: &str) -> Option<Entry> {
    if name.starts_with('.') {
        return None;
    }
    // Through links: what one leads to is what can be opened.
    let is_file = !fs::metadata(path).ok()?.is_dir();
    Some(Entry { is_file, lower: name.to_lowercase(), name: name.into() })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn names(browser: &Browser) -> Vec<&str> {
        browser.entries().iter().map(|e| e.name.as_str()).collect()
    }

    #[test]
    fn folders_come_first_and_only_wanted_files_are_shown() {
        let folder = std::env::temp_dir().join(format!("mrtphys-browser-{}", std::process::id()));
        let _ = fs::remove_dir_all(&folder);
        fs::create_dir_all(folder.join("Zoo")).unwrap();
        for name in ["b.toml", "A.TOML", "x.png", ".hidden.toml", "toml"] {
            fs::write(folder.join(name), "").unwrap();
        }
        let mut browser = Browser::new(&folder, &["toml"]);
        assert_eq!(names(&browser), ["Zoo", "A.TOML", "b.toml"]);
        browser.show_only_these(false);
        assert_eq!(names(&browser), ["Zoo", "A.TOML", "b.toml", "toml", "x.png"]);
        browser.go(&folder.join("Zoo"));
        assert!(browser.entries().is_empty() && browser.trouble.is_none());
        browser.up();
        assert_eq!(browser.entries().len(), 5);
        assert_eq!(browser.path_of(" c.toml "), browser.folder().join("c.toml"));
        assert_eq!(browser.path_of("/x/y"), Path::new("/x/y"));
        browser.go(&folder.join("not there"));
        assert!(browser.entries().is_empty());
        assert!(browser.trouble.as_ref().is_some_and(|t| t.contains("not there")));
        fs::remove_dir_all(folder).unwrap();
    }

    #[test]
    fn the_root_has_nothing_above_it() {
        let mut browser = Browser::new(Path::new("/"), &[]);
        browser.up();
        assert_eq!(browser.folder(), fs::canonicalize("/").unwrap());
    }
}
