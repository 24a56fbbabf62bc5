//! The exact routines against slow twins, closed forms and reference vectors.

mod bodies;
mod flat_landing;
mod overlap;
mod spheres;
mod timing;
