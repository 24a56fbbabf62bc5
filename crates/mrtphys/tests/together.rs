//! Parts at work together: books, memories and scopes while bodies come, go and are changed between steps.

mod support;

use mrtphys::field::{EarthGravity, ForceField, PointField, Scope};
use mrtphys::shape::{HalfSpace, LimitPlane, Polyhedron, Sphere};
use mrtphys::{BodyDef, BoundaryDef, ContactMode, FrictionLaw, ImpactMode, Mass, Quat, Settings, Surface, Vec3, World};
use std::sync::Arc;

fn ball(r: f64, position: Vec3, velocity: Vec3) -> BodyDef {
    BodyDef { position, velocity, ..BodyDef::new(Sphere::new(r).unwrap()) }
}

fn floor(world: &mut World) {
    let shape = Arc::new(HalfSpace::new(Vec3::Y).unwrap());
    let def = BoundaryDef { name: "floor".into(), shape, position: Vec3::ZERO, surface: Surface::default() };
    world.add_boundary(def).unwrap();
}

fn plane(world: &mut World, normal: Vec3) {
    let shape = Arc::new(LimitPlane::new(normal).unwrap());
    let def = BoundaryDef { name: "plane".into(), shape, position: Vec3::ZERO, surface: Surface::default() };
    world.add_boundary(def).unwrap();
}

fn point_field(strength: f64) -> Arc<dyn ForceField> {
    Arc::new(PointField::new(Vec3::ZERO, strength, 2).unwrap())
}

#[test]
fn scopes_follow_the_bodies_when_changes_are_booked() {
    for with_carrier in [false, true] {
        let mut world = World::new(Settings::default()).unwrap();
        let ids: Vec<_> = (0..5)
            .map(|i| world.add_body(ball(0.1, Vec3::new(f64::from(i) + 1.0, 0.0, 0.0), Vec3::ZERO)).unwrap())
            .collect();
        let carrier = with_carrier.then_some(ids[3]);
        let scope = Scope { carrier, only: Some(vec![ids[4], ids[1]]), ..Scope::default() };
        let field = world.add_force(point_field(5.0), scope).unwrap();
        world.step().unwrap();
        // The last slot's body moves into the gap.
        world.remove_body(ids[0]).unwrap();
        world.set_position(ids[4], Vec3::new(7.0, 3.0, 0.0)).unwrap();
        world.remove_body(ids[2]).unwrap();
        world.set_force(field, point_field(3.0)).unwrap();
        world.add_body(ball(0.1, Vec3::new(0.0, 9.0, 0.0), Vec3::X)).unwrap();
        world.set_velocity(ids[1], Vec3::Y).unwrap();
        world.sort_storage();
        world.set_position(ids[1], Vec3::new(2.0, 2.0, 0.0)).unwrap();
        world.set_settings(Settings { medium_density: 0.1, ..world.settings().clone() }).unwrap();
        world.set_mass(ids[4], Mass::Value(3.0)).unwrap();
        world.add_force(point_field(0.5), Scope::default()).unwrap();
        assert!(support::residual(&world, 1.0, 0.0) <= 1.0, "{}", support::residual(&world, 1.0, 0.0));
        if with_carrier {
            world.remove_body(ids[3]).unwrap();
            assert!(support::residual(&world, 1.0, 0.0) <= 1.0, "{}", support::residual(&world, 1.0, 0.0));
        }
        world.step().unwrap();
    }
}

#[test]
fn changes_of_many_single_bodies_are_all_booked() {
    let mut world = World::new(Settings::default()).unwrap();
    world.add_force(Arc::new(EarthGravity::default()), Scope::default()).unwrap();
    let n = 20_000;
    let place = |i: u32| ball(0.1, Vec3::new(f64::from(i), 0.0, 0.0), Vec3::ZERO);
    let mut ids: Vec<_> = (0..n).map(|i| world.add_body(place(i)).unwrap()).collect();
    world.step().unwrap();
    for (&id, i) in ids.iter().zip(0..) {
        world.set_velocity(id, Vec3::X).unwrap();
        world.set_position(id, Vec3::new(f64::from(i), 1.0, 0.0)).unwrap();
    }
    ids.extend((n..2 * n).map(|i| world.add_body(place(i)).unwrap()));
    ids.iter().for_each(|&id| world.remove_body(id).unwrap());
    assert!(support::residual(&world, f64::from(n), 0.0) <= 1.0);
}

