//! The manual's first page does what it says: its scenes are put into files, its commands are run in their order.

mod common;
use common::{Done, Folder};

const PAGE: &str = include_str!("../../../docs/manual/getting-started.md");

/// What happened at each command of the page.
fn follow(folder: &Folder) -> Vec<(String, Done)> {
    let mut done = Vec::new();
    let mut fences = PAGE.split("```");
    fences.next();
    while let (Some(fence), Some(_)) = (fences.next(), fences.next()) {
        let (kind, text) = fence.split_once('\n').expect("a fence has lines");
        match kind {
            // The first line is a comment with the file's name.
            "toml" => folder.put(text.lines().next().and_then(|l| l.strip_prefix("# ")).expect("a name"), text),
            "sh" => done.extend(text.lines().map(|line| {
                let args = line.strip_prefix("mrtphys ").expect("a command of the program");
                (args.to_string(), folder.run(args))
            })),
            other => panic!("nobody checks '{other}'"),
        }
    }
    done
}

fn line<'a>(text: &'a str, start: &str) -> &'a str {
    text.lines().find(|l| l.starts_with(start)).unwrap_or_else(|| panic!("no '{start}' in\n{text}"))
}

#[test]
fn the_first_page_works_as_written() {
    let folder = Folder::new("manual");
    let done = follow(&folder);
    assert!(done.len() > 15, "the page has commands");
    for (args, d) in &done {
        assert_eq!(d.status, Some(0), "mrtphys {args}: {}", d.err);
        let warns = args.ends_with("--steps-per-frame 2");
        assert_eq!(d.err.contains("warning"), warns, "mrtphys {args}: {}", d.err);
    }
    let out = |args: &str| &done.iter().find(|(a, _)| a == args).unwrap_or_else(|| panic!("no {args}")).1.out;

    // The table that the page shows is the one of the run.
    let shown: Vec<&str> = PAGE.lines().skip_while(|l| !l.starts_with("    energy [J]")).take(6).collect();
    let ball = out("run ball.toml --events impacts.csv");
    for l in shown {
        assert!(ball.contains(l.strip_prefix("    ").expect("indented")), "{l}\n{ball}");
    }
    assert!(
        folder.text("impacts.csv").lines().nth(1).is_some_and(|l| l.starts_with("0.42916666666666664,ball,floor,"))
    );
    assert!(line(out("run ball.toml --steps-per-frame 512"), "ledger").contains("-3.1777"));

    let slope = folder.json("slope.json");
    let speed = |i: usize| slope["bodies"][i]["velocity"][0].as_f64().expect("a number");
    let (g, half) = (9.80665, 0.5_f64);
    let expected = [g * (half - 0.3 * 0.75_f64.sqrt()), g * half * 5.0 / 7.0, 0.0];
    for (i, v) in expected.iter().enumerate() {
        assert!((speed(i) - v).abs() < 1e-5, "body {i}: {} is not {v}", speed(i));
    }

    let hash = |args: &str| line(out(args), "state hash").to_string();
    let phases = ["sorted-grid", "adaptive-tree", "regular-grid", "brute-force"];
    let hashes = phases.map(|b| hash(&format!("run gas.toml --broad-phase {b}")));
    assert!(hashes.iter().all(|h| *h == hashes[0]), "{hashes:?}");
    assert_eq!(hash("run gas.toml --resume half.snapshot"), hashes[0]);
}
