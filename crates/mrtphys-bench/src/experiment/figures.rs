//! The figures, drawn from the tables alone: an interrupted run is drawn as far as it came.

use super::csv::Table;
use super::methods::Method;
use crate::plot::{self, Axis, Band, Layout, Marker, Plot, Scale, Series, Ticks};

/// The tables.
#[derive(Clone, Debug, Default)]
pub struct Tables {
    /// `counts.csv`
    pub counts: Table,
    /// `speed.csv`
    pub speed: Table,
    /// `clusters.csv`
    pub clusters: Table,
}

/// What the thesis's text says about 512 bodies (section 5.3.4).
pub mod thesis {
    /// movable bodies
    pub const BODIES: f64 = 512.0;
    /// bounding-sphere tests of bSphere: (11 m + m^2)/2
    pub const SPHERES_TESTS: f64 = 133_888.0;
    /// bounding-sphere tests of Grid 16
    pub const GRID_TESTS: f64 = 1642.0;
    /// special tests of bSphere
    pub const SPHERES_DETECTS: f64 = 2014.0;
    /// special tests of Grid 16
    pub const GRID_DETECTS: f64 = 472.0;
}

/// Time to draw a frame that the second panel of figure 9 supposes \[ms\]: a display's sixtieth of a second.
const DRAWING_MS: f64 = 1e3 / 60.0;
/// Box edge of the clusters over whose number of bodies is plotted \[m\].
const EDGES_AT_N: u32 = 16;

/// File names and SVG texts of all figures.
pub fn all(tables: &Tables) -> Vec<(&'static str, String)> {
    vec![
        ("figure6.svg", figure6(&tables.counts)),
        ("figure7.svg", figure7(&tables.counts)),
        ("figure8.svg", figure8(&tables.speed)),
        ("figure9.svg", figure9(&tables.speed)),
        ("clusters.svg", clusters(&tables.clusters)),
        ("clusters-edge.svg", clusters_edge(&tables.clusters)),
    ]
}

fn style(method: Method) -> (&'static str, Marker) {
    // Colors of Okabe and Ito (2008), told apart by the color-blind too.
    match method {
        Method::Nothing => ("#777777", Marker::Cross),
        Method::Spheres => ("#000000", Marker::Circle),
        Method::Tree => ("#d55e00", Marker::Triangle),
        Method::DeepTree => ("#cc79a7", Marker::Wedge),
        Method::Grid => ("#0072b2", Marker::Square),
        Method::Sorted => ("#009e73", Marker::Diamond),
    }
}

/// A line per method; `value` gives x and y of a row, `whole` the steps of a run that left none out.
fn lines(table: &Table, value: impl Fn(&[String]) -> Option<(f64, f64)>) -> Vec<Series> {
    let most = table.rows.iter().filter_map(|r| table.number(r, "steps")).fold(0.0, f64::max);
    Method::ALL
        .into_iter()
        .map(|method| {
            let (color, marker) = style(method);
            let rows = table.rows.iter().filter(|r| table.method(r) == Some(method));
            let mut points: Vec<(f64, f64, bool)> = rows
                .filter_map(|r| {
                    let (x, y) = value(r)?;
                    Some((x, y, table.number(r, "steps")? < most))
                })
                .collect();
            points.sort_by(|a, b| a.0.total_cmp(&b.0));
            Series { name: method.name().into(), color, marker, line: true, points }
        })
        .collect()
}

fn of_bodies(table: &Table, column: &str) -> Vec<Series> {
    lines(table, |r| Some((table.number(r, "bodies")?, table.number(r, column)?)))
}

/// The same without '0 test', which tests nothing and is what losses are measured against.
fn of_detecting(table: &Table, column: &str) -> Vec<Series> {
    detecting(of_bodies(table, column))
}

fn detecting(mut series: Vec<Series>) -> Vec<Series> {
    series.retain(|s| s.name != Method::Nothing.name());
    series
}

/// What the thesis's text says, as stars.
fn stars(values: [f64; 2]) -> Series {
    Series {
        name: "thesis, text".into(),
        color: "#e0a000",
        marker: Marker::Star,
        line: false,
        points: values.map(|y| (thesis::BODIES, y, false)).to_vec(),
    }
}

fn bodies_axis() -> Axis {
    Axis {
        label: "movable bodies m = n³".into(),
        scale: Scale::Log,
        include: vec![],
        ticks: Ticks::At([2.0f64, 3.0, 4.0, 6.0, 8.0, 12.0, 16.0, 24.0, 47.0].map(|n| n.powi(3)).to_vec()),
    }
}

fn axis(label: &str, scale: Scale, include: &[f64]) -> Axis {
    Axis { label: label.into(), scale, include: include.to_vec(), ticks: Ticks::Auto }
}

const BAND: Option<Band> = Some(Band { of_x: true, range: (8.0, 512.0), name: "range of the thesis" });

fn plot(title: &str, y: Axis, series: Vec<Series>) -> Plot {
    Plot { title: title.into(), x: bodies_axis(), y, series, band: BAND }
}

fn figure(plots: &[Plot], notes: &[String]) -> String {
    plot::figure(plots, Layout::row(plots.len()), notes)
}

fn notes(of: &str) -> Vec<String> {
    vec![of.into(), "Open markers: measured in a part of the steps, see the column 'steps' of the table.".into()]
}

