//! Lets the engines of a scene take turns.

use super::Log;
use super::child::name;
use super::options::Options;
use super::scenes::Scene;
use crate::peers::scene::SceneData;
use crate::peers::{EngineKind, Margin};
use serde_json::{Value, json};
use std::collections::VecDeque;
use std::io::{BufRead, BufReader, Read, Write};
use std::path::{Path, PathBuf};
use std::process::{Child, ChildStdin, Command, Stdio};
use std::sync::mpsc::{Receiver, RecvTimeoutError, channel};
use std::sync::{Arc, Mutex};
use std::thread::JoinHandle;
use std::time::Duration;

/// Runs a scene in all engines.
pub fn conduct(scene: &Scene, options: &Options, again: &[&str], log: &mut Log) -> Result<(), String> {
    let data = scene.subject.data();
    let file = SceneFile::new(&options.folder, &data)?;
    log.scene.clone_from(&scene.name);
    log.put(described(scene, &data))?;
    let mut players = Vec::new();
    for &(kind, margin) in &options.entries {
        if margin == Margin::Thin && !scene.plan.thin {
            continue;
        }
        match Player::start(kind, margin, options, again, &file.0) {
            Ok(player) => {
                let mut introduction = player.introduction.clone();
                introduction["what"] = "engine".into();
                player.put(log, introduction)?;
                players.push(player);
            }
            Err(why) => failed(log, kind, margin, &why)?,
        }
    }
    let mut stage = Stage { players, log, patience: options.patience, dt: data.dt };
    stage.play(scene)
}

fn described(scene: &Scene, data: &SceneData) -> Value {
    let plan = &scene.plan;
    json!({
        "what": "scene", "scene": scene.name, "bodies": data.bodies.iter().filter(|b| !b.fixed).count(),
        "rate": (1.0 / data.dt).round() as u64, "flies": scene.subject.flies(), "burst": plan.burst,
        "rounds": plan.rounds, "late": plan.late, "end": plan.end,
    })
}

fn failed(log: &mut Log, kind: EngineKind, margin: Margin, why: &str) -> Result<(), String> {
    let scene = log.scene.clone();
    let why = format!("failed: {why}");
    log.put(json!({ "what": "failed", "scene": scene, "engine": kind.name(), "margin": name(margin), "why": why }))
}

/// Whoever can be given a command and answers.
trait Plays {
    /// Engine and margin.
    fn id(&self) -> (EngineKind, Margin);

    /// Gives a command and waits for the answer.
    ///
    /// # Errors
    /// Why there is none.
    fn ask(&mut self, command: &str, patience: Duration) -> Result<Value, String>;

    /// Writes down a record of it.
    fn put(&self, log: &mut Log, mut record: Value) -> Result<(), String> {
        let (kind, margin) = self.id();
        (record["engine"], record["margin"]) = (kind.name().into(), name(margin).into());
        record["scene"] = log.scene.as_str().into();
        log.put(record)
    }
}

/// The engines that still play.
struct Stage<'a, P: Plays> {
    players: Vec<P>,
    log: &'a mut Log,
    patience: Duration,
    /// step \[s\]
    dt: f64,
}

impl<P: Plays> Stage<'_, P> {
    fn play(&mut self, scene: &Scene) -> Result<(), String> {
        let plan = scene.plan;
        let window = plan.burst * plan.rounds;
        self.window("start", &scene.plan)?;
        let late = plan.late.unwrap_or(plan.end).max(window);
        let watched = plan.watch.min(late - window);
        self.watch(watched, scene)?;
        self.all(&format!("run {}", late - window - watched), |_| None)?;
        let mut done = late;
        if plan.late.is_some() {
            self.window("late", &plan)?;
            done += window;
        }
        self.all(&format!("run {}", plan.end.saturating_sub(done)), |_| None)?;
        let steps = plan.end.max(done);
        self.all("truth", |answer| {
            let mut record = answer.clone();
            (record["what"], record["steps"]) = ("truth".into(), steps.into());
            Some(record)
        })
    }

    /// A window of time: a burst of every engine, round after round. Each round begins with another engine.
    fn window(&mut self, window: &str, plan: &super::scenes::Plan) -> Result<(), String> {
        for round in 0..plan.rounds {
            self.all(&format!("time {}", plan.burst), |answer| {
                let mut record = answer.clone();
                (record["what"], record["window"], record["round"]) = ("burst".into(), window.into(), round.into());
                record["steps"] = plan.burst.into();
                Some(record)
            })?;
            if !self.players.is_empty() {
                self.players.rotate_left(1);
            }
        }
        Ok(())
    }

    fn watch(&mut self, steps: u64, scene: &Scene) -> Result<(), String> {
        let dt = self.dt;
        self.all(&format!("watch {steps}"), |answer| {
            let number = |key: &str| answer[key].as_f64().unwrap_or(f64::NAN);
            let (body_steps, changes) = (number("body_steps"), number("changes"));
            let speed = number("speed") / number("steps");
            let moved = if body_steps > changes { number("moved") / (body_steps - changes) } else { f64::NAN };
            Some(json!({
                "what": "watch", "steps": answer["steps"], "rate": changes / (body_steps * dt), "speed": speed,
                "theory": scene.subject.theory(speed), "moved": moved,
            }))
        })
    }

    /// Gives all the same command, one after the other. Those that fail play no more.
    fn all(&mut self, command: &str, record: impl Fn(&Value) -> Option<Value>) -> Result<(), String> {
        for mut player in std::mem::take(&mut self.players) {
            match player.ask(command, self.patience) {
                Ok(answer) => {
                    if let Some(record) = record(&answer) {
                        player.put(self.log, record)?;
                    }
                    self.players.push(player);
                }
                Err(why) => {
                    let (kind, margin) = player.id();
                    failed(self.log, kind, margin, &why)?;
                }
            }
        }
        Ok(())
    }
}

