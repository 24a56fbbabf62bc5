//! The face of the library under bad input: typed errors, and a world that is bitwise what it was (hard inputs 1, 2, 5-9,
//! 12, 43, 44, 47, 48, 50, 52, 54).

use mrtphys::shape::{HalfSpace, Polyhedron, Sphere};
use mrtphys::{BodyDef, BodyId, BoundaryDef, Error, Mass, Mat3, Quat, Settings, Surface, Vec3, World};
use std::sync::Arc;

fn ball(r: f64) -> BodyDef {
    BodyDef::new(Sphere::new(r).unwrap())
}

fn world() -> World {
    World::new(Settings::default()).unwrap()
}

const NAN: f64 = f64::NAN;
const INF: f64 = f64::INFINITY;

#[test]
fn not_finite_values_are_refused_and_change_nothing() {
    let mut w = world();
    let id = w.add_body(BodyDef { velocity: Vec3::X, ..ball(1.0) }).unwrap();
    let hash = w.state_hash();
    for bad in [Vec3::new(NAN, 0.0, 0.0), Vec3::new(0.0, INF, 0.0), Vec3::new(0.0, 0.0, -INF)] {
        for (field, result) in [
            ("position", w.add_body(BodyDef { position: bad, ..ball(1.0) }).map(drop)),
            ("velocity", w.add_body(BodyDef { velocity: bad, ..ball(1.0) }).map(drop)),
            ("angular_velocity", w.add_body(BodyDef { angular_velocity: bad, ..ball(1.0) }).map(drop)),
            ("position", w.set_position(id, bad)),
            ("velocity", w.set_velocity(id, bad)),
            ("angular_velocity", w.set_angular_velocity(id, bad)),
            ("momentum", w.set_momentum(id, bad)),
            ("angular_momentum", w.set_angular_momentum(id, bad)),
            ("impulse", w.apply_impulse(id, bad, Vec3::ZERO)),
        ] {
            assert!(matches!(&result, Err(Error::NonFinite { field: f, .. }) if *f == field), "{field}: {result:?}");
        }
    }
    let q = Quat::new(NAN, 0.0, 0.0, 1.0);
    assert!(matches!(w.set_orientation(id, q), Err(Error::NonFinite { field: "orientation", .. })));
    assert_eq!(w.state_hash(), hash);
    assert_eq!(w.body_count(), 1);
}

#[test]
fn an_error_names_the_body() {
    let error = world().add_body(BodyDef { name: "ball".into(), mass: Mass::Value(0.0), ..ball(1.0) }).unwrap_err();
    assert!(error.to_string().contains("body 'ball'") && error.to_string().contains("mass"), "{error}");
}

#[test]
fn masses_out_of_range_are_refused() {
    for mass in [0.0, -1.0, 5e-324, 1e200, INF, NAN] {
        assert!(world().add_body(BodyDef { mass: Mass::Value(mass), ..ball(1.0) }).is_err(), "{mass}");
        assert!(world().add_body(BodyDef { mass: Mass::Density(mass), ..ball(1.0) }).is_err(), "density {mass}");
    }
    world().add_body(BodyDef { mass: Mass::Value(1e38), ..ball(1.0) }).unwrap();
    let fixed = BodyDef { mass: Mass::Infinite, velocity: Vec3::X, angular_velocity: Vec3::Y, ..ball(1.0) };
    let mut w = world();
    let id = w.add_body(fixed).unwrap();
    let body = w.body(id).unwrap();
    assert_eq!((body.mass, body.velocity, body.angular_velocity), (INF, Vec3::ZERO, Vec3::ZERO));
}

#[test]
fn surfaces_out_of_range_are_refused() {
    for (friction, restitution) in [(-0.1, 1.0), (INF, 1.0), (NAN, 1.0), (0.0, -0.1), (0.0, 1.1), (0.0, NAN)] {
        let surface = Surface { friction, restitution, ..Surface::default() };
        assert!(world().add_body(BodyDef { surface, ..ball(1.0) }).is_err());
        let mut w = world();
        let id = w.add_body(ball(1.0)).unwrap();
        assert!(w.set_surface(id, surface).is_err());
    }
}

