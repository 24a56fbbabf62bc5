//! Closed forms (validation) and faults inside a step, on whole worlds.

mod support;

use mrtphys::field::{EarthGravity, ForceField, Scope, UniformField};
use mrtphys::shape::{HalfSpace, Polyhedron, Shape, Sphere};
use mrtphys::{
    BodyDef, BodyId, BoundaryDef, Error, FrictionLaw, ImpactMode, Mass, Quat, Settings, Surface, Vec3, World,
};
use std::sync::Arc;

fn settings(fps: u32) -> Settings {
    Settings { fps, steps_per_frame: 1, ..Settings::default() }
}

fn ball(r: f64, position: Vec3, velocity: Vec3) -> BodyDef {
    BodyDef { position, velocity, ..BodyDef::new(Sphere::new(r).unwrap()) }
}

fn add_plane(world: &mut World, normal: Vec3, surface: Surface) {
    let shape = Arc::new(HalfSpace::new(normal).unwrap());
    world.add_boundary(BoundaryDef { name: "floor".into(), shape, position: Vec3::ZERO, surface }).unwrap();
}

fn add_gravity(world: &mut World, g: Vec3) {
    world.add_force(Arc::new(UniformField::new(g).unwrap()), Scope::default()).unwrap();
}

fn run(world: &mut World, seconds: f64) {
    let steps = (seconds / world.time_step()).round() as usize;
    (0..steps).for_each(|_| world.step().unwrap());
}

fn velocities(world: &World) -> Vec<Vec3> {
    world.bodies().map(|b| world.body(b).unwrap().velocity).collect()
}

#[test]
fn an_elastic_ball_reaches_the_same_height_for_ever() {
    let mut world = World::new(settings(256)).unwrap();
    add_plane(&mut world, Vec3::Y, Surface::default());
    add_gravity(&mut world, Vec3::new(0.0, -9.81, 0.0));
    world.add_body(ball(0.1, Vec3::new(0.0, 1.1, 0.0), Vec3::ZERO)).unwrap();
    let start = world.energy().total();
    run(&mut world, 600.0);
    assert!(world.totals().impacts > 600);
    assert!((world.energy().total() / start - 1.0).abs() < 1e-12);
}

#[test]
fn an_inelastic_ball_comes_to_rest_on_the_floor() {
    // Total time sqrt(2h/g) (1+e)/(1-e) and path h (1+e^2)/(1-e^2) for h = 1, g = 9.81, e = 0.8.
    let mut worst = Vec::new();
    for fps in [512, 4096] {
        let mut world = World::new(settings(fps)).unwrap();
        add_plane(&mut world, Vec3::Y, Surface::default());
        add_gravity(&mut world, Vec3::new(0.0, -9.81, 0.0));
        let surface = Surface { restitution: 0.8, ..Surface::default() };
        let id = world.add_body(BodyDef { surface, ..ball(0.1, Vec3::new(0.0, 1.1, 0.0), Vec3::ZERO) }).unwrap();
        let (mut path, mut last, mut rest) = (0.0, 1.1, 0.0);
        for _ in 0..6 * fps {
            world.step().unwrap();
            let y = world.body(id).unwrap().position.y;
            path += (y - last).abs();
            last = y;
            if world.body(id).unwrap().velocity.y.abs() > 9.81 * world.time_step() * 1.001 {
                rest = world.time();
            }
        }
        worst.push(((rest - 4.063712769) / 4.06_f64).abs().max(((path - 4.5555556) / 4.56).abs()));
        let body = world.body(id).unwrap();
        assert_eq!(body.velocity, Vec3::ZERO, "it lies still");
        assert!((body.position.y - 0.1).abs() < 1e-12, "on the floor, not in it: {}", body.position.y);
        assert!(support::residual(&world, 9.81, 9.81) <= 1.0);
    }
    assert!(worst[0] < 0.05 && worst[1] < 0.01 && worst[1] < worst[0], "{worst:?}");
}

#[test]
fn a_cradle_passes_on_as_many_as_came() {
    for (incoming, impact) in [
        (1, ImpactMode::Sequential),
        (1, ImpactMode::Reflection),
        (2, ImpactMode::Reflection),
        (3, ImpactMode::Reflection),
    ] {
        let mut world = World::new(Settings { impact, ..settings(512) }).unwrap();
        for i in 0..5 {
            let moving = i < incoming;
            let x = if moving { i as f64 - 0.25 } else { f64::from(i) };
            let v = if moving { Vec3::X } else { Vec3::ZERO };
            world.add_body(ball(0.5, Vec3::new(x, 0.0, 0.0), v)).unwrap();
        }
        run(&mut world, 0.5);
        let v = velocities(&world);
        for (i, v) in v.iter().enumerate() {
            let wanted = if i >= 5 - incoming as usize { 1.0 } else { 0.0 };
            assert!((v.x - wanted).abs() < 1e-12 && v.y == 0.0, "{impact} {incoming}: {i} {v:?}");
        }
    }
}

