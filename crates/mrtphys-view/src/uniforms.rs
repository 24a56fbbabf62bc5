//! What the shaders know about a picture as a whole.

use crate::frame::{Frame, Illumination, Light, MOST_LIGHTS};
use crate::matrix::Matrix;
use crate::palette::linear;
use mrtphys::{Real, Vec3};

/// As `Picture` in `common.wgsl`.
#[derive(Clone, Copy, Debug, PartialEq, bytemuck::Pod, bytemuck::Zeroable)]
#[repr(C)]
pub struct Uniforms {
    projection: [[f32; 4]; 4],
    shadow: [[f32; 4]; 4],
    eye: [f32; 4],
    up: [f32; 4],
    size: [f32; 4],
    counts: [f32; 4],
    sky: [f32; 4],
    base: [f32; 4],
    ink: [f32; 4],
    paper: [f32; 4],
    accent: [f32; 4],
    lamps: [[[f32; 4]; 2]; MOST_LIGHTS],
}

/// Shadows are drawn to this many distances of the eye from the point looked at.
const SHADOWS_TO: f32 = 6.0;
/// Width of the edges of wireframe drawings \[pixels\] in a picture 720 pixels high.
const EDGE_WIDTH: f32 = 1.2;

fn four(v: [f32; 3], w: f32) -> [f32; 4] {
    [v[0], v[1], v[2], w]
}

fn single(v: Vec3) -> [f32; 3] {
    v.to_array().map(|x| x as f32)
}

impl Uniforms {
    /// For a picture of this size \[pixels\], with a shadow map of this size \[texels\].
    pub fn new(frame: &Frame, width: u32, height: u32, shadow_size: u32) -> Uniforms {
        let aspect = Real::from(width) / Real::from(height);
        let colors = frame.look.theme.colors();
        let mut lamps = [[[0.0; 4]; 2]; MOST_LIGHTS];
        let mut count = 0;
        let equation = Illumination::ALL.iter().position(|i| i.0 == frame.look.illumination).unwrap_or(0) as f32;
        for light in lamps_of(frame) {
            let Some(direction) = light.direction.try_normalize() else { continue };
            let Some(lamp) = lamps.get_mut(count) else { break };
            *lamp = [four(single(-direction), 0.0), four(linear(light.color).map(|c| c * light.strength), 0.0)];
            count += 1;
        }
        let first = lamps_of(frame).iter().find_map(|l| l.direction.try_normalize());
        let (shadow, radius) = match first {
            Some(direction) if casts_shadows(frame) => shadow_view(frame, direction, shadow_size),
            _ => (Matrix([[0.0; 4]; 4]), 0.0),
        };
        let up = frame.camera.up.try_normalize().unwrap_or(Vec3::Y);
        Uniforms {
            projection: frame.camera.projection(frame.origin, frame.unit, aspect).to_f32(),
            shadow: shadow.to_f32(),
            eye: four(frame.place(frame.camera.eye), 1.0),
            up: four(single(up), 0.0),
            size: [width as f32, height as f32, edge_width(height), 2.0 * radius as f32 / shadow_size as f32],
            counts: [count as f32, f32::from(radius > 0.0), 1.0 / shadow_size as f32, equation],
            sky: four(linear(colors.sky), 1.0),
            base: four(linear(colors.base), 1.0),
            ink: four(linear(colors.ink), 1.0),
            paper: four(linear(colors.paper), 1.0),
            accent: four(linear(colors.accent), 1.0),
            lamps,
        }
    }

    /// Whether the first lamp throws shadows.
    pub fn has_shadows(&self) -> bool {
        self.counts[1] > 0.5
    }
}

/// Lines keep their part of the picture in large ones, and stay a pixel wide in small ones.
pub fn edge_width(height: u32) -> f32 {
    EDGE_WIDTH * (height as f32 / 720.0).max(1.0)
}

/// The lights that shine in a picture.
fn lamps_of(frame: &Frame) -> &[Light] {
    if frame.look.illumination == Illumination::Ambient { &[] } else { &frame.lights }
}

fn casts_shadows(frame: &Frame) -> bool {
    frame.look.shadows && !frame.look.mode.has_lines()
}

