//! `mrtphys experiment`: the comparison of section 5.3.4 of the thesis redone, continued to a hundred thousand bodies, and
//! its claim about clustered scenes put to the test.

pub mod csv;
pub mod figures;
pub mod measure;
pub mod methods;
pub mod plan;
pub mod report;
pub mod scenes;

use csv::{Table, Writer};
use figures::Tables;
use measure::{Measured, Which};
use methods::Method;
use plan::{Plan, Stage};
use scenes::Arena;
use std::io::Write;
use std::path::{Path, PathBuf};

const HELP: &str = "\
The thesis's comparison of broad phases: tests and frame rates over the number of bodies, and what becomes of them in
clustered scenes. Writes tables (CSV, row by row as they are measured), figures (SVG) and a report (index.html).

Usage: mrtphys experiment [-o FOLDER] [--quick] [--draw] [--threads N] [--quiet]

  -o, --output FOLDER  where to write (default: out/experiment)
      --quick          small scenes and a second of simulated time: to see that it works
      --draw           measure nothing, draw the tables that are in the folder
      --threads N      threads to compute with (default: 1, as the thesis's machine; 0: one for each core)
      --quiet          no progress on stderr
";

struct Options {
    folder: PathBuf,
    quick: bool,
    draw: bool,
    threads: usize,
    quiet: bool,
}

/// Runs the command with the arguments that follow its name.
///
/// # Errors
/// What is wrong with the arguments or the folder, in words.
pub fn run(args: &[String]) -> Result<(), String> {
    if args.iter().any(|a| a == "--help" || a == "-h") {
        return say(HELP);
    }
    let options = parse(args)?;
    if !options.draw {
        std::fs::create_dir_all(&options.folder).map_err(|e| format!("{}: {e}", options.folder.display()))?;
        let plan = if options.quick { plan::quick() } else { plan::full() };
        let pool = rayon::ThreadPoolBuilder::new().num_threads(options.threads).build().map_err(|e| e.to_string())?;
        pool.install(|| measure_all(&plan, &options))?;
    }
    let tables = draw(&options.folder)?;
    say(&report::text(&tables))?;
    say(&format!("{}\n", options.folder.join("index.html").display()))
}

fn parse(args: &[String]) -> Result<Options, String> {
    let mut options = Options { folder: "out/experiment".into(), quick: false, draw: false, threads: 1, quiet: false };
    let mut rest = args.iter();
    while let Some(arg) = rest.next() {
        let mut value = || rest.next().ok_or(format!("{arg} needs a value"));
        match arg.as_str() {
            "-o" | "--output" => options.folder = value()?.into(),
            "--quick" => options.quick = true,
            "--draw" => options.draw = true,
            "--quiet" => options.quiet = true,
            "--threads" => {
                let text = value()?;
                options.threads = text
                    .parse()
                    .ok()
                    .filter(|n| *n <= 1024)
                    .ok_or(format!("--threads: '{text}' is not a number from 0 to 1024"))?;
            }
            other => return Err(format!("experiment: '{other}' is not known; see 'mrtphys experiment --help'")),
        }
    }
    Ok(options)
}

/// On stdout, where a closed pipe is an error and no panic.
fn say(text: &str) -> Result<(), String> {
    std::io::stdout().lock().write_all(text.as_bytes()).map_err(|e| format!("stdout: {e}"))
}

/// The tables while they grow.
struct Books {
    counts: Writer,
    speed: Writer,
    clusters: Writer,
    /// time of a step of the present scene with nothing detected \[s\]
    nothing: f64,
    quiet: bool,
}

fn measure_all(plan: &Plan, options: &Options) -> Result<(), String> {
    let create = |name: &str, header: &[&str]| Writer::create(&options.folder.join(name), header);
    let mut books = Books {
        counts: create("counts.csv", &csv::COUNTS)?,
        speed: create("speed.csv", &csv::SPEED)?,
        clusters: create("clusters.csv", &csv::CLUSTERS)?,
        nothing: f64::NAN,
        quiet: options.quiet,
    };
    for (i, stage) in plan.stages.iter().enumerate() {
        books.tell(&format!("scene {} of {}: {}", i + 1, plan.stages.len(), stage.arena.name()));
        measure_stage(stage, plan, &mut books)?;
        draw(&options.folder)?;
    }
    Ok(())
}

/// What is measured from the start first, '0 test' among it, then what is measured in windows of one run.
fn measure_stage(stage: &Stage, plan: &Plan, books: &mut Books) -> Result<(), String> {
    let (all, windows): (Vec<_>, Vec<_>) = stage.cases.iter().partition(|c| matches!(c.1, Which::All { .. }));
    for (method, which) in all {
        books.enter(&measure::all_steps(stage.arena, method, which.measured(), plan.patience)?)?;
    }
    if !windows.is_empty() {
        for measured in measure::in_windows(stage.arena, &windows, plan.patience)? {
            books.enter(&measured)?;
        }
    }
    Ok(())
}

impl Books {
    fn enter(&mut self, m: &Measured) -> Result<(), String> {
        if m.method == Method::Nothing {
            self.nothing = m.step_seconds;
        }
        match m.arena {
            Arena::Cube { .. } => {
                self.counts.row(&csv::counts_row(m))?;
                self.speed.row(&csv::speed_row(m, self.nothing))?;
            }
            Arena::Clusters { .. } => self.clusters.row(&csv::clusters_row(m))?,
        }
        self.tell(&format!(
            "  {:<12} {:>4} steps, {:>12.1} tests and {:>10.1} special tests a step, {:>9.4} ms a step",
            m.method.name(),
            m.steps,
            m.sphere_tests as f64 / f64::from(m.steps),
            m.detect_calls as f64 / f64::from(m.steps),
            1e3 * m.step_seconds
        ));
        Ok(())
    }

    /// Progress; a closed stderr is no reason to stop.
    fn tell(&self, text: &str) {
        if !self.quiet {
            let _ = writeln!(std::io::stderr().lock(), "{text}");
        }
    }
}

/// Draws the tables of a folder: figures and report, each replaced as a whole.
fn draw(folder: &Path) -> Result<Tables, String> {
    let read = |name: &str| Table::read(&folder.join(name));
    let tables = Tables { counts: read("counts.csv")?, speed: read("speed.csv")?, clusters: read("clusters.csv")? };
    let figures = figures::all(&tables);
    let page = report::html(&tables, &figures);
    for (name, text) in figures.iter().map(|f| (f.0, &f.1)).chain([("index.html", &page)]) {
        let (path, fresh) = (folder.join(name), folder.join(format!(".{name}.new")));
        std::fs::write(&fresh, text)
            .and_then(|()| std::fs::rename(&fresh, &path))
            .map_err(|e| format!("{}: {e}", path.display()))?;
    }
    Ok(tables)
}
