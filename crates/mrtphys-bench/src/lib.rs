//! Benchmarks: every run reports its speed together with what makes the speed worth something: the error of its energy, its
//! collision rate against kinetic theory, and its state hash.

pub mod command;
pub mod compare;
pub mod experiment;
pub mod gas;
pub mod measure;
pub mod peers;
pub mod plot;
pub mod table;

pub use gas::{GasShape, GasSpec};
pub use measure::{Measurement, measure};
