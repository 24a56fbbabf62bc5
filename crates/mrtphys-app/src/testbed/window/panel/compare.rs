//! Section Compare: a rival world from the same state, with other settings, beside the first.

use crate::testbed::session::{Command, Numbers, Sample};
use crate::testbed::window::desk::Desk;
use crate::testbed::window::format::{count, deviation, drift, duration};
use crate::testbed::window::labels;
use crate::testbed::window::quantity::Entry;
use eframe::egui;
use mrtphys::def::{BroadPhaseKind, FrictionLaw, ImpactMode, Integrator, Settings};
use std::collections::VecDeque;
use std::time::Duration;

/// Frames over which the median is taken.
const WINDOW: usize = 120;

/// The middle one of the latest step times.
#[derive(Clone, Debug, Default)]
struct Median {
    latest: VecDeque<Duration>,
}

impl Median {
    fn extend(&mut self, samples: &[Sample]) {
        for s in samples.iter().filter(|s| s.steps > 0) {
            if self.latest.len() == WINDOW {
                self.latest.pop_front();
            }
            self.latest.push_back(s.cost.div_f64(s.steps as f64));
        }
    }

    fn value(&self) -> Option<Duration> {
        let mut sorted: Vec<Duration> = self.latest.iter().copied().collect();
        sorted.sort_unstable();
        sorted.get(sorted.len() / 2).copied()
    }
}

/// The section.
#[derive(Default)]
pub struct Compare {
    /// what the rival is to have; `None`: nothing was chosen yet
    chosen: Option<Settings>,
    steps: [Median; 2],
    /// the report that was taken last, and of which scene
    taken: (u64, u64),
}

impl Compare {
    /// Shows it.
    pub fn show(&mut self, ui: &mut egui::Ui, desk: &mut Desk) {
        let report = desk.report();
        let runs = report.sides.len() > 1;
        self.take(desk, runs);
        let own = &report.sides[0].numbers.settings;
        if !runs && self.chosen.as_ref().is_none_or(|c| !comparable(c, own)) {
            self.chosen = Some(first_choice(own));
        }
        let Some(mut settings) = self.chosen.clone() else { return };
        choices(ui, &mut settings);
        let changed = self.chosen.as_ref() != Some(&settings);
        self.chosen = Some(settings.clone());
        ui.horizontal(|ui| {
            let (label, hint) = if runs {
                ("Stop comparing", "the rival goes, the world goes on")
            } else {
                ("Compare", "copies the world as it is now, and runs the copy beside it with these settings")
            };
            let response = ui.button(label).on_hover_text(hint);
            desk.probes.mark("compare", &response);
            if response.clicked() {
                self.steps = Default::default();
                desk.send(Command::Rival((!runs).then(|| settings.clone())));
            } else if runs && changed {
                self.steps = Default::default();
                desk.send(Command::Rival(Some(settings.clone())));
            }
        });
        if runs {
            self.table(ui, desk);
        } else {
            ui.weak("Both worlds then do the same steps from the same state; every edit goes to both.");
        }
    }

    /// Takes the step times of a new report.
    fn take(&mut self, desk: &Desk, runs: bool) {
        let report = desk.report();
        if self.taken.1 != desk.opened || !runs {
            self.steps = Default::default();
        }
        if self.taken.1 != desk.opened {
            self.chosen = None;
        }
        if self.taken != (report.number, desk.opened) {
            self.steps.iter_mut().zip(&report.sides).for_each(|(median, side)| median.extend(&side.samples));
            self.taken = (report.number, desk.opened);
        }
    }

    fn table(&self, ui: &mut egui::Ui, desk: &Desk) {
        let report = desk.report();
        let [a, b] = [0, 1].map(|i| report.sides.get(i).map(|s| &s.numbers));
        let (Some(a), Some(b)) = (a, b) else { return };
        let medians = [&self.steps[0], &self.steps[1]].map(|m| m.value().map_or("-".into(), duration));
        egui::Grid::new("compare").num_columns(3).striped(true).spacing([10.0, 3.0]).show(ui, |ui| {
            let mut row = |name: &str, values: [String; 2], hint: &str| {
                ui.label(name).on_hover_text(hint);
                for value in values {
                    ui.monospace(value);
                }
                ui.end_row();
            };
            row("", ["world".into(), "rival".into()], "");
            row("time per step", medians, "computing time of a physical step, the median of the latest frames");
            let tests = [a, b].map(|n| count(n.counters.sphere_tests));
            row("sphere tests", tests, "bounding-sphere tests of the last step");
            row(
                "detect calls",
                [a, b].map(|n| count(n.counters.detect_calls)),
                "calls of pair routines in the last step",
            );
            row("contacts", [a, b].map(|n| count(n.counters.contacts)), "contacts of the last step");
            row("impacts", [a, b].map(|n| count(n.totals.impacts)), "impacts since the start");
            row("E/E0 - 1", [a, b].map(drift_of), "relative change of the total energy since the start");
        });
        if let Some(agrees) = report.rival_agrees {
            ui.label(labels::agreement(agrees)).on_hover_text("the hashes of both states after the same steps");
        }
    }
}

fn drift_of(n: &Numbers) -> String {
    drift(n.energy.total(), n.initial_energy.total()).map_or("-".into(), deviation)
}

/// Whether a rival with these settings can run beside a world with those: what is fixed when a world is made is the same.
fn comparable(rival: &Settings, own: &Settings) -> bool {
    (rival.contact, rival.inertia) == (own.contact, own.inertia)
}

