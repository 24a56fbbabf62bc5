//! Work in the background: it says how far it is, can be called off, and tells in the end what came of it.

use super::desk::Message;
use eframe::egui;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering::Relaxed};
use std::sync::mpsc::{self, Receiver, Sender, TryRecvError};

/// How far a job is.
#[derive(Debug, Default)]
pub struct Progress {
    done: AtomicU64,
    total: AtomicU64,
    called_off: AtomicBool,
}

impl Progress {
    /// So much of so much is done.
    pub fn set(&self, done: u64, total: u64) {
        self.done.store(done, Relaxed);
        self.total.store(total, Relaxed);
    }

    /// Whether the user called it off.
    pub fn is_called_off(&self) -> bool {
        self.called_off.load(Relaxed)
    }
}

/// The worker's end of a job. If it goes without a word, the user is told that too.
pub struct Ticket {
    /// how far it is
    pub progress: Arc<Progress>,
    sender: Sender<Message>,
    context: egui::Context,
}

impl Ticket {
    /// Tells how it ended. `None`: called off, which the user knows.
    pub fn end(self, result: Result<Option<String>, String>) {
        let message = match result {
            Ok(Some(text)) => Some(Message { is_error: false, text }),
            Ok(None) => None,
            Err(text) => Some(Message { is_error: true, text }),
        };
        let text = message.unwrap_or(Message { is_error: false, text: String::new() });
        let _ = self.sender.send(text);
        self.context.request_repaint();
    }

    /// Tells how far it is.
    pub fn progress(&self, done: u64, total: u64) {
        self.progress.set(done, total);
        self.context.request_repaint();
    }
}

struct Job {
    name: String,
    can_stop: bool,
    progress: Arc<Progress>,
    receiver: Receiver<Message>,
}

/// The jobs under way.
#[derive(Default)]
pub struct Jobs {
    list: Vec<Job>,
}

impl Jobs {
    /// A new job.
    pub fn begin(&mut self, name: impl Into<String>, can_stop: bool, context: &egui::Context) -> Ticket {
        let (sender, receiver) = mpsc::channel();
        let progress = Arc::new(Progress::default());
        self.list.push(Job { name: name.into(), can_stop, progress: progress.clone(), receiver });
        Ticket { progress, sender, context: context.clone() }
    }

    /// Collects what has ended.
    pub fn poll(&mut self, messages: &mut Vec<Message>) {
        self.list.retain(|job| match job.receiver.try_recv() {
            Ok(message) => {
                if !message.text.is_empty() {
                    messages.push(message);
                }
                false
            }
            Err(TryRecvError::Empty) => true,
            Err(TryRecvError::Disconnected) => {
                messages.push(Message { is_error: true, text: format!("{}: broke off", job.name) });
                false
            }
        });
    }

    /// How many there are.
    pub fn count(&self) -> usize {
        self.list.len()
    }

    /// Shows those that can be called off, at the lower right of a place.
    pub fn show(&self, context: &egui::Context, within: egui::Rect) {
        if !self.list.iter().any(|job| job.can_stop) {
            return;
        }
        let area =
            egui::Area::new(egui::Id::unique("jobs")).order(egui::Order::Foreground).pivot(egui::Align2::RIGHT_BOTTOM);
        area.fixed_pos(within.right_bottom() - egui::vec2(10.0, 10.0)).show(context, |ui| {
            for job in self.list.iter().filter(|job| job.can_stop) {
                egui::Frame::popup(ui.style()).show(ui, |ui| show_one(ui, job));
            }
        });
    }
}

fn show_one(ui: &mut egui::Ui, job: &Job) {
    let (done, total) = (job.progress.done.load(Relaxed), job.progress.total.load(Relaxed));
    ui.label(&job.name);
    ui.horizontal(|ui| {
        let part = if total > 0 { done as f32 / total as f32 } else { 0.0 };
        ui.add(egui::ProgressBar::new(part).desired_width(180.0).text(format!("{done} of {total}")));
        let stopping = job.progress.is_called_off();
        let cancel =
            ui.add_enabled(!stopping, egui::Button::new("Cancel")).on_hover_text("Call it off; nothing is written");
        if cancel.clicked() {
            job.progress.called_off.store(true, Relaxed);
        }
    });
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_job_tells_how_it_ended_once() {
        let (mut jobs, mut said) = (Jobs::default(), Vec::new());
        let context = egui::Context::default();
        let good = jobs.begin("film", true, &context);
        let bad = jobs.begin("picture", false, &context);
        let quiet = jobs.begin("called off", true, &context);
        let lost = jobs.begin("lost", true, &context);
        jobs.poll(&mut said);
        assert!(said.is_empty() && jobs.count() == 4);
        good.end(Ok(Some("written".into())));
        bad.end(Err("disk full".into()));
        quiet.end(Ok(None));
        drop(lost);
        jobs.poll(&mut said);
        let said: Vec<(bool, &str)> = said.iter().map(|m| (m.is_error, m.text.as_str())).collect();
        assert_eq!(said, [(false, "written"), (true, "disk full"), (true, "lost: broke off")]);
        assert_eq!(jobs.count(), 0);
    }
}
