//! JSON that a person can read: the members of the outermost object and the elements of its lists of objects stand on a
//! line each, everything deeper on that line.

use serde_json::ser::Formatter;
use std::io::{self, Write};

/// Lays out a report.
#[derive(Default)]
pub struct Layout {
    depth: usize,
    /// whether depth 2 is a list
    list: bool,
    /// whether objects stand in that list, so that its bracket needs a line of its own
    rows: bool,
}

impl Formatter for Layout {
    fn begin_object<W: ?Sized + Write>(&mut self, to: &mut W) -> io::Result<()> {
        if self.depth == 2 && self.list {
            // An object in a list in the report: a body.
            to.write_all(b"\n    ")?;
            self.rows = true;
        }
        self.depth += 1;
        self.list &= self.depth > 2;
        to.write_all(b"{")
    }

    fn end_object<W: ?Sized + Write>(&mut self, to: &mut W) -> io::Result<()> {
        self.depth -= 1;
        to.write_all(if self.depth == 0 { b"\n}\n" } else { b"}" })
    }

    fn begin_object_key<W: ?Sized + Write>(&mut self, to: &mut W, first: bool) -> io::Result<()> {
        match (self.depth, first) {
            (1, true) => to.write_all(b"\n  "),
            (1, false) => to.write_all(b",\n  "),
            (_, true) => Ok(()),
            (_, false) => to.write_all(b", "),
        }
    }

    fn begin_object_value<W: ?Sized + Write>(&mut self, to: &mut W) -> io::Result<()> {
        to.write_all(b": ")
    }

    fn begin_array<W: ?Sized + Write>(&mut self, to: &mut W) -> io::Result<()> {
        self.depth += 1;
        if self.depth == 2 {
            (self.list, self.rows) = (true, false);
        }
        to.write_all(b"[")
    }

    fn end_array<W: ?Sized + Write>(&mut self, to: &mut W) -> io::Result<()> {
        self.depth -= 1;
        let close: &[u8] = if self.depth == 1 && self.rows { b"\n  ]" } else { b"]" };
        to.write_all(close)
    }

    fn begin_array_value<W: ?Sized + Write>(&mut self, to: &mut W, first: bool) -> io::Result<()> {
        if first { Ok(()) } else { to.write_all(b",") }
    }
}

/// Writes a value in this layout.
pub fn write(to: &mut dyn Write, value: &impl serde::Serialize) -> io::Result<()> {
    let mut serializer = serde_json::Serializer::with_formatter(to, Layout::default());
    value.serialize(&mut serializer).map_err(io::Error::from)
}

#[cfg(test)]
mod tests {
    use serde_json::json;

    #[test]
    fn a_body_is_a_line() {
        let value = json!({"n": 1.5, "bodies": [{"p": [1, 2], "q": {}}, {"p": []}], "v": [1, 2], "e": [], "o": {"a": [[1]], "b": {}}});
        let mut text = Vec::new();
        super::write(&mut text, &value).unwrap();
        let text = String::from_utf8(text).unwrap();
        let expected = "{\n  \"n\": 1.5,\n  \"bodies\": [\n    {\"p\": [1,2], \"q\": {}},\n    {\"p\": []}\n  ],\n  \"v\": [1,2],\n  \"e\": [],\n  \"o\": {\"a\": [[1]], \"b\": {}}\n}\n";
        assert_eq!(text, expected);
        assert_eq!(serde_json::from_str::<serde_json::Value>(&text).unwrap(), value);
    }
}
