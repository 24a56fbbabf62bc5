//! Files that a run writes. A path that cannot be written is found out before the simulation starts; what goes wrong later
//! (a full disk, a closed pipe) ends the run with exit status 2 and a message that names the file.

use crate::exit::{Failure, Outcome};
use std::fs::{self, File, OpenOptions};
use std::io::{self, BufWriter, Write};
use std::path::{Path, PathBuf};

/// Text, or little-endian records: the ending `.bin` decides.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Format {
    /// CSV or JSON
    Text,
    /// records, layout in `docs/manual/files.md`
    Binary,
}

impl Format {
    /// The format that a path asks for.
    pub fn of(path: &Path) -> Format {
        let binary = path.extension().is_some_and(|e| e.eq_ignore_ascii_case("bin"));
        if binary { Format::Binary } else { Format::Text }
    }
}

/// A failure before the simulation.
fn wrong(path: &Path, e: &io::Error) -> Failure {
    Failure::Wrong(format!("cannot write '{}': {e}", path.display()))
}

/// A failure while writing.
fn stopped(path: &Path, e: &io::Error) -> Failure {
    Failure::Stopped(format!("writing '{}' failed: {e}", path.display()))
}

/// A file written while the simulation runs.
pub struct Stream {
    path: PathBuf,
    to: BufWriter<File>,
}

impl Stream {
    /// Creates the file, emptying one that is there.
    pub fn create(path: &Path) -> Outcome<Stream> {
        let file = File::create(path).map_err(|e| wrong(path, &e))?;
        Ok(Stream { path: path.to_path_buf(), to: BufWriter::with_capacity(1 << 16, file) })
    }

    /// Writes with `write`; an error names the file.
    pub fn put(&mut self, write: impl FnOnce(&mut BufWriter<File>) -> io::Result<()>) -> Outcome {
        write(&mut self.to).map_err(|e| stopped(&self.path, &e))
    }

    /// Hands everything to the system.
    pub fn flush(&mut self) -> Outcome {
        self.put(|to| to.flush())
    }
}

/// A file that appears as a whole or not at all: it is written beside its place and then renamed.
pub struct Whole {
    path: PathBuf,
    /// a device or a pipe, which cannot be renamed over: held open, for a reader takes its closing for the end
    device: Option<File>,
}

impl Whole {
    /// Makes sure that the file can be written, without touching what is there.
    pub fn check(path: &Path) -> Outcome<Whole> {
        // A folder takes the ordinary way, where opening it says what is wrong.
        let is_device = fs::metadata(path).is_ok_and(|m| !m.is_file() && !m.is_dir());
        let tried = if is_device {
            OpenOptions::new().write(true).open(path).map(Some)
        } else {
            try_place(&place_of(path)).map(|()| None)
        };
        let device = tried.map_err(|e| wrong(path, &e))?;
        Ok(Whole { path: path.to_path_buf(), device })
    }

    /// Writes the file.
    pub fn write(&self, write: impl FnOnce(&mut dyn Write) -> io::Result<()>) -> Outcome {
        let written = match &self.device {
            Some(device) => device.try_clone().and_then(|file| fill(file, write).map(drop)),
            None => replace(&place_of(&self.path), write),
        };
        written.map_err(|e| stopped(&self.path, &e))
    }
}

/// The file that a path names, through symbolic links.
fn place_of(path: &Path) -> PathBuf {
    fs::canonicalize(path).unwrap_or_else(|_| path.to_path_buf())
}

/// Whether a file can be put here, and what is here can be written.
fn try_place(place: &Path) -> io::Result<()> {
    if place.exists() {
        OpenOptions::new().append(true).open(place)?;
    }
    let part = part_of(place)?;
    File::create_new(&part)?;
    fs::remove_file(&part)
}

/// Puts a new file in a place; if that fails, what was there stays.
fn replace(place: &Path, write: impl FnOnce(&mut dyn Write) -> io::Result<()>) -> io::Result<()> {
    let part = part_of(place)?;
    let done = File::create_new(&part)
        .and_then(|file| fill(file, write))
        .and_then(|file| file.sync_all())
        .and_then(|()| fs::rename(&part, place));
    if done.is_err() {
        let _ = fs::remove_file(&part);
    }
    done
}

fn fill(file: File, write: impl FnOnce(&mut dyn Write) -> io::Result<()>) -> io::Result<File> {
    let mut to = BufWriter::with_capacity(1 << 16, file);
    write(&mut to)?;
    to.flush()?;
    to.into_inner().map_err(io::IntoInnerError::into_error)
}