#[test]
fn removing_a_body_forgets_its_contacts_and_no_others() {
    for contact in [ContactMode::Exact, ContactMode::Thesis] {
        let settings = Settings { contact, friction_law: FrictionLaw::Kurtenbach, ..Settings::default() };
        let mut world = World::new(settings).unwrap();
        floor(&mut world);
        let far = world.add_body(ball(1.0, Vec3::new(50.0, 9.0, 0.0), Vec3::ZERO)).unwrap();
        world.add_body(ball(1.0, Vec3::new(0.0, 0.9, 0.0), Vec3::new(0.0, 0.01, 0.0))).unwrap();
        let partner = world.add_body(ball(1.0, Vec3::new(1.9, 0.9, 0.0), Vec3::new(0.0, 0.01, 0.0))).unwrap();
        let count = |world: &World| world.contact_memory().len();
        world.step().unwrap();
        assert_eq!(count(&world), 3, "two on the floor, and each other");
        world.remove_body(far).unwrap();
        assert_eq!(count(&world), 3, "{contact:?}: the first body is not the first boundary");
        world.remove_body(partner).unwrap();
        assert_eq!(count(&world), 1);
    }
}

#[test]
fn a_law_without_memory_leaves_none_behind() {
    let with = |friction_law| Settings { friction_law, ..Settings::default() };
    let mut world = World::new(with(FrictionLaw::Kurtenbach)).unwrap();
    floor(&mut world);
    world.add_body(ball(1.0, Vec3::new(0.0, 0.9, 0.0), Vec3::new(0.0, 0.01, 0.0))).unwrap();
    world.step().unwrap();
    assert_eq!(world.contact_memory().len(), 1);
    world.set_settings(with(FrictionLaw::Coulomb)).unwrap();
    world.step().unwrap();
    assert_eq!(world.contact_memory().len(), 0, "what was a contact long ago is none when the law comes back");
}

#[test]
fn a_snapshot_of_other_contents_is_refused() {
    let build = |settings: Settings, normal: Vec3, field: f64, only: bool, combine: mrtphys::Combine, size: Vec3| {
        let mut world = World::new(settings).unwrap();
        plane(&mut world, normal);
        let surface = Surface { restitution_combine: combine, ..Surface::default() };
        let cube = Polyhedron::cuboid(size).unwrap();
        let def = BodyDef { surface, position: Vec3::new(3.0, 3.0, 3.0), ..BodyDef::new(cube) };
        let inertia = Some(mrtphys::Mat3::IDENTITY);
        let id = world.add_body(BodyDef { inertia, mass: Mass::Value(1.0), ..def }).unwrap();
        let scope = Scope { only: only.then(|| vec![id]), ..Scope::default() };
        world.add_force(point_field(field), scope).unwrap();
        world.step().unwrap();
        world
    };
    use mrtphys::Combine::{Average, Multiply};
    let (cube, thesis) = (Vec3::splat(1.0), Settings { contact: ContactMode::Thesis, ..Settings::default() });
    let usual = Settings::default();
    let mut world = build(usual.clone(), Vec3::Y, 1.0, true, Multiply, Vec3::new(1.0, 2.0, 4.0));
    let bytes = world.snapshot();
    world.restore(&bytes).unwrap();
    let other_order = Vec3::new(2.0, 1.0, 4.0);
    for (what, mut other) in [
        ("contact mode", build(thesis, Vec3::Y, 1.0, true, Multiply, Vec3::new(1.0, 2.0, 4.0))),
        ("plane", build(usual.clone(), Vec3::X, 1.0, true, Multiply, Vec3::new(1.0, 2.0, 4.0))),
        ("field", build(usual.clone(), Vec3::Y, 2.0, true, Multiply, Vec3::new(1.0, 2.0, 4.0))),
        ("scope", build(usual.clone(), Vec3::Y, 1.0, false, Multiply, Vec3::new(1.0, 2.0, 4.0))),
        ("combination", build(usual.clone(), Vec3::Y, 1.0, true, Average, Vec3::new(1.0, 2.0, 4.0))),
        ("shape", build(usual.clone(), Vec3::Y, 1.0, true, Multiply, other_order)),
        ("size", build(usual, Vec3::Y, 1.0, true, Multiply, cube)),
    ] {
        let hash = other.state_hash();
        assert!(other.restore(&bytes).is_err(), "another {what}");
        assert_eq!(other.state_hash(), hash);
    }
}