#[test]
fn an_inertia_that_no_body_has_is_refused() {
    for d in [(0.0, 1.0, 1.0), (-1.0, 1.0, 1.0), (1.0, 1.0, 3.0), (NAN, 1.0, 1.0)] {
        let inertia = Some(Mat3::diagonal(Vec3::new(d.0, d.1, d.2)));
        let error = world().add_body(BodyDef { inertia, ..ball(1.0) }).unwrap_err();
        assert!(matches!(error, Error::InvalidInertia { .. } | Error::NonFinite { .. }), "{error:?}");
    }
    let inertia = Some(Mat3::diagonal(Vec3::new(1.0, 2.0, 3.0)));
    let mut w = world();
    let id = w.add_body(BodyDef { inertia, angular_velocity: Vec3::new(0.0, 2.0, 0.0), ..ball(1.0) }).unwrap();
    assert_eq!(w.body(id).unwrap().rotational_energy(), 4.0);
}

#[test]
fn orientations_are_normalised_and_zero_is_refused() {
    let mut w = world();
    for q in [Quat::new(0.0, 0.0, 0.0, 1.001), Quat::new(1e-30, 0.0, 0.0, 0.0)] {
        let id = w.add_body(BodyDef { orientation: q, ..ball(1.0) }).unwrap();
        assert!((w.body(id).unwrap().orientation.dot(q.try_normalize().unwrap()) - 1.0).abs() < 1e-15);
    }
    let zero = Quat::new(0.0, 0.0, 0.0, 0.0);
    assert!(matches!(
        w.add_body(BodyDef { orientation: zero, ..ball(1.0) }),
        Err(Error::OutOfRange { field: "orientation", .. })
    ));
}

#[test]
fn steps_of_impossible_length_are_refused() {
    let mut w = world();
    w.add_body(BodyDef { velocity: Vec3::X, ..ball(1.0) }).unwrap();
    let hash = w.state_hash();
    w.step_by(0.0).unwrap();
    for dt in [-1.0, NAN, INF, 5e-324, 1e30] {
        assert!(w.step_by(dt).is_err(), "{dt}");
    }
    assert_eq!(w.state_hash(), hash);
    w.step_by(0.5).unwrap();
    assert_eq!(w.time(), 0.5);
    for (fps, steps_per_frame) in [(0, 8), (60, 0)] {
        assert!(World::new(Settings { fps, steps_per_frame, ..Settings::default() }).is_err());
    }
}

#[test]
fn handles_that_are_not_valid_are_refused() {
    let (mut w, mut other) = (world(), world());
    let id = w.add_body(ball(1.0)).unwrap();
    let foreign = other.add_body(ball(1.0)).unwrap();
    let invented = BodyId::from_parts(u32::MAX, u32::MAX, u32::MAX);
    w.remove_body(id).unwrap();
    for bad in [id, foreign, invented] {
        assert_eq!(w.remove_body(bad), Err(Error::InvalidHandle { what: "body" }));
        assert!(w.body(bad).is_err() && w.set_velocity(bad, Vec3::X).is_err());
    }
    let again = w.add_body(ball(1.0)).unwrap();
    assert!(w.body(id).is_err() && w.body(again).is_ok(), "a stale handle stays stale when its place is used again");
}

#[test]
fn planes_and_shapes_without_sense_are_refused() {
    assert!(HalfSpace::new(Vec3::ZERO).is_err() && HalfSpace::new(Vec3::new(NAN, 0.0, 1.0)).is_err());
    for r in [0.0, -1.0, 5e-324, NAN, INF] {
        assert!(Sphere::new(r).is_err());
    }
    let mut w = world();
    assert!(w.add_box("empty", Vec3::splat(1.0), Vec3::ZERO, Surface::default()).is_err());
    assert_eq!(w.boundaries().len(), 0);
    let floor = BoundaryDef {
        name: String::new(),
        shape: Arc::new(HalfSpace::new(Vec3::new(0.0, 3.0, 0.0)).unwrap()),
        position: Vec3::new(0.0, INF, 0.0),
        surface: Surface::default(),
    };
    assert!(w.add_boundary(floor).is_err());
}

#[test]
fn a_body_can_go_while_in_contact() {
    let mut w = world();
    w.add_box("box", Vec3::ZERO, Vec3::splat(10.0), Surface::default()).unwrap();
    let place = |x: f64| BodyDef { position: Vec3::new(x, 0.9, 5.0), velocity: Vec3::new(0.0, -1.0, 0.0), ..ball(1.0) };
    let ids: Vec<_> = [2.0, 3.9, 5.8].map(|x| w.add_body(place(x)).unwrap()).to_vec();
    w.step().unwrap();
    assert!(w.counters().contacts >= 4);
    w.remove_body(ids[1]).unwrap();
    w.step().unwrap();
    assert_eq!(w.bodies().collect::<Vec<_>>(), [ids[0], ids[2]]);
}

