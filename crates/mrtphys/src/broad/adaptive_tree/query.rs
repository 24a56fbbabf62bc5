//! The comparisons (section 6.4.2, the three `detectAndResponse`).

use super::super::{BoundsView, Candidates};
use super::AdaptiveTree;

impl AdaptiveTree {
    /// Compares every object with those listed after it in its own node, and with those in the branches below whose cell
    /// meets the object's box. A pair in the same branch is met once, at the upper object's turn; what lies in two branches
    /// side by side does not meet.
    pub(super) fn compare(&self, view: &BoundsView<'_>, out: &mut Candidates) {
        let mut branches = Vec::new();
        for (n, _) in self.walk() {
            let node = &self.arena.nodes[n as usize];
            for a in self.arena.listed(n) {
                let still = self.scene.is_immovable(view, a);
                let compare = |b: u32, out: &mut Candidates| {
                    if !(still && self.scene.is_immovable(view, b)) {
                        self.scene.test(view, a, b, out);
                    }
                };
                self.arena.from(self.arena.next(a)).for_each(|b| compare(b, out));
                if node.is_leaf() {
                    continue;
                }
                branches.extend([node.child, node.child + 1]);
                while let Some(m) = branches.pop() {
                    let below = &self.arena.nodes[m as usize];
                    if !below.cell.meets(&self.spans[a as usize]) {
                        continue;
                    }
                    self.arena.listed(m).for_each(|b| compare(b, out));
                    if !below.is_leaf() {
                        branches.extend([below.child, below.child + 1]);
                    }
                }
            }
        }
    }
}
