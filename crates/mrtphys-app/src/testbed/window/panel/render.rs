//! Section Render (thesis, appendix B.4): shading, illumination, rendering and triangulation.

use crate::testbed::window::action::Action;
use crate::testbed::window::desk::Desk;
use crate::testbed::window::typed::Typed;
use eframe::egui;
use mrtphys_view::mesh::FINEST;
use mrtphys_view::{Illumination, Mode, Quality, Theme};

/// How surfaces are interpolated between the corners of triangles.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
enum Shading {
    Flat,
    Gouraud,
    #[default]
    Phong,
}

impl Shading {
    const ALL: [(Shading, &'static str, &'static str); 3] = [
        (Shading::Flat, "flat", "one color for each triangle"),
        (Shading::Gouraud, "Gouraud", "lit at the corners, colors interpolated between them"),
        (Shading::Phong, "Phong", "lit in every pixel, normals interpolated between the corners"),
    ];
}

/// The method of drawing.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
enum Rendering {
    Wireframe,
    HiddenLine,
    #[default]
    Filled,
}

impl Rendering {
    const ALL: [(Rendering, &'static str, &'static str); 3] = [
        (Rendering::Wireframe, "wireframe", "the edges of all triangles"),
        (Rendering::HiddenLine, "hidden line", "the edges of all triangles that are not hidden"),
        (Rendering::Filled, "filled", "faces, by the depth of every pixel"),
    ];
}

/// The renderer's mode.
fn mode(rendering: Rendering, shading: Shading) -> Mode {
    match (rendering, shading) {
        (Rendering::Wireframe, _) => Mode::Wireframe,
        (Rendering::HiddenLine, _) => Mode::HiddenLine,
        (Rendering::Filled, Shading::Flat) => Mode::Flat,
        (Rendering::Filled, Shading::Gouraud) => Mode::Gouraud,
        (Rendering::Filled, Shading::Phong) => Mode::Phong,
    }
}

/// What a mode is made of; lines have no shading of their own.
fn parts(mode: Mode) -> (Rendering, Option<Shading>) {
    match mode {
        Mode::Wireframe => (Rendering::Wireframe, None),
        Mode::HiddenLine => (Rendering::HiddenLine, None),
        Mode::Flat => (Rendering::Filled, Some(Shading::Flat)),
        Mode::Gouraud => (Rendering::Filled, Some(Shading::Gouraud)),
        Mode::Phong => (Rendering::Filled, Some(Shading::Phong)),
    }
}

/// The slider's place: 0 is automatic.
fn place(quality: Quality) -> u8 {
    match quality {
        Quality::Auto => 0,
        Quality::Level(level) => level.min(FINEST) + 1,
    }
}

fn quality(place: u8) -> Quality {
    place.checked_sub(1).map_or(Quality::Auto, Quality::Level)
}

/// What the slider says.
fn meaning(place: u8) -> String {
    match quality(place) {
        Quality::Auto => "automatic".into(),
        Quality::Level(level) => format!("{} triangles", 20 * 4u64.pow(level.into())),
    }
}

/// The place of what was typed: so many triangles at least, as far as there are so many.
fn place_of(text: &str) -> Option<u8> {
    let number = text.trim().trim_end_matches("triangles").trim_end();
    match number.parse::<f64>() {
        Ok(0.0) => Some(0),
        Ok(n) if n > 0.0 => {
            let level = (0..=FINEST).find(|l| f64::from(20 * 4u32.pow((*l).into())) >= n);
            Some(level.unwrap_or(FINEST) + 1)
        }
        _ => (!number.is_empty() && "automatic".starts_with(&number.to_lowercase())).then_some(0),
    }
}

/// The section.
#[derive(Default)]
pub struct Render {
    /// the shading that filled faces had last
    shading: Shading,
}