#[test]
fn many_bodies_come_and_go() {
    let mut w = world();
    let shape: Arc<dyn mrtphys::shape::Shape> = Arc::new(Sphere::new(0.1).unwrap());
    let ids: Vec<_> = (0..1_000_000)
        .map(|i| {
            w.add_body(BodyDef { position: Vec3::new(f64::from(i), 0.0, 0.0), ..BodyDef::new(shape.clone()) }).unwrap()
        })
        .collect();
    w.step().unwrap();
    ids.iter().rev().for_each(|&id| w.remove_body(id).unwrap());
    assert_eq!(w.body_count(), 0);
    w.step().unwrap();
    let again = w.add_body(ball(0.1)).unwrap();
    assert_eq!(w.bodies().collect::<Vec<_>>(), [again]);
}

#[test]
fn far_away_is_just_a_place() {
    for far in [1e7, 1e9, 1e15, 1e100] {
        let mut w = world();
        let a = w.add_body(BodyDef { position: Vec3::new(far, 0.0, 0.0), velocity: Vec3::X, ..ball(1.0) }).unwrap();
        w.add_body(ball(1.0)).unwrap();
        w.add_body(BodyDef { position: Vec3::new(1.5, 0.0, 0.0), velocity: -Vec3::X, ..ball(1.0) }).unwrap();
        (0..3).for_each(|_| w.step().unwrap());
        assert_eq!(w.totals().impacts, 1, "the pair near the origin meets");
        assert!(w.body(a).unwrap().position.x >= far);
    }
    let outside = BodyDef { position: Vec3::new(1e151, 0.0, 0.0), ..ball(1.0) };
    assert!(matches!(world().add_body(outside), Err(Error::OutOfRange { field: "position", .. })));
}

#[test]
fn energies_momenta_and_densities_can_be_read_and_set() {
    let mut w = world();
    let cube = Polyhedron::cuboid(Vec3::splat(2.0)).unwrap();
    let id = w.add_body(BodyDef { mass: Mass::Density(3.0), ..BodyDef::new(cube) }).unwrap();
    assert!((w.body(id).unwrap().mass - 24.0).abs() < 1e-12);
    assert!(w.set_linear_energy(id, 1.0).is_err(), "at rest there is no direction");
    w.set_velocity(id, Vec3::new(0.0, 2.0, 0.0)).unwrap();
    w.set_linear_energy(id, 12.0).unwrap();
    w.set_angular_velocity(id, Vec3::new(1.0, 1.0, 0.0)).unwrap();
    w.set_rotational_energy(id, 6.0).unwrap();
    let body = w.body(id).unwrap();
    assert!((body.linear_energy() - 12.0).abs() < 1e-12 && (body.rotational_energy() - 6.0).abs() < 1e-12);
    assert!((body.momentum().y - 24.0).abs() < 1e-12);
    // A cube of edge 2: m l^2 / 6 about every axis, equation (25).
    assert!((body.inertia_about(Vec3::new(1.0, 2.0, 3.0)) - 16.0).abs() < 1e-12);
    w.set_mass(id, Mass::Density(1.0)).unwrap();
    assert!((w.body(id).unwrap().density() - 1.0).abs() < 1e-15);
    assert_eq!(w.body(id).unwrap().velocity, body.velocity);
}

#[test]
fn sums_taken_at_once_are_those_taken_one_by_one() {
    let mut w = world();
    w.add_force(Arc::new(mrtphys::field::PointField::new(Vec3::Y, 3.0, 2).unwrap()), Default::default()).unwrap();
    let ids: Vec<BodyId> = (0..40)
        .map(|i| {
            let x = f64::from(i);
            let (position, velocity) = (Vec3::new(3.0 * x, 0.1 * x, 1.0 / (x + 0.3)), Vec3::new(x, -0.7 * x, 0.1));
            let fixed = if i % 9 == 8 { Mass::Infinite } else { Mass::Density(300.0 + x) };
            let def = BodyDef { position, velocity, angular_velocity: Vec3::splat(0.3 * x), mass: fixed, ..ball(0.4) };
            w.add_body(def).unwrap()
        })
        .collect();
    // Storage in another order than that of creation.
    [3, 17, 0].into_iter().for_each(|i: usize| w.remove_body(ids[i]).unwrap());
    w.sort_storage();
    for _ in 0..5 {
        w.step().unwrap();
        let sums = w.sums();
        let one_by_one = (w.energy(), w.momentum(), w.angular_momentum());
        // With every digit, and the sign of zero.
        assert_eq!(format!("{:?}", (sums.energy, sums.momentum, sums.angular_momentum)), format!("{one_by_one:?}"));
        assert!(sums.energy.potential != 0.0 && sums.momentum.x > 0.0 && sums.angular_momentum.length() > 0.0);
    }
}
