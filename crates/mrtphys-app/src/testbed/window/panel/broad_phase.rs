//! How pairs that may collide are found, and what it costs (thesis, sections 5.3 and 7.1).

use crate::testbed::session::{Command, Numbers};
use crate::testbed::window::desk::Desk;
use crate::testbed::window::format::count;
use crate::testbed::window::pending::Pending;
use crate::testbed::window::quantity::{Entry, Slid};
use crate::testbed::window::table::columns;
use eframe::egui;
use mrtphys::def::{Algorithm, Settings};
use mrtphys::{BroadPhaseKind, World};
use std::time::Instant;

/// The choices on the panel, with their names and what they are.
const CHOICES: [(Choice, &str, &str); 4] = [
    (Choice::Spheres, "bSphere", "Brute force: the bounding spheres of all pairs of bodies are tested"),
    (Choice::Grid, "Grid", "Regular grid: only bodies in the same or neighbouring cells are tested"),
    (Choice::Adaptive, "Adaptive", "Adaptive subdivision: a cell with too many bodies is divided into eight"),
    (Choice::Sorted, "Sorted grid", "A grid whose cells are sorted by key: fast for many bodies, wherever they are"),
];

/// One of the choices.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Choice {
    Spheres,
    Grid,
    Adaptive,
    Sorted,
}

/// Cells along an edge of the grid, and the limits of the controls.
const RESOLUTIONS: std::ops::RangeInclusive<u32> = 1..=1024;
const OBJECTS: std::ops::RangeInclusive<u32> = 1..=1_000_000;
const OBJECTS_SLIDER: std::ops::RangeInclusive<f64> = 1.0..=200.0;
const DEPTHS: std::ops::RangeInclusive<u32> = 0..=48;
/// Resolution when a fixed one is first asked for.
const FIRST_RESOLUTION: u32 = 20;

/// The section.
pub struct BroadPhase {
    asked: Pending<BroadPhaseKind>,
    /// parameters that were used last: a choice comes back with them
    resolution: Option<u32>,
    tree: (u32, u32),
    /// the resolution slider's place while the grid chooses for itself
    fixed: u32,
}

impl Default for BroadPhase {
    fn default() -> BroadPhase {
        BroadPhase {
            asked: Pending::default(),
            resolution: None,
            tree: (BroadPhaseKind::DEFAULT_OBJECTS_PER_CELL, BroadPhaseKind::DEFAULT_MAX_DEPTH),
            fixed: FIRST_RESOLUTION,
        }
    }
}

impl BroadPhase {
    /// Shows it.
    pub fn show(&mut self, ui: &mut egui::Ui, desk: &mut Desk) {
        let Some(side) = desk.report().sides.first() else { return };
        let numbers = side.numbers.clone();
        let now = Instant::now();
        let mut kind = self.asked.shown(numbers.settings.broad_phase, now);
        let before = kind;
        self.remember(kind);
        ui.horizontal_wrapped(|ui| {
            for (choice, name, hint) in CHOICES {
                let shown = ui.selectable_label(choice_of(kind) == choice, name).on_hover_text(hint);
                desk.probes.mark(&format!("acceleration.{name}"), &shown);
                if shown.clicked() && choice_of(kind) != choice {
                    kind = self.with(choice);
                }
            }
        });
        self.parameters(ui, &mut kind, desk);
        if kind != before {
            self.asked.ask(kind, now);
            set(desk, move |s| s.broad_phase = kind);
        }
        algorithm(ui, &numbers.settings, desk);
        ui.add_space(4.0);
        counts(ui, &numbers, desk);
    }

    fn remember(&mut self, kind: BroadPhaseKind) {
        match kind {
            BroadPhaseKind::RegularGrid { resolution } => {
                self.resolution = resolution;
                self.fixed = resolution.unwrap_or(self.fixed);
            }
            BroadPhaseKind::AdaptiveTree { objects_per_cell, max_depth } => self.tree = (objects_per_cell, max_depth),
            BroadPhaseKind::BruteForce | BroadPhaseKind::SortedGrid => {}
        }
    }

