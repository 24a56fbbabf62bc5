//! Convex hulls with exact predicates.
