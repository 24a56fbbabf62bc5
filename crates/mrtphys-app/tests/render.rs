//! `mrtphys render`, with the real program and, where there is one, the real graphics driver.
#![cfg(feature = "view")]

mod common;
use common::{Done, Folder};
use std::io::Write;
use std::process::{Command, Stdio};
use std::time::{Duration, Instant};

/// Whether pictures can be drawn here. If not, the test says so, past the capture of the test harness.
fn can_draw(test: &str) -> bool {
    match mrtphys_view::Renderer::new() {
        Ok(_) => true,
        Err(e) => {
            let _ = writeln!(std::io::stderr(), "SKIPPED {test}: {e}");
            false
        }
    }
}

fn bytes(folder: &Folder, name: &str) -> Vec<u8> {
    std::fs::read(folder.path(name)).unwrap()
}

#[test]
fn a_png_a_gif_an_mp4_and_a_folder_are_written() {
    if !can_draw("a_png_a_gif_an_mp4_and_a_folder_are_written") {
        return;
    }
    let folder = Folder::with_scenes("render");
    let size = "--size 160x120";
    folder.run(&format!("render gas.toml -o a.png {size} --at 0.25")).expect(0);
    let png = bytes(&folder, "a.png");
    assert_eq!(&png[..8], b"\x89PNG\r\n\x1a\n");
    assert_eq!((&png[16..20], &png[20..24]), (&160u32.to_be_bytes()[..], &120u32.to_be_bytes()[..]));
    folder.run(&format!("render gas.toml -o b.png {size} --at 0.25 --threads 1")).expect(0);
    assert_eq!(png, bytes(&folder, "b.png"));
    folder.run(&format!("render gas.toml -o b.png {size} --at 0.26")).expect(0);
    assert_ne!(png, bytes(&folder, "b.png"), "time passes between two steps too");
    folder.run(&format!("render gas.toml -o f.gif {size} --seconds 0.2")).expect(0);
    let gif = bytes(&folder, "f.gif");
    assert!(gif.starts_with(b"GIF89a") && gif.ends_with(&[0x3b]));
    let said = folder.run(&format!("render gas.toml -o f.mp4 {size} --frames 7 --mode hidden-line")).expect(0);
    assert!(said.out.contains("7 pictures of 160 x 120"), "{}", said.out);
    assert_eq!(&bytes(&folder, "f.mp4")[4..8], b"ftyp");
    // 0.2 s in slow motion, at 10 a second: ten pictures
    folder.run(&format!("render gas.toml -o film {size} --seconds 0.2 --fps 10 --speed 0.2 --dark --fit")).expect(0);
    let mut names: Vec<_> = std::fs::read_dir(folder.path("film")).unwrap().map(|e| e.unwrap().file_name()).collect();
    names.sort();
    assert_eq!((names.len(), names[9].to_str()), (10, Some("frame_00009.png")));
    folder.run(&format!("render gas.toml -o film {size}")).refused(&["film", "already"]);
}

#[test]
fn every_option_of_the_look_changes_the_picture() {
    if !can_draw("every_option_of_the_look_changes_the_picture") {
        return;
    }
    let folder = Folder::with_scenes("render-look");
    let mut seen: Vec<(Vec<u8>, &str)> = Vec::new();
    let same_as_default = ["", "--illumination blinn", "--color-by own"];
    for options in [
        "",
        "--illumination blinn",
        "--color-by own",
        "--illumination ambient",
        "--illumination lambert",
        "--illumination phong",
        "--color-by speed",
        "--color-by spin",
        "--color-by kinetic-energy",
        "--color-by kind",
        "--color-by contacts",
        "--no-shadows",
        "--no-walls",
        "--no-marks",
        "--mode flat",
        "--dark",
    ] {
        let said = folder.run(&format!("render gas.toml -o a.png --size 160x120 --at 0.25 {options}")).expect(0);
        assert_eq!(said.out.contains("colors:"), options.contains("color-by") && !options.contains("own"), "{options}");
        let png = bytes(&folder, "a.png");
        let like = seen.iter().find(|(other, _)| *other == png).map(|(_, name)| *name);
        assert_eq!(like, same_as_default[1..].contains(&options).then_some(""), "{options}");
        seen.push((png, options));
    }
}

#[test]
fn stderr_is_the_program_s_own() {
    if !can_draw("stderr_is_the_program_s_own") {
        return;
    }
    let folder = Folder::with_scenes("render-stderr");
    let mut command = folder.command();
    command.args("render gas.toml -o a.png --size 32x32 --quiet".split_whitespace());
    command.env_remove("XDG_RUNTIME_DIR").env_remove("NODEVICE_SELECT");
    let done = Done::from(command.output().unwrap()).expect(0);
    assert_eq!(done.err, "", "no library complains of a missing XDG_RUNTIME_DIR");
}

