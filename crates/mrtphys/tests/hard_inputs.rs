//! Hard inputs that no other test has: each names its row of the table of hard inputs. (Rows 1, 2, 5, 6, 8 to 10, 12, 44,
//! 48, 52 and 54: `world_api.rs`; 3, 4, 17, 18, 21 to 24: `physics.rs`, `motion.rs`, `reflection.rs`; 11, 28: `impacts.rs`; 34
//! to 43: `shapes.rs` and the modules of shapes; 45: `determinism.rs`; 55 to 58: `mrtphys-scene`.)

mod support;

use mrtphys::field::{Scope, UniformField};
use mrtphys::shape::{Polyhedron, Sphere};
use mrtphys::{BodyDef, BroadPhaseKind, Error, Mass, Mat3, Settings, Surface, Vec3, World};
use std::sync::Arc;

fn ball(r: f64, position: Vec3, velocity: Vec3) -> BodyDef {
    BodyDef { position, velocity, ..BodyDef::new(Sphere::new(r).unwrap()) }
}

fn world(broad_phase: BroadPhaseKind, dt_inverse: u32) -> World {
    World::new(Settings { broad_phase, fps: dt_inverse, steps_per_frame: 1, ..Settings::default() }).unwrap()
}

fn phases() -> Vec<BroadPhaseKind> {
    ["brute-force", "regular-grid", "adaptive-tree", "sorted-grid"].map(|name| name.parse().unwrap()).to_vec()
}

/// Row 7: gravity that is no number, enormous, or nothing.
#[test]
fn gravity_of_any_size() {
    assert!(UniformField::new(Vec3::new(0.0, f64::INFINITY, 0.0)).is_err());
    for g in [0.0, 1e20] {
        let mut w = world(BroadPhaseKind::SortedGrid, 512);
        w.add_force(Arc::new(UniformField::new(Vec3::new(0.0, -g, 0.0)).unwrap()), Scope::default()).unwrap();
        let id = w.add_body(ball(1.0, Vec3::ZERO, Vec3::ZERO)).unwrap();
        (0..512).for_each(|_| w.step().unwrap());
        assert!((w.body(id).unwrap().position.y + 0.5 * g).abs() <= 1e-12 * g);
        assert_eq!(w.totals().quarantined, 0);
    }
}

/// Row 11: mass ratios up to 1e12 keep momentum and energy on a world.
#[test]
fn mass_ratios() {
    for ratio in [1e6, 1e9, 1e12] {
        let mut w = world(BroadPhaseKind::SortedGrid, 64);
        let heavy = BodyDef { mass: Mass::Value(ratio), ..ball(1.0, Vec3::ZERO, Vec3::X) };
        w.add_body(heavy).unwrap();
        let light = w.add_body(BodyDef { mass: Mass::Value(1.0), ..ball(1.0, Vec3::new(2.1, 0.0, 0.0), Vec3::ZERO) });
        (0..64).for_each(|_| w.step().unwrap());
        assert_eq!(w.totals().impacts, 1);
        let v = w.body(light.unwrap()).unwrap().velocity.x;
        assert!((v - 2.0 * ratio / (ratio + 1.0)).abs() < 1e-14, "{ratio}: {v}");
        assert!((w.energy().total() / w.initial_energy().total() - 1.0).abs() < 1e-15);
    }
}

/// Row 13: a million radians a second about the intermediate axis.
#[test]
fn spin_of_a_million() {
    let mut w = world(BroadPhaseKind::SortedGrid, 480);
    let inertia = Some(Mat3::diagonal(Vec3::new(1.0, 2.0, 3.0)));
    let cube = Polyhedron::cuboid(Vec3::splat(1.0)).unwrap();
    let id = w.add_body(BodyDef { inertia, angular_velocity: Vec3::new(1.0, 1e6, 0.0), ..BodyDef::new(cube) }).unwrap();
    let start = w.body(id).unwrap();
    (0..4800).for_each(|_| w.step().unwrap());
    let end = w.body(id).unwrap();
    assert_eq!(end.angular_momentum, start.angular_momentum);
    assert!((end.rotational_energy() / start.rotational_energy() - 1.0).abs() < 1e-13);
}

/// Row 46: radii of a millimetre and of a kilometre in one scene, in every broad phase.
#[test]
fn sizes_a_million_apart() {
    let mut hashes = Vec::new();
    for phase in phases() {
        let mut w = world(phase, 1000);
        let ground = BodyDef { mass: Mass::Infinite, ..ball(1e3, Vec3::new(0.0, -1e3, 0.0), Vec3::ZERO) };
        w.add_body(ground).unwrap();
        for i in 0..400 {
            let position = Vec3::new(0.004 * f64::from(i % 20), 0.0035, 0.004 * f64::from(i / 20));
            w.add_body(ball(1e-3, position, Vec3::new(0.0, -0.25, 0.0))).unwrap();
        }
        (0..40).for_each(|_| w.step().unwrap());
        assert!(w.totals().impacts >= 400, "{phase}: {}", w.totals().impacts);
        hashes.push(w.state_hash());
    }
    assert!(hashes.iter().all(|h| *h == hashes[0]));
}

