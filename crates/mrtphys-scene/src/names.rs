//! Names of bodies and boundaries. Bodies of a lattice are named by their place, so a lattice of a million bodies costs one
//! name; a name is made when it is asked for.

use crate::format::read::Findings;
use crate::scene::{BoundaryDesc, BoundaryKind, Content, Scene};
use crate::source::Span;
use crate::table::TableRows;
use mrtphys::id::{BodyId, BoundaryId};
use std::collections::BTreeMap;
use std::collections::btree_map::Entry;
use std::sync::Arc;

/// The faces of a box, in order.
pub const BOX_FACES: [&str; 6] = ["-x", "+x", "-y", "+y", "-z", "+z"];

/// Names of the bodies and boundaries of a world.
#[derive(Clone, Debug, Default)]
pub struct Names {
    groups: Vec<Group>,
    /// bodies in the order of the scene
    ids: Vec<BodyId>,
    /// how many of them were there from the start: their handles ascend
    ascending: usize,
    /// place of the bodies added later
    late: BTreeMap<BodyId, u32>,
    boundary_ids: Vec<BoundaryId>,
    boundary_names: Vec<String>,
    by_name: BTreeMap<String, Named>,
    /// the groups whose bodies have names of their own
    named_tables: Vec<u32>,
}

/// What a name stands for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Named {
    /// a body, lattice or table
    Group(u32),
    /// a boundary
    Boundary(u32),
    /// a box, whose faces have names of their own
    Box,
}

#[derive(Clone, Debug)]
struct Group {
    name: String,
    /// number of its first body
    first: usize,
    count: usize,
    kind: GroupKind,
}

#[derive(Clone, Debug)]
enum GroupKind {
    Single,
    Lattice([u32; 3]),
    /// bodies named by number
    Table,
    /// bodies with names of their own, and their numbers in order of the names
    NamedTable(Arc<TableRows>, Vec<u32>),
}

impl Group {
    fn of(content: &Content, first: usize) -> Group {
        let kind = match content {
            Content::Body(_) => GroupKind::Single,
            Content::Lattice(l) => GroupKind::Lattice(l.count),
            Content::Table(t) if t.rows.names.is_empty() => GroupKind::Table,
            Content::Table(t) => {
                let mut sorted: Vec<u32> = (0..t.rows.names.len() as u32).collect();
                sorted.sort_by(|&a, &b| t.rows.names.get(a as usize).cmp(t.rows.names.get(b as usize)));
                GroupKind::NamedTable(t.rows.clone(), sorted)
            }
        };
        Group { name: content.name().to_string(), first, count: content.count() as usize, kind }
    }

    fn name_of(&self, i: usize) -> String {
        match &self.kind {
            GroupKind::Single => self.name.clone(),
            GroupKind::Lattice([_, ny, nz]) => {
                let (ny, nz) = (*ny as usize, *nz as usize);
                format!("{}[{},{},{}]", self.name, i / (ny * nz), i / nz % ny, i % nz)
            }
            GroupKind::Table => format!("{}[{i}]", self.name),
            GroupKind::NamedTable(rows, _) => rows.names.get(i).to_string(),
        }
    }

    /// The number of the body with these indices (`3,0,2`).
    fn number(&self, indices: &str) -> Option<usize> {
        let mut parts = indices.split(',').map(|p| {
            // As they are printed: no signs, spaces or leading zeros, so that every body has one name.
            let plain = p.bytes().all(|b| b.is_ascii_digit()) && (p == "0" || !p.starts_with('0'));
            plain.then(|| p.parse::<usize>().ok()).flatten()
        });
        let mut next = || parts.next().flatten();
        let i = match &self.kind {
            GroupKind::Lattice([nx, ny, nz]) => {
                let (i, j, k) = (next()?, next()?, next()?);
                let inside = i < *nx as usize && j < *ny as usize && k < *nz as usize;
                inside.then_some((i * *ny as usize + j) * *nz as usize + k)?
            }
            GroupKind::Table => next()?,
            GroupKind::Single | GroupKind::NamedTable(..) => return None,
        };
        (i < self.count && indices.split(',').count() == self.indices()).then_some(i)
    }

