//! `mrtphys run`: simulate without a window.

use crate::cast::Cast;
use crate::check;
use crate::cli::RunArgs;
use crate::events::Events;
use crate::exit::{Failure, Outcome, warn};
use crate::interrupt;
use crate::output::{Format, Whole, check_distinct, say};
use crate::plan::{Beat, Length, Plan, frames_behind};
use crate::progress::Progress;
use crate::report::{self, Ending, Facts};
use crate::setup::{self, Ready};
use crate::summary::{self, Scale};
use crate::trajectory::Trajectory;
use mrtphys::World;
use std::path::Path;

/// How often at most the energies are looked at for the scale of the ledger's round-off.
const LOOKS: u64 = 64;

/// Runs a scene.
pub fn run(args: &RunArgs, quiet: bool) -> Outcome {
    interrupt::listen()?;
    let pool = threads(args.simulation.threads)?;
    pool.install(|| run_here(args, quiet, pool.current_num_threads()))
}

/// Threads to compute with; 0: one for each core.
pub fn threads(count: u32) -> Outcome<rayon::ThreadPool> {
    let pool = rayon::ThreadPoolBuilder::new().num_threads(count as usize).build();
    pool.map_err(|e| Failure::Stopped(format!("cannot start {count} threads: {e}")))
}

fn run_here(args: &RunArgs, quiet: bool, threads: usize) -> Outcome {
    check_files(args)?;
    run_ready(args, quiet, threads, setup::prepare(args)?)
}

fn run_ready(args: &RunArgs, quiet: bool, threads: usize, mut ready: Ready) -> Outcome {
    let settings = ready.world.settings();
    let beat = Beat { fps: settings.fps, steps_per_frame: settings.steps_per_frame };
    let (steps_before, time) = (ready.world.steps(), ready.world.time());
    let plan = Plan::new(ready.end, beat, steps_before, time).map_err(Failure::Wrong)?;
    if plan.steps_left() == 0 && args.simulation.resume.is_some() {
        warn(&format!("the snapshot is at {time} s, which is the end of this run or after it: no step is made"));
    }
    if args.simulation.resume.is_none() {
        check::warn_of_overlaps(&ready.scene, &mut ready.world, &ready.cast);
    }
    let mut files = Files::open(args, &ready)?;
    let mut progress = Progress::new(quiet, plan.steps_left());
    let mut course = Course {
        frames: frames_behind(beat, steps_before, time),
        scale: Scale::new(ready.world.initial_energy()),
        look_every: (plan.steps_left() / u64::from(beat.steps_per_frame) / LOOKS).max(1),
        ending: Ending::Done,
    };
    let done = course.go(&mut ready.world, &ready.cast, plan, &mut files, &mut progress);
    let wall_seconds = progress.seconds();
    progress.clear();
    course.scale.see(ready.world.energy());
    let facts = Facts {
        scene: ready.scene.clone(),
        title: ready.title.clone(),
        seed: ready.seed,
        threads,
        frames: course.frames,
        wall_seconds,
        ending: &course.ending,
    };
    // A file that could not be written keeps no other from being written; the first failure is told.
    let ended = [
        done,
        files.finish(&ready.world, &ready.cast, &facts, args.bodies),
        say(&summary::text(&ready.world, &facts, &course.scale, ready.world.steps() - steps_before)),
    ];
    summary::warnings(&ready.world, &course.scale);
    ended.into_iter().collect::<Outcome<Vec<()>>>()?;
    match course.ending {
        Ending::Done => Ok(()),
        Ending::Interrupted => Err(Failure::Interrupted),
        Ending::Stopped(why) => Err(Failure::Stopped(why)),
    }
}

/// Refuses outputs over each other and over the inputs, before anything is read or emptied.
fn check_files(args: &RunArgs) -> Outcome {
    let all = [
        ("--report", &args.report),
        ("--events", &args.events),
        ("--trajectory", &args.trajectory),
        ("--snapshot", &args.snapshot),
    ];
    let outputs: Vec<(&str, &Path)> = all.iter().filter_map(|(o, p)| Some((*o, p.as_deref()?))).collect();
    // A snapshot may be replaced by its own continuation: it is written as a whole at the end.
    let mut inputs = vec![("the scene", Path::new(&args.scene))];
    check_distinct(&outputs, &inputs)?;
    inputs.clear();
    inputs.extend(args.simulation.resume.as_deref().map(|p| ("--resume", p)));
    let streams: Vec<(&str, &Path)> = outputs.into_iter().filter(|(o, _)| *o != "--snapshot").collect();
    check_distinct(&streams, &inputs)
}

/// The outputs of a run.
struct Files {
    report: Option<(Whole, Format)>,
    snapshot: Option<Whole>,
    events: Option<Events>,
    trajectory: Option<Trajectory>,
}

impl Files {
    /// Opens what was asked for. The files that appear as a whole are checked first: nothing is emptied in vain.
    fn open(args: &RunArgs, ready: &Ready) -> Outcome<Files> {
        let report = args.report.as_deref().map(report::open).transpose()?;
        let snapshot = args.snapshot.as_deref().map(Whole::check).transpose()?;
        let only = args.events_only.as_deref();
        let events = args.events.as_deref().map(|p| Events::create(p, only, &ready.cast)).transpose()?;
        let trajectory = args.trajectory.as_deref().map(|p| Trajectory::create(p, &ready.cast)).transpose()?;
        Ok(Files { report, snapshot, events, trajectory })
    }

