//! Contacts of smooth elastic spheres, answered by several threads.
//!
//! Contacts that share no body commute. The storage is cut into parts, and what happens within a part is answered there, part
//! beside part, each in the order of response. What reaches from one part into another, or needs more than a bounce, is left
//! for later, and with it everything that is tied to it through a body, directly or through others: so what is left shares no
//! body with what was answered. Storage is in spatial order, so little is left.

use super::answer::{Bounce, PairSurfaces, bounce};
use crate::contact::{Contact, Other};
use crate::counters::Counters;
use crate::math::Vec3;
use crate::par;
use crate::state::{Line, State};
use crate::step::Recipe;
use rayon::prelude::*;

/// Contacts from which this pays.
const MANY: usize = 512;
/// Parts of the storage at most. More of them leave more contacts between them.
const MOST_PARTS: usize = 8;
/// Bodies in a part at least.
const SMALLEST_PART: usize = 8192;
/// Contacts in a block that is looked at by one thread.
const BLOCK: usize = 512;
/// In place of a slot: a boundary.
const WALL: u32 = u32::MAX;

/// Memory, kept from step to step.
#[derive(Clone, Debug, Default)]
pub struct Parts {
    blocks: Vec<Sorted>,
    parts: Vec<Part>,
    marks: Vec<bool>,
    left: Vec<u32>,
}

/// A contact within a part.
#[derive(Clone, Copy, Debug)]
struct Inner {
    /// its number in the list
    index: u32,
    a: u32,
    b: u32,
    normal: Vec3,
}

/// A block of contacts, sorted by part.
#[derive(Clone, Debug, Default)]
struct Sorted {
    /// contacts within each part
    inner: Vec<Vec<Inner>>,
    /// bodies of each part that have a contact that is left
    touched: Vec<Vec<u32>>,
    /// contacts that are left
    left: Vec<u32>,
}

/// What became of a part.
#[derive(Clone, Debug, Default)]
struct Part {
    left: Vec<u32>,
    counters: Counters,
}

/// Whether parts are of use for these contacts. One thread alone is faster without; the bits are the same.
pub(super) fn is_worth_it(recipe: &Recipe<'_>, state: &State, contacts: &[Contact]) -> bool {
    contacts.len() >= MANY
        && rayon::current_num_threads() > 1
        && state.lines.len() >= 2 * SMALLEST_PART
        && !recipe.record_events
        && recipe.model.all_spheres
        && recipe.law.is_frictionless_at_zero()
}

impl Parts {
    /// Answers what can be answered in parts of the storage. Returns the numbers of the contacts that are left, ascending.
    pub fn answer(
        &mut self,
        recipe: &Recipe<'_>,
        state: &mut State,
        contacts: &[Contact],
        counters: &mut Counters,
    ) -> &[u32] {
        let size = state.lines.len().div_ceil(MOST_PARTS).max(SMALLEST_PART);
        let smooth = || {
            let mut pairs = PairSurfaces::new(recipe.model);
            move |c: &Contact| pairs.of(c).is_smooth_bounce(recipe)
        };
        self.answer_in(size, smooth, &mut state.lines, contacts, counters)
    }

    /// In parts of `size` bodies. What `smooth` makes tells the contacts that are a bounce.
    fn answer_in<F: FnMut(&Contact) -> bool>(
        &mut self,
        size: usize,
        smooth: impl Fn() -> F + Sync,
        lines: &mut [Line],
        contacts: &[Contact],
        counters: &mut Counters,
    ) -> &[u32] {
        let count = lines.len().div_ceil(size);
        let used = par::ranges_into(contacts.len(), BLOCK, &mut self.blocks, |range, block| {
            block.sort(smooth(), range.start, &contacts[range], (size, count));
        });
        let blocks = &self.blocks[..used];
        self.parts.resize_with(count, Part::default);
        self.marks.resize(lines.len(), false);
        let parts = lines.par_chunks_mut(size).zip(self.marks.par_chunks_mut(size)).zip(&mut self.parts);
        parts.enumerate().for_each(|(k, ((lines, marks), part))| part.answer(k, k * size, blocks, lines, marks));
        self.left.clear();
        blocks.iter().for_each(|block| self.left.extend_from_slice(&block.left));
        for part in &self.parts {
            self.left.extend_from_slice(&part.left);
            *counters += part.counters;
        }
        self.left.par_sort_unstable();
        &self.left
    }
}

impl Sorted {
    fn sort(
        &mut self,
        mut smooth: impl FnMut(&Contact) -> bool,
        first: usize,
        contacts: &[Contact],
        (size, count): (usize, usize),
    ) {
        self.inner.resize_with(count, Vec::new);
        self.touched.resize_with(count, Vec::new);
        self.inner.iter_mut().for_each(Vec::clear);
        self.touched.iter_mut().for_each(Vec::clear);
        self.left.clear();
        for (index, c) in contacts.iter().enumerate() {
            let (index, a, part) = ((first + index) as u32, c.a, c.a as usize / size);
            let (b, part_b) = match c.b {
                Other::Body(slot) => (slot, slot as usize / size),
                Other::Wall(_) => (WALL, part),
            };
            if part == part_b && smooth(c) {
                self.inner[part].push(Inner { index, a, b, normal: c.normal });
                continue;
            }
            self.left.push(index);
            self.touched[part].push(a);
            if b != WALL {
                self.touched[part_b].push(b);
            }
        }
    }
}

