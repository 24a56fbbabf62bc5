//! The thread of a session: commands in, steps, reports out. Nothing here waits for a window.

use super::Session;
use super::command::Command;
use super::core::{Core, News, Next};
use super::lane;
use super::report::Report;
use mrtphys_scene::{Diagnostics, Scene};
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::mpsc::{self, Receiver, RecvTimeoutError, TryRecvError};
use std::sync::{Arc, Mutex, PoisonError};
use std::time::{Duration, Instant};

/// A report that nobody has taken is replaced after so long.
const PATIENCE: Duration = Duration::from_millis(100);
/// Reports of frames may take this part of the time (one in so many).
const TELLING_PART: u32 = 5;
/// And they come no faster than this.
const SHORTEST_GAP: Duration = Duration::from_millis(4);

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

    fn is_empty(&self) -> bool {
        self.0.lock().unwrap_or_else(PoisonError::into_inner).is_none()
    }

    /// Replaces the report. What may be told only once goes over from one that was not taken: samples (merged in pairs
    /// where there are more than [`lane::MOST_SAMPLES`]) and impacts (the latest [`lane::MOST_IMPACTS`]).
    fn put(&self, mut report: Report) {
        let mut place = self.0.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some(old) = place.take() {
            for (new, old) in report.sides.iter_mut().zip(old.sides) {
                carry_over(old, new);
            }
        }
        *place = Some(report);
    }
}

fn carry_over(old: super::report::Side, new: &mut super::report::Side) {
    // After a jump back the old samples are of frames that are no more: a history cuts itself when it sees the new ones.
    let mut samples = old.samples;
    samples.append(&mut new.samples);
    new.samples = samples;
    lane::thin(&mut new.samples);
    if !new.extras.impacts.is_empty() || !old.extras.impacts.is_empty() {
        let mut impacts = old.extras.impacts;
        impacts.append(&mut new.extras.impacts);
        let extra = impacts.len().saturating_sub(lane::MOST_IMPACTS);
        impacts.drain(..extra);
        new.extras.impacts = impacts;
    }
}

/// Starts the thread.
pub fn start(scene: Scene, wake: Box<dyn Fn() + Send>) -> Result<Session, Diagnostics> {
    let mut core = Core::new(scene.build()?, Box::new(Instant::now));
    let report = core.report();
    let (sender, commands) = mpsc::channel();
    let mailbox = Mailbox::default();
    let mut worker = Worker { core, commands, mailbox: mailbox.clone(), wake, told: None };
    let thread = std::thread::Builder::new().name("session".into()).spawn(move || worker.live());
    let (thread, report) = match thread {
        Ok(thread) => (Some(thread), report),
        Err(e) => (None, Report { trouble: Some(format!("no thread for the simulation: {e}")), troubles: 1, ..report }),
    };
    Ok(Session { commands: Some(sender), mailbox, thread, report })
}

struct Worker {
    core: Core,
    commands: Receiver<Command>,
    mailbox: Mailbox,
    wake: Box<dyn Fn() + Send>,
    /// when the last report was made, and what that took
    told: Option<(Instant, Duration)>,
}

/// The session is over.
struct Over;

impl Worker {
    /// Until nobody can send commands any more. A panic is a fault of this program: it is said, and the session goes on from
    /// the last whole frame if it can.
    fn live(&mut self) {
        loop {
            let Err(panic) = catch_unwind(AssertUnwindSafe(|| while self.turn().is_ok() {})) else { return };
            let what = panic.downcast_ref::<String>().map(String::as_str);
            let what = what.or_else(|| panic.downcast_ref::<&str>().copied()).unwrap_or("unknown");
            let message = format!("the program has a fault ({what}); please report it");
            if catch_unwind(AssertUnwindSafe(|| self.core.recover(&message))).is_err() {
                let _ = catch_unwind(AssertUnwindSafe(|| {
                    let mut report = self.core.last_report();
                    report.running = false;
                    report.trouble = Some(format!("{message}. The session is over: open the scene again"));
                    report.troubles += 1;
                    self.mailbox.put(report);
                    (self.wake)();
                }));
                return;
            }
        }
    }

    /// All commands there are, one physical step, a report if it is time; then sleeps until there is something to do.
    fn turn(&mut self) -> Result<(), Over> {
        loop {
            match self.commands.try_recv() {
                Ok(command) => self.core.obey(command),
                Err(TryRecvError::Empty) => break,
                Err(TryRecvError::Disconnected) => return Err(Over),
            }
        }
        let next = self.core.work();
        let again = self.tell();
        let until = match (next, again) {
            (Next::Now, _) => return Ok(()),
            (Next::At(due), Some(again)) => due.min(again),
            (Next::At(due), None) => due,
            (Next::Never, Some(again)) => again,
            (Next::Never, None) => {
                let command = self.commands.recv().map_err(|_| Over)?;
                self.core.obey(command);
                return Ok(());
            }
        };
        match self.commands.recv_timeout(until.saturating_duration_since(Instant::now())) {
            Ok(command) => self.core.obey(command),
            Err(RecvTimeoutError::Timeout) => {}
            Err(RecvTimeoutError::Disconnected) => return Err(Over),
        }
        Ok(())
    }

    /// Makes a report, if there are news and it is time; else says when that will be.
    fn tell(&mut self) -> Option<Instant> {
        let (news, good_moment) = self.core.news();
        if news == News::None || !(good_moment || news == News::Answer) {
            return None;
        }
        let now = Instant::now();
        if let (News::Frame, Some((then, cost))) = (news, self.told) {
            let gap = SHORTEST_GAP.max(cost * TELLING_PART);
            let due = then + if self.mailbox.is_empty() { gap } else { gap.max(PATIENCE) };
            if now < due {
                return Some(due);
            }
        }
        let report = self.core.report();
        self.mailbox.put(report);
        (self.wake)();
        self.told = Some((now, now.elapsed()));
        None
    }
}
