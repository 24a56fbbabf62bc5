//! Impact laws against the reference cases, closed forms and what every law must keep.

use mrtphys::def::FrictionLaw;
use mrtphys::impact::sequential::{Response, frictionless_spheres, respond};
use mrtphys::impact::{Encounter, Party, make};
use mrtphys::{Mat3, Real, Vec3};
use proptest::prelude::*;
use proptest::test_runner::{Config, RngAlgorithm, TestRng, TestRunner};
use serde_json::Value;

const LAWS: [FrictionLaw; 6] = [
    FrictionLaw::Frictionless,
    FrictionLaw::Kurtenbach,
    FrictionLaw::KurtenbachLiteral,
    FrictionLaw::Velocity,
    FrictionLaw::Rough,
    FrictionLaw::Coulomb,
];

fn vec3(v: &Value) -> Vec3 {
    let at = |i: usize| v[i].as_f64().unwrap();
    Vec3::new(at(0), at(1), at(2))
}

/// A body with a spherical inertia tensor.
fn round(mass: Real, j: Real, v: Vec3, w: Vec3, r: Vec3) -> Party {
    Party {
        mass,
        inverse_mass: 1.0 / mass,
        inverse_inertia: Mat3::diagonal(Vec3::splat(1.0 / j)),
        v,
        w,
        r,
        angular_momentum: w * j,
    }
}

/// A party of a reference case, and its moment of inertia (0 for infinite mass).
fn party(case: &Value, i: u8) -> (Party, Real) {
    let get = |name: &str| &case[format!("{name}{i}")];
    let Some(mass) = get("m").as_f64() else {
        return (Party::IMMOVABLE, 0.0);
    };
    let j = get("J").as_f64().unwrap();
    (round(mass, j, vec3(get("v")), vec3(get("w")), vec3(get("r"))), j)
}

fn after(p: &Party, j: Vec3) -> Party {
    Party { v: p.v + j * p.inverse_mass, w: p.w + p.inverse_inertia * p.r.cross(j), ..*p }
}

fn both_after(e: &Encounter, r: &Response) -> Encounter {
    Encounter { a: after(&e.a, r.impulse_on_a), b: after(&e.b, -r.impulse_on_a), ..*e }
}

#[test]
fn guarded_laws_match_the_reference() {
    let file: Value = serde_json::from_str(include_str!("vectors/impacts.json")).unwrap();
    let laws = [
        ("frictionless", FrictionLaw::Frictionless),
        ("thesis", FrictionLaw::Kurtenbach),
        ("velocity", FrictionLaw::Velocity),
        ("effective", FrictionLaw::Rough),
    ];
    let (mut compared, mut left_out, mut fallbacks, mut unanswered) = (0, 0, 0, 0);
    for case in file["cases"].as_array().unwrap() {
        let ((a, ja), (b, jb)) = (party(case, 1), party(case, 2));
        let friction = case["phi"].as_f64().unwrap();
        let e = Encounter { a, b, normal: vec3(&case["N1"]), friction, restitution: 1.0, persistent: false };
        for (name, law) in laws {
            let expected = &case["guarded"][name];
            if expected["margin"].as_f64().unwrap() <= 1e-7 * e.relative_velocity().length() {
                left_out += 1;
                continue;
            }
            let context = format!("{} {name}", case["kind"]);
            let response = respond(&e, make(law).as_ref());
            assert_eq!(response.is_some(), expected["applied"].as_bool().unwrap(), "{context}");
            let Some(response) = response else {
                unanswered += 1;
                continue;
            };
            assert_eq!(response.fallback, expected["fallback"].as_bool().unwrap(), "{context}");
            fallbacks += u32::from(response.fallback);
            let out = both_after(&e, &response);
            let close = |found: Vec3, key: &str, scale: Real| {
                let expected = vec3(&expected[key]);
                let error = (found - expected).length();
                assert!(error <= 1e-9 * (expected.length() + scale), "{context} {key}: {found:?} {expected:?}");
            };
            close(response.impulse_on_a, "dp1", 0.0);
            close(out.a.v, "v1", e.a.v.length());
            // Spin is worth the speed that it gives the contact point.
            close(out.a.w, "w1", e.a.w.length() + e.relative_velocity().length() / e.a.r.length());
            close(out.b.v, "v2", e.b.v.length());
            close(out.b.w, "w2", e.b.w.length() + e.relative_velocity().length() / e.b.r.length().max(e.a.r.length()));
            let vn = expected["vn_after"].as_f64().unwrap();
            assert!((out.approach() - vn).abs() <= 1e-9 * e.relative_velocity().length(), "{context}");
            let linear = |p: &Party| if p.inverse_mass > 0.0 { 0.5 * p.mass * p.v.length_squared() } else { 0.0 };
            let (wl, wr) = (
                linear(&out.a) + linear(&out.b),
                0.5 * ja * out.a.w.length_squared() + 0.5 * jb * out.b.w.length_squared(),
            );
            let energy = |key: &str| expected[key].as_f64().unwrap();
            let total = energy("Wlin") + energy("Wrot");
            assert!(
                (wl - energy("Wlin")).abs() <= 1e-9 * total && (wr - energy("Wrot")).abs() <= 1e-9 * total,
                "{context}"
            );
            assert!(response.energy_change.abs() <= 1e-13 * total, "{context}");
            compared += 1;
        }
    }
    // Enough of each kind was seen for the test to mean something.
    assert!(
        compared == 504 && fallbacks == 23 && unanswered == 32 && left_out == 0,
        "{compared} {fallbacks} {unanswered} {left_out}"
    );
}

