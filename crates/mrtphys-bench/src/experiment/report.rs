//! The report: our numbers beside the thesis's, and what can be compared.

use super::csv::Table;
use super::figures::{Tables, thesis};
use super::methods::Method;
use crate::plot::{escape, grouped};
use std::fmt::Write;

/// A number with as many digits as say something.
fn short(v: f64) -> String {
    if v.abs() >= 100.0 { grouped(v.round() as i64) } else { format!("{v:.*}", if v.abs() >= 10.0 { 1 } else { 2 }) }
}

/// A column of the row with this method and these values.
fn find(table: &Table, method: Method, keys: &[(&str, f64)], column: &str) -> Option<f64> {
    let fits = |row: &&Vec<String>| {
        table.method(row) == Some(method) && keys.iter().all(|(k, v)| table.number(row, k) == Some(*v))
    };
    table.number(table.rows.iter().find(fits)?, column)
}

/// The measured table as text, for the terminal.
pub fn text(tables: &Tables) -> String {
    let mut out = format!(
        "{:<6} {:>8}  {:<12} {:>6} {:>15} {:>15} {:>9} {:>12} {:>8}\n",
        "n", "bodies", "method", "steps", "tests/step", "special/step", "share %", "frames/s", "loss %"
    );
    for row in &tables.counts.rows {
        let of = |column| tables.counts.text(row, column);
        let number = |column| tables.counts.number(row, column).unwrap_or(f64::NAN);
        let Some(method) = tables.counts.method(row) else { continue };
        let speed = |column| find(&tables.speed, method, &[("n", number("n"))], column).unwrap_or(f64::NAN);
        let _ = writeln!(
            out,
            "{:<6} {:>8}  {:<12} {:>6} {:>15.1} {:>15.1} {:>9.3} {:>12.2} {:>8.2}",
            of("n"),
            of("bodies"),
            method.name(),
            of("steps"),
            number("sphere_tests_per_step"),
            number("detect_calls_per_step"),
            number("special_percent"),
            speed("fps"),
            speed("loss_percent")
        );
    }
    for sentence in verdicts(tables) {
        let _ = writeln!(out, "{sentence}");
    }
    out
}

/// What the numbers say about the thesis's claims. Every sentence is computed.
pub fn verdicts(tables: &Tables) -> Vec<String> {
    let mut out = uniform_verdicts(tables);
    out.extend(cluster_verdicts(&tables.clusters));
    out
}

fn uniform_verdicts(tables: &Tables) -> Vec<String> {
    let at = [("bodies", thesis::BODIES)];
    let tests = |m| find(&tables.counts, m, &at, "sphere_tests_per_step");
    let fps = |m| find(&tables.speed, m, &at, "fps");
    let mut out = Vec::new();
    if let (Some(tree), Some(grid)) = (tests(Method::Tree), tests(Method::Grid)) {
        let holds = if tree > 1.5 * grid { "as the thesis says" } else { "which the thesis's text does not say" };
        let ratio = tree / grid;
        out.push(format!("512 bodies, evenly spread: Adaptive makes {ratio:.2} times the tests of Grid 16, {holds}."));
    }
    if let (Some(tree), Some(grid)) = (fps(Method::Tree), fps(Method::Grid)) {
        let similar = (0.67..1.5).contains(&(tree / grid));
        let holds = if similar { "similar, as the thesis says" } else { "not similar, as the thesis found it" };
        out.push(format!("Its frame rate there is {:.2} times that of Grid 16: {holds}.", tree / grid));
    }
    if let (Some(spheres), Some(grid), Some(sorted)) = (fps(Method::Spheres), fps(Method::Grid), fps(Method::Sorted)) {
        out.push(format!(
            "bSphere reaches {:.2} times the frame rate of Grid 16 at 512 bodies; sorted-grid {:.2} times.",
            spheres / grid,
            sorted / grid
        ));
    }
    out.extend(crossing(&tables.speed));
    out
}

