//! Body tables as CSV (RFC 4180) with a header line.

use super::{Reading, TableRow, TableRows, TableShape};
use crate::diagnostics::{Diagnostic, Diagnostics, MOST_REPORTED, Place};
use std::borrow::Cow;
use std::fmt::Write as _;
use std::io::{BufRead, BufReader, Read};

/// Longest line \[bytes\].
const LONGEST_LINE: u64 = 1 << 16;

const COLUMNS: [&str; 18] = [
    "body", "px", "py", "pz", "qx", "qy", "qz", "qw", "vx", "vy", "vz", "wx", "wy", "wz", "kind", "radius", "mass",
    "material",
];
const REQUIRED: [&str; 5] = ["px", "py", "pz", "kind", "radius"];

/// A field of a line, with its first byte's place in the line.
type Field<'a> = (usize, Cow<'a, str>);

struct Lines<R> {
    input: R,
    number: usize,
    bytes: Vec<u8>,
}

impl<R: BufRead> Lines<R> {
    /// The next line without its end; `None` at the end of the file.
    fn next(&mut self, reading: &Reading) -> Result<Option<&str>, Diagnostics> {
        self.bytes.clear();
        let mut bounded = (&mut self.input).take(LONGEST_LINE + 1);
        let n = bounded.read_until(b'\n', &mut self.bytes).map_err(|e| reading.fail(format!("cannot read: {e}")))?;
        if n == 0 {
            return Ok(None);
        }
        self.number += 1;
        if n as u64 > LONGEST_LINE {
            return Err(reading.fail(format!("line {}: longer than {LONGEST_LINE} bytes", self.number)));
        }
        if self.number == 1 && self.bytes.starts_with(b"\xEF\xBB\xBF") {
            self.bytes.drain(..3);
        }
        while let Some(b'\n' | b'\r') = self.bytes.last() {
            self.bytes.pop();
        }
        match std::str::from_utf8(&self.bytes) {
            Ok(line) => Ok(Some(line)),
            Err(e) => {
                let good = String::from_utf8_lossy(&self.bytes[..e.valid_up_to()]).into_owned();
                Err(diagnostic(reading, self.number, &good, good.len(), "the text is not UTF-8".into()).into())
            }
        }
    }
}

fn diagnostic(reading: &Reading, line: usize, text: &str, at: usize, message: String) -> Diagnostic {
    let column = text[..at.min(text.len())].chars().count() + 1;
    let shown: String = text.chars().take(160).map(|c| if c.is_control() { '\u{FFFD}' } else { c }).collect();
    // A place beyond what is shown has no caret line to stand in.
    let place = Place { line, column, width: 1, shown_from: if column <= 160 { 1 } else { column }, shown };
    Diagnostic { file: reading.name.clone(), place: Some(place), message }
}

/// Splits a line into fields: quoted ones may hold commas, and quotes doubled.
fn split(line: &str) -> Result<Vec<Field<'_>>, (usize, String)> {
    let mut fields = Vec::with_capacity(COLUMNS.len());
    let mut at = 0;
    loop {
        let rest = &line[at..];
        let end = if rest.starts_with('"') {
            let (length, text) = quoted(rest).ok_or((at, "a quoted field is not closed".to_string()))?;
            fields.push((at, text));
            at + length
        } else {
            let length = rest.find(',').unwrap_or(rest.len());
            fields.push((at, Cow::Borrowed(rest[..length].trim())));
            at + length
        };
        match line[end..].chars().next() {
            None => return Ok(fields),
            Some(',') => at = end + 1,
            Some(_) => return Err((end, "expected a comma after the quoted field".into())),
        }
    }
}

/// Length and text of the quoted field that this begins with.
fn quoted(s: &str) -> Option<(usize, Cow<'_, str>)> {
    let mut end = 1;
    loop {
        end += s[end..].find('"')? + 1;
        if !s[end..].starts_with('"') {
            let inner = &s[1..end - 1];
            let text = if inner.contains('"') { Cow::Owned(inner.replace("\"\"", "\"")) } else { Cow::Borrowed(inner) };
            return Some((end, text));
        }
        end += 1;
    }
}

/// For each known column, which field of a line it is.
fn header(line: &str) -> Result<[Option<usize>; COLUMNS.len()], (usize, String)> {
    let mut at = [None; COLUMNS.len()];
    for (i, (start, name)) in split(line)?.iter().enumerate() {
        let Some(c) = COLUMNS.iter().position(|c| c == name) else {
            let shown: String = name.escape_debug().take(64).collect();
            return Err((*start, format!("unknown column '{shown}'; known are {}", COLUMNS.join(", "))));
        };
        if at[c].replace(i).is_some() {
            return Err((*start, format!("column '{name}' is there twice")));
        }
    }
    match REQUIRED.iter().find(|r| at[column(r)].is_none()) {
        Some(missing) => Err((0, format!("column '{missing}' is missing"))),
        None => Ok(at),
    }
}

fn column(name: &str) -> usize {
    COLUMNS.iter().position(|c| *c == name).unwrap_or(0)
}