#[test]
fn a_symmetric_break_stays_symmetric() {
    let mut world = World::new(Settings { impact: ImpactMode::Reflection, ..settings(512) }).unwrap();
    let h = 3.0_f64.sqrt() / 2.0;
    world.add_body(ball(0.5, Vec3::new(-0.2, 0.0, 0.0), Vec3::X)).unwrap();
    world.add_body(ball(0.5, Vec3::new(h, 0.5, 0.0), Vec3::ZERO)).unwrap();
    world.add_body(ball(0.5, Vec3::new(h, -0.5, 0.0), Vec3::ZERO)).unwrap();
    run(&mut world, 0.5);
    let v = velocities(&world);
    // The overlap of half a step at the moment of detection turns the normals by less than a step's distance.
    assert!((v[0].x + 0.2).abs() < 0.01 && v[0].y.abs() < 1e-13, "{v:?}");
    assert!((v[1].y - 3.0_f64.sqrt() / 5.0).abs() < 0.01, "{v:?}");
    assert!((v[1].x - v[2].x).abs() < 1e-14 && (v[1].y + v[2].y).abs() < 1e-14, "{v:?}");
}

#[test]
fn a_superball_leaves_as_garwin_says() {
    let mut world = World::new(Settings { friction_law: FrictionLaw::Rough, ..settings(512) }).unwrap();
    let sandpaper = Surface { friction: 1.0, ..Surface::default() };
    add_plane(&mut world, Vec3::Y, sandpaper);
    let def = ball(0.5, Vec3::new(0.0, 0.6, 0.0), Vec3::new(7.0, -7.0, 0.0));
    let id = world.add_body(BodyDef { surface: sandpaper, ..def }).unwrap();
    run(&mut world, 0.125);
    let body = world.body(id).unwrap();
    assert!((body.velocity - Vec3::new(3.0, 7.0, 0.0)).length() < 1e-13, "{:?}", body.velocity);
    // R w = 10/7 v_x in size, forward rolling sense: about -z for motion along x.
    assert!((body.angular_velocity.z * 0.5 + 10.0).abs() < 1e-12, "{:?}", body.angular_velocity);
}

#[test]
fn sliding_becomes_rolling_at_five_sevenths() {
    let (g, mu, v0) = (9.81, 0.3, 2.0);
    let mut world = World::new(Settings { friction_law: FrictionLaw::Coulomb, ..settings(4096) }).unwrap();
    let surface =
        Surface { friction: mu, restitution: 0.0, friction_combine: mrtphys::Combine::Maximum, ..Surface::default() };
    add_plane(&mut world, Vec3::Y, Surface::default());
    add_gravity(&mut world, Vec3::new(0.0, -g, 0.0));
    let def = ball(0.1, Vec3::new(0.0, 0.1, 0.0), Vec3::new(v0, 0.0, 0.0));
    let id = world.add_body(BodyDef { surface, ..def }).unwrap();
    let slip = |world: &World| {
        let b = world.body(id).unwrap();
        b.velocity.x + b.angular_velocity.z * 0.1
    };
    while slip(&world) > 1e-9 && world.time() < 2.0 {
        world.step().unwrap();
    }
    let time = 2.0 * v0 / (7.0 * mu * g);
    assert!((world.time() - time).abs() < 2.0 / 4096.0, "{} for {time}", world.time());
    let body = world.body(id).unwrap();
    assert!((body.velocity.x - 5.0 / 7.0 * v0).abs() < 1e-3, "{:?}", body.velocity);
    run(&mut world, 1.0);
    assert!((world.body(id).unwrap().velocity.x - body.velocity.x).abs() < 1e-9, "rolling goes on");
    assert!(support::residual(&world, 2.0, 1.0) <= 1.0);
}

/// A body on an incline, gravity turned instead of the plane; velocity down the slope after a second.
fn on_incline(shape: Arc<dyn Shape>, height: f64, tangent: f64, mu: f64) -> f64 {
    let g = 9.81;
    let cos = 1.0 / (1.0 + tangent * tangent).sqrt();
    let mut world = World::new(Settings { friction_law: FrictionLaw::Coulomb, ..settings(2048) }).unwrap();
    add_plane(&mut world, Vec3::Y, Surface { friction: mu, restitution: 0.0, ..Surface::default() });
    add_gravity(&mut world, Vec3::new(g * cos * tangent, -g * cos, 0.0));
    let surface = Surface { friction: 1.0, restitution: 0.0, ..Surface::default() };
    let position = Vec3::new(0.0, height, 0.0);
    let id = world.add_body(BodyDef { position, surface, ..BodyDef::new(shape) }).unwrap();
    run(&mut world, 1.0);
    world.body(id).unwrap().velocity.x
}

