//! A folder of its own for each test, the real program in it, and readers for what it writes.
#![allow(dead_code)] // every test file uses a part

use serde_json::Value;
use std::ffi::OsStr;
use std::path::{Path, PathBuf};
use std::process::{Command, Output, Stdio};

/// 27 spheres and tetrahedra in an elastic box.
pub const GAS: &str = r#"
format = 1
title = "A small gas"
[simulation]
seconds = 0.5
seed = 7
[[boundary]]
kind = "box"
name = "walls"
min = [0, 0, 0]
max = [1, 1, 1]
[[lattice]]
name = "gas"
count = [3, 3, 3]
min = [0, 0, 0]
max = [1, 1, 1]
jitter = 0.5
speed = 2.0
spin = 3.0
body = [ { shape = { kind = "sphere", radius = 0.12 }, mass = 1.0 },
         { shape = { kind = "tetrahedron", circumradius = 0.14 }, mass = 2.0 } ]
"#;

/// Lossy impacts under gravity: every ball falls, hits the floor and meets others.
pub const RAIN: &str = r#"
format = 1
[simulation]
seconds = 1.0
[[force_field]]
kind = "earth-gravity"
[[boundary]]
kind = "half-space"
name = "floor"
point = [0, 0, 0]
normal = [0, 1, 0]
[[body]]
name = "a \"quoted\", name"
shape = { kind = "sphere", radius = 0.1 }
position = [0, 1, 0]
velocity = [0.3, 0, 0]
restitution = 0.8
friction = 0.3
[[body]]
name = "low"
shape = { kind = "sphere", radius = 0.1 }
position = [0.05, 0.5, 0]
mass = 2.0
restitution = 0.9
friction = 0.2
[[body]]
name = "rock"
shape = { kind = "sphere", radius = 0.1 }
position = [5, 1, 0]
fixed = true
"#;

/// A folder that goes when the test is over.
pub struct Folder(pub PathBuf);

impl Folder {
    pub fn new(name: &str) -> Folder {
        let path = std::env::temp_dir().join(format!("mrtphys-app-{name}-{}", std::process::id()));
        let _ = std::fs::remove_dir_all(&path);
        std::fs::create_dir_all(&path).unwrap();
        Folder(path)
    }

    /// With the scene texts above in it.
    pub fn with_scenes(name: &str) -> Folder {
        let folder = Folder::new(name);
        folder.put("gas.toml", GAS);
        folder.put("rain.toml", RAIN);
        folder
    }

    pub fn path(&self, name: &str) -> PathBuf {
        self.0.join(name)
    }

    pub fn put(&self, name: &str, text: &str) {
        std::fs::write(self.path(name), text).unwrap();
    }

    pub fn text(&self, name: &str) -> String {
        std::fs::read_to_string(self.path(name)).unwrap_or_else(|e| panic!("{name}: {e}"))
    }

    pub fn json(&self, name: &str) -> Value {
        serde_json::from_str(&self.text(name)).unwrap()
    }

    pub fn command(&self) -> Command {
        let mut command = Command::new(env!("CARGO_BIN_EXE_mrtphys"));
        command.current_dir(&self.0).stdin(Stdio::null());
        command
    }

    /// Runs the program; arguments are separated by blanks.
    pub fn run(&self, args: &str) -> Done {
        self.run_args(args.split_whitespace())
    }

    pub fn run_args(&self, args: impl IntoIterator<Item = impl AsRef<OsStr>>) -> Done {
        Done::from(self.command().args(args).output().unwrap())
    }

    /// Runs a scene and reads its report.
    pub fn report(&self, args: &str) -> Value {
        self.run(&format!("run {args} --quiet --report r.json")).expect(0);
        self.json("r.json")
    }

    /// Files in the folder, hidden ones too.
    pub fn files(&self) -> Vec<String> {
        let name = |e: std::io::Result<std::fs::DirEntry>| e.unwrap().file_name().into_string().unwrap();
        let mut files: Vec<String> = std::fs::read_dir(&self.0).unwrap().map(name).collect();
        files.sort();
        files
    }
}

impl Drop for Folder {
    fn drop(&mut self) {
        let _ = std::fs::remove_dir_all(&self.0);
    }
}

/// What a run of the program left.
#[derive(Debug)]
pub struct Done {
    pub status: Option<i32>,
    pub out: String,
    pub err: String,
}

impl From<Output> for Done {
    fn from(o: Output) -> Done {
        let text = |bytes| String::from_utf8(bytes).unwrap();
        Done { status: o.status.code(), out: text(o.stdout), err: text(o.stderr) }
    }
}

impl Done {
    #[track_caller]
    pub fn expect(self, status: i32) -> Done {
        assert_eq!(self.status, Some(status), "stdout:\n{}\nstderr:\n{}", self.out, self.err);
        assert!(!self.err.contains("panicked"), "{}", self.err);
        self
    }

    /// Status 1 and a message that holds all of these.
    #[track_caller]
    pub fn refused(self, parts: &[&str]) {
        let done = self.expect(1);
        for part in parts {
            assert!(done.err.contains(part), "'{part}' is not in:\n{}", done.err);
        }
    }
}

/// Reads RFC 4180; every line must end with CR LF.
pub fn csv(text: &str) -> Vec<Vec<String>> {
    let (mut rows, mut row, mut field, mut quoted) = (Vec::new(), Vec::new(), String::new(), false);
    let mut chars = text.chars().peekable();
    while let Some(c) = chars.next() {
        match (c, quoted) {
            ('"', true) if chars.peek() == Some(&'"') => field.extend(chars.next()),
            ('"', _) => quoted = !quoted,
            (',', false) => row.push(std::mem::take(&mut field)),
            ('\r', false) => {
                assert_eq!(chars.next(), Some('\n'));
                row.push(std::mem::take(&mut field));
                rows.push(std::mem::take(&mut row));
            }
            ('\n', false) => panic!("a line end without CR"),
            (c, _) => field.push(c),
        }
    }
    assert!(row.is_empty() && field.is_empty() && !quoted, "the last line is cut off: {row:?} {field:?}");
    rows
}

pub fn number(text: &str) -> f64 {
    text.parse().unwrap_or_else(|_| panic!("'{text}' is no number"))
}

pub fn numbers(value: &Value) -> Vec<f64> {
    value.as_array().unwrap().iter().map(|v| v.as_f64().unwrap()).collect()
}

pub fn exists(path: &Path) -> bool {
    path.exists()
}