    fn indices(&self) -> usize {
        if matches!(self.kind, GroupKind::Lattice(_)) { 3 } else { 1 }
    }

    /// The number of the body of this name of its own.
    fn named(&self, name: &str) -> Option<usize> {
        let GroupKind::NamedTable(rows, sorted) = &self.kind else { return None };
        let at = sorted.binary_search_by(|&i| rows.names.get(i as usize).cmp(name)).ok()?;
        Some(sorted[at] as usize)
    }
}

impl Names {
    /// The names of a scene; handles are given as the world is built.
    pub(crate) fn of(scene: &Scene, found: &mut Findings) -> Names {
        let mut names = Names::default();
        let mut bodies = 0;
        for content in &scene.contents {
            let group = Group::of(content, bodies);
            bodies += group.count;
            let what = Named::Group(names.groups.len() as u32);
            names.enter(content.name().to_string(), what, content.span(), found);
            if let GroupKind::NamedTable(..) = group.kind {
                names.named_tables.push(names.groups.len() as u32);
            }
            names.groups.push(group);
        }
        for b in &scene.boundaries {
            names.enter_boundary(b, found);
        }
        names.check_generated(scene, found);
        names
    }

    fn enter(&mut self, name: String, what: Named, span: Span, found: &mut Findings) {
        match self.by_name.entry(name) {
            Entry::Occupied(e) => found.push(span, format!("the name '{}' is there twice", e.key())),
            Entry::Vacant(e) => {
                e.insert(what);
            }
        }
    }

    fn enter_boundary(&mut self, b: &BoundaryDesc, found: &mut Findings) {
        if let BoundaryKind::Box { .. } = b.kind {
            self.enter(b.name.clone(), Named::Box, b.span, found);
            for face in BOX_FACES {
                self.enter_wall(format!("{}.{face}", b.name), b.span, found);
            }
        } else {
            self.enter_wall(b.name.clone(), b.span, found);
        }
    }

    fn enter_wall(&mut self, name: String, span: Span, found: &mut Findings) {
        let number = self.boundary_names.len() as u32;
        self.boundary_names.push(name.clone());
        self.enter(name, Named::Boundary(number), span, found);
    }

    /// Names that are made from places, and names in tables, must not be there otherwise.
    fn check_generated(&self, scene: &Scene, found: &mut Findings) {
        for (name, what) in &self.by_name {
            if self.generated(name).is_some() {
                let span = match what {
                    Named::Group(g) => scene.contents[*g as usize].span(),
                    _ => Span::default(),
                };
                found.push(span, format!("the name '{name}' is that of a body of a lattice or table"));
            }
        }
        for (group, content) in self.groups.iter().zip(&scene.contents) {
            let GroupKind::NamedTable(rows, sorted) = &group.kind else { continue };
            let mut report = |name: &str| found.push(content.span(), format!("the name '{name}' is there twice"));
            for (n, &i) in sorted.iter().enumerate() {
                let name = rows.names.get(i as usize);
                let again = n > 0 && rows.names.get(sorted[n - 1] as usize) == name;
                let elsewhere = self.by_name.contains_key(name) || self.generated(name).is_some();
                let others = || self.in_tables(name).count() > 1;
                if again || elsewhere || others() {
                    report(name);
                }
            }
        }
    }

    /// The bodies of this name in tables that name theirs.
    fn in_tables<'a>(&'a self, name: &'a str) -> impl Iterator<Item = usize> + 'a {
        let groups = self.named_tables.iter().map(|&g| &self.groups[g as usize]);
        groups.filter_map(move |g| g.named(name).map(|i| g.first + i))
    }

