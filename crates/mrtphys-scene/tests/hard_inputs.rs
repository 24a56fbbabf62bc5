//! Inputs that break parsers: every one is answered with an error that says where, or has a defined meaning.

use mrtphys_scene::scene::{Content, Placement};
use mrtphys_scene::{Diagnostics, LARGEST_TEXT, MOST_VALUES, Scene, Source};
use proptest::prelude::*;
use proptest::test_runner::RngSeed;

fn read(bytes: &[u8]) -> Result<Scene, Diagnostics> {
    Scene::parse(Source::from_bytes("scene.toml", bytes, None)?)
}

#[track_caller]
fn headline(bytes: &[u8]) -> String {
    match read(bytes) {
        Ok(_) => panic!("accepted: {:?}", String::from_utf8_lossy(&bytes[..bytes.len().min(80)])),
        Err(e) => e.first().expect("at least one").headline(),
    }
}

const BODY: &str = "format = 1\n[[body]]\nshape = { kind = 'sphere', radius = 1 }\nposition = ";

/// The x coordinate that a number's text means.
fn number(text: &str) -> Result<f64, String> {
    let scene = read(format!("{BODY}[{text}, 0, 0]\n").as_bytes()).map_err(|e| e.list[0].message.clone())?;
    match &scene.contents[0] {
        Content::Body(b) => match b.placement {
            Placement::Origin(p) => Ok(p.x),
            Placement::CenterOfMass(_) => panic!("a position was given"),
        },
        _ => panic!("a body was given"),
    }
}

#[test]
fn empty_truncated_and_binary() {
    assert_eq!(headline(b""), "scene.toml:1:1: scene: key 'format' is missing");
    assert_eq!(headline(b"\n \t\n# nothing\n"), "scene.toml:1:1: scene: key 'format' is missing");
    assert_eq!(headline(&[0xFF; 64]), "scene.toml:1:1: the text is not UTF-8 (byte 0xFF at offset 0)");
    assert_eq!(
        headline(b"format = 1\nti\xC3tle = 'x'\n"),
        "scene.toml:2:3: the text is not UTF-8 (byte 0xC3 at offset 13)"
    );
    // Columns are characters: a-umlaut is one.
    assert_eq!(
        headline("title = 'ä\u{FFFF}".as_bytes().split_last().expect("bytes").1),
        "scene.toml:1:11: the text is not UTF-8 (byte 0xEF at offset 11)"
    );
    assert_eq!(
        headline(b"\xFF\xFEf\0o\0r\0"),
        "scene.toml:1:1: the text is not UTF-8 (byte 0xFF at offset 0): it looks like UTF-16; save it as UTF-8"
    );
    assert!(headline(b"\0").starts_with("scene.toml:1:1: syntax: "));
    assert!(headline(b"format = 1\ntitle = \"a\0b\"\n").starts_with("scene.toml:2:11: syntax: "));
    assert_eq!(
        headline(b"format = 1\n[[body]]\nshape = { kind = 'sphere', radius"),
        "scene.toml:3:34: syntax: unclosed inline table, expected `}`"
    );
}

/// A text cut at any byte is an error with a place, or a scene.
#[test]
fn truncated_at_every_byte() {
    let text = include_str!("data/interface-example.toml");
    for end in (0..text.len()).filter(|&i| text.is_char_boundary(i)) {
        if let Err(e) = read(&text.as_bytes()[..end]) {
            assert!(e.first().expect("one").place.is_some());
        }
    }
}

#[test]
fn byte_order_mark_and_line_ends_of_windows() {
    let text = "\u{FEFF}format = 1\r\ntitle = 'x'\r\n[[light]]\r\ndirection = [0, 0, 0]\r\n";
    let e = read(text.as_bytes()).expect_err("a direction of zero");
    assert_eq!(e.list[0].headline(), "scene.toml:4:13: light 0: direction: a direction must not be [0, 0, 0]");
    // The carriage return is not shown.
    assert!(e.to_string().ends_with("4 | direction = [0, 0, 0]\n  |             ^^^^^^^^^"), "{e}");
    assert_eq!(headline("\u{FEFF}forma = 1".as_bytes()).split(':').nth(2), Some("1"));
    assert!(read("\u{FEFF}format = 1\r\ntitle = 'x'\r\n".as_bytes()).is_ok());
}

#[test]
fn depth_of_a_million() {
    let n = 1_000_000;
    for text in [
        format!("format = 1\ntitle = {}", "[".repeat(n)),
        format!("format = 1\ntitle = {}{}", "[".repeat(n), "]".repeat(n)),
        format!("format = 1\ntitle = {}", "{a=".repeat(n)),
        format!("format = 1\n{}a = 1", "a.".repeat(n)),
        format!("format = 1\n[{}a]\n", "a.".repeat(n)),
    ] {
        let e = read(text.as_bytes()).expect_err("too deep");
        assert!(e.to_string().contains("recurs"), "{}", e.first().expect("one").headline());
    }
}

