//! A control shows what was asked for until the session, which lives on another thread, says the same.

use std::time::{Duration, Instant};

/// How long a session that says nothing is believed to be on its way.
const PATIENCE: Duration = Duration::from_secs(1);

/// What was asked for last.
#[derive(Clone, Copy, Debug)]
pub struct Pending<T> {
    asked: Option<(T, Instant)>,
}

impl<T> Default for Pending<T> {
    fn default() -> Pending<T> {
        Pending { asked: None }
    }
}

impl<T: Copy + PartialEq> Pending<T> {
    /// What the control is to show, where the session says `reported`.
    pub fn shown(&mut self, reported: T, now: Instant) -> T {
        match self.asked {
            Some((value, since)) if value != reported && now.saturating_duration_since(since) < PATIENCE => value,
            _ => {
                self.asked = None;
                reported
            }
        }
    }

    /// Something else was asked for.
    pub fn ask(&mut self, value: T, now: Instant) {
        self.asked = Some((value, now));
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_asked_value_is_shown_until_it_is_reported_or_refused() {
        let (start, mut fps) = (Instant::now(), Pending::default());
        assert_eq!(fps.shown(60, start), 60);
        fps.ask(100, start);
        assert_eq!(fps.shown(60, start), 100, "the session has not heard yet");
        assert_eq!(fps.shown(100, start), 100);
        assert_eq!(fps.shown(60, start), 60, "it was reported, so a later change is somebody else's");
        fps.ask(0, start);
        assert_eq!(fps.shown(60, start + PATIENCE / 2), 0);
        assert_eq!(fps.shown(60, start + PATIENCE), 60, "refused");
    }
}
