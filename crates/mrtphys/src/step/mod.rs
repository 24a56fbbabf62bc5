//! Time-stepping algorithms. Only they order the stages.

pub mod fixed_step;