/// Where comparing every pair stops paying.
fn crossing(speed: &Table) -> Option<String> {
    let grid = |n| find(speed, Method::Grid, &[("n", n)], "fps");
    let behind = |row: &&Vec<String>| {
        let (Some(n), Some(fps)) = (speed.number(row, "n"), speed.number(row, "fps")) else { return false };
        speed.method(row) == Some(Method::Spheres) && grid(n).is_some_and(|grid| grid > 1.1 * fps)
    };
    let bodies = speed.rows.iter().filter(behind).filter_map(|r| speed.number(r, "bodies")).reduce(f64::min)?;
    Some(format!("bSphere falls behind Grid 2n from {} bodies on.", short(bodies)))
}

/// Whether the grid loses, by its ratios to the trees of 16 and of 32 levels. Within a tenth, nobody has won.
fn loses(tree: f64, deep: f64) -> &'static str {
    match (tree > 1.1, deep > 1.1) {
        (true, true) => "yes",
        (false, true) => "only to the deeper tree",
        (true, false) => "only to the tree of 16 levels",
        (false, false) if tree < 0.9 && deep < 0.9 => "no, it wins",
        (false, false) => "no, they are even",
    }
}

/// The claim that the thesis never measured: in clustered scenes the grid loses.
fn cluster_verdicts(clusters: &Table) -> Vec<String> {
    let mut out = Vec::new();
    let (mut scenes, mut lost, mut ours) = (0, [[0; 2]; 2], Vec::new());
    for row in clusters.rows.iter().filter(|r| clusters.method(r) == Some(Method::Grid)) {
        let of = |column| clusters.number(row, column).unwrap_or(f64::NAN);
        let keys = [("n", of("n")), ("edge", of("edge"))];
        let value = |method, column| find(clusters, method, &keys, column);
        let ratios = ["sphere_tests_per_step", "broad_us"]
            .map(|c| [Method::Tree, Method::DeepTree].map(|m| Some(of(c) / value(m, c)?)));
        let [[Some(a), Some(b)], [Some(c), Some(d)]] = ratios else { continue };
        scenes += 1;
        for (counts, pair) in lost.iter_mut().zip([[a, b], [c, d]]) {
            *counts = std::array::from_fn(|i| counts[i] + u32::from(pair[i] > 1.1));
        }
        let best = [Method::Spheres, Method::Tree, Method::DeepTree].into_iter().filter_map(|m| value(m, "broad_us"));
        let best = best.fold(of("broad_us"), f64::min);
        ours.extend(value(Method::Sorted, "broad_us").map(|t| t / best));
        out.push(format!(
            "Clusters, {} bodies in a box of {} m: Grid 2n makes {} times the tests of Adaptive and needs {} times its time \
             to find the pairs; against a tree of up to 32 levels {} and {} times. Does the grid lose? In tests: {}; in time: \
             {}.",
            clusters.text(row, "bodies"),
            clusters.text(row, "edge"),
            short(a),
            short(c),
            short(b),
            short(d),
            loses(a, b),
            loses(c, d)
        ));
    }
    if scenes > 0 {
        let [tests, times] = lost;
        let (low, high) = ours.iter().fold((f64::INFINITY, 0.0f64), |(l, h), r| (l.min(*r), h.max(*r)));
        out.push(format!(
            "Of {scenes} clustered scenes, Grid 2n loses by more than a tenth to Adaptive in {} (tests) and {} (time), to a \
             tree of up to 32 levels in {} and {}. sorted-grid needs {} to {} times the time of the best of the others.",
            tests[0],
            times[0],
            tests[1],
            times[1],
            short(low),
            short(high)
        ));
    }
    out
}

const STYLE: &str = "body{font:16px/1.5 Helvetica,Arial,sans-serif;max-width:72em;margin:2em auto;padding:0 1em;color:#222}\
table{border-collapse:collapse;margin:1em 0;font-size:14px}th,td{padding:.15em .7em;text-align:right;border-bottom:1px solid #ddd}\
th{border-bottom:2px solid #222}td.l,th.l{text-align:left}svg{max-width:100%;height:auto}tr.n td{border-top:1px solid #888}";

