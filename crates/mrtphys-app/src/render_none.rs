//! `mrtphys render` in a program that was built without graphics.

use crate::exit::{Failure, Outcome};
use crate::render_args::RenderArgs;

/// Refuses.
pub fn render(_args: &RenderArgs, _quiet: bool) -> Outcome {
    Err(Failure::Wrong(
        "'render': this program was built without graphics (cargo feature 'view'); 'mrtphys run SCENE --trajectory FILE.csv' \
         writes every body at every frame"
            .into(),
    ))
}
