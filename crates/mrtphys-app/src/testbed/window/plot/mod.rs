//! What the plots show, without the plots: series over time, and what theory says of a gas.

mod csv;
mod curves;
mod gas;
pub mod grid;
mod speeds;
mod trace;

pub use csv::csv;
pub use curves::{Chart, curves, power_of_ten};
pub use gas::Gas;
pub use speeds::Histogram;
pub use trace::Trace;