/// Everything that a random encounter is made of.
#[derive(Clone, Copy, Debug)]
struct Body {
    mass: Real,
    /// body's own length \[m\]
    size: Real,
    /// principal moments over m size^2; they satisfy the triangle inequality
    moments: [Real; 3],
    turn: [Real; 4],
    v: [Real; 3],
    w: [Real; 3],
    r: [Real; 3],
}

fn body() -> impl Strategy<Value = Body> {
    let unit = || -1.0..1.0;
    (
        (-4.6..4.6, 0.05..1.0),
        [0.02..0.5, 0.02..0.5, 0.02..0.5],
        [unit(), unit(), unit(), 0.1..1.0],
        [unit(), unit(), unit()],
        [unit(), unit(), unit()],
        [unit(), unit(), unit()],
    )
        .prop_map(|((log, size), h, turn, v, w, r): ((Real, Real), [Real; 3], [Real; 4], _, _, _)| Body {
            mass: libm::exp(log),
            size,
            moments: [h[1] + h[2], h[2] + h[0], h[0] + h[1]],
            turn,
            v,
            w,
            r,
        })
}

impl Body {
    fn party(&self) -> Party {
        let [x, y, z, w] = self.turn;
        let axes = mrtphys::Quat::new(x, y, z, w).try_normalize().unwrap().to_matrix();
        let [a, b, c] = self.moments.map(|h| h * self.mass * self.size * self.size);
        let spin = Vec3::from(self.w) * (1.0 / self.size);
        Party {
            mass: self.mass,
            inverse_mass: 1.0 / self.mass,
            inverse_inertia: axes.conjugate_diagonal(Vec3::new(1.0 / a, 1.0 / b, 1.0 / c)),
            v: self.v.into(),
            w: spin,
            r: Vec3::from(self.r) * self.size,
            angular_momentum: axes.conjugate_diagonal(Vec3::new(a, b, c)) * spin,
        }
    }
}

/// Approaching encounters; a quarter of them with a wall.
fn encounter() -> impl Strategy<Value = Encounter> {
    let unit = || -1.0..1.0;
    (body(), body(), [unit(), unit(), unit()], 0.0..1.0, prop_oneof![Just(1.0), Just(0.0), 0.0..1.0], 0..4)
        .prop_filter_map("no normal", |(a, b, n, friction, restitution, wall)| {
            let n: [Real; 3] = n;
            let mut e = Encounter {
                a: a.party(),
                b: if wall == 0 { Party::IMMOVABLE } else { b.party() },
                normal: Vec3::from(n).try_normalize()?,
                friction,
                restitution,
                persistent: false,
            };
            if e.approach() < 0.0 {
                e.normal = -e.normal;
            }
            (e.approach() > 1e-3 * e.relative_velocity().length()).then_some(e)
        })
}

