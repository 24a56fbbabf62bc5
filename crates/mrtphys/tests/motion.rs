//! The integrators, against the vectors, closed forms and their own orders; and the ledger they keep.

mod bodies;

use bodies::Bodies;
use mrtphys::field::{
    EarthGravity, ForceField, PointField, SinkFlow, UniformField, UniformFlow, VortexField, VortexFlow,
};
use mrtphys::math::{Quat, Real, Vec3};
use mrtphys::model::Inertia;
use mrtphys::{Integrator, Settings};
use serde_json::Value;
use std::f64::consts::PI;

const ALL: [Integrator; 4] =
    [Integrator::Parabola, Integrator::SemiImplicitEuler, Integrator::ExplicitEuler, Integrator::RungeKutta4];

fn vectors() -> Value {
    serde_json::from_str(include_str!("vectors/motion.json")).unwrap()
}

fn number(v: &Value) -> Real {
    v.as_f64().unwrap()
}

fn vector(v: &Value) -> Vec3 {
    Vec3::new(number(&v[0]), number(&v[1]), number(&v[2]))
}

fn scheme(name: &str) -> Integrator {
    match name {
        "explicit" => Integrator::ExplicitEuler,
        "semi" => Integrator::SemiImplicitEuler,
        "exact" => Integrator::Parabola,
        _ => panic!("{name}"),
    }
}

fn scene(integrator: Integrator, viscosity: Real) -> Bodies {
    Bodies::new(Settings { integrator, viscosity, ..Settings::default() })
}

#[test]
fn falls_as_the_vectors_say() {
    for case in vectors()["cases"].as_array().unwrap() {
        let (g, dt, steps) = (number(&case["g"]), number(&case["dt"]), case["steps"].as_u64().unwrap() as usize);
        for (name, expected) in case["schemes"].as_object().unwrap() {
            let mut b = scene(scheme(name), 0.0);
            b.add(2.0, Vec3::new(1.0, number(&case["y0"]), 0.0), Vec3::new(0.0, number(&case["v0"]), 0.0));
            b.force(EarthGravity::new(g).unwrap());
            let start = b.energy();
            b.steps(dt, steps);
            let line = b.state.lines[0];
            assert!((line.x.y - number(&expected["y"])).abs() < 1e-11, "{name}: {}", line.x.y);
            assert!((line.v.y - number(&expected["v"])).abs() < 1e-11, "{name}: {}", line.v.y);
            // +-1/2 m g^2 dt^2 per step, and the ledger says so.
            let drift = 2.0 * steps as Real * number(&expected["energy_error_per_step"]);
            assert!((b.energy() - start - drift).abs() < 1e-10, "{name}: {}", b.energy() - start);
            assert!((b.run.ledger.integration - drift).abs() < 1e-10, "{name}: {}", b.run.ledger.integration);
            assert_eq!(b.run.ledger.sum(), b.run.ledger.integration);
            assert_eq!(b.run.work.accelerations, vec![Vec3::new(0.0, -g, 0.0)]);
        }
    }
}

#[test]
fn bounces_as_the_vectors_say() {
    for case in vectors()["bounce"].as_array().unwrap() {
        let name = case["scheme"].as_str().unwrap();
        let (h, r, dt) = (number(&case["h"]), number(&case["r"]), number(&case["dt"]));
        let mut b = scene(scheme(name), 0.0);
        b.add(1.0, Vec3::new(0.0, h, 0.0), Vec3::ZERO);
        b.force(EarthGravity::default());
        let mut bounces = Vec::new();
        for step in 1..=case["steps"].as_u64().unwrap() {
            b.step(dt).unwrap();
            let line = &mut b.state.lines[0];
            if line.x.y < r && line.v.y < 0.0 {
                line.v.y = -line.v.y;
                bounces.push(step);
            }
        }
        let expected: Vec<u64> = case["bounce_steps"].as_array().unwrap().iter().map(|v| v.as_u64().unwrap()).collect();
        assert_eq!(bounces, expected, "{name}");
        assert!((b.state.lines[0].v.y - number(&case["v_end"])).abs() < 1e-11);
        assert!((b.run.ledger.integration - number(&case["predicted_energy_change"])).abs() < 1e-10);
    }
}