/// The page, with everything in it.
pub fn html(tables: &Tables, figures: &[(&'static str, String)]) -> String {
    let mut out = format!(
        "<!DOCTYPE html>\n<html lang=\"en\"><head><meta charset=\"utf-8\"><title>mrtphys: comparison of broad phases\
         </title><style>{STYLE}</style></head><body>\n<h1>The thesis's comparison of broad phases, redone</h1>\n\
         <p>Cubes of n³ spheres and tetrahedra between six limits (scenes <code>thesis/cube-2</code> to \
         <code>cube-8</code>, and larger ones by the same rule), 8 frames per second of 8 steps each, ten seconds: 640 \
         steps. mrtphys {}. Counts are the same on every machine; times are of the machine that measured them.</p>\n",
        env!("CARGO_PKG_VERSION")
    );
    out.push_str("<h2>What came out</h2>\n<ul>\n");
    for sentence in verdicts(tables) {
        let _ = writeln!(out, "<li>{}</li>", escape(&sentence));
    }
    out.push_str("</ul>\n<h2>Beside the thesis</h2>\n");
    out.push_str(&beside(&tables.counts));
    out.push_str(COMPARABLE);
    out.push_str("<h2>Figures</h2>\n");
    for (name, svg) in figures {
        let _ = writeln!(out, "<figure id=\"{name}\">\n{svg}</figure>");
    }
    out.push_str("<h2>Tables</h2>\n<h3>Cubes</h3>\n");
    out.push_str(&cubes(tables));
    out.push_str("<h3>Clusters</h3>\n");
    let columns =
        ["bodies", "edge", "method", "broad_phase", "steps", "sphere_tests_per_step", "detect_calls_per_step"];
    out.push_str(&rows(&tables.clusters, &[&columns[..], &["broad_us", "fps"]].concat()));
    out + "</body></html>\n"
}

/// The numbers that the thesis's text gives.
fn beside(counts: &Table) -> String {
    let at = [("bodies", thesis::BODIES)];
    let cell = |method, column| {
        let value: Option<f64> = find(counts, method, &at, column);
        value.map_or_else(|| "not measured".into(), short)
    };
    let mut out = String::from(
        "<table><tr><th class=\"l\">512 bodies</th><th>thesis</th><th>here, mean of all steps</th>\
         <th>here, last steps of the frames</th></tr>\n",
    );
    let (tests, detects) = ("sphere_tests_per_step", "detect_calls_per_step");
    let lines = [
        ("bSphere: bounding-sphere tests", thesis::SPHERES_TESTS, Method::Spheres, tests, "shown_sphere_tests"),
        ("bSphere: special tests", thesis::SPHERES_DETECTS, Method::Spheres, detects, "shown_detect_calls"),
        ("Grid 16: bounding-sphere tests", thesis::GRID_TESTS, Method::Grid, tests, "shown_sphere_tests"),
        ("Grid 16: special tests", thesis::GRID_DETECTS, Method::Grid, detects, "shown_detect_calls"),
    ];
    for (what, theirs, method, mean, shown) in lines {
        let (ours, last) = (cell(method, mean), cell(method, shown));
        let _ = writeln!(
            out,
            "<tr><td class=\"l\">{what}</td><td>{}</td><td>{ours}</td><td>{last}</td></tr>",
            short(theirs)
        );
    }
    let share = |method| cell(method, "special_percent");
    let _ = writeln!(
        out,
        "<tr><td class=\"l\">bSphere: share</td><td>\"2 %\" (2014/133888 = 1.50 %)</td><td>{} %</td><td></td></tr>\n\
         <tr><td class=\"l\">Grid 16: share</td><td>\"29 %\" (472/1642 = 28.7 %)</td><td>{} %</td><td></td></tr></table>",
        share(Method::Spheres),
        share(Method::Grid)
    );
    out
}

const COMPARABLE: &str = "<h2>What can be compared, and what cannot</h2>
<ul>
<li><b>Exactly:</b> the tests of bSphere. They follow from the number of bodies alone, (11 m + m²)/2, whatever the scene.</li>
<li><b>As orders of magnitude:</b> all other counts. The thesis gives neither the sizes, masses and speeds of its bodies nor
their layout, nor the number of objects per cell of its tree. Ours start on a lattice with r = 0.3/n and 0.5 m/s; the tree
holds 4 objects per cell. With bodies placed at random no single radius gives the thesis's three numbers together (1642 tests
need about 0.044, 472 special tests 0.038, 2014 special tests 0.027), so they are no targets.</li>
<li><b>Percentages</b> were rounded to whole ones in the thesis: 29 % of 1642 would be 476, 2 % of 133888 would be 2678; 472 and
2014 are what was measured.</li>
<li><b>Which steps:</b> the thesis takes the mean over 640 steps, but its program showed the last step of each frame only.
Both are in <code>counts.csv</code>; above they stand side by side.</li>
<li><b>Special tests differ between methods</b> although the trajectory is the same to the last bit: the bounding sphere of a
limit (a square of 1 m) reaches deep into the cube, and bSphere asks about all bodies in it; grid and tree use the flat box of
the limit and leave most of them out. sorted-grid compares a body with the limits only where it reaches the plane of one.</li>
<li><b>Frame rates</b> cannot be compared. The thesis's are of a Pentium Pro 200 and include drawing; its text gives no value,
and its figures are lost. \"0 test\" was its program without physics, that is, drawing. Here nothing is drawn: \"0 test\" is a
world whose broad phase finds nothing, that is, motion and bounding spheres. A loss against that is larger by nature; the second
panel of figure 9 supposes 1/60 s of drawing in every frame. A frame's time is 8 times the mean time of a step, for each step the shortest
of its repetitions.</li>
<li><b>Large cubes:</b> speed and step are the thesis's, so bodies of small size move far in a step (column
<code>largest_step_diameters</code>; above 0.25 impacts can go unseen). Counts are those of a gas all the same. Where a slow
method was measured in a part of the steps, the column <code>steps</code> says so.</li>
<li><b>Clusters:</b> eight groups of 1 m with (n/2)³ bodies each, held by a spring force towards their middles, at random places
in a box. The thesis says that a grid would lose there and a tree adapt, and did not measure it. Its tree ends at 16 levels
(appendix A.2); a tree of up to 32 levels is measured beside it.</li>
</ul>
";