#[test]
fn a_snapshot_goes_on_under_other_settings() {
    let with = |broad, friction_law, impact| Settings {
        broad_phase: broad,
        friction_law,
        impact,
        ..support::gas(support::Kind::Boxes, 1, Settings::default(), 1.0).settings().clone()
    };
    use mrtphys::BroadPhaseKind::{BruteForce, SortedGrid};
    let mut first =
        support::gas(support::Kind::Boxes, 4, with(SortedGrid, FrictionLaw::Kurtenbach, ImpactMode::Sequential), 1.0);
    (0..200).for_each(|_| first.step().unwrap());
    let bytes = first.snapshot();
    let settings = with(BruteForce, FrictionLaw::Coulomb, ImpactMode::Reflection);
    let mut second = support::gas(support::Kind::Boxes, 4, settings.clone(), 1.0);
    second.restore(&bytes).unwrap();
    assert_eq!(second.state_hash(), first.state_hash());
    assert_eq!(second.ledger(), first.ledger());
    first.set_settings(settings).unwrap();
    for _ in 0..100 {
        first.step().unwrap();
        second.step().unwrap();
    }
    assert_eq!(second.state_hash(), first.state_hash());
}

#[test]
fn a_turned_body_keeps_its_spin_in_its_own_axes() {
    let mut world = World::new(Settings::default()).unwrap();
    let cuboid = Polyhedron::cuboid(Vec3::new(1.0, 2.0, 4.0)).unwrap();
    let def = BodyDef { angular_velocity: Vec3::new(0.0, 3.0, 0.0), ..BodyDef::new(cuboid) };
    let id = world.add_body(def).unwrap();
    let energy = world.energy().total();
    // A quarter turn about z: what was along y is along -x.
    world.set_orientation(id, Quat::from_axis_angle(Vec3::Z, std::f64::consts::FRAC_PI_2)).unwrap();
    let body = world.body(id).unwrap();
    assert!((body.angular_velocity - Vec3::new(-3.0, 0.0, 0.0)).length() < 1e-14, "{:?}", body.angular_velocity);
    assert!((world.energy().total() / energy - 1.0).abs() < 1e-14);
}

#[derive(Debug)]
struct Broken;
impl ForceField for Broken {
    fn acceleration(&self, _: Vec3, _: f64) -> Vec3 {
        Vec3::splat(f64::NAN)
    }
    fn potential(&self, _: Vec3) -> Option<f64> {
        None
    }
}

#[test]
fn a_failing_step_leaves_no_memory_of_planes() {
    let mut world = World::new(Settings::default()).unwrap();
    plane(&mut world, Vec3::Y);
    world.add_body(ball(1.0, Vec3::new(0.0, 3.0, 0.0), Vec3::X)).unwrap();
    world.add_force(Arc::new(Broken), Scope::default()).unwrap();
    let (hash, snapshot) = (world.state_hash(), world.snapshot().len());
    assert!(world.step().is_err());
    assert_eq!(world.state_hash(), hash);
    assert_eq!(world.snapshot().len(), snapshot);
}

#[test]
fn asking_for_overlaps_changes_no_count() {
    let mut world = World::new(Settings::default()).unwrap();
    world.add_body(ball(1.0, Vec3::ZERO, Vec3::X)).unwrap();
    world.add_body(ball(1.0, Vec3::new(1.9, 0.0, 0.0), Vec3::ZERO)).unwrap();
    world.step().unwrap();
    let before = *world.counters();
    assert_eq!(world.overlaps().len(), 1);
    assert_eq!(*world.counters(), before);
}

#[test]
fn spins_and_masses_that_overflow_are_refused() {
    let mut world = World::new(Settings::default()).unwrap();
    let huge = BodyDef { mass: Mass::Value(1e100), ..ball(1e50, Vec3::ZERO, Vec3::ZERO) };
    let fast = Vec3::new(0.0, 1e140, 0.0);
    assert!(world.add_body(BodyDef { angular_velocity: fast, ..huge.clone() }).is_err());
    let id = world.add_body(huge).unwrap();
    let hash = world.state_hash();
    assert!(world.set_angular_velocity(id, fast).is_err());
    assert_eq!(world.state_hash(), hash);
    let inertia = Some(mrtphys::Mat3::diagonal(Vec3::splat(1e-300)));
    let id = world.add_body(BodyDef { inertia, angular_velocity: Vec3::Y, ..ball(1.0, Vec3::X, Vec3::ZERO) }).unwrap();
    assert!(world.set_mass(id, Mass::Value(1e-100)).is_err(), "its inertia has no reciprocal");
    let body = world.body(id).unwrap();
    assert!(body.mass == 1.0 && body.angular_velocity.is_finite());
}

