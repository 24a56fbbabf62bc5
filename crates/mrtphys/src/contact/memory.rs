//! Which pairs were in contact in the last step, where the friction law asks for it (the thesis's law answers a persistent
//! contact without friction, so that corners don't leak).

use super::Contact;
use crate::def::ContactMode;
use std::sync::OnceLock;

/// Marks the keys of boundaries, which come after the pairs.
const WALLS_LAST: u64 = 1 << 63;
/// Marks the keys of pairs, which come after the boundaries of the first body in the thesis's order.
const PAIRS_LAST: u64 = 1 << 31;

/// Sorts the contact of two bodies, the one created first before the other, into the order of response.
#[inline]
pub fn pair_key(low: u32, high: u32, mode: ContactMode) -> u64 {
    let key = (u64::from(low) << 32) | u64::from(high);
    if mode == ContactMode::Thesis { key | PAIRS_LAST } else { key }
}

/// Sorts the contact of a body and a boundary into the order of response.
#[inline]
pub fn wall_key(serial: u32, wall: u32, mode: ContactMode) -> u64 {
    let key = (u64::from(serial) << 32) | u64::from(wall);
    if mode == ContactMode::Thesis { key } else { key | WALLS_LAST }
}

/// Creation numbers of the bodies of a contact.
fn parties(key: u64, mode: ContactMode) -> [Option<u32>; 2] {
    let of_pair = match mode {
        ContactMode::Thesis => key & PAIRS_LAST != 0,
        ContactMode::Exact => key & WALLS_LAST == 0,
    };
    let number = |part: u64| (part & 0x7fff_ffff) as u32;
    [Some(number(key >> 32)), of_pair.then(|| number(key))]
}

/// Keys of the pairs that were in contact. They are put in order when somebody asks: where nothing rubs nobody does.
#[derive(Clone, Debug, Default)]
pub struct ContactMemory {
    /// as they were found
    found: Vec<u64>,
    /// in order, each once
    keys: OnceLock<Vec<u64>>,
}

impl PartialEq for ContactMemory {
    fn eq(&self, o: &ContactMemory) -> bool {
        self.keys() == o.keys()
    }
}

impl ContactMemory {
    /// Whether the pair was in contact in the last step.
    pub fn holds(&self, key: u64) -> bool {
        self.keys().binary_search(&key).is_ok()
    }

    /// Remembers the pairs of these contacts, in any order.
    pub fn remember<'a>(&mut self, contacts: impl Iterator<Item = &'a Contact>) {
        self.keys.take();
        self.found.clear();
        self.found.extend(contacts.map(|c| c.key));
    }

    /// Forgets every pair of a body.
    pub fn forget(&mut self, serial: u32, mode: ContactMode) {
        self.keys.take();
        self.found.retain(|&key| parties(key, mode).into_iter().all(|party| party != Some(serial)));
    }

    /// The keys, ascending.
    pub fn keys(&self) -> &[u64] {
        self.keys.get_or_init(|| {
            let mut keys = self.found.clone();
            keys.sort_unstable();
            keys.dedup();
            keys
        })
    }

    /// From keys as [`keys`](ContactMemory::keys) gave them.
    pub fn from_keys(keys: Vec<u64>) -> ContactMemory {
        ContactMemory { found: keys, keys: OnceLock::new() }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::contact::Other;
    use crate::math::Vec3;

    fn contact(key: u64) -> Contact {
        let (a, b) = (0, Other::Wall(0));
        Contact {
            key,
            a,
            b,
            feature: 0,
            normal: Vec3::X,
            point: Vec3::ZERO,
            depth: 0.0,
            first_point: 0,
            point_count: 0,
        }
    }

    #[test]
    fn keys_are_ascending_whatever_the_order_was() {
        let mode = ContactMode::Exact;
        let [a, b, c] = [pair_key(1, 2, mode), pair_key(1, 7, mode), pair_key(3, 4, mode)];
        let mut memory = ContactMemory::default();
        memory.remember([c, a, b, a].map(contact).iter());
        assert_eq!(memory.keys(), [a, b, c]);
        assert!(memory.holds(b) && !memory.holds(pair_key(2, 7, mode)));
        assert_eq!(memory, ContactMemory::from_keys(vec![a, b, c]));
        memory.forget(7, mode);
        assert_eq!(memory.keys(), [a, c]);
        memory.remember([b].map(contact).iter());
        assert_eq!(memory.keys(), [b], "what was asked for before is forgotten");
    }
}
