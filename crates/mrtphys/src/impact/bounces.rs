//! Contacts of a world in which everything is a smooth elastic sphere or a boundary: the gas, answered where it is found.
//!
//! Contacts that share no body commute. Most share none: those are answered in the order in which they were found, which is that
//! of the storage, so that their bodies are at hand in the caches. The others are tangled, and answered in the order of response.
//!
//! With several threads the storage is cut into parts, and what happens within a part is answered there, part beside part. What
//! reaches from one part into another is left for later, and with it everything that is tied to it through a body, directly or
//! through others: so what is left shares no body with what was answered. Storage is in spatial order, so little is left.

use super::answer::{Bounce, bounce};
use crate::cache::prefetch;
use crate::contact::{Contact, Other};
use crate::counters::Counters;
use crate::def::ImpactMode;
use crate::math::Vec3;
use crate::state::Line;
use crate::step::Recipe;
use rayon::prelude::*;

/// Bodies in a part of the storage at least.
const SMALLEST_PART: usize = 8192;
/// Parts of the storage at most. More of them leave more contacts between them.
const MOST_PARTS: usize = 8;
/// Contacts by which bodies are asked for ahead.
const AHEAD: usize = 8;
/// In place of a slot: a boundary.
const WALL: u32 = u32::MAX;
/// In place of the number of a body's contacts: it is tied to what is left.
const TIED: u8 = u8::MAX;

/// Memory, kept from step to step.
#[derive(Clone, Debug, Default)]
pub struct Bounces {
    blocks: Vec<Dealt>,
    parts: Vec<Part>,
    /// contacts of each body, as far as one, two or more are to be told apart
    degrees: Vec<u8>,
    left: Vec<Touching>,
}

/// A contact, as much of it as a bounce needs.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Touching {
    key: u64,
    a: u32,
    b: u32,
    normal: Vec3,
}

impl Touching {
    fn of(contact: &Contact) -> Touching {
        let b = match contact.b {
            Other::Body(slot) => slot,
            Other::Wall(_) => WALL,
        };
        Touching { key: contact.key, a: contact.a, b, normal: contact.normal }
    }
}

/// A block of contacts, dealt out to the parts.
#[derive(Clone, Debug, Default)]
struct Dealt {
    /// contacts within each part
    inner: Vec<Vec<Touching>>,
    /// bodies of each part that touch one of another
    reaching: Vec<Vec<u32>>,
    /// contacts between parts
    between: Vec<Touching>,
}

/// What became of a part.
#[derive(Clone, Debug, Default)]
struct Part {
    tangled: Vec<Touching>,
    left: Vec<Touching>,
    counters: Counters,
}

/// Whether every contact that this step can find is a smooth elastic bounce, and nobody asks in which order they are.
pub(crate) fn is_all(recipe: &Recipe<'_>) -> bool {
    let model = recipe.model;
    model.all_spheres
        && model.all_smooth
        && model.settings.impact == ImpactMode::Sequential
        && recipe.law.is_frictionless_at_zero()
        && !recipe.record_events
        && model.boundaries.iter().all(|b| b.surface.friction == 0.0 && b.surface.restitution == 1.0)
}