/// Spheres and boxes falling into a box: they come to a halt, lie hardly in one another, and every joule is booked.
fn pile(impact: ImpactMode, friction_law: FrictionLaw, restitution: f64, friction: f64) {
    let (bodies, seconds) = if impact == ImpactMode::Sequential { (106_u32, 10) } else { (40, 4) };
    let settings = Settings { fps: 60, steps_per_frame: 4, impact, friction_law, ..Settings::default() };
    let mut world = World::new(settings).unwrap();
    let surface = Surface { restitution, friction, ..Surface::default() };
    world.add_box("box", Vec3::ZERO, Vec3::new(1.0, 10.0, 1.0), surface).unwrap();
    world.add_force(Arc::new(EarthGravity::default()), Scope::default()).unwrap();
    let mut random = support::Random(7);
    let r = 0.1;
    let cube: Arc<dyn mrtphys::shape::Shape> = Arc::new(Polyhedron::cuboid(Vec3::new(0.15, 0.1, 0.12)).unwrap());
    let sphere: Arc<dyn mrtphys::shape::Shape> = Arc::new(Sphere::new(r).unwrap());
    for i in 0..bodies {
        let shape = if i % 17 == 9 { cube.clone() } else { sphere.clone() };
        let at = |k: u32| 0.15 + 0.23 * f64::from(k % 4);
        let position = Vec3::new(at(i), 0.15 + 0.23 * f64::from(i / 16), at(i / 4)) + random.vector() * 0.01;
        world.add_body(BodyDef { position, surface, mass: Mass::Value(1.0), ..BodyDef::new(shape) }).unwrap();
    }
    let (mut largest, mut corrected, mut gained, mut last, mut low, mut high) =
        (0.0_f64, 0.0, 0.0_f64, world.energy().total(), f64::INFINITY, f64::NEG_INFINITY);
    let mut deepest_late = 0.0_f64;
    for frame in 0..seconds * 60 {
        world.frame().unwrap();
        let energy = world.energy();
        largest = largest.max(energy.kinetic());
        low = low.min(energy.potential);
        high = high.max(energy.potential);
        let correction = world.ledger().position_correction;
        gained = gained.max(energy.total() - last - (correction - corrected));
        (last, corrected) = (energy.total(), correction);
        if frame >= (seconds - 2) * 60 {
            let deepest = world.contacts().list.iter().map(|c| c.depth).fold(0.0, f64::max);
            deepest_late = deepest_late.max(deepest);
        }
    }
    let kinetic = world.energy().kinetic();
    let outside = world.bodies().filter(|&b| world.body(b).unwrap().position.y < 0.0).count();
    assert!(gained <= 1e-9 * largest, "nothing but corrections gives energy: {gained}");
    assert!(support::residual(&world, largest, high - low) <= 1.0);
    let speed = (2.0 * kinetic / f64::from(bodies)).sqrt();
    assert!(speed < 3.0 * 9.80665 * world.time_step(), "no faster than free fall makes a body in three steps: {speed}");
    assert!(deepest_late < 0.06 * r, "{deepest_late}");
    assert_eq!(outside, 0);
}

#[test]
fn an_inelastic_pile_comes_to_rest_sequentially() {
    pile(ImpactMode::Sequential, FrictionLaw::Coulomb, 0.5, 0.3);
}

#[test]
fn an_inelastic_pile_without_friction_comes_to_rest() {
    pile(ImpactMode::Sequential, FrictionLaw::Frictionless, 0.5, 0.0);
}

#[test]
fn an_inelastic_pile_under_the_thesis_law_comes_to_rest() {
    pile(ImpactMode::Sequential, FrictionLaw::Kurtenbach, 0.5, 0.3);
}

#[test]
fn an_inelastic_pile_comes_to_rest_by_reflections() {
    pile(ImpactMode::Reflection, FrictionLaw::Coulomb, 0.5, 0.3);
}
