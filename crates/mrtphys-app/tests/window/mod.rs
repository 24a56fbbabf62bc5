//! The testbed on a virtual display, with a mouse and a keyboard, and a reader for what its panel says.

use super::common::Folder;
use serde_json::Value;
use std::io::{BufRead, BufReader, Write};
use std::process::{Child, Command, Stdio};
use std::sync::{Mutex, MutexGuard, PoisonError};
use std::time::{Duration, Instant};

/// Patience with a slow machine.
const PATIENCE: Duration = Duration::from_secs(90);

/// Whether a window can be opened here. If not, the test says so, past the capture of the test harness.
pub fn can_open(test: &str) -> bool {
    let missing = ["Xvfb", "xdotool"].into_iter().find(|program| {
        let found = Command::new(program).arg("-version").stdout(Stdio::null()).stderr(Stdio::null()).status();
        found.is_err()
    });
    let why = match (missing, mrtphys_view::Renderer::new()) {
        (Some(program), _) => format!("{program} is not there"),
        (None, Err(e)) => e.to_string(),
        (None, Ok(_)) => return true,
    };
    let _ = writeln!(std::io::stderr(), "SKIPPED {test}: {why}");
    false
}

/// A child that ends with the test.
struct Ended(Child);

impl Drop for Ended {
    fn drop(&mut self) {
        let _ = self.0.kill();
        let _ = self.0.wait();
    }
}

/// The program in its window. Dropped in this order: the program, then its display.
pub struct Window<'a> {
    program: Ended,
    _server: Ended,
    display: String,
    folder: &'a Folder,
    _only: MutexGuard<'static, ()>,
}

/// One window at a time: two of them drawn in software leave nothing of a small machine.
static ONLY: Mutex<()> = Mutex::new(());