#[test]
fn viscosity_as_the_vectors_say() {
    for case in vectors()["viscosity"].as_array().unwrap() {
        let (eta, dt) = (number(&case["eta"]), number(&case["dt"]));
        for integrator in [Integrator::Parabola, Integrator::SemiImplicitEuler, Integrator::ExplicitEuler] {
            let mut b = scene(integrator, eta);
            b.add(1.0, Vec3::ZERO, vector(&case["v"]));
            b.flow(UniformFlow::new(vector(&case["flow"])).unwrap());
            b.step(dt).unwrap();
            let v = b.state.lines[0].v;
            assert!((v - vector(&case["v_after"])).length() < 4e-15, "{integrator} {eta} {dt}: {v:?}");
        }
    }
}

#[test]
fn rotation_matrices_as_the_vectors_say() {
    for case in vectors()["rotation"].as_array().unwrap() {
        let axis = vector(&case["axis"]).try_normalize().unwrap();
        let m = Quat::from_axis_angle(axis, number(&case["angle"])).to_matrix();
        for i in 0..3 {
            for j in 0..3 {
                assert!((m.at(i, j) - number(&case["R_column_vectors"][i][j])).abs() < 1e-14);
            }
        }
    }
}

/// v(t) = u + g/k + (v - u - g/k) e^-kt, for one step of any length.
#[test]
fn fall_with_drag_is_exact() {
    let (eta, g, u, v0) = (0.4, 9.80665, Vec3::new(1.0, 0.5, -2.0), Vec3::new(3.0, 1.0, 0.0));
    let k = -libm::log(1.0 - eta);
    let a = Vec3::new(0.0, -g, 0.0);
    let exact = |t: Real| {
        let terminal = u + a / k;
        let e = libm::exp(-k * t);
        (terminal * t + (v0 - terminal) * ((1.0 - e) / k), terminal + (v0 - terminal) * e)
    };
    for (dt, steps) in [(8.0, 1), (0.125, 64)] {
        let mut b = scene(Integrator::Parabola, eta);
        b.add(1.5, Vec3::ZERO, v0);
        b.force(EarthGravity::default());
        b.flow(UniformFlow::new(u).unwrap());
        let start = b.energy();
        b.steps(dt, steps);
        let (x, v) = exact(8.0);
        assert!((b.state.lines[0].x - x).length() < 1e-12 && (b.state.lines[0].v - v).length() < 1e-12);
        assert!((b.energy() - start - b.run.ledger.drag).abs() < 1e-11);
        assert_eq!(b.run.ledger.sum(), b.run.ledger.drag);
    }
}

#[test]
fn buoyancy_replaces_the_mass() {
    let settings = Settings { medium_density: 1000.0, viscosity: 0.3, ..Settings::default() };
    let mut b = Bodies::new(settings);
    let inertia = Inertia::new(Vec3::splat(1.0), Quat::IDENTITY);
    for volume in [0.0, 0.001, 0.002, 0.004] {
        b.add_with(2.0, inertia, volume, Vec3::ZERO, Vec3::ZERO);
    }
    b.force(EarthGravity::new(10.0).unwrap());
    b.step(0.125).unwrap();
    for (slot, a) in [-10.0, -5.0, 0.0, 10.0].into_iter().enumerate() {
        assert_eq!(b.run.work.accelerations[slot].y, a);
        assert_eq!(b.state.lines[slot].v.y.total_cmp(&0.0), a.total_cmp(&0.0), "{a}");
    }
    assert_eq!(b.state.lines[2].x, Vec3::ZERO, "what weighs as much as the water floats where it is");
}

/// Error at the end of a run with `steps` steps, of the position alone.
fn orbit_error(integrator: Integrator, steps: usize) -> (Real, Real) {
    let mut b = scene(integrator, 0.0);
    // Eccentricity 0.36: half a revolution, from the farthest point to the nearest.
    b.add(1.0, Vec3::X, Vec3::new(0.0, 0.8, 0.0));
    b.force(PointField::new(Vec3::ZERO, 1.0, 2).unwrap());
    let axis = 1.0 / (2.0 - 0.64);
    let half = PI * libm::sqrt(axis * axis * axis);
    let start = b.energy();
    b.steps(half / steps as Real, steps);
    let near = -(2.0 * axis - 1.0);
    ((b.state.lines[0].x - Vec3::new(near, 0.0, 0.0)).length(), (b.energy() - start).abs())
}

#[test]
fn kepler_orbits_converge_at_the_order_of_the_scheme() {
    for (integrator, order) in [
        (Integrator::Parabola, 2.0),
        (Integrator::RungeKutta4, 4.0),
        (Integrator::ExplicitEuler, 1.0),
        (Integrator::SemiImplicitEuler, 1.0),
    ] {
        let (coarse, fine) = (orbit_error(integrator, 1000).0, orbit_error(integrator, 2000).0);
        let measured = libm::log2(coarse / fine);
        assert!((measured - order).abs() < 0.15, "{integrator}: order {measured}, not {order}");
    }
    assert!(orbit_error(Integrator::RungeKutta4, 1000).1 < 1e-9);
}

