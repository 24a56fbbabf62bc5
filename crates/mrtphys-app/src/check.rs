//! `mrtphys check`: whether a scene is sound before it runs.

use crate::cast::{Cast, Party};
use crate::exit::{Failure, Outcome, warn};
use crate::output::say;
use crate::setup;
use crate::summary::{LARGEST_SAFE_STEP, brief};
use mrtphys::{Vec3, World};
use mrtphys_scene::Scene;
use mrtphys_scene::scene::{Content, MassDesc, Turning};
use std::ffi::OsStr;
use std::fmt::Write;

/// Most overlaps, and most warnings of one kind, told one by one.
const MOST_TOLD: usize = 20;

/// Parses, validates, and reports what overlaps at the start.
pub fn check(name: &OsStr) -> Outcome {
    let scene = setup::load(name)?;
    let (mut world, cast) = setup::build(&scene)?;
    warn_some(&standing_bodies_with_velocities(&scene));
    warn_some(&long_steps(&world, &cast));
    let overlaps = overlaps(&mut world, &cast);
    if overlaps.is_empty() {
        let bodies = counted(cast.body_count(), "body", "bodies");
        let boundaries = counted(cast.boundary_count(), "boundary", "boundaries");
        return say(&format!("{}: sound; {bodies}, {boundaries}\n", name.to_string_lossy()));
    }
    let mut text = String::new();
    for line in overlaps.iter().take(MOST_TOLD) {
        // Writing to a string cannot fail.
        let _ = writeln!(text, "error: {}: {line}", name.to_string_lossy());
    }
    if overlaps.len() > MOST_TOLD {
        let _ = writeln!(text, "and {} more", overlaps.len() - MOST_TOLD);
    }
    Err(Failure::Wrong(text))
}

fn counted(n: usize, one: &str, many: &str) -> String {
    format!("{n} {}", if n == 1 { one } else { many })
}

/// Warns of a run that starts with overlaps: bodies let back into what they should not have entered.
pub fn warn_of_overlaps(scene: &str, world: &mut World, cast: &Cast) {
    let found = overlaps(world, cast);
    // What was looked at is no part of the run.
    world.forget_scratch();
    let Some(deepest) = found.first() else { return };
    let more = if found.len() > 1 { format!(", and {} more", found.len() - 1) } else { String::new() };
    warn(&format!("{deepest}{more}; 'mrtphys check {scene}' tells all"));
}

fn warn_some(warnings: &[String]) {
    warnings.iter().take(MOST_TOLD).for_each(|w| warn(w));
    if warnings.len() > MOST_TOLD {
        warn(&format!("and {} more of this kind", warnings.len() - MOST_TOLD));
    }
}

/// What overlaps, the deepest first.
fn overlaps(world: &mut World, cast: &Cast) -> Vec<String> {
    let mut found = world.overlaps();
    found.sort_by(|a, b| b.depth.total_cmp(&a.depth));
    let line = |o: &mrtphys::world::Overlap| {
        let (a, b) = (Party::Body(cast.number(o.a)), cast.party(o.b));
        format!("'{}' and '{}' overlap by {} m at the start", cast.name(a), cast.name(b), o.depth)
    };
    found.iter().map(line).collect()
}

/// A fixed body stays where it is, whatever velocity it is given.
fn standing_bodies_with_velocities(scene: &Scene) -> Vec<String> {
    let moves = |turning: Turning| match turning {
        Turning::Velocity(v) | Turning::Momentum(v) => v != Vec3::ZERO,
    };
    let bodies = scene.contents.iter().filter_map(|c| if let Content::Body(b) = c { Some(b) } else { None });
    bodies
        .filter(|b| b.substance.mass == MassDesc::Fixed && (b.velocity != Vec3::ZERO || moves(b.turning)))
        .map(|b| format!("'{}' is fixed: its velocities are taken as zero", b.name))
        .collect()
}

/// Bodies that move farther in the first step than is safe.
fn long_steps(world: &World, cast: &Cast) -> Vec<String> {
    let dt = world.time_step();
    let mut found = Vec::new();
    for (i, &id) in cast.bodies().iter().enumerate() {
        let Ok(body) = world.body(id) else { continue };
        let diameter = 2.0 * body.shape.bounding_sphere().radius;
        let step = body.velocity.length() * dt / diameter;
        if step > LARGEST_SAFE_STEP {
            found.push(format!(
                "'{}' moves {} of its own diameter in the first step; above {LARGEST_SAFE_STEP} collisions can \
                 go unseen at fixed steps: use more steps per frame",
                cast.name(Party::Body(i)),
                brief(step)
            ));
        }
    }
    found
}
