//! What is wrong with a scene, said with file, line, column, object and field.

use std::fmt;

/// Most diagnostics reported at once; how many more there are is said.
pub const MOST_REPORTED: usize = 20;

/// Where in a text.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Place {
    /// line, counted from 1
    pub line: usize,
    /// column in characters, counted from 1
    pub column: usize,
    /// characters concerned, on this line
    pub width: usize,
    /// the line, or the part of a long line around the place
    pub shown: String,
    /// column of the first character of `shown`
    pub shown_from: usize,
}

/// One thing that is wrong.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Diagnostic {
    /// file, or the name of a gallery scene
    pub file: String,
    /// where; `None`: the file as a whole
    pub place: Option<Place>,
    /// what is wrong: object, field, reason
    pub message: String,
}

impl Diagnostic {
    /// A diagnostic about a file as a whole.
    pub fn without_place(file: &str, message: String) -> Diagnostic {
        Diagnostic { file: file.into(), place: None, message }
    }

    /// The first line of the message: `FILE:LINE:COLUMN: MESSAGE`.
    pub fn headline(&self) -> String {
        match &self.place {
            Some(p) => format!("{}:{}:{}: {}", self.file, p.line, p.column, self.message),
            None => format!("{}: {}", self.file, self.message),
        }
    }
}

impl fmt::Display for Diagnostic {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.headline())?;
        let Some(p) = &self.place else { return Ok(()) };
        let number = p.line.to_string();
        let gap = " ".repeat(number.len());
        // Tabs are kept in the padding, so that the caret stands below its character at any tab width.
        let skipped = p.column - p.shown_from;
        let pad: String = p.shown.chars().take(skipped).map(|c| if c == '\t' { '\t' } else { ' ' }).collect();
        let left = p.shown.chars().count().saturating_sub(skipped).max(1);
        let carets = "^".repeat(p.width.min(left));
        write!(f, "\n{gap} |\n{number} | {}\n{gap} | {pad}{carets}", p.shown)
    }
}

/// Everything that is wrong with a scene; at least one thing.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Diagnostics {
    /// the first of them, in the order of the text
    pub list: Vec<Diagnostic>,
    /// how many more there are
    pub more: usize,
}

impl Diagnostics {
    /// From everything found; the first [`MOST_REPORTED`] are kept.
    pub(crate) fn new(mut list: Vec<Diagnostic>) -> Diagnostics {
        list.sort_by_key(|d| d.place.as_ref().map(|p| (p.line, p.column)));
        list.dedup();
        let more = list.len().saturating_sub(MOST_REPORTED);
        list.truncate(MOST_REPORTED);
        Diagnostics { list, more }
    }

    /// The first of them.
    pub fn first(&self) -> Option<&Diagnostic> {
        self.list.first()
    }
}

impl From<Diagnostic> for Diagnostics {
    fn from(d: Diagnostic) -> Diagnostics {
        Diagnostics { list: vec![d], more: 0 }
    }
}

impl fmt::Display for Diagnostics {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        for (i, d) in self.list.iter().enumerate() {
            if i > 0 {
                f.write_str("\n")?;
            }
            d.fmt(f)?;
        }
        if self.more > 0 {
            write!(f, "\nand {} more", self.more)?;
        }
        Ok(())
    }
}

impl std::error::Error for Diagnostics {}
