//! The testbed, in a build without it.

use crate::cli::ViewArgs;
use crate::exit::{Failure, Outcome};

/// Says what is missing.
pub fn open(_args: &ViewArgs) -> Outcome {
    Err(Failure::Wrong(
        "this program was built without the testbed (cargo feature 'testbed'); 'mrtphys run SCENE' simulates without a window, 'mrtphys scenes' lists the gallery".into(),
    ))
}