/// Deterministic cases, the same on every run.
fn check(cases: u32, test: impl Fn(Encounter) -> Result<(), TestCaseError>) {
    let config = Config { cases, failure_persistence: None, ..Config::default() };
    let rng = TestRng::from_seed(RngAlgorithm::ChaCha, &[7; 32]);
    TestRunner::new_with_rng(config, rng).run(&encounter(), test).unwrap();
}

fn kinetic(p: &Party, l: Vec3) -> Real {
    if p.inverse_mass == 0.0 { 0.0 } else { 0.5 * p.mass * p.v.length_squared() + 0.5 * l.dot(p.inverse_inertia * l) }
}

/// Kinetic energy of the pair before and after an impulse, from momenta: independent of what `respond` measures.
fn energies(e: &Encounter, j: Vec3) -> (Real, Real) {
    let (a, b) = (e.a, e.b);
    let before = kinetic(&a, a.angular_momentum) + kinetic(&b, b.angular_momentum);
    let after = kinetic(&after(&a, j), a.angular_momentum + a.r.cross(j))
        + kinetic(&after(&b, -j), b.angular_momentum - b.r.cross(j));
    (before, after)
}

#[test]
fn energy_never_increases_and_the_pair_separates() {
    check(4000, |e| {
        for law in LAWS {
            let Some(r) = respond(&e, make(law).as_ref()) else {
                return Err(TestCaseError::fail(format!("{law:?} left an approaching pair alone")));
            };
            let (before, after) = energies(&e, r.impulse_on_a);
            if law != FrictionLaw::KurtenbachLiteral {
                prop_assert!(after <= before * (1.0 + 1e-13), "{law:?} {}", after / before - 1.0);
                let out = both_after(&e, &r);
                let speeds = |p: &Party| p.v.length() + p.w.length() * p.r.length();
                let noise = 1e-14 * (speeds(&e.a) + speeds(&e.b) + speeds(&out.a) + speeds(&out.b));
                prop_assert!(out.approach() <= noise, "{law:?} approaches at {}", out.approach());
            }
            // The measured change is the change, and its parts add up.
            prop_assert!((after - before - r.energy_change).abs() <= 1e-13 * before, "{law:?}");
            prop_assert!((r.friction_change + r.restitution_change - r.energy_change).abs() <= 1e-15 * before);
            let elastic = !matches!(law, FrictionLaw::Coulomb | FrictionLaw::KurtenbachLiteral) && e.restitution == 1.0;
            prop_assert!(!elastic || (after - before).abs() <= 1e-13 * before, "{law:?}");
            prop_assert!(r.impulse_n > 0.0 || !matches!(law, FrictionLaw::Coulomb | FrictionLaw::Frictionless));
        }
        Ok(())
    });
}

#[test]
fn restitution_of_the_normal_speed_without_friction() {
    check(1000, |e| {
        let r = respond(&e, make(FrictionLaw::Frictionless).as_ref()).unwrap();
        let scale = e.relative_velocity().length() + e.response(r.impulse_on_a).length();
        prop_assert!((both_after(&e, &r).approach() + e.restitution * e.approach()).abs() <= 1e-13 * scale);
        prop_assert!(r.impulse_t <= 1e-15 * r.impulse_n);
        Ok(())
    });
}

