//! The tables as files: RFC 4180, a row as soon as it is measured, and read back for the figures.

use super::measure::{Measured, STAGES, STEPS_PER_FRAME};
use super::methods::Method;
use std::fs::File;
use std::io::Write;
use std::path::Path;

/// Columns of `counts.csv`.
pub const COUNTS: [&str; 16] = [
    "scene",
    "n",
    "bodies",
    "method",
    "broad_phase",
    "steps",
    "sphere_tests",
    "detect_calls",
    "contacts",
    "sphere_tests_per_step",
    "detect_calls_per_step",
    "special_percent",
    "shown_steps",
    "shown_sphere_tests",
    "shown_detect_calls",
    "largest_step_diameters",
];

/// Columns of `speed.csv`.
pub const SPEED: [&str; 18] = [
    "scene",
    "n",
    "bodies",
    "method",
    "broad_phase",
    "steps",
    "repetitions",
    "frame_ms",
    "frame_ms_mean",
    "fps",
    "slowdown",
    "loss_percent",
    "motion_us",
    "bounds_us",
    "broad_us",
    "narrow_us",
    "impact_us",
    "projection_us",
];

/// Columns of `clusters.csv`.
pub const CLUSTERS: [&str; 15] = [
    "scene",
    "n",
    "bodies",
    "edge",
    "method",
    "broad_phase",
    "steps",
    "sphere_tests",
    "detect_calls",
    "sphere_tests_per_step",
    "detect_calls_per_step",
    "frame_ms",
    "fps",
    "broad_us",
    "repetitions",
];

/// Means of counts are written exactly as the quotient of the two integers beside them rounds.
fn per_step(sum: u64, steps: u32) -> String {
    (sum as f64 / f64::from(steps)).to_string()
}

fn head(m: &Measured) -> Vec<String> {
    vec![m.arena.name(), m.arena.n().to_string(), m.arena.bodies().to_string()]
}

fn who(m: &Measured) -> Vec<String> {
    vec![m.method.name().into(), m.method.command_line(m.arena.n()), m.steps.to_string()]
}

fn number(x: f64) -> String {
    format!("{x:.6}")
}

/// Wall time of a frame \[s\].
fn frame_seconds(m: &Measured) -> f64 {
    m.step_seconds * f64::from(STEPS_PER_FRAME)
}

/// A row of `counts.csv`: whole numbers and their quotients, the same on every machine.
pub fn counts_row(m: &Measured) -> Vec<String> {
    let mut row = head(m);
    row.extend(who(m));
    row.extend([m.sphere_tests, m.detect_calls, m.contacts].map(|c| c.to_string()));
    row.extend([per_step(m.sphere_tests, m.steps), per_step(m.detect_calls, m.steps)]);
    row.push(if m.sphere_tests == 0 {
        "0".into()
    } else {
        (100.0 * m.detect_calls as f64 / m.sphere_tests as f64).to_string()
    });
    // Windows do not end with frames: nothing was shown then.
    let [tests, detects, shown] = m.shown;
    row.push(shown.to_string());
    let mean = |sum: u64| if shown == 0 { String::new() } else { (sum as f64 / shown as f64).to_string() };
    row.extend([mean(tests), mean(detects), m.largest_step.to_string()]);
    row
}

/// A row of `speed.csv`; `nothing`: time of a step with nothing detected \[s\].
pub fn speed_row(m: &Measured, nothing: f64) -> Vec<String> {
    let mut row = head(m);
    row.extend(who(m));
    row.push(m.repetitions.to_string());
    let frame = frame_seconds(m);
    row.extend([frame * 1e3, m.mean_seconds * f64::from(STEPS_PER_FRAME) * 1e3, 1.0 / frame].map(number));
    row.extend([m.step_seconds / nothing, 100.0 * (1.0 - nothing / m.step_seconds)].map(number));
    row.extend(m.stages.map(|s| number(s * 1e6)));
    row
}

/// A row of `clusters.csv`.
pub fn clusters_row(m: &Measured) -> Vec<String> {
    let mut row = head(m);
    row.push(m.arena.edge().to_string());
    row.extend(who(m));
    row.extend([m.sphere_tests, m.detect_calls].map(|c| c.to_string()));
    row.extend([per_step(m.sphere_tests, m.steps), per_step(m.detect_calls, m.steps)]);
    let broad = STAGES.iter().position(|s| *s == "broad").map_or(0.0, |i| m.stages[i]);
    row.extend([frame_seconds(m) * 1e3, 1.0 / frame_seconds(m), broad * 1e6].map(number));
    row.push(m.repetitions.to_string());
    row
}

