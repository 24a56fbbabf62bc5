//! Definitions: what a user fills in to create a world and its contents. Names are those of the scene language.

use crate::math::{Quat, Real, Vec3};
use crate::shape::Shape;
use std::sync::Arc;

/// Declares an enum of named choices: its names as in scenes and on the command line, `FromStr`, `Display` and a list.
macro_rules! choices {
    ($(#[$doc:meta])* $name:ident { $($(#[$vdoc:meta])* $variant:ident = $text:literal),+ $(,)? }) => {
        $(#[$doc])*
        #[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
        pub enum $name { $($(#[$vdoc])* $variant),+ }
        impl $name {
            /// Every choice with its name, in the order of the documentation.
            pub const ALL: &'static [(&'static str, $name)] = &[$(($text, $name::$variant)),+];
            /// The name used in scenes and on the command line.
            pub fn name(self) -> &'static str { match self { $($name::$variant => $text),+ } }
        }
        impl std::fmt::Display for $name {
            fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result { f.write_str(self.name()) }
        }
        impl std::str::FromStr for $name {
            type Err = String;
            /// The error is the list of the names there are.
            fn from_str(s: &str) -> Result<Self, String> {
                Self::ALL.iter().find(|(n, _)| *n == s).map(|(_, v)| *v).ok_or_else(|| {
                    Self::ALL.iter().map(|(n, _)| *n).collect::<Vec<_>>().join(", ")
                })
            }
        }
    };
}

choices! {
    /// The time-stepping algorithm (thesis, section 5.2).
    Algorithm {
        /// Algorithm III: frames split into physical steps; move, detect, respond
        FixedStep = "fixed-step",
    }
}

choices! {
    /// How an impact with friction is answered (thesis, section 3.8.4; `spec` critique 4).
    FrictionLaw {
        /// no tangential impulse
        Frictionless = "frictionless",
        /// the thesis's law in its sensible reading, with guards: momentum weights for pairs, velocity weights against infinite mass
        Kurtenbach = "kurtenbach",
        /// equations (59)-(70) as printed, (67) included: loses energy at every frictional wall contact
        KurtenbachLiteral = "kurtenbach-literal",
        /// velocity weights everywhere: the Galilei-invariant reading of (63)-(66)
        Velocity = "velocity",
        /// weights of the effective mass: at friction 1 the perfectly rough ball
        Rough = "rough",
        /// tangential impulse at most mu times the normal one; never adds energy
        Coulomb = "coulomb",
    }
}

choices! {
    /// How simultaneous impacts are answered.
    ImpactMode {
        /// one contact after the other, in ascending order of the pair
        Sequential = "sequential",
        /// generalized reflections of all contacts that hang together (Smith et al. 2012)
        Reflection = "reflection",
    }
}

choices! {
    /// Which pair routines are used.
    ContactMode {
        /// true normals and manifolds
        Exact = "exact",
        /// the thesis's own routines: one point, bisector normal
        Thesis = "thesis",
    }
}

choices! {
    /// Which inertia a body has.
    InertiaMode {
        /// the body's own tensor
        Full = "full",
        /// the thesis's assumption 3: that of a sphere, 2/5 m r^2 with the bounding radius, about every axis
        Sphere = "sphere",
    }
}

choices! {
    /// The integrator of the motion between impacts.
    Integrator {
        /// x += v dt + a dt^2/2, v += (a0 + a1) dt/2; drag exact: energy exact in uniform fields
        Parabola = "parabola",
        /// v += a dt, x += v dt
        SemiImplicitEuler = "semi-implicit-euler",
        /// x += v dt, v += a dt: the order of the thesis
        ExplicitEuler = "explicit-euler",
        /// the classical fourth-order scheme
        RungeKutta4 = "runge-kutta-4",
    }
}

choices! {
    /// How the values of two surfaces make the value of the pair.
    Combine {
        /// arithmetic mean
        Average = "average",
        /// the smaller
        Minimum = "minimum",
        /// the larger
        Maximum = "maximum",
        /// the square root of the product
        GeometricMean = "geometric-mean",
        /// the product, equation (58): the default
        Multiply = "multiply",
    }
}

/// Which broad phase finds the candidate pairs, with its parameters.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum BroadPhaseKind {
    /// every pair: the slow twin of all others
    BruteForce,
    /// the thesis's regular grid: `resolution` cells along each axis of the scene
    RegularGrid {
        /// cells along each axis; `None`: twice the cube root of the number of bodies (the thesis's 2n)
        resolution: Option<u32>,
    },
    /// the thesis's adaptive binary tree
    AdaptiveTree {
        /// a leaf with more objects is split
        objects_per_cell: u32,
        /// deepest level, counted from the root
        max_depth: u32,
    },
    /// counting sort into cells of twice the largest radius: made for speed
    SortedGrid,
}

impl BroadPhaseKind {
    /// The thesis's default depth (appendix A.2).
    pub const DEFAULT_MAX_DEPTH: u32 = 16;
    /// Objects per cell of the adaptive tree unless told.
    pub const DEFAULT_OBJECTS_PER_CELL: u32 = 4;
}

impl std::fmt::Display for BroadPhaseKind {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            BroadPhaseKind::BruteForce => f.write_str("brute-force"),
            BroadPhaseKind::RegularGrid { resolution: None } => f.write_str("regular-grid"),
            BroadPhaseKind::RegularGrid { resolution: Some(n) } => write!(f, "regular-grid:{n}"),
            BroadPhaseKind::AdaptiveTree { objects_per_cell, max_depth } => {
                write!(f, "adaptive-tree:{objects_per_cell}:{max_depth}")
            }
            BroadPhaseKind::SortedGrid => f.write_str("sorted-grid"),
        }
    }
}

