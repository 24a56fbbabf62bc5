//! What the panel says, written into a file for tests: where the controls are, what stands on them, and the numbers behind.

use super::desk::Desk;
use crate::output::Whole;
use crate::testbed::session::Command;
use eframe::egui;
use mrtphys::Vec3;
use serde_json::{Map, Value, json};
use std::path::PathBuf;
use std::sync::mpsc::{self, Receiver};
use std::time::{Duration, Instant};

/// Between two lines.
const PAUSE: Duration = Duration::from_millis(100);

/// The file, and the question whose answer it waits for.
pub struct Status {
    path: PathBuf,
    written: Option<Instant>,
    last: String,
    /// digest of the state, at this step of this scene
    hash: Option<(Moment, String)>,
    asked: Option<(Moment, Receiver<String>)>,
}

/// Scene, frame of the recording, steps and report.
type Moment = (u64, u64, u64, u64);

/// What is not on the desk.
pub struct Beside {
    /// what is wrong with a scene
    pub trouble: Option<String>,
    /// messages on the screen
    pub messages: Vec<String>,
    /// work in the background, and scenes being opened
    pub busy: usize,
    /// pictures of the gallery
    pub thumbnails: usize,
    /// windows that are open
    pub windows: Vec<&'static str>,
}

impl Status {
    /// Into this file.
    pub fn new(path: PathBuf) -> Status {
        Status { path, written: None, last: String::new(), hash: None, asked: None }
    }

    /// Writes what has changed, at most ten times a second.
    pub fn write(&mut self, context: &egui::Context, desk: &mut Desk, beside: &Beside) {
        self.inquire(context, desk);
        let now = Instant::now();
        if let Some(at) = self.written
            && now.saturating_duration_since(at) < PAUSE
        {
            context.request_repaint_after(PAUSE);
            return;
        }
        let text = format!("{}\n", self.line(context, desk, beside));
        if text == self.last {
            return;
        }
        self.written = Some(now);
        let file = Whole::check(&self.path).and_then(|file| file.write(|to| to.write_all(text.as_bytes())));
        match file {
            Ok(()) => self.last = text,
            Err(e) => desk.complain(e.to_string()),
        }
        // The last change must be written too, though nothing else may happen after it.
        context.request_repaint_after(PAUSE);
    }

    /// Asks for the digest of a state that stands still.
    fn inquire(&mut self, context: &egui::Context, desk: &Desk) {
        let report = desk.report();
        let steps = report.sides.first().map_or(0, |s| s.numbers.steps);
        let moment = (desk.opened, report.timeline.now, steps, report.number);
        if let Some((at, receiver)) = &self.asked {
            if let Ok(hash) = receiver.try_recv() {
                self.hash = Some((*at, hash));
                self.asked = None;
            }
            return;
        }
        let known = self.hash.as_ref().is_some_and(|(at, _)| (at.0, at.1, at.2) == (moment.0, moment.1, moment.2));
        if report.running || known {
            return;
        }
        let (sender, receiver) = mpsc::channel();
        let context = context.clone();
        desk.send(Command::Ask(Box::new(move |studio| {
            let _ = sender.send(studio.loaded.world.state_hash());
            context.request_repaint();
        })));
        self.asked = Some((moment, receiver));
    }

    fn line(&self, context: &egui::Context, desk: &Desk, beside: &Beside) -> Value {
        let report = desk.report();
        let Some(side) = report.sides.first() else { return Value::Null };
        let n = &side.numbers;
        let hash = self
            .hash
            .as_ref()
            .filter(|(at, _)| !report.running && (at.0, at.1, at.2) == (desk.opened, report.timeline.now, n.steps));
        let scale = context.pixels_per_point();
        let pixels = |r: egui::Rect| [r.min.x, r.min.y, r.max.x, r.max.y].map(|x| (x * scale).round());
        let widgets: Map<String, Value> =
            desk.probes.places().map(|(name, rect)| (name.to_string(), json!(pixels(rect)))).collect();
        let energy = |e: &mrtphys::ledger::Energy| json!({"linear": e.linear, "rotational": e.rotational, "potential": e.potential, "total": e.total()});
        let ledger: Map<String, Value> =
            n.ledger.entries().map(|(k, x)| (k.to_string(), json!(x))).into_iter().collect();
        json!({
            "name": desk.name, "title": report.title, "opened": desk.opened, "running": report.running,
            "bodies": side.shot.stage.body_count(), "frame": n.frame, "time": n.time, "steps": n.steps, "fps": n.settings.fps,
            "steps_per_frame": n.settings.steps_per_frame, "broad_phase": n.settings.broad_phase.to_string(),
            "energy": energy(&n.energy), "initial_energy": energy(&n.initial_energy), "ledger": ledger,
            "counters": counters(&n.totals), "last_step": counters(&n.counters),
            "state_hash": hash.map(|(_, hash)| hash),
            "real_time": format!("{:?}", report.pace.real_time), "speed": report.pace.speed,
            "timeline": [report.timeline.first, report.timeline.now, report.timeline.last],
            "rival_agrees": report.rival_agrees, "session_trouble": report.trouble,
            "camera": {"eye": xyz(desk.camera.eye), "look_at": xyz(desk.camera.look_at), "up": xyz(desk.camera.up)},
            "dark": desk.look.theme == mrtphys_view::Theme::Dark, "scale": scale,
            "trouble": beside.trouble, "messages": beside.messages, "busy": beside.busy,
            "thumbnails": beside.thumbnails, "windows": beside.windows,
            "says": desk.probes.said(), "widgets": widgets,
        })
    }
}

fn xyz(v: Vec3) -> [f64; 3] {
    v.to_array()
}

fn counters(c: &mrtphys::counters::Counters) -> Value {
    let named = mrtphys::counters::Counters::NAMES.iter().zip(c.to_array());
    Value::Object(named.map(|(name, n)| (name.to_string(), json!(n))).collect())
}