/// Where the new file is put together: hidden, in the same folder, of this process only.
fn part_of(path: &Path) -> io::Result<PathBuf> {
    let name = path.file_name().ok_or_else(|| io::Error::new(io::ErrorKind::InvalidInput, "this is no file name"))?;
    let mut part = std::ffi::OsString::from(".");
    part.push(name);
    part.push(format!(".{}.part", std::process::id()));
    Ok(path.with_file_name(part))
}

/// Refuses two outputs to one file, or an output over an input.
pub fn check_distinct(outputs: &[(&str, &Path)], inputs: &[(&str, &Path)]) -> Outcome {
    for (i, (option, path)) in outputs.iter().enumerate() {
        let mut others = inputs.iter().chain(&outputs[..i]);
        if let Some((other, _)) = others.find(|(_, p)| is_same_file(p, path)) {
            return Err(Failure::Wrong(format!("{option} and {other} are the same file, '{}'", path.display())));
        }
    }
    Ok(())
}

fn is_same_file(a: &Path, b: &Path) -> bool {
    // Nothing is lost where two outputs go to one device.
    let device = |p: &Path| fs::metadata(p).is_ok_and(|m| !m.is_file());
    let real = |p: &Path| fs::canonicalize(p).or_else(|_| std::path::absolute(p)).unwrap_or_else(|_| p.to_path_buf());
    !device(a) && real(a) == real(b)
}

/// Text on stdout. `println!` would panic on a closed pipe.
pub fn say(text: &str) -> Outcome {
    let mut out = io::stdout().lock();
    out.write_all(text.as_bytes())
        .and_then(|()| out.flush())
        .map_err(|e| Failure::Stopped(format!("writing to standard output failed: {e}")))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn folder(name: &str) -> PathBuf {
        let folder = std::env::temp_dir().join(format!("mrtphys-output-{name}-{}", std::process::id()));
        let _ = fs::remove_dir_all(&folder);
        fs::create_dir_all(&folder).unwrap();
        folder
    }

    #[test]
    fn a_whole_file_appears_at_once_and_a_failed_one_leaves_the_old() {
        let folder = folder("whole");
        let path = folder.join("a.json");
        let whole = Whole::check(&path).unwrap();
        assert!(!path.exists(), "the check leaves nothing behind");
        whole.write(|to| to.write_all(b"first")).unwrap();
        assert_eq!(fs::read(&path).unwrap(), b"first");
        let broken = whole.write(|to| {
            to.write_all(b"half")?;
            Err(io::Error::other("no space"))
        });
        assert!(matches!(broken, Err(Failure::Stopped(text)) if text.contains("a.json") && text.contains("no space")));
        assert_eq!(fs::read(&path).unwrap(), b"first");
        assert_eq!(fs::read_dir(&folder).unwrap().count(), 1, "no half file is left");
        fs::remove_dir_all(folder).unwrap();
    }

    #[test]
    fn what_cannot_be_written_is_found_before() {
        let folder = folder("before");
        for path in [folder.join("no/such/folder.json"), folder.clone()] {
            assert!(matches!(Whole::check(&path), Err(Failure::Wrong(_))), "{path:?}");
            assert!(matches!(Stream::create(&path), Err(Failure::Wrong(_))), "{path:?}");
        }
        fs::remove_dir_all(folder).unwrap();
    }

    #[test]
    fn two_outputs_to_one_file_are_refused() {
        let folder = folder("same");
        let (a, b) = (folder.join("x.csv"), folder.join("./x.csv"));
        fs::write(&a, "").unwrap();
        assert!(check_distinct(&[("--events", &a), ("--trajectory", &b)], &[]).is_err());
        assert!(check_distinct(&[("--events", &a)], &[("the scene", &b)]).is_err());
        assert!(check_distinct(&[("--events", &a), ("--trajectory", &folder.join("y.csv"))], &[]).is_ok());
        let null = Path::new("/dev/null");
        assert!(check_distinct(&[("--events", null), ("--trajectory", null)], &[]).is_ok());
        fs::remove_dir_all(folder).unwrap();
    }

    #[test]
    fn the_ending_decides_the_format() {
        assert_eq!(Format::of(Path::new("a/b.bin")), Format::Binary);
        assert_eq!(Format::of(Path::new("a.bin/b.csv")), Format::Text);
        assert_eq!(Format::of(Path::new("b")), Format::Text);
    }
}
