//! Handles. A handle names one thing of one world for ever: indices are reused with a new generation, and a handle of
//! another world is recognised, so a stale, foreign or invented handle is an error and never somebody else's body.

/// Handle of a body.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct BodyId {
    pub(crate) index: u32,
    pub(crate) generation: u32,
    pub(crate) world: u32,
}

/// Handle of a boundary.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct BoundaryId {
    pub(crate) index: u32,
    pub(crate) world: u32,
}

/// Handle of a force field or a flow field.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct FieldId {
    pub(crate) index: u32,
    pub(crate) flow: bool,
    pub(crate) world: u32,
}

impl BodyId {
    /// A handle made of raw parts, as a foreign-language binding would make one. It is valid only if a world handed out
    /// these very parts; anything else is answered with [`Error::InvalidHandle`](crate::Error::InvalidHandle).
    pub const fn from_parts(index: u32, generation: u32, world: u32) -> BodyId {
        BodyId { index, generation, world }
    }

    /// Index, generation and world number.
    pub const fn to_parts(self) -> (u32, u32, u32) {
        (self.index, self.generation, self.world)
    }
}
