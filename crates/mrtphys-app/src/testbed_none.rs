//! The testbed, in a build without it.

use crate::exit::{Failure, Outcome};
use mrtphys_scene::Scene;

/// Says what is missing.
pub fn open(_scene: Option<Scene>) -> Outcome {
    Err(Failure::Wrong(
        "this program was built without the testbed (cargo feature 'testbed'); 'mrtphys run SCENE' simulates without a window, 'mrtphys scenes' lists the gallery".into(),
    ))
}
