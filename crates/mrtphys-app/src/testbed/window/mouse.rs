//! What the mouse means in the picture (thesis, section 7.2: left, middle and right drag), as plain functions.

use eframe::egui::{Modifiers, PointerButton};
use mrtphys::math::Quat;
use mrtphys::{Real, Vec3};
use mrtphys_view::Camera;

/// What a drag does.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Gesture {
    /// the viewer moves on a sphere round the point looked at
    Orbit,
    /// the point looked at moves
    Move,
    /// vertical: the viewer approaches or recedes; horizontal: the picture rolls
    Approach,
    /// the body under the mouse is pulled
    Pull,
}

/// What a drag that begins like this does. `hand`: the hand is on; `on_body`: the mouse is on a body. Trackpads have one
/// button: Shift makes it the middle one, Ctrl (or Cmd) the right one.
pub fn gesture(button: PointerButton, keys: Modifiers, hand: bool, on_body: bool) -> Option<Gesture> {
    match button {
        PointerButton::Primary if keys.shift => Some(Gesture::Move),
        PointerButton::Primary if keys.command || keys.ctrl => Some(Gesture::Approach),
        PointerButton::Primary if on_body && (hand || keys.alt) => Some(Gesture::Pull),
        PointerButton::Primary => Some(Gesture::Orbit),
        PointerButton::Middle => Some(Gesture::Move),
        PointerButton::Secondary => Some(Gesture::Approach),
        _ => None,
    }
}

/// The camera after a drag by parts of the picture's height, to the right and downwards.
pub fn drag(camera: &mut Camera, gesture: Gesture, dx: Real, dy: Real) {
    match gesture {
        Gesture::Orbit => camera.orbit(dx, dy),
        Gesture::Move => camera.pan(dx, dy),
        Gesture::Approach => {
            camera.dolly(dy);
            camera.roll(dx);
        }
        Gesture::Pull => {}
    }
}

/// The camera comes nearer (positive) towards what is under the mouse, at the distance of the point looked at: it stays
/// under the mouse. `at`: the mouse from the middle of the picture, to the right and downwards, in its heights.
pub fn approach(camera: &mut Camera, by: Real, at: (Real, Real)) {
    let before = camera.distance();
    camera.dolly(by);
    let factor = camera.distance() / before;
    if factor > 0.0 && factor.is_finite() {
        let shift = 1.0 - 1.0 / factor;
        camera.pan(at.0 * shift, at.1 * shift);
    }
}

/// Looks along an axis (0 x, 1 y, 2 z) from its positive or negative side; point and distance stay.
pub fn along_axis(camera: &mut Camera, axis: usize, negative: bool) {
    let distance = camera.distance();
    let sign = if negative { -1.0 } else { 1.0 };
    let unit = [Vec3::X, Vec3::Y, Vec3::Z][axis.min(2)];
    camera.eye = camera.look_at + unit * (sign * distance);
    camera.up = if axis == 1 { Vec3::Z * -sign } else { Vec3::Y };
}

/// Looks at a ball from the same side, so that it fills a good part of the picture.
pub fn look_at_ball(camera: &mut Camera, center: Vec3, radius: Real) {
    let forward = camera.axes().forward;
    let nearest = radius * 6.0 / camera.tan_half_fov().max(1e-3);
    let distance = if radius > 0.0 { nearest.min(camera.distance()) } else { camera.distance() };
    if center.is_finite() && distance > 0.0 && distance.is_finite() {
        camera.look_at = center;
        camera.eye = center - forward * distance;
    }
}

/// Moves with what has moved.
pub fn follow(camera: &mut Camera, from: Vec3, to: Vec3) {
    let by = to - from;
    if by.is_finite() {
        camera.eye += by;
        camera.look_at += by;
    }
}

/// A body in the hand.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Held {
    /// where it is held, in its own axes \[m\]
    pub point: Vec3,
    /// how far before the eye, along the line of sight \[m\]: the mouse moves the point in this plane
    pub depth: Real,
}

impl Held {
    /// Takes a body at a point of its surface.
    pub fn take(camera: &Camera, at: Vec3, position: Vec3, orientation: Quat) -> Held {
        let depth = (at - camera.eye).dot(camera.axes().forward);
        Held { point: orientation.conjugate().rotate(at - position), depth }
    }

    /// Where the hand is when the mouse is on this line of sight \[m\].
    pub fn target(&self, camera: &Camera, direction: Vec3) -> Vec3 {
        let cosine = direction.dot(camera.axes().forward);
        camera.eye + direction * (self.depth / if cosine > 1e-6 { cosine } else { 1.0 })
    }

    /// The held point of a body that is here now \[m\].
    pub fn end(&self, position: Vec3, orientation: Quat) -> Vec3 {
        position + orientation.rotate(self.point)
    }

