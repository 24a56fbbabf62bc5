//! The menu bar: File, Render, Forces, View and Help (thesis, section 7.1).

use super::action::Action;
use super::desk::Desk;
use super::keys::name_of;
use super::preferences::Preferences;
use eframe::egui;
use mrtphys_view::mesh::FINEST;
use mrtphys_view::{Mode, Quality};

/// What the menus need to know.
pub struct Facts<'a> {
    /// whether the panel is shown
    pub side_panel: bool,
    /// whether the area at the bottom is shown; `None`: there is nothing for it
    pub below: Option<bool>,
    /// sections of the panel: name and title
    pub sections: &'a [(&'static str, &'static str)],
}

/// Shows the bar.
pub fn show(ui: &mut egui::Ui, desk: &mut Desk, preferences: &mut Preferences, facts: &Facts<'_>) {
    egui::MenuBar::new().ui(ui, |ui| {
        let menus: [(&str, &str); 5] = [
            ("menu.file", "File"),
            ("menu.render", "Render"),
            ("menu.forces", "Forces"),
            ("menu.view", "View"),
            ("menu.help", "Help"),
        ];
        for (name, title) in menus {
            let shown = ui.menu_button(title, |ui| match title {
                "File" => file(ui, desk, preferences),
                "Render" => render(ui, desk),
                "Forces" => sections(ui, desk, facts, &["forces", "body"]),
                "View" => view(ui, desk, preferences, facts),
                _ => {
                    item(ui, desk, "Help", Action::Help, "Mouse, keys and modes");
                    item(ui, desk, "About mrtphys", Action::About, "Version, driver and licence");
                }
            });
            desk.probes.mark(name, &shown.response);
        }
        ui.with_layout(egui::Layout::right_to_left(egui::Align::Center), |ui| {
            let title = desk.report().title.clone();
            let label = egui::Label::new(egui::RichText::new(title).weak()).truncate();
            ui.add(label).on_hover_text(&desk.name);
        });
    });
}

/// An entry with its key.
fn item(ui: &mut egui::Ui, desk: &mut Desk, text: &str, action: Action, hint: &str) {
    let key = name_of(&action);
    let button = egui::Button::new(text).shortcut_text(key.split(',').next().unwrap_or_default());
    let shown = ui.add(button).on_hover_text(hint);
    desk.probes.mark(&format!("menu.{text}"), &shown);
    if shown.clicked() {
        desk.actions.push(action);
        ui.close();
    }
}

fn file(ui: &mut egui::Ui, desk: &mut Desk, preferences: &mut Preferences) {
    item(ui, desk, "Open...", Action::OpenFile, "Open a scene file (.toml), or go on from a snapshot");
    item(ui, desk, "Gallery", Action::Gallery, "The scenes that are built in");
    ui.menu_button("Recent", |ui| recent(ui, desk, preferences));
    item(ui, desk, "Reload", Action::Reload, "Read the scene again from where it came from");
    ui.checkbox(&mut preferences.auto_reload, "Reload when the file changes")
        .on_hover_text("Looks at the file once a second. The camera stays");
    ui.separator();
    item(
        ui,
        desk,
        "Save scene...",
        Action::SaveScene,
        "Write the present state as a scene, to be edited and opened again",
    );
    item(ui, desk, "Save snapshot...", Action::SaveSnapshot, "Write the world bit for bit, to go on from later");
    item(ui, desk, "Load snapshot...", Action::LoadSnapshot, "Go on from a snapshot of the same scene");
    ui.separator();
    item(ui, desk, "Picture...", Action::Screenshot, "Write the picture as PNG, at any size");
    item(ui, desk, "Film...", Action::Film, "Make a film from the recording: MP4, GIF or single pictures");
    ui.separator();
    item(ui, desk, "Quit", Action::Quit, "End the program");
}

