//! The pair table: which routine answers which pair of kinds. Resolved once, from the inventory of kinds and the routines
//! declared for them; then dense, so that a look-up is one load.
//!
//! The algorithm is that of the thesis (section 6.5, Fig. 12) made sound (`registerFunction` there compares functions, and
//! leaves stale entries in the mirrored cell, which then win):
//!
//! - A declaration `(i, j)` covers every pair `(a, b)` with `a` below or equal to `i` and `b` below or equal to `j`; in a
//!   table of one hierarchy also the mirrored pair `(b, a)`, with the arguments swapped.
//! - Declarations are entered in order. An entry is overwritten only by a declaration whose **both** kinds are equally near or
//!   nearer. So the first one stands where two declarations tie, and a more special one always wins.
//! - An entry remembers its declaration, not its function: the same function may be declared for many pairs.

use super::kinds::KindId;
use super::{Placed, Routine, Touches};
use std::fmt;

/// A hierarchy: number 0 is the root, every other one has a parent of lower number.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Hierarchy {
    parents: Vec<usize>,
    depths: Vec<u32>,
}

impl Hierarchy {
    /// Only the root.
    pub fn root() -> Hierarchy {
        Hierarchy { parents: vec![0], depths: vec![0] }
    }

    /// Adds a child and returns its number; `None` where there is no such parent.
    pub fn add(&mut self, parent: usize) -> Option<usize> {
        let depth = self.depths.get(parent)? + 1;
        self.parents.push(parent);
        self.depths.push(depth);
        Some(self.parents.len() - 1)
    }

    /// How many there are.
    pub fn len(&self) -> usize {
        self.parents.len()
    }

    /// Never: there is always the root.
    pub fn is_empty(&self) -> bool {
        false
    }

    /// Steps from `below` up to its ancestor `above`; 0 for itself, `None` where `above` is no ancestor.
    pub fn distance(&self, below: usize, above: usize) -> Option<u32> {
        let wanted = *self.depths.get(above)?;
        let (mut at, mut steps) = (below, 0);
        while *self.depths.get(at)? > wanted {
            at = self.parents[at];
            steps += 1;
        }
        (at == above).then_some(steps)
    }

    /// The nearest ancestor, or the kind itself, among the first `known` ones.
    fn oldest(&self, mut at: usize, known: usize) -> usize {
        while at >= known && at > 0 {
            at = self.parents[at];
        }
        at
    }
}

/// Which declaration answers a pair.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Winner {
    /// number of the declaration, in the order given
    pub declaration: usize,
    /// whether it answers with its arguments swapped
    pub swapped: bool,
    nearness: Nearness,
}

/// Steps from each kind of a pair up to the kind that a routine was declared for.
type Nearness = (u32, u32);

fn nearness(rows: &Hierarchy, columns: &Hierarchy, pair: (usize, usize), declared: (usize, usize)) -> Option<Nearness> {
    Some((rows.distance(pair.0, declared.0)?, columns.distance(pair.1, declared.1)?))
}

/// Whether both kinds are equally near or nearer.
fn as_near(new: Nearness, old: Nearness) -> bool {
    new.0 <= old.0 && new.1 <= old.1
}

/// Resolves one cell of a table of two hierarchies.
fn winner_of_two(
    rows: &Hierarchy,
    columns: &Hierarchy,
    pair: (usize, usize),
    all: &[(usize, usize)],
) -> Option<Winner> {
    let mut stands: Option<Winner> = None;
    for (declaration, &declared) in all.iter().enumerate() {
        let found = nearness(rows, columns, pair, declared);
        if let Some(nearness) = found.filter(|&n| stands.is_none_or(|w| as_near(n, w.nearness))) {
            stands = Some(Winner { declaration, swapped: false, nearness });
        }
    }
    stands
}

/// Resolves one cell of a table of one hierarchy, where a declaration answers the swapped pair too.
fn winner_of_one(tree: &Hierarchy, pair: (usize, usize), all: &[Declaration]) -> Option<Winner> {
    let mut stands: Option<Winner> = None;
    for (declaration, d) in all.iter().enumerate() {
        let allowed = |n: &Nearness| stands.is_none_or(|w| as_near(*n, w.nearness));
        let [direct, mirrored] = ways(tree, pair, d.kinds).map(|way| way.filter(allowed));
        let (nearness, swapped) = match (direct, mirrored) {
            (None, None) => continue,
            (Some(n), None) => (n, false),
            (None, Some(n)) => (n, true),
            // Either will do. The nearness is chosen so that both orders of the pair see the same declarations win.
            (Some(n), Some(m)) => (if pair.0 <= pair.1 { n } else { m }, is_entered_swapped(tree, pair, d)),
        };
        stands = Some(Winner { declaration, swapped, nearness });
    }
    stands
}

/// How near a declaration is to a pair, as declared and with its arguments swapped; `None`: it does not cover it.
fn ways(tree: &Hierarchy, pair: (usize, usize), declared: (usize, usize)) -> [Option<Nearness>; 2] {
    [nearness(tree, tree, pair, declared), nearness(tree, tree, pair, (declared.1, declared.0))]
}

/// Which way round the thesis's order of registration enters a declaration that covers a pair both ways. It fills the cells
/// by ascending kinds, each with its mirror: of a cell and its mirror the second fill stands where both are equally near (a
/// kind with itself), else the first. A kind added later copies its parent's cells.
fn is_entered_swapped(tree: &Hierarchy, pair: (usize, usize), d: &Declaration) -> bool {
    let (a, b) = (tree.oldest(pair.0, d.known), tree.oldest(pair.1, d.known));
    if d.kinds.0 == d.kinds.1 { a < b } else { a > b }
}

