//! What can be asked of a session.

use super::pace::RealTime;
use super::report::Recorded;
use mrtphys::def::Settings;
use mrtphys::{BodyId, Vec3};
use mrtphys_scene::Loaded;

/// A change of the world. It is called for the world, for its rival, and again whenever a frame after it is restored: so it
/// must do the same to the same world, and nothing else. An error is shown to the user.
pub type Change = Box<dyn Fn(&mut Loaded) -> Result<(), String> + Send>;
/// A look at the session from its thread.
pub type Question = Box<dyn FnOnce(&Studio<'_>) + Send>;

/// Steers a session.
pub enum Command {
    /// run, or stand still
    Go(bool),
    /// make one frame and stand still
    Frame,
    /// make one physical step and stand still
    Step,
    /// go back by one frame and stand still
    Back,
    /// go to a frame of the recording (its number in [`Timeline`](super::report::Timeline)) and stand still; running on from there
    /// replaces what came after
    Seek(u64),
    /// begin again with the scene as it was loaded
    Restart,
    /// frames per second of simulated time \[1/s\]; the frame counter begins anew (thesis, section 7.1)
    Fps(u32),
    /// physical steps per frame
    StepsPerFrame(u32),
    /// how simulated time follows real time
    RealTime(RealTime),
    /// simulated seconds per real second in the real-time modes: 0.1 is slow motion
    Speed(f64),
    /// change the world
    Edit {
        /// what
        change: Change,
        /// whether bodies come or go, or look different
        structural: bool,
    },
    /// what reports are to contain beside the poses
    Wish(Wish),
    /// hold a body with the mouse; `None`: let go, and it flies on
    Hold(Option<Grip>),
    /// run a rival beside the world, from the same state with other settings; `None`: no longer
    Rival(Option<Settings>),
    /// let a closure look at the world and the recording: to save, to export, to hash
    Ask(Question),
}

/// What a report contains beside the poses; what is not wished for costs nothing.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Wish {
    /// contacts of the last step
    pub contacts: bool,
    /// number of contacts of every body in the last step
    pub touches: bool,
    /// impacts since the last report
    pub impacts: bool,
    /// velocity and angular velocity of every body
    pub velocities: bool,
    /// axis-parallel box of every body
    pub boxes: bool,
    /// cells of the broad phase
    pub cells: bool,
    /// speeds for the histogram
    pub speeds: bool,
    /// poses of so many frames before this one
    pub trail: usize,
    /// the body whose properties are shown
    pub selected: Option<BodyId>,
}

/// The hand that holds a body: a spring from a point of the body to the mouse, critically damped, booked to `user`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Grip {
    /// which body
    pub body: BodyId,
    /// where it is held, in the body's own axes \[m\]
    pub point: Vec3,
    /// where the mouse is \[m\]
    pub target: Vec3,
}

/// What a question sees.
pub struct Studio<'a> {
    /// the world, its names and its scene
    pub loaded: &'a Loaded,
    /// the recording, oldest first
    pub frames: &'a dyn Fn() -> Vec<Recorded>,
}
