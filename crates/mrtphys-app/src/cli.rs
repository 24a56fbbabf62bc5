//! The command line.
// What stands in brackets in these comments is the help's own notation, and the help shows a backslash as one.
#![allow(rustdoc::broken_intra_doc_links)]

use crate::choices;
use crate::exit::{Failure, Outcome, complain};
use crate::plan::{End, check_seconds};
use crate::render_args::RenderArgs;
use crate::{bench, check, experiment, list, output, render, run, testbed};
use clap::{Args, Parser, Subcommand};
use mrtphys::{Algorithm, BroadPhaseKind, FrictionLaw, ImpactMode};
use std::ffi::OsString;
use std::path::PathBuf;
use std::process::ExitCode;

/// Rigid bodies that collide as physics says.
#[derive(Parser, Debug)]
#[command(name = "mrtphys", version = version())]
struct Cli {
    #[command(subcommand)]
    command: Option<Command>,
    /// No progress on stderr. Errors and warnings are never hidden
    #[arg(long, global = true)]
    quiet: bool,
}

#[derive(Subcommand, Debug)]
enum Command {
    /// The testbed on one scene
    #[command(allow_negative_numbers = true)]
    View(Box<ViewArgs>),
    /// Simulate without a window: progress on stderr, summary on stdout
    #[command(allow_negative_numbers = true)]
    Run(Box<RunArgs>),
    /// Pictures and films without a window: .png, .gif, .mp4, or a folder of pictures
    #[command(allow_negative_numbers = true)]
    Render(Box<RenderArgs>),
    /// Parse and validate a scene, report what overlaps at the start
    Check {
        /// A scene file, or the name of a gallery scene
        scene: OsString,
    },
    /// The thesis's comparison of broad phases, redone: tables, figures, report
    Experiment(Later),
    /// The physics measured against theory (not in this version)
    Validate(Later),
    /// Benchmarks: time, energy, collision rate and state hash
    Bench(Later),
    /// The gallery, a line each
    Scenes,
    /// The JSON schema of the scene format
    Schema,
}

/// Arguments of a command that takes them unread.
#[derive(Args, Debug)]
#[command(disable_help_flag = true)]
struct Later {
    #[arg(trailing_var_arg = true, allow_hyphen_values = true, hide = true)]
    args: Vec<OsString>,
}

/// Options of `run`.
#[derive(Args, Debug)]
pub struct RunArgs {
    /// A scene file, or the name of a gallery scene
    pub scene: OsString,
    /// Run to this simulated time [s] (default: the scene's own, else 10)
    #[arg(long, value_name = "S", value_parser = seconds, conflicts_with = "frames")]
    pub seconds: Option<f64>,
    /// Run to the end of this frame
    #[arg(long, value_name = "N", value_parser = frames)]
    pub frames: Option<u64>,
    #[command(flatten)]
    pub simulation: SimulationArgs,
    /// Frames per second of simulated time
    #[arg(long, value_name = "N", value_parser = rate)]
    pub fps: Option<u32>,
    /// Write the final state, energies and counters (JSON, or records with the ending .bin)
    #[arg(long, value_name = "FILE")]
    pub report: Option<PathBuf>,
    /// Write every impact (CSV, or records with the ending .bin)
    #[arg(long, value_name = "FILE")]
    pub events: Option<PathBuf>,
    /// Only impacts of these bodies or boundaries; the name of a lattice or box stands for all of it
    #[arg(long, value_name = "NAME,...", requires = "events")]
    pub events_only: Option<String>,
    /// Write every body at every frame (CSV, or records with the ending .bin)
    #[arg(long, value_name = "FILE")]
    pub trajectory: Option<PathBuf>,
    /// List the bodies in the report even if there are more than 100 000
    #[arg(long)]
    pub bodies: bool,
    /// Write the world at the end
    #[arg(long, value_name = "FILE")]
    pub snapshot: Option<PathBuf>,
}

/// Options of `view`.
#[derive(Args, Clone, Debug, Default)]
#[cfg_attr(not(feature = "testbed"), allow(dead_code))]
pub struct ViewArgs {
    /// A scene file, or the name of a gallery scene; without it, the gallery
    pub scene: Option<OsString>,
    #[command(flatten)]
    pub simulation: SimulationArgs,
    /// Frames per second of simulated time
    #[arg(long, value_name = "N", value_parser = rate)]
    pub fps: Option<u32>,
    /// Stand still at the first frame
    #[arg(long)]
    pub paused: bool,
    /// Width and height of the window at first [points]
    #[arg(long, value_name = "WxH", value_parser = crate::render_args::size)]
    pub size: Option<(u32, u32)>,
    /// For tests: write what the panel says, and where its controls are, whenever it changes
    #[arg(long, value_name = "FILE", hide = true)]
    pub status: Option<PathBuf>,
}