    /// A choice with the parameters it had last.
    fn with(&self, choice: Choice) -> BroadPhaseKind {
        match choice {
            Choice::Spheres => BroadPhaseKind::BruteForce,
            Choice::Grid => BroadPhaseKind::RegularGrid { resolution: self.resolution },
            Choice::Adaptive => BroadPhaseKind::AdaptiveTree { objects_per_cell: self.tree.0, max_depth: self.tree.1 },
            Choice::Sorted => BroadPhaseKind::SortedGrid,
        }
    }

    fn parameters(&mut self, ui: &mut egui::Ui, kind: &mut BroadPhaseKind, desk: &mut Desk) {
        match kind {
            BroadPhaseKind::RegularGrid { resolution } => {
                let mut automatic = resolution.is_none();
                ui.horizontal(|ui| {
                    let hint = "The grid chooses its resolution from the sizes and the number of the bodies";
                    ui.checkbox(&mut automatic, "Resolution chosen by the grid").on_hover_text(hint);
                });
                if !automatic {
                    let entry = Entry::whole("", RESOLUTIONS, "Cells along each edge of the grid");
                    let slid = Slid::new(entry.range.clone(), true);
                    let slider = labelled(ui, "Resolution", &entry, &slid, &mut self.fixed);
                    desk.probes.mark("acceleration.resolution", &slider);
                }
                *resolution = (!automatic).then_some(self.fixed);
            }
            BroadPhaseKind::AdaptiveTree { objects_per_cell, max_depth } => {
                let entry = Entry::whole("", OBJECTS, "A cell with more bodies than this is divided into eight");
                let slid = Slid::new(OBJECTS_SLIDER, true);
                let slider = labelled(ui, "Objects per cell", &entry, &slid, objects_per_cell);
                desk.probes.mark("acceleration.objects", &slider);
                let entry = Entry::whole("", DEPTHS, "Cells are not divided more often than this");
                labelled(ui, "Deepest level", &entry, &Slid::new(entry.range.clone(), false), max_depth);
            }
            BroadPhaseKind::BruteForce | BroadPhaseKind::SortedGrid => {}
        }
    }
}

fn choice_of(kind: BroadPhaseKind) -> Choice {
    match kind {
        BroadPhaseKind::BruteForce => Choice::Spheres,
        BroadPhaseKind::RegularGrid { .. } => Choice::Grid,
        BroadPhaseKind::AdaptiveTree { .. } => Choice::Adaptive,
        BroadPhaseKind::SortedGrid => Choice::Sorted,
    }
}

/// A name, and below it a slider with its number.
fn labelled(ui: &mut egui::Ui, name: &str, entry: &Entry<'_>, slid: &Slid, value: &mut u32) -> egui::Response {
    ui.label(name).on_hover_text(entry.hint);
    entry.count_slider(ui, value, slid).0
}

fn algorithm(ui: &mut egui::Ui, settings: &Settings, desk: &mut Desk) {
    let mut algorithm = settings.algorithm;
    if Algorithm::ALL.len() < 2 {
        let line = ui.horizontal(|ui| {
            ui.label("Algorithm");
            ui.with_layout(egui::Layout::right_to_left(egui::Align::Center), |ui| ui.label(algorithm.name()));
        });
        line.response.on_hover_text("How time is stepped. This version has one algorithm");
        return;
    }
    ui.horizontal(|ui| {
        ui.label("Algorithm");
        egui::ComboBox::from_id_salt("algorithm").selected_text(algorithm.name()).show_ui(ui, |ui| {
            for (name, value) in Algorithm::ALL {
                ui.selectable_value(&mut algorithm, *value, *name);
            }
        });
    });
    if algorithm != settings.algorithm {
        set(desk, move |s| s.algorithm = algorithm);
    }
}

