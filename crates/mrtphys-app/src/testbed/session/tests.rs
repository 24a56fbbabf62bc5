//! Sessions without a thread, and a few with one.

mod hold;
mod rival;
mod thread;
mod wander;

use super::core::{Clock, Core, News, Next};
use super::pace::RealTime;
use super::report::{Report, Sample};
use super::{Command, Grip, Session, Wish};
use mrtphys::def::{BroadPhaseKind, FrictionLaw, Settings};
use mrtphys::field::{EarthGravity, Scope};
use mrtphys::{BodyId, Vec3};
use mrtphys_scene::scene::{BodyDesc, Placement};
use mrtphys_scene::{Loaded, Scene, gallery_scene};
use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::{Arc, Mutex};
use std::time::{Duration, Instant};

/// A clock that stands still until it is told to go on; every look at it may take time.
#[derive(Clone)]
struct Watch {
    start: Instant,
    now: Arc<AtomicU64>,
    per_look: Arc<AtomicU64>,
}

impl Watch {
    fn new() -> Watch {
        Watch { start: Instant::now(), now: Arc::default(), per_look: Arc::default() }
    }

    fn clock(&self) -> Clock {
        let watch = self.clone();
        Box::new(move || {
            let step = watch.per_look.load(Ordering::Relaxed);
            watch.start + Duration::from_nanos(watch.now.fetch_add(step, Ordering::Relaxed) + step)
        })
    }

    fn wait(&self, seconds: f64) {
        self.now.fetch_add((seconds * 1e9) as u64, Ordering::Relaxed);
    }

    fn wait_until(&self, then: Instant) {
        let then = then.saturating_duration_since(self.start).as_nanos() as u64;
        self.now.fetch_max(then, Ordering::Relaxed);
    }
}

struct Bench {
    core: Core,
    watch: Watch,
}

fn scene(name: &str) -> Scene {
    Scene::from_text(name, gallery_scene(name).unwrap()).unwrap()
}

fn bench(name: &str) -> Bench {
    let watch = Watch::new();
    Bench { core: Core::new(scene(name).build().unwrap(), watch.clock()), watch }
}

impl Bench {
    fn send(&mut self, command: Command) -> &mut Bench {
        self.core.obey(command);
        self
    }

    fn edit(&mut self, structural: bool, change: impl Fn(&mut Loaded) -> Result<(), String> + Send + 'static) {
        self.send(Command::Edit { change: Box::new(change), structural });
    }

    /// Works until there is nothing to do at this moment.
    fn settle(&mut self) -> Next {
        for _ in 0..1_000_000 {
            match self.core.work() {
                Next::Now => {}
                other => return other,
            }
        }
        panic!("it never comes to rest");
    }

    /// Runs for some real time.
    fn run(&mut self, seconds: f64) {
        let end = self.watch.start
            + Duration::from_nanos(self.watch.now.load(Ordering::Relaxed))
            + Duration::from_secs_f64(seconds);
        while let Next::At(then) = self.settle() {
            if then > end {
                break;
            }
            self.watch.wait_until(then);
        }
        self.watch.wait_until(end);
        self.settle();
    }

    /// Makes frames, standing still after each.
    fn frames(&mut self, count: usize) {
        for _ in 0..count {
            self.send(Command::Frame).settle();
        }
    }

    fn hash(&self) -> String {
        self.core.loaded().world.state_hash()
    }

    fn report(&mut self) -> Report {
        self.core.report()
    }

    fn body(&self, name: &str) -> BodyId {
        self.core.loaded().names.body(name).unwrap()
    }
}

fn gravity(loaded: &mut Loaded) -> Result<(), String> {
    loaded.world.add_force(Arc::new(EarthGravity::default()), Scope::default()).map(drop).map_err(|e| e.to_string())
}

fn first_body(loaded: &Loaded) -> BodyId {
    loaded.world.bodies().next().unwrap()
}

#[test]
fn stands_still_until_it_is_told_to_go() {
    let mut b = bench("cradle");
    let start = b.hash();
    b.watch.wait(10.0);
    assert_eq!(b.settle(), Next::Never);
    assert_eq!(b.hash(), start);
    let report = b.report();
    assert!(!report.running && report.trouble.is_none() && report.timeline.last == 0);
    assert_eq!(b.core.news().0, News::None);
}

