//! Reports, summaries and the length of runs.

mod common;
use common::{Folder, numbers};
use serde_json::Value;

/// The members of the contract, in its order.
const MEMBERS: &[&str] = &[
    "format",
    "scene",
    "algorithm",
    "broad_phase",
    "friction_law",
    "impact",
    "threads",
    "time",
    "frames",
    "steps",
    "wall_seconds",
    "bodies",
    "energy",
    "initial_energy",
    "ledger",
    "momentum",
    "angular_momentum",
    "counters",
    "per_step",
    "largest_step",
    "state_hash",
];

fn keys(value: &Value) -> Vec<&str> {
    value.as_object().unwrap().keys().map(String::as_str).collect()
}

#[test]
fn a_report_has_the_members_of_the_contract_in_its_order() {
    let folder = Folder::with_scenes("members");
    let r = folder.report("rain.toml --threads 2");
    assert_eq!(&keys(&r)[..MEMBERS.len()], MEMBERS);
    assert_eq!(r["format"], 1);
    assert_eq!(r["scene"], "rain.toml");
    let names = ["fixed-step", "sorted-grid", "kurtenbach", "sequential"];
    assert_eq!([&r["algorithm"], &r["broad_phase"], &r["friction_law"], &r["impact"]], names);
    assert_eq!((r["threads"].as_u64(), r["time"].as_f64(), r["frames"].as_u64()), (Some(2), Some(1.0), Some(60)));
    assert_eq!(r["steps"], 480);
    assert!(r["wall_seconds"].as_f64().unwrap() > 0.0);
    let energies = ["linear", "rotational", "potential", "total"];
    assert_eq!(keys(&r["energy"]), energies);
    assert_eq!(keys(&r["initial_energy"]), energies);
    let ledger =
        "friction restitution drag work_of_fields position_correction integration moving_bodies user created_removed";
    assert_eq!(keys(&r["ledger"]), ledger.split(' ').collect::<Vec<_>>());
    assert_eq!(&keys(&r["counters"])[..5], ["sphere_tests", "detect_calls", "impacts", "undecided", "missed"]);
    assert!(r["counters"]["missed"].is_null());
    assert_eq!(keys(&r["per_step"]), ["sphere_tests", "detect_calls"]);
    let hash = r["state_hash"].as_str().unwrap();
    assert!(hash.len() == 32 && hash.chars().all(|c| c.is_ascii_hexdigit()), "{hash}");
    assert!(r.get("interrupted").is_none() && r.get("stopped").is_none());
    // An end that is not one would be told here.
    assert_eq!(r["title"], "");
}

#[test]
fn bodies_stand_in_scene_order_with_their_state() {
    let folder = Folder::with_scenes("bodies");
    let r = folder.report("rain.toml --seconds 0");
    let bodies = r["bodies"].as_array().unwrap();
    let names: Vec<&str> = bodies.iter().map(|b| b["name"].as_str().unwrap()).collect();
    assert_eq!(names, ["a \"quoted\", name", "low", "rock"]);
    let members = ["name", "kind", "mass", "position", "orientation", "velocity", "angular_velocity"];
    assert_eq!(keys(&bodies[0]), members);
    assert_eq!(bodies[0]["kind"], "sphere");
    assert_eq!([&bodies[1]["mass"], &bodies[2]["mass"]], [&serde_json::json!(2.0), &serde_json::json!("infinite")]);
    assert_eq!(numbers(&bodies[1]["position"]), [0.05, 0.5, 0.0]);
    assert_eq!(numbers(&bodies[0]["velocity"]), [0.3, 0.0, 0.0]);
    assert_eq!(numbers(&bodies[0]["orientation"]), [0.0, 0.0, 0.0, 1.0]);
    assert_eq!((r["steps"].as_u64(), r["frames"].as_u64(), r["time"].as_f64()), (Some(0), Some(0), Some(0.0)));
}

