//! What is measured, and how much of it.

use super::measure::{Patience, STEPS_PER_FRAME, Which};
use super::methods::Method;
use super::scenes::Arena;
use std::time::Duration;

/// Frames per second of simulated time, as in the thesis.
const FPS: u32 = 8;
/// The thesis's ten seconds.
const SECONDS: u32 = 10;

/// A scene with the methods that are tried in it.
#[derive(Clone, Debug)]
pub struct Stage {
    /// the scene
    pub arena: Arena,
    /// methods and the steps in which they are measured
    pub cases: Vec<(Method, Which)>,
}

/// The whole experiment.
#[derive(Clone, Debug)]
pub struct Plan {
    /// scenes in order
    pub stages: Vec<Stage>,
    /// how long times are measured
    pub patience: Patience,
}

/// The methods of the thesis's figures and ours.
const IN_CUBES: [Method; 5] = [Method::Nothing, Method::Spheres, Method::Tree, Method::Grid, Method::Sorted];

/// Everything: seven scenes of the thesis, six larger ones, clusters.
pub fn full() -> Plan {
    let steps = FPS * STEPS_PER_FRAME * SECONDS;
    let cubes = [2, 3, 4, 5, 6, 7, 8, 10, 12, 16, 24, 32, 47];
    let mut stages: Vec<Stage> = cubes.into_iter().map(|n| cube(n, steps)).collect();
    stages.extend([4, 8, 16, 24, 32].into_iter().map(|n| clusters(n, 32.0, steps)));
    stages.extend([6.0, 8.0, 16.0, 64.0, 128.0].into_iter().map(|edge| clusters(16, edge, steps)));
    Plan { stages, patience: Patience { time: Duration::from_millis(1200), most: 25 } }
}

/// Seconds long: a second of simulated time of small scenes, one of every kind.
pub fn quick() -> Plan {
    let steps = FPS * STEPS_PER_FRAME;
    let mut stages: Vec<Stage> = [2, 3, 4, 8].into_iter().map(|n| cube(n, steps)).collect();
    let mut sampled = cube(10, steps);
    for (method, which) in &mut sampled.cases {
        if *method == Method::Spheres {
            *which = Which::Windows { steps, windows: 2, each: 1 };
        }
    }
    stages.push(sampled);
    stages.extend([(4, 16.0), (8, 6.0), (8, 16.0)].into_iter().map(|(n, edge)| clusters(n, edge, steps)));
    Plan { stages, patience: Patience { time: Duration::ZERO, most: 1 } }
}

/// Slow methods are measured in a part of the steps of large scenes.
fn cube(n: u32, steps: u32) -> Stage {
    let which = |method| match (method, n) {
        (Method::Spheres, 17..=24) => Which::Windows { steps, windows: 20, each: 1 },
        (Method::Spheres, 25..=32) => Which::Windows { steps, windows: 8, each: 1 },
        (Method::Spheres, 33..) => Which::Windows { steps, windows: 3, each: 1 },
        (Method::Tree | Method::Grid, 24..=32) => Which::Windows { steps, windows: 20, each: 4 },
        (Method::Tree | Method::Grid | Method::Sorted, 33..) => Which::Windows { steps, windows: 8, each: 3 },
        _ => Which::All { steps },
    };
    Stage { arena: Arena::Cube { n }, cases: IN_CUBES.into_iter().map(|m| (m, which(m))).collect() }
}

fn clusters(n: u32, edge: f64, steps: u32) -> Stage {
    let which = |method| match (method, n) {
        (_, 0..=8) => Which::All { steps },
        (Method::Spheres, 25..) => Which::Windows { steps, windows: 4, each: 1 },
        (_, 25..) => Which::Windows { steps, windows: 5, each: 2 },
        (Method::Spheres, _) => Which::Windows { steps, windows: 10, each: 1 },
        _ => Which::Windows { steps, windows: 20, each: 3 },
    };
    let methods = [Method::Spheres, Method::Tree, Method::DeepTree, Method::Grid, Method::Sorted];
    Stage { arena: Arena::Clusters { n, edge }, cases: methods.into_iter().map(|m| (m, which(m))).collect() }
}
