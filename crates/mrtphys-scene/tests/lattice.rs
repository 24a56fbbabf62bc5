//! The contract of lattices: places, turns, and random numbers, against values computed independently (a program in another
//! language, from the description in the manual).

use mrtphys::math::Vec3;
use mrtphys_scene::scene::Content;
use mrtphys_scene::{Loaded, Scene};

fn build(text: &str) -> Loaded {
    Scene::from_text("scene.toml", text).and_then(|s| s.build()).unwrap_or_else(|e| panic!("{e}"))
}

const JITTERED: &str = "format = 1
[[lattice]]
count = [1, 1, 3]
jitter = 0.5
speed = 2
spin = 3
body = [ { shape = { kind = 'sphere', radius = 0.125 } }, { shape = { kind = 'sphere', radius = 0.0625 } } ]
";

type Row = ([f64; 3], [f64; 3], [f64; 3]);

fn rows(loaded: &Loaded) -> Vec<Row> {
    let row = |id| {
        let b = loaded.world.body(id).expect("a body");
        (b.position.to_array(), b.velocity.to_array(), b.angular_velocity.to_array())
    };
    loaded.world.bodies().map(row).collect()
}

#[test]
fn jitter_speed_and_spin_are_drawn_in_the_documented_order() {
    let expected: [Row; 3] = [
        (
            [0.6168545595807068, 0.592664268559332, 0.150006287647241],
            [1.2005695677860928, -1.5375279095872645, 0.4411809607702147],
            [-2.9504687875216837, 0.490522518232208, -0.23264048007055826],
        ),
        (
            [0.7003284107937352, 0.562236870999385, 0.47541428711569395],
            [1.2817687518373304, -1.4881806382276987, -0.37734235757143875],
            [-1.8594722122094025, 0.7284861198177536, -2.238676185886191],
        ),
        (
            [0.680775764445577, 0.5416991092658909, 0.8429207067033964],
            [1.0599328928725837, 1.6940140607122416, 0.0828168142105043],
            [2.964658286546839, -0.45884259597691085, -0.016270099149354567],
        ),
    ];
    let found = rows(&build(JITTERED));
    for (f, e) in found.iter().zip(&expected) {
        assert_eq!((f.0, f.1), (e.0, e.1));
        // The angular velocity goes through the angular momentum.
        for (a, b) in f.2.iter().zip(e.2) {
            assert!((a - b).abs() <= 4.0 * f64::EPSILON * b.abs());
        }
    }
    assert_eq!(found.len(), 3);
}

#[test]
fn nothing_is_drawn_for_what_is_zero() {
    let text = JITTERED
        .replace("jitter = 0.5", "jitter = 0")
        .replace("spin = 3", "spin = 0")
        .replace("speed = 2", "speed = 1");
    let text = text.replace("[[lattice]]", "[simulation]\nseed = 2\n[[lattice]]");
    let first = rows(&build(&text))[0];
    assert_eq!(first, ([0.5, 0.5, 0.5 / 3.0], [0.8622633310608714, 0.12081364169121281, 0.4918394167704711], [0.0; 3]));
}

#[test]
fn kinds_take_turns_and_k_runs_fastest() {
    let loaded = build(&JITTERED.replace("[1, 1, 3]", "[2, 3, 4]").replace("jitter = 0.5", "jitter = 0"));
    let mut n = 0;
    for i in 0..2 {
        for j in 0..3 {
            for k in 0..4 {
                let id = loaded.names.bodies()[n];
                assert_eq!(loaded.names.body_name(id), Some(format!("lattice0[{i},{j},{k}]")));
                let body = loaded.world.body(id).expect("a body");
                let radius = if (i + j + k) % 2 == 0 { 0.125 } else { 0.0625 };
                assert_eq!(body.shape.bounding_sphere().radius, radius);
                let center =
                    Vec3::new((f64::from(i) + 0.5) / 2.0, (f64::from(j) + 0.5) / 3.0, (f64::from(k) + 0.5) / 4.0);
                assert!((body.position - center).max_abs() < 1e-15);
                n += 1;
            }
        }
    }
}

#[test]
fn seeds_follow_the_place_unless_a_lattice_has_its_own() {
    let one = |seed: &str| {
        format!("[[lattice]]\ncount = [1, 1, 1]\n{seed}body = [ {{ shape = {{ kind = 'sphere', radius = 0.1 }} }} ]\n")
    };
    let velocity = |text: &str, n: usize| rows(&build(text))[n].1;
    let scene = |seed: u64, lattices: &[&str]| {
        format!("format = 1\n[simulation]\nseed = {seed}\n{}", lattices.iter().map(|s| one(s)).collect::<String>())
    };
    let second = velocity(&scene(4, &["", ""]), 1);
    assert_eq!(second, velocity(&scene(5, &[""]), 0));
    assert_eq!(second, velocity(&scene(99, &["seed = 5\n"]), 0));
    assert_ne!(second, velocity(&scene(4, &["", ""]), 0));
}

#[test]
fn full_jitter_never_makes_an_overlap() {
    let mut moved = 0;
    for seed in 0..20 {
        let text = format!(
            "format = 1\n[simulation]\nseed = {seed}\n[[boundary]]\n[[lattice]]\ncount = [4, 4, 4]\njitter = 1\nbody = [ {{ shape = {{ kind = 'sphere', radius = 0.1 }} }}, {{ shape = {{ kind = 'box', size = [0.1, 0.1, 0.1] }} }} ]\n"
        );
        let loaded = &mut build(&text);
        assert!(loaded.world.overlaps().is_empty());
        moved += rows(loaded).iter().filter(|r| (r.0[0] * 4.0).fract() != 0.5).count();
    }
    assert!(moved > 19 * 64);
}

/// Lattice points, velocities and spins are scaled exactly with a power of two.
#[test]
fn scaling_by_a_power_of_two_is_exact() {
    let scene = build(JITTERED).scene;
    let Content::Lattice(l) = &scene.contents[0] else { panic!("a lattice") };
    let k = (2.0_f64).powi(-37);
    let scaled = mrtphys_scene::scene::LatticeDesc { min: l.min * k, max: l.max * k, speed: l.speed * k, ..l.clone() };
    for (a, b) in l.points(1, &[0.125, 0.0625]).zip(scaled.points(1, &[0.125 * k, 0.0625 * k])) {
        assert_eq!((a.center * k, a.velocity * k, a.angular_velocity), (b.center, b.velocity, b.angular_velocity));
    }
}