/// The symplectic scheme's energy swings and does not drift: 100 revolutions.
#[test]
fn kepler_energy_stays() {
    let mut b = scene(Integrator::Parabola, 0.0);
    b.add(1.0, Vec3::X, Vec3::new(0.0, 0.8, 0.0));
    b.force(PointField::new(Vec3::ZERO, 1.0, 2).unwrap());
    let start = b.energy();
    let mut largest: Real = 0.0;
    for _ in 0..100 {
        b.steps(0.005, 792);
        largest = largest.max((b.energy() - start).abs());
    }
    assert!(largest < 3e-5, "{largest:e}");
    assert!((b.energy() - start - b.run.ledger.sum()).abs() < 1e-12);
}

/// Viscosity 1: a circle round the vortex at the rate Gamma/(2 pi r^2), and r^3 = r0^3 - 3 S t/(4 pi) into the sink.
#[test]
fn streamlines_converge_at_the_order_of_the_scheme() {
    let error = |integrator, steps: usize, sink: bool| {
        let mut b = scene(integrator, 1.0);
        b.add(1.0, Vec3::X, Vec3::ZERO);
        let expected = if sink {
            b.flow(SinkFlow::new(Vec3::ZERO, 4.0).unwrap());
            Vec3::new(libm::cbrt(1.0 - 3.0 * 4.0 / (4.0 * PI) * 0.75), 0.0, 0.0)
        } else {
            b.flow(VortexFlow::new(Vec3::ZERO, Vec3::new(0.0, 0.0, 7.0), 6.0).unwrap());
            Quat::from_axis_angle(Vec3::Z, 6.0 / (2.0 * PI) * 0.75).rotate(Vec3::X)
        };
        b.steps(0.75 / steps as Real, steps);
        (b.state.lines[0].x - expected).length()
    };
    for sink in [false, true] {
        for (integrator, order) in [(Integrator::Parabola, 2.0), (Integrator::RungeKutta4, 4.0)] {
            let measured = libm::log2(error(integrator, 64, sink) / error(integrator, 128, sink));
            assert!((measured - order).abs() < 0.3, "{integrator}, sink {sink}: {measured}");
        }
    }
}

/// Drag in a varying flow: order 2 for the parabola, 4 for Runge-Kutta, against a fine run of the latter.
#[test]
fn drag_in_a_vortex_converges() {
    let end = |integrator, steps: usize| {
        let mut b = scene(integrator, 0.8);
        b.add(1.0, Vec3::X, Vec3::new(0.3, 0.0, 0.2));
        b.flow(VortexFlow::new(Vec3::ZERO, Vec3::Z, 6.0).unwrap());
        b.force(VortexField::new(-Vec3::Y, Vec3::X, 1.0).unwrap());
        b.steps(1.0 / steps as Real, steps);
        b.state.lines[0].x
    };
    let reference = end(Integrator::RungeKutta4, 2048);
    for (integrator, order) in [(Integrator::Parabola, 2.0), (Integrator::RungeKutta4, 4.0)] {
        let error = |steps| (end(integrator, steps) - reference).length();
        let measured = libm::log2(error(32) / error(64));
        assert!((measured - order).abs() < 0.35, "{integrator}: {measured}");
    }
}

/// Everything at once, and no close encounters: gravity, a charge that is pushed back, another without reaction, a vortex, drag, spin.
fn busy(integrator: Integrator, viscosity: Real, scale: Real) -> Bodies {
    let settings = Settings { integrator, viscosity, viscous_spin: true, medium_density: 0.3, ..Settings::default() };
    let mut b = Bodies::new(settings);
    let inertia = Inertia::new(Vec3::new(1.0, 2.0, 2.5) * (scale * scale), Quat::IDENTITY);
    for i in 0..6 {
        let t = Real::from(i);
        let x = Vec3::new(1.0 + t, 0.5 * t - 1.0, 2.0 - 0.7 * t) * scale;
        let slot = b.add_with(1.0 + 0.25 * t, inertia, 0.1, x, Vec3::new(0.1 * t, 0.4, -0.2) * scale);
        b.state.spins[slot].l = Vec3::new(0.3, 1.0, 0.1 * t) * (scale * scale);
    }
    b.add(Real::INFINITY, Vec3::new(-2.0, 0.0, 0.0) * scale, Vec3::ZERO);
    b.force(UniformField::new(Vec3::new(0.0, -0.5, 0.125) * scale).unwrap());
    b.force_of(PointField::new(Vec3::ZERO, -1.5 * scale * scale * scale, 2).unwrap(), Some(0), false);
    b.force_of(PointField::new(Vec3::ZERO, -0.5 * scale * scale, 1).unwrap(), Some(3), true);
    b.force_of(PointField::new(Vec3::ZERO, 0.5 * scale * scale * scale, 2).unwrap(), Some(6), false);
    b.force(VortexField::new(Vec3::ZERO, Vec3::Y, 0.7 * scale * scale).unwrap());
    b.flow(VortexFlow::new(Vec3::X * scale, Vec3::Z, 2.0 * scale * scale).unwrap());
    b
}

