//! The figures of a run: speed over the number of bodies, and what became of the energy.

use super::results::{Row, SceneRows, clock, gather, threads};
use crate::peers::EngineKind;
use crate::plot::{Axis, Band, Layout, Marker, Plot, Scale, Series, Ticks, figure, plain};
use serde_json::Value;
use std::path::Path;

/// Steps per second of the figure of the speed.
const RATE: u64 = 512;

/// The least error of a ratio near one that double precision can show: the distance from one to the next number below. What
/// has no error at all is drawn there.
const LEAST: f64 = f64::EPSILON / 2.0;

/// A figure with its name, what a reader who does not see it is told, and its SVG.
pub struct Figure {
    name: &'static str,
    what: &'static str,
    svg: String,
}

/// The figures that the records have anything for.
pub fn all(records: &[Value]) -> Vec<Figure> {
    let scenes = gather(records);
    let speed = speed(&scenes, threads(records));
    let energy = energy(&scenes);
    let with = |name, what, svg: Option<String>| svg.map(|svg| Figure { name, what, svg });
    [
        with("speed", "Time per body and step over the number of bodies", speed),
        with("energy", "Error of the energy at the end, by scene and engine", energy),
    ]
    .into_iter()
    .flatten()
    .collect()
}

/// Writes figures into the folder `pictures` beside a document, named after it, and returns the lines that show them there.
///
/// # Errors
/// A file cannot be written, in words.
pub fn write(document: &Path, figures: &[Figure]) -> Result<String, String> {
    let folder = document.parent().unwrap_or(Path::new("")).join("pictures");
    let stem = document.file_stem().unwrap_or_default().to_string_lossy();
    let mut links = String::new();
    for figure in figures {
        let file = format!("{stem}-{}.svg", figure.name);
        let path = folder.join(&file);
        std::fs::create_dir_all(&folder)
            .and_then(|()| std::fs::write(&path, &figure.svg))
            .map_err(|e| format!("{}: {e}", path.display()))?;
        links.push_str(&format!("![{}](pictures/{file})\n\n", figure.what));
    }
    Ok(links)
}

/// Colors of Okabe and Ito (2008), told apart by the color-blind too.
fn style(engine: &str) -> (&'static str, Marker) {
    match EngineKind::named(engine) {
        Some(EngineKind::Ours) | None => ("#000000", Marker::Circle),
        Some(EngineKind::Rapier) => ("#d55e00", Marker::Triangle),
        Some(EngineKind::Box3d) => ("#009e73", Marker::Diamond),
        Some(EngineKind::Jolt) => ("#0072b2", Marker::Square),
        Some(EngineKind::Physx) => ("#cc79a7", Marker::Wedge),
    }
}

/// Engines and margins that are in any scene, in the order of the tables.
fn entries(scenes: &[SceneRows]) -> Vec<(&'static str, &'static str)> {
    let all = EngineKind::ALL.iter().flat_map(|e| [(e.1, "default"), (e.1, "thin")]);
    all.filter(|&(engine, margin)| scenes.iter().any(|s| s.find(engine, margin).is_some())).collect()
}

/// Kinds of scenes, in their order.
fn kinds(scenes: &[SceneRows]) -> Vec<&str> {
    let mut kinds: Vec<&str> = Vec::new();
    for scene in scenes {
        if !kinds.contains(&scene.kind()) {
            kinds.push(scene.kind());
        }
    }
    kinds
}

fn axis(label: &str, scale: Scale, include: Vec<f64>, ticks: Ticks) -> Axis {
    Axis { label: label.into(), scale, include, ticks }
}