#[test]
fn what_colors_mean_is_said() {
    if !can_draw("what_colors_mean_is_said") {
        return;
    }
    let folder = Folder::new("render-colors");
    let ball = "[[body]]\nshape = { kind = \"sphere\", radius = 0.1 }\n";
    let fall = "[[force_field]]\nkind = \"uniform\"\nacceleration = [0, -2, 0]\n";
    let text = format!("format = 1\n{fall}{ball}position = [0, 0, 0]\nvelocity = [0, -3, 0]\n");
    folder.put("fall.toml", &text);
    let said = folder.run("render fall.toml -o a.png --size 32x32 --color-by speed").expect(0);
    assert!(said.out.contains("colors: speed from 0 (#440154) to 5 m/s (#"), "{}", said.out);
    // After two seconds 7 m/s: above the 5 of the beginning.
    let said = folder.run("render fall.toml -o a.gif --size 32x32 --color-by speed --seconds 2 --fps 4").expect(0);
    assert!(said.out.contains("to 10 m/s (#") && said.out.contains("), at the beginning to 5 m/s\n"), "{}", said.out);
    // Thrown up, it is slow on top: the colors stay.
    folder.put("rise.toml", &text.replace("-3", "3"));
    let said = folder.run("render rise.toml -o b.gif --size 32x32 --color-by speed --seconds 1.5 --fps 4").expect(0);
    assert!(said.out.contains("to 5 m/s (#") && !said.out.contains("beginning"), "{}", said.out);
    let said = folder.run("render fall.toml -o a.png --size 32x32 --color-by kind").expect(0);
    assert!(said.out.contains("colors: kind of shape: sphere #0072b2\n"), "{}", said.out);
}

#[test]
fn what_cannot_be_drawn_is_refused_before_anything_is_written() {
    let folder = Folder::with_scenes("render-refused");
    folder.run("render gas.toml -o a.jpg").refused(&["a.jpg", ".png", ".gif", ".mp4"]);
    folder.run("render a.gif -o a.gif").refused(&["same file"]);
    folder.run("render gas.toml -o a.png --size 10").refused(&["WIDTHxHEIGHT"]);
    folder.run("render gas.toml -o a.png --mode phongg").refused(&["did you mean 'phong'?"]);
    folder.run("render gas.toml -o a.png --illumination blin").refused(&["did you mean 'blinn'?"]);
    folder.run("render gas.toml -o a.png --color-by sped").refused(&["did you mean 'speed'?"]);
    folder.run("render gas.toml -o a.png --seconds 1").refused(&["--seconds", "--at"]);
    folder.run("render gas.toml -o a.gif --seconds 100000000").refused(&["pictures"]);
    folder.run("render gas.toml").refused(&["--output"]);
    if can_draw("what_cannot_be_drawn_is_refused_before_anything_is_written") {
        folder.run("render gas.toml -o a.mp4 --size 101x100").refused(&["even"]);
        folder.run("render gas.toml -o a.gif --fps 60").refused(&["50 pictures a second"]);
    }
    assert!(!folder.path("a.png").exists() && !folder.path("a.gif").exists() && !folder.path("a.mp4").exists());
}

#[cfg(unix)]
#[test]
fn an_interrupted_film_is_whole() {
    if !can_draw("an_interrupted_film_is_whole") {
        return;
    }
    let folder = Folder::with_scenes("render-interrupted");
    let mut command = folder.command();
    command.args("render gas.toml -o long.gif --size 160x120 --seconds 10000 --quiet".split_whitespace());
    let mut child = command.stdout(Stdio::piped()).stderr(Stdio::piped()).spawn().unwrap();
    let part = folder.path(&format!(".long.gif.{}.part", child.id()));
    let start = Instant::now();
    let wait = |what: &str| {
        assert!(start.elapsed() < Duration::from_secs(120), "waited in vain: {what}");
        std::thread::sleep(Duration::from_millis(10));
    };
    while std::fs::metadata(&part).map_or(0, |m| m.len()) < 100_000 {
        wait("the first pictures");
    }
    assert!(Command::new("kill").args(["-INT", &child.id().to_string()]).status().unwrap().success());
    while child.try_wait().unwrap().is_none() {
        wait("the end");
    }
    Done::from(child.wait_with_output().unwrap()).expect(130);
    let gif = bytes(&folder, "long.gif");
    assert!(gif.len() > 100_000 && gif.starts_with(b"GIF89a") && gif.ends_with(&[0x3b]) && !part.exists());
}
