//! What the records of a run say of each engine in each scene.

use super::check::MOVED_ENOUGH;
use super::stats::{median, spread};
use crate::peers::EngineKind;
use serde_json::Value;

/// An engine with a margin in a scene.
#[derive(Clone, Debug, Default)]
pub struct Row {
    /// engine, as on the command line
    pub engine: String,
    /// margin
    pub margin: String,
    /// time of a step \[ms\] in every turn of the first window
    start: Vec<f64>,
    /// the same in the second
    late: Vec<f64>,
    /// mean time of a step \[ms\] in every turn of the last window there was
    means: Vec<f64>,
    /// most threads that computed at once in a turn: processor time by wall time
    busy: f64,
    /// threads that the engine was given
    threads: u64,
    /// whether bodies of the scene fly freely while it is watched
    flies: bool,
    /// record of the watch
    watch: Value,
    /// record of the end
    truth: Value,
    /// why there is no more
    pub failure: Option<String>,
}

/// A scene with its rows.
#[derive(Clone, Debug)]
pub struct SceneRows {
    /// name
    pub name: String,
    /// record of the scene
    pub record: Value,
    /// rows, in the order in which the engines began
    pub rows: Vec<Row>,
}

/// Threads of each engine in a run.
pub fn threads(records: &[Value]) -> u64 {
    records.iter().find(|r| r["what"] == "machine").and_then(|r| r["threads"].as_u64()).unwrap_or(1)
}

/// The clock that times a step: the processor time of several threads says nothing of how long a step takes, and with one
/// thread the time that goes by counts what else the machine does.
pub fn clock(threads: u64) -> &'static str {
    if threads > 1 { "wall" } else { "cpu" }
}

/// Sorts records by scene and engine.
pub fn gather(records: &[Value]) -> Vec<SceneRows> {
    let threads = threads(records);
    let mut scenes: Vec<SceneRows> = Vec::new();
    for record in records {
        let Some(name) = record["scene"].as_str() else { continue };
        let at = scenes.iter().position(|s| s.name == name).unwrap_or_else(|| {
            scenes.push(SceneRows { name: name.into(), record: Value::Null, rows: Vec::new() });
            scenes.len() - 1
        });
        let scene = &mut scenes[at];
        match record["engine"].as_str() {
            None => scene.record = record.clone(),
            Some(engine) => scene.row(engine, record["margin"].as_str().unwrap_or_default(), threads).take(record),
        }
    }
    scenes
}

impl SceneRows {
    fn row(&mut self, engine: &str, margin: &str, threads: u64) -> &mut Row {
        let at = self.rows.iter().position(|r| r.engine == engine && r.margin == margin).unwrap_or_else(|| {
            let flies = self.record["flies"] != false;
            self.rows.push(Row { threads, flies, ..Row::of(engine, margin) });
            self.rows.len() - 1
        });
        &mut self.rows[at]
    }

    /// What stands in the name before the size: `spheres`.
    pub fn kind(&self) -> &str {
        self.name.split(['-', '@']).next().unwrap_or(&self.name)
    }

    /// Movable bodies.
    pub fn bodies(&self) -> Option<f64> {
        self.record["bodies"].as_f64()
    }

    /// Steps per second.
    pub fn rate(&self) -> Option<u64> {
        self.record["rate"].as_u64()
    }

    /// This project's row, if it took part.
    pub fn ours(&self) -> Option<&Row> {
        self.rows.iter().find(|r| r.engine == EngineKind::Ours.name())
    }

    /// The row of an engine with a margin.
    pub fn find(&self, engine: &str, margin: &str) -> Option<&Row> {
        self.rows.iter().find(|r| r.engine == engine && r.margin == margin)
    }
}

impl Row {
    /// The row of an engine with a margin, without any result.
    pub fn of(engine: &str, margin: &str) -> Row {
        Row { engine: engine.into(), margin: margin.into(), ..Row::default() }
    }

    fn take(&mut self, record: &Value) {
        match record["what"].as_str() {
            Some("burst") => self.take_burst(record),
            Some("watch") => self.watch = record.clone(),
            Some("truth") => self.truth = record.clone(),
            Some("failed") => self.failure = record["why"].as_str().map(String::from),
            _ => {}
        }
    }

    fn take_burst(&mut self, record: &Value) {
        let number = |clock: &str, key: &str| record[clock][key].as_f64().unwrap_or(f64::NAN);
        self.busy = self.busy.max(number("cpu", "total") / number("wall", "total"));
        let late = record["window"] == "late";
        let times = if late { &mut self.late } else { &mut self.start };
        times.push(1e3 * number(clock(self.threads), "median"));
        if late && times.len() == 1 {
            self.means.clear();
        }
        self.means.push(1e3 * number(clock(self.threads), "mean"));
    }

    /// Name in tables.
    pub fn title(&self) -> String {
        let title = EngineKind::named(&self.engine).map_or("?", EngineKind::title);
        if self.margin == "thin" { format!("{title}, thin") } else { title.into() }
    }

    /// Time of a step near the start \[ms\].
    pub fn start(&self) -> Option<f64> {
        median(&self.start)
    }

    /// Time of a step in the second window \[ms\].
    pub fn late(&self) -> Option<f64> {
        median(&self.late)
    }

    /// Mean time of a step in the last window \[ms\].
    pub fn mean(&self) -> Option<f64> {
        median(&self.means)
    }

    /// Spread of the turns of the last window.
    pub fn spread(&self) -> Option<f64> {
        spread(if self.late.is_empty() { &self.start } else { &self.late })
    }

    /// A number of the watch.
    pub fn watched(&self, key: &str) -> Option<f64> {
        self.watch[key].as_f64()
    }

    /// A number of the end.
    pub fn truth(&self, key: &str) -> Option<f64> {
        self.truth[key].as_f64()
    }

    /// Whether the run came to its end.
    pub fn ended(&self) -> bool {
        !self.truth.is_null()
    }

    /// Why the run is not one of this scene, if so.
    pub fn invalid(&self) -> Option<String> {
        if !self.watch.is_null() {
            match self.watched("moved") {
                // A number that is none is written as null: nothing was in free flight, or nothing is a number.
                None if !self.flies => {}
                None => return Some("no body was seen in free flight".into()),
                Some(part) if part < MOVED_ENOUGH => {
                    return Some(format!("only {:.0} % of the bodies in free flight moved v t", 100.0 * part));
                }
                Some(_) => {}
            }
        }
        let more = self.busy > 1.1 * self.threads.max(1) as f64;
        more.then(|| format!("{:.1} threads computed at once", self.busy))
    }
}
