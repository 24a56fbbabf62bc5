//! The testbed as a user has it: the real program in a window, its buttons clicked, its keys pressed, and what its panel says
//! compared with what `mrtphys run` reports.
#![cfg(feature = "testbed")]

mod common;
mod window;

use common::{Folder, numbers};
use serde_json::Value;
use std::process::Command;
use window::{Window, can_open};

/// What the panel says at some frame is what a run without a window reports of it, bit for bit.
#[track_caller]
fn same(status: &Value, report: &Value) {
    for key in ["time", "steps", "energy", "initial_energy", "ledger", "state_hash"] {
        assert_eq!(status[key], report[key], "{key}");
    }
    for key in ["sphere_tests", "detect_calls", "contacts", "impacts", "wall_impacts", "undecided", "quarantined"] {
        assert_eq!(status["counters"][key], report["counters"][key], "{key}");
    }
}

/// The letters on the panel mean the same numbers.
#[track_caller]
fn says_the_same(status: &Value, report: &Value) {
    let said = |name: &str| status["says"][name].as_str().unwrap_or_else(|| panic!("nothing is said of {name}"));
    let quantity = |name: &str| -> f64 { said(name).split(' ').next().unwrap().parse().unwrap() };
    let count = |name: &str| -> u64 { said(name).replace(' ', "").parse().unwrap() };
    let energy = &report["energy"];
    let pairs = [
        ("energies.linear", energy["linear"].as_f64().unwrap()),
        ("energies.rotation", energy["rotational"].as_f64().unwrap()),
        ("energies.kinetic", energy["linear"].as_f64().unwrap() + energy["rotational"].as_f64().unwrap()),
        ("energies.potential", energy["potential"].as_f64().unwrap()),
        ("energies.total", energy["total"].as_f64().unwrap()),
        ("animation.simulated time", report["time"].as_f64().unwrap()),
    ];
    for (name, right) in pairs {
        assert!((quantity(name) - right).abs() <= 1e-5 * right.abs(), "{name}: '{}' is not {right}", said(name));
    }
    let counters = &report["counters"];
    assert_eq!(count("acceleration.bSphere calls.total"), counters["sphere_tests"]);
    assert_eq!(count("acceleration.detect calls.total"), counters["detect_calls"]);
    assert_eq!(count("acceleration.impacts.total"), counters["impacts"]);
    assert_eq!(count("animation.physical steps"), report["steps"]);
}

#[test]
fn steps_give_what_a_run_gives() {
    if !can_open("steps_give_what_a_run_gives") {
        return;
    }
    let folder = Folder::with_scenes("testbed-steps");
    let mut window = Window::open(&folder, "gas.toml --paused --broad-phase regular-grid:7");
    let start = window.still_at(0);
    assert_eq!(start["running"], false);
    for frame in 1..=6 {
        window.click(if frame % 2 == 0 { "animation.step" } else { "transport.step" });
        window.still_at(frame);
    }
    let report = folder.report("gas.toml --frames 6 --broad-phase regular-grid:7");
    let status = window.still_at(6);
    same(&status, &report);
    says_the_same(&status, &report);
    assert_eq!(status["says"]["transport.code"], "0 h: 0 ': 0 \": 6 f");
    assert_ne!(status["state_hash"], start["state_hash"]);
    let asked = window.click_until("energies.hash", 0.5, |s| s["says"]["energies.hash"].is_string());
    assert_eq!(asked["says"]["energies.hash"], report["state_hash"]);
    window.click("animation.restart");
    let again = window.until("the start", |s| s["steps"] == 0 && s["state_hash"].is_string());
    assert_eq!(again["state_hash"], start["state_hash"]);
    assert_eq!(window.complaints(), "");
}

#[test]
fn the_broad_phase_changes_while_it_runs_and_the_physics_does_not() {
    if !can_open("the_broad_phase_changes_while_it_runs_and_the_physics_does_not") {
        return;
    }
    let folder = Folder::with_scenes("testbed-broad");
    let mut window = Window::open(&folder, "gas.toml --paused");
    window.click("animation.go");
    window.until("it runs", |s| s["running"] == true && s["frame"].as_u64() > Some(2));
    for (control, name) in [("Grid", "regular-grid"), ("Adaptive", "adaptive-tree:4:16"), ("bSphere", "brute-force")] {
        let status = window.click_until(&format!("acceleration.{control}"), 0.5, |s| s["broad_phase"] == name);
        assert_eq!(status["running"], true);
    }
    window.click("transport.go");
    let status = window.until("it stands still", |s| s["running"] == false && s["state_hash"].is_string());
    // It stands still between two steps, which may be within a frame.
    let time = status["time"].as_f64().unwrap();
    let report = folder.report(&format!("gas.toml --seconds {time}"));
    for key in ["time", "steps", "energy", "ledger", "state_hash"] {
        assert_eq!(status[key], report[key], "{key}");
    }
    assert_eq!(status["counters"]["impacts"], report["counters"]["impacts"]);
    let pairs = 27 * 26 / 2 + 27 * 6;
    assert_eq!(
        status["last_step"]["sphere_tests"], pairs,
        "brute force tests all pairs, and all bodies with all walls"
    );
}

