//! The tables: Markdown with aligned columns, the same on the terminal and in the documents.

use super::results::{Row, SceneRows, clock, gather, threads};
use crate::peers::EngineKind;
use serde_json::Value;
use std::fmt::Write;
use std::path::Path;

/// The lines between which the tables stand in a document.
const BEGIN: &str = "<!-- tables -->";
const END: &str = "<!-- end of tables -->";

/// All tables of a run.
pub fn tables(records: &[Value]) -> String {
    let scenes = gather(records);
    let mut out = String::new();
    for machine in records.iter().filter(|r| r["what"] == "machine") {
        out.push_str(&machine_text(machine));
    }
    out.push_str(&engines_text(records));
    let clock = clock_text(records);
    let _ = writeln!(out, "\n### {clock} of a step near the start \\[ms\\], in brackets times ours\n");
    out.push_str(&matrix(&scenes, true, |row, ours| time_cell(row, row.start(), ours.and_then(Row::start))));
    out.push_str("\n### The same in the second window, after a simulated second\n\n");
    out.push_str(&matrix(&scenes, true, |row, ours| time_cell(row, row.late(), ours.and_then(Row::late))));
    let dear: Vec<&str> = scenes.iter().filter(|s| s.record["late"].is_null()).map(|s| s.name.as_str()).collect();
    if !dear.is_empty() {
        let _ = writeln!(out, "\nA simulated second is too dear for {}: no second window.", dear.join(", "));
    }
    out.push_str("\n### Energy at the end, as a part of that at the start\n\n");
    out.push_str(&matrix(&scenes, false, |row, _| row.truth("energy").map_or_else(|| state(row), energy)));
    out.push_str("\n### Each scene\n");
    for scene in &scenes {
        out.push_str(&scene_text(scene, &clock));
    }
    out
}

/// The table of a scene, for the terminal.
pub fn details(records: &[Value], scene: &str) -> String {
    let clock = clock_text(records);
    gather(records).iter().filter(|s| s.name == scene).map(|s| scene_text(s, &clock)).collect()
}

/// What the times are.
fn clock_text(records: &[Value]) -> String {
    match threads(records) {
        n if clock(n) == "wall" => format!("Wall time, {n} threads,"),
        _ => "Processor time".into(),
    }
}

/// Puts the tables into a document, between the two lines that mark their place.
///
/// # Errors
/// The document cannot be read or written or lacks the lines, in words.
pub fn splice(path: &Path, tables: &str) -> Result<(), String> {
    let words = |e: std::io::Error| format!("{}: {e}", path.display());
    let text = std::fs::read_to_string(path).map_err(words)?;
    let place = || Some((text.split_once(BEGIN)?.0, text.split_once(END)?.1));
    let (before, after) = place().ok_or(format!("{}: lacks the lines {BEGIN} and {END}", path.display()))?;
    std::fs::write(path, format!("{before}{BEGIN}\n\n{}\n{END}{after}", tables.trim())).map_err(words)
}

fn machine_text(machine: &Value) -> String {
    let text = |key: &str| machine[key].as_str().unwrap_or("?").to_string();
    let threads = machine["threads"].as_u64().unwrap_or(1);
    let clock = if clock(threads) == "wall" { "wall time" } else { "processor time of the engine's process" };
    format!(
        "Machine: {}, {} cores, {}, {}, load {} at the start. {threads} thread(s) an engine; times are {clock}.\n\n    {}\n",
        text("cpu"),
        machine["cores"],
        text("kernel"),
        text("rustc"),
        text("load"),
        text("command"),
    )
}

fn engines_text(records: &[Value]) -> String {
    let mut rows: Vec<Vec<String>> = Vec::new();
    for record in records.iter().filter(|r| r["what"] == "engine") {
        let text = |key: &str| record[key].as_str().unwrap_or("?").to_string();
        let row = Row::of(&text("engine"), &text("margin"));
        let line = vec![row.title(), text("version"), text("settings")];
        if rows.iter().all(|r| r[0] != line[0]) {
            rows.push(line);
        }
    }
    if rows.is_empty() {
        return String::new();
    }
    format!("\n{}", table(&["engine", "version", "settings"], &rows))
}

/// A table with the scenes as rows and the engines as columns.
fn matrix(scenes: &[SceneRows], timed: bool, cell: impl Fn(&Row, Option<&Row>) -> String) -> String {
    let mut columns: Vec<(&str, &str)> = Vec::new();
    for (_, name, _) in EngineKind::ALL {
        for margin in ["default", "thin"] {
            if scenes.iter().any(|s| s.find(name, margin).is_some()) {
                columns.push((name, margin));
            }
        }
    }
    let title = |&(engine, margin): &(&str, &str)| Row::of(engine, margin).title();
    let mut head = vec!["scene".to_string()];
    head.extend(columns.iter().map(title));
    let mut rows = Vec::new();
    for scene in scenes {
        let mut row = vec![scene.name.clone()];
        row.extend(columns.iter().map(|&(engine, margin)| {
            let found = scene.find(engine, margin);
            found.map_or_else(String::new, |r| cell(r, scene.ours()))
        }));
        // A row without any time says nothing.
        if !timed || row.iter().skip(1).any(|c| c.starts_with(|c: char| c.is_ascii_digit())) {
            rows.push(row);
        }
    }
    table(&head.iter().map(String::as_str).collect::<Vec<_>>(), &rows)
}

