//! Contacts, impulses, velocities.

use super::{Drawn, LONGEST, NORMAL, Pen, opaque, spread};
use crate::overlay::Overlay;
use crate::scale::Scale;
use mrtphys::contact::Contact;
use mrtphys::event::{ImpactEvent, Partner};
use mrtphys::{Real, Vec3};

/// Lines of an arrow: the shaft and two strokes of the head.
const ARROW: usize = 3;
/// Strokes of the arc about an angular velocity, and its angle \[radians\].
const ARC: (usize, Real) = (12, 4.7);
/// Its radius, to the longest arrow; and where on the arrow it is.
const ARC_SIZE: (Real, Real) = (0.16, 0.55);

impl Pen {
    /// Contact points, and normals from the first body to the second: all of the same length.
    pub fn contacts(&self, overlay: &mut Overlay, contacts: &[Contact]) -> Drawn {
        let total = contacts.len();
        let mut drawn = 0;
        for c in spread(total, self.affordable(ARROW)).map(|i| &contacts[i]) {
            let tip = c.point + c.normal * (NORMAL * self.length);
            overlay.arrow(self.line(c.point, tip, opaque(self.inks.normal, 255), 1.3), self.eye);
            self.dot(overlay, c.point, self.inks.contact, 4.5);
            drawn += 1;
        }
        Drawn { drawn, total }
    }

    /// Impulses: what the second body gets along the normal, or the first where the second is a boundary. The length is
    /// proportional to the **square root** of the impulse, so that weak ones are seen beside strong ones: an impulse of
    /// `scale`'s full value is as long as an arrow gets, one of a quarter half as long. Where there are too many, the strongest
    /// are drawn.
    pub fn impulses(&self, overlay: &mut Overlay, scale: &mut Scale, impacts: &[ImpactEvent]) -> Drawn {
        let strongest = impacts.iter().map(|i| i.impulse_n.abs()).filter(|j| j.is_finite()).fold(0.0, Real::max);
        let full = scale.follow(strongest);
        let most = self.affordable(ARROW);
        let mut order: Vec<u32> = (0..impacts.len() as u32).collect();
        if impacts.len() > most {
            let strength = |i: &u32| impacts[*i as usize].impulse_n.abs();
            order.sort_by(|a, b| strength(b).total_cmp(&strength(a)));
            order.truncate(most);
        }
        let drawn = order.len();
        for i in order.into_iter().map(|i| &impacts[i as usize]) {
            let sign = if matches!(i.b, Partner::Body(_)) { 1.0 } else { -1.0 };
            let length = LONGEST * self.length * (i.impulse_n.abs() / full).min(1.0).sqrt();
            let tip = i.point + i.normal * (sign * length);
            overlay.arrow(self.line(i.point, tip, opaque(self.inks.impulse, 255), 1.8), self.eye);
        }
        Drawn { drawn, total: impacts.len() }
    }

    /// Velocities, as arrows from the centres of mass. The length is proportional to the speed: one of `scale`'s full value is
    /// as long as an arrow gets. `velocities` are velocity and angular velocity of every body, in the order of the positions.
    /// Bodies at rest count as drawn.
    pub fn velocities(
        &self,
        overlay: &mut Overlay,
        scale: &mut Scale,
        positions: &[Vec3],
        velocities: &[(Vec3, Vec3)],
    ) -> Drawn {
        let total = positions.len().min(velocities.len());
        let full = scale.follow(largest(velocities.iter().map(|v| v.0)));
        let mut drawn = 0;
        for i in spread(total, self.affordable(ARROW)) {
            self.arrow_from(overlay, positions[i], velocities[i].0 / full, opaque(self.inks.velocity, 255));
            drawn += 1;
        }
        Drawn { drawn, total }
    }