#[test]
fn the_frame_rate_begins_the_counter_anew_and_the_steps_per_frame_do_not() {
    if !can_open("the_frame_rate_begins_the_counter_anew_and_the_steps_per_frame_do_not") {
        return;
    }
    let folder = Folder::with_scenes("testbed-rates");
    let mut window = Window::open(&folder, "gas.toml --paused");
    window.keys(&["Right", "Right", "Right"]);
    let before = window.still_at(3);
    let after = window.click_until("animation.steps", 0.1, |s| s["steps_per_frame"] != before["steps_per_frame"]);
    assert_eq!((&after["frame"], &after["steps"]), (&before["frame"], &before["steps"]));
    let after = window.click_until("animation.fps", 0.4, |s| s["fps"] != before["fps"] && s["frame"] == 0);
    assert_eq!(after["steps"], before["steps"], "time goes on");
    assert_eq!(after["time"], before["time"]);
    assert_eq!(after["says"]["animation.code"], "0 h: 0 ': 0 \": 0 f");
}

#[test]
fn keys_steer() {
    if !can_open("keys_steer") {
        return;
    }
    let folder = Folder::with_scenes("testbed-keys");
    let mut window = Window::open(&folder, "gas.toml --paused");
    let start = window.still_at(0);
    window.keys(&["Right"]);
    let first = window.still_at(1);
    window.keys(&["Right"]);
    window.still_at(2);
    window.keys(&["Left"]);
    assert_eq!(window.still_at(1)["state_hash"], first["state_hash"], "back is where it was");
    window.keys(&["End"]);
    window.still_at(2);
    window.keys(&["Home"]);
    assert_eq!(window.still_at(0)["state_hash"], start["state_hash"]);
    window.keys(&["space"]);
    window.until("it runs", |s| s["running"] == true && s["frame"].as_u64() > Some(4));
    window.keys(&["space"]);
    window.until("it stands still", |s| s["running"] == false);
    window.keys(&["r"]);
    window.still_at(0);
    window.keys(&["F1"]);
    window.until("the help", |s| s["windows"].as_array().is_some_and(|w| w.contains(&"help".into())));
    window.keys(&["Escape"]);
    window.until("no help", |s| s["windows"].as_array().is_some_and(Vec::is_empty));
    window.keys(&["t"]);
    window.until("dark colors", |s| s["dark"] == true);
}

#[test]
fn the_mouse_moves_the_viewer() {
    if !can_open("the_mouse_moves_the_viewer") {
        return;
    }
    let folder = Folder::with_scenes("testbed-mouse");
    let mut window = Window::open(&folder, "gas.toml --paused");
    let vector = |s: &Value, name: &str| numbers(&s["camera"][name]);
    let distance = |s: &Value| {
        let parts = vector(s, "eye").into_iter().zip(vector(s, "look_at"));
        parts.map(|(a, b)| (a - b) * (a - b)).sum::<f64>().sqrt()
    };
    // On the background, beside every body.
    let (here, there) = ((120.0, 640.0), (220.0, 600.0));
    let before = window.still_at(0);
    window.drag("1", here, there);
    let orbited = window.until("another eye", |s| vector(s, "eye") != vector(&before, "eye"));
    assert_eq!(vector(&orbited, "look_at"), vector(&before, "look_at"));
    assert!((distance(&orbited) / distance(&before) - 1.0).abs() < 1e-9, "an orbit keeps the distance");
    window.drag("2", here, there);
    let moved = window.until("another point", |s| vector(s, "look_at") != vector(&before, "look_at"));
    assert!((distance(&moved) / distance(&before) - 1.0).abs() < 1e-9);
    window.drag("3", here, (here.0, here.1 - 150.0));
    window.until("another distance", |s| (distance(s) / distance(&before) - 1.0).abs() > 0.1);
    window.keys(&["c"]);
    window.until("the scene's camera", |s| s["camera"] == before["camera"]);
}

