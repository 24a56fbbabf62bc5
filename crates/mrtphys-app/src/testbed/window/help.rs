//! Help: mouse, keys and modes; and who made this.

use super::keys::SHORTCUTS;
use super::panel::meaning;
use crate::testbed::session::RealTime;
use eframe::egui;

/// What the mouse does in the picture.
const MOUSE: [(&str, &str); 14] = [
    ("Left drag", "go round the point looked at, at the same distance"),
    ("Middle drag, or Shift and left", "move the point looked at"),
    ("Right drag, or Ctrl and left: vertical", "come nearer, or go away"),
    ("Right drag, horizontal", "turn the picture about the line of sight"),
    ("Wheel", "come nearer to what is under the mouse, or go away"),
    ("Click on a body", "select it: its properties are in the panel"),
    ("Double click on a body", "look at it"),
    ("Alt and drag a body, or H and drag", "hold it with a spring, and throw it; the wheel brings it nearer"),
    ("1, 2, 3, with Shift from behind", "look along x, y, z"),
    ("L", "the camera follows the selected body, or no longer"),
    ("B", "throw a ball along the line of sight"),
    ("Delete", "remove the selected body"),
    ("Escape", "select nothing"),
    ("Drop a file on the window", "open a scene, or go on from a snapshot"),
];

/// How surfaces are drawn.
const MODES: [(&str, &str); 5] = [
    ("Wireframe", "the edges of all triangles"),
    ("Hidden line", "the same without the edges that are hidden"),
    ("Flat", "one color for each triangle"),
    ("Gouraud", "lit at the corners, colors interpolated between them"),
    ("Phong", "lit in every pixel, normals interpolated between the corners"),
];

/// The help and the about box.
#[derive(Default)]
pub struct Help {
    /// whether the help is shown
    pub open: bool,
    /// whether the about box is shown
    pub about: bool,
}

impl Help {
    /// Shows what is open.
    pub fn show(&mut self, context: &egui::Context, driver: &str) {
        let center = context.content_rect().center();
        let height = 0.66 * context.content_rect().height();
        egui::Window::new("Help")
            .open(&mut self.open)
            .pivot(egui::Align2::CENTER_CENTER)
            .default_pos(center)
            .default_size([560.0, height])
            .collapsible(false)
            .vscroll(true)
            .show(context, help);
        egui::Window::new("About mrtphys")
            .open(&mut self.about)
            .pivot(egui::Align2::CENTER_CENTER)
            .default_pos(center)
            .resizable(false)
            .collapsible(false)
            .show(context, |ui| about(ui, driver));
    }
}

/// Width of the names \[points\].
const NAMES: f32 = 232.0;

fn table<'a>(ui: &mut egui::Ui, title: &str, lines: impl Iterator<Item = (&'a str, &'a str)>) {
    ui.strong(title);
    ui.add_space(2.0);
    for (name, text) in lines {
        line(ui, NAMES, name, text);
    }
    ui.add_space(12.0);
}

/// A name in a column of its own, and a text that wraps beside it.
fn line(ui: &mut egui::Ui, width: f32, name: &str, text: &str) {
    ui.horizontal_top(|ui| {
        ui.spacing_mut().interact_size.y = 16.0;
        let (left, _) = ui.allocate_exact_size(egui::vec2(width, 16.0), egui::Sense::hover());
        let color = ui.visuals().strong_text_color();
        let font = egui::TextStyle::Body.resolve(ui.style());
        ui.painter().text(left.left_center(), egui::Align2::LEFT_CENTER, name, font, color);
        ui.add(egui::Label::new(text).wrap());
    });
}

fn help(ui: &mut egui::Ui) {
    table(ui, "Mouse, in the picture", MOUSE.into_iter());
    table(ui, "Keys, unless a text is being typed", SHORTCUTS.iter().map(|s| (s.name, s.text)));
    table(ui, "Realtime", RealTime::ALL.into_iter().map(|(mode, name)| (name, meaning(mode))));
    table(ui, "Shading", MODES.into_iter());
    ui.label("Every control says what it does when the mouse rests on it. The manual has the scene language, the physics and the files.");
}

fn about(ui: &mut egui::Ui, driver: &str) {
    ui.set_width(400.0);
    ui.heading("mrtphys");
    ui.label("Rigid bodies that collide as physics says.");
    ui.add_space(6.0);
    let lines = [
        ("Version", crate::cli::version()),
        ("Precision", "double (64 bits), the same bits on every machine".into()),
        ("Drawn by", driver.to_string()),
        ("Licence", env!("CARGO_PKG_LICENSE").into()),
    ];
    for (name, text) in lines {
        line(ui, 80.0, name, &text);
    }
    ui.add_space(6.0);
    ui.label("Grown from a thesis of 1998 on physically based animation of rigid bodies.");
}
