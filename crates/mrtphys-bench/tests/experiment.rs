//! The experiment: its counts against the thesis, its files complete and well-formed.

use mrtphys_bench::experiment::csv::{self, Table};
use mrtphys_bench::experiment::measure::{self, Measured, Patience, Which};
use mrtphys_bench::experiment::methods::Method;
use mrtphys_bench::experiment::scenes::Arena;
use mrtphys_bench::experiment::{plan, run};
use std::path::{Path, PathBuf};
use std::time::Duration;

const ONCE: Patience = Patience { time: Duration::ZERO, most: 1 };

fn steps(arena: Arena, method: Method, steps: u32) -> Measured {
    measure::all_steps(arena, method, steps, ONCE).unwrap()
}

#[test]
fn brute_force_makes_the_thesiss_tests_in_every_step() {
    // Footnote 6 of the thesis: (11 m + m^2) / 2; 133888 for 512 bodies.
    for n in 2..=8u32 {
        let m = u64::from(n).pow(3);
        let found = steps(Arena::Cube { n }, Method::Spheres, 16);
        assert_eq!(found.sphere_tests, 16 * (11 * m + m * m) / 2);
    }
    assert_eq!(steps(Arena::Cube { n: 8 }, Method::Spheres, 1).sphere_tests, 133_888);
}

#[test]
fn methods_differ_in_tests_and_agree_in_contacts() {
    for arena in [Arena::Cube { n: 5 }, Arena::Clusters { n: 8, edge: 12.0 }] {
        let brute = steps(arena, Method::Spheres, 64);
        assert!(brute.contacts > 0);
        for method in [Method::Tree, Method::DeepTree, Method::Grid, Method::Sorted] {
            let other = steps(arena, method, 64);
            assert_eq!(other.contacts, brute.contacts, "{method:?}");
            assert!(other.sphere_tests < brute.sphere_tests / 2, "{method:?}");
            assert!(other.detect_calls <= brute.detect_calls, "{method:?}");
        }
        let nothing = steps(arena, Method::Nothing, 64);
        assert_eq!((nothing.sphere_tests, nothing.detect_calls, nothing.contacts), (0, 0, 0));
    }
}

#[test]
fn windows_see_the_steps_of_the_whole_run() {
    let arena = Arena::Cube { n: 4 };
    // A window as long as the run is the run, but for the step that warms up the grid.
    let whole = Which::Windows { steps: 0, windows: 1, each: 24 };
    let several = Patience { time: Duration::from_secs(60), most: 3 };
    let cases = [(Method::Spheres, whole), (Method::Grid, whole)];
    let found = measure::in_windows(arena, &cases, several).unwrap();
    let (brute, first) = (steps(arena, Method::Spheres, 24), steps(arena, Method::Grid, 1));
    let grid = steps(arena, Method::Grid, 25);
    assert_eq!(
        (found[0].detect_calls, found[0].contacts, found[0].shown),
        (brute.detect_calls, brute.contacts, brute.shown)
    );
    assert_eq!(found[1].sphere_tests, grid.sphere_tests - first.sphere_tests);
    assert_eq!((found[0].repetitions, found[1].repetitions, found[1].steps), (3, 3, 24));
    // Two windows of two steps each in 16 steps begin after 4 and after 12.
    let apart = [(Method::Spheres, Which::Windows { steps: 16, windows: 2, each: 2 })];
    let counts = |n| steps(arena, Method::Spheres, n).detect_calls;
    let expected = counts(6) - counts(4) + counts(14) - counts(12);
    assert_eq!(measure::in_windows(arena, &apart, ONCE).unwrap()[0].detect_calls, expected);
}

struct Folder(PathBuf);

impl Folder {
    fn new(name: &str) -> Folder {
        let path = std::env::temp_dir().join(format!("mrtphys-experiment-{name}-{}", std::process::id()));
        let _ = std::fs::remove_dir_all(&path);
        Folder(path)
    }

    fn run(&self, more: &[&str]) -> Result<(), String> {
        let folder = self.0.to_str().unwrap();
        let args: Vec<String> = [&["--quiet", "-o", folder], more].concat().into_iter().map(String::from).collect();
        run(&args)
    }

    fn read(&self, name: &str) -> String {
        std::fs::read_to_string(self.0.join(name)).unwrap()
    }

    fn table(&self, name: &str) -> Table {
        Table::read(&self.0.join(name)).unwrap()
    }
}

impl Drop for Folder {
    fn drop(&mut self) {
        let _ = std::fs::remove_dir_all(&self.0);
    }
}

const FIGURES: [&str; 6] =
    ["figure6.svg", "figure7.svg", "figure8.svg", "figure9.svg", "clusters.svg", "clusters-edge.svg"];

#[test]
fn a_quick_run_writes_everything() {
    let folder = Folder::new("quick");
    folder.run(&["--quick"]).unwrap();
    let expected = |cubes: bool| -> usize {
        let stages = plan::quick().stages;
        stages.iter().filter(|s| matches!(s.arena, Arena::Cube { .. }) == cubes).map(|s| s.cases.len()).sum()
    };
    let (counts, speed, clusters) =
        (folder.table("counts.csv"), folder.table("speed.csv"), folder.table("clusters.csv"));
    assert_eq!(counts.header, csv::COUNTS);
    assert_eq!(speed.header, csv::SPEED);
    assert_eq!(clusters.header, csv::CLUSTERS);
    assert_eq!(
        (counts.rows.len(), speed.rows.len(), clusters.rows.len()),
        (expected(true), expected(true), expected(false))
    );
    check_rows(&counts, &speed);
    for name in FIGURES {
        check_figure(&folder.read(name), name);
    }
    let page = folder.read("index.html");
    balanced(&page[page.find("<html").unwrap()..], "index.html");
    for word in ["133888", "1642", "472", "2014", "What can be compared", "Clusters"] {
        assert!(page.contains(word), "{word}");
    }
    assert_eq!(page.matches("<svg").count(), FIGURES.len());
    for foreign in ["src=", "href=", "<script", "@import"] {
        assert!(!page.contains(foreign), "the page is not self-contained: {foreign}");
    }
}

