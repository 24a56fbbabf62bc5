//! Where the viewer is, and what a mouse does to it (thesis, chapter 7).

use crate::matrix::Matrix;
use mrtphys::bounds::Aabb;
use mrtphys::math::Quat;
use mrtphys::{Real, Vec3};

/// Smallest and largest vertical angle of view \[degrees\].
pub const ANGLES: (Real, Real) = (1.0, 150.0);
/// How near to the up vector an orbit may come \[radians\]: at the pole the picture would jump round.
const POLE: Real = 0.02;
/// A picture's height of dragging is this angle of an orbit or a roll \[radians\].
const ANGLE_OF_A_DRAG: Real = std::f64::consts::PI;
/// A picture's height of dragging changes the distance by this power of e.
const DOLLY_OF_A_DRAG: Real = 2.0;
/// What fits into the picture leaves some air about it.
const AIR: Real = 1.06;
/// A distance is multiplied or divided by no more than this at once: a wild mouse is no reason to be lost.
const MOST_AT_ONCE: Real = 20.0;
/// Nothing nearer to the eye than this part of the distance of the point looked at is drawn.
const NEAR: Real = 1e-3;

/// A perspective camera. Movements are given as fractions of the picture's height, to the right and downwards, as the mouse
/// moves.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Camera {
    /// position of the eye \[m\]
    pub eye: Vec3,
    /// the point looked at \[m\]
    pub look_at: Vec3,
    /// upwards; any length
    pub up: Vec3,
    /// vertical angle of view \[degrees\]
    pub fov_deg: Real,
}

impl From<mrtphys_scene::scene::Camera> for Camera {
    fn from(c: mrtphys_scene::scene::Camera) -> Camera {
        Camera { eye: c.eye, look_at: c.look_at, up: c.up, fov_deg: c.fov_deg }
    }
}

/// The axes of a camera: orthonormal, right-handed.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Axes {
    /// to the right in the picture
    pub right: Vec3,
    /// upwards in the picture
    pub up: Vec3,
    /// into the picture
    pub forward: Vec3,
}

/// A half-line in space.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ray {
    /// where it begins \[m\]
    pub origin: Vec3,
    /// where it goes; of length 1
    pub direction: Vec3,
}

impl Ray {
    /// The point at a distance \[m\] from the origin.
    pub fn at(&self, distance: Real) -> Vec3 {
        self.origin + self.direction * distance
    }
}

impl Camera {
    /// Distance from the eye to the point looked at \[m\]; never zero.
    pub fn distance(&self) -> Real {
        let d = (self.look_at - self.eye).length();
        if d > 0.0 && d.is_finite() { d } else { 1.0 }
    }

    /// The axes. Where `up` says nothing (zero, or along the line of sight), any upright will do.
    pub fn axes(&self) -> Axes {
        let forward = (self.look_at - self.eye).try_normalize().unwrap_or(-Vec3::Z);
        let across = forward.cross(self.up.try_normalize().unwrap_or(Vec3::Y));
        let right = if across.length() > 1e-9 { across.try_normalize() } else { None };
        let right = right.unwrap_or_else(|| forward.any_perpendicular().try_normalize().unwrap_or(Vec3::X));
        Axes { right, up: right.cross(forward), forward }
    }

    /// Tangent of half the vertical angle of view.
    pub fn tan_half_fov(&self) -> Real {
        let half = self.fov_deg.clamp(ANGLES.0, ANGLES.1).to_radians() / 2.0;
        if half.is_nan() { 0.4 } else { half.tan() }
    }

    /// Left drag: the viewer moves on a sphere round the point looked at; the distance is kept.
    pub fn orbit(&mut self, dx: Real, dy: Real) {
        let (distance, up) = (self.distance(), self.up.try_normalize().unwrap_or(Vec3::Y));
        let Axes { right, forward, .. } = self.axes();
        // The angle from `up` to the direction of the eye; a drag down lifts the eye.
        let polar = (-forward).dot(up).clamp(-1.0, 1.0).acos();
        let wanted = polar - finite(dy) * ANGLE_OF_A_DRAG;
        let turned = wanted.clamp(POLE.min(polar), (std::f64::consts::PI - POLE).max(polar)) - polar;
        let about_right = Quat::from_axis_angle(right, turned);
        let about_up = Quat::from_axis_angle(up, -finite(dx) * ANGLE_OF_A_DRAG);
        let toward_eye = about_up.rotate(about_right.rotate(-forward)).try_normalize().unwrap_or(-forward);
        self.eye = self.look_at + toward_eye * distance;
    }