/// Row 47: far from the origin the relative state is good to the spacing of numbers there.
#[test]
fn scenes_far_from_the_origin() {
    let run = |origin: f64| {
        let mut w = world(BroadPhaseKind::SortedGrid, 64);
        let at = |x: f64| Vec3::new(origin + x, 0.0, 0.0);
        let a = w.add_body(ball(1.0, at(0.0), Vec3::X)).unwrap();
        let b = w.add_body(ball(1.0, at(3.0), -Vec3::X)).unwrap();
        (0..96).for_each(|_| w.step().unwrap());
        assert_eq!(w.totals().impacts, 1);
        w.body(b).unwrap().position.x - w.body(a).unwrap().position.x
    };
    let near = run(0.0);
    for origin in [1e7, 1e9] {
        assert!((run(origin) - near).abs() <= 96.0 * 2.0 * f64::EPSILON * origin, "{origin}: {} {near}", run(origin));
    }
}

/// Row 49: all in one place, all on a line; row 62: every pair in contact.
#[test]
fn crowds_in_one_cell_and_on_a_line() {
    for on_line in [false, true] {
        let mut hashes = Vec::new();
        for phase in phases() {
            let mut w = world(phase, 1000);
            for i in 0..200 {
                let x = if on_line { 1.9 * f64::from(i) } else { 1e-3 * f64::from(i % 7) };
                w.add_body(ball(1.0, Vec3::new(x, 0.0, 0.0), Vec3::ZERO)).unwrap();
            }
            w.step().unwrap();
            assert_eq!(w.counters().contacts, if on_line { 199 } else { 200 * 199 / 2 }, "{phase}");
            hashes.push(w.state_hash());
        }
        assert!(hashes.iter().all(|h| *h == hashes[0]));
    }
}

/// Rows 8 and 52: fixed bodies stay, whatever is done to them, in every broad phase.
#[test]
fn fixed_bodies_in_every_broad_phase() {
    let mut hashes = Vec::new();
    for phase in phases() {
        let mut w = world(phase, 500);
        w.add_box("box", Vec3::ZERO, Vec3::splat(4.0), Surface::default()).unwrap();
        let cube = Polyhedron::cuboid(Vec3::splat(1.0)).unwrap();
        let fixed = BodyDef { mass: Mass::Infinite, position: Vec3::splat(2.0), ..BodyDef::new(cube) };
        let id = w.add_body(fixed.clone()).unwrap();
        w.add_body(BodyDef { position: Vec3::new(2.5, 2.0, 2.0), ..fixed }).unwrap();
        let mut random = support::Random(3);
        for i in 0..40_u32 {
            let at = |k: u32| 0.3 + 0.5 * f64::from(k);
            let position = Vec3::new(at(i % 7), 0.3, at(i / 7));
            w.add_body(ball(0.15, position, random.direction())).unwrap();
        }
        w.set_momentum(id, Vec3::X).unwrap();
        w.set_velocity(id, Vec3::X).unwrap();
        w.set_angular_velocity(id, Vec3::X).unwrap();
        w.apply_impulse(id, Vec3::X, Vec3::ZERO).unwrap();
        let start = w.energy().total();
        (0..2000).for_each(|_| w.step().unwrap());
        assert!(w.totals().impacts > w.totals().wall_impacts);
        assert!((w.energy().total() / start - 1.0).abs() < 1e-12);
        assert_eq!(w.body(id).unwrap().position, Vec3::splat(2.0));
        hashes.push(w.state_hash());
    }
    assert!(hashes.iter().all(|h| *h == hashes[0]));
}

/// Row 50: a churn of bodies made and removed while the world runs under gravity keeps the books.
#[test]
fn bodies_come_and_go_while_the_world_runs() {
    let mut w = world(BroadPhaseKind::SortedGrid, 480);
    w.add_box("box", Vec3::ZERO, Vec3::splat(10.0), Surface::default()).unwrap();
    w.add_force(Arc::new(UniformField::new(Vec3::new(0.0, -9.81, 0.0)).unwrap()), Scope::default()).unwrap();
    let mut random = support::Random(5);
    let mut ids = Vec::new();
    let (mut kinetic, mut low, mut high) = (0.0_f64, 0.0_f64, 0.0_f64);
    for step in 0..2000 {
        let position = Vec3::splat(5.0) + random.vector() * 4.0;
        ids.push(w.add_body(ball(0.2, position, random.direction())).unwrap());
        if step % 3 != 0 {
            let at = random.next() as usize % ids.len();
            let id = ids.swap_remove(at);
            w.remove_body(id).unwrap();
            assert!(matches!(w.body(id), Err(Error::InvalidHandle { .. })));
        }
        if step % 50 == 0 {
            w.sort_storage();
        }
        w.step().unwrap();
        kinetic = kinetic.max(w.energy().kinetic());
        (low, high) = (low.min(w.energy().potential), high.max(w.energy().potential));
    }
    assert_eq!(w.body_count(), ids.len());
    assert!(support::residual(&w, kinetic, high - low) <= 1.0, "{}", support::residual(&w, kinetic, high - low));
}

/// Row 39: a million points on a sphere are more corners than a rigid body may have; said in seconds, not in hours.
#[test]
fn a_million_points_on_a_sphere() {
    let mut random = support::Random(39);
    let points: Vec<Vec3> = (0..1_000_000).map(|_| random.direction()).collect();
    let error = Polyhedron::convex_hull(&points).unwrap_err();
    assert!(matches!(error, mrtphys::Error::LimitExceeded { .. }), "{error:?}");
    let hull = Polyhedron::convex_hull(&points[..20_000]).unwrap();
    assert_eq!(hull.corners().len(), 20_000);
}
