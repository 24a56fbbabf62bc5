//! Pair routines, one file each. A routine's file is named after the kinds of its arguments, in their order; `thesis_`
//! marks those of the contact mode `thesis`.
//!
//! A routine is declared for a kind and called for every kind below it. A shape whose type it does not know (a user's, below
//! a kind of this crate) is taken as its bounding sphere.

pub mod half_space_sphere;
pub mod never;
pub mod plane;
pub mod polyhedron_half_space;
pub mod polyhedron_polyhedron;
pub mod polyhedron_quadrangle;
pub mod quadrangle_half_space;
pub mod quadrangle_quadrangle;
pub mod sphere_polyhedron;
pub mod sphere_quadrangle;
pub mod sphere_sphere;
pub mod thesis_polyhedron_half_space;
pub mod thesis_polyhedron_polyhedron;
pub mod thesis_polyhedron_sphere;
pub mod thesis_quadrangle_half_space;
pub mod thesis_quadrangle_sphere;
pub mod thesis_sphere_sphere;

pub(crate) mod closest;