impl Part {
    /// Answers what happens within part `k`, whose bodies are those from slot `first` on. `marks`: bodies that have a contact
    /// that is left.
    fn answer(&mut self, k: usize, first: usize, blocks: &[Sorted], lines: &mut [Line], marks: &mut [bool]) {
        self.left.clear();
        self.counters = Counters::default();
        marks.fill(false);
        blocks.iter().flat_map(|block| &block.touched[k]).for_each(|&slot| marks[slot as usize - first] = true);
        let inner = || blocks.iter().flat_map(|block| &block.inner[k]);
        let mut spread = marks.contains(&true);
        while spread {
            spread = false;
            for c in inner().filter(|c| c.b != WALL) {
                let (a, b) = (c.a as usize - first, c.b as usize - first);
                if marks[a] != marks[b] {
                    (marks[a], marks[b], spread) = (true, true, true);
                }
            }
        }
        for c in inner() {
            let a = c.a as usize - first;
            if marks[a] {
                self.left.push(c.index);
                continue;
            }
            let b = (c.b != WALL).then(|| c.b as usize - first);
            let Some(Bounce { va, vb, .. }) = bounce(&lines[a], b.map(|b| &lines[b]), c.normal) else { continue };
            lines[a].v = va;
            if let Some(b) = b {
                lines[b].v = vb;
            }
            self.counters.impacts += 1;
            self.counters.wall_impacts += u64::from(b.is_none());
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::Real;
    use proptest::prelude::*;
    use proptest::test_runner::RngSeed;

    const BODIES: u32 = 60;

    /// Contacts of bodies that are mostly near each other in the storage, with a share of boundaries; every ninth body of
    /// infinite mass.
    fn contacts() -> impl Strategy<Value = Vec<Contact>> {
        let one = (0..BODIES, 1..12_u32, 0..5_u8, prop::array::uniform3(-1.0..1.0_f64));
        prop::collection::vec(one, 0..250).prop_map(|list| {
            let contact = |(k, (a, step, wall, n)): (usize, (u32, u32, u8, [f64; 3]))| Contact {
                key: k as u64,
                a,
                b: if wall == 0 { Other::Wall(0) } else { Other::Body((a + step) % BODIES) },
                feature: 0,
                normal: Vec3::from(n).try_normalize().unwrap_or(Vec3::X),
                point: Vec3::ZERO,
                depth: 0.0,
                first_point: 0,
                point_count: 0,
            };
            list.into_iter().enumerate().map(contact).collect()
        })
    }

    fn lines(velocities: &[[f64; 3]]) -> Vec<Line> {
        let line = |(k, v): (usize, &[f64; 3])| Line {
            x: Vec3::ZERO,
            radius: 1.0,
            v: Vec3::from(*v),
            inverse_mass: if k % 9 == 4 { 0.0 } else { 1.0 / (1.0 + k as Real) },
        };
        velocities.iter().enumerate().map(line).collect()
    }

    /// One after the other.
    fn answer_one(lines: &mut [Line], contact: &Contact, counters: &mut Counters) {
        let b = match contact.b {
            Other::Body(slot) => Some(lines[slot as usize]),
            Other::Wall(_) => None,
        };
        let Some(found) = bounce(&lines[contact.a as usize], b.as_ref(), contact.normal) else { return };
        lines[contact.a as usize].v = found.va;
        if let Other::Body(slot) = contact.b {
            lines[slot as usize].v = found.vb;
        }
        counters.impacts += 1;
        counters.wall_impacts += u64::from(b.is_none());
    }

    proptest! {
        #![proptest_config(ProptestConfig {
            cases: 200, rng_seed: RngSeed::Fixed(21), failure_persistence: None, ..ProptestConfig::default()
        })]

        #[test]
        fn parts_of_any_size_give_the_bits_of_one_after_the_other(
            contacts in contacts(),
            velocities in prop::collection::vec(prop::array::uniform3(-1.0..1.0_f64), BODIES as usize),
            size in 1_usize..80,
            rough in 2_u64..40,
        ) {
            let (mut twin, mut counted) = (lines(&velocities), Counters::default());
            contacts.iter().for_each(|c| answer_one(&mut twin, c, &mut counted));
            let mut parts = Parts::default();
            for threads in [1, 2, 3, 8] {
                let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
                let (mut own, mut counters) = (lines(&velocities), Counters::default());
                let smooth = || |c: &Contact| !c.key.is_multiple_of(rough);
                let left = pool.install(|| parts.answer_in(size, smooth, &mut own, &contacts, &mut counters).to_vec());
                prop_assert!(left.is_sorted());
                prop_assert!(contacts.iter().all(|c| !c.key.is_multiple_of(rough) || left.contains(&(c.key as u32))));
                left.iter().for_each(|&k| answer_one(&mut own, &contacts[k as usize], &mut counters));
                prop_assert_eq!(&own, &twin);
                prop_assert_eq!(counters, counted);
            }
        }
    }

    #[test]
    fn one_part_leaves_nothing() {
        let velocities = [[1.0, 0.0, 0.0]; BODIES as usize];
        let normal = |a, b| Contact {
            key: 0,
            a,
            b: Other::Body(b),
            feature: 0,
            normal: Vec3::X,
            point: Vec3::ZERO,
            depth: 0.0,
            first_point: 0,
            point_count: 0,
        };
        let contacts = [normal(0, 1), normal(1, 59), normal(2, 3)];
        let mut parts = Parts::default();
        let mut left = |size| {
            let all_smooth = || |_: &Contact| true;
            parts.answer_in(size, all_smooth, &mut lines(&velocities), &contacts, &mut Counters::default()).to_vec()
        };
        assert!(left(60).is_empty());
        // 1 and 59 are in different parts, and 0 is tied to them by 1.
        assert_eq!(left(30), [0, 1]);
    }
}
