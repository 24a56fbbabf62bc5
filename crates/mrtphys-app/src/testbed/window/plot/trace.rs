//! What happened since the scene was loaded, frame by frame, in bounded memory.

use crate::testbed::session::Sample;
use std::time::Duration;

/// What happened in a frame, or in several that follow each other.
pub type Moment = Sample;

/// More moments are merged in pairs: a plot has no more pixels.
const MOST: usize = 4096;

/// Moments in order of time.
#[derive(Clone, Debug, Default)]
pub struct Trace {
    moments: Vec<Moment>,
    /// frames in a moment
    every: u64,
    /// whether the last moment is not complete
    open: bool,
}

impl Trace {
    /// Adds what is new. Where time was turned back, what came after is forgotten.
    pub fn extend(&mut self, samples: &[Sample]) {
        for sample in samples {
            self.push(sample);
        }
    }

    fn push(&mut self, sample: &Sample) {
        if self.moments.last().is_some_and(|m| sample.time < m.time || sample.tick < m.tick) {
            self.forget_after(sample);
        }
        let merged = match self.moments.last_mut().filter(|_| self.open) {
            Some(last) => {
                merge(last, sample);
                last.frames
            }
            None => {
                self.moments.push(sample.clone());
                sample.frames
            }
        };
        self.open = merged < self.every.max(1);
        if self.moments.len() > MOST {
            self.halve();
        }
    }

    /// Time was turned back to before this sample.
    fn forget_after(&mut self, sample: &Sample) {
        // A moment that began before and ended after is not known any more.
        let keep = self.moments.partition_point(|m| m.time < sample.time && m.tick < sample.tick.max(1));
        self.moments.truncate(keep);
        self.open = false;
    }

    fn halve(&mut self) {
        self.every = self.every.max(1) * 2;
        let old = std::mem::take(&mut self.moments);
        let mut pairs = old.into_iter();
        while let Some(mut first) = pairs.next() {
            if let Some(second) = pairs.next() {
                merge(&mut first, &second);
            }
            self.moments.push(first);
        }
        self.open = self.moments.last().is_some_and(|m| m.frames < self.every);
    }

    /// All of them.
    pub fn moments(&self) -> &[Moment] {
        &self.moments
    }

    /// Nothing is known any more.
    pub fn clear(&mut self) {
        *self = Trace::default();
    }
}

/// At most so many moments, neighbours taken together: counts of single frames fluctuate, and their mean is what is looked for.
pub fn grouped(moments: &[Moment], most: usize) -> Vec<Moment> {
    let size = moments.len().div_ceil(most.max(1)).max(1);
    let together = |group: &[Moment]| {
        let mut all = group.first().cloned()?;
        group[1..].iter().for_each(|m| merge(&mut all, m));
        Some(all)
    };
    // What is left at the end goes to the last group: a mean of a few would stand out from the others.
    let groups = (moments.len() / size).max(1);
    let end = |i: usize| if i + 1 == groups { moments.len() } else { (i + 1) * size };
    (0..groups).filter_map(|i| together(&moments[i * size..end(i)])).collect()
}

/// Two moments as one: the state is that of the later, the rest is summed.
fn merge(into: &mut Moment, next: &Sample) {
    let before = into.clone();
    *into = next.clone();
    into.frames += before.frames;
    into.counts += before.counts;
    into.steps += before.steps;
    into.duration += before.duration;
    into.cost += before.cost;
}

/// Of a moment: per step, per second.
pub trait Rates {
    /// Divides a count by the steps.
    fn per_step(&self, count: u64) -> Option<f64>;
    /// Divides a count by the simulated time \[1/s\].
    fn per_second(&self, count: u64) -> Option<f64>;
    /// Computing time of a step.
    fn step_cost(&self) -> Option<Duration>;
}

impl Rates for Moment {
    fn per_step(&self, count: u64) -> Option<f64> {
        (self.steps > 0).then(|| count as f64 / self.steps as f64)
    }

    fn per_second(&self, count: u64) -> Option<f64> {
        (self.duration > 0.0).then(|| count as f64 / self.duration)
    }

    fn step_cost(&self) -> Option<Duration> {
        (self.steps > 0).then(|| self.cost.div_f64(self.steps as f64))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use mrtphys::counters::Counters;

    fn sample(tick: u64) -> Sample {
        Sample {
            tick,
            time: tick as f64 * 0.5,
            frames: 1,
            steps: 8,
            duration: 0.5,
            cost: Duration::from_micros(80),
            counts: Counters { sphere_tests: 16, ..Counters::default() },
            ..Sample::default()
        }
    }

    #[test]
    fn memory_is_bounded_and_sums_are_kept() {
        let mut trace = Trace::default();
        let n = 3 * MOST as u64 + 77;
        for tick in 1..=n {
            trace.extend(&[sample(tick)]);
        }
        let all = trace.moments();
        assert!(all.len() <= MOST && all.len() > MOST / 4);
        assert_eq!(all.iter().map(|m| m.frames).sum::<u64>(), n);
        assert_eq!(all.iter().map(|m| m.counts.sphere_tests).sum::<u64>(), 16 * n);
        assert!(all.windows(2).all(|w| w[0].time < w[1].time));
        assert_eq!(all.last().map(|m| m.tick), Some(n));
        assert!(all.iter().all(|m| m.per_step(m.counts.sphere_tests) == Some(2.0)));
        assert!(all.iter().all(|m| m.per_second(m.counts.sphere_tests) == Some(32.0)));
        assert!(all.iter().all(|m| m.step_cost() == Some(Duration::from_micros(10))));
    }

    #[test]
    fn going_back_forgets_what_came_after() {
        let mut trace = Trace::default();
        (1..=20).for_each(|tick| trace.extend(&[sample(tick)]));
        trace.extend(&[sample(11)]);
        let ticks: Vec<u64> = trace.moments().iter().map(|m| m.tick).collect();
        assert_eq!(ticks, (1..=11).collect::<Vec<_>>());
        trace.extend(&[sample(0)]);
        assert_eq!(trace.moments().len(), 1, "from the start again");
    }

    #[test]
    fn groups_are_few_and_keep_the_sums() {
        let moments: Vec<Moment> = (1..=1000).map(sample).collect();
        let groups = grouped(&moments, 240);
        assert_eq!((groups.len(), groups.iter().map(|m| m.frames).sum::<u64>()), (200, 1000));
        assert!(groups.iter().all(|m| m.per_second(m.counts.sphere_tests) == Some(32.0)));
        assert_eq!(grouped(&moments[..7], 240).len(), 7);
        let uneven = grouped(&moments[..481], 240);
        assert!(uneven.len() <= 240 && uneven.iter().all(|m| (3..6).contains(&m.frames)), "{}", uneven.len());
        assert_eq!(uneven.iter().map(|m| m.frames).sum::<u64>(), 481);
        assert!(grouped(&[], 240).is_empty());
    }

    #[test]
    fn an_edit_has_no_rates() {
        let edit = Sample { tick: 3, frames: 0, ..Sample::default() };
        assert_eq!((edit.per_step(5), edit.per_second(5), edit.step_cost()), (None, None, None));
    }
}
