//! The `mrtphys` program.
fn main() {}