fn time_cell(row: &Row, time: Option<f64>, ours: Option<f64>) -> String {
    let Some(time) = time else { return state(row) };
    let mark = if row.invalid().is_some() { " INVALID" } else { "" };
    match ours {
        Some(ours) if row.engine != EngineKind::Ours.name() => {
            format!("{} ({}){mark}", three(time), three(time / ours))
        }
        _ => format!("{}{mark}", three(time)),
    }
}

fn state(row: &Row) -> String {
    if row.failure.is_some() { "failed".into() } else { String::new() }
}

fn scene_text(scene: &SceneRows, clock: &str) -> String {
    let (name, bodies, rate) = (&scene.name, &scene.record["bodies"], &scene.record["rate"]);
    let mut out = format!(
        "\n#### {name}: {bodies} bodies, 1/{rate} s a step; ms: {}\n\n",
        clock.to_lowercase().trim_end_matches(',')
    );
    let head = [
        "engine",
        "start ms",
        "late ms",
        "mean ms",
        "spread",
        "steps",
        "E/E0",
        "escaped",
        "overlaps",
        "worst / r",
        "changes / s",
        "/ theory",
        "moved v t",
    ];
    let ours = scene.ours();
    let rows: Vec<Vec<String>> = scene.rows.iter().map(|row| scene_row(row, ours)).collect();
    out.push_str(&table(&head, &rows));
    for row in &scene.rows {
        if let Some(why) = &row.failure {
            let _ = writeln!(out, "\n{} {why}", row.title());
        }
        if let Some(why) = row.invalid() {
            let _ = writeln!(out, "\n{} INVALID: {why}.", row.title());
        }
    }
    out
}

fn scene_row(row: &Row, ours: Option<&Row>) -> Vec<String> {
    let number = |x: Option<f64>| x.map_or_else(String::new, three);
    let percent = |x: Option<f64>| x.map_or_else(String::new, |x| format!("{:.1} %", 100.0 * x));
    let count = |x: Option<f64>| x.map_or_else(String::new, |x| format!("{x}"));
    let energy = match row.truth("energy") {
        Some(e) => energy(e),
        None if row.ended() => "not a number".into(),
        None => String::new(),
    };
    let theory = row.watched("theory").and_then(|theory| Some(row.watched("rate")? / theory));
    vec![
        row.title(),
        time_cell(row, row.start(), ours.and_then(Row::start)),
        time_cell(row, row.late(), ours.and_then(Row::late)),
        number(row.mean()),
        percent(row.spread()),
        count(row.truth("steps")),
        energy,
        count(row.truth("escaped")),
        count(row.truth("pairs")),
        number(row.truth("worst")),
        number(row.watched("rate")),
        number(theory),
        percent(row.watched("moved")),
    ]
}

/// Near one, the difference from one is what matters.
fn energy(ratio: f64) -> String {
    let error = ratio - 1.0;
    if error == 0.0 {
        "1".into()
    } else if error.abs() < 1e-3 {
        format!("1 {} {:.0e}", if error < 0.0 { '-' } else { '+' }, error.abs())
    } else {
        three(ratio)
    }
}

/// Three significant digits.
fn three(x: f64) -> String {
    if x == 0.0 || !x.is_finite() {
        return format!("{x}");
    }
    let digits = x.abs().log10().floor();
    if !(-4.0..=6.0).contains(&digits) {
        return format!("{x:.2e}");
    }
    format!("{x:.*}", (2.0 - digits).max(0.0) as usize)
}

/// A Markdown table with aligned columns.
fn table(head: &[&str], rows: &[Vec<String>]) -> String {
    let width = |k: usize| {
        let cells = rows.iter().map(|r| r[k].chars().count());
        cells.chain([head[k].chars().count(), 3]).max().unwrap_or(3)
    };
    let widths: Vec<usize> = (0..head.len()).map(width).collect();
    let mut out = String::new();
    let line = |out: &mut String, cells: &mut dyn Iterator<Item = &str>| {
        for (cell, width) in cells.zip(&widths) {
            let _ = write!(out, "| {cell}{} ", " ".repeat(width - cell.chars().count()));
        }
        out.push_str("|\n");
    };
    line(&mut out, &mut head.iter().copied());
    let rules: Vec<String> = widths.iter().map(|w| "-".repeat(*w)).collect();
    line(&mut out, &mut rules.iter().map(String::as_str));
    for row in rows {
        line(&mut out, &mut row.iter().map(String::as_str));
    }
    out
}

#[cfg(test)]
mod tests {
    use super::*;
    use serde_json::json;