#[test]
fn runs_in_real_time_and_says_so() {
    let mut b = bench("cradle");
    b.send(Command::Go(true));
    b.run(2.0);
    let report = b.report();
    let fps = f64::from(report.sides[0].numbers.settings.fps);
    let frames = report.sides[0].numbers.frame as f64;
    assert!((frames - 2.0 * fps).abs() <= 1.0, "{frames} frames in 2 s");
    assert!((report.pace.fps_reached - fps).abs() < 0.05 * fps, "{}", report.pace.fps_reached);
    assert!(report.running);
    assert_eq!(report.sides[0].before.tick + 1, report.sides[0].shot.tick);
    assert!((report.pace.blend.as_secs_f64() - 1.0 / fps).abs() < 0.1 / fps);
    b.send(Command::Go(false));
    let stopped = b.hash();
    b.run(1.0);
    assert_eq!(b.hash(), stopped);
    assert!(!b.report().running);
}

#[test]
fn a_frame_and_a_step_are_what_the_world_says() {
    let mut b = bench("thesis/cube-3");
    let mut twin = scene("thesis/cube-3").build().unwrap();
    b.frames(3);
    (0..3).for_each(|_| twin.world.frame().unwrap());
    assert_eq!(b.hash(), twin.world.state_hash());
    for _ in 0..twin.world.settings().steps_per_frame + 2 {
        b.send(Command::Step).settle();
        twin.world.step().unwrap();
        assert_eq!(b.hash(), twin.world.state_hash());
        let report = b.report();
        assert_eq!(report.sides[0].shot.time, twin.world.time(), "the picture is of the middle of a frame");
        assert!(Arc::ptr_eq(&report.sides[0].before, &report.sides[0].shot), "nothing is blended");
    }
    assert_eq!(b.report().timeline.now, 4);
    b.frames(1);
    assert_eq!(b.report().timeline.now, 5, "the frame in progress is made whole");
}

#[test]
fn going_on_after_a_stop_in_the_middle_of_a_frame_changes_nothing() {
    let mut b = bench("thesis/cube-3");
    let mut twin = bench("thesis/cube-3");
    twin.frames(4);
    b.send(Command::RealTime(RealTime::Off)).send(Command::Go(true));
    for _ in 0..7 {
        b.core.work();
    }
    b.send(Command::Go(false));
    assert_eq!(b.settle(), Next::Never, "it stops within a step");
    assert!(b.core.is_inside());
    let left = 4 - b.report().timeline.now as usize;
    b.frames(left);
    assert_eq!((b.hash(), b.report().timeline.now), (twin.hash(), 4));
}

/// Everything that can happen to a world on the way.
fn adventure(b: &mut Bench) -> Vec<String> {
    let mut hashes = vec![b.hash()];
    let frames = |b: &mut Bench, hashes: &mut Vec<String>, n: usize| {
        for _ in 0..n {
            b.frames(1);
            hashes.push(b.hash());
        }
    };
    let name = |i: usize| format!("late {i}");
    frames(b, &mut hashes, 5);
    b.edit(false, gravity);
    frames(b, &mut hashes, 4);
    b.edit(true, |l| {
        let id = first_body(l);
        l.world.remove_body(id).map_err(|e| e.to_string())
    });
    // The state at a frame is that after the edits made there.
    hashes.pop();
    hashes.push(b.hash());
    frames(b, &mut hashes, 3);
    b.edit(true, move |l| add_like(l, &name(1), Vec3::new(0.5, 0.9, 0.5)).map(drop));
    hashes.pop();
    hashes.push(b.hash());
    frames(b, &mut hashes, 2);
    b.send(Command::StepsPerFrame(3));
    frames(b, &mut hashes, 3);
    b.send(Command::Fps(24));
    frames(b, &mut hashes, 3);
    b.send(Command::Step).settle();
    b.send(Command::Step).settle();
    assert!(b.core.is_inside());
    b.edit(false, |l| {
        let id = first_body(l);
        l.world.apply_impulse(id, Vec3::new(0.01, 0.0, 0.02), Vec3::ZERO).map_err(|e| e.to_string())
    });
    frames(b, &mut hashes, 2);
    let held = first_body(b.core.loaded());
    b.send(Command::RealTime(RealTime::Forced)).send(Command::Go(true));
    for i in 0..6 {
        b.watch.wait(0.05 + 0.07 * f64::from(i));
        let target = Vec3::new(0.5, 0.5 + 0.01 * f64::from(i), 0.5);
        b.send(Command::Hold(Some(Grip { body: held, point: Vec3::new(0.01, 0.0, 0.0), target })));
        while let Next::Now = b.core.work() {
            if hashes.len() as u64 <= b.core.position().tick && !b.core.is_inside() {
                hashes.push(b.hash());
            }
        }
        if hashes.len() as u64 <= b.core.position().tick {
            hashes.push(b.hash());
        }
    }
    b.send(Command::Hold(None)).send(Command::Go(false)).settle();
    assert!(b.report().pace.skipped > 3, "frames were merged");
    b.send(Command::Fps(30));
    frames(b, &mut hashes, 4);
    assert_eq!(hashes.len() as u64, b.report().timeline.last + 1);
    hashes
}

