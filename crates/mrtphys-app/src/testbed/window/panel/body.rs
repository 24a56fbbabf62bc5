//! Section Body: everything about the selected body, to be read and changed while it moves.

use super::making;
use crate::testbed::window::desk::Desk;
use crate::testbed::window::format::{number, with_unit};
use crate::testbed::window::quantity::Entry;
use eframe::egui;
use mrtphys::def::{Mass, Surface};
use mrtphys::math::Quat;
use mrtphys::world::Body as State;
use mrtphys::{BodyId, Real, Vec3, World};

/// Density of water \[kg/m3\]: what a fixed body that is set free is made of, unless it had a mass before.
const WATER: Real = 1000.0;

/// The section.
#[derive(Default)]
pub struct Body {
    /// impulse of a push \[Ns\], and the body it was chosen for
    push: Option<(BodyId, Real)>,
    /// the last finite mass of a body that was fixed here \[kg\]
    freed: Option<(BodyId, Real)>,
    /// how much had gone wrong when the last change was sent
    changed: Option<u64>,
}

impl Body {
    /// Shows it.
    pub fn show(&mut self, ui: &mut egui::Ui, desk: &mut Desk) {
        let side = &desk.report().sides[0];
        let body = side.extras.selected.clone().filter(|(id, ..)| desk.selected == Some(*id));
        let Some((id, name, body)) = body else {
            let text = match desk.selected {
                None => "Click a body in the picture or in the list to see and change its properties.",
                Some(id) if side.shot.stage.index(id).is_none() => "This body is there no more.",
                Some(_) => "...",
            };
            ui.label(egui::RichText::new(text).weak());
            return;
        };
        ui.horizontal_wrapped(|ui| {
            ui.strong(&name);
            let fixed = if body.mass == Real::INFINITY { ", fixed" } else { "" };
            ui.label(format!("{}{fixed}", body.kind)).on_hover_text("kind of shape");
            if body.set_aside {
                ui.colored_label(ui.visuals().error_fg_color, "set aside: its motion was no longer finite");
            }
        });
        // A field belongs to its body: what is typed in it does not go over to the next one.
        ui.push_id(id, |ui| self.properties(ui, desk, &body, id));
        self.complaint(ui, desk);
    }

    fn properties(&mut self, ui: &mut egui::Ui, desk: &mut Desk, body: &State, id: BodyId) {
        let scale = Scale::of(body);
        egui::Grid::new("body properties").num_columns(2).spacing([6.0, 4.0]).show(ui, |ui| {
            self.substance(ui, desk, body, id);
            self.place(ui, desk, body, id, &scale);
            self.motion(ui, desk, body, id, &scale);
            self.energies(ui, desk, body, id);
        });
        self.surface(ui, desk, body, id);
        self.actions(ui, desk, body, id);
    }

    /// Changes the world, and remembers when.
    fn edit(&mut self, desk: &Desk, looks: bool, change: impl Fn(&mut World) -> mrtphys::Result<()> + Send + 'static) {
        self.changed = Some(desk.report().troubles);
        desk.edit(looks, move |loaded| change(&mut loaded.world).map_err(|e| e.to_string()));
    }

    /// What was wrong with the last change.
    fn complaint(&self, ui: &mut egui::Ui, desk: &Desk) {
        let after = |n: u64| desk.report().troubles > n;
        if let Some(trouble) = desk.report().trouble.as_ref().filter(|_| self.changed.is_some_and(after)) {
            ui.colored_label(ui.visuals().error_fg_color, trouble);
        }
    }

    fn substance(&mut self, ui: &mut egui::Ui, desk: &mut Desk, body: &State, id: BodyId) {
        let fixed = body.mass == Real::INFINITY;
        ui.label("Mass");
        ui.horizontal(|ui| {
            if !fixed {
                let entry = Entry::positive("kg", body.mass, "mass; velocities stay");
                if let Some(m) = entry.show(ui, body.mass) {
                    self.edit(desk, false, move |w| w.set_mass(id, Mass::Value(m)));
                }
            }
            let mut on = fixed;
            let hint = "a fixed body has infinite mass: it never moves";
            if ui.checkbox(&mut on, "fixed").on_hover_text(hint).changed() {
                let mass = if on { Mass::Infinite } else { self.mass_when_freed(body, id) };
                if on {
                    self.freed = Some((id, body.mass));
                }
                self.edit(desk, true, move |w| w.set_mass(id, mass));
            }
        });
        ui.end_row();
        if !fixed && body.volume > 0.0 {
            ui.label("Density");
            let entry = Entry::positive("kg/m3", body.density(), "mass by volume");
            if let Some(d) = entry.show(ui, body.density()) {
                self.edit(desk, false, move |w| w.set_mass(id, Mass::Density(d)));
            }
            ui.end_row();
        }
    }

