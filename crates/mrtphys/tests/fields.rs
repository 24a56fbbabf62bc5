//! Force fields and flow fields one by one, and what carries them.

mod bodies;

use bodies::Bodies;
use mrtphys::field::sum::{acceleration_of, potential_energy};
use mrtphys::field::{
    EarthGravity, FlowField, ForceField, PointField, SinkFlow, UniformField, UniformFlow, VortexField, VortexFlow,
};
use mrtphys::math::{Real, Vec3};
use mrtphys::{Error, Integrator, Settings};
use std::f64::consts::PI;

const PLACES: [Vec3; 4] =
    [Vec3::new(0.3, -1.2, 0.8), Vec3::new(4.0, 2.0, -1.0), Vec3::new(-0.2, 0.1, 0.05), Vec3::new(-7.0, 0.4, 3.0)];

/// a = -grad potential, by central differences with a step where their error is about 1e-9.
#[test]
fn acceleration_is_the_gradient_of_the_potential() {
    let mut fields: Vec<Box<dyn ForceField>> =
        vec![Box::new(EarthGravity::default()), Box::new(UniformField::new(Vec3::new(1.0, -2.0, 0.5)).unwrap())];
    for p in -4..6 {
        for strength in [2.0, -0.7] {
            fields.push(Box::new(PointField::new(Vec3::new(1.0, 0.5, -0.25), strength, p).unwrap()));
        }
    }
    for field in &fields {
        for at in PLACES {
            let h = 1e-5;
            let slope =
                |d: Vec3| (field.potential(at - d * h).unwrap() - field.potential(at + d * h).unwrap()) / (2.0 * h);
            let gradient = Vec3::new(slope(Vec3::X), slope(Vec3::Y), slope(Vec3::Z));
            let a = field.acceleration(at, 3.0);
            assert!((a - gradient).length() < 1e-8 * (1.0 + a.length()), "{field:?} at {at:?}: {a:?}, {gradient:?}");
        }
    }
}

#[test]
fn earth_gravity_is_that_of_the_thesis() {
    let mut g = EarthGravity::default();
    assert_eq!(g.g(), 9.80665);
    assert_eq!(g.acceleration(Vec3::splat(5.0), 7.0), Vec3::new(0.0, -9.80665, 0.0));
    g.set_g(1.62).unwrap();
    assert_eq!(g.g(), 1.62);
    assert!(g.set_g(Real::NAN).is_err());
    assert_eq!(g.g(), 1.62);
}

#[test]
fn point_field_falls_off_with_its_power() {
    for (p, expected) in [(-2, 12.0), (-1, 6.0), (0, 3.0), (1, 1.5), (2, 0.75), (3, 0.375)] {
        let field = PointField::new(Vec3::ZERO, 3.0, p).unwrap();
        assert_eq!(field.acceleration(Vec3::new(2.0, 0.0, 0.0), 1.0), Vec3::new(-expected, 0.0, 0.0));
        assert_eq!(field.acceleration(Vec3::ZERO, 1.0), Vec3::ZERO);
        for at in [1e-200, 1e-150, 1e-100, 1e150] {
            assert!(field.acceleration(Vec3::new(at, 0.0, 0.0), 1.0).is_finite());
            assert!(field.potential(Vec3::new(at, 0.0, 0.0)).unwrap().is_finite());
        }
    }
}

#[test]
fn vortices_turn_counter_clockwise() {
    let force = VortexField::new(Vec3::new(1.0, 0.0, 0.0), Vec3::new(0.0, 0.0, 9.0), 6.0).unwrap();
    assert!((force.acceleration(Vec3::new(3.0, 0.0, 5.0), 1.0) - Vec3::new(0.0, 3.0, 0.0)).length() < 1e-15);
    assert_eq!(force.acceleration(Vec3::new(1.0, 0.0, 5.0), 1.0), Vec3::ZERO);
    assert_eq!(force.potential(Vec3::X), None);
    let flow = VortexFlow::new(Vec3::ZERO, Vec3::Y, 2.0 * PI).unwrap();
    assert!((flow.velocity(Vec3::new(0.0, 3.0, 2.0)) - Vec3::new(0.5, 0.0, 0.0)).length() < 1e-15);
    assert_eq!(flow.velocity(Vec3::Y), Vec3::ZERO);
    let sink = SinkFlow::new(Vec3::ZERO, 4.0 * PI).unwrap();
    assert!((sink.velocity(Vec3::new(0.0, 2.0, 0.0)) - Vec3::new(0.0, -0.25, 0.0)).length() < 1e-15);
    assert_eq!(sink.velocity(Vec3::ZERO), Vec3::ZERO);
}

