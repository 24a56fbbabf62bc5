//! Walks a TOML document along the table of keys. Everything that is wrong is found in one pass.

use super::keys::{Case, Key, Kind, Table};
use super::value::{self, Checked, Reason, Refusal, Val};
use crate::source::Span;
use mrtphys::def::BroadPhaseKind;
use mrtphys::math::{Quat, Vec3};
use toml::de::{DeArray, DeTable, DeValue};

/// A table that was read.
#[derive(Clone, Debug)]
pub(crate) struct Record {
    /// the table in the text
    pub span: Span,
    /// the case that its `kind` names
    pub case: Option<&'static Case>,
    entries: Vec<Entry>,
}

#[derive(Clone, Debug)]
struct Entry {
    key: &'static str,
    value: Val,
    span: Span,
}

macro_rules! getter {
    ($name:ident, $variant:ident, $t:ty) => {
        pub fn $name(&self, key: &str) -> Option<$t> {
            match self.get(key) {
                Some(Val::$variant(v)) => Some(v.clone()),
                _ => None,
            }
        }
    };
}

impl Record {
    fn get(&self, key: &str) -> Option<&Val> {
        self.entries.iter().find(|e| e.key == key).map(|e| &e.value)
    }

    /// Where a key's value is in the text; the table, where the key is missing.
    pub fn span_of(&self, key: &str) -> Span {
        self.entries.iter().find(|e| e.key == key).map_or(self.span, |e| e.span)
    }

    pub fn case_name(&self) -> &'static str {
        self.case.map_or("", |c| c.name)
    }

    getter!(text, Text, String);
    getter!(bool, Bool, bool);
    getter!(integer, Integer, i64);
    getter!(number, Number, f64);
    getter!(vector, Vector, Vec3);
    getter!(quaternion, Quaternion, Quat);
    getter!(points, Points, Vec<Vec3>);
    getter!(faces, Faces, Vec<Vec<u32>>);
    getter!(names, Names, Vec<String>);
    getter!(counts, Counts, [u32; 3]);

    pub fn table(&self, key: &str) -> Option<&Record> {
        match self.get(key) {
            Some(Val::Table(r)) => Some(r),
            _ => None,
        }
    }

    pub fn tables(&self, key: &str) -> &[Record] {
        match self.get(key) {
            Some(Val::Tables(r)) => r,
            _ => &[],
        }
    }

    pub fn map(&self, key: &str) -> &[(String, Record)] {
        match self.get(key) {
            Some(Val::Map(m)) => m,
            _ => &[],
        }
    }

    /// A text that names a choice, or the choice's default.
    pub fn choice<T: std::str::FromStr>(&self, key: &str) -> Option<T> {
        self.text(key).and_then(|t| t.parse().ok())
    }
}

/// Most findings kept; more are only counted.
const MOST_KEPT: usize = 1000;

/// What was found wrong.
#[derive(Debug, Default)]
pub(crate) struct Findings {
    pub list: Vec<(Span, String)>,
    pub more: usize,
}

impl Findings {
    pub fn push(&mut self, span: impl Into<Span>, message: String) {
        if self.list.len() < MOST_KEPT {
            self.list.push((span.into(), message));
        } else {
            self.more += 1;
        }
    }
}

/// Where the walk is: the object that messages name, and the way from it to the present table (`shape.`).
struct Here<'a> {
    object: &'a str,
    path: &'a str,
}

impl Here<'_> {
    fn message(&self, key: &str, reason: &Reason) -> String {
        match reason {
            Reason::Plain(r) => format!("{}: {}{key}: {r}", self.object, self.path),
            Reason::Joined(r) => format!("{}: {}{key}{r}", self.object, self.path),
        }
    }

    /// About the present table as a whole.
    fn remark(&self, what: String) -> String {
        match self.path.strip_suffix('.') {
            Some(path) => format!("{}: {path}: {what}", self.object),
            None => format!("{}: {what}", self.object),
        }
    }
}

/// Reads a whole scene.
pub(crate) fn document(root: &DeTable, span: Span, found: &mut Findings) -> Record {
    table(&super::tables::SCENE, root, span, &Here { object: "scene", path: "" }, found)
}

fn table(spec: &'static Table, t: &DeTable, span: Span, here: &Here, found: &mut Findings) -> Record {
    let case = match case_of(spec, t, span, here, found) {
        Ok(case) => case,
        // Without its kind, nothing sensible can be said about the other keys.
        Err(()) => return Record { span, case: None, entries: Vec::new() },
    };
    let mut entries = Vec::new();
    for (k, v) in t.iter() {
        let name: &str = k.get_ref();
        if name == "kind" && !spec.cases.is_empty() {
            continue;
        }
        let Some(key) = spec.keys_with(case).find(|key| key.name == name) else {
            found.push(k.span(), here.remark(unknown_key(spec, case, name)));
            continue;
        };
        match checked(key, v.get_ref(), v.span(), here, found) {
            Ok(Some(value)) => entries.push(Entry { key: key.name, value, span: v.span().into() }),
            Ok(None) => {}
            Err(refusal) => {
                let place = refusal.span.unwrap_or(v.span());
                found.push(place, here.message(key.name, &refusal.reason));
            }
        }
    }
    completeness(spec, case, t, span, here, found);
    Record { span, case, entries }
}