    fn mass_when_freed(&self, body: &State, id: BodyId) -> Mass {
        match self.freed {
            Some((before, mass)) if before == id => Mass::Value(mass),
            _ if body.volume > 0.0 => Mass::Density(WATER),
            _ => Mass::Value(1.0),
        }
    }

    fn place(&mut self, ui: &mut egui::Ui, desk: &mut Desk, body: &State, id: BodyId, scale: &Scale) {
        ui.label("Position").on_hover_text("centre of mass [m]");
        let entry = Entry::any("m", scale.length, "position of the centre of mass");
        if let Some(x) = entry.vector(ui, body.position) {
            self.edit(desk, false, move |w| w.set_position(id, x));
        }
        ui.end_row();
        ui.label("Orientation").on_hover_text(orientation_hint(body.orientation));
        let entry = Entry::any("degrees", 90.0, "rotation from the shape's axes: angle times axis");
        if let Some(v) = entry.vector(ui, rotation_vector(body.orientation)) {
            let q = from_rotation_vector(v);
            self.edit(desk, false, move |w| w.set_orientation(id, q));
        }
        ui.end_row();
    }

    fn motion(&mut self, ui: &mut egui::Ui, desk: &mut Desk, body: &State, id: BodyId, scale: &Scale) {
        if body.mass == Real::INFINITY {
            return;
        }
        ui.label("Velocity").on_hover_text(with_unit(body.velocity.length(), "m/s"));
        if let Some(v) = Entry::any("m/s", scale.speed, "velocity of the centre of mass").vector(ui, body.velocity) {
            self.edit(desk, false, move |w| w.set_velocity(id, v));
        }
        ui.end_row();
        ui.label("Angular vel.").on_hover_text(with_unit(body.angular_velocity.length(), "rad/s"));
        let entry = Entry::any("rad/s", scale.spin, "angular velocity, world axes");
        if let Some(w) = entry.vector(ui, body.angular_velocity) {
            self.edit(desk, false, move |world| world.set_angular_velocity(id, w));
        }
        ui.end_row();
        ui.label("Momentum").on_hover_text(with_unit(body.momentum().length(), "Ns"));
        let entry = Entry::any("Ns", scale.speed * body.mass, "momentum: mass times velocity");
        if let Some(p) = entry.vector(ui, body.momentum()) {
            self.edit(desk, false, move |w| w.set_momentum(id, p));
        }
        ui.end_row();
        ui.label("Angular mom.").on_hover_text(with_unit(body.angular_momentum.length(), "Js"));
        let entry = Entry::any("Js", scale.spin * body.inertia.moments.x, "angular momentum about the centre of mass");
        if let Some(l) = entry.vector(ui, body.angular_momentum) {
            self.edit(desk, false, move |w| w.set_angular_momentum(id, l));
        }
        ui.end_row();
    }

    fn energies(&mut self, ui: &mut egui::Ui, desk: &mut Desk, body: &State, id: BodyId) {
        if body.mass == Real::INFINITY {
            return;
        }
        let (linear, rotational) = (body.linear_energy(), body.rotational_energy());
        ui.label("Linear energy").on_hover_text("kinetic energy of translation; a change keeps the direction");
        if let Some(e) = Entry::positive("J", linear, "m v2 / 2, equation (16)").show(ui, linear) {
            self.edit(desk, false, move |w| w.set_linear_energy(id, e));
        }
        ui.end_row();
        ui.label("Rot. energy").on_hover_text("kinetic energy of rotation; a change keeps the axis");
        if let Some(e) = Entry::positive("J", rotational, "w J w / 2, equation (29)").show(ui, rotational) {
            self.edit(desk, false, move |w| w.set_rotational_energy(id, e));
        }
        ui.end_row();
        ui.label("Kinetic energy").on_hover_text("the sum of the two");
        ui.label(with_unit(linear + rotational, "J"));
        ui.end_row();
    }

    fn surface(&mut self, ui: &mut egui::Ui, desk: &mut Desk, body: &State, id: BodyId) {
        let old = body.surface;
        let mut new = old;
        ui.horizontal(|ui| {
            ui.label("Friction");
            let hint = "friction coefficient: 0 oiled to 1 sandpaper; any non-negative number for the Coulomb law";
            new.friction = Entry::positive("", 0.2, hint).show(ui, old.friction).unwrap_or(old.friction);
            ui.label("Restitution");
            let entry = Entry { range: 0.0..=1.0, ..Entry::any("", 0.2, "1: elastic; 0: no rebound") };
            new.restitution = entry.show(ui, old.restitution).unwrap_or(old.restitution);
        });
        if new != old {
            let surface: Surface = new;
            self.edit(desk, false, move |w| w.set_surface(id, surface));
        }
        ui.horizontal(|ui| {
            ui.label("Color");
            let stage = &desk.report().sides[0].shot.stage;
            let mut rgb = stage.index(id).map_or([128; 3], |i| stage.color(i));
            let hint = "color in the picture; in a lattice, of all bodies of the same kind";
            if ui.color_edit_button_srgb(&mut rgb).on_hover_text(hint).changed() {
                self.changed = Some(desk.report().troubles);
                desk.edit(true, move |loaded| making::paint(loaded, id, rgb));
            }
            ui.checkbox(&mut desk.seeing.follow, "Follow").on_hover_text("the camera moves with this body (L)");
            let trails = &mut desk.seeing.sight;
            let mut on = trails.trail_of_selected;
            if ui.checkbox(&mut on, "Trail").on_hover_text("shows where this body has been").changed() {
                trails.trail_of_selected = on;
            }
        });
    }