/// How a scene is simulated: options of every command that does.
#[derive(Args, Clone, Debug, Default)]
pub struct SimulationArgs {
    /// Time-stepping algorithm: fixed-step
    #[arg(long, value_name = "NAME", value_parser = choices::algorithm)]
    pub algorithm: Option<Algorithm>,
    /// brute-force, regular-grid[:RESOLUTION], adaptive-tree[:OBJECTS_PER_CELL[:MAX_DEPTH]] or sorted-grid
    #[arg(long, value_name = "NAME", value_parser = choices::broad_phase)]
    pub broad_phase: Option<BroadPhaseKind>,
    /// Simultaneous impacts: sequential or reflection
    #[arg(long, value_name = "NAME", value_parser = choices::impact)]
    pub impact: Option<ImpactMode>,
    /// frictionless, kurtenbach, kurtenbach-literal, velocity, rough or coulomb
    #[arg(long, value_name = "NAME", value_parser = choices::friction_law)]
    pub friction_law: Option<FrictionLaw>,
    /// Physical steps per frame
    #[arg(long, value_name = "N", value_parser = rate)]
    pub steps_per_frame: Option<u32>,
    /// Threads to compute with; 0: one for each core. The result is the same for any number
    #[arg(long, value_name = "N", default_value_t = 0, value_parser = threads)]
    pub threads: u32,
    /// Seed of the scene's random draws
    // What a scene text can say too: TOML has signed numbers.
    #[arg(long, value_name = "N", value_parser = seed)]
    pub seed: Option<u64>,
    /// Go on from a snapshot of the same scene instead of its start
    #[arg(long, value_name = "FILE")]
    pub resume: Option<PathBuf>,
}

impl RunArgs {
    /// Where the run ends, if an option says so.
    pub fn end(&self) -> Option<End> {
        self.seconds.map(End::Seconds).or(self.frames.map(End::Frames))
    }
}

pub fn seconds(text: &str) -> Result<f64, String> {
    let value: f64 = text.parse().map_err(|_| "a number of seconds is needed".to_string())?;
    check_seconds(value).map(|()| value)
}

fn frames(text: &str) -> Result<u64, String> {
    whole(text, 0, u64::MAX)
}

fn seed(text: &str) -> Result<u64, String> {
    whole(text, 0, i64::MAX as u64)
}

fn rate(text: &str) -> Result<u32, String> {
    whole(text, 1, 1_000_000_000).map(|n| n as u32)
}

fn threads(text: &str) -> Result<u32, String> {
    whole(text, 0, 1024).map(|n| n as u32)
}

/// A whole number in a range, refused in words of the user's world.
fn whole(text: &str, low: u64, high: u64) -> Result<u64, String> {
    let value = text.parse().ok().filter(|n| (low..=high).contains(n));
    value.ok_or_else(|| format!("a whole number from {low} to {high} is needed"))
}

/// Version, precision and the instruction set that this machine has.
pub fn version() -> String {
    format!("{} (f64, {})", env!("CARGO_PKG_VERSION"), instruction_set())
}

fn instruction_set() -> String {
    let mut found = vec![std::env::consts::ARCH];
    #[cfg(target_arch = "x86_64")]
    {
        let levels = [
            ("sse4.2", std::arch::is_x86_feature_detected!("sse4.2")),
            ("avx", std::arch::is_x86_feature_detected!("avx")),
            ("avx2", std::arch::is_x86_feature_detected!("avx2")),
            ("avx512f", std::arch::is_x86_feature_detected!("avx512f")),
        ];
        found.extend(levels.iter().filter(|l| l.1).map(|l| l.0));
    }
    #[cfg(target_arch = "aarch64")]
    found.extend(std::arch::is_aarch64_feature_detected!("neon").then_some("neon"));
    found.join(" ")
}

/// Reads the command line and does what it says.
pub fn main() -> ExitCode {
    match Cli::try_parse() {
        Ok(cli) => crate::exit::finish(dispatch(cli)),
        Err(e) if e.exit_code() == 0 => crate::exit::finish(output::say(&e.render().to_string())),
        Err(e) => {
            complain(&e.render().to_string());
            ExitCode::from(1)
        }
    }
}

fn dispatch(cli: Cli) -> Outcome {
    match cli.command {
        None => testbed::open(&ViewArgs::default()),
        Some(Command::View(args)) => testbed::open(&args),
        Some(Command::Render(args)) => render::render(&args, cli.quiet),
        Some(Command::Experiment(later)) => experiment::experiment(&later.args, cli.quiet),
        Some(Command::Validate(_)) => {
            Err(Failure::not_yet("'validate'", "'mrtphys run SCENE --report FILE.json' shows where the energy went"))
        }
        Some(Command::Run(args)) => run::run(&args, cli.quiet),
        Some(Command::Check { scene }) => check::check(&scene),
        Some(Command::Bench(later)) => bench::bench(&later.args),
        Some(Command::Scenes) => list::scenes(),
        Some(Command::Schema) => list::schema(),
    }
}

#[cfg(test)]
pub mod tests {
    use super::*;
    use clap::CommandFactory;

    /// The options of a `run` command line, the program's name left out.
    pub fn run_args(line: &[&str]) -> RunArgs {
        match Cli::try_parse_from([&["mrtphys"], line].concat()).unwrap().command {
            Some(Command::Run(args)) => *args,
            other => panic!("{other:?} is not 'run'"),
        }
    }

    #[test]
    fn the_command_line_is_consistent() {
        Cli::command().debug_assert();
    }
}