#[test]
fn a_film_is_made_from_the_recording() {
    if !can_open("a_film_is_made_from_the_recording") {
        return;
    }
    let folder = Folder::with_scenes("testbed-film");
    let mut window = Window::open(&folder, "gas.toml --paused");
    window.keys(&["Right"; 12]);
    window.still_at(12);
    window.keys(&["ctrl+m"]);
    let shown = window.until("the film's window", |s| s["widgets"]["film.gif"].is_array());
    assert!(shown["says"]["film.missing"].is_null(), "everything that is seen is recorded");
    window.click_until("film.gif", 0.5, |s| s["says"]["film.format"] == "gif");
    window.click("film.save");
    window.name_file("film");
    window.until("the film", |s| {
        s["busy"] == 0
            && s["messages"].as_array().is_some_and(|m| m.iter().any(|m| m.to_string().contains("6 pictures")))
    });
    let gif = std::fs::read(folder.path("film.gif")).unwrap();
    assert_eq!(&gif[..6], b"GIF89a");
    let probe = Command::new("ffprobe")
        .args(["-v", "error", "-count_frames", "-show_entries", "stream=nb_read_frames,width,height", "-of", "csv=p=0"])
        .arg(folder.path("film.gif"))
        .output();
    match probe {
        // 12 frames at 60 a second are 0.2 s, and 6 pictures at 30 a second.
        Ok(probe) => assert_eq!(String::from_utf8_lossy(&probe.stdout).trim(), "1280,720,6"),
        Err(e) => eprintln!("SKIPPED the count of the film's pictures: ffprobe: {e}"),
    }
    a_film_as_mp4(&mut window, &folder);
    assert!(folder.files().iter().all(|f| !f.contains(".part")), "nothing half is left");
}

/// The same film once more, for players of films.
fn a_film_as_mp4(window: &mut Window<'_>, folder: &Folder) {
    window.keys(&["ctrl+m"]);
    window.click_until("film.mp4", 0.5, |s| s["says"]["film.format"] == "mp4");
    window.click("film.save");
    window.name_file("second");
    window.until("the second film", |s| {
        s["busy"] == 0
            && s["messages"]
                .as_array()
                .is_some_and(|m| m.iter().any(|m| m.to_string().contains("second.mp4: 6 pictures")))
    });
    let film = std::fs::read(folder.path("second.mp4")).unwrap();
    assert_eq!(&film[4..8], b"ftyp");
    let shown = "stream=codec_name,pix_fmt,width,height,r_frame_rate,nb_read_frames";
    let probe = Command::new("ffprobe")
        .args(["-v", "error", "-count_frames", "-show_entries", shown, "-of", "csv=p=0"])
        .arg(folder.path("second.mp4"))
        .output();
    match probe {
        Ok(probe) => {
            assert_eq!(String::from_utf8_lossy(&probe.stderr), "", "no picture is damaged");
            assert_eq!(String::from_utf8_lossy(&probe.stdout).trim(), "h264,1280,720,yuv420p,30/1,6");
        }
        Err(e) => eprintln!("SKIPPED what is in the film: ffprobe: {e}"),
    }
}

#[test]
fn it_asks_before_changes_by_hand_are_lost() {
    if !can_open("it_asks_before_changes_by_hand_are_lost") {
        return;
    }
    let folder = Folder::with_scenes("testbed-leaving");
    let ball = "format = 1\n[[body]]\nshape = { kind = \"sphere\", radius = 1 }\n";
    folder.put("ball.toml", ball);
    let mut window = Window::open(&folder, "ball.toml --paused");
    let asks = |s: &Value| s["windows"].as_array().is_some_and(|w| w.contains(&"leaving".into()));
    assert_eq!(window.still_at(0)["bodies"], 1);
    // Into the middle of the picture, where the ball is: its section is opened at the right.
    window.click("viewport");
    window.until("a selected body", |s| s["widgets"]["body"].is_array());
    window.keys(&["Delete"]);
    window.until("no body", |s| s["bodies"] == 0);
    window.keys(&["ctrl+q"]);
    window.until("the question", asks);
    window.keys(&["Escape"]);
    window.until("no question", |s| !asks(s));
    // What is saved is not lost: it ends without a word.
    window.keys(&["ctrl+q"]);
    window.until("the question", asks);
    window.click("leaving.save");
    window.name_file("saved");
    window.until("the file", |s| {
        s["messages"].as_array().is_some_and(|m| m.iter().any(|m| m.to_string().contains("saved")))
    });
    window.keys(&["ctrl+q"]);
    window.ends();
    assert!(folder.files().iter().any(|f| f == "saved.toml"));
}

