//! From TOML values to checked values. Numbers are converted here, from their text, so that what a number means does not
//! depend on the TOML library: correctly rounded to double precision, tiny ones to zero, too large ones refused.

use super::keys::Range;
use mrtphys::math::{Quat, Vec3};
use toml::de::{DeArray, DeInteger, DeValue};

/// A value that its key allows.
#[derive(Clone, Debug)]
pub(crate) enum Val {
    Text(String),
    Bool(bool),
    Integer(i64),
    Number(f64),
    Vector(Vec3),
    Quaternion(Quat),
    Points(Vec<Vec3>),
    Faces(Vec<Vec<u32>>),
    Counts([u32; 3]),
    Names(Vec<String>),
    Table(super::read::Record),
    Tables(Vec<super::read::Record>),
    Map(Vec<(String, super::read::Record)>),
}

/// Why a value is refused, and which bytes of the text are to blame (`None`: the whole value).
#[derive(Debug)]
pub(crate) struct Refusal {
    pub reason: Reason,
    pub span: Option<std::ops::Range<usize>>,
}

#[derive(Debug)]
pub(crate) enum Reason {
    /// follows `FIELD: `
    Plain(String),
    /// follows `FIELD`
    Joined(String),
}

impl From<String> for Refusal {
    fn from(s: String) -> Refusal {
        Refusal { reason: Reason::Plain(s), span: None }
    }
}

impl Refusal {
    fn at(mut self, span: std::ops::Range<usize>) -> Refusal {
        self.span.get_or_insert(span);
        self
    }

    fn joined(s: String) -> Refusal {
        Refusal { reason: Reason::Joined(s), span: None }
    }
}

pub(crate) type Checked<T> = Result<T, Refusal>;

/// How messages call the type of a value.
pub(crate) fn type_name(v: &DeValue) -> &'static str {
    match v {
        DeValue::String(_) => "a string",
        DeValue::Integer(_) => "an integer",
        DeValue::Float(_) => "a number",
        DeValue::Boolean(_) => "a truth value",
        DeValue::Datetime(_) => "a date",
        DeValue::Array(_) => "an array",
        DeValue::Table(_) => "a table",
    }
}

pub(crate) fn wrong_type(expected: &str, v: &DeValue) -> Refusal {
    Refusal::from(format!("expected {expected}, found {}", type_name(v)))
}

/// The first characters of a number's text, for messages: it may have a hundred thousand digits.
fn short(text: &str) -> String {
    const LONGEST: usize = 24;
    let mut s: String = text.chars().take(LONGEST).collect();
    if s.len() < text.len() {
        s.push_str("...");
    }
    s
}

fn parse_integer(i: &DeInteger) -> Checked<i64> {
    let text = i.as_str();
    i64::from_str_radix(text, i.radix()).map_err(|e| match e.kind() {
        std::num::IntErrorKind::PosOverflow | std::num::IntErrorKind::NegOverflow => Refusal::from(format!(
            "the integer {} does not fit into 64 bits; a number of this size needs a decimal point or an exponent",
            short(text)
        )),
        _ => Refusal::from(format!("'{}' is not a number", short(&i.to_string()))),
    })
}

fn parse_number(v: &DeValue) -> Checked<f64> {
    match v {
        DeValue::Integer(i) => Ok(parse_integer(i)? as f64),
        DeValue::Float(f) => {
            let text = f.as_str();
            let x: f64 = text.parse().map_err(|_| Refusal::from(format!("'{}' is not a number", short(text))))?;
            if x.is_finite() {
                return Ok(x);
            }
            let bare = text.trim_start_matches(['+', '-']);
            Err(Refusal::from(match bare.starts_with(|c: char| c.is_ascii_digit()) {
                true => format!("the number {} is too large", short(text)),
                false => format!("{} is not a finite number", short(text)),
            }))
        }
        other => Err(wrong_type("a number", other)),
    }
}

/// A number in a range.
pub(crate) fn number(v: &DeValue, range: &Range) -> Checked<f64> {
    let x = parse_number(v)?;
    if x < range.low || x > range.high {
        return Err(Refusal::joined(format!(" = {x:?} is out of range: {}", range.text)));
    }
    Ok(x)
}

/// An integer in a range.
pub(crate) fn integer(v: &DeValue, low: i64, high: i64) -> Checked<i64> {
    let DeValue::Integer(i) = v else { return Err(wrong_type("an integer", v)) };
    let x = parse_integer(i)?;
    if low == high && x != low {
        // The version of the format: the one number there is.
        return Err(Refusal::joined(format!(" = {x}: not in this version; there is {low}")));
    }
    if x < low || x > high {
        return Err(Refusal::joined(format!(" = {x} is out of range: {low} to {high}")));
    }
    Ok(x)
}

fn elements<'a, 'i>(v: &'a DeValue<'i>, what: &str, n: usize) -> Checked<&'a DeArray<'i>> {
    match v {
        DeValue::Array(a) if a.len() == n => Ok(a),
        DeValue::Array(a) => Err(Refusal::from(format!("expected {what}, found {}", a.len()))),
        other => Err(wrong_type(what, other)),
    }
}

fn numbers<const N: usize>(v: &DeValue, what: &str, range: &Range) -> Checked<[f64; N]> {
    let mut out = [0.0; N];
    for (x, e) in out.iter_mut().zip(elements(v, what, N)?.iter()) {
        *x = number(e.get_ref(), range).map_err(|r| r.at(e.span()))?;
    }
    Ok(out)
}

