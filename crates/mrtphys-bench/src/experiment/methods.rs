//! What is compared: the thesis's three methods, the broad phase made for speed, and a world that detects nothing.

use mrtphys::broad::{BoundsView, BroadPhase, Candidates};
use mrtphys::{BroadPhaseKind, Result, World};

/// A way of finding the pairs to be tested.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Method {
    /// the thesis's bSphere: bounding spheres, every pair
    Spheres,
    /// the thesis's adaptive tree, at most 16 levels deep as in its appendix A.2
    Tree,
    /// the same, up to 32 levels deep
    DeepTree,
    /// the thesis's regular grid with 2n cells along each axis
    Grid,
    /// counting-sorted cells: ours
    Sorted,
    /// motion and bounding spheres, no detection
    Nothing,
}

impl Method {
    /// Every method, in the order of the tables.
    pub const ALL: [Method; 6] =
        [Method::Nothing, Method::Spheres, Method::Tree, Method::DeepTree, Method::Grid, Method::Sorted];

    /// Name in tables and figures; the thesis's where it has one.
    pub fn name(self) -> &'static str {
        match self {
            Method::Spheres => "bSphere",
            Method::Tree => "Adaptive",
            Method::DeepTree => "Adaptive 32",
            Method::Grid => "Grid 2n",
            Method::Sorted => "sorted-grid",
            Method::Nothing => "0 test",
        }
    }

    /// The method of this name.
    pub fn named(name: &str) -> Option<Method> {
        Method::ALL.into_iter().find(|m| m.name() == name)
    }

    /// The broad phase for n^3 bodies; none: nothing is detected.
    pub fn broad_phase(self, n: u32) -> Option<BroadPhaseKind> {
        let tree = |max_depth| BroadPhaseKind::AdaptiveTree {
            objects_per_cell: BroadPhaseKind::DEFAULT_OBJECTS_PER_CELL,
            max_depth,
        };
        match self {
            Method::Spheres => Some(BroadPhaseKind::BruteForce),
            Method::Tree => Some(tree(BroadPhaseKind::DEFAULT_MAX_DEPTH)),
            Method::DeepTree => Some(tree(2 * BroadPhaseKind::DEFAULT_MAX_DEPTH)),
            Method::Grid => Some(BroadPhaseKind::RegularGrid { resolution: Some(2 * n) }),
            Method::Sorted => Some(BroadPhaseKind::SortedGrid),
            Method::Nothing => None,
        }
    }

    /// The broad phase as on the command line.
    pub fn command_line(self, n: u32) -> String {
        self.broad_phase(n).map_or_else(|| "none".to_string(), |kind| kind.to_string())
    }

    /// From now on the world finds its pairs in this way.
    ///
    /// # Errors
    /// None for worlds of this crate.
    pub fn apply(self, world: &mut World, n: u32) -> Result<()> {
        match self.broad_phase(n) {
            Some(broad_phase) => world.set_settings(mrtphys::Settings { broad_phase, ..world.settings().clone() }),
            None => {
                world.set_broad_phase(Box::new(NoDetection));
                Ok(())
            }
        }
    }
}

/// Finds nothing. Bodies pass through each other and through the limits. This is the thesis's "0 Test": its program with
/// the physics switched off still drew the scene; ours still moves the bodies and places their bounding spheres.
#[derive(Clone, Copy, Debug)]
struct NoDetection;

impl BroadPhase for NoDetection {
    fn name(&self) -> String {
        "none".into()
    }

    fn find(&mut self, _view: &BoundsView<'_>, _out: &mut Candidates) {}
}