/// Another body like the first of a scene.
fn add_like(l: &mut Loaded, name: &str, at: Vec3) -> Result<BodyId, String> {
    let substance = l.scene.contents.iter().find_map(|c| match c {
        mrtphys_scene::scene::Content::Body(b) => Some(b.substance.clone()),
        mrtphys_scene::scene::Content::Lattice(l) => Some(l.bodies[0].clone()),
        mrtphys_scene::scene::Content::Table(_) => None,
    });
    let body = BodyDesc {
        name: name.into(),
        substance: substance.ok_or("no body")?,
        placement: Placement::CenterOfMass(at),
        orientation: mrtphys::Quat::IDENTITY,
        velocity: Vec3::ZERO,
        turning: mrtphys_scene::scene::Turning::Velocity(Vec3::ZERO),
        span: Default::default(),
    };
    l.add_body(body).map_err(|e| e.to_string())
}

#[test]
fn every_frame_is_restored_bit_for_bit() {
    let mut b = bench("thesis/cube-3");
    let hashes = adventure(&mut b);
    let last = hashes.len() as u64 - 1;
    let there_and_back = (0..=last).rev().chain([3, last, 0, last / 2, last / 2 + 1, last]);
    for tick in there_and_back {
        b.send(Command::Seek(tick)).settle();
        assert_eq!(b.hash(), hashes[tick as usize], "frame {tick}");
        let report = b.report();
        assert_eq!((report.timeline.now, report.timeline.last), (tick, last));
        assert_eq!(report.sides[0].shot.tick, tick);
        assert_eq!(report.sides[0].numbers.time, b.core.loaded().world.time());
        let bodies: Vec<_> = report.sides[0].shot.stage.bodies().collect();
        assert_eq!(bodies, b.core.loaded().world.bodies().collect::<Vec<_>>(), "frame {tick}: the stage fits");
        assert!(report.trouble.is_none(), "{:?}", report.trouble);
    }
    for tick in (last - 5..last).rev() {
        b.send(Command::Back).settle();
        assert_eq!(b.hash(), hashes[tick as usize], "back to frame {tick}");
    }
}

#[test]
fn an_adventure_is_restored_from_few_states_too() {
    let watch = Watch::new();
    // Every look at the clock takes a while, so that many states are kept, and there is memory for hardly any.
    watch.per_look.store(20_000_000, Ordering::Relaxed);
    let core = Core::with_budget(scene("thesis/cube-3").build().unwrap(), watch.clock(), 100 << 10);
    let mut b = Bench { core, watch };
    let mut hashes = Vec::new();
    for i in 0..60 {
        if i % 10 == 5 {
            b.edit(false, gravity);
            hashes.pop();
            hashes.push(b.hash());
        }
        b.frames(1);
        hashes.push(b.hash());
    }
    let (first, last) = b.core.tape.range();
    assert!(first > 0 && last == 60, "{first}..{last}: the oldest frames are gone");
    assert!(b.core.tape.keys(0).len() >= 2);
    for tick in (first..=last).rev().step_by(7) {
        b.send(Command::Seek(tick)).settle();
        assert_eq!(b.hash(), hashes[tick as usize - 1], "frame {tick}");
    }
    b.send(Command::Seek(0)).settle();
    assert_eq!(b.report().timeline.now, first);
}