    fn actions(&mut self, ui: &mut egui::Ui, desk: &mut Desk, body: &State, id: BodyId) {
        ui.horizontal_wrapped(|ui| {
            if ui.button("Look at").on_hover_text("the camera turns to this body (double click)").clicked() {
                let ball = body.shape.bounding_sphere();
                crate::testbed::window::mouse::look_at_ball(&mut desk.camera, body.position, ball.radius);
            }
            if ui.button("Duplicate").on_hover_text("another body like this one, beside it").clicked() {
                self.changed = Some(desk.report().troubles);
                desk.edit(true, move |loaded| making::duplicate(loaded, id).map(drop));
            }
            if ui.button("Delete").on_hover_text("removes this body (Delete)").clicked() {
                self.edit(desk, true, move |w| w.remove_body(id));
                desk.selected = None;
            }
        });
        if body.mass == Real::INFINITY {
            return;
        }
        ui.horizontal(|ui| {
            let impulse = match self.push {
                Some((of, impulse)) if of == id => impulse,
                _ => body.mass * Scale::of(body).speed,
            };
            let axes = desk.camera.axes();
            if ui.button("Push").on_hover_text("an impulse through the centre of mass, away from the viewer").clicked()
            {
                self.push = Some((id, impulse));
                self.edit(desk, false, move |w| {
                    let center = w.body(id)?.position;
                    w.apply_impulse(id, axes.forward * impulse, center)
                });
            }
            let entry = Entry::any("Ns", impulse, "size of the impulse; negative: towards the viewer");
            if let Some(new) = entry.show(ui, impulse) {
                self.push = Some((id, new));
            }
        });
    }
}

/// What is much for a body: steps of its entries.
struct Scale {
    length: Real,
    speed: Real,
    spin: Real,
}

impl Scale {
    /// A body's own size, and what it covers in a second.
    fn of(body: &State) -> Scale {
        let radius = body.shape.bounding_sphere().radius;
        let length = if radius > 0.0 && radius.is_finite() { radius } else { 1.0 };
        Scale { length, speed: (body.velocity.length() * 0.5).max(length), spin: 1.0 }
    }
}

/// Angle times axis \[degrees\], the angle from 0 to 180.
pub fn rotation_vector(q: Quat) -> Vec3 {
    let q = q.try_normalize().unwrap_or(Quat::IDENTITY);
    let sign = if q.w < 0.0 { -1.0 } else { 1.0 };
    let v = Vec3::new(q.x, q.y, q.z) * sign;
    let sine = v.length();
    let angle = 2.0 * sine.atan2(q.w * sign);
    // For small angles the vector is twice the imaginary part.
    let factor = if sine > 1e-9 { angle / sine } else { 2.0 };
    (v * factor).to_array().map(Real::to_degrees).into()
}

/// The orientation of an angle times axis \[degrees\].
pub fn from_rotation_vector(degrees: Vec3) -> Quat {
    Quat::from_rotation_vector(Vec3::from(degrees.to_array().map(Real::to_radians)))
}

fn orientation_hint(q: Quat) -> String {
    let [x, y, z, w] = [q.x, q.y, q.z, q.w].map(number);
    format!("angle times axis [degrees]; the quaternion is x {x}, y {y}, z {z}, w {w}")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn orientations_are_read_as_they_are_shown() {
        let axes = [Vec3::X, Vec3::new(1.0, -2.0, 0.5), Vec3::new(-0.1, 0.2, 0.9)];
        for axis in axes {
            for angle in [0.0, 1e-12, 1e-4, 0.5, 3.0, 3.1, 4.0, 6.2] {
                let n = axis.try_normalize().unwrap();
                let q = Quat::from_axis_angle(n, angle);
                let v = rotation_vector(q);
                assert!(v.length() <= 180.0 + 1e-9);
                let back = from_rotation_vector(v);
                assert!(q.dot(back).abs() > 1.0 - 1e-12, "{angle}: {v:?}");
            }
        }
        let quarter = rotation_vector(Quat::from_axis_angle(Vec3::Y, std::f64::consts::FRAC_PI_2));
        assert!((quarter - Vec3::Y * 90.0).length() < 1e-9);
        assert_eq!(rotation_vector(Quat::IDENTITY), Vec3::ZERO);
    }
}
