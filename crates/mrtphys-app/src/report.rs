//! `--report`: what was reached, as the interface contract lays it out.

use crate::binary;
use crate::cast::{Cast, Party};
use crate::exit::Outcome;
use crate::json;
use crate::output::{Format, Whole};
use crate::trajectory::motion;
use mrtphys::ledger::{Energy, Ledger};
use mrtphys::world::Body;
use mrtphys::{Vec3, World};
use serde::Serialize;
use serde::ser::{Error as _, SerializeMap, Serializer};
use std::io::Write;
use std::path::Path;

/// Above this number of bodies the JSON report lists them only if told to.
pub const MOST_BODIES_LISTED: usize = 100_000;
/// number of the kind, mass, and the thirteen values of the motion
const RECORD_BYTES: u32 = 15 * 8;

/// How a run ended.
#[derive(Clone, Debug, PartialEq)]
pub enum Ending {
    /// as planned
    Done,
    /// the user interrupted
    Interrupted,
    /// the simulation gave an error
    Stopped(String),
}

/// What a report says beside what the world knows.
pub struct Facts<'a> {
    /// the scene as it was named
    pub scene: String,
    /// its title
    pub title: String,
    /// seed of its random draws
    pub seed: u64,
    /// threads that computed
    pub threads: usize,
    /// frames since the start of the scene
    pub frames: u64,
    /// wall time of the simulation \[s\]
    pub wall_seconds: f64,
    /// how it ended
    pub ending: &'a Ending,
}

#[derive(Serialize)]
struct Report<'a> {
    format: u32,
    scene: &'a str,
    algorithm: &'a str,
    broad_phase: String,
    friction_law: &'a str,
    impact: &'a str,
    threads: usize,
    time: f64,
    frames: u64,
    steps: u64,
    wall_seconds: f64,
    #[serde(skip_serializing_if = "Option::is_none")]
    bodies: Option<Bodies<'a>>,
    energy: Energies,
    initial_energy: Energies,
    #[serde(serialize_with = "entries")]
    ledger: &'a Ledger,
    momentum: [f64; 3],
    angular_momentum: [f64; 3],
    counters: Counts,
    per_step: PerStep,
    largest_step: f64,
    state_hash: String,
    // What the contract does not ask for stands after what it does.
    title: &'a str,
    seed: u64,
    fps: u32,
    steps_per_frame: u32,
    body_count: usize,
    #[serde(skip_serializing_if = "Option::is_none")]
    kinds: Option<Vec<String>>,
    #[serde(skip_serializing_if = "std::ops::Not::not")]
    interrupted: bool,
    #[serde(skip_serializing_if = "Option::is_none")]
    stopped: Option<&'a str>,
}

#[derive(Serialize)]
struct Energies {
    linear: f64,
    rotational: f64,
    potential: f64,
    total: f64,
}

#[derive(Serialize)]
struct Counts {
    sphere_tests: u64,
    detect_calls: u64,
    impacts: u64,
    undecided: u64,
    /// no certificate at fixed steps
    missed: Option<u64>,
    contacts: u64,
    wall_impacts: u64,
    fallbacks: u64,
    projections: u64,
    quarantined: u64,
}

#[derive(Serialize)]
struct PerStep {
    sphere_tests: f64,
    detect_calls: f64,
}

#[derive(Serialize)]
struct BodyLine<'a> {
    name: &'a str,
    kind: &'a str,
    mass: MassValue,
    position: &'a [f64],
    orientation: &'a [f64],
    velocity: &'a [f64],
    angular_velocity: &'a [f64],
}

struct MassValue(f64);

impl Serialize for MassValue {
    fn serialize<S: Serializer>(&self, s: S) -> Result<S::Ok, S::Error> {
        // JSON has no infinity.
        if self.0 == f64::INFINITY { s.serialize_str("infinite") } else { s.serialize_f64(self.0) }
    }
}

/// The bodies, read from the world one at a time: ten million of them are never in memory twice.
struct Bodies<'a> {
    world: &'a World,
    cast: &'a Cast,
}

impl Serialize for Bodies<'_> {
    fn serialize<S: Serializer>(&self, s: S) -> Result<S::Ok, S::Error> {
        use serde::ser::SerializeSeq;
        let mut list = s.serialize_seq(Some(self.cast.body_count()))?;
        for (i, &id) in self.cast.bodies().iter().enumerate() {
            let body = self.world.body(id).map_err(S::Error::custom)?;
            let m = motion(&body);
            list.serialize_element(&BodyLine {
                name: &self.cast.name(Party::Body(i)),
                kind: &body.kind,
                mass: MassValue(body.mass),
                position: &m[0..3],
                orientation: &m[3..7],
                velocity: &m[7..10],
                angular_velocity: &m[10..13],
            })?;
        }
        list.end()
    }
}