    /// Angular velocities, as arrows along the axes of rotation from the centres of mass, with an arc about them in the sense of
    /// rotation. The length is proportional to the angular speed, as that of [`velocities`](Pen::velocities) is to the speed.
    pub fn spins(
        &self,
        overlay: &mut Overlay,
        scale: &mut Scale,
        positions: &[Vec3],
        velocities: &[(Vec3, Vec3)],
    ) -> Drawn {
        let total = positions.len().min(velocities.len());
        let full = scale.follow(largest(velocities.iter().map(|v| v.1)));
        let mut drawn = 0;
        for i in spread(total, self.affordable(ARROW + ARC.0 + 2)) {
            let spin = velocities[i].1 / full;
            self.arrow_from(overlay, positions[i], spin, opaque(self.inks.spin, 255));
            self.arc(overlay, positions[i], spin);
            drawn += 1;
        }
        Drawn { drawn, total }
    }

    /// An arrow of the longest length times `part`, whose length is at most 1.
    fn arrow_from(&self, overlay: &mut Overlay, from: Vec3, part: Vec3, color: [u8; 4]) {
        let length = part.length();
        if length > 0.0 && length.is_finite() && from.is_finite() {
            let tip = from + part * (LONGEST * self.length / length.max(1.0));
            overlay.arrow(self.line(from, tip, color, 1.6), self.eye);
        }
    }

    fn arc(&self, overlay: &mut Overlay, center: Vec3, spin: Vec3) {
        let Some(axis) = spin.try_normalize().filter(|_| center.is_finite()) else { return };
        let Some(u) = axis.any_perpendicular().try_normalize() else { return };
        let (part, v) = (spin.length().min(1.0), axis.cross(u));
        let longest = LONGEST * self.length;
        let radius = longest * ARC_SIZE.0 * part.sqrt();
        let middle = center + axis * (longest * part * ARC_SIZE.1);
        let at = |k: usize| {
            let angle = ARC.1 * k as Real / ARC.0 as Real;
            middle + (u * angle.cos() + v * angle.sin()) * radius
        };
        let color = opaque(self.inks.spin, 255);
        for k in 0..ARC.0 {
            overlay.lines.push(self.line(at(k), at(k + 1), color, 1.2));
        }
        // The head, along the last stroke.
        let (tip, along) = (at(ARC.0), at(ARC.0) - at(ARC.0 - 1));
        let out = (tip - middle) * 0.35;
        for side in [out, -out] {
            overlay.lines.push(self.line(tip, tip - along + side, color, 1.2));
        }
    }
}

fn largest(vectors: impl Iterator<Item = Vec3>) -> Real {
    vectors.map(Vec3::length).filter(|l| l.is_finite()).fold(0.0, Real::max)
}

#[cfg(test)]
mod tests {
    use super::super::tests::pen;
    use super::*;
    use mrtphys::BodyId;
    use mrtphys::contact::Other;

    fn contact(x: Real) -> Contact {
        let (normal, point) = (Vec3::Y, Vec3::X * x);
        Contact {
            key: 0,
            a: 0,
            b: Other::Wall(0),
            feature: 0,
            normal,
            point,
            depth: 0.0,
            first_point: 0,
            point_count: 0,
        }
    }

    fn impact(b: Partner, j: Real) -> ImpactEvent {
        let a = BodyId::from_parts(0, 0, 0);
        let (point, normal) = (Vec3::ZERO, Vec3::X);
        ImpactEvent { time: 0.0, a, b, point, normal, impulse_n: j, impulse_t: 0.0, energy_change: 0.0 }
    }

    #[test]
    fn contacts_are_dots_with_normals_and_too_many_are_counted() {
        let mut o = Overlay::default();
        let all: Vec<Contact> = (0..100).map(|i| contact(f64::from(i))).collect();
        assert_eq!(pen().contacts(&mut o, &all), Drawn { drawn: 100, total: 100 });
        assert_eq!((o.points.len(), o.lines.len()), (100, 300));
        assert_eq!(o.points[7].at, Vec3::X * 7.0);
        let shaft = o.lines[21].to - o.lines[21].from;
        assert!((shaft - Vec3::Y * (NORMAL * pen().length)).length() < 1e-12);
        o.clear();
        let few = Pen { lines: 30, ..pen() };
        assert_eq!(few.contacts(&mut o, &all), Drawn { drawn: 10, total: 100 });
        assert_eq!(o.lines.len(), 30);
        assert_eq!(o.points[9].at, Vec3::X * 90.0, "spread over all");
    }

