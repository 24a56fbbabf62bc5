//! The raw formulas, without guards, against the reference cases.

use super::kurtenbach::{KurtenbachLiteral, thesis_direction, weighted_velocity};
use super::{Encounter, Party};
use crate::math::{Mat3, Real, Vec3};
use serde_json::Value;

fn vec3(v: &Value) -> Vec3 {
    let at = |i: usize| v[i].as_f64().unwrap();
    Vec3::new(at(0), at(1), at(2))
}

fn party(case: &Value, i: u8) -> Party {
    let get = |name: &str| &case[format!("{name}{i}")];
    let Some(mass) = get("m").as_f64() else {
        return Party::IMMOVABLE;
    };
    let j = get("J").as_f64().unwrap();
    let w = vec3(get("w"));
    Party {
        mass,
        inverse_mass: 1.0 / mass,
        inverse_inertia: Mat3::diagonal(Vec3::splat(1.0 / j)),
        v: vec3(get("v")),
        w,
        r: vec3(get("r")),
        angular_momentum: w * j,
    }
}

#[test]
fn unguarded_formulas_match_the_reference() {
    let text = include_str!("../../tests/vectors/impacts.json");
    let file: Value = serde_json::from_str(text).unwrap();
    let cases = file["cases"].as_array().unwrap();
    assert_eq!(cases.len(), 134);
    let (mut compared, mut left_out) = (0, 0);
    for case in cases {
        let e = Encounter {
            a: party(case, 1),
            b: party(case, 2),
            normal: vec3(&case["N1"]),
            friction: case["phi"].as_f64().unwrap(),
            restitution: 1.0,
            persistent: false,
        };
        let wall = e.has_immovable();
        let margin = case["guarded"]["frictionless"]["margin"].as_f64().unwrap();
        let ill = margin <= 1e-7 * e.relative_velocity().length();
        for (column, expected) in case["dp1_unguarded"].as_object().unwrap() {
            let direction = match column.as_str() {
                "frictionless" => Some(e.normal),
                "thesis" => thesis_direction(&e),
                "velocity" => weighted_velocity(&e).try_normalize(),
                "effective" => super::rough::direction(&e),
                "literal" | "inf_literal" => None,
                "wrong_orientation" | "noabs" => continue,
                other => panic!("unknown column {other}"),
            };
            let is_literal = column.ends_with("literal");
            assert!(!is_literal || wall == (column == "inf_literal"));
            let found =
                if is_literal { KurtenbachLiteral::printed(&e) } else { direction.and_then(|n| e.impulse_along(n)) };
            if ill {
                left_out += 1;
                continue;
            }
            let (found, expected) = (found.unwrap(), vec3(expected));
            let error = (found - expected).length() / expected.length();
            assert!(error < 1e-9, "{} {column}: {found:?} {expected:?}", case["kind"]);
            compared += 1;
        }
        let close = |a: Real, b: &Value| (a - b.as_f64().unwrap()).abs() <= 1e-12 * a.abs();
        assert!(close(e.inverse_effective_mass(e.normal), &case["B"]));
        assert!(ill || close(e.approach(), &case["approach"]) || e.approach().abs() < 1e-3);
    }
    assert!(compared > 580 && left_out < 60, "{compared} {left_out}");
}