#[test]
fn energies_are_those_of_the_bodies_and_the_ledger_explains_their_change() {
    let folder = Folder::with_scenes("energies");
    let r = folder.report("rain.toml");
    let of = |name: &str| r["energy"][name].as_f64().unwrap();
    let (mut linear, mut potential) = (0.0, 0.0);
    for body in r["bodies"].as_array().unwrap() {
        let Some(mass) = body["mass"].as_f64() else { continue };
        let v = numbers(&body["velocity"]);
        linear += 0.5 * mass * (v[0] * v[0] + v[1] * v[1] + v[2] * v[2]);
        potential += mass * 9.80665 * numbers(&body["position"])[1];
    }
    assert!((of("linear") - linear).abs() <= 1e-13 * linear, "{} {linear}", of("linear"));
    assert!((of("potential") - potential).abs() <= 1e-13 * potential, "{} {potential}", of("potential"));
    assert!((of("total") - of("linear") - of("rotational") - of("potential")).abs() < 1e-13 * of("total"));
    let entries: Vec<f64> = r["ledger"].as_object().unwrap().values().map(|v| v.as_f64().unwrap()).collect();
    let change = of("total") - r["initial_energy"]["total"].as_f64().unwrap();
    assert!(change < -0.1, "the scene loses energy: {change}");
    let scale = r["initial_energy"]["total"].as_f64().unwrap() + entries.iter().map(|e| e.abs()).sum::<f64>();
    assert!((change - entries.iter().sum::<f64>()).abs() <= 1e-12 * scale, "{change} {entries:?}");
}

#[test]
fn runs_are_as_long_as_they_are_told() {
    let folder = Folder::with_scenes("length");
    let reached = |args: &str| {
        let r = folder.report(&format!("gas.toml {args}"));
        (r["steps"].as_u64().unwrap(), r["frames"].as_u64().unwrap(), r["time"].as_f64().unwrap())
    };
    assert_eq!(reached(""), (240, 30, 0.5), "the scene's own");
    assert_eq!(reached("--frames 3"), (24, 3, 0.05));
    assert_eq!(reached("--frames 0"), (0, 0, 0.0));
    assert_eq!(reached("--seconds 0.1"), (48, 6, 0.1));
    assert_eq!(reached("--seconds 0.0123"), (6, 1, 0.0123));
    assert_eq!(reached("--seconds 0.35 --fps 10 --steps-per-frame 3"), (11, 4, 0.35));
    // 1/3 s is 160 steps, though 0.333... x 480 is not 160 in doubles for every rounding
    assert_eq!(reached("--seconds 0.3333333333333333"), (160, 20, 160.0 / 480.0));
    assert_eq!(reached("--frames 7 --fps 30 --steps-per-frame 1"), (7, 7, 7.0 / 30.0));
}

#[test]
fn without_a_length_of_its_own_a_scene_runs_ten_seconds() {
    let folder = Folder::new("ten");
    folder.put("one.toml", "format = 1\n[[body]]\nshape = { kind = \"sphere\", radius = 1.0 }\nvelocity = [1, 0, 0]\n");
    let r = folder.report("one.toml");
    assert_eq!((r["time"].as_f64(), r["steps"].as_u64()), (Some(10.0), Some(4800)));
    // straight on, without accumulated round-off worth a name
    assert!((numbers(&r["bodies"][0]["position"])[0] - 10.0).abs() < 1e-11);
    assert_eq!(r["bodies"][0]["name"], "body0");
}