#[test]
fn the_ledger_closes() {
    for integrator in ALL {
        for viscosity in [0.0, 0.2, 0.9999, 1.0] {
            let mut b = busy(integrator, viscosity, 1.0);
            let start = b.energy();
            b.steps(1.0 / 128.0, 128);
            let l = b.run.ledger;
            let scale = start.abs() + b.energy().abs() + l.sum_abs();
            let residual = b.energy() - start - l.sum();
            assert!(residual.abs() < 1e-12 * scale, "{integrator}, {viscosity}: {residual:e} of {l:?}");
            assert!(l.work_of_fields != 0.0 && (l.drag != 0.0) == (viscosity != 0.0));
        }
    }
    // What the scheme itself lost falls with its order, so that the other entries are the true ones to that order.
    for (integrator, order) in [(Integrator::Parabola, 2.0), (Integrator::RungeKutta4, 4.0)] {
        let loss = |steps: usize| {
            let mut b = busy(integrator, 0.2, 1.0);
            b.steps(1.0 / steps as Real, steps);
            b.run.ledger.integration.abs()
        };
        let measured = libm::log2(loss(64) / loss(128));
        assert!(measured > order - 0.4, "{integrator}: {measured}");
    }
}

#[test]
fn scenes_of_twice_the_size_are_the_same_to_the_last_bit() {
    for integrator in ALL {
        for viscosity in [0.0, 0.2, 1.0] {
            let mut one = busy(integrator, viscosity, 1.0);
            one.steps(1.0 / 64.0, 32);
            for exponent in [-40, 1, 40] {
                let scale = libm::ldexp(1.0, exponent);
                let mut other = busy(integrator, viscosity, scale);
                other.steps(1.0 / 64.0, 32);
                for (a, b) in one.state.lines.iter().zip(&other.state.lines) {
                    assert_eq!((a.x * scale, a.v * scale), (b.x, b.v), "{integrator} {viscosity} 2^{exponent}");
                }
                for (a, b) in one.state.spins.iter().zip(&other.state.spins) {
                    assert_eq!((a.q, a.l * (scale * scale)), (b.q, b.l));
                }
            }
        }
    }
}

/// Slots are no more than places in memory.
#[test]
fn the_order_of_slots_does_not_matter() {
    let n = 6;
    for integrator in ALL {
        let mut one = busy(integrator, 0.2, 1.0);
        let mut other = busy(integrator, 0.2, 1.0);
        let turned = |slot: usize| if slot < n { n - 1 - slot } else { slot };
        for slot in 0..=n {
            other.state.lines[turned(slot)] = one.state.lines[slot];
            other.state.spins[turned(slot)] = one.state.spins[slot];
            other.model.type_of[turned(slot)] = slot as u32;
            other.model.serial[turned(slot)] = slot as u32;
        }
        for force in &mut other.model.forces {
            force.reach.carrier = force.reach.carrier.map(|slot| turned(slot as usize) as u32);
        }
        one.steps(1.0 / 64.0, 64);
        other.steps(1.0 / 64.0, 64);
        for slot in 0..=n {
            assert_eq!(one.state.lines[slot], other.state.lines[turned(slot)]);
            assert_eq!(one.state.spins[slot], other.state.spins[turned(slot)]);
        }
        assert_eq!(one.run.ledger, other.run.ledger);
    }
}