impl<'a> Window<'a> {
    /// Opens `mrtphys view` with these arguments, separated by blanks, and waits until it is drawn.
    pub fn open(folder: &'a Folder, args: &str) -> Window<'a> {
        let only = ONLY.lock().unwrap_or_else(PoisonError::into_inner);
        let mut server = Command::new("Xvfb")
            .args(["-displayfd", "1", "-screen", "0", "1280x800x24", "-nolisten", "tcp"])
            .stdout(Stdio::piped())
            .stderr(Stdio::null())
            .spawn()
            .unwrap();
        let mut number = String::new();
        BufReader::new(server.stdout.take().unwrap()).read_line(&mut number).unwrap();
        let display = format!(":{}", number.trim());
        let server = Ended(server);
        let program = folder
            .command()
            .args(["view", "--status", "status.json", "--size", "1280x800"])
            .args(args.split_whitespace())
            .env("DISPLAY", &display)
            .env_remove("WAYLAND_DISPLAY")
            .env_remove("WAYLAND_SOCKET")
            .env("XDG_RUNTIME_DIR", &folder.0)
            .env("XDG_CONFIG_HOME", folder.path("config"))
            .stderr(std::fs::File::create(folder.path("stderr.txt")).unwrap())
            .spawn()
            .unwrap();
        let mut window = Window { program: Ended(program), _server: server, display, folder, _only: only };
        window.until("the first picture", |s| s["widgets"]["animation.go"].is_array());
        // There is no window manager that would give the keyboard to anybody.
        window.focus();
        window
    }

    /// The window may be drawn before it is on the screen.
    fn focus(&self) {
        let start = Instant::now();
        while let Err(why) = self.try_xdotool(&["search", "--onlyvisible", "--name", "mrtphys", "windowfocus"]) {
            assert!(start.elapsed() < PATIENCE, "{why}");
            std::thread::sleep(Duration::from_millis(100));
        }
    }

    /// What the panel says now.
    pub fn status(&mut self) -> Value {
        if let Some(status) = self.program.0.try_wait().unwrap() {
            panic!("the program ended with {status}:\n{}", self.folder.text("stderr.txt"));
        }
        let text = std::fs::read_to_string(self.folder.path("status.json")).unwrap_or_default();
        serde_json::from_str(&text).unwrap_or_default()
    }

    /// Waits until the program has ended, and well.
    #[track_caller]
    pub fn ends(&mut self) {
        let start = Instant::now();
        loop {
            if let Some(status) = self.program.0.try_wait().unwrap() {
                assert!(status.success(), "{status}:\n{}", self.folder.text("stderr.txt"));
                return;
            }
            assert!(start.elapsed() < PATIENCE, "waited in vain for the end");
            std::thread::sleep(Duration::from_millis(30));
        }
    }

    /// Waits until the panel says something.
    #[track_caller]
    pub fn until(&mut self, what: &str, says: impl Fn(&Value) -> bool) -> Value {
        let start = Instant::now();
        loop {
            let status = self.status();
            if says(&status) {
                return status;
            }
            assert!(start.elapsed() < PATIENCE, "waited in vain for {what}; the panel says {status:#}");
            std::thread::sleep(Duration::from_millis(30));
        }
    }

    /// Waits for a frame of the counter, standing still, with the digest of its state.
    #[track_caller]
    pub fn still_at(&mut self, frame: u64) -> Value {
        self.until(&format!("frame {frame}"), |s| s["frame"] == frame && s["state_hash"].is_string())
    }

    /// Mouse and keyboard.
    pub fn xdotool(&self, args: &[&str]) {
        self.try_xdotool(args).unwrap();
    }

    fn try_xdotool(&self, args: &[&str]) -> Result<(), String> {
        let done = Command::new("xdotool").args(args).env("DISPLAY", &self.display).output().unwrap();
        let said = || format!("xdotool {args:?}: {}", String::from_utf8_lossy(&done.stderr));
        if done.status.success() { Ok(()) } else { Err(said()) }
    }

    /// Presses keys, one after the other.
    pub fn keys(&self, keys: &[&str]) {
        self.xdotool(&[&["key", "--delay", "40"], keys].concat());
    }

    /// Types a text.
    pub fn type_text(&self, text: &str) {
        self.xdotool(&["type", "--delay", "30", text]);
    }

    /// Clicks a control that may be clicked more than once, until the panel says what follows: under load a window may still
    /// have been on its way to its place.
    #[track_caller]
    pub fn click_until(&mut self, control: &str, part: f64, says: impl Fn(&Value) -> bool) -> Value {
        for _ in 0..12 {
            self.click_at(control, part);
            if let Some(status) = self.soon(&says) {
                return status;
            }
        }
        self.until(control, says)
    }

    /// Waits a little until the panel says something.
    fn soon(&mut self, says: impl Fn(&Value) -> bool) -> Option<Value> {
        let start = Instant::now();
        while start.elapsed() < Duration::from_secs(5) {
            let status = self.status();
            if says(&status) {
                return Some(status);
            }
            std::thread::sleep(Duration::from_millis(50));
        }
        None
    }

    /// Answers the dialog that asks for a file with a name in the folder of the scene.
    #[track_caller]
    pub fn name_file(&mut self, name: &str) {
        for _ in 0..12 {
            self.click("files.name");
            self.keys(&["ctrl+a"]);
            self.type_text(name);
            if self.soon(|s| s["says"]["files.name"] == name).is_some() {
                break;
            }
        }
        self.until("the name", |s| s["says"]["files.name"] == name);
        self.keys(&["Return"]);
    }

    fn move_to(&self, x: f64, y: f64) {
        self.xdotool(&["mousemove", &format!("{x:.0}"), &format!("{y:.0}")]);
        // Time for the program to see where the mouse is before it is pressed.
        std::thread::sleep(Duration::from_millis(150));
    }

    /// Where a control is: at a part of its width, in the middle of its height. Waits until it is there and stands still.
    #[track_caller]
    fn place(&mut self, control: &str, part: f64) -> (f64, f64) {
        let mut last = Value::Null;
        loop {
            let status = self.until(control, |s| s["widgets"][control].is_array());
            let place = status["widgets"][control].clone();
            if place == last {
                let [x0, y0, x1, y1]: [f64; 4] = serde_json::from_value(place).unwrap();
                return (x0 + part * (x1 - x0), 0.5 * (y0 + y1));
            }
            last = place;
            std::thread::sleep(Duration::from_millis(250));
        }
    }

    /// Clicks a control.
    #[track_caller]
    pub fn click(&mut self, control: &str) {
        self.click_at(control, 0.5);
    }

    /// Clicks a control at a part of its width.
    #[track_caller]
    pub fn click_at(&mut self, control: &str, part: f64) {
        let (x, y) = self.place(control, part);
        self.move_to(x, y);
        self.xdotool(&["mousedown", "1"]);
        std::thread::sleep(Duration::from_millis(300));
        self.xdotool(&["mouseup", "1"]);
    }

    /// Drags from one point of the screen to another.
    pub fn drag(&self, button: &str, from: (f64, f64), to: (f64, f64)) {
        self.move_to(from.0, from.1);
        self.xdotool(&["mousedown", button]);
        for i in 1..=8 {
            let part = f64::from(i) / 8.0;
            self.move_to(from.0 + part * (to.0 - from.0), from.1 + part * (to.1 - from.1));
        }
        self.xdotool(&["mouseup", button]);
    }

    /// Everything that the program has complained about on stderr.
    pub fn complaints(&self) -> String {
        self.folder.text("stderr.txt")
    }
}
