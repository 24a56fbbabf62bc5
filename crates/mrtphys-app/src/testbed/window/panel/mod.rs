//! The panel at the right: sections under each other, each of which can be folded; and the area at the bottom.

mod animation;
mod bodies;
mod body;
mod broad_phase;
mod compare;
mod digest;
mod energies;
mod fields;
mod forces;
mod making;
mod overlays;
mod plots;
mod render;
mod scope;
mod stages;

use super::desk::Desk;
use eframe::egui;

pub use animation::meaning;
pub use bodies::throw_ball;

/// What shows a section.
type Show = Box<dyn FnMut(&mut egui::Ui, &mut Desk)>;

/// A section of the panel, or a tab at the bottom.
struct Section {
    /// for the rest of the program: `Panel::reveal`
    name: &'static str,
    /// on the screen
    title: &'static str,
    /// what it is for
    hint: &'static str,
    /// whether it is open at the start
    open: bool,
    show: Show,
}

fn section(
    name: &'static str,
    title: &'static str,
    hint: &'static str,
    open: bool,
    show: impl FnMut(&mut egui::Ui, &mut Desk) + 'static,
) -> Section {
    Section { name, title, hint, open, show: Box::new(show) }
}

/// The sections at the right, from top to bottom. A new one is a `mod` above and an entry here.
fn sections() -> Vec<Section> {
    let mut animation = animation::Animation::default();
    let mut energies = energies::Energies::default();
    let mut broad_phase = broad_phase::BroadPhase::default();
    let mut stages = stages::Stages::default();
    let mut forces = forces::Forces::default();
    let mut render = render::Render::default();
    let mut overlays = overlays::Overlays::default();
    let mut compare = compare::Compare::default();
    let mut body = body::Body::default();
    let mut bodies = bodies::Bodies::default();
    vec![
        section("animation", "Animation", "How time passes", true, move |ui, desk| animation.show(ui, desk)),
        section("energies", "Energy", "Energies, and where every joule went", true, move |ui, desk| {
            energies.show(ui, desk);
        }),
        section(
            "acceleration",
            "Acceleration",
            "How colliding pairs are found, and what it costs",
            true,
            move |ui, desk| {
                broad_phase.show(ui, desk);
            },
        ),
        section("stages", "Time per stage", "Where the computing time goes", false, move |ui, desk| {
            stages.show(ui, desk);
        }),
        section("forces", "Forces", "Gravity, viscosity, and all other fields", false, move |ui, desk| {
            forces.show(ui, desk);
        }),
        section("render", "Render", "How the picture is drawn", false, move |ui, desk| render.show(ui, desk)),
        section("overlays", "Look closer", "What is drawn over the bodies, and what their colors show", false, {
            move |ui, desk| overlays.show(ui, desk)
        }),
        section("compare", "Compare", "The same world with other settings, side by side", false, move |ui, desk| {
            compare.show(ui, desk);
        }),
        section("body", "Body", "The selected body", false, move |ui, desk| body.show(ui, desk)),
        section("bodies", "Bodies", "All bodies, and new ones", false, move |ui, desk| bodies.show(ui, desk)),
    ]
}

/// What is shown in the area at the bottom, as tabs.
fn below() -> Vec<Section> {
    let mut plots = plots::Plots::default();
    vec![section("plots", "Plots", "What happens over time", true, move |ui, desk| plots.show(ui, desk))]
}

/// All sections.
pub struct Panel {
    sections: Vec<Section>,
    below: Vec<Section>,
    /// the tab in front
    tab: usize,
    /// the section that is to be opened and shown
    wanted: Option<&'static str>,
}

impl Panel {
    /// With every section as it is at the start.
    pub fn new() -> Panel {
        Panel { sections: sections(), below: below(), tab: 0, wanted: None }
    }

    /// Opens a section, and scrolls to it.
    pub fn reveal(&mut self, name: &'static str) {
        self.wanted = Some(name);
        if let Some(tab) = self.below.iter().position(|s| s.name == name) {
            self.tab = tab;
        }
    }

    /// Name and title of every section at the right.
    pub fn titles(&self) -> impl Iterator<Item = (&'static str, &'static str)> + '_ {
        self.sections.iter().map(|s| (s.name, s.title))
    }

    /// The sections at the right.
    pub fn show(&mut self, ui: &mut egui::Ui, desk: &mut Desk) {
        let wanted = self.wanted.take();
        egui::ScrollArea::vertical().auto_shrink([false, false]).show(ui, |ui| {
            for section in &mut self.sections {
                let is_wanted = wanted == Some(section.name);
                let header = egui::CollapsingHeader::new(egui::RichText::new(section.title).strong())
                    .id_salt(section.name)
                    .default_open(section.open)
                    .open(is_wanted.then_some(true));
                let shown = header.show_unindented(ui, |ui| {
                    ui.add_space(2.0);
                    (section.show)(ui, desk);
                    ui.add_space(6.0);
                });
                let header = shown.header_response.on_hover_text(section.hint);
                desk.probes.mark(section.name, &header);
                if is_wanted {
                    header.scroll_to_me(Some(egui::Align::TOP));
                }
                ui.separator();
            }
        });
    }

    /// Whether there is anything for the area at the bottom.
    pub fn has_below(&self) -> bool {
        !self.below.is_empty()
    }

    /// The area at the bottom.
    pub fn show_below(&mut self, ui: &mut egui::Ui, desk: &mut Desk) {
        if self.below.len() > 1 {
            ui.horizontal(|ui| {
                for (i, section) in self.below.iter().enumerate() {
                    ui.selectable_value(&mut self.tab, i, section.title).on_hover_text(section.hint);
                }
            });
        }
        if let Some(section) = self.below.get_mut(self.tab) {
            (section.show)(ui, desk);
        }
    }
}