/// An engine in a process of its own.
struct Player {
    kind: EngineKind,
    margin: Margin,
    introduction: Value,
    process: Child,
    commands: ChildStdin,
    answers: Receiver<String>,
    complaints: Arc<Mutex<VecDeque<String>>>,
    reader: Option<JoinHandle<()>>,
}

impl Player {
    fn start(
        kind: EngineKind,
        margin: Margin,
        options: &Options,
        again: &[&str],
        file: &Path,
    ) -> Result<Player, String> {
        let program = std::env::current_exe().map_err(|e| e.to_string())?;
        let mut process = Command::new(program)
            .args(again)
            .args([super::SERVE, kind.name(), name(margin), &options.threads.to_string()])
            .arg(file)
            .stdin(Stdio::piped())
            .stdout(Stdio::piped())
            .stderr(Stdio::piped())
            .spawn()
            .map_err(|e| format!("cannot start: {e}"))?;
        let (Some(commands), Some(out), Some(complaints)) =
            (process.stdin.take(), process.stdout.take(), process.stderr.take())
        else {
            return Err("cannot start: no pipes".into());
        };
        let (sender, answers) = channel();
        std::thread::spawn(move || {
            let lines = BufReader::new(out).lines().map_while(Result::ok).filter(|l| l.starts_with('{'));
            lines.map_while(|l| sender.send(l).ok()).for_each(drop);
        });
        let kept = Arc::new(Mutex::new(VecDeque::new()));
        let reader = std::thread::spawn({
            let kept = kept.clone();
            move || keep_last_lines(complaints, &kept)
        });
        let (introduction, reader) = (Value::Null, Some(reader));
        let mut player = Player { kind, margin, introduction, process, commands, answers, complaints: kept, reader };
        player.introduction = player.answer(options.patience)?;
        Ok(player)
    }

    fn answer(&mut self, patience: Duration) -> Result<Value, String> {
        match self.answers.recv_timeout(patience) {
            Ok(line) => {
                let value: Value = serde_json::from_str(&line).map_err(|e| format!("answers nonsense: {e}"))?;
                match value["error"].as_str() {
                    Some(why) => Err(why.to_string()),
                    None => Ok(value),
                }
            }
            Err(RecvTimeoutError::Timeout) => Err(format!("no answer in {} s", patience.as_secs())),
            Err(RecvTimeoutError::Disconnected) => Err(self.last_words()),
        }
    }

    /// How the process ended and what it complained of last.
    fn last_words(&mut self) -> String {
        let status = self.process.wait().map_or_else(|e| e.to_string(), |s| s.to_string());
        if let Some(reader) = self.reader.take() {
            let _ = reader.join();
        }
        let complaints = self.complaints.lock().map(|lines| lines.iter().cloned().collect::<Vec<_>>().join(" | "));
        format!("{status}: {}", complaints.unwrap_or_default())
    }
}

impl Plays for Player {
    fn id(&self) -> (EngineKind, Margin) {
        (self.kind, self.margin)
    }

    fn ask(&mut self, command: &str, patience: Duration) -> Result<Value, String> {
        // Whoever no longer reads has ended, and the answer says why.
        let _ = writeln!(self.commands, "{command}").and_then(|()| self.commands.flush());
        self.answer(patience)
    }
}

