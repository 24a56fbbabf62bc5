//! Drawings that explain what happens: contacts, impulses, velocities, bounds, cells, trails, and the hand's spring.
//!
//! A [`Pen`] is made for each picture and draws plain data into an [`Overlay`]. Lengths are relative to the scene, or to what the
//! picture shows of it; widths are in pixels and grow with high pictures. Colors have the hues of Okabe and Ito, which people with
//! any kind of color vision tell apart, darker on light and lighter on dark.
//!
//! Each method draws with at most [`Pen::lines`] lines, and tells how many of how many it drew: a window is to say so where that
//! is less than all. Unless a method says otherwise those drawn are spread evenly over all.

mod arrows;
mod paths;
mod volumes;

use crate::camera::Camera;
use crate::overlay::{Line, Overlay, Point, Rgba};
use crate::palette::{Rgb, Theme};
use mrtphys::bounds::Aabb;
use mrtphys::{Real, Vec3};

/// How much of it was drawn.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Drawn {
    /// so many were drawn
    pub drawn: usize,
    /// of so many
    pub total: usize,
}

impl Drawn {
    /// Whether some are missing, which the user is to be told.
    pub fn is_part(self) -> bool {
        self.drawn < self.total
    }
}

/// Most lines that a method of a pen draws with, unless told otherwise.
pub const LINES: usize = 60_000;
/// Lengths are relative to the scene's diagonal, but to no less than this part of what is seen, and no more than all of it.
const LEAST: Real = 0.5;
/// The longest arrow, relative to what is seen.
const LONGEST: Real = 0.15;
/// The length of a contact's normal, relative to what is seen.
const NORMAL: Real = 0.05;
/// What is infinite is drawn to so many diagonals of the scene from its middle.
const REGION: Real = 2.0;

/// Colors of what is drawn, for a window to show beside the names.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Inks {
    /// contact points
    pub contact: Rgb,
    /// their normals
    pub normal: Rgb,
    /// impulses
    pub impulse: Rgb,
    /// velocities
    pub velocity: Rgb,
    /// angular velocities
    pub spin: Rgb,
    /// bounding spheres
    pub ball: Rgb,
    /// axis-parallel boxes
    pub aabb: Rgb,
    /// the hand's spring
    pub grip: Rgb,
}

impl Inks {
    /// Those of a theme: the hues are the same, dark ones are lighter on dark and light ones darker on light.
    pub fn of(theme: Theme) -> Inks {
        match theme {
            Theme::Light => Inks {
                contact: [0xd5, 0x5e, 0x00],
                normal: [0xa9, 0x4a, 0x7e],
                impulse: [0xa8, 0x7c, 0x00],
                velocity: [0x00, 0x5f, 0x98],
                spin: [0x00, 0x80, 0x5c],
                ball: [0x2b, 0x8c, 0xc4],
                aabb: [0x30, 0x38, 0x44],
                grip: [0xd5, 0x5e, 0x00],
            },
            Theme::Dark => Inks {
                contact: [0xff, 0x7a, 0x1a],
                normal: [0xe5, 0x95, 0xc2],
                impulse: [0xe6, 0x9f, 0x00],
                velocity: [0x56, 0xb4, 0xe9],
                spin: [0x20, 0xc9, 0x97],
                ball: [0x8c, 0xcb, 0xf0],
                aabb: [0xf0, 0xe4, 0x42],
                grip: [0xff, 0x7a, 0x1a],
            },
        }
    }
}

/// Draws explanations into an overlay, for one picture.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Pen {
    /// colors
    pub inks: Inks,
    /// most lines that a method draws with: [`LINES`]
    pub lines: usize,
    /// whether arrows show through the bodies
    pub on_top: bool,
    theme: Theme,
    eye: Vec3,
    /// length of what is seen \[m\]
    length: Real,
    /// width of a thin line \[pixels\]
    thin: f32,
    region: Aabb,
}

impl Pen {
    /// For a picture of this height \[pixels\] of a scene with these bounds.
    pub fn new(camera: &Camera, bounds: &Aabb, theme: Theme, height: u32) -> Pen {
        let seen = 2.0 * camera.distance() * camera.tan_half_fov();
        let diagonal = (bounds.max - bounds.min).length();
        let known = diagonal > 0.0 && diagonal.is_finite();
        let length = if known { diagonal.clamp(LEAST * seen, seen) } else { seen };
        let middle = if known { (bounds.min + bounds.max) * 0.5 } else { camera.look_at };
        let around = Vec3::splat(REGION * if known { diagonal } else { seen });
        Pen {
            inks: Inks::of(theme),
            lines: LINES,
            on_top: true,
            theme,
            eye: camera.eye,
            length,
            thin: 1.25 * (height as f32 / 720.0).max(1.0),
            region: Aabb { min: middle - around, max: middle + around },
        }
    }