#[test]
fn a_sphere_rolls_down_an_incline_at_five_sevenths_of_g_sine() {
    let sphere: Arc<dyn Shape> = Arc::new(Sphere::new(0.1).unwrap());
    let (g, tangent) = (9.81, 0.3_f64);
    let sine = tangent / (1.0 + tangent * tangent).sqrt();
    let v = on_incline(sphere, 0.1, tangent, 0.3);
    assert!((v - 5.0 / 7.0 * g * sine).abs() < 2e-3, "{v}");
}

#[test]
fn a_block_slips_only_above_the_angle_of_friction() {
    let block: Arc<dyn Shape> = Arc::new(Polyhedron::cuboid(Vec3::new(0.4, 0.1, 0.4)).unwrap());
    let (g, mu) = (9.81, 0.5);
    let held = on_incline(block.clone(), 0.05, 0.45, mu);
    assert!(held.abs() < 1e-3, "below the angle it stays: {held}");
    let tangent: f64 = 0.6;
    let cos = 1.0 / (1.0 + tangent * tangent).sqrt();
    let slid = on_incline(block, 0.05, tangent, mu);
    assert!((slid - g * cos * (tangent - mu)).abs() < 0.02, "{slid}");
}

#[test]
fn a_flat_landing_gives_no_spin() {
    for impact in [ImpactMode::Sequential, ImpactMode::Reflection] {
        for (shape, height) in
            [(Polyhedron::cuboid(Vec3::new(1.0, 0.7, 0.4)).unwrap(), 0.35), (support::u_shape(0.5), 0.3)]
        {
            let mut world = World::new(Settings { impact, ..settings(512) }).unwrap();
            add_plane(&mut world, Vec3::Y, Surface::default());
            add_gravity(&mut world, Vec3::new(0.0, -9.81, 0.0));
            let position = Vec3::new(0.0, height + 0.5, 0.0);
            let id = world.add_body(BodyDef { position, ..BodyDef::new(shape) }).unwrap();
            let start = world.energy().total();
            run(&mut world, 2.0);
            let body = world.body(id).unwrap();
            assert!(world.totals().impacts > 0);
            assert!(body.angular_velocity.length() < 1e-12, "{impact}: {:?}", body.angular_velocity);
            assert!((world.energy().total() / start - 1.0).abs() < 1e-13);
        }
    }
}

#[test]
fn a_ball_wedged_between_two_fixed_walls_keeps_its_energy() {
    for impact in [ImpactMode::Sequential, ImpactMode::Reflection] {
        let mut world = World::new(Settings { impact, ..settings(512) }).unwrap();
        world.add_box("slit", Vec3::new(-1.0, -9.0, -9.0), Vec3::new(1.0, 9.0, 9.0), Surface::default()).unwrap();
        let id = world.add_body(ball(1.0, Vec3::ZERO, Vec3::new(1.0, 0.5, 0.0))).unwrap();
        run(&mut world, 1.0);
        let body = world.body(id).unwrap();
        assert!((world.energy().total() - world.initial_energy().total()).abs() < 1e-14, "{impact}");
        assert_eq!(body.velocity.y, 0.5);
        assert!(body.position.x.abs() < 0.01, "it stays between the walls: {:?}", body.position);
    }
}

#[test]
fn a_body_whose_motion_overflows_is_set_aside_and_the_others_go_on_as_if_it_had_been_removed() {
    let make = |with: bool| {
        let gas = support::gas(support::Kind::Tetrahedra, 3, settings(512), 1.0);
        let mut world = World::new(settings(512)).unwrap();
        for id in gas.bodies() {
            let b = gas.body(id).unwrap();
            let towards = (Vec3::splat(0.5) - b.position) * 1.5;
            world.add_body(BodyDef { position: b.position, velocity: towards, ..BodyDef::new(b.shape) }).unwrap();
        }
        let fast = BodyDef {
            position: Vec3::new(-5.0, 0.0, 0.0),
            velocity: Vec3::new(-9e149, 0.0, 0.0),
            ..BodyDef::new(Sphere::new(0.1).unwrap())
        };
        let id = world.add_body(fast).unwrap();
        for _ in 0..600 {
            world.step().unwrap();
            if !with && world.bodies().count() == 28 && world.steps() == 568 {
                world.remove_body(id).unwrap();
            }
        }
        (world, id)
    };
    let (with, id) = make(true);
    let body = with.body(id).unwrap();
    assert!(body.set_aside && body.velocity == Vec3::ZERO && body.position.x.is_finite());
    assert_eq!(with.totals().quarantined, 1);
    assert!(with.totals().impacts > 10);
    assert!(with.energy().total().is_finite());
    let (without, _) = make(false);
    for (a, b) in with.bodies().zip(without.bodies()) {
        let (a, b) = (with.body(a).unwrap(), without.body(b).unwrap());
        assert_eq!((a.position, a.velocity, a.orientation), (b.position, b.velocity, b.orientation));
    }
}

