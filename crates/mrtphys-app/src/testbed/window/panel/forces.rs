//! Section Forces (thesis, appendix B.2): gravity and viscosity, and all other force and flow fields.

use super::fields::{self, Field, Placed, STANDARD};
use super::scope;
use crate::testbed::window::ask::Inquiry;
use crate::testbed::window::desk::Desk;
use crate::testbed::window::pending::Pending;
use crate::testbed::window::quantity::{Entry, Slid};
use eframe::egui;
use mrtphys::def::Settings;
use mrtphys::{Real, Vec3};
use mrtphys_scene::scene::{FlowKind, ForceKind};
use std::time::{Duration, Instant};

/// The slider goes up to this \[m/s2\]; more can be typed.
const MOST: Real = 30.0;
/// While the scene runs the list of fields is looked at this often.
const LOOK_EVERY: Duration = Duration::from_millis(400);

/// The section.
#[derive(Default)]
pub struct Forces {
    gravity: Pending<Vec3>,
    /// where gravity points; kept while it is zero
    direction: Option<Vec3>,
    viscosity: Pending<Real>,
    list: Inquiry<Vec<Placed>>,
    /// the report that the list was asked for with, the scene, and when
    asked: Option<(u64, u64, Instant)>,
    changed: Option<u64>,
}

impl Forces {
    /// Shows it.
    pub fn show(&mut self, ui: &mut egui::Ui, desk: &mut Desk) {
        self.gravity(ui, desk);
        ui.add_space(4.0);
        self.medium(ui, desk);
        ui.add_space(4.0);
        self.look(ui, desk);
        self.fields(ui, desk);
        let trouble = self.changed.filter(|n| desk.report().troubles > *n).and(desk.report().trouble.clone());
        if let Some(text) = trouble {
            ui.colored_label(ui.visuals().error_fg_color, text);
        }
    }

    fn edit(
        &mut self,
        desk: &Desk,
        change: impl Fn(&mut mrtphys_scene::Loaded) -> Result<(), String> + Send + 'static,
    ) {
        self.changed = Some(desk.report().troubles);
        desk.session.edit(false, change);
    }

    /// Changes what would have to be made again if it were not saved.
    fn make(
        &mut self,
        desk: &Desk,
        change: impl Fn(&mut mrtphys_scene::Loaded) -> Result<(), String> + Send + 'static,
    ) {
        self.changed = Some(desk.report().troubles);
        desk.edit(false, change);
    }

    fn set_gravity(&mut self, desk: &Desk, gravity: Vec3) {
        self.gravity.ask(gravity, Instant::now());
        self.edit(desk, move |loaded| fields::set_gravity(loaded, gravity));
    }

    fn gravity(&mut self, ui: &mut egui::Ui, desk: &mut Desk) {
        let reported = desk.report().sides[0].numbers.gravity.unwrap_or(Vec3::ZERO);
        let gravity = self.gravity.shown(reported, Instant::now());
        let direction = gravity.try_normalize().or(self.direction).unwrap_or(Vec3::Y * -1.0);
        self.direction = Some(direction);
        ui.label("Gravity");
        let hint = "acceleration of gravity; more than the slider has can be typed";
        let slid = Slid { number: 110.0, ..Slid::new(0.0..=MOST, false) };
        let (response, new) = Entry::positive("m/s2", 1.0, hint).slider(ui, gravity.length(), &slid);
        desk.probes.mark("gravity", &response);
        if let Some(g) = new {
            self.set_gravity(desk, direction * g);
        }
        ui.horizontal(|ui| {
            let hint = "standard gravity, 9.80665 m/s2, downwards (against y)";
            let reset = ui.button("Reset").on_hover_text(hint);
            desk.probes.mark("gravity-reset", &reset);
            if reset.clicked() {
                self.direction = Some(Vec3::Y * -1.0);
                self.set_gravity(desk, Vec3::Y * -STANDARD);
            }
            if ui.button("Off").on_hover_text("no gravity").clicked() {
                self.set_gravity(desk, Vec3::ZERO);
            }
        });
        ui.horizontal(|ui| {
            ui.label("towards");
            let entry = Entry::any("", 1.0, "where gravity points; any length");
            if let Some(new) = entry.vector(ui, direction).and_then(Vec3::try_normalize) {
                self.direction = Some(new);
                self.set_gravity(desk, new * gravity.length());
            }
        });
    }

