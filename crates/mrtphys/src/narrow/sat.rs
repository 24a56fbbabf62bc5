//! Separating axes of convex pieces.