impl Render {
    /// Shows it.
    pub fn show(&mut self, ui: &mut egui::Ui, desk: &mut Desk) {
        let (mut rendering, shading) = parts(desk.look.mode);
        self.shading = shading.unwrap_or(self.shading);
        egui::Grid::new("render").num_columns(2).spacing([8.0, 4.0]).show(ui, |ui| {
            ui.label("Rendering").on_hover_text("method of drawing");
            ui.horizontal(|ui| {
                for (r, name, hint) in Rendering::ALL {
                    let response = ui.selectable_value(&mut rendering, r, name).on_hover_text(hint);
                    desk.probes.mark(name, &response);
                }
            });
            ui.end_row();
            ui.label("Shading").on_hover_text("interpolation between the corners of a triangle");
            ui.add_enabled_ui(rendering == Rendering::Filled, |ui| {
                ui.horizontal(|ui| {
                    for (s, name, hint) in Shading::ALL {
                        ui.selectable_value(&mut self.shading, s, name).on_hover_text(hint);
                    }
                });
            });
            ui.end_row();
            ui.label("Illumination").on_hover_text("the lighting equation");
            illumination(ui, &mut desk.look.illumination);
            ui.end_row();
            ui.label("Triangulation").on_hover_text("how finely spheres are triangulated");
            triangulation(ui, &mut desk.look.quality);
            ui.end_row();
            ui.label("Background").on_hover_text("light or dark (T)");
            ui.horizontal(|ui| {
                for (theme, name) in [(Theme::Light, "light"), (Theme::Dark, "dark")] {
                    let hint = "the window and the picture";
                    let response = ui.selectable_label(desk.look.theme == theme, name).on_hover_text(hint);
                    if response.clicked() && desk.look.theme != theme {
                        desk.actions.push(Action::Theme);
                    }
                }
            });
            ui.end_row();
        });
        desk.look.mode = mode(rendering, self.shading);
        ui.horizontal_wrapped(|ui| {
            let look = &mut desk.look;
            ui.checkbox(&mut look.shadows, "Shadows").on_hover_text("the first light throws shadows");
            ui.checkbox(&mut look.walls, "Boundaries").on_hover_text("the walls are drawn");
            ui.checkbox(&mut look.marks, "Marks").on_hover_text("spheres bear marks, by which one sees them spin");
        });
        smoothing(ui, &mut desk.look.smooth);
    }
}

fn triangulation(ui: &mut egui::Ui, chosen: &mut Quality) {
    let mut slid = place(*chosen);
    let hint = "automatic: as finely as its size in the picture needs to look round; else all spheres alike";
    let read = |text: &str| {
        let place = place_of(text).ok_or("A number of triangles is expected, or 'automatic'")?;
        Ok(f64::from(place))
    };
    ui.horizontal(|ui| {
        ui.spacing_mut().slider_width = 80.0;
        let slider = egui::Slider::new(&mut slid, 0..=FINEST + 1).show_value(false);
        let mut changed = ui.add(slider).on_hover_text(hint).changed();
        let typed = Typed {
            shown: &|x| meaning(x as u8),
            read: &read,
            range: 0.0..=f64::from(FINEST + 1),
            speed: 0.05,
            width: None,
            suffix: String::new(),
            hint,
            exact: String::new(),
        };
        if let Some(new) = typed.show(ui, f64::from(slid)).1 {
            (slid, changed) = (new.round() as u8, true);
        }
        if changed {
            *chosen = quality(slid);
        }
    });
}

fn illumination(ui: &mut egui::Ui, value: &mut Illumination) {
    let hints = [
        "light from everywhere only: no lamp, no shadow",
        "and diffuse reflection of the lamps",
        "and highlights where the eye meets the mirrored ray of a lamp",
        "and highlights where the normal is half-way between lamp and eye",
    ];
    let name = Illumination::ALL.iter().find(|(i, _)| i == value).map_or("", |(_, n)| n);
    egui::ComboBox::from_id_salt("illumination").selected_text(name).show_ui(ui, |ui| {
        for ((i, name), hint) in Illumination::ALL.into_iter().zip(hints) {
            ui.selectable_value(value, i, name).on_hover_text(hint);
        }
    });
}

fn smoothing(ui: &mut egui::Ui, value: &mut Option<bool>) {
    ui.horizontal(|ui| {
        ui.label("Smooth edges").on_hover_text("four samples a pixel");
        let hint = "where a graphics card draws, not where software does";
        ui.selectable_value(value, None, "automatic").on_hover_text(hint);
        ui.selectable_value(value, Some(true), "on").on_hover_text("four samples a pixel");
        ui.selectable_value(value, Some(false), "off").on_hover_text("one sample a pixel: faster");
    });
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_mode_can_be_chosen_and_is_shown() {
        for (m, name) in Mode::ALL {
            let (rendering, shading) = parts(m);
            assert_eq!(mode(rendering, shading.unwrap_or_default()), m, "{name}");
        }
    }

    #[test]
    fn what_is_typed_is_a_number_of_triangles() {
        for p in 0..=FINEST + 1 {
            assert_eq!(place_of(&meaning(p)), Some(p));
        }
        let read = ["300", "1e300", "auto", "0"].map(place_of);
        assert_eq!(read, [Some(3), Some(FINEST + 1), Some(0), Some(0)]);
        assert_eq!(["", "-5", "many", "nan"].map(place_of), [None; 4]);
    }

    #[test]
    fn the_slider_has_a_place_for_every_quality() {
        for p in 0..=FINEST + 1 {
            assert_eq!(place(quality(p)), p);
        }
        assert_eq!(
            (meaning(0).as_str(), meaning(1).as_str(), meaning(4).as_str()),
            ("automatic", "20 triangles", "1280 triangles")
        );
    }
}
