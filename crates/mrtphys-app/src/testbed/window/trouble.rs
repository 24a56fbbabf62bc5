//! What is wrong with a scene: everything that was found, with the place in the text.

use super::action::Action;
use super::desk::Desk;
use super::opening::Origin;
use eframe::egui;
use mrtphys_scene::Diagnostics;

/// The window that shows it.
#[derive(Default)]
pub struct Trouble {
    found: Option<(Origin, Diagnostics)>,
}

impl Trouble {
    /// Shows what is wrong with a scene.
    pub fn set(&mut self, origin: Origin, found: Diagnostics) {
        self.found = Some((origin, found));
    }

    /// The scene is fine, or another one is open.
    pub fn clear(&mut self) {
        self.found = None;
    }

    /// The text that is shown, if any.
    pub fn text(&self) -> Option<String> {
        self.found.as_ref().map(|(_, found)| found.to_string())
    }

    /// The scene that is wrong.
    pub fn origin(&self) -> Option<&Origin> {
        self.found.as_ref().map(|(origin, _)| origin)
    }

    /// Shows the window.
    pub fn show(&mut self, context: &egui::Context, desk: &mut Desk) {
        let Some((origin, found)) = &self.found else { return };
        let count = found.list.len() + found.more;
        let title = if count == 1 { "Error in the scene".into() } else { format!("{count} errors in the scene") };
        let mut open = true;
        let mut dismissed = false;
        egui::Window::new(title)
            .id(egui::Id::unique("trouble"))
            .open(&mut open)
            .collapsible(false)
            .default_width(620.0)
            .pivot(egui::Align2::CENTER_CENTER)
            .default_pos(context.content_rect().center())
            .show(context, |ui| {
                ui.label(format!("{} cannot be opened. The scene before it goes on.", origin.name()));
                ui.add_space(4.0);
                let height = (0.5 * context.content_rect().height()).max(120.0);
                egui::ScrollArea::both().max_height(height).auto_shrink([false, true]).show(ui, |ui| {
                    for diagnostic in &found.list {
                        show_one(ui, diagnostic);
                    }
                    if found.more > 0 {
                        ui.label(format!("and {} more", found.more));
                    }
                });
                ui.separator();
                ui.horizontal(|ui| {
                    let reload = ui.button("Reload").on_hover_text("Read the scene again (Ctrl+R)");
                    desk.probes.mark("trouble.reload", &reload);
                    if reload.clicked() {
                        desk.actions.push(Action::Reload);
                    }
                    if ui.button("Copy").on_hover_text("Put the text on the clipboard").clicked() {
                        ui.ctx().copy_text(found.to_string());
                    }
                    let dismiss = ui.button("Dismiss").on_hover_text("Close this window (Escape)");
                    desk.probes.mark("trouble.dismiss", &dismiss);
                    dismissed = dismiss.clicked();
                });
            });
        if !open || dismissed {
            self.found = None;
        }
    }
}

fn show_one(ui: &mut egui::Ui, diagnostic: &mrtphys_scene::Diagnostic) {
    let text = diagnostic.to_string();
    // The headline wraps; the line of the text and its caret must not.
    let (headline, place) = text.split_once('\n').unwrap_or((&text, ""));
    let error = ui.visuals().error_fg_color;
    ui.add(egui::Label::new(egui::RichText::new(headline).monospace().color(error)).wrap());
    if !place.is_empty() {
        ui.add(egui::Label::new(egui::RichText::new(place).monospace()).extend());
    }
    ui.add_space(6.0);
}
