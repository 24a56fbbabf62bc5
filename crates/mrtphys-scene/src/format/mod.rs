//! The scene format: one table of its keys (`tables.rs`), which reading, writing of the schema and the manual's test share.

pub(crate) mod keys;
pub(crate) mod read;
pub(crate) mod tables;
pub(crate) mod value;
