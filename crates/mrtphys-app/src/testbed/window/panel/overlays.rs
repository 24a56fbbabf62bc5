//! Section Look closer: what is drawn over the bodies, and what their colors show.

use crate::testbed::window::desk::Desk;
use crate::testbed::window::format::{count, number};
use crate::testbed::window::quantity::{Entry, Slid};
use crate::testbed::window::seeing::{LONGEST_TRAIL, Layer};
use eframe::egui::{self, Color32};
use mrtphys_view::explain::Inks;
use mrtphys_view::{Coloring, Drawn};

/// The section.
#[derive(Default)]
pub struct Overlays {}

impl Overlays {
    /// Shows it.
    pub fn show(&mut self, ui: &mut egui::Ui, desk: &mut Desk) {
        let inks = Inks::of(desk.look.theme);
        for (layer, name, hint) in Layer::ALL {
            ui.horizontal(|ui| {
                let mut on = desk.seeing.sight.has(layer);
                let response = ui.checkbox(&mut on, name).on_hover_text(hint);
                desk.probes.mark(name, &response);
                if response.changed() {
                    desk.seeing.sight.set(layer, on);
                }
                colors(layer, &inks).iter().for_each(|c| sample(ui, *c));
                let drawn = desk.seeing.drawn.iter().find(|(l, _)| *l == layer).map(|(_, d)| *d);
                if let Some(text) = drawn.filter(|_| on).and_then(left_out) {
                    let text = egui::RichText::new(text).small().color(ui.visuals().warn_fg_color);
                    ui.label(text)
                        .on_hover_text("more would be too many to draw; those shown are spread evenly over all");
                }
            });
        }
        ui.horizontal(|ui| {
            ui.label("Trail");
            let entry =
                Entry::whole("frames", 2..=LONGEST_TRAIL as u32, "length of trails; they come from the recording");
            let mut trail = desk.seeing.sight.trail as u32;
            let slid = Slid { number: 86.0, ..Slid::new(entry.range.clone(), true) };
            if entry.count_slider(ui, &mut trail, &slid).1 {
                desk.seeing.sight.trail = trail as usize;
            }
        });
        ui.checkbox(&mut desk.seeing.labels, "Names and speeds")
            .on_hover_text("name and speed stand beside the selected body and the one under the mouse");
        ui.horizontal(|ui| {
            ui.label("Color by");
            let coloring = &mut desk.seeing.sight.coloring;
            let name = Coloring::ALL.iter().find(|(c, _)| c == coloring).map_or("own", |(_, n)| n);
            egui::ComboBox::from_id_salt("coloring").selected_text(name).show_ui(ui, |ui| {
                for (c, name) in Coloring::ALL {
                    ui.selectable_value(coloring, c, name);
                }
            });
        })
        .response
        .on_hover_text("what the colors of bodies show; 'own' are the scene's. A legend is in the picture.");
        for legend in &desk.seeing.legends {
            let unit = if legend.unit.is_empty() { "" } else { legend.unit };
            if !legend.samples.is_empty() {
                ui.weak(format!("{}: {} to {} {unit}", legend.title, number(legend.min), number(legend.max)));
            }
        }
    }
}

/// The colors that a layer is drawn with; none for those with a legend of their own.
fn colors(layer: Layer, inks: &Inks) -> Vec<[u8; 3]> {
    match layer {
        Layer::Contacts => vec![inks.contact, inks.normal],
        Layer::Impulses => vec![inks.impulse],
        Layer::Velocities => vec![inks.velocity],
        Layer::Spins => vec![inks.spin],
        Layer::Balls => vec![inks.ball],
        Layer::Boxes => vec![inks.aabb],
        Layer::Trails | Layer::Cells => Vec::new(),
    }
}

fn sample(ui: &mut egui::Ui, [r, g, b]: [u8; 3]) {
    let (rect, _) = ui.allocate_exact_size(egui::vec2(14.0, 10.0), egui::Sense::hover());
    ui.painter().rect_filled(rect, 3.0, Color32::from_rgb(r, g, b));
}

/// What is to be said where not all was drawn.
fn left_out(drawn: Drawn) -> Option<String> {
    let (some, all) = (count(drawn.drawn as u64), count(drawn.total as u64));
    drawn.is_part().then(|| format!("{some} of {all}"))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_left_out_is_said() {
        assert_eq!(left_out(Drawn { drawn: 20_000, total: 103_823 }), Some("20 000 of 103 823".into()));
        assert_eq!(left_out(Drawn { drawn: 7, total: 7 }), None);
    }

    #[test]
    fn every_layer_has_its_own_colors_or_a_legend() {
        for theme in [mrtphys_view::Theme::Light, mrtphys_view::Theme::Dark] {
            let inks = Inks::of(theme);
            let mut all: Vec<[u8; 3]> = Layer::ALL.iter().flat_map(|l| colors(l.0, &inks)).collect();
            let n = all.len();
            all.sort_unstable();
            all.dedup();
            assert_eq!((n, all.len()), (7, 7));
        }
    }
}
