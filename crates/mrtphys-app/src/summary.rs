//! The summary on stdout, and the warnings that a run may deserve.

use crate::exit::warn;
use crate::report::{Ending, Facts, mean};
use mrtphys::ledger::Energy;
use mrtphys::{Vec3, World};
use std::fmt::Write;

/// Above this fraction of its own diameter a body may pass through another within a step (requirement 4).
pub const LARGEST_SAFE_STEP: f64 = 0.25;

/// What the energies were as far as they were looked at: the scale of the ledger's round-off.
#[derive(Clone, Copy, Debug)]
pub struct Scale {
    kinetic: f64,
    potential: [f64; 2],
}

impl Scale {
    /// From the energies at the start.
    pub fn new(e: Energy) -> Scale {
        Scale { kinetic: e.kinetic(), potential: [e.potential; 2] }
    }

    /// Looks again.
    pub fn see(&mut self, e: Energy) {
        self.kinetic = self.kinetic.max(e.kinetic());
        self.potential = [self.potential[0].min(e.potential), self.potential[1].max(e.potential)];
    }

    /// The bound of the contract: 1e-12 (largest kinetic energy + sum of |entries| + range of the potential) \[J\].
    pub fn bound(&self, world: &World) -> f64 {
        1e-12 * (self.kinetic + world.ledger().sum_abs() + (self.potential[1] - self.potential[0]))
    }
}

/// Energy that the ledger does not explain \[J\].
pub fn residual(world: &World) -> f64 {
    world.energy().total() - world.initial_energy().total() - world.ledger().sum()
}

/// The summary.
pub fn text(world: &World, facts: &Facts<'_>, scale: &Scale, steps_now: u64) -> String {
    let mut out = String::new();
    // Writing to a string cannot fail.
    let _ = head(&mut out, world, facts);
    let _ = energy(&mut out, world, scale);
    let _ = counts(&mut out, world);
    let _ = speed(&mut out, world, facts, steps_now);
    let _ = writeln!(out, "state hash     {}", world.state_hash());
    out
}

fn head(out: &mut String, world: &World, facts: &Facts<'_>) -> std::fmt::Result {
    let s = world.settings();
    let title = if facts.title.is_empty() { String::new() } else { format!(": {}", facts.title) };
    writeln!(out, "scene          {}{title}", facts.scene)?;
    writeln!(out, "bodies         {}", world.body_count())?;
    let ending = match facts.ending {
        Ending::Done => String::new(),
        Ending::Interrupted => ", interrupted".into(),
        Ending::Stopped(_) => ", stopped by an error".into(),
    };
    writeln!(out, "simulated      {} s in {} frames, {} steps{ending}", world.time(), facts.frames, world.steps())?;
    writeln!(out, "by             {}, {}, {}, {}", s.algorithm, s.broad_phase, s.friction_law, s.impact)
}

fn energy(out: &mut String, world: &World, scale: &Scale) -> std::fmt::Result {
    let (start, end) = (world.initial_energy(), world.energy());
    writeln!(out, "energy [J]     {:<12} {:>22} {:>22} {:>14}", "", "start", "end", "change")?;
    let kinds = [
        ("linear", start.linear, end.linear),
        ("rotational", start.rotational, end.rotational),
        ("potential", start.potential, end.potential),
        ("total", start.total(), end.total()),
    ];
    for (name, start, end) in kinds {
        writeln!(out, "               {name:<12} {:>22} {:>22} {:>14}", brief(start), brief(end), change(start, end))?;
    }
    let entries = world.ledger().entries();
    for (i, (name, value)) in entries.iter().filter(|e| e.1 != 0.0).enumerate() {
        let label = if i == 0 { "ledger [J]" } else { "" };
        writeln!(out, "{label:<14} {name:<20} {:>14}", brief(*value))?;
    }
    writeln!(out, "unexplained    {} J of at most {} J", brief(residual(world)), brief(scale.bound(world)))?;
    writeln!(out, "momentum       {} Ns", vector(world.momentum()))?;
    writeln!(out, "ang. momentum  {} Js", vector(world.angular_momentum()))
}

