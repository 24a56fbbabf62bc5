//! Free rotation against closed forms, a slow twin, and its own conservation laws.

use mrtphys::math::{Quat, Real, Vec3};
use mrtphys::model::Inertia;
use mrtphys::motion::rotate_free;
use proptest::prelude::*;

const DT: Real = 1.0 / 64.0;

/// Angle \[rad\] of the rotation between two orientations: the vector part keeps its digits for small angles.
fn angle_between(a: Quat, b: Quat) -> Real {
    let d = a.conjugate() * b;
    2.0 * libm::atan2(Vec3::new(d.x, d.y, d.z).length(), d.w.abs())
}

/// The slow twin: the classical Runge-Kutta scheme on q' = 1/2 w q with very small steps.
fn slow(mut q: Quat, l: Vec3, inertia: &Inertia, dt: Real, steps: usize) -> Quat {
    let rate = |q: Quat| {
        let w = inertia.angular_velocity(q, l);
        Quat::new(0.5 * w.x, 0.5 * w.y, 0.5 * w.z, 0.0) * q
    };
    let add = |q: Quat, d: Quat, h: Real| Quat::new(q.x + h * d.x, q.y + h * d.y, q.z + h * d.z, q.w + h * d.w);
    let h = dt / steps as Real;
    for _ in 0..steps {
        let k1 = rate(q);
        let k2 = rate(add(q, k1, 0.5 * h));
        let k3 = rate(add(q, k2, 0.5 * h));
        let k4 = rate(add(q, k3, h));
        q = add(add(add(add(q, k1, h / 6.0), k2, h / 3.0), k3, h / 3.0), k4, h / 6.0);
        q = q.try_normalize().unwrap();
    }
    q
}

fn body_spin(inertia: &Inertia, q: Quat, l: Vec3) -> Vec3 {
    inertia.principal_rotation(q).transpose_mul(l).mul_elements(inertia.inverse)
}

fn unit(x: Real, y: Real, z: Real, w: Real) -> Quat {
    Quat::new(x, y, z, w).try_normalize().unwrap()
}

fn tensors() -> Vec<(&'static str, Inertia)> {
    let axes = unit(0.3, -0.2, 0.6, 0.7);
    vec![
        ("sphere", Inertia::new(Vec3::splat(0.4), Quat::IDENTITY)),
        ("prolate", Inertia::new(Vec3::new(2.0, 2.0, 0.3), Quat::IDENTITY)),
        ("oblate, turned", Inertia::new(Vec3::new(1.9, 1.0, 1.0), axes)),
        ("asymmetric", Inertia::new(Vec3::new(1.0, 2.0, 3.0), Quat::IDENTITY)),
        ("asymmetric, turned", Inertia::new(Vec3::new(2.0, 3.0, 1.0), axes)),
        ("other handedness", Inertia::new(Vec3::new(3.0, 2.0, 1.5), Quat::IDENTITY)),
        ("nearly prolate", Inertia::new(Vec3::new(2.0, 2.0 * (1.0 + 1e-13), 0.7), Quat::IDENTITY)),
        ("nearly oblate", Inertia::new(Vec3::new(1.0, 1.0 - 1e-9, 1.7), Quat::IDENTITY)),
        ("nearly spherical", Inertia::new(Vec3::new(1.0, 1.0 + 1e-15, 1.0 - 1e-15), Quat::IDENTITY)),
        ("needle", Inertia::new(Vec3::new(1.0, 1.1, 1e-6), Quat::IDENTITY)),
    ]
}

#[test]
fn no_spin_changes_no_bit() {
    let q = unit(0.1, 0.2, 0.3, 0.9);
    for (name, inertia) in tensors() {
        assert_eq!(rotate_free(q, Vec3::ZERO, &inertia, DT), q, "{name}");
        assert_eq!(rotate_free(q, Vec3::new(1.0, 2.0, 3.0), &inertia, 0.0), q, "{name}");
    }
    assert_eq!(rotate_free(q, Vec3::new(1.0, 2.0, 3.0), &Inertia::INFINITE, DT), q);
}

#[test]
fn agrees_with_the_slow_twin() {
    let starts = [unit(0.0, 0.0, 0.0, 1.0), unit(0.4, -0.1, 0.2, 0.8), unit(-0.7, 0.1, 0.7, 0.05)];
    let spins =
        [Vec3::new(0.3, 2.0, -0.5), Vec3::new(-2.0, 0.1, 0.4), Vec3::new(0.01, 2.0, 0.0), Vec3::new(0.2, 0.3, 1.7)];
    for (name, inertia) in tensors().into_iter().filter(|(name, _)| *name != "needle") {
        for q in starts {
            for w in spins {
                let l = inertia.angular_momentum(q, w);
                for dt in [1e-3, 0.1, -0.1, 0.7, 5.0] {
                    let fast = rotate_free(q, l, &inertia, dt);
                    let twin = slow(q, l, &inertia, dt, 20_000);
                    let error = angle_between(fast, twin);
                    assert!(error < 2e-11, "{name}: {error:e} rad for w = {w:?}, q = {q:?}, dt = {dt}");
                }
            }
        }
    }
}