/// A table that grows in a file.
#[derive(Debug)]
pub struct Writer {
    file: File,
    name: String,
}

impl Writer {
    /// Starts the file anew, with its header.
    ///
    /// # Errors
    /// The file cannot be written.
    pub fn create(path: &Path, header: &[&str]) -> Result<Writer, String> {
        let name = path.display().to_string();
        let file = File::create(path).map_err(|e| format!("{name}: {e}"))?;
        let mut writer = Writer { file, name };
        writer.row(header)?;
        Ok(writer)
    }

    /// Adds a row; it is in the file when this returns.
    ///
    /// # Errors
    /// The file cannot be written.
    pub fn row<S: AsRef<str>>(&mut self, fields: &[S]) -> Result<(), String> {
        let quoted: Vec<String> = fields.iter().map(|f| quoted(f.as_ref())).collect();
        let line = quoted.join(",") + "\r\n";
        self.file.write_all(line.as_bytes()).map_err(|e| format!("{}: {e}", self.name))
    }
}

fn quoted(field: &str) -> String {
    if field.contains([',', '"', '\r', '\n']) { format!("\"{}\"", field.replace('"', "\"\"")) } else { field.into() }
}

/// A table that was read.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Table {
    /// names of the columns
    pub header: Vec<String>,
    /// fields, as many in each row as there are columns
    pub rows: Vec<Vec<String>>,
}

impl Table {
    /// Reads a file. A last line that was cut off is left out: the run was interrupted while it was written.
    ///
    /// # Errors
    /// The file cannot be read, or a row has not the columns of the header.
    pub fn read(path: &Path) -> Result<Table, String> {
        let name = path.display();
        let text = std::fs::read_to_string(path).map_err(|e| format!("{name}: {e}"))?;
        let mut lines = records(&text).into_iter();
        let header = lines.next().ok_or(format!("{name}: there is no header"))?;
        let rows: Vec<Vec<String>> = lines.collect();
        match rows.iter().position(|row| row.len() != header.len()) {
            Some(i) => Err(format!("{name}: row {} has {} fields, not {}", i + 1, rows[i].len(), header.len())),
            None => Ok(Table { header, rows }),
        }
    }

    /// A field of a row as text; empty where there is no such column.
    pub fn text<'a>(&self, row: &'a [String], column: &str) -> &'a str {
        self.header.iter().position(|h| h == column).and_then(|i| row.get(i)).map_or("", String::as_str)
    }

    /// A field as a number, if it is one.
    pub fn number(&self, row: &[String], column: &str) -> Option<f64> {
        self.text(row, column).parse().ok().filter(|x: &f64| x.is_finite())
    }

    /// The method of a row.
    pub fn method(&self, row: &[String]) -> Option<Method> {
        Method::named(self.text(row, "method"))
    }
}

/// The complete records of a text.
fn records(text: &str) -> Vec<Vec<String>> {
    let (mut done, mut row, mut field, mut inside) = (Vec::new(), Vec::new(), String::new(), false);
    let mut rest = text.chars().peekable();
    while let Some(c) = rest.next() {
        match c {
            '"' if inside && rest.peek() == Some(&'"') => {
                rest.next();
                field.push('"');
            }
            '"' => inside = !inside,
            ',' if !inside => row.push(std::mem::take(&mut field)),
            '\r' if !inside => {}
            '\n' if !inside => {
                row.push(std::mem::take(&mut field));
                done.push(std::mem::take(&mut row));
            }
            c => field.push(c),
        }
    }
    done
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_written_reads_back_and_a_torn_line_is_left_out() {
        let path = std::env::temp_dir().join(format!("mrtphys-csv-{}.csv", std::process::id()));
        let mut writer = Writer::create(&path, &["a", "b"]).unwrap();
        let row = ["x, \"y\"\nz", "0.1"];
        writer.row(&row).unwrap();
        writer.file.write_all(b"torn,3").unwrap();
        let table = Table::read(&path).unwrap();
        std::fs::remove_file(&path).unwrap();
        assert_eq!(table, Table { header: vec!["a".into(), "b".into()], rows: vec![row.map(String::from).to_vec()] });
        assert_eq!(table.number(&table.rows[0], "b"), Some(0.1));
        assert_eq!(table.number(&table.rows[0], "a"), None);
    }
}