#[test]
fn sizes_are_bounded() {
    let large = vec![b'#'; LARGEST_TEXT as usize + 1];
    assert_eq!(
        headline(&large),
        "scene.toml: the scene text is larger than 64 MiB; put many bodies into a [[body_table]]"
    );
    assert!(read(&large[1..]).is_err_and(|e| e.list[0].message.contains("'format' is missing")));
    let many = format!("format = 1\ntitle = [{}]", "1,".repeat(MOST_VALUES));
    assert!(headline(many.as_bytes()).contains("more than 5000000 values"));
    let file = "format = 1\n[[lattice]]\ncount = [10000000, 10000000, 10000000]\nbody = [ { shape = { kind = 'sphere', radius = 1 } } ]\n";
    assert_eq!(
        headline(file.as_bytes()),
        "scene.toml:2:1: scene: 18446744073709551615 bodies are more than the 10000000 that a scene may hold"
    );
    let two = "format = 1\n".to_string()
        + &"[[lattice]]\ncount = [200, 200, 200]\nbody = [ { shape = { kind = 'sphere', radius = 1 } } ]\n".repeat(2);
    assert!(headline(two.as_bytes()).contains("16000000 bodies are more than"));
}

#[cfg(unix)]
#[test]
fn an_endless_file_is_read_up_to_the_limit() {
    let e = Scene::load(std::path::Path::new("/dev/zero")).expect_err("no scene");
    assert!(e.list[0].message.contains("larger than 64 MiB"));
    let e = Scene::load(std::path::Path::new("/nonexistent/scene.toml")).expect_err("no file");
    assert!(e.list[0].message.starts_with("cannot read: "));
}

#[test]
fn numbers() {
    let bits = |text: &str| number(text).map(f64::to_bits);
    assert_eq!(bits("-0"), Ok(0.0_f64.to_bits()));
    assert_eq!(bits("-0.0"), Ok((-0.0_f64).to_bits()));
    // Below the smallest number: correctly rounded to zero.
    assert_eq!(bits("1e-400"), Ok(0));
    assert_eq!(bits("5e-324"), Ok(1));
    assert_eq!(bits("0.1"), Ok(0.1_f64.to_bits()));
    assert_eq!(bits("1_000.5"), Ok(1000.5_f64.to_bits()));
    assert_eq!(bits("9007199254740993"), Ok(9_007_199_254_740_992.0_f64.to_bits()));
    // Exactly between two numbers, plus one digit a hundred thousand places further on.
    let tie = format!("9007199254740993.{}1", "0".repeat(100_000));
    assert_eq!(bits(&tie), Ok(9_007_199_254_740_994.0_f64.to_bits()));
    let refused = |text: &str, message: &str| {
        assert_eq!(number(text), Err(format!("body 'body0': position: {message}")), "{text}")
    };
    refused("1e999", "the number 1e999 is too large");
    refused("-1e999", "the number -1e999 is too large");
    refused("nan", "nan is not a finite number");
    refused("-inf", "-inf is not a finite number");
    refused("0x", "'0x' is not a number");
    refused(
        &"9".repeat(100_000),
        "the integer 999999999999999999999999... does not fit into 64 bits; a number of this size needs a decimal point or an exponent",
    );
    refused(&format!("{}.0", "9".repeat(100_000)), "the number 999999999999999999999999... is too large");
    refused("true", "expected a number, found a truth value");
    refused("1979-05-27", "expected a number, found a date");
    // A decimal comma makes four coordinates, or no TOML at all.
    refused("0,5", "expected 3 numbers [x, y, z], found 4");
    assert_eq!(
        headline(b"format = 1\n[simulation]\nseconds = 0,5\n"),
        "scene.toml:3:12: syntax: unexpected key or value, expected newline, `#`"
    );
}

#[test]
fn duplicates() {
    assert_eq!(headline(b"format = 1\nformat = 1\n"), "scene.toml:2:1: syntax: duplicate key");
    assert_eq!(headline(b"format = 1\n[medium]\n[medium]\n"), "scene.toml:3:2: syntax: duplicate key");
    assert_eq!(headline(b"format = 1\n[material.a]\n[material.a]\n"), "scene.toml:3:11: syntax: duplicate key");
}

#[test]
fn names() {
    let named = |name: &str| headline(format!("format = 1\n[[boundary]]\nname = {name}\n").as_bytes());
    assert_eq!(named("''"), "scene.toml:3:8: boundary 'boundary0': name: a name must not be empty");
    assert_eq!(
        named("\"a\\u0000b\""),
        "scene.toml:3:8: boundary 'boundary0': name: a name must not contain control characters"
    );
    assert_eq!(
        named("\"a\\nb\""),
        "scene.toml:3:8: boundary 'boundary0': name: a name must not contain control characters"
    );
    let long = format!("'{}'", "x".repeat(257));
    assert_eq!(
        named(&long),
        "scene.toml:3:8: boundary 'boundary0': name: a name must not be longer than 256 characters"
    );
}

