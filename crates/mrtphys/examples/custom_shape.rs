//! A shape of one's own, made outside of the crate: a capsule. It registers a kind, declares two pair routines, and
//! collides with everything else as its bounding sphere.
//!
//!     cargo run --release -p mrtphys --example custom_shape

use mrtphys::bounds::Ball;
use mrtphys::narrow::kinds::Kinds;
use mrtphys::narrow::{Placed, Touches};
use mrtphys::shape::{HalfSpace, LimitQuadrangle, MassProperties, Shape, Sphere};
use mrtphys::{BodyDef, ContactMode, Quat, Settings, Surface, Vec3, World};

/// All points within `radius` of a piece of the y axis of length `2 half`.
#[derive(Debug)]
struct Capsule {
    half: f64,
    radius: f64,
}

impl Capsule {
    /// The two ends of the axis in the world.
    fn ends(&self, at: &Placed<'_>) -> [Vec3; 2] {
        let half = *at.rotation * Vec3::new(0.0, self.half, 0.0);
        [at.position - half, at.position + half]
    }
}

impl Shape for Capsule {
    fn kind(&self) -> &'static str {
        "capsule"
    }

    fn bounding_sphere(&self) -> Ball {
        Ball { center: Vec3::ZERO, radius: self.half + self.radius }
    }

    /// A cylinder of height h = 2 half and a sphere cut in two: the halves' centres of mass are 3/8 r inside of their faces.
    fn mass_properties(&self) -> Option<MassProperties> {
        let (r, h) = (self.radius, 2.0 * self.half);
        let (cylinder, sphere) = (std::f64::consts::PI * r * r * h, 4.0 / 3.0 * std::f64::consts::PI * r * r * r);
        let volume = cylinder + sphere;
        let along = (0.5 * cylinder + 0.4 * sphere) * r * r;
        let across = cylinder * (r * r / 4.0 + h * h / 12.0) + sphere * (0.4 * r * r + h * h / 4.0 + 3.0 / 8.0 * h * r);
        Some(MassProperties {
            volume,
            moments_per_mass: Vec3::new(across, along, across) * (1.0 / volume),
            axes: Quat::IDENTITY,
        })
    }
}

/// Capsule against sphere: the point of the axis nearest to the centre decides.
fn capsule_sphere(a: &Placed<'_>, b: &Placed<'_>, out: &mut Touches) {
    let (Some(capsule), Some(sphere)) = (a.shape.downcast::<Capsule>(), b.shape.downcast::<Sphere>()) else { return };
    let [low, high] = capsule.ends(a);
    let along = high - low;
    let t = ((b.position - low).dot(along) / along.length_squared()).clamp(0.0, 1.0);
    let nearest = low + along * t;
    let apart = b.position - nearest;
    let depth = capsule.radius + sphere.radius() - apart.length();
    if depth < 0.0 {
        return;
    }
    let normal = apart.try_normalize().unwrap_or(Vec3::X);
    let point = nearest + normal * (capsule.radius - 0.5 * depth);
    out.push(normal, point, depth, 0, &[point]);
}

/// Capsule against half-space: the lower end, or the middle of both where they are level.
fn capsule_half_space(a: &Placed<'_>, b: &Placed<'_>, out: &mut Touches) {
    let Some(capsule) = a.shape.downcast::<Capsule>() else { return };
    let wall = b.shape.downcast::<HalfSpace>().map(HalfSpace::normal);
    let Some(normal) = wall.or(b.shape.downcast::<LimitQuadrangle>().map(LimitQuadrangle::normal)) else { return };
    let [low, high] = capsule.ends(a).map(|end| (end, normal.dot(end - b.position)));
    let deepest = if low.1 < high.1 { low } else { high };
    let level = (low.1 - high.1).abs() <= 1e-12 * capsule.half;
    let center = if level { a.position } else { deepest.0 };
    let depth = capsule.radius - deepest.1;
    if depth >= 0.0 {
        let point = center - normal * (capsule.radius - 0.5 * depth);
        out.push(-normal, point, depth, 0, &[point]);
    }
}

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let mut kinds = Kinds::standard(ContactMode::Exact);
    kinds.add("capsule", "body")?;
    kinds.declare("capsule", "sphere", "capsule_sphere", capsule_sphere)?;
    kinds.declare("capsule", "half-space", "capsule_half_space", capsule_half_space)?;

    let mut world = World::with_kinds(Settings { fps: 64, steps_per_frame: 8, ..Settings::default() }, kinds)?;
    println!("{}", world.kinds().resolve());
    world.add_box("box", Vec3::ZERO, Vec3::splat(1.0), Surface::default())?;
    for i in 0..8_u32 {
        let at = |bit: u32| if i >> bit & 1 == 0 { 0.25 } else { 0.75 };
        let position = Vec3::new(at(0), at(1), at(2));
        let velocity = Vec3::new(at(1) - 0.4, at(2) - 0.6, at(0) - 0.5);
        let body = if i % 2 == 0 {
            BodyDef {
                angular_velocity: Vec3::new(1.0, 0.0, 2.0),
                ..BodyDef::new(std::sync::Arc::new(Capsule { half: 0.1, radius: 0.05 }) as std::sync::Arc<dyn Shape>)
            }
        } else {
            BodyDef::new(Sphere::new(0.1)?)
        };
        world.add_body(BodyDef { position, velocity, ..body })?;
    }
    let start = world.energy().total();
    for _ in 0..640 {
        world.frame()?;
    }
    let error = world.energy().total() / start - 1.0;
    println!("{} impacts in {} s, energy changed by {error:e} of itself", world.totals().impacts, world.time());
    assert!(world.totals().impacts > 20 && error.abs() < 1e-12, "a capsule conserves energy like any other shape");
    Ok(())
}
