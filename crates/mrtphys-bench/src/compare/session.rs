//! One engine with one scene, timed and watched.

use super::check::{self, Masses, Watched};
use super::overlap::{Overlaps, overlaps};
use super::stats::{Clock, Times};
use crate::peers::scene::SceneData;
use crate::peers::{Engine, State};

/// Times of some steps by both clocks.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Burst {
    /// time that all threads of this process computed
    pub cpu: Times,
    /// time that went by
    pub wall: Times,
}

/// What the bodies are like now.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Truth {
    /// energy by that at the start
    pub energy: f64,
    /// bodies outside
    pub escaped: usize,
    /// overlaps
    pub overlaps: Overlaps,
}

/// An engine at work.
pub struct Session {
    scene: SceneData,
    engine: Box<dyn Engine>,
    masses: Masses,
    energy: f64,
    state: State,
    next: State,
}

impl Session {
    /// Begins: looks whether the engine has the scene's initial state.
    ///
    /// # Errors
    /// It has another, in words.
    pub fn new(scene: SceneData, engine: Box<dyn Engine>) -> Result<Session, String> {
        let mut state = State::default();
        engine.read(&mut state);
        check::same_start(&scene, &state)?;
        let masses = Masses::new(&scene)?;
        let energy = masses.energy(&state);
        Ok(Session { scene, engine, masses, energy, state, next: State::default() })
    }

    /// The engine.
    pub fn engine(&self) -> &dyn Engine {
        &*self.engine
    }

    /// Makes steps and times them: nothing else is done between them.
    ///
    /// # Errors
    /// The engine's.
    pub fn time(&mut self, steps: u64) -> Result<Burst, String> {
        let whole = Clock::start()?;
        let (mut cpu, mut wall) = (Vec::with_capacity(steps as usize), Vec::with_capacity(steps as usize));
        for _ in 0..steps {
            let clock = Clock::start()?;
            self.engine.step()?;
            let (computed, went_by) = clock.read();
            cpu.push(computed.as_secs_f64());
            wall.push(went_by.as_secs_f64());
        }
        let (computed, went_by) = whole.read();
        Ok(Burst { cpu: Times::of(&cpu, computed), wall: Times::of(&wall, went_by) })
    }

    /// Makes steps.
    ///
    /// # Errors
    /// The engine's.
    pub fn run(&mut self, steps: u64) -> Result<(), String> {
        (0..steps).try_for_each(|_| self.engine.step())
    }

    /// Makes steps and looks at every body before and after each.
    ///
    /// # Errors
    /// The engine's.
    pub fn watch(&mut self, steps: u64) -> Result<Watched, String> {
        let mut watched = Watched::default();
        self.engine.read(&mut self.state);
        for _ in 0..steps {
            self.engine.step()?;
            self.engine.read(&mut self.next);
            check::watch(&self.scene, &self.state, &self.next, &mut watched);
            std::mem::swap(&mut self.state, &mut self.next);
        }
        Ok(watched)
    }

    /// Looks at the bodies as they are now.
    pub fn truth(&mut self) -> Truth {
        self.engine.read(&mut self.state);
        Truth {
            energy: self.masses.energy(&self.state) / self.energy,
            escaped: check::escaped(&self.scene, &self.state),
            overlaps: overlaps(&self.scene, &self.state),
        }
    }
}
