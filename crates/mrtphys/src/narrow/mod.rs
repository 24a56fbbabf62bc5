//! Stage 4: from candidate pairs to contacts. `kinds` is the inventory of what exists, `pair_table` says which routine
//! answers which pair, `pairs/` holds one file per routine.

pub mod kinds;
pub mod pair_table;
pub mod pairs;
pub mod sat;
pub mod clip;
pub(crate) mod convex_contact;
#[cfg(test)]
mod exact_tests;

use crate::bounds::Ball;
use crate::math::{Mat3, Real, Vec3};
use crate::shape::Shape;

/// A shape in its place: what a pair routine sees of a body or a boundary.
#[derive(Clone, Copy, Debug)]
pub struct Placed<'a> {
    /// the shape
    pub shape: &'a dyn Shape,
    /// position of the centre of mass \[m\]
    pub position: Vec3,
    /// rotation from the shape's axes into the world's
    pub rotation: &'a Mat3,
    /// bounding sphere in its place
    pub ball: Ball,
    /// for a two-sided plane: the side (+1 or -1) on which the partner is at home; 0: not known
    pub home_side: Real,
}

/// One contact that a pair routine reports.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Touch {
    /// unit normal from the first shape to the second
    pub normal: Vec3,
    /// contact point \[m\], world coordinates: the one at which an impact acts
    pub point: Vec3,
    /// depth of the overlap along the normal \[m\], not negative
    pub depth: Real,
    /// which features touch: equal from step to step while the same features touch
    pub feature: u32,
    /// first of its manifold points in [`Touches::points`]
    pub first_point: u32,
    /// number of its manifold points
    pub point_count: u32,
}

/// Where a pair routine writes its contacts.
#[derive(Clone, Debug, Default)]
pub struct Touches {
    /// the contacts, in the order found
    pub list: Vec<Touch>,
    /// manifold points of all contacts \[m\], world coordinates
    pub points: Vec<Vec3>,
    /// memory of the routines for polyhedra
    pub(crate) scratch: convex_contact::PairScratch,
}

impl Touches {
    /// Reports a contact. `manifold`: the corners of the contact area; the point itself where it is a point.
    pub fn push(&mut self, normal: Vec3, point: Vec3, depth: Real, feature: u32, manifold: &[Vec3]) {
        let manifold = if manifold.is_empty() { std::slice::from_ref(&point) } else { manifold };
        let first_point = self.points.len() as u32;
        self.points.extend_from_slice(manifold);
        self.list.push(Touch { normal, point, depth, feature, first_point, point_count: manifold.len() as u32 });
    }

    /// Forgets everything, keeps the memory.
    pub fn clear(&mut self) {
        self.list.clear();
        self.points.clear();
    }

    /// Turns the contacts from `first` on round, after a routine was called with swapped arguments.
    pub fn flip_from(&mut self, first: usize) {
        for t in &mut self.list[first..] {
            t.normal = -t.normal;
        }
    }
}

/// A pair routine: reports the contacts of two placed shapes, normals from the first to the second. Called only for pairs
/// whose bounds meet.
pub type Routine = fn(&Placed<'_>, &Placed<'_>, &mut Touches);