    /// The hand comes nearer (positive) or goes away, as the wheel turns; it stays before the eye.
    pub fn reach(&mut self, by: Real) {
        if by.is_finite() {
            self.depth *= (-by.clamp(-2.0, 2.0)).exp();
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn camera() -> Camera {
        Camera { eye: Vec3::new(0.0, 0.0, 4.0), look_at: Vec3::ZERO, up: Vec3::Y, fov_deg: 60.0 }
    }

    #[test]
    fn the_three_buttons_are_the_thesis_s() {
        let none = Modifiers::NONE;
        for hand in [false, true] {
            let at = |b, keys, on| gesture(b, keys, hand, on);
            assert_eq!(at(PointerButton::Primary, none, false), Some(Gesture::Orbit));
            assert_eq!(at(PointerButton::Middle, none, true), Some(Gesture::Move));
            assert_eq!(at(PointerButton::Secondary, none, true), Some(Gesture::Approach));
            assert_eq!(at(PointerButton::Primary, Modifiers::SHIFT, true), Some(Gesture::Move));
            assert_eq!(at(PointerButton::Primary, Modifiers::CTRL, true), Some(Gesture::Approach));
            assert_eq!(at(PointerButton::Extra1, none, true), None);
        }
    }

    #[test]
    fn a_body_is_pulled_only_when_it_is_asked_for() {
        let at = |keys, hand, on| gesture(PointerButton::Primary, keys, hand, on);
        assert_eq!(at(Modifiers::NONE, false, true), Some(Gesture::Orbit));
        assert_eq!(at(Modifiers::NONE, true, true), Some(Gesture::Pull));
        assert_eq!(at(Modifiers::ALT, false, true), Some(Gesture::Pull));
        assert_eq!(at(Modifiers::ALT, true, false), Some(Gesture::Orbit));
    }

    #[test]
    fn what_is_under_the_mouse_stays_there_when_the_wheel_turns() {
        for by in [0.1, -0.2, 0.7] {
            let mut c = camera();
            c.orbit(0.1, 0.2);
            let at = (0.3, -0.2);
            let seen = |c: &Camera| {
                let axes = c.axes();
                let height = 2.0 * c.distance() * c.tan_half_fov();
                c.look_at + (axes.right * at.0 - axes.up * at.1) * height
            };
            let (before, distance) = (seen(&c), c.distance());
            approach(&mut c, by, at);
            assert!((seen(&c) - before).length() < 1e-12, "{by}");
            assert_eq!(c.distance() < distance, by > 0.0);
        }
    }

    #[test]
    fn views_along_the_axes_keep_distance_and_point() {
        let mut c = camera();
        for axis in 0..3 {
            for negative in [false, true] {
                along_axis(&mut c, axis, negative);
                let a = c.axes();
                assert!((c.distance() - 4.0).abs() < 1e-12 && c.look_at == Vec3::ZERO);
                assert_eq!(a.forward[axis], if negative { 1.0 } else { -1.0 });
                assert!(a.up.dot(a.forward).abs() < 1e-12);
            }
        }
        along_axis(&mut c, 1, false);
        assert_eq!(c.axes().right, Vec3::X, "seen from above, x points to the right as seen from the front");
    }

    #[test]
    fn a_ball_is_looked_at_from_the_same_side_and_never_from_farther() {
        let mut c = camera();
        let forward = c.axes().forward;
        look_at_ball(&mut c, Vec3::new(1.0, 2.0, 0.0), 0.05);
        assert!((c.axes().forward - forward).length() < 1e-12 && c.look_at == Vec3::new(1.0, 2.0, 0.0));
        assert!(c.distance() < 4.0 && c.distance() > 0.05 * 2.0);
        look_at_ball(&mut c, Vec3::ZERO, 1e9);
        assert!(c.distance() < 4.0);
        let before = c;
        look_at_ball(&mut c, Vec3::splat(Real::NAN), 1.0);
        follow(&mut c, Vec3::splat(Real::NAN), Vec3::ZERO);
        assert_eq!(c, before);
        follow(&mut c, Vec3::ZERO, Vec3::X);
        assert_eq!((c.eye, c.look_at), (before.eye + Vec3::X, before.look_at + Vec3::X));
    }

    #[test]
    fn a_held_point_stays_under_the_mouse_in_its_plane() {
        let c = camera();
        let q = Quat::from_axis_angle(Vec3::Z, 0.7);
        let (at, position) = (Vec3::new(0.5, 0.25, 1.0), Vec3::new(0.4, 0.2, 0.8));
        let mut held = Held::take(&c, at, position, q);
        assert!((held.end(position, q) - at).length() < 1e-12);
        let direction = (at - c.eye).try_normalize().unwrap_or(Vec3::Z);
        assert!((held.target(&c, direction) - at).length() < 1e-12, "nothing is pulled before the mouse moves");
        let aside = (Vec3::new(2.0, 0.25, 1.0) - c.eye).try_normalize().unwrap_or(Vec3::Z);
        assert!((held.target(&c, aside) - Vec3::new(2.0, 0.25, 1.0)).length() < 1e-12);
        held.reach(0.5);
        assert!(held.depth < 3.0 && held.depth > 0.0);
        held.reach(Real::NAN);
        assert!(held.depth > 0.0);
    }
}