/// A panel for each kind of bodies, a line for each engine.
fn speed(scenes: &[SceneRows], threads: u64) -> Option<String> {
    let scenes: Vec<SceneRows> = scenes.iter().filter(|s| s.rate() == Some(RATE)).cloned().collect();
    let kinds = kinds(&scenes);
    let time = |scene: &SceneRows, engine: &str| {
        let row = scene.find(engine, "default").filter(|r| r.invalid().is_none())?;
        Some((scene.bodies()?, 1e6 * row.start()? / scene.bodies()?, false))
    };
    let all: Vec<(f64, f64, bool)> =
        scenes.iter().flat_map(|s| EngineKind::ALL.map(|e| time(s, e.1))).flatten().collect();
    if all.is_empty() {
        return None;
    }
    let clock = if clock(threads) == "wall" { "wall time" } else { "processor time" };
    let mut sizes: Vec<f64> = scenes.iter().filter_map(SceneRows::bodies).collect();
    sizes.sort_by(f64::total_cmp);
    sizes.dedup();
    let panel = |kind: &&str| {
        let here = || scenes.iter().filter(|s| s.kind() == *kind);
        let series = EngineKind::ALL.map(|(_, engine, title)| {
            let (color, marker) = style(engine);
            let mut points: Vec<_> = here().filter_map(|s| time(s, engine)).collect();
            points.sort_by(|a, b| a.0.total_cmp(&b.0));
            Series { name: title.into(), color, marker, line: true, points }
        });
        Plot {
            title: format!("Gas of {kind}, steps of 1/{RATE} s"),
            // The same ranges in every panel, so that they can be compared.
            x: axis("bodies", Scale::Log, sizes.clone(), Ticks::At(sizes.clone())),
            y: axis(
                &format!("{clock} per body and step [ns]"),
                Scale::Log,
                all.iter().map(|p| p.1).collect(),
                Ticks::Auto,
            ),
            series: series.to_vec(),
            band: None,
        }
    };
    let plots: Vec<Plot> = kinds.iter().map(panel).collect();
    let mut notes = vec![format!(
        "Medians near the start, {threads} thread{}, margins left as the engines have them.",
        if threads == 1 { "" } else { "s" }
    )];
    notes.extend(left_out(&scenes));
    Some(figure(&plots, Layout::row(2), &notes))
}

/// A panel for each length of step, a field for each scene, a marker for each engine and margin.
fn energy(scenes: &[SceneRows]) -> Option<String> {
    let entries = entries(scenes);
    let error = |scene: &SceneRows, &(engine, margin): &(&str, &str)| {
        let row = scene.find(engine, margin).filter(|r| r.invalid().is_none())?;
        Some((row.truth("energy")? - 1.0).abs().max(LEAST))
    };
    let all: Vec<f64> = scenes.iter().flat_map(|s| entries.iter().filter_map(move |e| error(s, e))).collect();
    if all.is_empty() {
        return None;
    }
    let kinds = kinds(scenes);
    let mut rates: Vec<u64> = scenes.iter().filter_map(SceneRows::rate).collect();
    rates.sort_unstable_by(|a, b| b.cmp(a));
    rates.dedup();
    let panel = |rate: &u64| {
        let mut here: Vec<&SceneRows> = scenes.iter().filter(|s| s.rate() == Some(*rate)).collect();
        here.sort_by_key(|s| kinds.iter().position(|k| *k == s.kind()));
        let series = entries.iter().enumerate().map(|(slot, entry)| {
            let (color, marker) = style(entry.0);
            // Side by side within nine tenths of the field, so that equal errors do not hide each other.
            let aside = 0.9 * ((slot as f64 + 0.5) / entries.len() as f64 - 0.5);
            let places = here.iter().enumerate().map(|(field, scene)| (field as f64 + aside, error(scene, entry)));
            let points = places.filter_map(|(x, y)| Some((x, y?, entry.1 == "thin"))).collect();
            Series { name: Row::of(entry.0, entry.1).title(), color, marker, line: false, points }
        });
        let name = |s: &&SceneRows| {
            let steps = s.rows.iter().filter_map(|r| r.truth("steps")).fold(0.0, f64::max);
            let seconds = (1e3 * steps / *rate as f64).round() / 1e3;
            format!("{}\n{}\n{seconds} s", s.bodies().map_or_else(String::new, plain), s.kind())
        };
        Plot {
            title: format!("Energy at the end of the run, steps of 1/{rate} s"),
            x: axis("bodies and simulated time", Scale::Fields, vec![], Ticks::Named(here.iter().map(name).collect())),
            y: axis("|E/E₀ − 1|", Scale::Log, [&all[..], &[LEAST]].concat(), Ticks::Auto),
            series: series.collect(),
            band: Some(Band { of_x: false, range: (0.0, f64::EPSILON), name: "exact to round-off" }),
        }
    };
    let plots: Vec<Plot> = rates.iter().map(panel).collect();
    let mut notes = vec!["Open markers: thin margins. What is exact to the last bit is drawn at 2⁻⁵³.".into()];
    notes.extend(left_out(scenes));
    Some(figure(&plots, Layout { columns: 1, width: 700.0, height: 250.0 }, &notes))
}