#[test]
fn the_result_is_the_same_for_any_threads_and_broad_phase() {
    let folder = Folder::with_scenes("same");
    let r = folder.report("gas.toml");
    assert!(r["counters"]["impacts"].as_u64().unwrap() > 20, "something happens: {}", r["counters"]);
    let variants = [
        "--threads 1",
        "--threads 2",
        "--threads 8",
        "--broad-phase brute-force",
        "--broad-phase regular-grid",
        "--broad-phase regular-grid:3",
        "--broad-phase adaptive-tree",
        "--broad-phase adaptive-tree:1:5",
        "--broad-phase sorted-grid",
    ];
    for variant in variants {
        let other = folder.report(&format!("gas.toml {variant}"));
        assert_eq!(other["state_hash"], r["state_hash"], "{variant}");
        assert_eq!(other["counters"]["impacts"], r["counters"]["impacts"], "{variant}");
        assert_eq!(other["energy"], r["energy"], "{variant}");
        if let Some(name) = variant.strip_prefix("--broad-phase ") {
            assert!(other["broad_phase"].as_str().unwrap().starts_with(name), "{variant}");
        }
    }
    let tests = |args: &str| folder.report(args)["per_step"]["sphere_tests"].as_f64().unwrap();
    // 27 bodies against each other and against six walls, every step
    assert_eq!(tests("gas.toml --broad-phase brute-force"), 27.0 * 26.0 / 2.0 + 27.0 * 6.0);
    for (seed, same) in [(7, true), (8, false)] {
        let other = folder.report(&format!("gas.toml --seed {seed}"));
        assert_eq!(other["state_hash"] == r["state_hash"], same, "seed {seed}");
        assert_eq!(other["seed"], seed);
    }
}

#[test]
fn options_win_over_the_scene() {
    let folder = Folder::with_scenes("options");
    let rain = folder.report("rain.toml")["state_hash"].clone();
    for law in ["frictionless", "kurtenbach-literal", "velocity", "rough", "coulomb"] {
        let r = folder.report(&format!("rain.toml --friction-law {law}"));
        assert_eq!(r["friction_law"], law);
        assert_ne!(r["state_hash"], rain, "{law}");
    }
    let r = folder.report("gas.toml --impact reflection --frames 1");
    assert_eq!(r["impact"], "reflection");
}

#[test]
fn the_summary_says_what_happened_and_quiet_is_quiet() {
    let folder = Folder::with_scenes("summary");
    let done = folder.run("run rain.toml --quiet --report r.json").expect(0);
    assert_eq!(done.err, "");
    let hash = folder.json("r.json")["state_hash"].as_str().unwrap().to_string();
    for part in [
        "rain.toml",
        "1 s in 60 frames, 480 steps",
        "linear",
        "restitution",
        "unexplained",
        "momentum",
        "steps/s",
        &hash,
    ] {
        assert!(done.out.contains(part), "'{part}' is not in:\n{}", done.out);
    }
    assert!(!done.out.contains("drag"), "lines of the ledger that are zero are left out:\n{}", done.out);
    assert_eq!(folder.files(), ["gas.toml", "r.json", "rain.toml"], "nothing else is left behind");
}

#[test]
fn a_body_that_moves_too_far_in_a_step_is_warned_of() {
    let folder = Folder::new("largest");
    let scene = |speed: f64| {
        format!("format = 1\n[[body]]\nshape = {{ kind = \"sphere\", radius = 0.5 }}\nvelocity = [{speed}, 0, 0]\n")
    };
    folder.put("slow.toml", &scene(0.24 * 480.0));
    folder.put("fast.toml", &scene(0.26 * 480.0));
    assert_eq!(folder.run("run slow.toml --frames 2 --quiet").expect(0).err, "");
    let done = folder.run("run fast.toml --frames 2 --quiet --report r.json").expect(0);
    assert!(done.err.contains("warning") && done.err.contains("0.26") && done.err.contains("unseen"), "{}", done.err);
    assert!((folder.json("r.json")["largest_step"].as_f64().unwrap() - 0.26).abs() < 1e-12);
}

#[test]
fn above_100_000_bodies_the_report_lists_them_only_when_told() {
    let folder = Folder::new("many");
    folder.put(
        "many.toml",
        "format = 1\n[[lattice]]\ncount = [101, 100, 10]\nspeed = 0.0\nmax = [101, 100, 10]\nbody = [ { shape = { kind = \"sphere\", radius = 0.1 } } ]\n",
    );
    let r = folder.report("many.toml --frames 1");
    assert_eq!((r.get("bodies"), r["body_count"].as_u64()), (None, Some(101_000)));
    let r = folder.report("many.toml --frames 0 --bodies");
    assert_eq!(r["bodies"].as_array().unwrap().len(), 101_000);
    assert_eq!(r["bodies"][100_999]["name"], "lattice0[100,99,9]");
}
