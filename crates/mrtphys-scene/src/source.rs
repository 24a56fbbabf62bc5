//! Scene text: read with a bound, decoded, and asked for lines and columns.

use crate::diagnostics::{Diagnostic, Diagnostics, Place};
use std::io::Read;
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// The largest scene text \[bytes\]. What is larger is a body table's business. Never more than this is read.
pub const LARGEST_TEXT: u64 = 64 << 20;

/// A half-open range of bytes of the scene text.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Span {
    /// first byte
    pub start: u32,
    /// one past the last byte
    pub end: u32,
}

impl From<std::ops::Range<usize>> for Span {
    // The text is shorter than 2^32 bytes: `LARGEST_TEXT`.
    fn from(r: std::ops::Range<usize>) -> Span {
        Span { start: r.start as u32, end: r.end as u32 }
    }
}

/// A scene's text, where it came from, and where its tables are looked for.
#[derive(Clone, Debug, PartialEq)]
pub struct Source {
    /// the name in messages: a path, or a gallery scene's name
    pub name: Arc<str>,
    /// the text, without byte-order mark
    pub text: Arc<str>,
    /// the folder that file names in the scene are relative to; `None`: the scene may name no files
    pub folder: Option<PathBuf>,
}

impl Source {
    /// Text that is already in memory.
    ///
    /// # Errors
    /// It is not UTF-8, or it is larger than [`LARGEST_TEXT`].
    pub fn from_bytes(name: &str, bytes: &[u8], folder: Option<&Path>) -> Result<Source, Diagnostics> {
        if bytes.len() as u64 > LARGEST_TEXT {
            return Err(too_large(name).into());
        }
        // A byte-order mark is accepted and counts as no column.
        let bytes = bytes.strip_prefix(b"\xEF\xBB\xBF").unwrap_or(bytes);
        match std::str::from_utf8(bytes) {
            Ok(text) => Ok(Source { name: name.into(), text: text.into(), folder: folder.map(Into::into) }),
            Err(e) => Err(invalid_utf8(name, bytes, e.valid_up_to()).into()),
        }
    }

    /// A file's text; the file's folder is the scene's.
    ///
    /// # Errors
    /// The file cannot be read, is larger than [`LARGEST_TEXT`] (no more than that is read), or is not UTF-8.
    pub fn read(path: &Path) -> Result<Source, Diagnostics> {
        let name = path.display().to_string();
        let fail = |e: std::io::Error| Diagnostics::from(Diagnostic::without_place(&name, format!("cannot read: {e}")));
        let file = std::fs::File::open(path).map_err(fail)?;
        let mut bytes = Vec::new();
        file.take(LARGEST_TEXT + 1).read_to_end(&mut bytes).map_err(fail)?;
        let folder = match path.parent() {
            Some(p) if !p.as_os_str().is_empty() => p,
            _ => Path::new("."),
        };
        Source::from_bytes(&name, &bytes, Some(folder))
    }

    /// Line and column of a range, with the line's text.
    pub fn place(&self, span: Span) -> Place {
        place(&self.text, span.start as usize, span.end as usize)
    }

    /// A diagnostic about a range of the text.
    pub fn diagnostic(&self, span: Span, message: String) -> Diagnostic {
        Diagnostic { file: self.name.to_string(), place: Some(self.place(span)), message }
    }
}

fn too_large(name: &str) -> Diagnostic {
    let limit = LARGEST_TEXT >> 20;
    Diagnostic::without_place(
        name,
        format!("the scene text is larger than {limit} MiB; put many bodies into a [[body_table]]"),
    )
}

fn invalid_utf8(name: &str, bytes: &[u8], good: usize) -> Diagnostic {
    let text = std::str::from_utf8(&bytes[..good]).unwrap_or_default();
    let mut place = place(text, good, good);
    // What follows on the line is no text; the message shows what there is of it.
    place.width = 1;
    let hint = match bytes {
        [0xFF, 0xFE, ..] | [0xFE, 0xFF, ..] => ": it looks like UTF-16; save it as UTF-8",
        _ => "",
    };
    let message = format!("the text is not UTF-8 (byte 0x{:02X} at offset {good}){hint}", bytes[good]);
    Diagnostic { file: name.into(), place: Some(place), message }
}

/// Longest line shown with a message \[characters\]; longer ones are cut around the place.
const LONGEST_SHOWN: usize = 160;

fn place(text: &str, start: usize, end: usize) -> Place {
    let floor = |i: usize| {
        let mut i = i.min(text.len());
        while !text.is_char_boundary(i) {
            i -= 1;
        }
        i
    };
    let (start, end) = (floor(start), floor(end));
    let line_start = text[..start].rfind('\n').map_or(0, |i| i + 1);
    let line_end = text[start..].find('\n').map_or(text.len(), |i| start + i);
    let line = text[..start].bytes().filter(|&b| b == b'\n').count() + 1;
    let column = text[line_start..start].chars().count() + 1;
    let width = text[start..end.clamp(start, line_end)].trim_end().chars().count().max(1);
    let shown = text[line_start..line_end].trim_end_matches('\r');
    let first = if column + 40 > LONGEST_SHOWN { column - 40 } else { 0 };
    let shown: String = shown
        .chars()
        .skip(first)
        .take(LONGEST_SHOWN)
        .map(|c| if c.is_control() && c != '\t' { '\u{FFFD}' } else { c })
        .collect();
    Place { line, column, width, shown, shown_from: first + 1 }
}