#[test]
fn a_scene_that_is_edited_is_read_again_and_its_errors_are_shown_with_their_line() {
    if !can_open("a_scene_that_is_edited_is_read_again_and_its_errors_are_shown_with_their_line") {
        return;
    }
    let folder = Folder::with_scenes("testbed-errors");
    let good = folder.text("gas.toml");
    let mut window = Window::open(&folder, "gas.toml");
    let opened = window.until("it runs", |s| s["running"] == true && s["frame"].as_u64() > Some(0));
    assert_eq!(opened["opened"], 0);
    folder.put("gas.toml", &good.replace("count = [3, 3, 3]", "count = [3, 3, 3]\nbodie = 1"));
    let line = good.lines().position(|l| l.starts_with("count")).unwrap() + 2;
    let wrong = window.until("the error", |s| s["trouble"].is_string());
    let text = wrong["trouble"].as_str().unwrap();
    assert!(text.contains(&format!("gas.toml:{line}:1:")) && text.contains("bodie = 1"), "{text}");
    let frame = wrong["frame"].as_u64();
    window.until("the old scene going on", |s| s["frame"].as_u64() > frame && s["opened"] == 0);
    folder.put("gas.toml", &good.replace("A small gas", "A gas that was edited"));
    let fixed = window.until("the new scene", |s| s["opened"] == 1 && s["title"] == "A gas that was edited");
    assert!(fixed["trouble"].is_null());
    assert_eq!(fixed["camera"], wrong["camera"], "the camera stays");
}

#[test]
fn the_gallery_opens_what_is_searched_for() {
    if !can_open("the_gallery_opens_what_is_searched_for") {
        return;
    }
    let folder = Folder::with_scenes("testbed-gallery");
    let mut window = Window::open(&folder, "");
    let first = window.until("a gallery with pictures", |s| s["thumbnails"].as_u64() > Some(10));
    assert_eq!(first["name"], "thesis/cube-8");
    assert!(first["windows"].as_array().unwrap().contains(&"gallery".into()));
    window.click("gallery.search");
    window.type_text("cradle");
    window.until("only one scene", |s| {
        s["widgets"]["gallery.cradle"].is_array() && s["widgets"]["gallery.thesis/cube-2"].is_null()
    });
    window.click("gallery.cradle");
    let opened = window.until("the cradle", |s| s["name"] == "cradle" && s["running"] == true);
    assert!(opened["windows"].as_array().unwrap().is_empty(), "the gallery has done its work");
}

#[test]
fn a_snapshot_goes_there_and_back() {
    if !can_open("a_snapshot_goes_there_and_back") {
        return;
    }
    let folder = Folder::with_scenes("testbed-snapshot");
    folder.run("run gas.toml --frames 5 --snapshot five.snapshot --quiet").expect(0);
    let mut window = Window::open(&folder, "gas.toml --paused --resume five.snapshot");
    window.until("five frames", |s| s["steps"] == 40);
    window.keys(&["Right", "Right"]);
    let status = window.until("seven frames", |s| s["steps"] == 56 && s["state_hash"].is_string());
    same(&status, &folder.report("gas.toml --frames 7"));
    window.click("menu.file");
    window.click("menu.Save snapshot...");
    window.name_file("seven");
    window.until("the snapshot", |s| {
        s["messages"].as_array().is_some_and(|m| m.iter().any(|m| m.to_string().contains("saved")))
    });
    let report = folder.report("gas.toml --frames 9 --resume seven.snapshot");
    assert_eq!(report["state_hash"], folder.report("gas.toml --frames 9")["state_hash"]);
}

#[test]
fn without_a_display_it_says_what_works_instead() {
    let folder = Folder::with_scenes("testbed-none");
    let run = |display: Option<&str>, args: &[&str]| {
        let mut command = folder.command();
        command.args(args).env_remove("WAYLAND_DISPLAY").env_remove("WAYLAND_SOCKET").env_remove("DISPLAY");
        command.env("XDG_CONFIG_HOME", folder.path("config"));
        if let Some(display) = display {
            command.env("DISPLAY", display);
        }
        common::Done::from(command.output().unwrap())
    };
    for (display, args) in [(None, &[][..]), (None, &["view", "gas.toml"]), (Some(":9876"), &["view", "gas.toml"])] {
        let done = run(display, args).expect(1);
        assert!(done.err.contains("display") && done.err.contains("mrtphys run SCENE"), "{}", done.err);
        assert_eq!(done.err.lines().count(), 1, "one sentence: {}", done.err);
    }
    // A scene that is wrong is said to be wrong, display or not.
    folder.put("bad.toml", "format = 1\nbodi = 3\n");
    run(None, &["view", "bad.toml"]).refused(&["bad.toml:2:1", "did you mean 'body'"]);
    run(None, &["view", "no-such-scene"]).refused(&["no-such-scene"]);
    folder.put("no.snapshot", "nonsense");
    run(None, &["view", "gas.toml", "--resume", "no.snapshot"]).refused(&["--resume", "no.snapshot"]);
}
