//! One contact after the other.
