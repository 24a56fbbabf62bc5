//! Light or dark, and the size of letters.

use super::preferences::Preferences;
use eframe::egui;

/// Makes the window look as preferred.
pub fn apply(context: &egui::Context, preferences: &Preferences) {
    context.set_theme(egui::Theme::from_dark_mode(preferences.dark));
    context.set_zoom_factor(preferences.scale as f32 / 100.0);
    context.options_mut(|options| options.zoom_with_keyboard = false);
    context.all_styles_mut(|style| {
        style.spacing.item_spacing = egui::vec2(6.0, 4.0);
        style.spacing.slider_rail_height = 5.0;
        style.interaction.selectable_labels = false;
        style.interaction.tooltip_delay = 0.4;
    });
}
