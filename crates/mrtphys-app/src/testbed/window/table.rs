//! Tables of names and values in the panel.

use super::probe::Probes;
use eframe::egui;

/// Two columns: names at the left, values at the right edge in letters of one width.
/// Tests know them by the group's name and theirs.
pub fn rows(ui: &mut egui::Ui, probes: &mut Probes, group: &str, rows: &[Row<'_>]) {
    ui.scope(|ui| {
        ui.spacing_mut().item_spacing.y = 3.0;
        for row in rows {
            line(ui, row);
            probes.say(|| format!("{group}.{}", row.name), &row.value);
        }
    });
}

/// Height of a line \[points\].
const LINE: f32 = 16.0;

/// A line of a table.
pub struct Row<'a> {
    /// at the left
    pub name: &'a str,
    /// at the right
    pub value: String,
    /// explains both
    pub hint: &'a str,
    /// a sum, which stands out
    pub strong: bool,
}

impl<'a> Row<'a> {
    /// An ordinary line.
    pub fn new(name: &'a str, value: impl Into<String>, hint: &'a str) -> Row<'a> {
        Row { name, value: value.into(), hint, strong: false }
    }

    /// A line that stands out.
    pub fn sum(name: &'a str, value: impl Into<String>, hint: &'a str) -> Row<'a> {
        Row { strong: true, ..Row::new(name, value, hint) }
    }
}

/// Lines stand closer than controls do.
fn close(ui: &mut egui::Ui) {
    ui.spacing_mut().interact_size.y = LINE;
    ui.spacing_mut().item_spacing.y = 2.0;
}

/// A line with several values, each right-aligned in a column of its width \[points\], the last at the right edge.
pub fn columns(ui: &mut egui::Ui, name: egui::RichText, values: &[(egui::RichText, f32)], hint: &str) {
    let line = ui.horizontal(|ui| {
        close(ui);
        ui.label(name);
        ui.with_layout(egui::Layout::right_to_left(egui::Align::Center), |ui| {
            for (value, width) in values.iter().rev() {
                ui.allocate_ui_with_layout(
                    egui::vec2(*width, LINE),
                    egui::Layout::right_to_left(egui::Align::Center),
                    |ui| {
                        ui.set_min_width(*width);
                        ui.add(egui::Label::new(value.clone()).truncate());
                    },
                );
            }
        });
    });
    line.response.on_hover_text(hint);
}

fn line(ui: &mut egui::Ui, row: &Row<'_>) {
    let line = ui.horizontal(|ui| {
        close(ui);
        let mut name = egui::RichText::new(row.name);
        let mut value = egui::RichText::new(&row.value).monospace();
        if row.strong {
            (name, value) = (name.strong(), value.strong());
        }
        ui.label(name);
        ui.with_layout(egui::Layout::right_to_left(egui::Align::Center), |ui| {
            ui.add(egui::Label::new(value).truncate());
        });
    });
    line.response.on_hover_text(row.hint);
}
