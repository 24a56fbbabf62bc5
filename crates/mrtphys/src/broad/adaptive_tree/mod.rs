//! The thesis's adaptive space subdivision (sections 5.3.3, 6.4.2, figures 5 and 10, appendix A.2): a binary tree of cells,
//! each halved across its longest extent. Objects that lie in both halves stay above them, so each object is listed once.
//! The tree is not built anew for every step but adapted to how the objects have moved.

mod maintain;
mod node;
mod query;
#[cfg(test)]
mod tests;

use super::scene::Scene;
use super::{BoundsView, BroadPhase, Candidates, Cell};
use crate::math::Real;
use node::{Arena, Frame, ROOT, Span};

/// The thesis's adaptive binary tree.
///
/// Where the thesis leaves the rules open: a leaf is split while it holds more than `objects_per_cell` objects and is above
/// the deepest level, counted from the current root; two leaves are joined when they and their parent together hold no more
/// than that; cells are halved across the longest extent, x before y before z where they are equal; an object that comes
/// nearer to a side of a cell than 2^-30 of the root's size has left it; the first root is the scene's box, wider by 10^-6
/// of its extent. Boundaries that reach to infinity are compared with every body, and so is a body that has crossed a
/// limit's face with that limit.
#[derive(Clone, Debug)]
pub struct AdaptiveTree {
    objects_per_cell: u32,
    max_depth: u32,
    scene: Scene,
    /// what the tree was built for
    known: Option<Known>,
    frame: Frame,
    /// how far boxes have been drawn out for rounding, the farthest since the tree was built \[m\]
    reach: Real,
    arena: Arena,
    /// box of every object in the tree's coordinates
    spans: Vec<Span>,
    /// scratch: nodes with their depth
    order: Vec<(u32, u32)>,
}

/// If any of this changes, object numbers mean other objects.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
struct Known {
    epoch: u64,
    bodies: usize,
    boundaries: usize,
}

impl AdaptiveTree {
    /// Deepest level that may be asked for: with more, cells are thinner than what a number can tell apart.
    pub const DEEPEST: u32 = 48;

    /// A tree whose leaves hold at most `objects_per_cell` objects, unless they are at level `max_depth` below the root. At
    /// least one object per cell and at most [`Self::DEEPEST`] levels: what lies outside is brought to the nearer end.
    pub fn new(objects_per_cell: u32, max_depth: u32) -> Self {
        AdaptiveTree {
            objects_per_cell: objects_per_cell.max(1),
            max_depth: max_depth.min(Self::DEEPEST),
            scene: Scene::default(),
            known: None,
            frame: Frame::of(&Default::default()),
            reach: 0.0,
            arena: Arena::default(),
            spans: Vec::new(),
            order: Vec::new(),
        }
    }

    /// Number of nodes, the root included; 0 before the first search.
    pub fn node_count(&self) -> usize {
        self.arena.count()
    }

    /// Deepest level in use, the root being level 0.
    pub fn depth(&self) -> u32 {
        self.walk().map(|(_, depth)| depth).max().unwrap_or(0)
    }

    /// All nodes with their depth, parents before children.
    fn walk(&self) -> impl Iterator<Item = (u32, u32)> + '_ {
        let mut stack = Vec::new();
        if !self.arena.nodes.is_empty() {
            stack.push((ROOT, 0));
        }
        std::iter::from_fn(move || {
            let (n, depth) = stack.pop()?;
            let node = &self.arena.nodes[n as usize];
            if !node.is_leaf() {
                stack.extend([(node.child, depth + 1), (node.child + 1, depth + 1)]);
            }
            Some((n, depth))
        })
    }
}

impl BroadPhase for AdaptiveTree {
    fn name(&self) -> String {
        let Self { objects_per_cell, max_depth, .. } = *self;
        crate::def::BroadPhaseKind::AdaptiveTree { objects_per_cell, max_depth }.to_string()
    }

    fn wants_boxes(&self) -> bool {
        true
    }

    fn find(&mut self, view: &BoundsView<'_>, out: &mut Candidates) {
        let walls_before = out.walls.len();
        self.scene.survey(view);
        self.adapt(view);
        self.compare(view, out);
        self.scene.finish(view, walls_before, out);
    }

    /// All nodes.
    fn cells(&self) -> Vec<Cell> {
        let cell = |(n, depth): (u32, u32)| {
            let node = &self.arena.nodes[n as usize];
            Cell { bounds: self.frame.bounds(&node.cell), depth, objects: node.num }
        };
        self.walk().map(cell).collect()
    }
}
