//! Stage 3: candidate pairs. Contract: every pair of bodies whose bounding spheres meet, and every body with every boundary
//! whose bounds it reaches, exactly once, in any order. A broad phase that works with boxes (the thesis's two) may leave out
//! a pair whose bounding spheres meet although its boxes do not: a body whose box is clear of a limit's face and that does
//! not reach behind it, two bodies with boxes tighter than their spheres. No pair routine calls those a contact, and the
//! thesis's own counts differ between its methods for this reason (figure 6). The caller sorts contacts, so the choice of
//! the broad phase changes the speed and never the trajectory.

pub mod brute_force;
pub mod regular_grid;
pub mod adaptive_tree;
pub mod sorted_grid;
mod scene;

pub use adaptive_tree::AdaptiveTree;
pub use brute_force::BruteForce;
pub use regular_grid::RegularGrid;
pub use sorted_grid::SortedGrid;

use crate::bounds::{Aabb, Ball, BoundaryBounds};
use crate::def::BroadPhaseKind;

/// What a broad phase sees of the world.
#[derive(Clone, Copy, Debug)]
pub struct BoundsView<'a> {
    /// bounding sphere of every body, by slot; an empty ball takes no part
    pub balls: &'a [Ball],
    /// bounding box of every body, by slot; empty unless [`BroadPhase::wants_boxes`]
    pub boxes: &'a [Aabb],
    /// whether a body has infinite mass; two such never collide. Empty: none has
    pub fixed: &'a [bool],
    /// the boundaries
    pub boundaries: &'a [BoundaryBounds],
    /// changes whenever bodies or boundaries were added, removed, re-ordered or moved by hand, so that memory from the
    /// last step must be forgotten
    pub epoch: u64,
}

impl BoundsView<'_> {
    /// Whether the body in a slot has infinite mass.
    #[inline]
    pub fn is_fixed(&self, slot: u32) -> bool {
        self.fixed.get(slot as usize).copied().unwrap_or(false)
    }
}

/// What a broad phase finds.
#[derive(Clone, Debug, Default)]
pub struct Candidates {
    /// pairs of body slots whose bounding spheres meet, the two in any order
    pub pairs: Vec<[u32; 2]>,
    /// body slot and boundary index, where the body reaches the boundary's bounds
    pub walls: Vec<[u32; 2]>,
    /// pairs compared, boundaries included
    pub sphere_tests: u64,
}

impl Candidates {
    /// Forgets everything, keeps the memory.
    pub fn clear(&mut self) {
        self.pairs.clear();
        self.walls.clear();
        self.sphere_tests = 0;
    }
}

/// A cell or node of a broad phase, for drawing.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Cell {
    /// its box \[m\]
    pub bounds: Aabb,
    /// level below the root; 0 in a grid
    pub depth: u32,
    /// objects listed in it
    pub objects: u32,
}

/// A broad phase. What it remembers from step to step only saves time: dropping it changes no result.
pub trait BroadPhase: Send + Sync {
    /// Name as on the command line, with parameters.
    fn name(&self) -> String;

    /// Whether [`BoundsView::boxes`] must be filled.
    fn wants_boxes(&self) -> bool {
        false
    }

    /// Finds the candidates. `out` is cleared by the caller.
    fn find(&mut self, view: &BoundsView<'_>, out: &mut Candidates);

    /// The cells that are in use, for drawing; empty where there are none.
    fn cells(&self) -> Vec<Cell> {
        Vec::new()
    }
}

/// Makes the broad phase that is asked for.
pub fn make(kind: BroadPhaseKind) -> Box<dyn BroadPhase> {
    match kind {
        BroadPhaseKind::BruteForce => Box::new(BruteForce),
        BroadPhaseKind::RegularGrid { resolution } => Box::new(RegularGrid::new(resolution)),
        BroadPhaseKind::AdaptiveTree { objects_per_cell, max_depth } => {
            Box::new(AdaptiveTree::new(objects_per_cell, max_depth))
        }
        BroadPhaseKind::SortedGrid => Box::new(SortedGrid::default()),
    }
}