impl std::str::FromStr for BroadPhaseKind {
    type Err = String;
    fn from_str(s: &str) -> Result<BroadPhaseKind, String> {
        let mut parts = s.split(':');
        let name = parts.next().unwrap_or_default();
        let mut number = |what: &str, low: u32, high: u32| -> Result<Option<u32>, String> {
            let Some(text) = parts.next() else { return Ok(None) };
            match text.parse::<u32>() {
                Ok(n) if (low..=high).contains(&n) => Ok(Some(n)),
                _ => Err(format!("{what} '{text}' is not a number from {low} to {high}")),
            }
        };
        let kind = match name {
            "brute-force" => BroadPhaseKind::BruteForce,
            "regular-grid" => BroadPhaseKind::RegularGrid { resolution: number("resolution", 1, 1024)? },
            "adaptive-tree" => BroadPhaseKind::AdaptiveTree {
                objects_per_cell: number("objects per cell", 1, 1_000_000)?.unwrap_or(Self::DEFAULT_OBJECTS_PER_CELL),
                max_depth: number("depth", 0, 48)?.unwrap_or(Self::DEFAULT_MAX_DEPTH),
            },
            "sorted-grid" => BroadPhaseKind::SortedGrid,
            _ => {
                return Err(
                    "brute-force, regular-grid[:RESOLUTION], adaptive-tree[:OBJECTS_PER_CELL[:MAX_DEPTH]], sorted-grid"
                        .into(),
                );
            }
        };
        match parts.next() {
            None => Ok(kind),
            Some(extra) => Err(format!("'{extra}' is more than '{name}' can be given")),
        }
    }
}

/// How a world is simulated. All of it may be changed between steps.
#[derive(Clone, Debug, PartialEq)]
pub struct Settings {
    /// time-stepping algorithm
    pub algorithm: Algorithm,
    /// broad phase
    pub broad_phase: BroadPhaseKind,
    /// friction law
    pub friction_law: FrictionLaw,
    /// simultaneous impacts
    pub impact: ImpactMode,
    /// pair routines; fixed when the world is made
    pub contact: ContactMode,
    /// inertia; fixed when the world is made
    pub inertia: InertiaMode,
    /// integrator
    pub integrator: Integrator,
    /// frames per second of simulated time \[1/s\], 1 to 10^9
    pub fps: u32,
    /// physical steps per frame, 1 to 10^9
    pub steps_per_frame: u32,
    /// viscosity of the medium, 0 (void) to 1 (very tough): v relaxes to the flow as (1 - viscosity)^(dt / 1 s)
    pub viscosity: Real,
    /// whether viscosity brakes the spin too
    pub viscous_spin: bool,
    /// density of the medium \[kg/m3\], for buoyancy
    pub medium_density: Real,
}