/// Says what a figure does not show because it is no run of its scene.
fn left_out(scenes: &[SceneRows]) -> Option<String> {
    let bad = |r: &&Row| r.failure.is_some() || r.invalid().is_some() || (r.ended() && r.truth("energy").is_none());
    let rows =
        scenes.iter().flat_map(|s| s.rows.iter().filter(bad).map(move |r| format!("{} in {}", r.title(), s.name)));
    let names: Vec<String> = rows.collect();
    (!names.is_empty()).then(|| format!("Failed, invalid or not a number, see the tables: {}.", names.join(", ")))
}

#[cfg(test)]
mod tests {
    use super::*;
    use serde_json::json;

    fn scene(name: &str, bodies: u64, rate: u64) -> Value {
        json!({"what": "scene", "scene": name, "bodies": bodies, "rate": rate, "late": null})
    }

    /// A run of an engine: time of a step \[s\] by the processor's clock, energy, part that moved v t.
    fn run(scene: &str, engine: &str, margin: &str, time: f64, energy: Value, moved: f64) -> Vec<Value> {
        let times = |t: f64| json!({"median": t, "mean": t, "total": t});
        let of = json!({"scene": scene, "engine": engine, "margin": margin});
        let with = |what: &str, more: Value| {
            let mut record = of.clone();
            record["what"] = what.into();
            more.as_object().unwrap().iter().for_each(|(k, v)| record[k] = v.clone());
            record
        };
        vec![
            with("burst", json!({"window": "start", "cpu": times(time), "wall": times(3.0 * time)})),
            with("watch", json!({"moved": moved})),
            with("truth", json!({"energy": energy, "steps": 4})),
        ]
    }

