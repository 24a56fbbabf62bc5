//! The `mrtphys` program.

mod cli;
mod choices;
mod exit;
mod interrupt;

mod setup;
mod plan;
mod run;
mod progress;

mod output;
mod binary;
mod cast;
mod report;
mod json;
mod events;
mod trajectory;
mod summary;

mod render_args;
#[cfg(feature = "view")]
mod render;
#[cfg(not(feature = "view"))]
#[path = "render_none.rs"]
mod render;

#[cfg(feature = "testbed")]
mod testbed;
#[cfg(not(feature = "testbed"))]
#[path = "testbed_none.rs"]
mod testbed;

mod check;
mod list;
mod bench;
mod experiment;

fn main() -> std::process::ExitCode {
    cli::main()
}
