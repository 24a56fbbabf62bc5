//! Commands, options and exit statuses.

mod common;
use common::Folder;

#[test]
fn help_and_version_are_no_errors() {
    let folder = Folder::new("help");
    let version = folder.run("--version").expect(0).out;
    assert!(version.starts_with(&format!("mrtphys {} (f64, {}", env!("CARGO_PKG_VERSION"), std::env::consts::ARCH)));
    let help = folder.run("run --help").expect(0).out;
    for option in ["--seconds", "--frames", "--broad-phase", "--events-only", "--snapshot", "--resume", "--threads"] {
        assert!(help.contains(option), "{option}");
    }
}

#[test]
fn what_is_not_in_this_version_is_refused_by_name() {
    let folder = Folder::with_scenes("later");
    if cfg!(feature = "testbed") {
        folder.run("view gas.toml --fancy").refused(&["--fancy", "--help"]);
    } else {
        folder.run("").refused(&["testbed", "built without", "mrtphys run SCENE"]);
    }
    folder.run("validate").refused(&["'validate'", "not in this version", "mrtphys run"]);
    folder.run("run gas.toml --algorithm rollback").refused(&["'rollback'", "not in this version", "fixed-step"]);
    folder.run("run gas.toml --algorithm event-driven").refused(&["'event-driven'", "not in this version"]);
    folder.run("run gas.toml --broad-phase bvh").refused(&["'bvh'", "not in this version", "sorted-grid"]);
}

#[test]
fn the_experiment_writes_its_folder() {
    let folder = Folder::new("experiment");
    let done = folder.run("experiment --quick -o out/deep --quiet").expect(0);
    assert!(done.out.contains("133888") && done.err.is_empty(), "{}{}", done.out, done.err);
    for file in ["index.html", "counts.csv", "speed.csv", "clusters.csv", "figure6.svg", "figure9.svg", "clusters.svg"]
    {
        assert!(folder.path("out/deep").join(file).is_file(), "{file}");
    }
    assert!(folder.run("experiment --help").expect(0).out.contains("--quick"));
    folder.run("experiment --fast").refused(&["--fast", "--help"]);
}

#[test]
fn wrong_options_end_with_1_and_list_the_choices() {
    let folder = Folder::with_scenes("wrong");
    folder.run("run gas.toml --broad-phase sortedgrid").refused(&[
        "--broad-phase",
        "brute-force",
        "did you mean 'sorted-grid'",
    ]);
    folder.run("run gas.toml --friction-law coulom").refused(&["kurtenbach-literal", "did you mean 'coulomb'"]);
    folder.run("run gas.toml --impact all").refused(&["sequential", "reflection"]);
    folder.run("run gas.toml --broad-phase regular-grid:0").refused(&["1 to 1024"]);
    folder.run("run gas.toml --secnds 3").refused(&["--secnds", "--seconds"]);
    folder.run("run gas.toml --seconds 3 --frames 2").refused(&["--seconds", "--frames"]);
    for seconds in ["-1", "nan", "inf", "1e400", "soon", ""] {
        folder.run_args(["run", "gas.toml", "--seconds", seconds]).refused(&["--seconds"]);
    }
    folder.run("run gas.toml --frames -3").refused(&["--frames", "-3"]);
    folder.run("run gas.toml --frames 99999999999999999").refused(&["2^53"]);
    folder.run("run gas.toml --fps 0").refused(&["--fps"]);
    folder.run("run gas.toml --steps-per-frame 4294967297").refused(&["--steps-per-frame"]);
    folder.run("run gas.toml --threads 100000").refused(&["--threads"]);
    folder.run("run gas.toml --events-only x").refused(&["--events"]);
    folder.run("run").refused(&["SCENE"]);
    folder.run("chek gas.toml").refused(&["chek", "check"]);
}

#[test]
fn a_wrong_scene_is_told_with_line_and_column() {
    let folder = Folder::with_scenes("scene");
    folder.put("typo.toml", "format = 1\n[simulation]\nsecnods = 3\n");
    for command in ["run", "check"] {
        folder.run(&format!("{command} typo.toml")).refused(&["typo.toml:3:1", "secnods", "seconds"]);
        folder.run(&format!("{command} none.toml")).refused(&["none.toml"]);
    }
    folder.put("syntax.toml", "format = 1\n\n[[body]\n");
    folder.run("run syntax.toml").refused(&["syntax.toml:3:"]);
    folder.run("run thesis/no-such-scene").refused(&["thesis/no-such-scene"]);
    // Nothing is written where the scene is wrong.
    folder.run("run typo.toml --report r.json --events e.csv --trajectory t.csv").expect(1);
    assert_eq!(folder.files(), ["gas.toml", "rain.toml", "syntax.toml", "typo.toml"]);
}

#[test]
fn check_tells_what_overlaps() {
    let folder = Folder::with_scenes("check");
    let good = folder.run("check rain.toml").expect(0);
    assert!(good.out.contains("rain.toml") && good.err.is_empty(), "{good:?}");
    let ball = |name: &str, x: f64| {
        format!("[[body]]\nname = \"{name}\"\nshape = {{ kind = \"sphere\", radius = 1.0 }}\nposition = [{x}, 0, 0]\n")
    };
    folder.put("overlap.toml", &format!("format = 1\n{}{}{}", ball("left", 0.0), ball("right", 1.5), ball("far", 4.0)));
    let done = folder.run("check overlap.toml").expect(1);
    let all = done.out + &done.err;
    assert!(all.contains("'left' and 'right' overlap by 0.5 m") && !all.contains("'far'"), "{all}");
    folder.put("touch.toml", &format!("format = 1\n{}{}", ball("left", 0.0), ball("right", 2.0)));
    folder.run("check touch.toml").expect(0);
}