#[test]
fn a_lost_body_does_not_disturb_the_others() {
    for integrator in ALL {
        for (uniform, by_spin) in [(true, false), (true, true), (false, false), (false, true)] {
            let build = |with: bool| {
                let mut b = if uniform { scene(integrator, 0.0) } else { busy(integrator, 0.2, 1.0) };
                if uniform {
                    b.add(1.0, Vec3::X, Vec3::Y);
                    b.force(EarthGravity::default());
                }
                let inertia = Inertia::new(Vec3::new(1.0, 2.0, 3.0), Quat::IDENTITY);
                let v = if by_spin { Vec3::ZERO } else { Vec3::new(1e152, 0.0, 0.0) };
                let slot = b.add_with(1.0, inertia, 0.0, Vec3::new(0.0, 5.0, 0.0), v);
                if by_spin {
                    b.state.spins[slot].l = Vec3::splat(1.7e308);
                }
                if !with {
                    b.state.lines[slot].radius = -1.0;
                }
                (b, slot)
            };
            let ((mut with, slot), (mut without, _)) = (build(true), build(false));
            with.steps(0.125, 3);
            without.steps(0.125, 3);
            assert_eq!(with.run.counters.quarantined, 1, "{integrator} {uniform} {by_spin}");
            assert_eq!(without.run.counters.quarantined, 0);
            let line = with.state.lines[slot];
            assert_eq!((line.x, line.v, line.radius), (Vec3::new(0.0, 5.0, 0.0), Vec3::ZERO, -1.0));
            assert_eq!(with.state.spins[slot].l, Vec3::ZERO);
            assert_eq!(with.state.lines[..slot], without.state.lines[..slot]);
            assert_eq!(with.state.spins[..slot], without.state.spins[..slot]);
        }
    }
}

#[test]
fn the_energy_of_a_lost_body_is_booked() {
    let mut b = scene(Integrator::Parabola, 0.0);
    b.add(2.0, Vec3::new(0.9e150, 0.0, 0.0), Vec3::new(1e150, 0.0, 0.0) * 1e-100);
    b.add(1.0, Vec3::ZERO, Vec3::X);
    b.state.lines[0].v = Vec3::new(3e149, 0.0, 0.0);
    b.step(1.0).unwrap();
    assert_eq!(b.run.counters.quarantined, 1);
    assert_eq!(b.run.ledger.created_removed, -(0.5 * 2.0 * (3e149 * 3e149)));
}

#[derive(Debug)]
struct Broken;

impl ForceField for Broken {
    fn acceleration(&self, at: Vec3, _mass: Real) -> Vec3 {
        if at.y < 0.0 { Vec3::splat(Real::NAN) } else { Vec3::ZERO }
    }
    fn potential(&self, _at: Vec3) -> Option<Real> {
        None
    }
}

#[test]
fn a_field_that_is_no_number_is_an_error() {
    for integrator in ALL {
        let mut b = scene(integrator, 0.0);
        b.add(1.0, Vec3::Y, Vec3::ZERO);
        b.force(EarthGravity::default());
        b.force(Broken);
        let error = (0..100).find_map(|_| b.step(0.125).err()).expect("it falls below zero");
        assert_eq!(error.to_string(), "force field 1 (Broken) gave a value that is not finite");
    }
}

#[test]
fn what_has_no_mass_or_is_set_aside_stays() {
    for integrator in ALL {
        let mut b = busy(integrator, 0.2, 1.0);
        b.state.lines[2].radius = -1.0;
        b.state.spins[2].l = Vec3::ZERO;
        let (aside, fixed) = (b.state.lines[2], b.state.lines[6]);
        b.steps(0.125, 4);
        assert_eq!((b.state.lines[2], b.state.lines[6]), (aside, fixed));
        assert_eq!((b.run.work.accelerations[2], b.run.work.accelerations[6]), (Vec3::ZERO, Vec3::ZERO));
    }
}

/// Thousands of bodies go through several blocks; each must move as it does alone.
#[test]
fn many_bodies_move_as_one_does() {
    let mut b = scene(Integrator::Parabola, 0.1);
    for i in 0..9000 {
        b.add(1.0, Vec3::new(Real::from(i), 0.0, 0.0), Vec3::new(0.0, 0.01 * Real::from(i), 1.0));
    }
    b.force(EarthGravity::default());
    b.steps(0.125, 2);
    for i in [0, 1, 4095, 4096, 8999] {
        let mut one = scene(Integrator::Parabola, 0.1);
        one.add(1.0, Vec3::new(Real::from(i), 0.0, 0.0), Vec3::new(0.0, 0.01 * Real::from(i), 1.0));
        one.force(EarthGravity::default());
        one.steps(0.125, 2);
        assert_eq!(one.state.lines[0], b.state.lines[i as usize]);
    }
}
