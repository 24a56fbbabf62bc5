//! Polyhedra (thesis, sections 6.6.2, A.14, A.15), convex and not.

use super::{MassProperties, Shape};
use crate::bounds::{Aabb, Ball};
use crate::math::{Mat3, Real, Vec3};

/// A plane polygon of a polyhedron's surface.
#[derive(Clone, Debug, PartialEq)]
pub struct Face {
    /// corner numbers, counter-clockwise seen from outside
    pub corners: Vec<u32>,
    /// outward unit normal
    pub normal: Vec3,
    /// normal . x on the face \[m\]
    pub offset: Real,
    /// inside of the body: a cut between two convex pieces, which nothing outside can touch
    pub internal: bool,
}

/// An edge of a polyhedron between two faces that are not coplanar.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Edge {
    /// the two corners
    pub ends: [u32; 2],
    /// the two faces that meet in it
    pub faces: [u32; 2],
}

/// A convex polyhedron, or a convex piece of one that is not.
#[derive(Clone, Debug, PartialEq)]
pub struct ConvexPiece {
    /// corners \[m\], in the coordinates of the whole body
    pub corners: Vec<Vec3>,
    /// faces; coplanar triangles are one face
    pub faces: Vec<Face>,
    /// edges
    pub edges: Vec<Edge>,
    /// smallest enclosing sphere, in the coordinates of the whole body
    pub ball: Ball,
}

/// A rigid polyhedron; its centre of mass is the origin of its coordinates.
#[derive(Clone, Debug, PartialEq)]
pub struct Polyhedron {
    /// corners \[m\]
    pub(crate) corners: Vec<Vec3>,
    /// triangles of the surface, counter-clockwise seen from outside
    pub(crate) triangles: Vec<[u32; 3]>,
    /// faces of the surface: coplanar triangles are one face
    pub(crate) faces: Vec<Face>,
    /// edges between faces that are not coplanar
    pub(crate) edges: Vec<Edge>,
    /// convex pieces; exactly one where the polyhedron is convex
    pub(crate) pieces: Vec<ConvexPiece>,
    pub(crate) ball: Ball,
    pub(crate) mass: MassProperties,
    pub(crate) author_origin: Vec3,
    pub(crate) kind: &'static str,
}

impl Shape for Polyhedron {
    fn kind(&self) -> &'static str {
        self.kind
    }
    fn bounding_sphere(&self) -> Ball {
        self.ball
    }
    fn bounding_box(&self, position: Vec3, rotation: &Mat3) -> Aabb {
        Aabb::of_points(self.corners.iter().map(|&c| position + *rotation * c))
    }
    fn mass_properties(&self) -> Option<MassProperties> {
        Some(self.mass)
    }
    fn author_origin(&self) -> Vec3 {
        self.author_origin
    }
}