impl Default for Settings {
    fn default() -> Settings {
        Settings {
            algorithm: Algorithm::FixedStep,
            broad_phase: BroadPhaseKind::SortedGrid,
            friction_law: FrictionLaw::Kurtenbach,
            impact: ImpactMode::Sequential,
            contact: ContactMode::Exact,
            inertia: InertiaMode::Full,
            integrator: Integrator::Parabola,
            fps: 60,
            steps_per_frame: 8,
            viscosity: 0.0,
            viscous_spin: false,
            medium_density: 0.0,
        }
    }
}

/// The mass of a body.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Mass {
    /// \[kg\], positive and finite
    Value(Real),
    /// \[kg/m3\], positive and finite: times the shape's volume
    Density(Real),
    /// infinite: the body never moves, its velocities are taken as zero
    Infinite,
}

/// Surface properties.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Surface {
    /// friction coefficient: 0 oiled to 1 sandpaper for the thesis's laws; any non-negative number for `coulomb`
    pub friction: Real,
    /// coefficient of restitution, 0 to 1
    pub restitution: Real,
    /// how friction combines with the partner's
    pub friction_combine: Combine,
    /// how restitution combines with the partner's
    pub restitution_combine: Combine,
}

impl Default for Surface {
    fn default() -> Surface {
        Surface {
            friction: 0.0,
            restitution: 1.0,
            friction_combine: Combine::Multiply,
            restitution_combine: Combine::Multiply,
        }
    }
}

impl Combine {
    /// The rule for a pair whose two surfaces name different rules: the first of average, minimum, maximum, geometric mean,
    /// multiply that either names (the precedence of glTF's KHR_physics_rigid_bodies, with ours inserted).
    pub fn of_pair(self, other: Combine) -> Combine {
        if (self as u8) <= (other as u8) { self } else { other }
    }

    /// The pair's value.
    pub fn apply(self, a: Real, b: Real) -> Real {
        match self {
            Combine::Average => 0.5 * (a + b),
            Combine::Minimum => crate::math::min(a, b),
            Combine::Maximum => crate::math::max(a, b),
            Combine::GeometricMean => (a * b).sqrt(),
            Combine::Multiply => a * b,
        }
    }
}

/// What a body is made of.
#[derive(Clone, Debug)]
pub struct BodyDef {
    /// used in error messages only; empty: the body's number
    pub name: String,
    /// the shape, its centre of mass at the origin of its coordinates
    pub shape: Arc<dyn Shape>,
    /// position of the centre of mass \[m\]
    pub position: Vec3,
    /// orientation; normalised when the body is made
    pub orientation: Quat,
    /// velocity of the centre of mass \[m/s\]
    pub velocity: Vec3,
    /// angular velocity \[rad/s\], world axes
    pub angular_velocity: Vec3,
    /// mass
    pub mass: Mass,
    /// inertia tensor about the centre of mass in the body's axes \[kg m2\]; `None`: the homogeneous shape's
    pub inertia: Option<crate::math::Mat3>,
    /// surface
    pub surface: Surface,
}

impl BodyDef {
    /// A body of mass 1 kg at rest at the origin.
    pub fn new(shape: impl Into<Arc<dyn Shape>>) -> BodyDef {
        BodyDef {
            name: String::new(),
            shape: shape.into(),
            position: Vec3::ZERO,
            orientation: Quat::IDENTITY,
            velocity: Vec3::ZERO,
            angular_velocity: Vec3::ZERO,
            mass: Mass::Value(1.0),
            inertia: None,
            surface: Surface::default(),
        }
    }
}

/// An immovable limit of the scene (thesis, section 6.7).
#[derive(Clone, Debug)]
pub struct BoundaryDef {
    /// used in error messages only; empty: the boundary's number
    pub name: String,
    /// half-space, plane, limit quadrangle, or a kind of the user's
    pub shape: Arc<dyn Shape>,
    /// where the shape's origin is placed \[m\]
    pub position: Vec3,
    /// surface
    pub surface: Surface,
}