/// The thesis's algorithm for two hierarchies of their own (Figures 11 and 12): row by row, which declaration answers.
pub fn resolve_two(rows: &Hierarchy, columns: &Hierarchy, declared: &[(usize, usize)]) -> Vec<Vec<Option<Winner>>> {
    let cell = |a, b| winner_of_two(rows, columns, (a, b), declared);
    (0..rows.len()).map(|a| (0..columns.len()).map(|b| cell(a, b)).collect()).collect()
}

/// What the table holds for a pair.
#[derive(Clone, Copy, Debug)]
pub struct Entry {
    /// the routine
    pub routine: Routine,
    /// whether it wants the pair the other way round
    pub swapped: bool,
    /// the routine's name
    pub name: &'static str,
}

impl Entry {
    /// Calls the routine for the pair in the order of the look-up: contacts are appended with normals from `a` to `b`.
    #[inline]
    pub fn call(&self, a: &Placed<'_>, b: &Placed<'_>, out: &mut Touches) {
        if self.swapped {
            let first = out.list.len();
            (self.routine)(b, a, out);
            out.flip_from(first);
        } else {
            (self.routine)(a, b, out);
        }
    }
}

/// A pair for which two declarations tie: each is nearer in one of the kinds. The first declared stands.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Ambiguity {
    /// the two kinds
    pub kinds: (String, String),
    /// name of the routine that stands
    pub stands: &'static str,
    /// name of the routine that it ties with
    pub against: &'static str,
}

/// A declared routine, with the kinds it was declared for.
#[derive(Clone, Copy, Debug)]
pub(super) struct Declaration {
    pub kinds: (usize, usize),
    /// how many kinds there were when it was declared
    pub known: usize,
    pub name: &'static str,
    pub routine: Routine,
}

/// The resolved table.
#[derive(Clone, Debug)]
pub struct PairTable {
    names: Vec<String>,
    /// row by row
    entries: Vec<Entry>,
    ambiguities: Vec<Ambiguity>,
}

impl PairTable {
    /// Resolves the declarations. The first one must be for the root and itself: it answers whatever nothing else does.
    pub(super) fn resolve(names: &[String], tree: &Hierarchy, declarations: &[Declaration]) -> PairTable {
        debug_assert_eq!(declarations.first().map(|d| d.kinds), Some((0, 0)));
        let n = tree.len();
        let mut table =
            PairTable { names: names.to_vec(), entries: Vec::with_capacity(n * n), ambiguities: Vec::new() };
        for pair in (0..n).flat_map(|a| (0..n).map(move |b| (a, b))) {
            let root = Winner { declaration: 0, swapped: false, nearness: (u32::MAX, u32::MAX) };
            let stands = winner_of_one(tree, pair, declarations).unwrap_or(root);
            let d = &declarations[stands.declaration];
            table.entries.push(Entry { routine: d.routine, swapped: stands.swapped, name: d.name });
            if pair.0 <= pair.1 {
                table.note_ambiguities(tree, declarations, pair, stands);
            }
        }
        table
    }

    /// Notes every declaration that covers the pair and is nearer in one kind than the one that stands, whichever way round
    /// either is read. None is nearer in both: it would have overwritten it.
    fn note_ambiguities(&mut self, tree: &Hierarchy, all: &[Declaration], pair: (usize, usize), stands: Winner) {
        let best: Vec<Nearness> = ways(tree, pair, all[stands.declaration].kinds).into_iter().flatten().collect();
        for (_, d) in all.iter().enumerate().filter(|&(k, _)| k != stands.declaration) {
            let covers: Vec<Nearness> = ways(tree, pair, d.kinds).into_iter().flatten().collect();
            let beaten = covers.iter().any(|&n| best.iter().any(|&s| as_near(s, n)));
            if !covers.is_empty() && !beaten {
                let kinds = (self.names[pair.0].clone(), self.names[pair.1].clone());
                self.ambiguities.push(Ambiguity { kinds, stands: all[stands.declaration].name, against: d.name });
            }
        }
    }

    /// What answers a pair. Every pair of kinds of the inventory that made this table has an entry.
    #[inline]
    pub fn lookup(&self, a: KindId, b: KindId) -> Entry {
        self.entries[a.0 as usize * self.names.len() + b.0 as usize]
    }

    /// Pairs for which two declarations tie, each pair of kinds once.
    pub fn ambiguities(&self) -> &[Ambiguity] {
        &self.ambiguities
    }
}

impl fmt::Display for PairTable {
    /// Rows: the first kind; columns: the second; `~`: called with the arguments swapped.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let n = self.names.len();
        let cell = |e: &Entry| format!("{}{}", if e.swapped { "~" } else { "" }, e.name);
        let mut columns: Vec<Vec<String>> = vec![vec![String::new()]];
        columns[0].extend(self.names.iter().cloned());
        for b in 0..n {
            let mut column = vec![self.names[b].clone()];
            column.extend((0..n).map(|a| cell(&self.entries[a * n + b])));
            columns.push(column);
        }
        let widths: Vec<usize> =
            columns.iter().map(|c| c.iter().map(|s| s.chars().count()).max().unwrap_or(0)).collect();
        for row in 0..=n {
            let line: Vec<String> =
                columns.iter().zip(&widths).map(|(c, &w)| format!("{:w$}", c[row], w = w)).collect();
            writeln!(f, "{}", line.join("  ").trim_end())?;
        }
        writeln!(f, "\nrow: first kind, column: second kind, ~: called with the arguments swapped")
    }
}