impl Bounces {
    /// Answers all contacts.
    pub(super) fn answer<'a>(
        &mut self,
        lines: &mut [Line],
        blocks: impl Iterator<Item = &'a [Contact]> + Clone,
        counters: &mut Counters,
    ) {
        let alone = rayon::current_num_threads() == 1 || lines.len() < 2 * SMALLEST_PART;
        let parts = if alone { 1 } else { MOST_PARTS.min(lines.len() / SMALLEST_PART) };
        self.answer_in(lines.len().div_ceil(parts).max(1), lines, blocks, counters);
    }

    /// Answers all contacts, in parts of `size` bodies.
    fn answer_in<'a>(
        &mut self,
        size: usize,
        lines: &mut [Line],
        blocks: impl Iterator<Item = &'a [Contact]> + Clone,
        counters: &mut Counters,
    ) {
        self.degrees.resize(lines.len(), 0);
        if lines.len() <= size {
            self.parts.resize_with(1, Part::default);
            let all = blocks.map(|block| block.iter().map(Touching::of));
            self.parts[0].answer(0, all, &[], lines, &mut self.degrees);
        } else {
            self.answer_parts(size, lines, &blocks.collect::<Vec<_>>());
        }
        self.left.clear();
        self.blocks.iter_mut().for_each(|block| self.left.append(&mut block.between));
        for part in &mut self.parts {
            self.left.append(&mut part.left);
            *counters += part.counters;
        }
        self.left.sort_unstable_by_key(|c| c.key);
        self.left.iter().for_each(|c| answer_one(c, 0, lines, counters));
    }

    fn answer_parts(&mut self, size: usize, lines: &mut [Line], blocks: &[&[Contact]]) {
        let count = lines.len().div_ceil(size);
        self.blocks.resize_with(blocks.len(), Dealt::default);
        self.blocks.par_iter_mut().zip(blocks).for_each(|(dealt, block)| dealt.deal(block, size, count));
        self.parts.resize_with(count, Part::default);
        let dealt = &self.blocks;
        let parts = lines.par_chunks_mut(size).zip(self.degrees.par_chunks_mut(size)).zip(&mut self.parts);
        parts.enumerate().for_each(|(k, ((lines, degrees), part))| {
            let inner = dealt.iter().map(|block| block.inner[k].iter().copied());
            let reaching: Vec<&[u32]> = dealt.iter().map(|block| &block.reaching[k][..]).collect();
            part.answer(k * size, inner, &reaching, lines, degrees);
        });
    }
}

impl Dealt {
    fn deal(&mut self, contacts: &[Contact], size: usize, count: usize) {
        self.inner.resize_with(count, Vec::new);
        self.reaching.resize_with(count, Vec::new);
        self.inner.iter_mut().for_each(Vec::clear);
        self.reaching.iter_mut().for_each(Vec::clear);
        self.between.clear();
        for c in contacts.iter().map(Touching::of) {
            let part = c.a as usize / size;
            let other = if c.b == WALL { part } else { c.b as usize / size };
            if part == other {
                self.inner[part].push(c);
                continue;
            }
            self.between.push(c);
            self.reaching[part].push(c.a);
            self.reaching[other].push(c.b);
        }
    }
}

impl Part {
    /// Answers what happens within a part, whose bodies are those from slot `first` on. `reaching`: bodies that touch one of
    /// another part.
    fn answer(
        &mut self,
        first: usize,
        blocks: impl Iterator<Item = impl Iterator<Item = Touching> + Clone> + Clone,
        reaching: &[&[u32]],
        lines: &mut [Line],
        degrees: &mut [u8],
    ) {
        self.left.clear();
        self.tangled.clear();
        self.counters = Counters::default();
        degrees.fill(0);
        let mut count = |slot: u32| {
            let degree = &mut degrees[slot as usize - first];
            *degree = (*degree + 1).min(2);
        };
        for c in blocks.clone().flatten() {
            count(c.a);
            if c.b != WALL {
                count(c.b);
            }
        }
        reaching.iter().copied().flatten().for_each(|&slot| degrees[slot as usize - first] = TIED);
        for block in blocks {
            let mut ahead = block.clone().skip(AHEAD);
            for c in block {
                if let Some(next) = ahead.next() {
                    prefetch(&lines[next.a as usize - first]);
                    if next.b != WALL {
                        prefetch(&lines[next.b as usize - first]);
                    }
                }
                let alone = |slot: u32| degrees[slot as usize - first] == 1;
                if alone(c.a) && (c.b == WALL || alone(c.b)) {
                    answer_one(&c, first, lines, &mut self.counters);
                } else {
                    self.tangled.push(c);
                }
            }
        }
        self.untangle(first, lines, degrees, !reaching.is_empty());
    }

    /// Answers, in their order, those that are tangled among themselves.
    fn untangle(&mut self, first: usize, lines: &mut [Line], degrees: &mut [u8], mut spread: bool) {
        self.tangled.sort_unstable_by_key(|c| c.key);
        while spread {
            spread = false;
            for c in self.tangled.iter().filter(|c| c.b != WALL) {
                let (a, b) = (c.a as usize - first, c.b as usize - first);
                if (degrees[a] == TIED) != (degrees[b] == TIED) {
                    (degrees[a], degrees[b], spread) = (TIED, TIED, true);
                }
            }
        }
        for c in &self.tangled {
            if degrees[c.a as usize - first] == TIED {
                self.left.push(*c);
            } else {
                answer_one(c, first, lines, &mut self.counters);
            }
        }
    }
}