#[test]
fn coulomb_stays_in_the_cone_and_opposes_sliding() {
    let (slid, stuck) = (std::cell::Cell::new(0), std::cell::Cell::new(0));
    check(3000, |e| {
        let r = respond(&e, make(FrictionLaw::Coulomb).as_ref()).unwrap();
        prop_assert!(r.impulse_t <= (e.friction * (1.0 + 1e-12) + 1e-15) * r.impulse_n);
        let plain = respond(&Encounter { friction: 0.0, ..e }, make(FrictionLaw::Coulomb).as_ref()).unwrap();
        prop_assert!((r.impulse_n - plain.impulse_n).abs() <= 1e-12 * plain.impulse_n);
        let out = both_after(&e, &r);
        if out.approach() < -1e-9 && !r.fallback {
            let v = out.relative_velocity();
            let t = v - e.normal * v.dot(e.normal);
            let j = r.impulse_on_a + e.normal * r.impulse_n;
            let sliding = t.length() > 1e-9;
            // Sliding after the impact: the impulse is on the cone and straight against what sliding is left.
            if sliding {
                slid.set(slid.get() + 1);
                prop_assert!((r.impulse_t - e.friction * r.impulse_n).abs() <= 1e-9 * r.impulse_n);
                prop_assert!((j.dot(t) + j.length() * t.length()).abs() <= 1e-7 * j.length() * t.length());
            } else {
                stuck.set(stuck.get() + 1);
            }
        }
        Ok(())
    });
    assert!(slid.get() > 300 && stuck.get() > 300, "{} {}", slid.get(), stuck.get());
}

/// With e = 0 and full friction the rough law stops the contact point: what is left of the approach is round-off, which must
/// not make the guard step in.
#[test]
fn guards_do_not_answer_to_round_off() {
    check(1000, |e| {
        let e = Encounter { friction: 1.0, restitution: 0.0, ..e };
        let r = respond(&e, make(FrictionLaw::Rough).as_ref()).unwrap();
        prop_assert!(!r.fallback);
        let scale = e.relative_velocity().length() + e.a.v.length() + e.b.v.length();
        let k = e.response(r.impulse_on_a).length();
        prop_assert!(both_after(&e, &r).relative_velocity().length() <= 1e-11 * (scale + k));
        Ok(())
    });
}

#[test]
fn galilei_invariance() {
    let shift = Vec3::new(3.0, -2.0, 1.0);
    let laws = [FrictionLaw::Frictionless, FrictionLaw::Velocity, FrictionLaw::Rough, FrictionLaw::Coulomb];
    check(1500, |e| {
        if e.has_immovable() {
            return Ok(());
        }
        let mut moved = e;
        moved.a.v += shift;
        moved.b.v += shift;
        for law in laws {
            let (r, s) = (respond(&e, make(law).as_ref()).unwrap(), respond(&moved, make(law).as_ref()).unwrap());
            let error = (r.impulse_on_a - s.impulse_on_a).length() / r.impulse_on_a.length();
            // Guards may tip over where the law's own impulse leaves the pair at rest to round-off.
            prop_assert!(error < 1e-9 || r.fallback != s.fallback && e.restitution < 1e-9, "{law:?} {error}");
        }
        Ok(())
    });
}

#[test]
fn the_momentum_law_depends_on_the_frame() {
    let mut e = Encounter {
        a: round(1.0, 0.4, Vec3::new(1.0, 0.5, 0.0), Vec3::ZERO, Vec3::X),
        b: round(5.0, 2.0, Vec3::new(-1.0, 0.0, 0.2), Vec3::ZERO, -Vec3::X),
        normal: Vec3::X,
        friction: 0.2,
        restitution: 1.0,
        persistent: false,
    };
    let law = make(FrictionLaw::Kurtenbach);
    let first = respond(&e, law.as_ref()).unwrap();
    e.a.v += Vec3::new(3.0, -2.0, 1.0);
    e.b.v += Vec3::new(3.0, -2.0, 1.0);
    let second = respond(&e, law.as_ref()).unwrap();
    assert!(!first.fallback && !second.fallback);
    assert!((first.impulse_on_a - second.impulse_on_a).length() > 0.1 * first.impulse_on_a.length());
}

fn scaled(p: &Party, length: Real, mass: Real) -> Party {
    let inertia = 1.0 / (mass * length * length);
    let c = p.inverse_inertia.c;
    Party {
        mass: p.mass * mass,
        inverse_mass: p.inverse_mass / mass,
        inverse_inertia: Mat3::from_columns(c[0] * inertia, c[1] * inertia, c[2] * inertia),
        v: p.v * length,
        w: p.w,
        r: p.r * length,
        angular_momentum: p.angular_momentum * (mass * length * length),
    }
}