/// The case that `kind` names.
fn case_of(
    spec: &Table,
    t: &DeTable,
    span: Span,
    here: &Here,
    found: &mut Findings,
) -> Result<Option<&'static Case>, ()> {
    if spec.cases.is_empty() {
        return Ok(None);
    }
    let Some(v) = t.get("kind") else {
        if let Some(default) = spec.default_case {
            return Ok(spec.case(default));
        }
        found.push(span, here.remark("key 'kind' is missing".into()));
        return Err(());
    };
    let names = || spec.cases.iter().map(|c| c.name).collect::<Vec<_>>();
    let chosen = value::text(v.get_ref()).and_then(|s| one_of(&s, &names(), spec.refused).map_err(Refusal::from));
    match chosen {
        Ok(name) => Ok(spec.case(&name)),
        Err(refusal) => {
            found.push(v.span(), here.message("kind", &refusal.reason));
            Err(())
        }
    }
}

/// Missing keys, and keys that exclude each other.
fn completeness(spec: &Table, case: Option<&'static Case>, t: &DeTable, span: Span, here: &Here, found: &mut Findings) {
    for key in spec.keys_with(case).filter(|k| k.required && !t.contains_key(k.name)) {
        found.push(span, here.remark(format!("key '{}' is missing", key.name)));
    }
    let there = |set: &[&'static str]| set.iter().copied().filter(|k| t.contains_key(*k)).collect::<Vec<_>>();
    let one_of_case = case.map_or(&[][..], |c| c.exactly_one);
    if !one_of_case.is_empty() && there(one_of_case).is_empty() {
        found.push(span, here.remark(format!("key '{}' is missing", one_of_case.join("' or '"))));
    }
    for set in spec.at_most_one.iter().copied().chain([one_of_case]) {
        if let [first, second, ..] = there(set)[..] {
            let place = t.iter().find(|(k, _)| k.get_ref() == second).map_or(span, |(k, _)| k.span().into());
            found.push(place, here.remark(format!("'{first}' and '{second}' exclude each other")));
        }
    }
}

fn unknown_key(spec: &Table, case: Option<&'static Case>, name: &str) -> String {
    let shown: String = name.escape_debug().take(64).collect();
    if let Some(case) = case
        && spec.cases.iter().any(|c| c.keys.iter().any(|k| k.name == name))
    {
        return format!("key '{shown}' does not belong to kind '{}'", case.name);
    }
    let kind = (!spec.cases.is_empty()).then_some("kind");
    let known: Vec<&str> = spec.keys_with(case).map(|k| k.name).chain(kind).collect();
    match nearest(name, &known) {
        Some(best) => format!("unknown key '{shown}', did you mean '{best}'?"),
        None => format!("unknown key '{shown}'; known are {}", known.join(", ")),
    }
}

/// `, did you mean 'rubber'?`, or nothing.
pub(crate) fn tip(name: &str, known: &[&str]) -> String {
    nearest(name, known).map(|best| format!(", did you mean '{best}'?")).unwrap_or_default()
}

/// The known name most like this one, if any is.
fn nearest<'a>(name: &str, known: &[&'a str]) -> Option<&'a str> {
    const LIKE: f64 = 0.8;
    // Comparing is quadratic in the lengths, and nobody mistypes 64 characters.
    let name: String = name.chars().take(64).collect::<String>().to_lowercase().replace('-', "_");
    let scored = known.iter().map(|k| (strsim::jaro_winkler(&name, &k.replace('-', "_")), *k));
    scored.filter(|(s, _)| *s >= LIKE).max_by(|a, b| a.0.total_cmp(&b.0)).map(|(_, k)| k)
}

fn one_of(s: &str, names: &[&str], refused: &[&str]) -> Result<String, String> {
    if names.contains(&s) {
        return Ok(s.to_string());
    }
    let shown: String = s.escape_debug().take(64).collect();
    if refused.contains(&s) {
        return Err(format!("'{shown}': not in this version"));
    }
    Err(match nearest(s, names) {
        Some(best) => format!("unknown value '{shown}', did you mean '{best}'?"),
        None => format!("unknown value '{shown}'; known are {}", names.join(", ")),
    })
}