fn counts(out: &mut String, world: &World) -> std::fmt::Result {
    let (t, steps) = (world.totals(), world.steps());
    let of = |total| brief(mean(total, steps));
    writeln!(
        out,
        "per step       {} sphere tests, {} detect calls, {} impacts",
        of(t.sphere_tests),
        of(t.detect_calls),
        of(t.impacts)
    )?;
    writeln!(
        out,
        "impacts        {}, {} of them against boundaries; undecided {}",
        t.impacts, t.wall_impacts, t.undecided
    )?;
    writeln!(out, "largest step   {} diameters", brief(world.largest_step()))
}

fn speed(out: &mut String, world: &World, facts: &Facts<'_>, steps: u64) -> std::fmt::Result {
    let rate = steps as f64 / facts.wall_seconds.max(1e-9);
    let bodies = rate * world.body_count() as f64;
    let threads = if facts.threads == 1 { "1 thread".to_string() } else { format!("{} threads", facts.threads) };
    let wall = brief(facts.wall_seconds);
    writeln!(out, "speed          {} steps/s, {} body steps/s; {wall} s on {threads}", brief(rate), brief(bodies))
}

/// The change in the unit of the energies, so that the ledger's entries add up to that of the total.
fn change(start: f64, end: f64) -> String {
    let change = end - start;
    let sign = if change > 0.0 { "+" } else { "" };
    format!("{sign}{}", brief(change))
}

/// Six digits, in the form that is shorter to read.
pub fn brief(x: f64) -> String {
    let size = x.abs();
    if x == 0.0 {
        "0".into()
    } else if (1e-3..1e7).contains(&size) {
        let digits = (5.0 - size.log10().floor()).clamp(0.0, 9.0) as usize;
        let text = format!("{x:.digits$}");
        if text.contains('.') { text.trim_end_matches('0').trim_end_matches('.').into() } else { text }
    } else {
        format!("{x:.5e}")
    }
}

fn vector(v: Vec3) -> String {
    format!("({}, {}, {})", brief(v.x), brief(v.y), brief(v.z))
}

/// Says on stderr what a user should not overlook.
pub fn warnings(world: &World, scale: &Scale) {
    let largest = world.largest_step();
    if largest > LARGEST_SAFE_STEP {
        warn(&format!(
            "a body moved {} of its own diameter in one step; above {LARGEST_SAFE_STEP} collisions can go unseen at \
             fixed steps: use more steps per frame (--steps-per-frame)",
            brief(largest)
        ));
    }
    let set_aside = world.totals().quarantined;
    if set_aside > 0 {
        warn(&format!("{set_aside} bodies were set aside because their motion was no longer a finite number"));
    }
    let (residual, bound) = (residual(world), scale.bound(world));
    // Written so that a residual that is no number is one too many.
    if !(residual.abs() <= bound) {
        warn(&format!(
            "the ledger leaves {} J unexplained, more than its bound of {} J",
            brief(residual),
            brief(bound)
        ));
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_brief() {
        let texts = [0.0, 1.0, -2.5, 0.1 + 0.2, 1234567.8, 1e-9, 12.0, 100.0, 1e22].map(brief);
        assert_eq!(texts, ["0", "1", "-2.5", "0.3", "1234568", "1.00000e-9", "12", "100", "1.00000e22"]);
    }

    #[test]
    fn a_change_is_told_in_joules() {
        assert_eq!(
            [change(2.0, 0.5), change(-2.0, -1.0), change(0.0, 1e-9), change(3.0, 3.0)],
            ["-1.5", "+1", "+1.00000e-9", "0"]
        );
    }

    #[test]
    fn the_bound_grows_with_what_was_seen() {
        let world = World::new(mrtphys::Settings::default()).unwrap();
        let mut scale = Scale::new(Energy { linear: 1.0, rotational: 2.0, potential: -1.0 });
        assert_eq!(scale.bound(&world), 3e-12);
        scale.see(Energy { linear: 5.0, rotational: 0.0, potential: 4.0 });
        assert_eq!(scale.bound(&world), 1e-12 * (5.0 + 5.0));
    }
}