#[test]
fn powers_of_two_pass_through_exactly() {
    check(300, |e| {
        for k in [-40, -7, 1, 40] {
            let length = libm::ldexp(1.0, k);
            for mass in [1.0, length * length * length] {
                let big = Encounter { a: scaled(&e.a, length, mass), b: scaled(&e.b, length, mass), ..e };
                // Speeds alone: angular velocity scales too, inertia stays.
                let faster = |p: &Party| Party {
                    v: p.v * length,
                    w: p.w * length,
                    angular_momentum: p.angular_momentum * length,
                    ..*p
                };
                let fast = Encounter { a: faster(&e.a), b: faster(&e.b), ..e };
                for law in LAWS {
                    let law = make(law);
                    let r = respond(&e, law.as_ref()).unwrap();
                    let s = respond(&big, law.as_ref()).unwrap();
                    prop_assert_eq!(s.impulse_on_a, r.impulse_on_a * (length * mass), "{:?}", law);
                    prop_assert_eq!(s.energy_change, r.energy_change * (length * length * mass));
                    prop_assert_eq!(s.fallback, r.fallback);
                    prop_assert_eq!(respond(&fast, law.as_ref()).unwrap().impulse_on_a, r.impulse_on_a * length);
                }
            }
        }
        Ok(())
    });
}

#[test]
fn without_friction_every_law_is_the_frictionless_one() {
    check(500, |e| {
        let e = Encounter { friction: 0.0, ..e };
        let plain = respond(&e, make(FrictionLaw::Frictionless).as_ref());
        for law in LAWS {
            prop_assert_eq!(respond(&e, make(law).as_ref()), plain, "{:?}", law);
        }
        Ok(())
    });
}

#[test]
fn contact_memory_switches_the_heuristics_friction_off() {
    check(500, |e| {
        let e = Encounter { persistent: true, ..e };
        let plain = respond(&e, make(FrictionLaw::Frictionless).as_ref());
        for law in LAWS {
            let made = make(law);
            let same = respond(&e, made.as_ref()) == plain;
            prop_assert!(same || !made.needs_contact_memory(), "{:?}", law);
        }
        Ok(())
    });
    assert!(make(FrictionLaw::Kurtenbach).needs_contact_memory() && !make(FrictionLaw::Rough).needs_contact_memory());
}

#[test]
fn hot_loop_gives_the_bits_of_the_frictionless_law() {
    check(1000, |e| {
        let still =
            |p: &Party| Party { inverse_inertia: Mat3::ZERO, w: Vec3::ZERO, angular_momentum: Vec3::ZERO, ..*p };
        let e = Encounter { a: still(&e.a), b: still(&e.b), ..e };
        let j = frictionless_spheres(e.normal, [e.a.v, e.b.v], [e.a.inverse_mass, e.b.inverse_mass], e.restitution);
        match (j, respond(&e, make(FrictionLaw::Frictionless).as_ref())) {
            (Some(j), Some(r)) => prop_assert_eq!(e.normal * -j, r.impulse_on_a),
            (None, None) => {}
            (j, r) => prop_assert!(false, "{:?} {:?}", j, r),
        }
        Ok(())
    });
}

