//! Algorithm III.
