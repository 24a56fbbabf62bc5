//! Handles to slots. Bodies are stored densely, in any order; a handle's index leads to the slot.

use crate::error::{Error, Result};
use crate::id::BodyId;

/// Marks an index that has no body.
const NONE: u32 = u32::MAX;

#[derive(Clone, Debug, Default)]
pub(super) struct IdTable {
    /// slot of each index, or [`NONE`]
    slot_of: Vec<u32>,
    /// generation of each index
    generation: Vec<u32>,
    /// index of the body in each slot
    index_of: Vec<u32>,
    /// indices without a body, to be used again
    free: Vec<u32>,
}

impl IdTable {
    /// Slot of a handle.
    pub fn slot(&self, id: BodyId, world: u32) -> Result<usize> {
        let i = id.index as usize;
        let valid = id.world == world && self.generation.get(i) == Some(&id.generation) && self.slot_of[i] != NONE;
        if valid { Ok(self.slot_of[i] as usize) } else { Err(Error::InvalidHandle { what: "body" }) }
    }

    /// Handle of the body in a slot.
    pub fn id(&self, slot: usize, world: u32) -> BodyId {
        let index = self.index_of[slot];
        BodyId { index, generation: self.generation[index as usize], world }
    }

    /// A new body in the next slot.
    pub fn push(&mut self, world: u32) -> BodyId {
        let slot = self.index_of.len() as u32;
        let index = self.free.pop().unwrap_or_else(|| {
            self.slot_of.push(NONE);
            self.generation.push(0);
            (self.slot_of.len() - 1) as u32
        });
        self.slot_of[index as usize] = slot;
        self.index_of.push(index);
        BodyId { index, generation: self.generation[index as usize], world }
    }

    /// The body in `slot` goes, the one in the last slot takes its place.
    pub fn swap_remove(&mut self, slot: usize) {
        let index = self.index_of[slot] as usize;
        self.slot_of[index] = NONE;
        // A generation that would wrap round retires its index: a handle stays unique for ever.
        if self.generation[index] < u32::MAX {
            self.generation[index] += 1;
            self.free.push(index as u32);
        }
        self.index_of.swap_remove(slot);
        if let Some(&moved) = self.index_of.get(slot) {
            self.slot_of[moved as usize] = slot as u32;
        }
        if self.index_of.is_empty() {
            self.index_of.shrink_to_fit();
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_handle_stays_unique_for_ever() {
        let mut t = IdTable::default();
        let ids: Vec<_> = (0..5).map(|_| t.push(7)).collect();
        t.swap_remove(t.slot(ids[1], 7).unwrap());
        assert!(t.slot(ids[1], 7).is_err());
        assert!(t.slot(ids[0], 8).is_err());
        let again = t.push(7);
        assert_eq!(again.index, ids[1].index);
        assert!(t.slot(ids[1], 7).is_err());
        assert_eq!(t.slot(ids[4], 7), Ok(1), "the last slot's body moves into the gap");
        assert!(t.slot(BodyId::from_parts(u32::MAX, 0, 7), 7).is_err());
    }
}