#[test]
fn what_cannot_be_answered_is_left_alone() {
    let ball = round(1.0, 0.4, Vec3::X, Vec3::ZERO, Vec3::X);
    let e =
        Encounter { a: ball, b: Party::IMMOVABLE, normal: Vec3::X, friction: 0.5, restitution: 1.0, persistent: false };
    for law in LAWS {
        let law = make(law);
        let both_fixed = Encounter { a: Party::IMMOVABLE, ..e };
        assert_eq!(respond(&both_fixed, law.as_ref()), None);
        assert_eq!(respond(&Encounter { normal: -Vec3::X, ..e }, law.as_ref()), None, "separating");
        assert_eq!(respond(&Encounter { normal: Vec3::Y, ..e }, law.as_ref()), None, "neither");
        for bad in [Real::NAN, Real::INFINITY, 1e308] {
            let mut wild = e;
            wild.a.v = Vec3::new(bad, bad, 1.0);
            wild.a.mass = 1e3;
            wild.a.inverse_mass = 1e-3;
            assert_eq!(respond(&wild, law.as_ref()), None, "{law:?} {bad}");
        }
        // A contact at the centre of mass: no direction of the spin's momentum, but an answer.
        for tiny in [0.0, 1e-200, 1e-30] {
            let mut central = e;
            central.a.r = Vec3::X * tiny;
            central.a.w = Vec3::new(3.0, 2.0, 1.0);
            central.a.angular_momentum = central.a.w * 0.4;
            central.b = round(2.0, 0.5, -Vec3::X, Vec3::Y, -Vec3::X * tiny);
            let r = respond(&central, law.as_ref()).unwrap();
            assert!(r.impulse_on_a.is_finite());
        }
    }
    assert_eq!(frictionless_spheres(Vec3::X, [Vec3::X, Vec3::ZERO], [0.0, 0.0], 1.0), None);
    assert_eq!(frictionless_spheres(Vec3::X, [Vec3::ZERO, Vec3::X], [1.0, 1.0], 1.0), None);
}

/// Kane's and Painleve's bodies: a rod that strikes obliquely, elastic, with much friction. Newton's hypothesis on the whole
/// impulse would gain energy; these laws must not.
#[test]
fn eccentric_rod_with_much_friction_gains_nothing() {
    let mut gained_by_newton = 0;
    for step in 1..180 {
        let angle = Real::from(step) * std::f64::consts::PI / 180.0;
        let (s, c) = mrtphys::math::sin_cos(angle);
        // A thin rod of length 2 and mass 1, touching the floor with its lower end; inertia 1/3, next to none about itself.
        let r = Vec3::new(-c, -s, 0.0);
        let rod = Party {
            mass: 1.0,
            inverse_mass: 1.0,
            inverse_inertia: Mat3::diagonal(Vec3::splat(3.0)),
            v: Vec3::new(2.0, -1.0, 0.0),
            w: Vec3::ZERO,
            r,
            angular_momentum: Vec3::ZERO,
        };
        for friction in [0.3, 1.0, 5.0, 1e6] {
            let e = Encounter {
                a: rod,
                b: Party::IMMOVABLE,
                normal: -Vec3::Y,
                friction,
                restitution: 1.0,
                persistent: false,
            };
            let r = respond(&e, make(FrictionLaw::Coulomb).as_ref()).unwrap();
            let (before, after) = energies(&e, r.impulse_on_a);
            assert!(after <= before * (1.0 + 1e-14), "{step} {friction}");
            let out = both_after(&e, &r);
            assert!(out.approach() <= 1e-14);
            // Newton's hypothesis on the impulse of a sliding contact: along d = -N - mu t, so long that v12'.N = -v12.N.
            let d = Vec3::new(-friction, 1.0, 0.0);
            let take = e.response(d).dot(-e.normal);
            let j = d * (2.0 * e.approach() / take);
            if take <= 0.0 {
                continue;
            }
            gained_by_newton += i32::from(energies(&e, j).1 > before * (1.0 + 1e-9));
        }
    }
    assert!(gained_by_newton > 0, "the scene must be one in which the naive law fails");
}

#[test]
fn superball_on_the_floor() {
    for (radius, vx, vy) in [(1.0, 1.0, 1.0), (0.3, -2.5, 0.01), (7.0, 1e-3, 4.0)] {
        let j = 0.4 * 2.0 * radius * radius;
        let ball = round(2.0, j, Vec3::new(vx, -vy, 0.0), Vec3::ZERO, Vec3::new(0.0, -radius, 0.0));
        let e = Encounter {
            a: ball,
            b: Party::IMMOVABLE,
            normal: -Vec3::Y,
            friction: 1.0,
            restitution: 1.0,
            persistent: false,
        };
        let r = respond(&e, make(FrictionLaw::Rough).as_ref()).unwrap();
        let out = both_after(&e, &r).a;
        assert!(!r.fallback);
        assert!((out.v - Vec3::new(3.0 / 7.0 * vx, vy, 0.0)).length() < 1e-15 * (vx.abs() + vy), "{:?}", out.v);
        assert!((radius * out.w.z.abs() - 10.0 / 7.0 * vx.abs()).abs() < 1e-15 * vx.abs() * 4.0);
        assert!(out.v.x * out.w.z < 0.0, "it rolls the way it goes");
    }
}

