//! Light or dark, and the size of letters.

use super::preferences::Preferences;
use eframe::egui;

/// Makes the window look as preferred.
pub fn apply(context: &egui::Context, preferences: &Preferences) {
    context.set_theme(egui::Theme::from_dark_mode(preferences.dark));
    context.set_zoom_factor(preferences.scale as f32 / 100.0);
    context.options_mut(|options| options.zoom_with_keyboard = false);
    // The usual grey of labels is hard to read on a projector.
    for (theme, grey) in [(egui::Theme::Dark, 200), (egui::Theme::Light, 40)] {
        context.style_mut_of(theme, |style| {
            style.visuals.widgets.noninteractive.fg_stroke.color = egui::Color32::from_gray(grey);
        });
    }
    context.all_styles_mut(|style| {
        style.spacing.item_spacing = egui::vec2(6.0, 4.0);
        style.spacing.slider_rail_height = 5.0;
        // A bar beside what it scrolls, not over it.
        style.spacing.scroll = egui::style::ScrollStyle { bar_width: 8.0, ..egui::style::ScrollStyle::solid() };
        style.interaction.selectable_labels = false;
        style.interaction.tooltip_delay = 0.4;
    });
}