fn recent(ui: &mut egui::Ui, desk: &mut Desk, preferences: &mut Preferences) {
    if preferences.recent.is_empty() {
        ui.weak("no file yet");
        return;
    }
    for path in &preferences.recent {
        let name = path.file_name().unwrap_or(path.as_os_str()).to_string_lossy().into_owned();
        if ui.button(name).on_hover_text(path.display().to_string()).clicked() {
            desk.actions.push(Action::Open(path.clone()));
            ui.close();
        }
    }
    ui.separator();
    if ui.button("Forget these").on_hover_text("Empty this list").clicked() {
        preferences.recent.clear();
        ui.close();
    }
}

fn render(ui: &mut egui::Ui, desk: &mut Desk) {
    ui.weak("Shading");
    for (mode, name) in Mode::ALL {
        let (title, hint) = said(mode, name);
        let shown = ui.radio_value(&mut desk.look.mode, mode, title).on_hover_text(hint);
        desk.probes.mark(&format!("menu.render.{name}"), &shown);
    }
    ui.separator();
    ui.menu_button("Triangulation of spheres", |ui| {
        let hint = "Each sphere as finely as its size in the picture needs to look round";
        ui.radio_value(&mut desk.look.quality, Quality::Auto, "Automatic").on_hover_text(hint);
        for level in 0..=FINEST {
            let triangles = 20u64 << (2 * u32::from(level));
            let text = format!("{triangles} triangles");
            ui.radio_value(&mut desk.look.quality, Quality::Level(level), text).on_hover_text("For every sphere");
        }
    });
    ui.checkbox(&mut desk.look.shadows, "Shadows").on_hover_text("The first light throws shadows");
    ui.checkbox(&mut desk.look.walls, "Boundaries").on_hover_text("Draw the walls");
    ui.separator();
    item(ui, desk, "All settings", Action::Reveal("render"), "Open the section of the panel");
}

fn said(mode: Mode, name: &'static str) -> (String, &'static str) {
    let hint = match mode {
        Mode::Wireframe => "The edges of all triangles",
        Mode::HiddenLine => "The edges that are not hidden",
        Mode::Flat => "One color for each triangle",
        Mode::Gouraud => "Lit at the corners, colors interpolated between them",
        Mode::Phong => "Lit in every pixel, normals interpolated between the corners",
    };
    let mut title = name.replace('-', " ");
    title[..1].make_ascii_uppercase();
    (title, hint)
}

/// Entries that open sections of the panel, where there are such.
fn sections(ui: &mut egui::Ui, desk: &mut Desk, facts: &Facts<'_>, names: &[&str]) {
    for (name, title) in facts.sections.iter().filter(|(name, _)| names.contains(name)) {
        item(ui, desk, title, Action::Reveal(name), "Open the section of the panel");
    }
}

fn view(ui: &mut egui::Ui, desk: &mut Desk, preferences: &mut Preferences, facts: &Facts<'_>) {
    let toggle = |on: bool, what: &str| format!("{} {what}", if on { "Hide" } else { "Show" });
    item(ui, desk, &toggle(facts.side_panel, "panel"), Action::SidePanel, "The sections at the right");
    if let Some(below) = facts.below {
        item(ui, desk, &toggle(below, "plots"), Action::Below, "The area at the bottom");
    }
    ui.menu_button("Section", |ui| {
        for (name, title) in facts.sections {
            item(ui, desk, title, Action::Reveal(name), "Open the section of the panel");
        }
    });
    ui.separator();
    item(ui, desk, "The scene's camera", Action::ResetCamera, "Look from where the scene says");
    item(
        ui,
        desk,
        "Everything into the picture",
        Action::FitCamera,
        "Look from the same side, from where everything fits",
    );
    ui.separator();
    item(
        ui,
        desk,
        if preferences.dark { "Light" } else { "Dark" },
        Action::Theme,
        "Colors of the window and the picture",
    );
    item(ui, desk, "Larger letters", Action::Scale(1), "Make everything on the panel larger");
    item(ui, desk, "Smaller letters", Action::Scale(-1), "Make everything on the panel smaller");
    item(ui, desk, "Letters as at first", Action::Scale(0), "The usual size");
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn modes_are_said_in_words() {
        let said: Vec<String> = Mode::ALL.map(|(mode, name)| said(mode, name).0).into();
        assert_eq!(said, ["Wireframe", "Hidden line", "Flat", "Gouraud", "Phong"]);
    }
}
