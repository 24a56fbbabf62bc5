//! Generalized reflections.