/// What the first lamp sees: the bodies and finite walls near enough, in a cube. Returns half its edge; 0: nothing.
fn shadow_view(frame: &Frame, direction: Vec3, texels: u32) -> (Matrix, Real) {
    let (mut min, mut max) = ([f32::INFINITY; 3], [f32::NEG_INFINITY; 3]);
    let mut see = |p: [f32; 3], r: f32| {
        for k in 0..3 {
            min[k] = min[k].min((p[k] - r).max(-SHADOWS_TO));
            max[k] = max[k].max((p[k] + r).min(SHADOWS_TO));
        }
    };
    frame.bodies().for_each(|b| see(b.position, b.scale));
    let finite = frame.walls.iter().filter(|w| w.endless.is_none());
    finite.flat_map(|w| w.corners).for_each(|c| see(frame.place(c), 0.0));
    let vector = |p: [f32; 3]| Vec3::new(p[0].into(), p[1].into(), p[2].into());
    let (min, max) = (vector(min), vector(max));
    let radius = 0.5 * (max - min).length();
    if !(radius > 0.0 && radius.is_finite()) {
        return (Matrix([[0.0; 4]; 4]), 0.0);
    }
    // Sizes in steps, places in texels: shadows do not shimmer while bodies move.
    let radius = 1.01 * ((radius.log2() * 4.0).ceil() / 4.0).exp2();
    let right = direction.cross(if direction.y.abs() < 0.9 { Vec3::Y } else { Vec3::X });
    let right = right.try_normalize().unwrap_or(Vec3::X);
    let up = right.cross(direction);
    let texel = 2.0 * radius / Real::from(texels);
    let snap = |x: Real| (x / texel).round() * texel;
    let middle = (min + max) * 0.5;
    let eye = right * snap(middle.dot(right)) + up * snap(middle.dot(up)) + direction * middle.dot(direction);
    (Matrix::parallel(radius).times(&Matrix::view(eye, right, up, direction)), radius)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::camera::Camera;
    use crate::frame::{Instance, Look};
    use mrtphys::math::Quat;

    fn frame() -> Frame {
        let camera = Camera { eye: Vec3::new(0.0, 0.0, 4.0), look_at: Vec3::ZERO, up: Vec3::Y, fov_deg: 45.0 };
        let mut frame = Frame::new(camera, Look::default());
        let ball = |x: Real| frame.instance(Vec3::new(x, 0.0, 0.0), 0.5, Quat::IDENTITY, [255; 4]);
        let balls: Vec<Instance> = [-1.0, 1.0].into_iter().filter_map(ball).collect();
        frame.spheres = balls;
        frame.lights.push(Light { direction: Vec3::new(-1.0, -2.0, -1.0), color: [255; 3], strength: 1.0 });
        frame
    }

    fn apply(m: &[[f32; 4]; 4], p: [f32; 3]) -> [f32; 4] {
        std::array::from_fn(|row| (0..3).map(|k| m[k][row] * p[k]).sum::<f32>() + m[3][row])
    }

    #[test]
    fn the_shadow_map_holds_every_body_and_sees_the_nearer_one_nearer() {
        let u = Uniforms::new(&frame(), 320, 240, 1024);
        assert!(u.has_shadows());
        for b in &frame().spheres {
            for k in 0..3 {
                for side in [-1.0, 1.0] {
                    let mut p = b.position;
                    p[k] += side * b.scale;
                    let at = apply(&u.shadow, p);
                    assert!(at[0].abs() <= 1.0 && at[1].abs() <= 1.0 && (0.0..=1.0).contains(&at[2]), "{at:?}");
                }
            }
        }
        // The light comes from +x.
        assert!(apply(&u.shadow, [0.25, 0.0, 0.0])[2] < apply(&u.shadow, [-0.25, 0.0, 0.0])[2]);
    }

    #[test]
    fn a_body_far_away_does_not_spoil_the_shadows() {
        let mut far = frame();
        let texel = |f: &Frame| Uniforms::new(f, 320, 240, 1024).size[3];
        let before = texel(&far);
        let away = far.instance(Vec3::X * 1e7, 0.5, Quat::IDENTITY, [255; 4]);
        far.spheres.extend(away);
        assert!(texel(&far) < 16.0 * before);
    }

    #[test]
    fn no_light_no_shadow_and_no_body_no_shadow() {
        let mut f = frame();
        f.lights.clear();
        assert!(!Uniforms::new(&f, 320, 240, 1024).has_shadows());
        let mut f = frame();
        f.spheres.clear();
        assert!(!Uniforms::new(&f, 320, 240, 1024).has_shadows());
        let mut f = frame();
        f.lights = vec![f.lights[0]; 9];
        assert_eq!(Uniforms::new(&f, 320, 240, 1024).counts[0], MOST_LIGHTS as f32);
    }
}
