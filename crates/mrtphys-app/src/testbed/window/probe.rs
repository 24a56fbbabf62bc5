//! Where named controls are and what the panel says, so that a test can click and read it.

use eframe::egui;
use std::collections::BTreeMap;

/// Names and places of the controls of the picture that is being made. Costs nothing unless somebody asked for it.
#[derive(Debug, Default)]
pub struct Probes {
    wanted: bool,
    places: BTreeMap<String, egui::Rect>,
    said: BTreeMap<String, String>,
}

impl Probes {
    /// That notes places only if they are wanted.
    pub fn new(wanted: bool) -> Probes {
        Probes { wanted, ..Probes::default() }
    }

    /// Notes where a control is, if it can be seen.
    pub fn mark(&mut self, name: &str, response: &egui::Response) {
        let visible = response.rect.intersect(response.interact_rect);
        if self.wanted && visible.is_positive() {
            self.places.insert(name.to_string(), visible);
        }
    }

    /// Forgets everything: a new picture begins.
    pub fn clear(&mut self) {
        self.places.clear();
        self.said.clear();
    }

    /// Notes what the panel says somewhere.
    pub fn say(&mut self, name: impl FnOnce() -> String, text: &str) {
        if self.wanted {
            self.said.insert(name(), text.to_string());
        }
    }

    /// What the panel says, by name.
    pub fn said(&self) -> &BTreeMap<String, String> {
        &self.said
    }

    /// The controls by name, in points.
    pub fn places(&self) -> impl Iterator<Item = (&str, egui::Rect)> {
        self.places.iter().map(|(name, rect)| (name.as_str(), *rect))
    }
}