    fn svg<'a>(figures: &'a [Figure], name: &str) -> &'a str {
        &figures.iter().find(|f| f.name == name).unwrap().svg
    }

    /// Where the markers of a color are: discs and the first corners of polygons.
    fn places(svg: &str, color: &str) -> Vec<(f64, f64)> {
        let value = |line: &str, key: &str| line.split_once(key).unwrap().1.split('"').next().unwrap().to_string();
        let lines =
            svg.lines().filter(|l| l.contains(color) && (l.starts_with("<circle") || l.starts_with("<polygon")));
        let place = |line: &str| {
            if line.starts_with("<circle") {
                return (value(line, "cx=\"").parse().unwrap(), value(line, "cy=\"").parse().unwrap());
            }
            let points = value(line, "points=\"");
            let (x, y) = points.split(' ').next().unwrap().split_once(',').unwrap();
            (x.parse().unwrap(), y.parse().unwrap())
        };
        lines.map(place).collect()
    }

    const OURS: &str = "#000000";
    const JOLT: &str = "#0072b2";

    #[test]
    fn speed_is_time_by_bodies_on_logarithmic_axes() {
        let mut records = Vec::new();
        for (name, bodies, rate) in
            [("a-1@512", 100, 512), ("a-2@512", 1000, 512), ("b-1@512", 100, 512), ("a-1@64", 100, 64)]
        {
            records.push(scene(name, bodies, rate));
            records.extend(run(name, "ours", "default", 1e-9 * bodies as f64, json!(1.0), 1.0));
            records.extend(run(name, "jolt", "default", 1e-8 * bodies as f64, json!(1.1), 1.0));
            records.extend(run(name, "jolt", "thin", 5e-8 * bodies as f64, json!(1.1), 1.0));
        }
        let figures = all(&records);
        let speed = svg(&figures, "speed");
        // Two panels with three scenes, each engine once in the legend; thin margins and other rates are not drawn.
        let (ours, jolt) = (places(speed, OURS), places(speed, JOLT));
        assert_eq!((ours.len(), jolt.len()), (4, 4), "{speed}");
        assert!(speed.contains("Gas of a,") && speed.contains("Gas of b,") && speed.contains("processor time"));
        assert!(ours[..3].iter().all(|p| p.1 == ours[0].1), "the same time per body is the same height: {ours:?}");
        let square = 3.6;
        assert!((jolt[0].0 + square - ours[0].0).abs() < 0.2);
        assert!(jolt[0].1 < ours[0].1 - 50.0, "more time is higher: {jolt:?} {ours:?}");
        assert!(!speed.contains("Rapier"), "{speed}");

        records.push(json!({"what": "machine", "threads": 2}));
        let figures = all(&records);
        assert!(svg(&figures, "speed").contains("wall time per body"));
        assert!(all(&[]).is_empty());
    }

    #[test]
    fn energy_has_a_floor_and_every_marker_a_place_of_its_own() {
        let mut records = vec![scene("a-1@512", 100, 512)];
        records.extend(run("a-1@512", "ours", "default", 1.0, json!(1.0), 1.0));
        records.extend(run("a-1@512", "jolt", "default", 1.0, json!(1.01), 1.0));
        records.extend(run("a-1@512", "jolt", "thin", 1.0, json!(0.99), 1.0));
        let figures = all(&records);
        let energy = svg(&figures, "energy");
        let (ours, jolt) = (places(energy, OURS), places(energy, JOLT));
        assert_eq!((ours.len(), jolt.len()), (2, 4), "{energy}");
        // The same error, at the same height, side by side.
        assert_eq!(jolt[0].1, jolt[1].1);
        assert!((jolt[0].0 - jolt[1].0).abs() > 10.0, "{jolt:?}");
        assert!(ours[0].1 > jolt[0].1 + 100.0, "the floor is below: {ours:?} {jolt:?}");
        assert!(
            energy.contains(">100</text>")
                && energy.contains(">a</text>")
                && energy.contains(">0.008 s</text>")
                && energy.contains("round-off")
        );
        assert_eq!(energy.matches("fill=\"#fff\" stroke=\"#0072b2\"").count(), 2, "thin is open, in the legend too");
        assert!(!energy.contains("invalid"));
    }

    #[test]
    fn what_is_no_run_of_its_scene_is_named_and_not_drawn() {
        for (energy, moved) in [(json!(1.0), 0.5), (Value::Null, 1.0)] {
            let mut records = vec![scene("a-1@512", 100, 512)];
            records.extend(run("a-1@512", "ours", "default", 1.0, json!(1.0), 1.0));
            records.extend(run("a-1@512", "jolt", "default", 1.0, energy, moved));
            let figures = all(&records);
            let energy = svg(&figures, "energy");
            assert!(places(energy, JOLT).is_empty(), "{energy}");
            assert!(energy.contains("Jolt in a-1@512"), "{energy}");
        }
    }

    #[test]
    fn figures_lie_beside_the_document() {
        let folder = std::env::temp_dir().join(format!("mrtphys-figures-{}", std::process::id()));
        let mut records = vec![scene("a-1@64", 100, 64)];
        records.extend(run("a-1@64", "ours", "default", 1.0, json!(1.0), 1.0));
        let links = write(&folder.join("page.md"), &all(&records)).unwrap();
        assert_eq!(links.matches("![").count(), 1, "no speed without steps of 1/{RATE} s: {links}");
        assert!(links.contains("](pictures/page-energy.svg)"), "{links}");
        let svg = std::fs::read_to_string(folder.join("pictures/page-energy.svg")).unwrap();
        assert!(svg.starts_with("<svg") && svg.ends_with("</svg>\n"));
        let _ = std::fs::remove_dir_all(&folder);
    }
}
