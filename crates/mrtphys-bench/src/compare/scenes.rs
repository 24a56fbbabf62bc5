//! The scenes of the comparison and how long each is run. A scene of another kind is a [`Subject`] and one more line of
//! [`catalogue`].

use crate::gas::{GasShape, GasSpec};
use crate::peers::scene::SceneData;
use mrtphys::BroadPhaseKind;
use std::sync::Arc;

/// How long a scene is run, in steps.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Plan {
    /// steps that an engine makes when its turn has come, all timed
    pub burst: u64,
    /// turns of every engine in each window of time
    pub rounds: u64,
    /// steps after which the second window begins, if it is reached
    pub late: Option<u64>,
    /// steps in which collisions are counted after the first window, at most: the second window comes before
    pub watch: u64,
    /// steps in all
    pub end: u64,
    /// whether the peers' thin margins are measured as well
    pub thin: bool,
}

/// What is simulated.
pub trait Subject {
    /// The scene that every engine is given.
    fn data(&self) -> SceneData;

    /// Steps with a change of velocity per body and second by theory, at this root of the mean square velocity \[m/s\]; `None`
    /// where there is no theory.
    fn theory(&self, _speed: f64) -> Option<f64> {
        None
    }

    /// Whether bodies fly freely while they are watched, so that a run in which none is seen to is none of this scene. In a
    /// stack none does.
    fn flies(&self) -> bool;
}

impl Subject for GasSpec {
    fn data(&self) -> SceneData {
        GasSpec::data(self)
    }

    fn theory(&self, speed: f64) -> Option<f64> {
        (self.shape == GasShape::Spheres).then(|| self.changes_per_body_second(speed * speed))
    }

    fn flies(&self) -> bool {
        true
    }
}

/// A scene of the comparison.
#[derive(Clone)]
pub struct Scene {
    /// name on the command line and in tables: kind and size, `@`, steps per second
    pub name: String,
    /// what is simulated
    pub subject: Arc<dyn Subject>,
    /// how long
    pub plan: Plan,
}

impl Scene {
    /// Name without the steps per second.
    pub fn group(&self) -> &str {
        self.name.split('@').next().unwrap_or(&self.name)
    }

    /// The same for a smoke test: some steps of everything.
    pub fn quick(mut self) -> Scene {
        let plan = self.plan;
        let late = plan.late.map(|_| 12);
        self.plan = Plan { burst: plan.burst.min(4), rounds: 2, late, watch: 8, end: 24, thin: plan.thin };
        self
    }
}

/// All scenes, the cheap ones first.
pub fn catalogue() -> Vec<Scene> {
    use GasShape::{Spheres, Tetrahedra};
    let plan = |burst, rounds, late, watch, end, thin| Plan { burst, rounds, late, watch, end, thin };
    let gas = |shape, n, rate, plan| {
        let gas = GasSpec { shape, n, rate, broad_phase: BroadPhaseKind::SortedGrid };
        Scene { name: format!("{}@{rate}", gas.name()), subject: Arc::new(gas), plan }
    };
    vec![
        gas(Spheres, 8, 512, plan(64, 3, Some(512), 512, 5120, true)),
        gas(Spheres, 8, 64, plan(16, 3, Some(64), 64, 640, true)),
        gas(Spheres, 16, 512, plan(32, 3, Some(512), 512, 2560, true)),
        gas(Spheres, 16, 64, plan(16, 3, Some(64), 64, 640, true)),
        gas(Tetrahedra, 8, 512, plan(64, 3, Some(512), 512, 5120, true)),
        gas(Tetrahedra, 8, 64, plan(16, 3, Some(64), 64, 640, true)),
        gas(Tetrahedra, 16, 512, plan(32, 3, Some(512), 512, 2048, true)),
        gas(Tetrahedra, 16, 64, plan(16, 3, Some(64), 64, 640, true)),
        gas(Spheres, 32, 512, plan(8, 3, Some(512), 128, 536, true)),
        gas(Spheres, 32, 64, plan(6, 3, Some(64), 32, 82, true)),
        gas(Spheres, 47, 512, plan(5, 3, None, 24, 40, true)),
        gas(Spheres, 47, 64, plan(2, 3, None, 5, 12, true)),
        gas(Spheres, 100, 512, plan(3, 3, None, 2, 11, false)),
        gas(Spheres, 100, 64, plan(2, 3, None, 1, 7, false)),
    ]
}

/// The scenes of the names, or all.
///
/// # Errors
/// A name that is none, with those there are.
pub fn chosen(names: &[String]) -> Result<Vec<Scene>, String> {
    let all = catalogue();
    if names.is_empty() {
        return Ok(all);
    }
    // `spheres-8` stands for both of its rates.
    let fits = |scene: &Scene, name: &str| scene.name == name || scene.group() == name;
    for name in names {
        if !all.iter().any(|s| fits(s, name)) {
            let known: Vec<_> = all.iter().map(|s| s.name.as_str()).collect();
            return Err(format!("no scene '{name}': {}", known.join(", ")));
        }
    }
    Ok(all.into_iter().filter(|s| names.iter().any(|n| fits(s, n))).collect())
}