fn figure6(counts: &Table) -> String {
    let mut series = of_detecting(counts, "special_percent");
    series.push(stars([
        100.0 * thesis::SPHERES_DETECTS / thesis::SPHERES_TESTS,
        100.0 * thesis::GRID_DETECTS / thesis::GRID_TESTS,
    ]));
    let y = axis("share of bounding-sphere tests [%]", Scale::Log, &[100.0]);
    let title = "Bounding-sphere tests that need a special test";
    figure(&[plot(title, y, series)], &notes("Thesis, figure 6. Sum of special tests over sum of tests of all steps."))
}

fn figure7(counts: &Table) -> String {
    let mut series = of_detecting(counts, "sphere_tests_per_step");
    series.push(stars([thesis::SPHERES_TESTS, thesis::GRID_TESTS]));
    let y = axis("bounding-sphere tests per step", Scale::Log, &[]);
    figure(&[plot("Bounding-sphere tests", y, series)], &notes("Thesis, figure 7. Mean over the steps."))
}

fn figure8(speed: &Table) -> String {
    let y = axis("frames per second [1/s]", Scale::Log, &[]);
    let plot = plot("Frames of 8 steps per second, nothing drawn", y, of_bodies(speed, "fps"));
    figure(&[plot], &notes("Thesis, figure 8, but the physics alone. '0 test': motion and bounding spheres only."))
}

fn figure9(speed: &Table) -> String {
    let loss = of_detecting(speed, "loss_percent");
    let nothing = |bodies: f64| {
        let row = speed
            .rows
            .iter()
            .find(|r| speed.method(r) == Some(Method::Nothing) && speed.number(r, "bodies") == Some(bodies))?;
        speed.number(row, "frame_ms")
    };
    let drawn = lines(speed, |r| {
        let (bodies, frame) = (speed.number(r, "bodies")?, speed.number(r, "frame_ms")?);
        Some((bodies, 100.0 * (1.0 - (nothing(bodies)? + DRAWING_MS) / (frame + DRAWING_MS))))
    });
    let y = || axis("loss of frame rate [%]", Scale::Linear, &[0.0, 100.0]);
    let plots = [
        plot("Loss against '0 test', nothing drawn", y(), loss),
        plot("The same if drawing takes 1/60 s a frame", y(), detecting(drawn)),
    ];
    let text = "Thesis, figure 9. Its '0 test' was drawing time, ours (left) is motion: only the right panel is like it, for \
                an assumed display.";
    figure(&plots, &notes(text))
}

/// The edge of the box in most rows that are not of the series over the edge.
fn main_edge(clusters: &Table) -> Option<f64> {
    let other = clusters.rows.iter().filter(|r| clusters.number(r, "n") != Some(f64::from(EDGES_AT_N)));
    other.filter_map(|r| clusters.number(r, "edge")).reduce(f64::max)
}

fn clusters(table: &Table) -> String {
    let edge = main_edge(table);
    let of = |column: &'static str, factor: f64| {
        lines(table, move |r| {
            let here = edge.is_none() || table.number(r, "edge") == edge;
            Some((table.number(r, "bodies")?, factor * table.number(r, column)?)).filter(|_| here)
        })
    };
    let unbanded = |title: &str, y, series| Plot { band: None, ..plot(title, y, series) };
    let plots = [
        unbanded(
            "Tests in eight clusters",
            axis("bounding-sphere tests per step", Scale::Log, &[]),
            of("sphere_tests_per_step", 1.0),
        ),
        unbanded("Time to find the pairs", axis("broad phase per step [ms]", Scale::Log, &[]), of("broad_us", 1e-3)),
    ];
    let edge = edge.map_or_else(String::new, |e| format!(", box of {e} m"));
    figure(&plots, &notes(&format!("Eight clusters of 1 m and (n/2)³ bodies each{edge}.")))
}

/// Number along an edge whose box is varied: the one with the most boxes.
fn clusters_edge(table: &Table) -> String {
    let mut kinds: Vec<(usize, f64)> = Vec::new();
    for row in &table.rows {
        let Some(n) = table.number(row, "n") else { continue };
        match kinds.iter_mut().find(|k| k.1 == n) {
            Some(kind) => kind.0 += usize::from(table.method(row) == Some(Method::Grid)),
            None => kinds.push((usize::from(table.method(row) == Some(Method::Grid)), n)),
        }
    }
    let n = kinds.into_iter().max_by(|a, b| a.0.cmp(&b.0).then(a.1.total_cmp(&b.1))).map(|k| k.1);
    let of = |column: &'static str, factor: f64| {
        lines(table, move |r| {
            let here = n.is_some() && table.number(r, "n") == n;
            Some((table.number(r, "edge")?, factor * table.number(r, column)?)).filter(|_| here)
        })
    };
    let edge_plot = |title: &str, label: &str, series: Vec<Series>| {
        let ticks = Ticks::At(vec![6.0, 8.0, 16.0, 32.0, 64.0, 128.0]);
        let x = Axis { label: "edge of the box [m]".into(), scale: Scale::Log, include: vec![], ticks };
        Plot { title: title.into(), x, y: axis(label, Scale::Log, &[]), series, band: None }
    };
    let plots = [
        edge_plot("Tests as the box grows", "bounding-sphere tests per step", of("sphere_tests_per_step", 1.0)),
        edge_plot("Time to find the pairs", "broad phase per step [ms]", of("broad_us", 1e-3)),
    ];
    let bodies = n.map_or_else(String::new, |n| format!("{} bodies in ", n.powi(3)));
    figure(&plots, &notes(&format!("{bodies}eight clusters of 1 m.")))
}