    fn medium(&mut self, ui: &mut egui::Ui, desk: &mut Desk) {
        let settings = desk.report().sides[0].numbers.settings.clone();
        ui.label("Viscosity");
        let viscosity = self.viscosity.shown(settings.viscosity, Instant::now());
        let hint = "0 void to 1 very tough: velocity relaxes to that of the medium as (1 - viscosity)^(t / 1 s)";
        let entry = Entry { range: 0.0..=1.0, ..Entry::any("", 0.2, hint) };
        let (response, new) = entry.slider(ui, viscosity, &Slid::new(0.0..=1.0, false));
        desk.probes.mark("viscosity", &response);
        if let Some(viscosity) = new {
            self.viscosity.ask(viscosity, Instant::now());
            self.set(desk, move |s| s.viscosity = viscosity);
        }
        ui.horizontal(|ui| {
            let mut spin = settings.viscous_spin;
            if ui.checkbox(&mut spin, "brakes the spin").on_hover_text("viscosity acts on rotation, too").changed() {
                self.set(desk, move |s| s.viscous_spin = spin);
            }
            ui.label("density");
            let entry = Entry::positive("kg/m3", 1.0, "density of the medium, for buoyancy; 0: none");
            if let Some(density) = entry.show(ui, settings.medium_density) {
                self.set(desk, move |s| s.medium_density = density);
            }
        });
    }

    /// Changes the settings.
    fn set(&mut self, desk: &Desk, change: impl Fn(&mut Settings) + Send + 'static) {
        self.edit(desk, move |loaded| {
            let mut settings = loaded.world.settings().clone();
            change(&mut settings);
            loaded.world.set_settings(settings).map_err(|e| e.to_string())
        });
    }

    /// Asks for the list of fields when it may have changed.
    fn look(&mut self, ui: &egui::Ui, desk: &Desk) {
        let (number, opened, now) = (desk.report().number, desk.opened, Instant::now());
        let due = match self.asked {
            None => true,
            Some((_, o, _)) if o != opened => {
                self.list.clear();
                true
            }
            Some((n, ..)) if n == number => false,
            Some((_, _, at)) => !desk.report().running || at.elapsed() > LOOK_EVERY || self.changed.is_some(),
        };
        if due && !self.list.is_waiting() {
            self.list.ask(&desk.session, ui.ctx(), |studio| fields::all(studio.loaded));
            self.asked = Some((number, opened, now));
        }
    }

    fn fields(&mut self, ui: &mut egui::Ui, desk: &mut Desk) {
        ui.label("Fields").on_hover_text(
            "force fields accelerate bodies; flow fields move the medium, which takes bodies along where it is viscous",
        );
        let list = self.list.answer().cloned().unwrap_or_default();
        if list.is_empty() {
            ui.weak("none");
        }
        let size = desk.camera.distance() * 0.3;
        for placed in &list {
            let is_flow = matches!(placed.field, Field::Flow(_));
            ui.push_id((is_flow, placed.number), |ui| {
                ui.horizontal(|ui| {
                    ui.strong(placed.field.name());
                    if ui.small_button("Remove").on_hover_text("takes this field away").clicked() {
                        let Placed { number, field, .. } = *placed;
                        self.make(desk, move |loaded| fields::remove(loaded, number, &field));
                    }
                });
                if let Some(new) = scope::show(ui, desk, placed) {
                    let Placed { number, field, .. } = *placed;
                    self.make(desk, move |loaded| scope::set(loaded, number, &field, &new));
                }
                if let Some(field) = parameters(ui, &placed.field, size) {
                    let number = placed.number;
                    self.make(desk, move |loaded| fields::set(loaded, number, field));
                }
            });
        }
        ui.horizontal(|ui| {
            let at = desk.camera.look_at;
            ui.menu_button("Add a field", |ui| {
                for field in Field::choices(at, size) {
                    if ui.button(field.name()).on_hover_text("at the point that the camera looks at").clicked() {
                        self.make(desk, move |loaded| fields::add(loaded, field));
                        ui.close();
                    }
                }
            })
            .response
            .on_hover_text("another force or flow; its values can be changed here afterwards");
        });
    }
}

