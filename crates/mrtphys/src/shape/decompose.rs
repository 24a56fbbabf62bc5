//! Convex pieces of a non-convex polyhedron.