#[test]
fn what_came_after_is_replaced_by_going_on() {
    let mut b = bench("thesis/cube-3");
    b.frames(10);
    let tenth = b.hash();
    b.send(Command::Seek(4)).settle();
    assert_eq!(b.report().timeline.last, 10);
    b.edit(false, |_| Err("no".into()));
    let report = b.report();
    assert_eq!((report.timeline.last, report.trouble.as_deref()), (10, Some("no")), "a refusal costs nothing");
    b.edit(false, gravity);
    assert_eq!(b.report().timeline.last, 4);
    b.frames(6);
    assert_eq!(b.report().timeline.last, 10);
    assert_ne!(b.hash(), tenth);
    let other = b.hash();
    b.send(Command::Seek(7)).settle();
    b.send(Command::Seek(10)).settle();
    assert_eq!(b.hash(), other);
    // And without an edit, the same comes again.
    let mut c = bench("thesis/cube-3");
    c.frames(10);
    c.send(Command::Back).send(Command::Back).settle();
    assert_eq!(c.report().timeline.now, 8);
    c.frames(2);
    assert_eq!(c.hash(), tenth);
}

#[test]
fn a_run_of_seeks_shows_pictures_at_once_and_restores_the_last() {
    let mut b = bench("thesis/cube-3");
    b.frames(30);
    for tick in [3, 20, 9] {
        b.send(Command::Seek(tick));
        let report = b.report();
        assert_eq!((report.sides[0].shot.tick, report.timeline.now), (tick, tick));
        assert!(report.timeline.restoring);
        b.core.work();
    }
    b.settle();
    let report = b.report();
    assert!(!report.timeline.restoring);
    let mut twin = bench("thesis/cube-3");
    twin.frames(9);
    assert_eq!(b.hash(), twin.hash());
    // A question that is asked on the way is answered with what was sought.
    let answer = Arc::new(Mutex::new(String::new()));
    let to = answer.clone();
    b.send(Command::Seek(20)).send(Command::Ask(Box::new(move |studio| {
        *to.lock().unwrap() = studio.loaded.world.state_hash();
    })));
    b.settle();
    twin.frames(11);
    assert_eq!(*answer.lock().unwrap(), twin.hash());
}

#[test]
fn restart_undoes_everything() {
    let mut b = bench("thesis/cube-3");
    let start = b.hash();
    let settings = b.core.loaded().world.settings().clone();
    b.frames(3);
    b.edit(true, |l| {
        let id = first_body(l);
        l.world.remove_body(id).map_err(|e| e.to_string())
    });
    b.send(Command::Fps(7)).send(Command::StepsPerFrame(2));
    b.frames(2);
    b.send(Command::Restart).settle();
    let report = b.report();
    assert_eq!(b.hash(), start);
    assert_eq!(*b.core.loaded().world.settings(), settings);
    assert_eq!((report.timeline.first, report.timeline.now, report.timeline.last), (0, 0, 0));
    assert_eq!(report.sides[0].shot.stage.body_count(), b.core.loaded().world.body_count());
    assert_eq!(report.sides[0].numbers.frame, 0);
    b.frames(1);
    let mut twin = bench("thesis/cube-3");
    twin.frames(1);
    assert_eq!(b.hash(), twin.hash());
}

#[test]
fn the_frame_rate_resets_the_counter_and_the_steps_do_not() {
    let mut b = bench("cradle");
    b.frames(5);
    b.send(Command::StepsPerFrame(4));
    assert_eq!(b.report().sides[0].numbers.frame, 5);
    b.frames(1);
    assert_eq!(b.report().sides[0].numbers.frame, 6);
    b.send(Command::Fps(30));
    let report = b.report();
    assert_eq!((report.sides[0].numbers.frame, report.timeline.now), (0, 6));
    b.frames(2);
    assert_eq!(b.report().sides[0].numbers.frame, 2);
    b.send(Command::Fps(0));
    assert!(b.report().trouble.unwrap().contains("fps"));
    assert_eq!(b.report().sides[0].numbers.settings.fps, 30);
}