/// The values of a field; the field with those that were changed.
fn parameters(ui: &mut egui::Ui, field: &Field, size: Real) -> Option<Field> {
    let mut new = *field;
    let mut changed = false;
    egui::Grid::new("field").num_columns(2).spacing([6.0, 3.0]).show(ui, |ui| match &mut new {
        Field::Force(ForceKind::EarthGravity { g, direction }) => {
            vector(ui, "direction", &Entry::any("", 1.0, "where it points; any length"), direction, &mut changed);
            scalar(ui, "g", &Entry::any("m/s2", 1.0, "acceleration"), g, &mut changed);
        }
        Field::Force(ForceKind::Uniform { acceleration }) => {
            vector(ui, "acceleration", &Entry::any("m/s2", 1.0, "the same everywhere"), acceleration, &mut changed);
        }
        Field::Force(ForceKind::Point { position, strength, exponent }) => {
            vector(
                ui,
                "point",
                &Entry::any("m", size * 0.1, "where it pulls to; relative to its carrier, where it has one"),
                position,
                &mut changed,
            );
            let hint = "strength / r^exponent is the acceleration; negative: it repels";
            let unit = format!("m^{}/s2", *exponent + 1);
            scalar(ui, "strength", &Entry::any(&unit, *strength, hint), strength, &mut changed);
            ui.label("exponent");
            let hint = "2: gravitation of a point; -1: a spring";
            let entry = Entry { range: -16.0..=16.0, whole: true, ..Entry::any("", 10.0, hint) };
            if let Some(x) = entry.show(ui, f64::from(*exponent)) {
                (*exponent, changed) = (x as i32, true);
            }
            ui.end_row();
        }
        Field::Force(ForceKind::Vortex { point, axis, strength }) => {
            vector(ui, "point", &Entry::any("m", size * 0.1, "a point of the axis"), point, &mut changed);
            vector(ui, "axis", &Entry::any("", 1.0, "direction of the axis; any length"), axis, &mut changed);
            scalar(
                ui,
                "strength",
                &Entry::any("m2/s2", *strength, "acceleration times distance"),
                strength,
                &mut changed,
            );
        }
        Field::Flow(FlowKind::Uniform { velocity }) => {
            vector(ui, "velocity", &Entry::any("m/s", size, "velocity of the medium"), velocity, &mut changed);
        }
        Field::Flow(FlowKind::Vortex { point, axis, circulation }) => {
            vector(ui, "point", &Entry::any("m", size * 0.1, "a point of the axis"), point, &mut changed);
            vector(ui, "axis", &Entry::any("", 1.0, "direction of the axis; any length"), axis, &mut changed);
            let entry = Entry::any("m2/s", *circulation, "circulation of the medium about the axis");
            scalar(ui, "circulation", &entry, circulation, &mut changed);
        }
        Field::Flow(FlowKind::Sink { point, strength }) => {
            vector(ui, "point", &Entry::any("m", size * 0.1, "where the medium flows to"), point, &mut changed);
            scalar(ui, "strength", &Entry::any("m3/s", *strength, "negative: a source"), strength, &mut changed);
        }
    });
    (changed && new != *field).then_some(new)
}

fn scalar(ui: &mut egui::Ui, label: &str, entry: &Entry<'_>, value: &mut Real, changed: &mut bool) {
    ui.label(label).on_hover_text(entry.hint);
    if let Some(x) = entry.show(ui, *value) {
        (*value, *changed) = (x, true);
    }
    ui.end_row();
}

fn vector(ui: &mut egui::Ui, label: &str, entry: &Entry<'_>, value: &mut Vec3, changed: &mut bool) {
    ui.label(label).on_hover_text(entry.hint);
    if let Some(x) = entry.vector(ui, *value) {
        (*value, *changed) = (x, true);
    }
    ui.end_row();
}