fn entries<S: Serializer>(ledger: &Ledger, s: S) -> Result<S::Ok, S::Error> {
    let entries = ledger.entries();
    let mut map = s.serialize_map(Some(entries.len()))?;
    for (name, value) in entries {
        map.serialize_entry(name, &value)?;
    }
    map.end()
}

fn energies(e: Energy) -> Energies {
    Energies { linear: e.linear, rotational: e.rotational, potential: e.potential, total: e.total() }
}

fn xyz(v: Vec3) -> [f64; 3] {
    [v.x, v.y, v.z]
}

/// Mean over the steps made; 0 before the first.
pub fn mean(total: u64, steps: u64) -> f64 {
    if steps == 0 { 0.0 } else { total as f64 / steps as f64 }
}

fn report<'a>(world: &'a World, facts: &'a Facts<'_>) -> Report<'a> {
    let (settings, totals) = (world.settings(), world.totals());
    Report {
        format: 1,
        scene: &facts.scene,
        algorithm: settings.algorithm.name(),
        broad_phase: settings.broad_phase.to_string(),
        friction_law: settings.friction_law.name(),
        impact: settings.impact.name(),
        threads: facts.threads,
        time: world.time(),
        frames: facts.frames,
        steps: world.steps(),
        wall_seconds: facts.wall_seconds,
        bodies: None,
        energy: energies(world.energy()),
        initial_energy: energies(world.initial_energy()),
        ledger: world.ledger(),
        momentum: xyz(world.momentum()),
        angular_momentum: xyz(world.angular_momentum()),
        counters: Counts {
            sphere_tests: totals.sphere_tests,
            detect_calls: totals.detect_calls,
            impacts: totals.impacts,
            undecided: totals.undecided,
            missed: None,
            contacts: totals.contacts,
            wall_impacts: totals.wall_impacts,
            fallbacks: totals.fallbacks,
            projections: totals.projections,
            quarantined: totals.quarantined,
        },
        per_step: PerStep {
            sphere_tests: mean(totals.sphere_tests, world.steps()),
            detect_calls: mean(totals.detect_calls, world.steps()),
        },
        largest_step: world.largest_step(),
        state_hash: world.state_hash(),
        title: &facts.title,
        seed: facts.seed,
        fps: settings.fps,
        steps_per_frame: settings.steps_per_frame,
        body_count: world.body_count(),
        kinds: None,
        interrupted: *facts.ending == Ending::Interrupted,
        stopped: match facts.ending {
            Ending::Stopped(why) => Some(why),
            _ => None,
        },
    }
}

/// Writes the report; `list_bodies` lists them however many there are.
pub fn write(to: &Whole, format: Format, world: &World, cast: &Cast, facts: &Facts<'_>, list_bodies: bool) -> Outcome {
    let mut content = report(world, facts);
    match format {
        Format::Text => {
            let listed = list_bodies || cast.body_count() <= MOST_BODIES_LISTED;
            content.bodies = listed.then_some(Bodies { world, cast });
            to.write(|to| json::write(to, &content))
        }
        Format::Binary => {
            let bodies = || cast.bodies().iter().map(|&id| world.body(id).map_err(std::io::Error::other));
            to.write(|to| {
                binary::header(to, binary::REPORT, RECORD_BYTES, cast)?;
                let mut kinds: Vec<String> = Vec::new();
                for body in bodies() {
                    put_record(to, &body?, &mut kinds)?;
                }
                content.kinds = Some(kinds);
                json::write(to, &content)
            })
        }
    }
}

/// One body of a binary report. Kinds are numbered as they come.
fn put_record(to: &mut dyn Write, body: &Body, kinds: &mut Vec<String>) -> std::io::Result<()> {
    let kind = kinds.iter().position(|k| *k == body.kind).unwrap_or_else(|| {
        kinds.push(body.kind.clone());
        kinds.len() - 1
    });
    binary::record(to, &[kind as u64], &[body.mass])?;
    binary::record(to, &[], &motion(body))
}

/// The file of a report: whether it can be written, and in which format.
pub fn open(path: &Path) -> Outcome<(Whole, Format)> {
    Ok((Whole::check(path)?, Format::of(path)))
}