    /// Middle drag: the point looked at moves in the plane of the picture, and the eye with it; what is under the mouse, at
    /// that distance, stays under it.
    pub fn pan(&mut self, dx: Real, dy: Real) {
        let height = 2.0 * self.distance() * self.tan_half_fov();
        let Axes { right, up, .. } = self.axes();
        let by = (up * finite(dy) - right * finite(dx)) * height;
        self.eye += by;
        self.look_at += by;
    }

    /// Right drag, vertical: approach (down) or recede (up). The point looked at is never reached.
    pub fn dolly(&mut self, dy: Real) {
        let factor = (-finite(dy) * DOLLY_OF_A_DRAG).exp().clamp(1.0 / MOST_AT_ONCE, MOST_AT_ONCE);
        let toward_eye = -self.axes().forward;
        self.eye = self.look_at + toward_eye * (self.distance() * factor);
    }

    /// Right drag, horizontal: the up vector turns about the line of sight, and the picture with the mouse.
    pub fn roll(&mut self, dx: Real) {
        let Axes { up, forward, .. } = self.axes();
        self.up = Quat::from_axis_angle(forward, -finite(dx) * ANGLE_OF_A_DRAG).rotate(up);
    }

    /// Magnifies the middle of the picture by narrowing the angle of view: 2 shows half as much.
    pub fn zoom(&mut self, factor: Real) {
        if factor > 0.0 && factor.is_finite() {
            let half = (self.tan_half_fov() / factor).atan();
            self.fov_deg = (2.0 * half.to_degrees()).clamp(ANGLES.0, ANGLES.1);
        }
    }

    /// Looks at a box from the same side, from where all its corners just fit into a picture of this width to height.
    pub fn fit(&mut self, bounds: &Aabb, aspect: Real) {
        let (center, half) = ((bounds.min + bounds.max) * 0.5, (bounds.max - bounds.min) * 0.5);
        if !(half.is_finite() && center.is_finite()) {
            return;
        }
        let Axes { right, up, forward } = self.axes();
        let (tan, aspect) = (self.tan_half_fov() / AIR, if aspect > 0.0 { aspect } else { 1.0 });
        // A corner c fits if |c.right| <= aspect tan (distance + c.forward), and so upwards.
        let needed = |i: usize| {
            let sign = |bit: usize| if i >> bit & 1 == 0 { -1.0 } else { 1.0 };
            let c = half.mul_elements(Vec3::new(sign(0), sign(1), sign(2)));
            (c.dot(right).abs() / aspect).max(c.dot(up).abs()) / tan - c.dot(forward)
        };
        let distance = (0..8).map(needed).fold(0.0, Real::max);
        let toward_eye = -forward;
        let distance = if distance > 0.0 { distance } else { self.distance() };
        self.look_at = center;
        self.eye = center + toward_eye * distance;
    }

    /// What is seen at a place of the picture, given as fractions of its width and height from the upper left corner: the
    /// line of sight, from the near plane on. `aspect`: width to height.
    pub fn ray(&self, x: Real, y: Real, aspect: Real) -> Ray {
        let Axes { right, up, forward } = self.axes();
        let tan = self.tan_half_fov();
        let along = forward + right * (tan * aspect * (2.0 * x - 1.0)) + up * (tan * (1.0 - 2.0 * y));
        let direction = along.try_normalize().unwrap_or(forward);
        Ray { origin: self.eye + along * (NEAR * self.distance()), direction }
    }

    /// Where in the picture a point is: fractions of its width and height from the upper left corner, which lie outside 0
    /// to 1 where the point is beyond the edge. `None`: it is not before the near plane.
    pub fn place(&self, point: Vec3, aspect: Real) -> Option<(Real, Real)> {
        let Axes { right, up, forward } = self.axes();
        let d = point - self.eye;
        let depth = d.dot(forward);
        if !(depth >= NEAR * self.distance()) {
            return None;
        }
        let half = depth * self.tan_half_fov();
        Some((0.5 + 0.5 * d.dot(right) / (half * aspect), 0.5 - 0.5 * d.dot(up) / half))
    }

