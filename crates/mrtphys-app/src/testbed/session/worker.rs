//! The thread of a session.

use super::Session;
use super::command::Command;
use super::pace::RealTime;
use super::report::{Extras, Numbers, PaceReport, Report, Shot, Side, Timeline};
use mrtphys_scene::{Diagnostics, Loaded, Scene};
use mrtphys_view::{Poses, Stage};
use std::sync::mpsc::{self, Receiver, TryRecvError};
use std::sync::{Arc, Mutex, PoisonError};
use std::time::{Duration, Instant};

/// Where the thread leaves its newest report.
#[derive(Clone, Default)]
pub struct Mailbox(Arc<Mutex<Option<Report>>>);

impl Mailbox {
    /// Takes the report out, if there is one.
    pub fn take(&self, into: &mut Report) -> bool {
        let new = self.0.lock().unwrap_or_else(PoisonError::into_inner).take();
        let found = new.is_some();
        if let Some(report) = new {
            *into = report;
        }
        found
    }

    fn put(&self, report: Report) {
        *self.0.lock().unwrap_or_else(PoisonError::into_inner) = Some(report);
    }
}

/// Starts the thread.
pub fn start(scene: Scene, wake: Box<dyn Fn() + Send>) -> Result<Session, Diagnostics> {
    let loaded = scene.build()?;
    let mut worker = Worker::new(loaded);
    let report = worker.report();
    let (sender, commands) = mpsc::channel();
    let mailbox = Mailbox::default();
    let postbox = mailbox.clone();
    let thread = std::thread::spawn(move || worker.live(&commands, &postbox, &*wake));
    Ok(Session { commands: Some(sender), mailbox, thread: Some(thread), report })
}

struct Worker {
    loaded: Loaded,
    running: bool,
    number: u64,
    tick: u64,
    before: Arc<Shot>,
    shot: Arc<Shot>,
    trouble: Option<String>,
}

impl Worker {
    fn new(loaded: Loaded) -> Worker {
        let stage = Arc::new(Stage::new(&loaded));
        let mut poses = Poses::default();
        stage.read(&loaded.world, &mut poses);
        let shot = Arc::new(Shot { tick: 0, frame: 0, time: 0.0, stage, poses: Arc::new(poses) });
        Worker { loaded, running: false, number: 0, tick: 0, before: shot.clone(), shot, trouble: None }
    }

    fn live(&mut self, commands: &Receiver<Command>, mailbox: &Mailbox, wake: &dyn Fn()) {
        loop {
            match commands.try_recv() {
                Ok(command) => {
                    self.obey(command);
                    continue;
                }
                Err(TryRecvError::Disconnected) => return,
                Err(TryRecvError::Empty) => {}
            }
            if self.running {
                self.frame();
            }
            mailbox.put(self.report());
            wake();
            std::thread::sleep(Duration::from_millis(15));
        }
    }

    fn obey(&mut self, command: Command) {
        match command {
            Command::Go(on) => self.running = on,
            Command::Frame => self.frame(),
            Command::Edit { change, .. } => self.trouble = change(&mut self.loaded).err(),
            _ => {}
        }
    }

    fn frame(&mut self) {
        if let Err(e) = self.loaded.world.frame() {
            self.trouble = Some(e.to_string());
            self.running = false;
        }
        self.tick += 1;
        let stage = self.shot.stage.clone();
        let mut poses = Poses::default();
        stage.read(&self.loaded.world, &mut poses);
        let time = self.loaded.world.time();
        let shot = Shot { tick: self.tick, frame: self.tick, time, stage, poses: Arc::new(poses) };
        self.before = std::mem::replace(&mut self.shot, Arc::new(shot));
    }

    fn report(&mut self) -> Report {
        self.number += 1;
        let w = &self.loaded.world;
        let numbers = Numbers {
            settings: w.settings().clone(),
            frame: self.tick,
            time: w.time(),
            steps: w.steps(),
            bodies: w.body_count(),
            energy: w.energy(),
            ..Numbers::default()
        };
        let side = Side {
            before: self.before.clone(),
            shot: self.shot.clone(),
            numbers,
            extras: Extras::default(),
            samples: Vec::new(),
        };
        Report {
            number: self.number,
            title: self.loaded.scene.title.clone(),
            running: self.running,
            pace: PaceReport {
                real_time: RealTime::IfPossible,
                speed: 1.0,
                fps_reached: 0.0,
                skipped: 0,
                since: Instant::now(),
                blend: Duration::from_millis(15),
            },
            timeline: Timeline { first: 0, last: self.tick, now: self.tick },
            sides: vec![side],
            rival_agrees: None,
            trouble: self.trouble.clone(),
        }
    }
}