impl Drop for Player {
    fn drop(&mut self) {
        // Its work is done or it has failed: nothing in it is worth waiting for.
        let _ = self.process.kill();
        let _ = self.process.wait();
    }
}

fn keep_last_lines(from: impl Read, kept: &Mutex<VecDeque<String>>) {
    for line in BufReader::new(from).lines().map_while(Result::ok) {
        if let Ok(mut kept) = kept.lock() {
            kept.push_back(line);
            if kept.len() > 4 {
                kept.pop_front();
            }
        }
    }
}

/// The file from which all engines of a scene read it. Gone when the scene is over.
struct SceneFile(PathBuf);

impl SceneFile {
    fn new(folder: &Path, data: &SceneData) -> Result<SceneFile, String> {
        let file = SceneFile(folder.join(format!("scene-{}.bin", std::process::id())));
        data.write(&file.0)?;
        Ok(file)
    }
}

impl Drop for SceneFile {
    fn drop(&mut self) {
        let _ = std::fs::remove_file(&self.0);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::compare::scenes::catalogue;
    use std::cell::RefCell;
    use std::rc::Rc;

    /// A player that writes down what it is told, and fails at a command if it is told to.
    struct Toy {
        kind: EngineKind,
        fails_at: Option<&'static str>,
        told: Rc<RefCell<Vec<String>>>,
    }

    impl Plays for Toy {
        fn id(&self) -> (EngineKind, Margin) {
            (self.kind, Margin::Default)
        }

        fn ask(&mut self, command: &str, _: Duration) -> Result<Value, String> {
            self.told.borrow_mut().push(format!("{} {command}", self.kind.name()));
            if self.fails_at.is_some_and(|word| command.starts_with(word)) {
                return Err("it fell over".into());
            }
            Ok(json!({"steps": 4, "body_steps": 40, "changes": 10, "moved": 15, "speed": 4.0}))
        }
    }

    fn play(fails_at: Option<&'static str>) -> (Vec<String>, Vec<Value>) {
        let path = std::env::temp_dir().join(format!("mrtphys-stage-{}-{fails_at:?}", std::process::id()));
        let file = std::fs::File::create(&path).unwrap();
        let mut log = Log { file, records: Vec::new(), scene: "s".into() };
        let told = Rc::new(RefCell::new(Vec::new()));
        let toy = |kind, fails_at| Toy { kind, fails_at, told: told.clone() };
        let players = vec![toy(EngineKind::Ours, None), toy(EngineKind::Jolt, fails_at)];
        let mut stage = Stage { players, log: &mut log, patience: Duration::ZERO, dt: 1.0 / 512.0 };
        stage.play(&catalogue().remove(0).quick()).unwrap();
        let written = std::fs::read_to_string(&path).unwrap();
        let _ = std::fs::remove_file(&path);
        assert_eq!(written.lines().count(), log.records.len());
        (told.take(), log.records)
    }

    #[test]
    fn engines_take_turns_and_each_round_begins_with_another() {
        let (told, records) = play(None);
        let times: Vec<_> = told.iter().filter_map(|t| t.strip_suffix(" time 4")).collect();
        assert_eq!(times, ["ours", "jolt", "jolt", "ours", "ours", "jolt", "jolt", "ours"]);
        let steps = |t: &String| t.strip_prefix("jolt")?.split(' ').nth(2)?.parse::<u64>().ok();
        assert_eq!(told.iter().filter_map(steps).sum::<u64>(), 24, "{told:?}");
        let watch = records.iter().find(|r| r["what"] == "watch").unwrap();
        assert_eq!(watch["moved"], 0.5);
        assert_eq!(watch["rate"], 0.25 * 512.0);
    }

    #[test]
    fn one_that_fails_leaves_the_stage_and_the_others_go_on() {
        for command in ["time", "watch", "run", "truth"] {
            let (told, records) = play(Some(command));
            let failures: Vec<_> = records.iter().filter(|r| r["what"] == "failed").collect();
            assert_eq!(failures.len(), 1);
            assert_eq!((&failures[0]["engine"], &failures[0]["why"]), (&"jolt".into(), &"failed: it fell over".into()));
            assert_eq!(told.iter().filter(|t| t.starts_with("jolt") && t.contains(command)).count(), 1);
            assert_eq!(told.last().unwrap(), if command == "truth" { "jolt truth" } else { "ours truth" });
            assert!(records.iter().any(|r| r["what"] == "truth" && r["engine"] == "ours"));
        }
    }
}