#[test]
fn check_warns_of_bodies_that_move_too_far_in_a_step() {
    let folder = Folder::new("fast");
    folder.put(
        "fast.toml",
        "format = 1\n[[body]]\nname = \"bullet\"\nshape = { kind = \"sphere\", radius = 0.01 }\nvelocity = [100, 0, 0]\n",
    );
    // 100 m/s / 480 steps/s / 0.02 m = 10.4 diameters
    let done = folder.run("check fast.toml").expect(0);
    assert!(done.err.contains("warning") && done.err.contains("'bullet'") && done.err.contains("10.4"), "{done:?}");
}

#[test]
fn the_gallery_runs_by_name_and_the_schema_is_json() {
    let folder = Folder::new("gallery");
    let scenes = folder.run("scenes").expect(0).out;
    let names: Vec<&str> = scenes.lines().filter_map(|l| l.split_whitespace().next()).collect();
    assert!(names.contains(&"thesis/cube-8"), "{scenes}");
    for name in names {
        folder.run(&format!("check {name}")).expect(0);
    }
    let schema: serde_json::Value = serde_json::from_str(&folder.run("schema").expect(0).out).unwrap();
    assert!(schema["properties"]["simulation"].is_object());
    let done = folder.run("run thesis/cube-8 --frames 1 --quiet").expect(0);
    assert!(done.out.contains("thesis/cube-8"));
}

#[cfg(target_os = "linux")]
#[test]
fn a_full_or_closed_standard_output_ends_with_2() {
    use std::process::Stdio;
    let folder = Folder::with_scenes("stdout");
    let full = || std::fs::OpenOptions::new().write(true).open("/dev/full").unwrap();
    for args in ["schema", "scenes", "--version", "check rain.toml"] {
        let child = folder.command().args(args.split(' ')).stdout(full()).output().unwrap();
        let done = common::Done::from(child).expect(2);
        assert!(done.err.contains("standard output"), "{args}: {}", done.err);
    }
    let mut child = folder.command();
    child.args(["run", "rain.toml", "--report", "r.json"]).stdout(Stdio::piped()).stderr(Stdio::piped());
    let mut child = child.spawn().unwrap();
    drop(child.stdout.take());
    let done = common::Done::from(child.wait_with_output().unwrap()).expect(2);
    assert!(done.err.contains("standard output"), "{}", done.err);
    assert_eq!(folder.json("r.json")["steps"], 480, "the report is written nonetheless");
}

#[test]
fn the_help_says_of_every_command_whether_this_version_has_it() {
    let folder = Folder::with_scenes("has");
    let help = folder.run("--help").expect(0).out;
    for command in ["view", "render", "experiment", "validate", "bench", "run", "check", "scenes", "schema"] {
        let line = help.lines().find(|l| l.trim_start().starts_with(&format!("{command} "))).unwrap();
        // Something no command can do, so that none does anything.
        let refused = folder.run(&format!("{command} --no-such-thing"));
        assert_eq!(line.contains("not in this version"), refused.err.contains("not in this version"), "{line}");
    }
}

#[test]
fn numbers_that_are_no_whole_ones_are_refused_in_plain_words() {
    let folder = Folder::with_scenes("whole");
    for (option, range) in [
        ("--frames -1", "from 0 to 18446744073709551615"),
        ("--seed -1", "from 0 to 9223372036854775807"),
        ("--fps 59.94", "from 1 to 1000000000"),
        ("--steps-per-frame 0", "from 1 to 1000000000"),
        ("--threads 1025", "from 0 to 1024"),
    ] {
        folder.run(&format!("run gas.toml {option}")).refused(&["a whole number", range]);
    }
}

#[test]
fn a_run_that_starts_with_overlaps_says_so_and_is_the_same_run() {
    let folder = Folder::with_scenes("overlap");
    let two = |x: f64| {
        format!(
            "format = 1\n[simulation]\nseconds = 0.1\n[[body]]\nname = 'a'\nshape = {{ kind = 'sphere', radius = 0.5 }}\n\
             [[body]]\nname = 'b'\nshape = {{ kind = 'sphere', radius = 0.5 }}\nposition = [{x:?}, 0, 0]\n"
        )
    };
    folder.put("apart.toml", &two(1.0));
    folder.put("deep.toml", &two(0.75));
    let apart = folder.run("run apart.toml --quiet").expect(0);
    assert_eq!(apart.err, "");
    let deep = folder.run("run deep.toml --quiet").expect(0);
    assert!(deep.err.contains("warning: 'a' and 'b' overlap by 0.25 m at the start"), "{}", deep.err);
    assert!(deep.err.contains("mrtphys check deep.toml"), "{}", deep.err);
    // What a run goes on from is no start.
    folder.run("run deep.toml --quiet --frames 2 --snapshot s").expect(0);
    assert_eq!(folder.run("run deep.toml --quiet --resume s").expect(0).err, "");
    let one = "format = 1\n[[boundary]]\nkind = 'plane'\nnormal = [0, 1, 0]\n";
    folder.put("one.toml", one);
    assert_eq!(folder.run("check one.toml").expect(0).out, "one.toml: sound; 0 bodies, 1 boundary\n");
}