/// A field that fails at a time.
#[derive(Debug)]
struct Failing;

impl ForceField for Failing {
    fn acceleration(&self, at: Vec3, _mass: f64) -> Vec3 {
        if at.x > 1.0 { Vec3::new(f64::NAN, 0.0, 0.0) } else { Vec3::ZERO }
    }
    fn potential(&self, _at: Vec3) -> Option<f64> {
        Some(0.0)
    }
}

#[test]
fn a_failing_callback_undoes_the_step() {
    let mut world = World::new(settings(64)).unwrap();
    world.add_force(Arc::new(Failing), Scope::default()).unwrap();
    world.add_body(ball(0.1, Vec3::ZERO, Vec3::X)).unwrap();
    world.add_body(ball(0.1, Vec3::new(0.0, 2.0, 0.0), Vec3::ZERO)).unwrap();
    let mut hash = world.state_hash();
    let error = loop {
        match world.step() {
            Ok(()) => hash = world.state_hash(),
            Err(e) => break e,
        }
        assert!(world.time() < 2.0, "the field must have failed");
    };
    assert!(matches!(error, Error::Callback { .. }), "{error:?}");
    assert_eq!(world.state_hash(), hash);
    assert_eq!(world.step().unwrap_err(), error);
}

#[test]
fn grazing_spheres_decide_the_same_way_and_do_not_ring() {
    for ulps in [-1_i64, 0, 1] {
        let y = f64::from_bits((1.0_f64.to_bits() as i64 + ulps) as u64);
        let mut world = World::new(settings(512)).unwrap();
        world.add_body(ball(0.5, Vec3::new(-0.5, 0.0, 0.0), Vec3::X)).unwrap();
        world.add_body(ball(0.5, Vec3::new(0.0, y, 0.0), Vec3::ZERO)).unwrap();
        let start = world.energy().total();
        run(&mut world, 2.0);
        assert!(world.totals().impacts <= 1, "{ulps} ulp: {:?}", world.totals());
        assert!((world.energy().total() / start - 1.0).abs() < 1e-15);
    }
}

#[test]
fn overlapping_bodies_are_reported_and_can_be_run() {
    let mut world = World::new(settings(64)).unwrap();
    let id = world.add_body(ball(1.0, Vec3::ZERO, Vec3::ZERO)).unwrap();
    world.add_body(ball(1.0, Vec3::new(2.0, 0.0, 0.0), Vec3::ZERO)).unwrap();
    assert!(world.overlaps().is_empty(), "touching is no overlap");
    world.add_body(ball(1.0, Vec3::ZERO, Vec3::ZERO)).unwrap();
    let found = world.overlaps();
    assert_eq!((found.len(), found[0].a, found[0].depth), (1, id, 2.0), "identical poses overlap by a diameter");
    run(&mut world, 1.0);
    assert!(world.energy().total() == 0.0, "nothing moves by itself");
}

#[test]
fn gravity_can_be_changed_and_the_ledger_knows() {
    let mut world = World::new(settings(64)).unwrap();
    let field = world.add_force(Arc::new(EarthGravity::default()), Scope::default()).unwrap();
    let id = world.add_body(ball(0.1, Vec3::new(0.0, 50.0, 0.0), Vec3::ZERO)).unwrap();
    run(&mut world, 0.5);
    world.set_force(field, Arc::new(EarthGravity::new(1.62).unwrap())).unwrap();
    run(&mut world, 0.5);
    world.set_velocity(id, Vec3::X).unwrap();
    world.set_position(id, Vec3::new(0.0, 10.0, 0.0)).unwrap();
    world.set_mass(id, Mass::Value(3.0)).unwrap();
    world.set_orientation(id, Quat::new(1.0, 0.0, 0.0, 0.0)).unwrap();
    let _: BodyId = world.add_body(ball(0.1, Vec3::new(0.0, 5.0, 0.0), Vec3::Y)).unwrap();
    run(&mut world, 0.5);
    world.remove_body(id).unwrap();
    run(&mut world, 0.5);
    assert!(world.ledger().user != 0.0 && world.ledger().created_removed != 0.0);
    assert!(support::residual(&world, 500.0, 500.0) <= 1.0, "{:?} {:?}", world.ledger(), world.energy());
}