#[test]
fn one_long_step_is_many_short_ones() {
    for (name, inertia) in tensors() {
        let q = unit(0.4, -0.1, 0.2, 0.8);
        let l = inertia.angular_momentum(q, Vec3::new(0.8, 2.0, -0.5));
        let mut small = q;
        for _ in 0..6400 {
            small = rotate_free(small, l, &inertia, DT);
        }
        let error = angle_between(small, rotate_free(q, l, &inertia, 6400.0 * DT));
        // The last bit of the needle's orientation is a ten-thousandth of its spin about the long axis, for 100 s.
        let bound = if name == "needle" { 2e-6 } else { 1e-10 };
        assert!(error < bound, "{name}: {error:e}");
    }
}

#[test]
fn energy_does_not_drift() {
    for (name, inertia) in tensors() {
        // One unit in the last place of the needle's orientation is a hundred of its energy.
        let bound = if name == "needle" { 2e-11 } else { 1e-13 };
        for (w, spin) in [(1.0, "slow"), (100.0, "fast"), (1e6, "very fast")] {
            for direction in [Vec3::new(0.3, 1.0, -0.2), Vec3::new(1e-3, 1.0, 1e-5), Vec3::new(0.1, 0.2, 1.0)] {
                let mut q = unit(0.4, -0.1, 0.2, 0.8);
                let l = inertia.angular_momentum(q, inertia.principal_rotation(q) * direction * w);
                let start = inertia.energy(q, l);
                for _ in 0..30_000 {
                    q = rotate_free(q, l, &inertia, DT);
                }
                let drift = (inertia.energy(q, l) / start - 1.0).abs();
                assert!(drift < bound, "{name}, {spin}, {direction:?}: {drift:e}");
                assert!((q.dot(q) - 1.0).abs() < 1e-14);
            }
        }
    }
}

/// I = (1, 2, 3), w = (0.01, 1, 0): the intermediate axis flips every 2 K / p = 20.754609764669 s.
#[test]
fn the_intermediate_axis_flips_on_time() {
    let inertia = Inertia::new(Vec3::new(1.0, 2.0, 3.0), Quat::IDENTITY);
    let (mut q, l) = (Quat::IDENTITY, Vec3::new(0.01, 2.0, 0.0));
    let (flip, dt) = (20.754609764669, 1.0 / 64.0);
    let mut found = Vec::new();
    let mut before = body_spin(&inertia, q, l);
    for step in 0..(5.2 * flip / dt) as usize {
        let next = rotate_free(q, l, &inertia, dt);
        let after = body_spin(&inertia, next, l);
        if (before.y > 0.0) != (after.y > 0.0) {
            // w2 = 0 is half-way between flips; bisect with the same closed form.
            let (mut low, mut high) = (0.0, dt);
            for _ in 0..60 {
                let middle = 0.5 * (low + high);
                let w = body_spin(&inertia, rotate_free(q, l, &inertia, middle), l);
                if (w.y > 0.0) == (before.y > 0.0) { low = middle } else { high = middle }
            }
            found.push(step as Real * dt + low);
        }
        (q, before) = (next, after);
    }
    assert_eq!(found.len(), 5);
    for pair in found.windows(2) {
        assert!((pair[1] - pair[0] - flip).abs() < 1e-8, "{}", pair[1] - pair[0]);
    }
    let once = body_spin(&inertia, rotate_free(Quat::IDENTITY, l, &inertia, flip), l);
    assert!(
        (once - Vec3::new(0.01, -1.0, 0.0)).length() < 1e-10 || (once - Vec3::new(-0.01, -1.0, 0.0)).length() < 1e-10,
        "{once:?}"
    );
}

/// The axis of a symmetric top precesses about L at |L|/I1.
#[test]
fn symmetric_top_precesses() {
    let (across, along) = (2.0, 0.7);
    let inertia = Inertia::new(Vec3::new(across, across, along), Quat::IDENTITY);
    let q = Quat::from_axis_angle(Vec3::X, 0.6);
    let l = Vec3::new(0.0, 0.0, 5.0);
    for dt in [0.01, 0.3, 2.0, 40.0] {
        let end = rotate_free(q, l, &inertia, dt);
        let expected = Quat::from_axis_angle(Vec3::Z, 5.0 / across * dt).rotate(q.rotate(Vec3::Z));
        assert!((end.rotate(Vec3::Z) - expected).length() < 1e-13);
        // In the body, w goes round the axis at (1/I3 - 1/I1) L3, against the sense in which the body turns under it.
        let angle = -5.0 * libm::cos(0.6) * (1.0 / along - 1.0 / across) * dt;
        let w = body_spin(&inertia, q, l);
        assert!((body_spin(&inertia, end, l) - Quat::from_axis_angle(Vec3::Z, angle).rotate(w)).length() < 1e-12);
    }
}

