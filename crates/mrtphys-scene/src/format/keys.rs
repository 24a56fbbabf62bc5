//! What the table of keys is made of.

/// A range of numbers, with its description for messages.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Range {
    pub low: f64,
    pub high: f64,
    pub text: &'static str,
}

/// What a key's value may be.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Kind {
    /// a line of text
    Text,
    /// a name: 1 to 256 characters, no control characters
    Name,
    /// `#rrggbb`
    Color,
    /// the name of a file in the scene's folder or below
    File,
    Bool,
    Integer {
        low: i64,
        high: i64,
    },
    Number(Range),
    /// three numbers
    Vector(Range),
    /// three numbers that are not all zero
    Direction,
    /// four numbers that are not all zero
    Quaternion,
    /// points, three numbers each
    Points {
        least: usize,
        most: usize,
    },
    /// lists of at least three point numbers
    Faces,
    /// a list of names
    Names,
    /// three positive integers
    Counts,
    /// one of these texts; the refused ones exist, but not in this version
    Choice {
        names: fn() -> Vec<&'static str>,
        refused: &'static [&'static str],
    },
    /// a broad phase, with parameters after colons
    BroadPhase,
    /// a table
    Table(&'static Table),
    /// an array of tables
    Tables {
        of: &'static Table,
        least: usize,
    },
    /// a table of tables with names of the author's
    Map(&'static Table),
}

/// A key.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Key {
    pub name: &'static str,
    pub kind: Kind,
    pub doc: &'static str,
    /// TOML text of the default
    pub default: Option<&'static str>,
    pub required: bool,
}

impl Key {
    pub const fn new(name: &'static str, kind: Kind, doc: &'static str) -> Key {
        Key { name, kind, doc, default: None, required: false }
    }

    pub const fn or(self, default: &'static str) -> Key {
        Key { default: Some(default), ..self }
    }

    pub const fn required(self) -> Key {
        Key { required: true, ..self }
    }
}

/// The keys that a value of `kind` brings with it.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Case {
    pub name: &'static str,
    pub doc: &'static str,
    pub keys: &'static [Key],
    /// exactly one of these must be there
    pub exactly_one: &'static [&'static str],
}

/// A table of the format.
#[derive(Debug)]
pub(crate) struct Table {
    /// what messages call it
    pub name: &'static str,
    pub doc: &'static str,
    pub keys: &'static [&'static [Key]],
    /// alternatives, chosen by the key `kind`
    pub cases: &'static [Case],
    /// the case where `kind` is missing; `None`: it must be there
    pub default_case: Option<&'static str>,
    /// cases that exist, but not in this version
    pub refused: &'static [&'static str],
    /// at most one of each set may be there
    pub at_most_one: &'static [&'static [&'static str]],
}

impl Table {
    pub const PLAIN: Table =
        Table { name: "", doc: "", keys: &[], cases: &[], default_case: None, refused: &[], at_most_one: &[] };

    /// The keys of all cases, and those of one.
    pub fn keys_with<'a>(&'a self, case: Option<&'a Case>) -> impl Iterator<Item = &'static Key> + 'a {
        self.keys.iter().flat_map(|k| k.iter()).chain(case.map_or(&[][..], |c| c.keys))
    }

    pub fn case(&self, name: &str) -> Option<&'static Case> {
        self.cases.iter().find(|c| c.name == name)
    }
}