    /// World to clip coordinates, in coordinates relative to `origin` and in units of `unit` metres.
    pub(crate) fn projection(&self, origin: Vec3, unit: Real, aspect: Real) -> Matrix {
        let Axes { right, up, forward } = self.axes();
        let view = Matrix::view((self.eye - origin) / unit, right, up, forward);
        Matrix::perspective(self.tan_half_fov(), aspect, NEAR * self.distance() / unit).times(&view)
    }
}

fn finite(x: Real) -> Real {
    if x.is_finite() { x.clamp(-10.0, 10.0) } else { 0.0 }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn camera() -> Camera {
        Camera { eye: Vec3::new(2.0, 1.5, 3.0), look_at: Vec3::splat(0.5), up: Vec3::Y, fov_deg: 45.0 }
    }

    fn near(a: Vec3, b: Vec3) -> bool {
        (a - b).length() < 1e-12
    }

    #[test]
    fn an_orbit_keeps_the_distance_and_what_is_looked_at() {
        let mut c = camera();
        let distance = c.distance();
        for i in 0..1000 {
            c.orbit(0.013 * f64::from(i % 7), 0.3 * f64::from(i % 5) - 0.55);
            assert!((c.distance() - distance).abs() < 1e-12);
            assert_eq!((c.look_at, c.up), (Vec3::splat(0.5), Vec3::Y));
            assert!(c.axes().up.y > 0.0, "the picture never turns over");
        }
    }

    #[test]
    fn an_orbit_turns_as_a_globe_under_the_hand() {
        // Half the height is a quarter of a turn. A drag to the right moves the front to the right: the eye goes left.
        let mut c = Camera { eye: Vec3::Z * 2.0, look_at: Vec3::ZERO, up: Vec3::Y, fov_deg: 45.0 };
        c.orbit(0.5, 0.0);
        assert!(near(c.eye, Vec3::X * -2.0), "{:?}", c.eye);
        c.orbit(-0.5, 0.25);
        assert!(c.eye.y > 1.0 && c.eye.x.abs() < 1e-12, "{:?}", c.eye);
        c.orbit(0.0, 10.0);
        assert!(c.eye.y > 1.999 && c.eye.z > 0.0, "it stops before the pole");
    }

    #[test]
    fn a_pan_moves_both_ends_and_keeps_what_is_under_the_mouse() {
        let mut c = camera();
        let picture = |c: &Camera, p| {
            let h = c.projection(Vec3::ZERO, 1.0, 1.0).apply(p);
            (h[0] / h[3] / 2.0, h[1] / h[3] / 2.0)
        };
        let (p, before) = (c.look_at, c);
        c.pan(0.2, -0.1);
        assert!(near(c.look_at - before.look_at, c.eye - before.eye));
        let (x, y) = picture(&c, p);
        assert!((x - 0.2).abs() < 1e-12 && (y - 0.1).abs() < 1e-12, "{x} {y}");
    }

    #[test]
    fn a_dolly_never_reaches_the_point_looked_at() {
        let mut c = camera();
        let forward = c.axes().forward;
        c.dolly(0.1);
        assert!(c.distance() < camera().distance());
        assert!(near(c.axes().forward, forward));
        for _ in 0..100 {
            c.dolly(0.2);
        }
        assert!(c.distance() > 0.0 && c.eye.is_finite());
        let mut c = camera();
        c.dolly(-1.0);
        assert!(c.distance() > camera().distance());
    }

    #[test]
    fn a_roll_turns_the_picture_and_nothing_else() {
        let mut c = camera();
        let axes = c.axes();
        c.roll(0.5);
        assert_eq!((c.eye, c.look_at), (camera().eye, camera().look_at));
        assert!(near(c.axes().up, -axes.right), "a quarter of a turn: {:?}", c.axes());
        c.roll(-0.5);
        assert!(near(c.axes().up, axes.up));
    }

    #[test]
    fn zoom_magnifies_within_limits() {
        let mut c = camera();
        let tan = c.tan_half_fov();
        c.zoom(2.0);
        assert!((c.tan_half_fov() - tan / 2.0).abs() < 1e-12);
        [1e9, 0.0, Real::NAN, -3.0].iter().for_each(|&f| c.zoom(f));
        assert_eq!(c.fov_deg, ANGLES.0);
        c.zoom(1e-9);
        assert_eq!(c.fov_deg, ANGLES.1);
    }

    #[test]
    fn fit_shows_the_whole_box_and_not_much_more() {
        for aspect in [0.5, 1.0, 1.8] {
            let mut c = camera();
            let b = Aabb { min: Vec3::new(-1.0, 4.0, 2.0), max: Vec3::new(3.0, 5.0, 9.0) };
            let forward = c.axes().forward;
            c.fit(&b, aspect);
            assert!(near(c.axes().forward, forward));
            let projection = c.projection(c.look_at, 1.0, aspect);
            let mut largest = 0.0f64;
            for i in 0..8 {
                let pick = |k: usize| if i >> k & 1 == 0 { b.min[k] } else { b.max[k] };
                let h = projection.apply(Vec3::new(pick(0), pick(1), pick(2)) - c.look_at);
                largest = largest.max((h[0] / h[3]).abs()).max((h[1] / h[3]).abs());
            }
            assert!((0.9..=1.0).contains(&largest), "{aspect}: {largest}");
        }
    }

    #[test]
    fn a_ray_goes_through_what_is_drawn_at_its_place() {
        let mut c = camera();
        c.roll(0.1);
        for aspect in [0.5, 1.0, 1.8] {
            for (x, y) in [(0.5, 0.5), (0.0, 0.0), (1.0, 0.2), (0.3, 0.9), (-0.2, 1.3)] {
                let ray = c.ray(x, y, aspect);
                assert!((ray.direction.length() - 1.0).abs() < 1e-12);
                for distance in [0.001, 0.7, 5.0, 1e6] {
                    let p = ray.at(distance);
                    let (px, py) = c.place(p, aspect).unwrap();
                    assert!((px - x).abs() < 1e-9 && (py - y).abs() < 1e-9, "{px} {py} for {x} {y}");
                    // The same place as the renderer's matrix gives.
                    let h = c.projection(Vec3::ZERO, 1.0, aspect).apply(p);
                    let (mx, my) = (0.5 + 0.5 * h[0] / h[3], 0.5 - 0.5 * h[1] / h[3]);
                    assert!((px - mx).abs() < 1e-9 && (py - my).abs() < 1e-9);
                }
            }
        }
        assert!(c.ray(0.0, 0.0, 1.0).direction.dot(c.axes().up) > 0.0, "y counts downwards");
        assert_eq!(c.place(c.eye - c.axes().forward, 1.0), None);
        assert_eq!(c.place(c.eye, 1.0), None);
        assert_eq!(c.place(Vec3::splat(Real::NAN), 1.0), None);
        let (x, y) = c.place(c.look_at, 1.5).unwrap();
        assert!((x - 0.5).abs() < 1e-12 && (y - 0.5).abs() < 1e-12);
    }

    #[test]
    fn nonsense_does_no_harm() {
        let nowhere = Camera { eye: Vec3::ZERO, look_at: Vec3::ZERO, up: Vec3::ZERO, fov_deg: Real::NAN };
        for mut c in [nowhere, Camera { eye: Vec3::Y, ..nowhere }, Camera { eye: Vec3::Y, up: Vec3::Y, ..nowhere }] {
            c.orbit(Real::NAN, 0.1);
            c.orbit(0.1, 0.1);
            c.roll(Real::INFINITY);
            c.pan(0.1, Real::NAN);
            c.dolly(Real::NAN);
            c.fit(&Aabb { min: Vec3::splat(Real::INFINITY), max: Vec3::splat(Real::NEG_INFINITY) }, 1.0);
            c.fit(&Aabb { min: Vec3::ZERO, max: Vec3::ZERO }, 0.0);
            let a = c.axes();
            assert!(c.eye.is_finite() && c.look_at.is_finite() && c.tan_half_fov() > 0.0);
            assert!(a.right.dot(a.up).abs() < 1e-9 && (a.forward.length() - 1.0).abs() < 1e-9);
        }
    }
}
