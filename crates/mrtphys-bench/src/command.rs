//! The command `mrtphys bench`.

use crate::gas::{GasShape, GasSpec};
use crate::measure::{Window, measure};
use crate::table;
use mrtphys::BroadPhaseKind;

const HELP: &str = "\
Measures gases of spheres and tetrahedra: time per step and per body, share of each stage, error of the energy, collisions
per second against kinetic theory, bodies that escaped, state hash.

Usage: mrtphys bench [SCENE...] [--broad-phase NAME] [--threads N] [--rate STEPS_PER_SECOND] [--warm-up S] [--seconds S]

SCENE is spheres-N or tetrahedra-N with N bodies along an edge of the cube; all of the standard ones if none is named.

mrtphys bench peers --help: the same gases in other engines, side by side.
";

/// The standard scenes with what is simulated before and while timing \[s\].
const STANDARD: [(GasShape, u32, f64, f64); 7] = [
    (GasShape::Spheres, 8, 1.0, 1.0),
    (GasShape::Spheres, 16, 1.0, 1.0),
    (GasShape::Spheres, 32, 1.0, 0.5),
    (GasShape::Spheres, 47, 1.0, 0.2),
    (GasShape::Spheres, 100, 0.05, 0.04),
    (GasShape::Tetrahedra, 8, 1.0, 1.0),
    (GasShape::Tetrahedra, 16, 1.0, 0.5),
];

struct Options {
    scenes: Vec<(GasShape, u32)>,
    broad_phase: BroadPhaseKind,
    threads: usize,
    rate: u32,
    warm_up: Option<f64>,
    timed: Option<f64>,
}

/// Runs the command with the arguments that follow its name.
///
/// # Errors
/// What is wrong with the arguments, in words.
pub fn run(args: &[String]) -> Result<(), String> {
    if args.iter().any(|a| a == "--help" || a == "-h") {
        print!("{HELP}");
        return Ok(());
    }
    run_all(&parse(args)?)
}

fn parse(args: &[String]) -> Result<Options, String> {
    let mut options = Options {
        scenes: Vec::new(),
        broad_phase: BroadPhaseKind::SortedGrid,
        threads: 1,
        rate: 512,
        warm_up: None,
        timed: None,
    };
    let mut rest = args.iter();
    while let Some(arg) = rest.next() {
        let mut value = || rest.next().ok_or(format!("{arg} needs a value"));
        match arg.as_str() {
            "--broad-phase" => {
                options.broad_phase = value()?.parse().map_err(|e| format!("--broad-phase: not one of {e}"))?
            }
            "--threads" => options.threads = number(arg, value()?)? as usize,
            "--rate" => options.rate = number(arg, value()?)? as u32,
            "--warm-up" => options.warm_up = Some(number(arg, value()?)?),
            "--seconds" => options.timed = Some(number(arg, value()?)?),
            name => options.scenes.push(scene(name)?),
        }
    }
    Ok(options)
}

fn number(name: &str, text: &str) -> Result<f64, String> {
    match text.parse::<f64>() {
        Ok(x) if (0.0..=1e6).contains(&x) => Ok(x),
        _ => Err(format!("{name}: '{text}' is not a number from 0 to 10^6")),
    }
}

fn scene(name: &str) -> Result<(GasShape, u32), String> {
    let shapes = [("spheres-", GasShape::Spheres), ("tetrahedra-", GasShape::Tetrahedra)];
    let found =
        shapes.iter().find_map(|(prefix, shape)| Some((*shape, name.strip_prefix(prefix)?.parse::<u32>().ok()?)));
    found
        .filter(|(_, n)| (1..=200).contains(n))
        .ok_or(format!("no scene '{name}': spheres-N or tetrahedra-N, N from 1 to 200"))
}

fn run_all(options: &Options) -> Result<(), String> {
    let pool = rayon::ThreadPoolBuilder::new().num_threads(options.threads).build().map_err(|e| e.to_string())?;
    say(&format!(
        "mrtphys {} | {} steps/s | {} | {} thread(s) | median of the timed steps",
        env!("CARGO_PKG_VERSION"),
        options.rate,
        options.broad_phase,
        options.threads
    ))?;
    say(&table::head())?;
    for (shape, n, warm_up, timed) in chosen(options) {
        let spec = GasSpec { shape, n, rate: options.rate.max(1), broad_phase: options.broad_phase };
        let window = Window { warm_up: options.warm_up.unwrap_or(warm_up), timed: options.timed.unwrap_or(timed) };
        let measurement = pool.install(|| measure(&spec, window)).map_err(|e| e.to_string())?;
        say(&table::line(&measurement))?;
    }
    Ok(())
}

/// A line on stdout. A closed pipe ends the run in words.
fn say(line: &str) -> Result<(), String> {
    use std::io::Write;
    writeln!(std::io::stdout().lock(), "{line}").map_err(|e| format!("stdout: {e}"))
}

fn chosen(options: &Options) -> Vec<(GasShape, u32, f64, f64)> {
    if options.scenes.is_empty() {
        return STANDARD.to_vec();
    }
    let window = |shape, n| STANDARD.iter().find(|s| s.0 == shape && s.1 == n).copied().unwrap_or((shape, n, 0.5, 0.5));
    options.scenes.iter().map(|&(shape, n)| window(shape, n)).collect()
}