/// Friction turns a grazing wall impact by (67) into a loss that has a closed form.
#[test]
fn printed_wall_law_loses_what_the_closed_form_says() {
    for phi in [0.1, 0.5, 0.9] {
        let ball = round(1.5, 0.2, Vec3::new(0.8, -1.0, 0.3), Vec3::new(0.1, -0.4, 2.0), Vec3::new(0.0, -0.5, 0.0));
        let e = Encounter {
            a: ball,
            b: Party::IMMOVABLE,
            normal: -Vec3::Y,
            friction: phi,
            restitution: 1.0,
            persistent: false,
        };
        let r = respond(&e, make(FrictionLaw::KurtenbachLiteral).as_ref()).unwrap();
        let v = e.relative_velocity();
        let t = v - e.normal * v.dot(e.normal);
        let n = (v - t + t * phi).try_normalize().unwrap();
        let loss = -2.0 * phi * (1.0 - phi) * t.length_squared() / e.inverse_effective_mass(n);
        assert!((r.energy_change - loss).abs() < 1e-14 * loss.abs());
    }
}

/// One-dimensional impact of two masses by the public path; velocities along x.
fn strike(m: [Real; 2], v: [Real; 2]) -> Option<[Real; 2]> {
    let j = frictionless_spheres(Vec3::X, [Vec3::X * v[0], Vec3::X * v[1]], [1.0 / m[0], 1.0 / m[1]], 1.0)?;
    Some([v[0] - j / m[0], v[1] + j / m[1]])
}

/// Galperin's billiard: a wall at the left, a small block, a large one coming in. The number of impacts spells pi.
#[test]
fn pi_billiard_as_impacts_in_sequence() {
    for (k, expected) in [3, 31, 314, 3141, 31415, 314_159].into_iter().enumerate() {
        let heavy = libm::pow(100.0, k as Real);
        // small, large
        let mut v = [0.0, -1.0];
        let mut count = 0;
        loop {
            // The large block is on the right: the pair approaches iff the small one is faster to the right.
            if let Some(out) = strike([1.0, heavy], v) {
                v = out;
            } else if v[0] < 0.0 {
                // Off the wall: the normal from the block to the wall points to the left.
                v[0] += frictionless_spheres(-Vec3::X, [Vec3::X * v[0], Vec3::ZERO], [1.0, 0.0], 1.0).unwrap();
            } else {
                break;
            }
            count += 1;
        }
        assert_eq!(count, expected, "mass ratio 100^{k}");
        let energy = 0.5 * v[0] * v[0] + 0.5 * heavy * v[1] * v[1];
        let drift = energy / (0.5 * heavy) - 1.0;
        assert!(drift.abs() < 1e-15 * (10.0 + Real::from(expected)), "{k}: {drift}");
    }
}

/// Two balls dropped together, the light one on top: sequential elastic impacts send it to ((3M - m)/(M + m))^2 h.
#[test]
fn galilean_cannon() {
    for (ratio, height) in [(3.0, 4.0), (10.0, 6.950_413_223_140_496), (100.0, 8.763_944_711_302_813)] {
        let v = 1.0;
        // The heavy ball has bounced off the floor, the light one is still coming down.
        let up =
            frictionless_spheres(-Vec3::X, [Vec3::X * -v, Vec3::ZERO], [1.0 / ratio, 0.0], 1.0).unwrap() / ratio - v;
        let [_, light] = strike([ratio, 1.0], [up, -v]).unwrap();
        assert!((light * light / (v * v) / height - 1.0).abs() < 1e-12, "{ratio}: {}", light * light);
    }
}
