//! The sum of all fields.