/// Changes the settings, between two steps.
fn set(desk: &Desk, change: impl Fn(&mut Settings) + Send + 'static) {
    let on = move |world: &mut World| {
        let mut settings = world.settings().clone();
        change(&mut settings);
        world.set_settings(settings).map_err(|e| e.to_string())
    };
    desk.send(Command::Edit { change: Box::new(move |loaded| on(&mut loaded.world)), structural: false });
}

/// What is counted, with its meaning: name, value of the last step, total.
fn counted(n: &Numbers) -> Vec<(&'static str, u64, u64, &'static str)> {
    let (a, b) = (&n.counters, &n.totals);
    let lines = [
        ("bSphere calls", a.sphere_tests, b.sphere_tests, "Tests of two bounding spheres"),
        (
            "detect calls",
            a.detect_calls,
            b.detect_calls,
            "Tests of two shapes: made where the bounding spheres do not exclude a collision",
        ),
        ("contacts", a.contacts, b.contacts, "Points where two bodies touch or overlap"),
        ("impacts", a.impacts, b.impacts, "Contacts with an impulse, between bodies"),
        ("wall impacts", a.wall_impacts, b.wall_impacts, "Impacts of a body on a boundary"),
    ];
    let rare = [
        ("fallbacks", a.fallbacks, b.fallbacks, "Contacts that needed the slower, safer routine"),
        ("projections", a.projections, b.projections, "Overlaps that were pushed apart"),
        ("undecided", a.undecided, b.undecided, "Tests that could not be decided: none is expected"),
        ("quarantined", a.quarantined, b.quarantined, "Bodies set aside since their motion was no longer finite"),
    ];
    lines.into_iter().chain(rare).collect()
}

/// Widths of the columns \[points\].
const STEP: f32 = 76.0;
const TOTAL: f32 = 108.0;

fn counts(ui: &mut egui::Ui, numbers: &Numbers, desk: &mut Desk) {
    let head = |text: &str| egui::RichText::new(text).weak();
    let hint = "Counts of the last physical step, and since the start";
    let gap = ui.spacing_mut().item_spacing.y;
    ui.spacing_mut().item_spacing.y = 3.0;
    columns(ui, head(""), &[(head("last step"), STEP), (head("total"), TOTAL)], hint);
    for (name, step, total, hint) in counted(numbers) {
        let value = |n: u64| egui::RichText::new(count(n)).monospace();
        for (n, what) in [(step, "step"), (total, "total")] {
            desk.probes.say(|| format!("acceleration.{name}.{what}"), &count(n));
        }
        columns(ui, egui::RichText::new(name), &[(value(step), STEP), (value(total), TOTAL)], hint);
    }
    ui.spacing_mut().item_spacing.y = gap;
}

#[cfg(test)]
mod tests {
    use super::*;
    use mrtphys::counters::Counters;

    #[test]
    fn every_counter_is_shown_once() {
        let all = Counters::from_array([1, 2, 3, 4, 5, 6, 7, 8, 9]);
        let numbers = Numbers { counters: all, ..Numbers::default() };
        let shown: Vec<u64> = counted(&numbers).iter().map(|line| line.1).collect();
        assert_eq!(shown, all.to_array());
    }

    #[test]
    fn a_choice_comes_back_with_its_parameters() {
        let mut section = BroadPhase::default();
        section.remember(BroadPhaseKind::RegularGrid { resolution: Some(7) });
        section.remember(BroadPhaseKind::AdaptiveTree { objects_per_cell: 9, max_depth: 3 });
        section.remember(BroadPhaseKind::SortedGrid);
        for (choice, text) in [
            (Choice::Spheres, "brute-force"),
            (Choice::Grid, "regular-grid:7"),
            (Choice::Adaptive, "adaptive-tree:9:3"),
            (Choice::Sorted, "sorted-grid"),
        ] {
            let kind = section.with(choice);
            assert_eq!((kind.to_string().as_str(), choice_of(kind)), (text, choice));
        }
    }
}