    fn line(&self, from: Vec3, to: Vec3, color: Rgba, width: f32) -> Line {
        Line { from, to, color, width: width * self.thin, on_top: self.on_top }
    }

    fn dot(&self, overlay: &mut Overlay, at: Vec3, color: Rgb, size: f32) {
        overlay.points.push(Point { at, color: opaque(color, 255), size: size * self.thin, on_top: self.on_top });
    }

    /// How many things of so many lines each may be drawn.
    fn affordable(&self, lines_each: usize) -> usize {
        self.lines / lines_each.max(1)
    }
}

/// Numbers below `total`, at most `most`, spread evenly.
fn spread(total: usize, most: usize) -> impl Iterator<Item = usize> {
    let count = total.min(most);
    (0..count).map(move |k| (k as u128 * total as u128 / count as u128) as usize)
}

fn opaque([r, g, b]: Rgb, a: u8) -> Rgba {
    [r, g, b, a]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::palette::linear;

    pub(super) fn pen() -> Pen {
        let camera = Camera { eye: Vec3::Z * 10.0, look_at: Vec3::ZERO, up: Vec3::Y, fov_deg: 45.0 };
        let bounds = Aabb { min: Vec3::splat(-1.0), max: Vec3::splat(1.0) };
        Pen::new(&camera, &bounds, Theme::Light, 720)
    }

    #[test]
    fn those_drawn_are_spread_over_all() {
        assert_eq!(spread(3, 10).collect::<Vec<_>>(), [0, 1, 2]);
        assert_eq!(spread(10, 3).collect::<Vec<_>>(), [0, 3, 6]);
        assert_eq!(spread(0, 3).count() + spread(3, 0).count(), 0);
        assert!(Drawn { drawn: 3, total: 10 }.is_part() && !Drawn { drawn: 3, total: 3 }.is_part());
    }

    #[test]
    fn inks_stand_out_from_the_background_and_from_each_other() {
        // Contrast as of WCAG 2.1, "Contrast Minimum": at least 3 for graphics.
        let brightness = |c: Rgb| {
            let [r, g, b] = linear(c);
            0.2126 * r + 0.7152 * g + 0.0722 * b + 0.05
        };
        for theme in [Theme::Light, Theme::Dark] {
            let (i, back) = (Inks::of(theme), theme.colors().base);
            let all = [i.contact, i.normal, i.impulse, i.velocity, i.spin, i.ball, i.aabb];
            for (n, c) in all.iter().enumerate() {
                let ratio = brightness(*c) / brightness(back);
                assert!(ratio.max(1.0 / ratio) > 2.3, "{theme:?} {n}: {ratio}");
                for d in &all[..n] {
                    let apart: i32 = c.iter().zip(d).map(|(x, y)| (i32::from(*x) - i32::from(*y)).abs()).sum();
                    assert!(apart > 60, "{theme:?}: {c:?} {d:?}");
                }
            }
        }
    }

    #[test]
    fn lengths_are_those_of_what_is_seen_or_of_a_smaller_scene() {
        let seen = 20.0 * 22.5f64.to_radians().tan();
        assert!((pen().length - 0.5 * seen).abs() < 1e-12, "a small scene in a large picture");
        let camera = Camera { eye: Vec3::Z * 10.0, look_at: Vec3::ZERO, up: Vec3::Y, fov_deg: 45.0 };
        let middling = Aabb { min: Vec3::splat(-2.0), max: Vec3::splat(2.0) };
        assert!((Pen::new(&camera, &middling, Theme::Dark, 100).length - 48f64.sqrt()).abs() < 1e-12);
        for bounds in [Aabb { min: Vec3::splat(-1e3), max: Vec3::splat(1e3) }, Aabb::EVERYWHERE, Aabb::EMPTY] {
            assert!((Pen::new(&camera, &bounds, Theme::Dark, 100).length - seen).abs() < 1e-9);
        }
    }
}
