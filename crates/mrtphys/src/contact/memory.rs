//! Which pairs were in contact in the last step, where the friction law asks for it (the thesis's law answers a persistent
//! contact without friction, so that corners don't leak).

use super::Contact;

/// Keys of the pairs that were in contact, ascending.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ContactMemory {
    keys: Vec<u64>,
}

impl ContactMemory {
    /// Whether the pair was in contact in the last step.
    pub fn holds(&self, key: u64) -> bool {
        self.keys.binary_search(&key).is_ok()
    }

    /// Remembers the pairs of these contacts, which are in order of their keys.
    pub fn remember(&mut self, contacts: &[Contact]) {
        self.keys.clear();
        self.keys.extend(contacts.iter().map(|c| c.key));
        self.keys.dedup();
    }

    /// Forgets every pair of a body.
    pub fn forget(&mut self, serial: u32) {
        self.keys.retain(|&key| {
            let (high, low) = (((key >> 32) & 0x7fff_ffff) as u32, (key & 0x7fff_ffff) as u32);
            high != serial && low != serial
        });
    }

    /// The keys, ascending.
    pub fn keys(&self) -> &[u64] {
        &self.keys
    }

    /// From keys as [`keys`](ContactMemory::keys) gave them.
    pub fn from_keys(keys: Vec<u64>) -> ContactMemory {
        ContactMemory { keys }
    }
}
