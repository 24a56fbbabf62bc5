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
    /// greatest ratio of processor time to wall time in a turn
    busy: f64,
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

/// Sorts records by scene and engine.
pub fn gather(records: &[Value]) -> Vec<SceneRows> {
    let threads = records.iter().find(|r| r["what"] == "machine").map_or(1, |r| r["threads"].as_u64().unwrap_or(1));
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
            Some(engine) => scene.row(engine, record["margin"].as_str().unwrap_or_default()).take(record, threads),
        }
    }
    scenes
}

impl SceneRows {
    fn row(&mut self, engine: &str, margin: &str) -> &mut Row {
        let at = self.rows.iter().position(|r| r.engine == engine && r.margin == margin).unwrap_or_else(|| {
            self.rows.push(Row::of(engine, margin));
            self.rows.len() - 1
        });
        &mut self.rows[at]
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

    fn take(&mut self, record: &Value, threads: u64) {
        match record["what"].as_str() {
            Some("burst") => self.take_burst(record, threads),
            Some("watch") => self.watch = record.clone(),
            Some("truth") => self.truth = record.clone(),
            Some("failed") => self.failure = record["why"].as_str().map(String::from),
            _ => {}
        }
    }

    fn take_burst(&mut self, record: &Value, threads: u64) {
        let number = |key: &str| record[key].as_f64().unwrap_or(f64::NAN);
        let wall = 1e3 * number("wall") / number("steps");
        // The processor time of several threads says nothing of how long a step takes.
        let (median, mean) = if threads > 1 { (wall, wall) } else { (1e3 * number("median"), 1e3 * number("mean")) };
        if threads == 1 {
            self.busy = self.busy.max(number("cpu") / number("wall"));
        }
        let late = record["window"] == "late";
        let times = if late { &mut self.late } else { &mut self.start };
        times.push(median);
        if late && times.len() == 1 {
            self.means.clear();
        }
        self.means.push(mean);
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
                None => return Some("no body was seen in free flight".into()),
                Some(part) if part < MOVED_ENOUGH => {
                    return Some(format!("only {:.0} % of the bodies in free flight moved v t", 100.0 * part));
                }
                Some(_) => {}
            }
        }
        (self.busy > 1.1).then(|| format!("{:.1} threads computed at once", self.busy))
    }
}