/// Answers a contact of bodies whose lines are those from slot `first` on.
#[inline]
fn answer_one(c: &Touching, first: usize, lines: &mut [Line], counters: &mut Counters) {
    let a = c.a as usize - first;
    let b = (c.b != WALL).then(|| c.b as usize - first);
    let Some(Bounce { va, vb, .. }) = bounce(&lines[a], b.map(|b| &lines[b]), c.normal) else { return };
    lines[a].v = va;
    if let Some(b) = b {
        lines[b].v = vb;
    }
    counters.impacts += 1;
    counters.wall_impacts += u64::from(b.is_none());
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::Real;
    use proptest::prelude::*;
    use proptest::test_runner::RngSeed;

    const BODIES: u32 = 60;

    fn contact(key: u64, a: u32, b: Other, normal: Vec3) -> Contact {
        Contact { key, a, b, feature: 0, normal, point: Vec3::ZERO, depth: 0.0, first_point: 0, point_count: 0 }
    }

    /// Contacts of bodies that are mostly near each other in the storage, with a share of boundaries, in the order of response.
    /// From few to so many that all bodies hang together.
    fn contacts() -> impl Strategy<Value = Vec<Contact>> {
        let one = (0..BODIES, 1..12_u32, 0..5_u8, prop::array::uniform3(-1.0..1.0_f64));
        prop::collection::vec(one, 0..150).prop_map(|list| {
            let contact = |(k, (a, step, wall, n)): (usize, (u32, u32, u8, [f64; 3]))| {
                let b = if wall == 0 { Other::Wall(0) } else { Other::Body((a + step) % BODIES) };
                contact(k as u64, a, b, Vec3::from(n).try_normalize().unwrap_or(Vec3::X))
            };
            list.into_iter().enumerate().map(contact).collect()
        })
    }

    /// Every ninth body of infinite mass.
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
    fn in_order(lines: &mut [Line], contacts: &[Contact]) -> Counters {
        let mut counters = Counters::default();
        for contact in contacts {
            let b = match contact.b {
                Other::Body(slot) => Some(lines[slot as usize]),
                Other::Wall(_) => None,
            };
            let Some(found) = bounce(&lines[contact.a as usize], b.as_ref(), contact.normal) else { continue };
            lines[contact.a as usize].v = found.va;
            if let Other::Body(slot) = contact.b {
                lines[slot as usize].v = found.vb;
            }
            counters.impacts += 1;
            counters.wall_impacts += u64::from(b.is_none());
        }
        counters
    }

    proptest! {
        #![proptest_config(ProptestConfig {
            cases: 200, rng_seed: RngSeed::Fixed(21), failure_persistence: None, ..ProptestConfig::default()
        })]

        #[test]
        fn found_in_any_order_and_cut_anyhow_they_give_the_bits_of_one_after_the_other(
            contacts in contacts(),
            velocities in prop::collection::vec(prop::array::uniform3(-1.0..1.0_f64), BODIES as usize),
            size in 1_usize..80,
            block in 1_usize..40,
            turn in 0_usize..150,
        ) {
            let mut twin = lines(&velocities);
            let counted = in_order(&mut twin, &contacts);
            let mut found = contacts.clone();
            found.sort_by_key(|c| (c.a, c.key.wrapping_mul(0x9e37_79b9_7f4a_7c15)));
            found.rotate_left(turn.min(contacts.len()));
            let mut bounces = Bounces::default();
            for threads in [1, 2, 3, 8] {
                let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
                let (mut own, mut counters) = (lines(&velocities), Counters::default());
                pool.install(|| bounces.answer_in(size, &mut own, found.chunks(block), &mut counters));
                prop_assert_eq!(&own, &twin);
                prop_assert_eq!(counters, counted);
            }
        }
    }

    #[test]
    fn what_is_tied_to_another_part_waits() {
        let contacts = [(0, 1), (1, 59), (2, 3)].map(|(a, b)| contact(u64::from(a), a, Other::Body(b), Vec3::X));
        let mut lines = lines(&[[1.0, 0.0, 0.0]; BODIES as usize]);
        let mut bounces = Bounces::default();
        let mut left = |size| {
            bounces.answer_in(size, &mut lines, contacts.chunks(2), &mut Counters::default());
            bounces.left.iter().map(|c| c.key).collect::<Vec<_>>()
        };
        assert!(left(60).is_empty());
        // 1 and 59 are in different parts, and 0 is tied to them by 1.
        assert_eq!(left(30), [0, 1]);
    }
}
