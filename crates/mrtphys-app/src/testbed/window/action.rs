//! What a user can ask of the program as a whole: a menu, a key and a button that do the same push the same action.

use std::path::PathBuf;

/// Done by the program after the parts of the window have been shown.
#[derive(Clone, Debug, PartialEq)]
pub enum Action {
    /// start, or stop
    Go,
    /// make one frame and stand still
    Step,
    /// make one physical step and stand still
    PhysicalStep,
    /// go back by one frame
    Back,
    /// begin again
    Restart,
    /// go to the first frame of the recording
    First,
    /// go to the last frame of the recording
    Last,
    /// ask for a scene file, and open it
    OpenFile,
    /// open a scene file, or take up a snapshot
    Open(PathBuf),
    /// open a scene of the gallery
    OpenGallery(&'static str),
    /// show or hide the gallery
    Gallery,
    /// read the scene again from where it came from
    Reload,
    /// write the present state as a scene
    SaveScene,
    /// write the world, to go on from later
    SaveSnapshot,
    /// go on from a snapshot
    LoadSnapshot,
    /// make a picture file
    Screenshot,
    /// make a film
    Film,
    /// open a section of the panel
    Reveal(&'static str),
    /// a body was selected in the picture: show its properties, if the panel is shown
    Selected,
    /// show or hide the panel
    SidePanel,
    /// show or hide the area at the bottom
    Below,
    /// the scene's camera
    ResetCamera,
    /// look from where everything fits into the picture
    FitCamera,
    /// light or dark
    Theme,
    /// larger or smaller letters, by this many steps; 0: as at first
    Scale(i8),
    /// show or hide mouse, keys and modes
    Help,
    /// show or hide version and licence
    About,
    /// end the program
    Quit,
}