/// Three numbers in a range.
pub(crate) fn vector(v: &DeValue, range: &Range) -> Checked<Vec3> {
    let [x, y, z] = numbers(v, "3 numbers [x, y, z]", range)?;
    Ok(Vec3::new(x, y, z))
}

const COMPONENT: Range = Range { low: -1e150, high: 1e150, text: "-1e150 to 1e150" };

/// A vector that is not zero.
pub(crate) fn direction(v: &DeValue) -> Checked<Vec3> {
    let d = vector(v, &COMPONENT)?;
    if d == Vec3::ZERO {
        return Err(Refusal::from("a direction must not be [0, 0, 0]".to_string()));
    }
    Ok(d)
}

/// A quaternion that is not zero.
pub(crate) fn quaternion(v: &DeValue) -> Checked<Quat> {
    let q: [f64; 4] = numbers(v, "4 numbers [x, y, z, w]", &COMPONENT)?;
    if q == [0.0; 4] {
        return Err(Refusal::from("a quaternion must not be [0, 0, 0, 0]".to_string()));
    }
    Ok(Quat::new(q[0], q[1], q[2], q[3]))
}

/// Points.
pub(crate) fn points(v: &DeValue, least: usize, most: usize) -> Checked<Vec<Vec3>> {
    let DeValue::Array(a) = v else { return Err(wrong_type("a list of points", v)) };
    if a.len() < least || a.len() > most {
        let wanted = if least == most { format!("{least} points") } else { format!("{least} to {most} points") };
        return Err(Refusal::from(format!("expected {wanted}, found {}", a.len())));
    }
    a.iter().map(|p| vector(p.get_ref(), &COMPONENT).map_err(|r| r.at(p.span()))).collect()
}

/// Lists of point numbers.
pub(crate) fn faces(v: &DeValue) -> Checked<Vec<Vec<u32>>> {
    let DeValue::Array(a) = v else { return Err(wrong_type("a list of faces", v)) };
    let face = |f: &DeValue| -> Checked<Vec<u32>> {
        let DeValue::Array(corners) = f else { return Err(wrong_type("a list of corner numbers", f)) };
        if corners.len() < 3 {
            return Err(Refusal::from(format!("a face needs at least 3 corners, found {}", corners.len())));
        }
        let corner = |c: &toml::Spanned<DeValue>| {
            integer(c.get_ref(), 0, super::tables::MOST_POINTS as i64 - 1).map(|n| n as u32).map_err(|r| r.at(c.span()))
        };
        corners.iter().map(corner).collect()
    };
    a.iter().map(|f| face(f.get_ref()).map_err(|r| r.at(f.span()))).collect()
}

/// Three positive integers.
pub(crate) fn counts(v: &DeValue) -> Checked<[u32; 3]> {
    let mut out = [0; 3];
    for (n, e) in out.iter_mut().zip(elements(v, "3 integers", 3)?.iter()) {
        *n = integer(e.get_ref(), 1, crate::scene::MOST_BODIES as i64).map_err(|r| r.at(e.span()))? as u32;
    }
    Ok(out)
}

/// A string.
pub(crate) fn text(v: &DeValue) -> Checked<String> {
    match v {
        DeValue::String(s) => Ok(s.to_string()),
        other => Err(wrong_type("a string", other)),
    }
}

/// Longest name \[characters\].
const LONGEST_NAME: usize = 256;

/// A name as an author may choose it.
pub(crate) fn name(v: &DeValue) -> Checked<String> {
    let s = text(v)?;
    check_name(&s).map_err(Refusal::from)?;
    Ok(s)
}

pub(crate) fn check_name(s: &str) -> Result<(), String> {
    if s.is_empty() {
        return Err("a name must not be empty".into());
    }
    if s.chars().count() > LONGEST_NAME {
        return Err(format!("a name must not be longer than {LONGEST_NAME} characters"));
    }
    if s.chars().any(char::is_control) {
        return Err("a name must not contain control characters".into());
    }
    Ok(())
}

/// A list of names.
pub(crate) fn names(v: &DeValue) -> Checked<Vec<String>> {
    let DeValue::Array(a) = v else { return Err(wrong_type("a list of names", v)) };
    a.iter().map(|e| name(e.get_ref()).map_err(|r| r.at(e.span()))).collect()
}

/// `#rrggbb`, kept as text.
pub(crate) fn color(v: &DeValue) -> Checked<String> {
    let s = text(v)?;
    match crate::scene::Color::parse(&s) {
        Some(_) => Ok(s),
        None => Err(Refusal::from(format!("'{s}' is not a color, expected '#rrggbb'"))),
    }
}

/// The name of a file in the scene's folder or below: no other file is ever opened on behalf of a scene.
pub(crate) fn file(v: &DeValue) -> Checked<String> {
    let s = text(v)?;
    // Written out for every system: what leaves the folder on one must not be read on another.
    let leaves = s.starts_with('/')
        || s.contains(['\\', ':'])
        || s.chars().any(char::is_control)
        || s.split('/').any(|part| part.is_empty() || part == "." || part == "..");
    if leaves {
        let reason = format!("'{}' is not a file in the scene's folder or below", s.escape_debug());
        return Err(Refusal::from(reason));
    }
    Ok(s)
}