#[test]
fn forced_frames_are_merged_into_the_steps_of_one() {
    let mut b = bench("cradle");
    let s = b.core.loaded().world.settings().clone();
    b.send(Command::RealTime(RealTime::Forced)).send(Command::Go(true));
    b.settle();
    b.watch.wait(5.5 / f64::from(s.fps));
    b.settle();
    let report = b.report();
    let numbers = &report.sides[0].numbers;
    assert_eq!((numbers.frame, report.pace.skipped, report.timeline.now), (5, 4, 1));
    assert_eq!(numbers.steps, u64::from(s.steps_per_frame));
    assert!((numbers.time - 5.0 / f64::from(s.fps)).abs() < 1e-12);
    assert_eq!(report.sides[0].samples.last().unwrap().frames, 1);
}

fn sums(samples: &[Sample]) -> (u64, u64, u64, f64) {
    let mut out = (0, 0, 0, 0.0);
    for s in samples {
        out = (out.0 + s.frames, out.1 + s.steps, out.2 + s.counts.sphere_tests, out.3 + s.duration);
    }
    out
}

#[test]
fn samples_add_up_to_the_whole_however_fast_frames_come() {
    let mut b = bench("thesis/cube-2");
    // Looking at the worlds is slow compared with stepping: most frames are not looked at.
    b.watch.per_look.store(1000, Ordering::Relaxed);
    b.send(Command::RealTime(RealTime::Off)).send(Command::Go(true));
    let mut samples = Vec::new();
    for _ in 0..50 {
        for _ in 0..100 {
            b.core.work();
        }
        samples.extend(b.report().sides.swap_remove(0).samples);
    }
    b.send(Command::Go(false)).settle();
    samples.extend(b.report().sides.swap_remove(0).samples);
    let world = &b.core.loaded().world;
    let (frames, steps, tests, duration) = sums(&samples);
    assert_eq!((steps, tests), (world.steps(), world.totals().sphere_tests));
    assert_eq!(frames, b.core.position().tick);
    assert!((duration - world.time()).abs() < 1e-9);
    assert!(samples.windows(2).all(|w| w[0].tick <= w[1].tick));
}

#[test]
fn samples_that_nobody_takes_are_merged() {
    let mut b = bench("cradle");
    b.frames(5000);
    let samples = b.report().sides.swap_remove(0).samples;
    assert!(samples.len() <= super::lane::MOST_SAMPLES + 1, "{}", samples.len());
    assert_eq!(sums(&samples).0, 5000);
}

#[test]
fn frames_that_are_not_recorded_can_be_gone_to() {
    let mut b = bench("thesis/cube-2");
    let steps = b.core.loaded().world.settings().steps_per_frame as usize;
    // Looking takes as long as a dozen frames.
    b.send(Command::RealTime(RealTime::Off)).send(Command::Go(true));
    for _ in 0..40 {
        b.watch.per_look.store(50_000, Ordering::Relaxed);
        for _ in 0..steps {
            b.core.work();
        }
        b.watch.per_look.store(50_000 * 2 * steps as u64, Ordering::Relaxed);
        b.core.work();
    }
    b.send(Command::Go(false)).send(Command::Frame).settle();
    let last = b.core.tape.range().1;
    let recorded: Vec<u64> = b.core.tape.shots().map(|s| s.tick).collect();
    assert!((recorded.len() as u64) < last, "{recorded:?} of {last}");
    let missing = (1..last).rev().find(|t| !recorded.contains(t)).unwrap();
    b.send(Command::Seek(missing)).settle();
    let report = b.report();
    let ticks: Vec<u64> = b.core.tape.shots().map(|s| s.tick).collect();
    assert!(ticks.is_sorted() && ticks.contains(&missing), "{ticks:?}");
    let mut twin = bench("thesis/cube-2");
    twin.frames(missing as usize);
    assert_eq!(b.hash(), twin.hash());
    assert_eq!(report.sides[0].shot.tick, missing);
}

