//! Pair routines, one file each.
pub mod polyhedron_half_space;
pub mod polyhedron_polyhedron;
pub mod polyhedron_quadrangle;
pub mod quadrangle_half_space;
pub mod quadrangle_quadrangle;
pub mod sphere_polyhedron;
pub mod sphere_quadrangle;