/// Every number is one, and those that are made of others are.
fn check_rows(counts: &Table, speed: &Table) {
    for row in &counts.rows {
        let of = |column| counts.number(row, column).unwrap_or_else(|| panic!("{column}: {row:?}"));
        assert!(counts.method(row).is_some());
        assert_eq!(of("bodies"), of("n").powi(3));
        assert_eq!(of("sphere_tests_per_step"), of("sphere_tests") / of("steps"));
        assert_eq!(of("detect_calls_per_step"), of("detect_calls") / of("steps"));
        if counts.text(row, "method") == "bSphere" {
            let m = of("bodies");
            assert_eq!(of("sphere_tests_per_step"), (11.0 * m + m * m) / 2.0);
        }
    }
    for (row, count) in speed.rows.iter().zip(&counts.rows) {
        let of = |column| speed.number(row, column).unwrap_or_else(|| panic!("{column}: {row:?}"));
        assert_eq!(row[..6], count[..6]);
        assert!((of("fps") * of("frame_ms") / 1e3 - 1.0).abs() < 0.05, "{row:?}");
        assert!((1.0 - 1.0 / of("slowdown") - of("loss_percent") / 100.0).abs() < 1e-3, "{row:?}");
    }
}

/// Well-formed, and every place in it is a number within the picture.
fn check_figure(svg: &str, name: &str) {
    balanced(svg, name);
    assert!(!svg.contains("NaN") && !svg.contains("inf"), "{name}");
    assert!(svg.contains("<polyline"), "{name} has no line");
    let size = |key: &str| -> f64 {
        let from = svg.find(key).unwrap() + key.len();
        svg[from..].split('"').next().unwrap().parse().unwrap()
    };
    let (width, height) = (size(" width=\""), size(" height=\""));
    for points in svg.split("points=\"").skip(1) {
        for pair in points.split('"').next().unwrap().split(' ') {
            let (x, y) = pair.split_once(',').unwrap();
            let (x, y): (f64, f64) = (x.parse().unwrap(), y.parse().unwrap());
            assert!((0.0..=width).contains(&x) && (0.0..=height).contains(&y), "{name}: {pair}");
        }
    }
}

/// Every element is closed by its like.
fn balanced(text: &str, name: &str) {
    let mut open: Vec<&str> = Vec::new();
    for part in text.split('<').skip(1) {
        let (tag, after) = part.split_once('>').unwrap_or_else(|| panic!("{name}: '<{part}' is not closed"));
        assert!(!after.contains('>'), "{name}: stray '>' after <{tag}>");
        let word = tag.split([' ', '\n']).next().unwrap();
        if let Some(closed) = tag.strip_prefix('/') {
            assert_eq!(open.pop(), Some(closed), "{name}");
        } else if !tag.ends_with('/') && word != "meta" {
            open.push(word);
        }
    }
    assert!(open.is_empty(), "{name}: {open:?}");
}

#[test]
fn what_was_measured_can_be_drawn_again_as_far_as_it_came() {
    let folder = Folder::new("draw");
    std::fs::create_dir_all(&folder.0).unwrap();
    let put = |name: &str, header: &[&str], rows: &[Vec<String>]| {
        let mut writer = csv::Writer::create(&folder.0.join(name), header).unwrap();
        rows.iter().for_each(|row| writer.row(row).unwrap());
    };
    let one = steps(Arena::Cube { n: 3 }, Method::Grid, 8);
    put("counts.csv", &csv::COUNTS, &[csv::counts_row(&one)]);
    put("speed.csv", &csv::SPEED, &[]);
    put("clusters.csv", &csv::CLUSTERS, &[]);
    // The run was interrupted while it wrote a row.
    let torn = folder.read("counts.csv") + "thesis/cube-3,3,2";
    std::fs::write(folder.0.join("counts.csv"), torn).unwrap();
    folder.run(&["--draw"]).unwrap();
    for name in FIGURES {
        balanced(&folder.read(name), name);
    }
    let table = folder.table("counts.csv");
    assert_eq!(table.rows, vec![csv::counts_row(&one)]);
    assert_eq!(table.number(&table.rows[0], "sphere_tests"), Some(one.sphere_tests as f64));
    assert!(Path::new(&folder.0.join("index.html")).exists());
}

#[test]
fn counts_are_the_same_each_time() {
    let (a, b) = (Folder::new("first"), Folder::new("second"));
    a.run(&["--quick"]).unwrap();
    b.run(&["--quick", "--threads", "2"]).unwrap();
    assert_eq!(a.read("counts.csv"), b.read("counts.csv"));
}

#[test]
fn wrong_arguments_are_told() {
    for (args, word) in [
        (&["--fast"][..], "--fast"),
        (&["-o"][..], "-o needs a value"),
        (&["--threads", "many"][..], "'many'"),
        (&["--draw", "-o", "/nonexistent/folder"][..], "counts.csv"),
    ] {
        let args: Vec<String> = args.iter().map(|a| a.to_string()).collect();
        let message = run(&args).unwrap_err();
        assert!(message.contains(word), "{message}");
    }
}