    #[test]
    fn an_impulse_of_a_quarter_is_half_as_long_and_pushes_the_body() {
        let mut o = Overlay::default();
        let body = Partner::Body(BodyId::from_parts(1, 0, 0));
        let floor = "format = 1\n[[boundary]]\nkind = \"half-space\"\nnormal = [0, 1, 0]\npoint = [0, 0, 0]\n";
        let loaded = mrtphys_scene::Scene::from_text("test", floor).unwrap().build().unwrap();
        let wall = Partner::Boundary(loaded.world.boundaries().next().unwrap());
        let mut scale = Scale::default();
        pen().impulses(&mut o, &mut scale, &[impact(body, 8.0), impact(wall, 2.0)]);
        assert_eq!(scale.full(), 10.0);
        let shaft = |i: usize| o.lines[3 * i].to.x - o.lines[3 * i].from.x;
        assert!((shaft(0) / shaft(1) + 2.0).abs() < 1e-12, "{} {}", shaft(0), shaft(1));
        assert!((shaft(0) - LONGEST * pen().length * 0.8f64.sqrt()).abs() < 1e-12);
        let mut o = Overlay::default();
        let many: Vec<ImpactEvent> = (1..=20).map(|i| impact(body, f64::from(i))).collect();
        let drawn = Pen { lines: 6, ..pen() }.impulses(&mut o, &mut scale, &many);
        assert_eq!(drawn, Drawn { drawn: 2, total: 20 });
        let right = LONGEST * pen().length * (19.0 / scale.full()).sqrt();
        assert!((o.lines[3].to.x - right).abs() < 1e-12, "the strongest");
    }

    #[test]
    fn velocities_are_to_scale_and_nonsense_is_not_drawn() {
        let (mut o, mut scale) = (Overlay::default(), Scale::default());
        let nan = Vec3::splat(Real::NAN);
        let v = [(Vec3::X * 4.0, Vec3::ZERO), (Vec3::Y * -1.0, Vec3::ZERO), (nan, nan), (Vec3::ZERO, Vec3::ZERO)];
        let at = [Vec3::ZERO, Vec3::X, Vec3::ZERO, Vec3::ZERO];
        assert_eq!(pen().velocities(&mut o, &mut scale, &at, &v), Drawn { drawn: 4, total: 4 });
        assert_eq!(o.lines.len(), 6);
        let longest = LONGEST * pen().length;
        assert!((o.lines[0].to - Vec3::X * (0.8 * longest)).length() < 1e-12);
        assert!((o.lines[3].to - (Vec3::X - Vec3::Y * (0.2 * longest))).length() < 1e-12);
        assert!(o.lines.iter().all(|l| l.to.is_finite() && l.on_top));
    }

    #[test]
    fn an_arc_turns_as_the_body_does() {
        let (mut o, mut scale) = (Overlay::default(), Scale::default());
        let v = [(Vec3::ZERO, Vec3::new(1.0, -2.0, 0.5))];
        assert_eq!(pen().spins(&mut o, &mut scale, &[Vec3::Y], &v), Drawn { drawn: 1, total: 1 });
        assert_eq!(o.lines.len(), ARROW + ARC.0 + 2);
        let arc = &o.lines[ARROW..ARROW + ARC.0];
        for w in arc.windows(2) {
            let turning = (w[0].to - w[0].from).cross(w[1].to - w[1].from);
            assert!(turning.dot(v[0].1) > 0.0);
        }
    }
}