#[test]
fn principal_axes_are_permanent_and_the_separatrix_settles() {
    let inertia = Inertia::new(Vec3::new(1.0, 2.0, 3.0), Quat::IDENTITY);
    for (l, i) in [(Vec3::X, 1.0), (Vec3::Y, 2.0), (Vec3::Z, 3.0)] {
        for dt in [0.01, 1.0, 1e4] {
            let q = rotate_free(Quat::IDENTITY, l, &inertia, dt);
            assert!(angle_between(q, Quat::from_axis_angle(l, dt / i)) < 1e-15 * (1.0 + dt), "{l:?} {dt}");
        }
    }
    // L^2 = 2 E I2 to the last bit: n3^2 = h n1^2 with h = 3. It settles on the intermediate axis and never leaves.
    let inertia = Inertia::new(Vec3::new(1.0, 1.5, 3.0), Quat::IDENTITY);
    let l = Vec3::new(1.0, 2.0, 1.0);
    let energy = inertia.energy(Quat::IDENTITY, l);
    for dt in [0.1, 1.0, 10.0, 1e3, 1e6] {
        let q = rotate_free(Quat::IDENTITY, l, &inertia, dt);
        assert!(q.is_finite());
        assert!((inertia.energy(q, l) / energy - 1.0).abs() < 1e-15, "{dt}");
        if dt >= 100.0 {
            assert!(inertia.principal_rotation(q).transpose_mul(l).y.abs() > l.length() * (1.0 - 1e-15));
        } else {
            assert!(angle_between(q, slow(Quat::IDENTITY, l, &inertia, dt, 40_000)) < 1e-10);
        }
    }
}

#[test]
fn not_finite_in_not_finite_out() {
    let inertia = Inertia::new(Vec3::new(1.0, 2.0, 3.0), Quat::IDENTITY);
    for l in [Vec3::new(Real::NAN, 0.0, 0.0), Vec3::new(1.0, Real::INFINITY, 0.0), Vec3::new(1e308, 1e308, 1e308)] {
        let _ = rotate_free(Quat::IDENTITY, l, &inertia, 1e10);
    }
    assert!(!rotate_free(Quat::IDENTITY, Vec3::new(Real::INFINITY, 0.0, 0.0), &inertia, 1.0).is_finite());
    // Tiny ones are as good as any.
    let q = rotate_free(Quat::IDENTITY, Vec3::new(0.01, 2.0, 0.0) * 1e-200, &inertia, 1e200);
    let r = rotate_free(Quat::IDENTITY, Vec3::new(0.01, 2.0, 0.0), &inertia, 1.0);
    assert!(angle_between(q, r) < 1e-14);
}

fn any_unit() -> impl Strategy<Value = Quat> {
    (-1.0..1.0, -1.0..1.0, -1.0..1.0, -1.0..1.0f64)
        .prop_filter_map("zero", |(x, y, z, w)| Quat::new(x, y, z, w).try_normalize())
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 300, rng_algorithm: prop::test_runner::RngAlgorithm::ChaCha, failure_persistence: None, ..ProptestConfig::default() })]

    /// Random tensors: those of three point pairs on the axes, so that every one of them belongs to a body.
    #[test]
    fn random_tensors(
        masses in (1e-3..1.0, 1e-3..1.0, 1e-3..1.0f64), axes in any_unit(), q in any_unit(),
        w in (-3.0..3.0, -3.0..3.0, -3.0..3.0f64), dt in -2.0..2.0f64, exponent in -40i32..=40,
    ) {
        let (a, b, c) = masses;
        let inertia = Inertia::new(Vec3::new(b + c, a + c, a + b), axes);
        let l = inertia.angular_momentum(q, Vec3::new(w.0, w.1, w.2));
        let end = rotate_free(q, l, &inertia, dt);
        prop_assert!(angle_between(end, slow(q, l, &inertia, dt, 4000)) < 2e-9);
        prop_assert!((inertia.energy(end, l) / inertia.energy(q, l) - 1.0).abs() < 3e-15);
        // There and back, and the same for lengths 2^k times as large.
        prop_assert!(angle_between(rotate_free(end, l, &inertia, -dt), q) < 1e-12);
        let area = libm::ldexp(1.0, 2 * exponent);
        let large = Inertia::new(inertia.moments * area, axes);
        prop_assert_eq!(rotate_free(q, l * area, &large, dt), end);
    }
}