pub(super) fn read(file: impl Read, reading: &Reading) -> Result<TableRows, Diagnostics> {
    let mut lines = Lines { input: BufReader::new(file), number: 0, bytes: Vec::new() };
    let mut out = TableRows::default();
    let columns = match lines.next(reading)? {
        None => return Err(reading.fail("the table is empty; it needs a header line".into())),
        Some(line) => header(line).map_err(|(at, m)| Diagnostics::from(diagnostic(reading, 1, line, at, m)))?,
    };
    let mut wrong = Vec::new();
    while let Some(line) = lines.next(reading)? {
        if line.is_empty() {
            continue;
        }
        if out.rows.len() as u64 == reading.left {
            return Err(reading.too_many());
        }
        let parsed = split(line).and_then(|fields| row(&fields, &columns, line.len(), reading, &mut out));
        if let Err((at, message)) = parsed {
            let line = line.to_string();
            wrong.push(diagnostic(reading, lines.number, &line, at, message));
            if wrong.len() > MOST_REPORTED {
                break;
            }
        }
    }
    if wrong.is_empty() { Ok(out) } else { Err(Diagnostics::new(wrong)) }
}

/// Reads one body.
fn row(
    fields: &[Field],
    columns: &[Option<usize>; COLUMNS.len()],
    length: usize,
    reading: &Reading,
    out: &mut TableRows,
) -> Result<(), (usize, String)> {
    let wanted = columns.iter().flatten().count();
    if fields.len() != wanted {
        return Err((length, format!("{} fields, the header has {wanted}", fields.len())));
    }
    let field = |name: &str| columns[column(name)].map(|i| &fields[i]).filter(|(_, t)| !t.is_empty());
    let number = |name: &str, default: Option<f64>| match (field(name), default) {
        (Some((at, text)), _) => match text.parse::<f64>() {
            Ok(x) if x.is_finite() => Ok(x),
            _ => Err((
                *at,
                format!("{name}: '{}' is not a finite number", text.escape_debug().take(24).collect::<String>()),
            )),
        },
        (None, Some(default)) => Ok(default),
        (None, None) => Err((columns[column(name)].map_or(0, |i| fields[i].0), format!("{name} is missing"))),
    };
    let (zero, one) = (Some(0.0), Some(1.0));
    let mut row = TableRow { radius: number("radius", None)?, mass: number("mass", zero)?, ..TableRow::PLAIN };
    let (p, v, w, q) = (&mut row.position, &mut row.velocity, &mut row.angular_velocity, &mut row.orientation);
    (p.x, p.y, p.z) = (number("px", None)?, number("py", None)?, number("pz", None)?);
    (q.x, q.y, q.z, q.w) = (number("qx", zero)?, number("qy", zero)?, number("qz", zero)?, number("qw", one)?);
    (v.x, v.y, v.z) = (number("vx", zero)?, number("vy", zero)?, number("vz", zero)?);
    (w.x, w.y, w.z) = (number("wx", zero)?, number("wy", zero)?, number("wz", zero)?);
    let Some((at, kind)) = field("kind") else { return Err((0, "kind is missing".into())) };
    row.shape = match TableShape::ALL.iter().find(|(n, _)| n == kind) {
        Some((_, shape)) => *shape,
        None => {
            let shown: String = kind.escape_debug().take(64).collect();
            return Err((*at, format!("kind: unknown value '{shown}'; known are sphere, tetrahedron")));
        }
    };
    if let Some((at, name)) = field("material") {
        row.material = material(name, reading, out).map_err(|m| (*at, m))?;
    }
    row.check().map_err(|m| (0, m))?;
    if columns[column("body")].is_some() {
        let (at, name) = field("body").ok_or((0, "body: a name must not be empty".to_string()))?;
        crate::format::value::check_name(name).map_err(|m| (*at, format!("body: {m}")))?;
        out.names.push(name);
    }
    out.rows.push(row);
    Ok(())
}

fn material(name: &str, reading: &Reading, out: &mut TableRows) -> Result<u32, String> {
    if let Some(i) = out.materials.iter().position(|m| m == name) {
        return Ok(i as u32);
    }
    if !reading.knows(name) {
        return Err(format!("material: there is no material '{}'", name.escape_debug().take(64).collect::<String>()));
    }
    out.materials.push(name.to_string());
    Ok(out.materials.len() as u32 - 1)
}

/// A table as CSV; numbers read back bit for bit.
pub fn write(table: &TableRows) -> String {
    let named = !table.names.is_empty();
    let mut s = COLUMNS[usize::from(!named)..].join(",");
    s.push_str("\r\n");
    for (i, r) in table.rows.iter().enumerate() {
        if named {
            let _ = write!(s, "\"{}\",", table.names.get(i).replace('"', "\"\""));
        }
        let q = r.orientation;
        let numbers = r.position.to_array().into_iter().chain([q.x, q.y, q.z, q.w]);
        for x in numbers.chain(r.velocity.to_array()).chain(r.angular_velocity.to_array()) {
            let _ = write!(s, "{x:?},");
        }
        let kind = TableShape::ALL[r.shape as usize].0;
        let material = table.materials.get(r.material as usize).map_or("", |m| m.as_str());
        let _ = write!(s, "{kind},{:?},{:?},\"{}\"\r\n", r.radius, r.mass, material.replace('"', "\"\""));
    }
    s
}