/// A key's value; `None`: what is wrong with it has been said already.
fn checked(
    key: &'static Key,
    v: &DeValue,
    at: std::ops::Range<usize>,
    here: &Here,
    found: &mut Findings,
) -> Checked<Option<Val>> {
    Ok(Some(match key.kind {
        Kind::Text => Val::Text(value::text(v)?),
        Kind::Name => Val::Text(value::name(v)?),
        Kind::Color => Val::Text(value::color(v)?),
        Kind::File => Val::Text(value::file(v)?),
        Kind::Bool => match v {
            DeValue::Boolean(b) => Val::Bool(*b),
            other => return Err(value::wrong_type("true or false", other)),
        },
        Kind::Integer { low, high } => Val::Integer(value::integer(v, low, high)?),
        Kind::Number(range) => Val::Number(value::number(v, &range)?),
        Kind::Vector(range) => Val::Vector(value::vector(v, &range)?),
        Kind::Direction => Val::Vector(value::direction(v)?),
        Kind::Quaternion => Val::Quaternion(value::quaternion(v)?),
        Kind::Points { least, most } => Val::Points(value::points(v, least, most)?),
        Kind::Faces => Val::Faces(value::faces(v)?),
        Kind::Names => Val::Names(value::names(v)?),
        Kind::Counts => Val::Counts(value::counts(v)?),
        Kind::Choice { names, refused } => Val::Text(one_of(&value::text(v)?, &names(), refused)?),
        Kind::BroadPhase => Val::Text(broad_phase(&value::text(v)?)?),
        Kind::Table(of) => match v {
            DeValue::Table(t) => {
                let path = format!("{}{}.", here.path, key.name);
                // A section is its own object; a table in an object is a field of it.
                let inner = match here.object {
                    "scene" => Here { object: key.name, path: "" },
                    object => Here { object, path: &path },
                };
                Val::Table(table(of, t, at.into(), &inner, found))
            }
            other => return Err(value::wrong_type("a table", other)),
        },
        Kind::Tables { of, least } => match v {
            DeValue::Array(a) => return tables(key.name, of, least, a, here, found).map(|t| Some(Val::Tables(t))),
            DeValue::Table(_) => {
                let name = key.name;
                return Err(
                    format!("expected a list of tables, found a table: write [[{name}]] instead of [{name}]").into()
                );
            }
            other => return Err(value::wrong_type("a list of tables", other)),
        },
        Kind::Map(of) => match v {
            DeValue::Table(t) => Val::Map(map(key.name, of, t, found)),
            other => return Err(value::wrong_type("a table of tables", other)),
        },
    }))
}

fn broad_phase(s: &str) -> Result<String, String> {
    let name = s.split(':').next().unwrap_or_default();
    if super::tables::REFUSED_BROAD_PHASES.contains(&name) {
        return Err(format!("'{name}': not in this version"));
    }
    let shown: String = s.escape_debug().take(64).collect();
    match s.parse::<BroadPhaseKind>() {
        Ok(kind) => Ok(kind.to_string()),
        Err(known) => {
            let names = ["brute-force", "regular-grid", "adaptive-tree", "sorted-grid"];
            match nearest(name, &names).filter(|best| *best != name) {
                Some(best) => Err(format!("unknown value '{shown}', did you mean '{best}'?")),
                None if names.contains(&name) => Err(format!("'{shown}': {known}")),
                None => Err(format!("unknown value '{shown}'; known are {known}")),
            }
        }
    }
}

fn tables(
    name: &'static str,
    of: &'static Table,
    least: usize,
    a: &DeArray,
    here: &Here,
    found: &mut Findings,
) -> Checked<Vec<Record>> {
    if a.len() < least {
        return Err(Refusal::from(format!("expected at least {least} table(s), found {}", a.len())));
    }
    let mut out = Vec::with_capacity(a.len());
    for (i, e) in a.iter().enumerate() {
        let path = format!("{}{name}[{i}].", here.path);
        let DeValue::Table(t) = e.get_ref() else {
            let reason = value::wrong_type("a table", e.get_ref()).reason;
            found.push(e.span(), here.message(&format!("{name}[{i}]"), &reason));
            continue;
        };
        let own_name = t.get("name").and_then(|n| n.get_ref().as_str()).filter(|n| value::check_name(n).is_ok());
        let own = match own_name {
            Some(n) => format!("{name} '{n}'"),
            // What may have a name is called by its default name, the rest by its number.
            None if of.keys_with(None).any(|k| k.name == "name") => format!("{name} '{name}{i}'"),
            None => format!("{name} {i}"),
        };
        let inner = match here.object {
            "scene" => Here { object: &own, path: "" },
            object => Here { object, path: &path },
        };
        out.push(table(of, t, e.span().into(), &inner, found));
    }
    Ok(out)
}

fn map(name: &'static str, of: &'static Table, t: &DeTable, found: &mut Findings) -> Vec<(String, Record)> {
    let mut out = Vec::with_capacity(t.len());
    for (k, v) in t.iter() {
        let object = format!("{name} '{}'", k.get_ref().escape_debug());
        if let Err(reason) = value::check_name(k.get_ref()) {
            found.push(k.span(), format!("{object}: {reason}"));
        }
        match v.get_ref() {
            DeValue::Table(inner) => {
                let here = Here { object: &object, path: "" };
                out.push((k.get_ref().to_string(), table(of, inner, v.span().into(), &here, found)));
            }
            other => found.push(v.span(), format!("{object}: expected a table, found {}", value::type_name(other))),
        }
    }
    out
}

/// Checks a single value, for tests of the table of keys.
#[cfg(test)]
pub(crate) fn check_value(key: &'static Key, v: &DeValue, found: &mut Findings) -> Checked<Option<Val>> {
    checked(key, v, 0..0, &Here { object: "test", path: "" }, found)
}
