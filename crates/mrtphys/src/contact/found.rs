//! The contacts of a step as they were found, block by block, and in the order of response as soon as somebody asks for it.

use super::{Contact, ContactList};
use crate::narrow::Touches;
use crate::par;
use rayon::prelude::*;
use std::sync::OnceLock;

/// Contacts from which several threads put them in order.
const MANY: usize = 1024;
/// Contacts in a part of that work.
const PART: usize = 512;

/// Contacts of one block of candidates.
#[derive(Clone, Debug, Default)]
pub struct Block {
    pub(super) contacts: Vec<Contact>,
    pub(super) touches: Touches,
}

impl Block {
    pub(super) fn clear(&mut self) {
        self.contacts.clear();
        self.touches.clear();
    }
}

/// The contacts of a step.
#[derive(Debug, Default)]
pub struct FoundContacts {
    /// blocks of candidate pairs, and how many of them are of this step
    pub(super) pairs: (Vec<Block>, usize),
    /// the same for boundaries
    pub(super) walls: (Vec<Block>, usize),
    ordered: OnceLock<ContactList>,
    /// memory of the order of earlier steps
    spare: ContactList,
    places: Vec<ContactPlace>,
}

/// Where a contact is before they are in order: its key, its block and its place there, from the highest bit down. What is
/// sorted are these few bytes. Contacts of one pair are in one block, so they keep the order in which their routine reported
/// them.
type ContactPlace = u128;

impl FoundContacts {
    /// Must be called when the blocks have changed.
    pub(super) fn renew(&mut self) {
        if let Some(list) = self.ordered.take() {
            self.spare = list;
        }
    }

    /// How many there are.
    pub fn count(&self) -> usize {
        self.blocks().map(<[Contact]>::len).sum()
    }

    /// As they were found, block by block. Blocks do not depend on the number of threads.
    pub fn blocks(&self) -> impl Iterator<Item = &[Contact]> + Clone {
        self.all().map(|block| &block.contacts[..])
    }

    fn all(&self) -> impl Iterator<Item = &Block> + Clone {
        self.pairs.0[..self.pairs.1].iter().chain(&self.walls.0[..self.walls.1])
    }

    /// In the order of response.
    pub fn ordered(&self) -> &ContactList {
        self.ordered.get_or_init(|| {
            let mut list = ContactList::default();
            self.put_in_order(&mut list, &mut Vec::new());
            list
        })
    }

    /// Lends the list in the order of response, which comes back by [`give_back`](FoundContacts::give_back).
    pub fn take_ordered(&mut self) -> ContactList {
        if let Some(list) = self.ordered.take() {
            return list;
        }
        let (mut list, mut places) = (std::mem::take(&mut self.spare), std::mem::take(&mut self.places));
        self.put_in_order(&mut list, &mut places);
        self.places = places;
        list
    }

    /// Takes the list back.
    pub fn give_back(&mut self, list: ContactList) {
        self.ordered = OnceLock::from(list);
    }

    /// Puts the contacts of all blocks together in the order of response.
    fn put_in_order(&self, list: &mut ContactList, places: &mut Vec<ContactPlace>) {
        list.points.clear();
        // Where the points of each block begin.
        let note_points = |block: &Block| {
            let first = list.points.len() as u32;
            list.points.extend_from_slice(&block.touches.points);
            first
        };
        let first_points: Vec<u32> = self.all().map(note_points).collect();
        let (pairs, walls) = (&self.pairs.0, &self.walls.0);
        let count = self.count();
        places.clear();
        places.resize(count, 0);
        let mut rest = &mut places[..];
        let pieces = self.blocks().map(|block| (block, par::cut(&mut rest, block.len())));
        let note = |(k, (block, piece)): (usize, (&[Contact], &mut [ContactPlace]))| {
            for (i, (contact, place)) in block.iter().zip(piece).enumerate() {
                *place = u128::from(contact.key) << 64 | (k as u128) << 32 | i as u128;
            }
        };
        let at = |&place: &ContactPlace| {
            let (k, before) = ((place >> 32) as u32 as usize, self.pairs.1);
            let block = if k < before { &pairs[k] } else { &walls[k - before] };
            let contact = block.contacts[place as u32 as usize];
            Contact { first_point: contact.first_point + first_points[k], ..contact }
        };
        if count < MANY {
            pieces.enumerate().for_each(note);
            places.sort_unstable();
            list.list.clear();
            list.list.extend(places.iter().map(at));
        } else {
            pieces.enumerate().collect::<Vec<_>>().into_par_iter().for_each(note);
            places.par_sort_unstable();
            places.par_iter().with_min_len(PART).map(at).collect_into_vec(&mut list.list);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::contact::Other;
    use crate::math::Vec3;

    /// A contact with this key, and one point of its own.
    fn add(block: &mut Block, key: u64) {
        let first_point = block.touches.points.len() as u32;
        block.touches.points.push(Vec3::splat(key as f64));
        let (a, b) = (0, Other::Wall(0));
        let (normal, point) = (Vec3::X, Vec3::ZERO);
        block.contacts.push(Contact { key, a, b, feature: 0, normal, point, depth: 0.0, first_point, point_count: 1 });
    }

    fn check(list: &ContactList, keys: &[u64]) {
        assert_eq!(list.list.iter().map(|c| c.key).collect::<Vec<_>>(), keys);
        for c in &list.list {
            assert_eq!(list.points[c.first_point as usize], Vec3::splat(c.key as f64), "points go with their contacts");
        }
    }

    #[test]
    fn the_order_is_that_of_the_keys_lent_or_looked_at_and_of_this_step() {
        for many in [1, 2000] {
            let blocks = |count: usize| (vec![Block::default(); count], count);
            let mut found = FoundContacts { pairs: blocks(2), walls: blocks(1), ..FoundContacts::default() };
            for key in (0..many).rev() {
                add(&mut found.pairs.0[0], 3 * key + 2);
                add(&mut found.pairs.0[1], 3 * key);
                add(&mut found.walls.0[0], 3 * key + 1);
            }
            let keys: Vec<u64> = (0..3 * many).collect();
            assert_eq!(found.count(), keys.len());
            check(found.ordered(), &keys);
            let lent = found.take_ordered();
            check(&lent, &keys);
            found.give_back(lent);
            found.walls.1 = 0;
            found.renew();
            let without: Vec<u64> = keys.iter().copied().filter(|k| k % 3 != 1).collect();
            check(&found.take_ordered(), &without);
        }
    }
}