    fn put_frame(&mut self, world: &World, cast: &Cast) -> Outcome {
        self.trajectory.as_mut().map_or(Ok(()), |t| t.put_frame(world, cast))
    }

    fn put_events(&mut self, world: &mut World, cast: &Cast) -> Outcome {
        let Some(events) = &mut self.events else { return Ok(()) };
        world.drain_events().try_for_each(|e| events.put(&e, cast))
    }

    /// Writes what is written at the end, each file whether or not another failed.
    fn finish(&mut self, world: &World, cast: &Cast, facts: &Facts<'_>, list_bodies: bool) -> Outcome {
        let events = self.events.as_mut().map_or(Ok(()), Events::flush);
        let trajectory = self.trajectory.as_mut().map_or(Ok(()), Trajectory::flush);
        let snapshot = self.snapshot.as_ref().map_or(Ok(()), |file| file.write(|to| to.write_all(&world.snapshot())));
        let report = self
            .report
            .as_ref()
            .map_or(Ok(()), |(file, format)| report::write(file, *format, world, cast, facts, list_bodies));
        events.and(trajectory).and(snapshot).and(report)
    }
}

/// How the run goes.
struct Course {
    /// frames since the start of the scene
    frames: u64,
    scale: Scale,
    /// frames from one look at the energies to the next
    look_every: u64,
    ending: Ending,
}

impl Course {
    /// Makes the steps of the plan, until an interrupt or an error. Fails where an output does.
    fn go(
        &mut self,
        world: &mut World,
        cast: &Cast,
        mut plan: Plan,
        files: &mut Files,
        progress: &mut Progress,
    ) -> Outcome {
        world.record_events(files.events.is_some());
        files.put_frame(world, cast)?;
        let mut steps = 0;
        while !interrupt::asked() {
            let Some((length, frame_ends)) = plan.next() else { return Ok(()) };
            let made = match length {
                Length::Full => world.step(),
                Length::Rest(dt) => world.step_by(dt),
            };
            if let Err(e) = made {
                self.ending = Ending::Stopped(format!("the simulation stopped at {} s: {e}", world.time()));
                return Ok(());
            }
            steps += 1;
            files.put_events(world, cast)?;
            progress.tick(steps, world.time());
            if frame_ends {
                self.frames += 1;
                files.put_frame(world, cast)?;
                if self.frames.is_multiple_of(self.look_every) {
                    self.scale.see(world.energy());
                }
            }
        }
        if plan.steps_left() > 0 {
            self.ending = Ending::Interrupted;
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use mrtphys::Vec3;
    use mrtphys::field::{ForceField, Scope};
    use std::sync::Arc;

    /// A field that fails beyond x = 0.05 m. No scene can say one: what scenes say stays finite.
    #[derive(Debug)]
    struct Failing;

    impl ForceField for Failing {
        fn acceleration(&self, at: Vec3, _mass: f64) -> Vec3 {
            if at.x > 0.05 { Vec3::splat(f64::NAN) } else { Vec3::ZERO }
        }
        fn potential(&self, _at: Vec3) -> Option<f64> {
            None
        }
    }

    #[test]
    fn a_simulation_that_stops_reports_what_was_reached_and_ends_with_2() {
        let folder = std::env::temp_dir().join(format!("mrtphys-run-stops-{}", std::process::id()));
        std::fs::create_dir_all(&folder).unwrap();
        let path = |name: &str| folder.join(name).into_os_string().into_string().unwrap();
        let shape = "shape = { kind = \"sphere\", radius = 0.1 }\nvelocity = [1, 0, 0]";
        std::fs::write(path("scene.toml"), format!("format = 1\n[[body]]\n{shape}\n")).unwrap();
        let [scene, report, trajectory, snapshot] = ["scene.toml", "r.json", "t.csv", "s.snap"].map(path);
        let line = ["run", &scene, "--report", &report, "--trajectory", &trajectory, "--snapshot", &snapshot];
        let args = crate::cli::tests::run_args(&line);
        let mut ready = setup::prepare(&args).unwrap();
        ready.world.add_force(Arc::new(Failing), Scope::default()).unwrap();
        let outcome = run_ready(&args, true, 1, ready);
        let failure = outcome.unwrap_err();
        assert_eq!(failure.status(), 2);
        assert!(failure.to_string().contains("Failing") && failure.to_string().contains("0.05"), "{failure}");
        let text = std::fs::read_to_string(&report).unwrap();
        let report: serde_json::Value = serde_json::from_str(&text).unwrap();
        assert_eq!(report["stopped"], failure.to_string());
        // 1 m/s x 24 steps / 480 per second = 0.05 m
        assert_eq!((report["steps"].as_u64(), report["frames"].as_u64()), (Some(24), Some(3)));
        assert_eq!(std::fs::read_to_string(&trajectory).unwrap().lines().count(), 1 + 4);
        assert!(std::fs::metadata(&snapshot).unwrap().len() > 0);
        std::fs::remove_dir_all(folder).unwrap();
    }
}