/// Another broad phase: the comparison of the thesis's chapter 5, and one whose states agree.
fn first_choice(own: &Settings) -> Settings {
    let broad_phase = match own.broad_phase {
        BroadPhaseKind::BruteForce => BroadPhaseKind::SortedGrid,
        _ => BroadPhaseKind::BruteForce,
    };
    Settings { broad_phase, ..own.clone() }
}

/// The broad phases that can be chosen.
fn broad_phases() -> [(&'static str, BroadPhaseKind); 4] {
    let (objects_per_cell, max_depth) = (BroadPhaseKind::DEFAULT_OBJECTS_PER_CELL, BroadPhaseKind::DEFAULT_MAX_DEPTH);
    [
        ("brute-force", BroadPhaseKind::BruteForce),
        ("regular-grid", BroadPhaseKind::RegularGrid { resolution: None }),
        ("adaptive-tree", BroadPhaseKind::AdaptiveTree { objects_per_cell, max_depth }),
        ("sorted-grid", BroadPhaseKind::SortedGrid),
    ]
}

fn choices(ui: &mut egui::Ui, s: &mut Settings) {
    egui::Grid::new("rival settings").num_columns(2).spacing([8.0, 4.0]).show(ui, |ui| {
        ui.label("Broad phase").on_hover_text("how candidates for contact are found; the state is the same with each");
        egui::ComboBox::from_id_salt("rival broad phase").selected_text(s.broad_phase.to_string()).show_ui(ui, |ui| {
            for (name, kind) in broad_phases() {
                ui.selectable_value(&mut s.broad_phase, kind, name);
            }
        });
        ui.end_row();
        parameters(ui, &mut s.broad_phase);
        choice(ui, "Friction law", "how an impact with friction is answered", FrictionLaw::ALL, &mut s.friction_law);
        choice(ui, "Impacts", "how simultaneous impacts are answered", ImpactMode::ALL, &mut s.impact);
        choice(ui, "Integrator", "motion between impacts", Integrator::ALL, &mut s.integrator);
        ui.label("Steps per frame").on_hover_text("physical steps per frame");
        let hint = "physical steps per frame: shorter steps find contacts earlier";
        Entry::whole("", 1..=10_000, hint).count(ui, &mut s.steps_per_frame);
        ui.end_row();
    });
}

fn parameters(ui: &mut egui::Ui, kind: &mut BroadPhaseKind) {
    match kind {
        BroadPhaseKind::RegularGrid { resolution } => {
            ui.label("Resolution").on_hover_text("cells along each axis; automatic: twice the cube root of the bodies");
            ui.horizontal(|ui| {
                let mut own = resolution.is_some();
                ui.checkbox(&mut own, "").on_hover_text("a number of your own");
                *resolution = own.then(|| resolution.unwrap_or(16));
                match resolution {
                    Some(n) => drop(Entry::whole("", 1..=1024, "cells along each axis").count(ui, n)),
                    None => drop(ui.weak("automatic")),
                }
            });
            ui.end_row();
        }
        BroadPhaseKind::AdaptiveTree { objects_per_cell, max_depth } => {
            ui.label("Objects per cell").on_hover_text("a cell with more is split");
            ui.horizontal(|ui| {
                Entry::whole("", 1..=1_000_000, "a cell with more is split").count(ui, objects_per_cell);
                ui.label("depth");
                Entry::whole("", 0..=48, "deepest level").count(ui, max_depth);
            });
            ui.end_row();
        }
        BroadPhaseKind::BruteForce | BroadPhaseKind::SortedGrid => {}
    }
}

fn choice<T: Copy + PartialEq>(ui: &mut egui::Ui, label: &str, hint: &str, all: &[(&'static str, T)], value: &mut T) {
    ui.label(label).on_hover_text(hint);
    let name = all.iter().find(|c| c.1 == *value).map_or("", |c| c.0);
    egui::ComboBox::from_id_salt(label).selected_text(name).show_ui(ui, |ui| {
        for (name, v) in all {
            ui.selectable_value(value, *v, *name);
        }
    });
    ui.end_row();
}

#[cfg(test)]
mod tests {
    use super::*;
    use mrtphys::def::ContactMode;

    #[test]
    fn the_median_is_of_the_latest_and_of_one_step() {
        let sample = |us: u64, steps: u64| Sample { cost: Duration::from_micros(us), steps, ..Sample::default() };
        let mut m = Median::default();
        assert_eq!(m.value(), None);
        m.extend(&[sample(80, 8), sample(160, 8), sample(9_000_000, 8), sample(5, 0)]);
        assert_eq!(m.value(), Some(Duration::from_micros(20)), "one slow frame does not matter");
        m.extend(&vec![sample(30, 1); WINDOW]);
        assert_eq!((m.value(), m.latest.len()), (Some(Duration::from_micros(30)), WINDOW));
    }

    #[test]
    fn the_rival_differs_at_first_by_its_broad_phase() {
        for (_, broad_phase) in broad_phases() {
            let own = Settings { broad_phase, ..Settings::default() };
            let rival = first_choice(&own);
            assert!(rival.broad_phase != own.broad_phase && comparable(&rival, &own));
            assert_eq!(Settings { broad_phase, ..rival }, own);
        }
        let thesis = Settings { contact: ContactMode::Thesis, ..Settings::default() };
        assert!(!comparable(&thesis, &Settings::default()));
    }
}