    /// The body whose name is made from its place.
    fn generated(&self, name: &str) -> Option<usize> {
        let (group, indices) = name.strip_suffix(']')?.rsplit_once('[')?;
        let Some(Named::Group(g)) = self.by_name.get(group) else { return None };
        let group = &self.groups[*g as usize];
        group.number(indices).map(|i| group.first + i)
    }

    pub(crate) fn set_ids(&mut self, ids: Vec<BodyId>, boundaries: Vec<BoundaryId>) {
        debug_assert!(ids.is_sorted());
        self.ascending = ids.len();
        self.ids = ids;
        self.boundary_ids = boundaries;
    }

    /// Whether a name is taken.
    pub fn is_taken(&self, name: &str) -> bool {
        self.by_name.contains_key(name) || self.place_of_name(name).is_some()
    }

    /// Appends a body to the end of the scene.
    pub(crate) fn push(&mut self, content: &Content, id: BodyId) {
        let place = self.ids.len();
        self.by_name.insert(content.name().to_string(), Named::Group(self.groups.len() as u32));
        self.groups.push(Group::of(content, place));
        self.ids.push(id);
        self.late.insert(id, place as u32);
    }

    fn place_of_name(&self, name: &str) -> Option<usize> {
        match self.by_name.get(name) {
            Some(Named::Group(g)) => {
                let group = &self.groups[*g as usize];
                matches!(group.kind, GroupKind::Single).then_some(group.first)
            }
            Some(_) => None,
            None => self.generated(name).or_else(|| self.in_tables(name).next()),
        }
    }

    /// All bodies the scene ever had, in its order; handles of removed ones are not valid in the world any more.
    pub fn bodies(&self) -> &[BodyId] {
        &self.ids
    }

    /// All boundaries, in the order of the scene.
    pub fn boundaries(&self) -> &[BoundaryId] {
        &self.boundary_ids
    }

    /// Handle of the body of this name.
    pub fn body(&self, name: &str) -> Option<BodyId> {
        self.place_of_name(name).and_then(|i| self.ids.get(i)).copied()
    }

    /// Handles of the bodies that a name stands for: one body, or all of a lattice or a table.
    pub fn bodies_of(&self, name: &str) -> Option<&[BodyId]> {
        if let Some(Named::Group(g)) = self.by_name.get(name) {
            let group = &self.groups[*g as usize];
            return self.ids.get(group.first..group.first + group.count);
        }
        let i = self.place_of_name(name)?;
        self.ids.get(i..=i)
    }

    /// Which content of the scene a body belongs to, and its number there.
    pub fn content_of(&self, id: BodyId) -> Option<(usize, usize)> {
        let place = match self.ids[..self.ascending].binary_search(&id) {
            Ok(place) => place,
            Err(_) => *self.late.get(&id)? as usize,
        };
        let g = self.groups.partition_point(|g| g.first <= place) - 1;
        // A lattice or table without bodies has no place of its own.
        Some((g, place - self.groups[g].first))
    }

    /// Name of a body.
    pub fn body_name(&self, id: BodyId) -> Option<String> {
        let (group, i) = self.content_of(id)?;
        Some(self.groups[group].name_of(i))
    }

    /// Name of the body with this number in this content of the scene.
    pub(crate) fn name_in(&self, content: usize, i: usize) -> String {
        self.groups[content].name_of(i)
    }

    /// Handles of the bodies of a content of the scene.
    pub(crate) fn ids_in(&self, content: usize) -> &[BodyId] {
        let g = &self.groups[content];
        &self.ids[g.first..g.first + g.count]
    }

    /// Handle of the boundary of this name.
    pub fn boundary(&self, name: &str) -> Option<BoundaryId> {
        match self.by_name.get(name) {
            Some(Named::Boundary(i)) => self.boundary_ids.get(*i as usize).copied(),
            _ => None,
        }
    }

    /// Name of a boundary.
    pub fn boundary_name(&self, id: BoundaryId) -> Option<&str> {
        let i = self.boundary_ids.binary_search(&id).ok()?;
        self.boundary_names.get(i).map(|s| s.as_str())
    }
}