#[test]
fn bad_values_are_refused() {
    let nan = Vec3::new(0.0, Real::NAN, 0.0);
    let infinite = Vec3::new(Real::INFINITY, 0.0, 0.0);
    for bad in [nan, infinite] {
        assert!(matches!(UniformField::new(bad), Err(Error::NonFinite { field: "acceleration", .. })));
        assert!(matches!(UniformFlow::new(bad), Err(Error::NonFinite { field: "velocity", .. })));
        assert!(matches!(PointField::new(bad, 1.0, 2), Err(Error::NonFinite { field: "position", .. })));
        assert!(matches!(VortexField::new(bad, Vec3::X, 1.0), Err(Error::NonFinite { field: "point", .. })));
        assert!(matches!(VortexField::new(Vec3::X, bad, 1.0), Err(Error::NonFinite { field: "axis", .. })));
        assert!(matches!(VortexFlow::new(Vec3::X, bad, 1.0), Err(Error::NonFinite { field: "axis", .. })));
        assert!(matches!(SinkFlow::new(bad, 1.0), Err(Error::NonFinite { field: "point", .. })));
    }
    for bad in [Real::NAN, Real::INFINITY] {
        assert!(matches!(EarthGravity::new(bad), Err(Error::NonFinite { field: "g", .. })));
        assert!(matches!(PointField::new(Vec3::X, bad, 2), Err(Error::NonFinite { field: "strength", .. })));
        assert!(matches!(VortexField::new(Vec3::X, Vec3::X, bad), Err(Error::NonFinite { .. })));
        assert!(matches!(VortexFlow::new(Vec3::X, Vec3::X, bad), Err(Error::NonFinite { .. })));
        assert!(matches!(SinkFlow::new(Vec3::X, bad), Err(Error::NonFinite { .. })));
    }
    assert!(matches!(PointField::new(Vec3::X, 1.0, -17), Err(Error::OutOfRange { field: "exponent", .. })));
    assert!(matches!(VortexField::new(Vec3::X, Vec3::ZERO, 1.0), Err(Error::OutOfRange { field: "axis", .. })));
    assert!(matches!(VortexFlow::new(Vec3::X, Vec3::ZERO, 1.0), Err(Error::OutOfRange { field: "axis", .. })));
}

/// Two stars, each carrying its own field: they attract each other, and themselves not.
#[test]
fn carried_fields_act_back() {
    let mut b = Bodies::new(Settings { integrator: Integrator::RungeKutta4, ..Settings::default() });
    b.add(2.0, Vec3::ZERO, Vec3::ZERO);
    b.add(1.0, Vec3::new(2.0, 0.0, 0.0), Vec3::new(0.0, 1.0, 0.0));
    b.force_of(PointField::new(Vec3::ZERO, 4.0, 2).unwrap(), Some(0), false);
    assert_eq!(acceleration_of(&b.model, &b.state, 1), Vec3::new(-1.0, 0.0, 0.0));
    assert_eq!(acceleration_of(&b.model, &b.state, 0), Vec3::new(0.5, 0.0, 0.0));
    assert_eq!(potential_energy(&b.model, &b.state), -2.0);
    let momentum = |b: &Bodies| b.state.lines[0].v * 2.0 + b.state.lines[1].v;
    b.steps(1.0 / 64.0, 640);
    assert!((momentum(&b) - Vec3::new(0.0, 1.0, 0.0)).length() < 1e-13);
    // Without reaction the carrier feels nothing, and what that costs is booked.
    let mut b = Bodies::new(Settings::default());
    b.add(2.0, Vec3::ZERO, Vec3::new(0.5, 0.0, 0.0));
    b.add(1.0, Vec3::new(2.0, 0.0, 0.0), Vec3::new(0.0, 1.0, 0.0));
    b.force_of(PointField::new(Vec3::ZERO, 4.0, 2).unwrap(), Some(0), true);
    assert_eq!(acceleration_of(&b.model, &b.state, 0), Vec3::ZERO);
    b.steps(1.0 / 64.0, 32);
    assert_eq!(b.state.lines[0].v, Vec3::new(0.5, 0.0, 0.0));
    assert!(b.run.ledger.work_of_fields != 0.0);
}

/// `advance` says the same acceleration as `acceleration_of` at the place where the body now is.
#[test]
fn accelerations_are_those_at_the_end() {
    for integrator in [Integrator::Parabola, Integrator::RungeKutta4, Integrator::ExplicitEuler] {
        let mut b = Bodies::new(Settings { integrator, medium_density: 0.5, ..Settings::default() });
        for i in 0..3 {
            b.add(1.0 + Real::from(i), PLACES[i as usize], Vec3::X);
        }
        b.force_of(PointField::new(Vec3::ZERO, 4.0, 2).unwrap(), Some(0), false);
        b.force(VortexField::new(Vec3::ZERO, Vec3::Z, 1.0).unwrap());
        b.force(EarthGravity::default());
        b.model.forces[2].reach.only = Some(vec![true, false, true]);
        b.step(0.125).unwrap();
        for slot in 0..3 {
            assert_eq!(
                b.run.work.accelerations[slot],
                acceleration_of(&b.model, &b.state, slot),
                "{integrator} {slot}"
            );
        }
        b.model.forces.truncate(0);
        b.step(0.125).unwrap();
        assert!(b.run.work.accelerations.is_empty());
    }
}

#[test]
fn only_those_named_are_acted_on() {
    let mut b = Bodies::new(Settings::default());
    for _ in 0..3 {
        b.add(1.0, Vec3::ZERO, Vec3::ZERO);
    }
    b.force(EarthGravity::new(8.0).unwrap());
    b.model.forces[0].reach.only = Some(vec![false, true, false]);
    b.steps(0.125, 8);
    assert_eq!(b.state.lines[0].v, Vec3::ZERO);
    assert_eq!(b.state.lines[1].v, Vec3::new(0.0, -8.0, 0.0));
    assert_eq!(b.state.lines[2].x, Vec3::ZERO);
    b.model.forces[0].reach.gone = true;
    assert_eq!(acceleration_of(&b.model, &b.state, 1), Vec3::ZERO);
}
