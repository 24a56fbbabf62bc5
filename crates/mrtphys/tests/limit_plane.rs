//! The two-sided plane against the reference cases (thesis, section 6.7.1).
//!
//! How the thesis's terms map on the memory of home sides ([`LetBack`]):
//!
//! | thesis | here |
//! |---|---|
//! | side of c - v dt, the reconstructed previous position | home side, settled before the first motion |
//! | `addToNewLetBackList`: the centre has changed sides ("crossed") | [`Passage::Crossed`] |
//! | `inLetBackList` | [`LetBack::has_crossed`] |
//! | crossed this step: reflected, if it moves on away from home | contact with the home half-space, approaching |
//! | on the list and moving back: no second reflection ("letback") | contact, but not approaching: no response |
//! | no longer cutting the plane: off the list ("returned") | [`Passage::Returned`] |
//! | cutting the plane from its own side ("reflect") | contact, approaching, nothing noted |
//!
//! The one difference is intended: a body that is pushed away again while on the list is never brought back by the thesis;
//! here it is reflected like any other.

use mrtphys::bounds::Ball;
use mrtphys::contact::let_back::{LetBack, Passage, Standing};
use mrtphys::def::ContactMode;
use mrtphys::narrow::kinds::Kinds;
use mrtphys::narrow::pair_table::PairTable;
use mrtphys::narrow::{Placed, Touches};
use mrtphys::shape::{LimitPlane, Sphere};
use mrtphys::{Mat3, Vec3};
use serde_json::Value;

const BOUNDARY: u32 = 2;
const SERIAL: u32 = 5;

fn vec3(v: &Value) -> Vec3 {
    Vec3::new(v[0].as_f64().unwrap(), v[1].as_f64().unwrap(), v[2].as_f64().unwrap())
}

/// A sphere and a two-sided plane.
struct Scene {
    table: PairTable,
    kinds: Kinds,
    point: Vec3,
    plane: LimitPlane,
    sphere: Sphere,
    center: Vec3,
    velocity: Vec3,
    memory: LetBack,
}

impl Scene {
    fn new(mode: ContactMode, point: Vec3, normal: Vec3, radius: f64, center: Vec3, velocity: Vec3) -> Scene {
        let kinds = Kinds::standard(mode);
        let (plane, sphere) = (LimitPlane::new(normal).unwrap(), Sphere::new(radius).unwrap());
        let (table, memory) = (kinds.resolve(), LetBack::default());
        let mut scene = Scene { table, kinds, point, plane, sphere, center, velocity, memory };
        assert_eq!(scene.settle(), Passage::Settled);
        scene
    }

    fn ball(&self) -> Ball {
        Ball { center: self.center, radius: self.sphere.radius() }
    }

    fn settle(&mut self) -> Passage {
        let standing = Standing::of(self.point, self.plane.normal(), &self.ball(), self.velocity);
        self.memory.settle(BOUNDARY, SERIAL, &standing)
    }

    /// The normal from the sphere to the plane, where they touch.
    fn contact(&self) -> Option<Vec3> {
        let unbounded = Ball { center: self.point, radius: f64::INFINITY };
        let upright = Mat3::IDENTITY;
        let home_side = self.memory.home_side(BOUNDARY, SERIAL);
        let plane = Placed { shape: &self.plane, position: self.point, rotation: &upright, ball: unbounded, home_side };
        let sphere = Placed {
            shape: &self.sphere,
            position: self.center,
            rotation: &upright,
            ball: self.ball(),
            home_side: 0.0,
        };
        let mut out = Touches::default();
        let id = |n: &str| self.kinds.id(n).unwrap();
        self.table.lookup(id("sphere"), id("plane")).call(&sphere, &plane, &mut out);
        assert!(out.list.len() <= 1);
        out.list.first().map(|t| t.normal)
    }

    /// Moves, detects, responds without friction; returns what the thesis would note.
    fn step(&mut self, dt: f64) -> Option<&'static str> {
        self.center += self.velocity * dt;
        let passage = self.settle();
        let contact = self.contact();
        let towards = contact.filter(|n| n.dot(self.velocity) > 0.0);
        if let Some(n) = towards {
            self.velocity -= n * (2.0 * n.dot(self.velocity));
        }
        match passage {
            Passage::Settled => unreachable!("settled when the scene was made"),
            Passage::Crossed => Some("crossed"),
            Passage::Returned => Some("returned"),
            Passage::Unchanged if towards.is_some() => Some("reflect"),
            Passage::Unchanged => contact.filter(|_| self.memory.has_crossed(BOUNDARY, SERIAL)).map(|_| "letback"),
        }
    }
}

fn assert_near(ours: Vec3, reference: Vec3, what: &str) {
    let scale = 1.0 + reference.length();
    assert!((ours - reference).length() <= 1e-9 * scale, "{what}: {ours:?}, not {reference:?}");
}

#[test]
fn reference_cases_step_by_step() {
    let all: Value = serde_json::from_str(include_str!("vectors/limit_plane.json")).unwrap();
    let mut noted = std::collections::BTreeMap::new();
    for mode in [ContactMode::Exact, ContactMode::Thesis] {
        for (i, case) in all["cases"].as_array().unwrap().iter().enumerate() {
            let number = |key: &str| case[key].as_f64().unwrap();
            let [point, normal, c0, v0] = ["P", "N", "c0", "v0"].map(|k| vec3(&case[k]));
            let mut scene = Scene::new(mode, point, normal, number("r"), c0, v0);
            for (k, expected) in case["steps"].as_array().unwrap().iter().enumerate() {
                scene.velocity = scene.velocity * number("damping_per_step_before_move");
                let event = scene.step(number("dt"));
                let what = format!("case {i}, step {k}");
                let events: Vec<&str> = event.into_iter().collect();
                assert_eq!(Value::from(events.clone()), expected["events"], "{what}");
                assert_eq!(scene.memory.has_crossed(BOUNDARY, SERIAL), expected["on_list"], "{what}");
                assert_near(scene.center, vec3(&expected["c"]), &what);
                assert_near(scene.velocity, vec3(&expected["v_after"]), &what);
                events.iter().for_each(|&e| *noted.entry(e).or_insert(0) += 1);
            }
        }
    }
    let seen: Vec<_> = noted.into_iter().collect();
    assert_eq!(seen, [("crossed", 84), ("letback", 4), ("reflect", 18), ("returned", 84)]);
}

/// What the thesis's list loses: pushed away again before it is back.
#[test]
fn a_body_pushed_away_while_on_the_list_is_brought_back() {
    for side in [1.0, -1.0] {
        let mut s = Scene::new(ContactMode::Thesis, Vec3::ZERO, Vec3::Y, 0.25, Vec3::Y * side, Vec3::Y * (-8.0 * side));
        assert_eq!(s.step(0.25), Some("crossed"));
        assert_eq!(s.velocity, Vec3::Y * (8.0 * side));
        s.velocity = Vec3::Y * (-2.0 * side);
        assert_eq!(s.step(0.25), Some("reflect"));
        assert_eq!(s.velocity, Vec3::Y * (2.0 * side));
        let events: Vec<_> = (0..4).map(|_| s.step(0.25)).collect();
        assert_eq!(events, [Some("letback"), Some("letback"), Some("letback"), Some("returned")]);
        assert_eq!(s.center, Vec3::Y * (0.5 * side));
    }
}
