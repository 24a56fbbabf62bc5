//! Engines side by side: one narrow interface, one file per engine.
//!
//! A peer is an optional feature of this crate; a build without features knows only [`ours`]. An engine is given a
//! [`SceneData`] and a [`Setup`], steps, and says where the bodies are: nothing else is asked of it, so that whatever is
//! measured is measured in the same way for all.

#[cfg(feature = "box3d")]
#[allow(unsafe_code)]
mod box3d;
#[cfg(feature = "jolt")]
#[allow(unsafe_code)]
mod jolt;
pub mod ours;
#[cfg(feature = "physx")]
#[allow(unsafe_code)]
mod physx;
#[cfg(feature = "rapier")]
mod rapier;
pub mod scene;

use scene::{SceneData, Triple};

/// Where the bodies are, in the units and in the order of the scene.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct State {
    /// positions of the centres of mass \[m\]
    pub position: Vec<Triple>,
    /// orientations: x, y, z, w
    pub orientation: Vec<[f64; 4]>,
    /// velocities \[m/s\]
    pub velocity: Vec<Triple>,
    /// angular velocities \[rad/s\], world axes
    pub spin: Vec<Triple>,
}

impl State {
    /// Forgets all bodies.
    pub fn clear(&mut self) {
        self.position.clear();
        self.orientation.clear();
        self.velocity.clear();
        self.spin.clear();
    }

    /// Adds the next body.
    pub fn push(&mut self, position: Triple, orientation: [f64; 4], velocity: Triple, spin: Triple) {
        self.position.push(position);
        self.orientation.push(orientation);
        self.velocity.push(velocity);
        self.spin.push(spin);
    }
}

/// An engine with a scene in it.
pub trait Engine {
    /// Version of the engine.
    fn version(&self) -> String;

    /// What was set and is not the engine's default, in words.
    fn settings(&self) -> String;

    /// Makes one step of the scene's length.
    ///
    /// # Errors
    /// What the engine reports, in words.
    fn step(&mut self) -> Result<(), String>;

    /// Says where the bodies are.
    fn read(&self, state: &mut State);
}

/// How far ahead of a contact an engine acts.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Margin {
    /// as the engine does unless told
    Default,
    /// a twentieth of what all four peers do unless told: 0.001 where a sphere has radius 0.46. It saves energy in gases
    Thin,
}

/// What can be chosen for a run.
#[derive(Clone, Copy, Debug)]
pub struct Setup {
    /// margin
    pub margin: Margin,
    /// threads that step
    pub threads: usize,
}

/// The engines that this program knows, built or not.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum EngineKind {
    /// this project
    Ours,
    /// Rapier (Rust, Dimforge)
    Rapier,
    /// Box3D (C, Erin Catto)
    Box3d,
    /// Jolt (C++, Jorrit Rouwe)
    Jolt,
    /// PhysX (C++, NVIDIA)
    Physx,
}

impl EngineKind {
    /// All, in the order of the tables, with their names on the command line and in tables.
    pub const ALL: [(EngineKind, &'static str, &'static str); 5] = [
        (EngineKind::Ours, "ours", "mrtphys"),
        (EngineKind::Rapier, "rapier", "Rapier"),
        (EngineKind::Box3d, "box3d", "Box3D"),
        (EngineKind::Jolt, "jolt", "Jolt"),
        (EngineKind::Physx, "physx", "PhysX"),
    ];

    /// Name on the command line.
    pub fn name(self) -> &'static str {
        Self::ALL[self as usize].1
    }

    /// Name in tables.
    pub fn title(self) -> &'static str {
        Self::ALL[self as usize].2
    }

    /// The engine of a name on the command line.
    pub fn named(name: &str) -> Option<EngineKind> {
        Self::ALL.iter().find(|e| e.1 == name).map(|e| e.0)
    }

    /// Whether this program was built with it.
    pub fn built(self) -> bool {
        match self {
            EngineKind::Ours => true,
            EngineKind::Rapier => cfg!(feature = "rapier"),
            EngineKind::Box3d => cfg!(feature = "box3d"),
            EngineKind::Jolt => cfg!(feature = "jolt"),
            EngineKind::Physx => cfg!(feature = "physx"),
        }
    }

    /// Whether it acts ahead of contacts at all, so that its margin is worth varying.
    pub fn has_margin(self) -> bool {
        self != EngineKind::Ours
    }

    /// Puts a scene into the engine.
    ///
    /// # Errors
    /// The engine is not built, or what it reports, in words.
    pub fn create(self, scene: &SceneData, setup: Setup) -> Result<Box<dyn Engine>, String> {
        match self {
            EngineKind::Ours => ours::create(scene, setup),
            #[cfg(feature = "rapier")]
            EngineKind::Rapier => rapier::create(scene, setup),
            #[cfg(feature = "box3d")]
            EngineKind::Box3d => box3d::create(scene, setup),
            #[cfg(feature = "jolt")]
            EngineKind::Jolt => jolt::create(scene, setup),
            #[cfg(feature = "physx")]
            EngineKind::Physx => physx::create(scene, setup),
            #[cfg(not(all(feature = "rapier", feature = "box3d", feature = "jolt", feature = "physx")))]
            _ => Err(format!("not built: needs the feature '{}'", self.name())),
        }
    }
}

/// Whether this program was built with any peer.
pub fn any_built() -> bool {
    EngineKind::ALL.iter().any(|e| e.0 != EngineKind::Ours && e.0.built())
}

/// The change of units between a scene and a single-precision engine with absolute tolerances.
#[derive(Clone, Copy, Debug)]
pub struct Scale(pub f64);

#[cfg_attr(not(any(feature = "rapier", feature = "box3d", feature = "jolt", feature = "physx")), allow(dead_code))]
impl Scale {
    /// A scene's own.
    pub(crate) fn of(scene: &SceneData) -> Scale {
        Scale(1.0 / scene.unit)
    }

    /// A length, velocity or acceleration as the engine sees it.
    pub(crate) fn vector(self, v: Triple) -> [f32; 3] {
        v.map(|x| (x * self.0) as f32)
    }

    /// A length as the engine sees it.
    pub(crate) fn length(self, x: f64) -> f32 {
        (x * self.0) as f32
    }

    /// A vector of the engine as the scene sees it.
    pub(crate) fn back(self, v: [f32; 3]) -> Triple {
        v.map(|x| f64::from(x) / self.0)
    }
}
