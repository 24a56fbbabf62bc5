//! How many pixels a picture has: all of them, unless drawing them takes so long that motion would stutter.

use std::time::Duration;

/// Parts of the full width and height.
const STEPS: [f32; 4] = [1.0, 0.75, 0.55, 0.4];
/// A moving picture that takes longer is drawn with fewer pixels.
const SLOW: Duration = Duration::from_millis(45);
/// One that takes less is drawn with more, if the next step is expected to stay below `SLOW`.
const FAST: Duration = Duration::from_millis(20);
/// So long after the last motion the picture is drawn in full.
pub const REST: Duration = Duration::from_millis(250);

/// Chooses the resolution of moving pictures by how long the last ones took.
#[derive(Clone, Debug, Default)]
pub struct Detail {
    step: usize,
}

impl Detail {
    /// Part of the full width and height for a picture that is moving.
    pub fn part(&self) -> f32 {
        STEPS[self.step]
    }

    /// A moving picture at [`part`](Detail::part) took so long.
    pub fn took(&mut self, time: Duration) {
        if time > SLOW {
            // Time goes with the number of pixels, or less where corners weigh: at least one step.
            let wanted = self.part() * (SLOW.as_secs_f32() / time.as_secs_f32()).sqrt();
            let fits = STEPS.iter().position(|s| *s <= wanted).unwrap_or(STEPS.len() - 1);
            self.step = fits.max(self.step + 1).min(STEPS.len() - 1);
        } else if time < FAST && self.step > 0 {
            let growth = (STEPS[self.step - 1] / self.part()).powi(2);
            if time.mul_f32(growth) < SLOW.mul_f32(0.8) {
                self.step -= 1;
            }
        }
    }
}

/// How long to wait after a picture that took so long, so that drawing in software takes no more than half the time of a
/// processor: the simulation needs it, too.
pub fn pause(time: Duration) -> Duration {
    time.max(Duration::from_millis(16)).min(Duration::from_millis(200))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn ms(x: f32) -> Duration {
        Duration::from_secs_f32(x / 1000.0)
    }

    #[test]
    fn fast_pictures_have_all_pixels() {
        let mut d = Detail::default();
        (0..100).for_each(|_| d.took(ms(30.0)));
        assert_eq!(d.part(), 1.0);
    }

    #[test]
    fn resolution_settles_where_the_time_is_good() {
        for full in [10.0, 60.0, 120.0, 300.0, 5000.0] {
            let mut d = Detail::default();
            let mut seen = Vec::new();
            for _ in 0..50 {
                d.took(ms(full * d.part() * d.part()));
                seen.push(d.part());
            }
            let last = seen[49];
            assert!(seen[10..].iter().all(|p| *p == last), "{full}: {seen:?}");
            assert!(full * last * last < 46.0 || last == STEPS[3], "{full}: {last}");
        }
    }

    #[test]
    fn it_comes_back_when_the_scene_becomes_easy() {
        let mut d = Detail::default();
        d.took(ms(2000.0));
        assert!(d.part() < 0.5);
        (0..10).for_each(|_| d.took(ms(3.0)));
        assert_eq!(d.part(), 1.0);
    }

    #[test]
    fn pauses_are_neither_busy_nor_long() {
        let of = |x: u64| pause(Duration::from_millis(x)).as_millis();
        assert_eq!([of(1), of(80), of(4000)], [16, 80, 200]);
    }
}