#[test]
fn wishes_are_granted_and_cost_nothing_otherwise() {
    let mut b = bench("thesis/cube-3");
    b.frames(2);
    let bare = b.report().sides.swap_remove(0).extras;
    assert!(bare.contacts.is_empty() && bare.impacts.is_empty() && bare.velocities.is_empty());
    assert!(bare.boxes.is_empty() && bare.cells.is_empty() && bare.speeds.is_empty() && bare.trail.is_empty());
    let id = first_body(b.core.loaded());
    let selected = Some(id);
    let wish = Wish {
        contacts: true,
        impacts: true,
        velocities: true,
        boxes: true,
        cells: true,
        speeds: true,
        trail: 5,
        selected,
    };
    b.send(Command::Wish(wish));
    let before = *b.core.loaded().world.totals();
    b.frames(60);
    let side = b.report().sides.swap_remove(0);
    let world = &b.core.loaded().world;
    let n = world.body_count();
    assert_eq!((side.extras.velocities.len(), side.extras.boxes.len(), side.extras.speeds.len()), (n, n, n));
    assert_eq!(side.extras.impacts.len() as u64, world.totals().impacts - before.impacts);
    assert!(!side.extras.impacts.is_empty() && !side.extras.cells.is_empty());
    assert_eq!(side.extras.trail.len(), 5);
    assert_eq!(side.extras.selected.as_ref().unwrap().0, id);
    assert_eq!(side.extras.velocities[0].0, world.body(id).unwrap().velocity);
    let energy: f64 = side.extras.speeds.iter().map(|(m, v)| 0.5 * m * v * v).sum();
    assert!((energy - side.numbers.energy.linear).abs() < 1e-9 * energy);
    assert!(b.report().sides[0].extras.impacts.is_empty(), "impacts are told once");
}

/// A field that fails from a time on.
#[derive(Debug)]
struct Failing;

impl mrtphys::field::ForceField for Failing {
    fn acceleration(&self, at: Vec3, _mass: f64) -> Vec3 {
        if at.y < 0.9 { Vec3::splat(f64::NAN) } else { Vec3::new(0.0, -1.0, 0.0) }
    }

    fn potential(&self, _at: Vec3) -> Option<f64> {
        None
    }
}

const BALL: &str = "format = 1\n[simulation]\nfps = 60\nsteps_per_frame = 4\n[[body]]\nname = 'ball'\nmass = 2\nshape = { kind = 'sphere', radius = 0.1 }\nposition = [0, 1, 0]\n";

fn ball() -> Bench {
    let watch = Watch::new();
    let loaded = Scene::from_text("ball", BALL).unwrap().build().unwrap();
    Bench { core: Core::new(loaded, watch.clock()), watch }
}

#[test]
fn a_world_that_fails_stands_still_and_loses_nothing() {
    let mut b = ball();
    b.edit(false, |l| l.world.add_force(Arc::new(Failing), Scope::default()).map(drop).map_err(|e| e.to_string()));
    let id = b.body("ball");
    b.send(Command::Go(true));
    b.run(3.0);
    let report = b.report();
    assert!(!report.running);
    assert!(report.trouble.as_deref().is_some_and(|t| t.contains("Failing")), "{:?}", report.trouble);
    let stopped = b.hash();
    b.send(Command::Frame).settle();
    assert_eq!((b.report().troubles, b.hash()), (2, stopped.clone()));
    // The hand's pull is undone, too.
    let target = Vec3::new(5.0, 0.0, 0.0);
    b.send(Command::Go(true)).send(Command::Hold(Some(Grip { body: id, point: Vec3::ZERO, target })));
    b.run(0.1);
    assert_eq!(b.hash(), stopped);
    b.send(Command::Seek(3)).settle();
    assert_eq!(b.report().timeline.now, 3);
    assert!(b.report().timeline.last > 3);
}

#[test]
fn a_command_that_changes_nothing_is_no_news() {
    let mut b = ball();
    b.report();
    b.send(Command::Hold(None)).send(Command::Wish(Wish::default()));
    assert_eq!(b.core.news().0, News::None);
    b.send(Command::Wish(Wish { trail: 3, ..Wish::default() }));
    assert_eq!(b.core.news().0, News::Answer);
}

#[test]
fn impacts_of_frames_that_were_restored_are_not_told_again() {
    let mut b = bench("thesis/cube-3");
    b.send(Command::Wish(Wish { impacts: true, ..Wish::default() }));
    b.frames(60);
    assert!(!b.report().sides[0].extras.impacts.is_empty());
    b.send(Command::Seek(50)).settle();
    assert!(b.report().sides[0].extras.impacts.is_empty());
    let before = b.core.loaded().world.totals().impacts;
    b.frames(1);
    let told = b.report().sides[0].extras.impacts.len() as u64;
    assert_eq!(told, b.core.loaded().world.totals().impacts - before);
}
