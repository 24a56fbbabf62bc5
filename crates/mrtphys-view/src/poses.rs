//! Where the bodies of a stage are.

use mrtphys::math::Quat;
use mrtphys::{Real, Vec3};

/// Positions and orientations of the bodies of a stage, in its order: the state that a picture shows.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Poses {
    /// centres of mass \[m\]
    pub positions: Vec<Vec3>,
    /// orientations
    pub orientations: Vec<Quat>,
}

impl Poses {
    /// The state between two, `part` of the way from `a` to `b`: positions along the straight line, orientations along the
    /// shorter way round.
    pub fn set_between(&mut self, a: &Poses, b: &Poses, part: Real) {
        self.positions.clear();
        self.orientations.clear();
        self.positions.extend(a.positions.iter().zip(&b.positions).map(|(p, q)| *p + (*q - *p) * part));
        self.orientations.extend(a.orientations.iter().zip(&b.orientations).map(|(p, q)| between(*p, *q, part)));
    }
}

/// Normalized linear interpolation: for the small angles between two steps the same as the great circle to third order.
fn between(a: Quat, b: Quat, part: Real) -> Quat {
    if a == b {
        return b;
    }
    let sign = if a.dot(b) < 0.0 { -1.0 } else { 1.0 };
    let mix = |x: Real, y: Real| x * (1.0 - part) + sign * y * part;
    Quat::new(mix(a.x, b.x), mix(a.y, b.y), mix(a.z, b.z), mix(a.w, b.w)).try_normalize().unwrap_or(b)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_between_two_states_is_halfway() {
        let quarter = Quat::from_axis_angle(Vec3::Y, 0.5);
        let minus = Quat::new(-quarter.x, -quarter.y, -quarter.z, -quarter.w);
        let a = Poses { positions: vec![Vec3::ZERO], orientations: vec![Quat::IDENTITY] };
        let mut c = Poses::default();
        for q in [quarter, minus] {
            let b = Poses { positions: vec![Vec3::X * 4.0], orientations: vec![q] };
            c.set_between(&a, &b, 0.5);
            assert_eq!(c.positions[0], Vec3::X * 2.0);
            assert!(c.orientations[0].dot(Quat::from_axis_angle(Vec3::Y, 0.25)) > 1.0 - 1e-12);
            c.set_between(&a, &b, 0.0);
            assert_eq!(c, a);
        }
    }
}
