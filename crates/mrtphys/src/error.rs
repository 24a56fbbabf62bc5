//! What can go wrong. Every error names the object and the field; a world that answered with an error is bitwise what it
//! was before the call.

use crate::math::Real;

/// An error of the simulator.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum Error {
    /// A value is NaN or infinite.
    #[error("{object}: {field} is not a finite number")]
    NonFinite {
        /// what the value belongs to
        object: String,
        /// which value
        field: &'static str,
    },
    /// A value is outside of what is allowed or meaningful.
    #[error("{object}: {field} = {value} is out of range: {expected}")]
    OutOfRange {
        /// what the value belongs to
        object: String,
        /// which value
        field: &'static str,
        /// the value given
        value: Real,
        /// what is allowed
        expected: &'static str,
    },
    /// The handle was never given out, belongs to another world, or its object is gone.
    #[error("{what} handle is not valid in this world")]
    InvalidHandle {
        /// `body`, `boundary` or `field`
        what: &'static str,
    },
    /// An inertia tensor that no rigid body has.
    #[error("{object}: inertia tensor: {reason}")]
    InvalidInertia {
        /// the body
        object: String,
        /// why
        reason: &'static str,
    },
    /// Fewer points than the shape needs.
    #[error("{object}: {given} points given, at least {needed} are needed")]
    TooFewPoints {
        /// the shape
        object: String,
        /// how many were given
        given: usize,
        /// how many are needed
        needed: usize,
    },
    /// Points that span no volume (or no area).
    #[error("{object}: the points are degenerate: they span {rank} dimension(s)")]
    Degenerate {
        /// the shape
        object: String,
        /// dimension of the space that the points span: 0 coincident, 1 collinear, 2 coplanar
        rank: usize,
    },
    /// A polyhedron's surface is not a closed, oriented surface of one volume.
    #[error("{object}: {reason}{}", .face.map(|f| format!(" (face {f})")).unwrap_or_default())]
    InvalidMesh {
        /// the shape
        object: String,
        /// the face concerned, counted from 0
        face: Option<usize>,
        /// the edge concerned, as two point numbers
        edge: Option<[usize; 2]>,
        /// what is wrong
        reason: String,
    },
    /// A limit of this implementation was passed.
    #[error("{object}: {what}: {given} exceeds the limit of {limit}")]
    LimitExceeded {
        /// the object
        object: String,
        /// what there is too much of
        what: &'static str,
        /// how much there is
        given: u64,
        /// how much is allowed
        limit: u64,
    },
    /// A kind that was not registered before the first body was made.
    #[error("kind '{name}' is not registered in this world")]
    UnknownKind {
        /// the kind's name
        name: String,
    },
    /// A kind that is in the inventory already.
    #[error("kind '{name}' is there already")]
    DuplicateKind {
        /// the kind's name
        name: String,
    },
    /// Two objects overlap where that was not allowed.
    #[error("{a} and {b} overlap by {depth} m at the start")]
    Overlap {
        /// first object
        a: String,
        /// second object
        b: String,
        /// depth of the overlap \[m\]
        depth: Real,
    },
    /// A snapshot that cannot be restored into this world.
    #[error("snapshot: {reason}")]
    Snapshot {
        /// why
        reason: String,
    },
    /// A callback of the user's (a field, a law, a shape) gave a value that is not finite. The step was undone.
    #[error("{object} gave a value that is not finite")]
    Callback {
        /// which callback
        object: String,
    },
}

/// A result of the simulator.
pub type Result<T> = std::result::Result<T, Error>;