#[test]
fn files_outside_of_the_folder() {
    for file in [
        "../../etc/passwd",
        "/etc/passwd",
        "a/../../b.csv",
        "..",
        ".",
        "",
        "a//b.csv",
        "./b.csv",
        "c:/b.csv",
        "\\\\\\\\server\\\\b.csv",
        "a\\u0000.csv",
        "http://example.org/b.csv",
    ] {
        let text = format!("format = 1\n[[body_table]]\nfile = \"{file}\"\n");
        let message = headline(text.as_bytes());
        assert!(message.starts_with("scene.toml:3:8: body_table 'body_table0': file: '"), "{message}");
        assert!(message.ends_with("' is not a file in the scene's folder or below"), "{message}");
    }
    // A scene without a folder names no files at all.
    assert_eq!(
        headline(b"format = 1\n[[body_table]]\nfile = 'b.csv'\n"),
        "scene.toml:2:1: body_table 'body_table0': file: this scene has no folder, so it can name no files"
    );
}

fn is_answered(bytes: &[u8]) {
    match read(bytes) {
        // What is read can be described again in full: no part of it is missing.
        Ok(scene) => assert!(!format!("{scene:?}").is_empty()),
        Err(e) => {
            assert!(!e.list.is_empty() && e.list.len() <= 20);
            for d in &e.list {
                let text = d.to_string();
                assert!(!text.is_empty());
                if let Some(p) = &d.place {
                    assert!(p.line >= 1 && p.column >= 1 && p.width >= 1 && p.shown_from <= p.column);
                }
            }
        }
    }
}

/// Pieces of scenes, put together at random, reach deeper than random bytes.
fn pieces() -> impl Strategy<Value = String> {
    let piece = prop::sample::select(vec![
        "format = 1\n",
        "[[body]]\n",
        "[[lattice]]\n",
        "[[boundary]]\n",
        "[simulation]\n",
        "[medium]\n",
        "[camera]\n",
        "[material.a]\n",
        "[[force_field]]\n",
        "[[flow_field]]\n",
        "[[light]]\n",
        "[[body_table]]\n",
        "kind = ",
        "'sphere'",
        "'box'",
        "'point'",
        "'plane'",
        "name = ",
        "'a'",
        "\n",
        "shape = ",
        "{",
        "}",
        "[",
        "]",
        ",",
        "radius = ",
        "points = ",
        "count = ",
        "body = ",
        "mass = ",
        "1",
        "-1",
        "0.5",
        "1e999",
        "nan",
        "0x",
        "[1, 2, 3]",
        "[[0,0,0],[1,0,0],[0,1,0],[0,0,1]]",
        "faces = ",
        "[[0, 1, 2]]",
        "true",
        "\"",
        "'",
        "#",
        "ä",
        "\r\n",
        "\u{FEFF}",
        "position = ",
        "material = ",
        "fps = ",
        "seed = ",
        ".",
        "=",
        "only = ",
        "['a', 'b']",
        "shape = { kind = 'sphere', radius = 0.1 }\n",
        "position = [0, 0, 0]\n",
    ]);
    prop::collection::vec(piece, 0..40).prop_map(|p| p.concat())
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 600, failure_persistence: None, rng_seed: RngSeed::Fixed(1998), ..ProptestConfig::default() })]

    #[test]
    fn any_bytes_are_answered(bytes in prop::collection::vec(any::<u8>(), 0..400)) {
        is_answered(&bytes);
    }

    #[test]
    fn any_text_is_answered(text in "\\PC{0,200}") {
        is_answered(text.as_bytes());
    }

    #[test]
    fn any_pieces_of_scenes_are_answered(text in pieces()) {
        is_answered(text.as_bytes());
        is_answered(format!("format = 1\n{text}").as_bytes());
    }

    #[test]
    fn a_damaged_scene_is_answered(at in 0_usize..4000, byte in any::<u8>()) {
        let mut bytes = include_bytes!("data/interface-example.toml").to_vec();
        let at = at % bytes.len();
        bytes[at] = byte;
        is_answered(&bytes);
    }

    #[test]
    fn a_number_is_read_as_the_nearest_double(x in any::<f64>().prop_filter("in range", |x| x.abs() <= 1e150)) {
        prop_assert_eq!(number(&format!("{x:?}")).map(f64::to_bits), Ok(x.to_bits()));
        prop_assert_eq!(number(&format!("{x:.40e}")).map(f64::to_bits), Ok(x.to_bits()));
    }
}