/// The table of the cubes: counts and speed of each row.
fn cubes(tables: &Tables) -> String {
    let mut out = String::from(
        "<table><tr><th>n</th><th>bodies</th><th class=\"l\">method</th><th>steps</th><th>tests per step</th>\
         <th>special tests per step</th><th>share %</th><th>largest step, diameters</th><th>frames per second</th>\
         <th>loss %</th></tr>\n",
    );
    let counts = &tables.counts;
    for row in &counts.rows {
        let Some(method) = counts.method(row) else { continue };
        let first = if method == Method::Nothing { " class=\"n\"" } else { "" };
        let of = |column| counts.number(row, column).unwrap_or(f64::NAN);
        let speed = |column| find(&tables.speed, method, &[("n", of("n"))], column).unwrap_or(f64::NAN);
        let _ = writeln!(
            out,
            "<tr{first}><td>{}</td><td>{}</td><td class=\"l\">{}</td><td>{}</td><td>{}</td><td>{}</td><td>{:.3}</td>\
             <td>{:.2}</td><td>{}</td><td>{:.2}</td></tr>",
            counts.text(row, "n"),
            short(of("bodies")),
            method.name(),
            counts.text(row, "steps"),
            short(of("sphere_tests_per_step")),
            short(of("detect_calls_per_step")),
            of("special_percent"),
            of("largest_step_diameters"),
            short(speed("fps")),
            speed("loss_percent")
        );
    }
    out + "</table>\n"
}

/// Columns of a table as they are, numbers shortened.
fn rows(table: &Table, columns: &[&str]) -> String {
    let head: Vec<String> = columns.iter().map(|c| format!("<th>{}</th>", escape(&c.replace('_', " ")))).collect();
    let mut out = format!("<table><tr>{}</tr>\n", head.concat());
    for row in &table.rows {
        let cell = |column: &&str| match table.number(row, column) {
            Some(v) if v.fract() != 0.0 || v >= 1e4 => short(v),
            _ => escape(table.text(row, column)),
        };
        let cells: Vec<String> = columns.iter().map(|c| format!("<td>{}</td>", cell(c))).collect();
        let _ = writeln!(out, "<tr>{}</tr>", cells.concat());
    }
    out + "</table>\n"
}