    fn burst(engine: &str, window: &str, median: f64) -> Value {
        let times = |t: f64| json!({"median": t, "mean": t, "total": 4.0 * t});
        json!({"what": "burst", "scene": "s@8", "engine": engine, "margin": "default", "window": window, "steps": 4,
            "cpu": times(median), "wall": times(median)})
    }

    fn watch(engine: &str, moved: Value) -> Value {
        json!({"what": "watch", "scene": "s@8", "engine": engine, "margin": "default", "steps": 3, "rate": 9.0,
            "theory": 10.0, "speed": 1.0, "moved": moved})
    }

    #[test]
    fn ratios_are_medians_of_the_turns_by_ours() {
        let mut records = vec![json!({"what": "scene", "scene": "s@8", "bodies": 8, "rate": 8, "late": null})];
        for (ours, peer) in [(0.001, 0.005), (0.002, 0.001), (0.004, 0.009)] {
            records.extend([burst("ours", "start", ours), burst("jolt", "start", peer)]);
        }
        records.push(watch("jolt", json!(0.99)));
        let text = tables(&records);
        assert!(text.contains("5.00 (2.50) "), "{text}");
        assert!(text.contains("| 0.900 "), "{text}");
        assert!(text.contains("too dear for s@8"), "{text}");
        assert!(!text.contains("INVALID"), "{text}");
    }

    #[test]
    fn runs_that_are_none_are_called_invalid() {
        let scene = json!({"what": "scene", "scene": "s@8", "bodies": 8, "rate": 8, "late": 4});
        for (moved, valid) in [(json!(0.95), true), (json!(0.51), false), (Value::Null, false)] {
            let text = tables(&[scene.clone(), burst("box3d", "start", 0.5), watch("box3d", moved)]);
            assert_eq!(!text.contains("INVALID"), valid, "{text}");
        }
        let mut two_threads = burst("box3d", "start", 0.5);
        two_threads["wall"] = json!({"median": 0.25, "mean": 0.25, "total": 1.0});
        assert!(tables(&[scene.clone(), two_threads.clone()]).contains("2.0 threads"));
        let machine = json!({"what": "machine", "threads": 2});
        assert!(!tables(&[machine, scene.clone(), two_threads]).contains("INVALID"));
        // In a stack nothing flies: that says nothing against it.
        let mut stack = scene;
        stack["flies"] = json!(false);
        assert!(!tables(&[stack, burst("box3d", "start", 0.5), watch("box3d", Value::Null)]).contains("INVALID"));
    }

    #[test]
    fn several_threads_are_timed_by_the_wall_and_the_tables_say_so() {
        let scene = json!({"what": "scene", "scene": "s@8", "bodies": 8, "rate": 8, "late": 4});
        let mut burst = burst("jolt", "start", 0.008);
        burst["wall"] = json!({"median": 0.005, "mean": 0.006, "total": 0.02});
        for (threads, time, clock) in
            [(1, "8.00", "Processor time of a step"), (2, "5.00", "Wall time, 2 threads, of a")]
        {
            let records = [json!({"what": "machine", "threads": threads}), scene.clone(), burst.clone()];
            let text = tables(&records);
            assert!(text.contains(clock) && text.contains(time), "{text}");
            // On the terminal too, where a scene's table stands alone.
            let text = details(&records, "s@8");
            assert!(text.contains(&clock.to_lowercase()[..9]) && text.contains(time), "{text}");
        }
    }

    #[test]
    fn a_failure_leaves_what_came_before() {
        let scene = json!({"what": "scene", "scene": "s@8", "bodies": 8, "rate": 8, "late": 4});
        let failed =
            json!({"what": "failed", "scene": "s@8", "engine": "jolt", "margin": "default", "why": "failed: x"});
        let text = tables(&[scene, burst("jolt", "start", 0.5), failed]);
        assert!(text.contains("500") && text.contains("Jolt failed: x"), "{text}");
    }

    #[test]
    fn numbers_have_three_digits() {
        assert_eq!(
            ["0.0142", "1.23", "102", "15000", "0", "1.00e-5"],
            [0.0142, 1.234, 102.4, 15000.0, 0.0, 1e-5].map(three)
        );
        assert_eq!(energy(1.0), "1");
        assert_eq!(energy(1.0 - 4e-16), "1 - 4e-16");
        assert_eq!(energy(0.347), "0.347");
    }

    #[test]
    fn tables_go_between_their_marks_again_and_again() {
        let path = std::env::temp_dir().join(format!("mrtphys-tables-{}.md", std::process::id()));
        std::fs::write(&path, format!("head\n{BEGIN}\nold\n{END}\ntail\n")).unwrap();
        for _ in 0..2 {
            splice(&path, "new").unwrap();
            let text = std::fs::read_to_string(&path).unwrap();
            assert_eq!(text, format!("head\n{BEGIN}\n\nnew\n{END}\ntail\n"));
        }
        std::fs::write(&path, "no marks").unwrap();
        assert!(splice(&path, "new").unwrap_err().contains(BEGIN));
        let _ = std::fs::remove_file(&path);
    }
}
