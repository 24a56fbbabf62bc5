//! Digests: short fingerprints of long data, the same on every machine. Not for secrets.

use crate::def::Surface;
use crate::field::{Reach, Scope};
use crate::math::{Mat3, Quat, Real, Vec3};
use crate::model::Model;
use crate::state::State;

/// A running 128-bit digest: two lanes of multiply, xor and rotate over 64-bit words, finished with an avalanche.
#[derive(Clone, Debug)]
pub struct Digest {
    lanes: [u64; 2],
    words: u64,
}

/// Odd constants: the fractional digits of the golden ratio and of the square roots of 2 and 3.
const MULTIPLIERS: [u64; 2] = [0x9e37_79b9_7f4a_7c15, 0x6a09_e667_f3bc_c909];
const SEEDS: [u64; 2] = [0xbb67_ae85_84ca_a73b, 0x3c6e_f372_fe94_f82b];

impl Default for Digest {
    fn default() -> Digest {
        Digest { lanes: SEEDS, words: 0 }
    }
}

impl Digest {
    /// Takes in a word.
    pub fn word(&mut self, w: u64) {
        for (lane, m) in self.lanes.iter_mut().zip(MULTIPLIERS) {
            *lane = (*lane ^ w).wrapping_mul(m).rotate_left(29);
            *lane ^= *lane >> 32;
        }
        self.lanes[1] = self.lanes[1].wrapping_add(self.lanes[0]);
        self.words += 1;
    }

    /// Takes in a number; both zeros are one.
    pub fn real(&mut self, x: Real) {
        self.word((x + 0.0).to_bits());
    }

    /// Takes in a vector.
    pub fn vector(&mut self, v: Vec3) {
        v.to_array().into_iter().for_each(|x| self.real(x));
    }

    /// Takes in an orientation; a quaternion and its opposite are one.
    pub fn orientation(&mut self, q: Quat) {
        let leading = [q.w, q.x, q.y, q.z].into_iter().find(|&c| c != 0.0).unwrap_or(0.0);
        let sign = if leading < 0.0 { -1.0 } else { 1.0 };
        [q.x, q.y, q.z, q.w].into_iter().for_each(|c| self.real(c * sign));
    }

    /// Takes in bytes, with their number.
    pub fn bytes(&mut self, bytes: &[u8]) {
        self.word(bytes.len() as u64);
        for chunk in bytes.chunks(8) {
            let mut word = [0; 8];
            word[..chunk.len()].copy_from_slice(chunk);
            self.word(u64::from_le_bytes(word));
        }
    }

    /// The digest.
    pub fn finish(&self) -> u128 {
        let mut copy = self.clone();
        for i in 0..4 {
            copy.word(self.words ^ i);
        }
        (u128::from(copy.lanes[0]) << 64) | u128::from(copy.lanes[1])
    }
}

/// Digest of what the future depends on.
pub(crate) fn state_hash(model: &Model, state: &State, order: &[u32]) -> String {
    let mut d = Digest::default();
    d.real(state.clock.time());
    d.word(state.clock.steps);
    d.word(order.len() as u64);
    for &slot in order {
        let (line, spin) = (&state.lines[slot as usize], &state.spins[slot as usize]);
        d.word(u64::from(model.serial[slot as usize]));
        d.vector(line.x);
        d.vector(line.v);
        d.orientation(spin.q);
        d.vector(spin.l);
        d.word(u64::from(line.radius < 0.0));
    }
    state.contacts.keys().iter().for_each(|&k| d.word(k));
    for e in state.let_back.entries() {
        let words = [u64::from(e.boundary), u64::from(e.serial), e.side as u64, u64::from(e.crossed)];
        words.into_iter().for_each(|w| d.word(w));
    }
    format!("{:032x}", d.finish())
}

/// Digest of what a snapshot must find again: the bodies, boundaries and fields it was taken with. Settings that may change
/// between steps are not part of it.
pub(crate) fn model_fingerprint(model: &Model, order: &[u32]) -> u128 {
    let mut d = Digest::default();
    // The keys in the memory of contacts have another order in each mode.
    d.bytes(model.settings.contact.name().as_bytes());
    d.word(order.len() as u64);
    for &slot in order {
        let body = model.body(slot as usize);
        d.word(u64::from(model.serial[slot as usize]));
        d.real(body.mass);
        d.vector(body.inertia.moments);
        d.orientation(body.inertia.axes);
        d.real(body.volume);
        d.vector(body.ball.center);
        d.real(body.ball.radius);
        surface(&mut d, &body.surface);
        d.word(u64::from(body.kind.0));
        let placed = body.shape.bounding_box(Vec3::ZERO, &Mat3::IDENTITY);
        d.vector(placed.min);
        d.vector(placed.max);
    }
    d.word(model.boundaries.len() as u64);
    for (boundary, bounds) in model.boundaries.iter().zip(&model.wall_bounds) {
        d.word(u64::from(boundary.kind.0));
        d.vector(boundary.position);
        surface(&mut d, &boundary.surface);
        d.bytes(format!("{:?}", boundary.shape).as_bytes());
        if let Some((normal, offset)) = bounds.behind {
            d.vector(normal);
            d.real(offset);
        }
    }
    d.word(model.forces.len() as u64);
    for f in &model.forces {
        d.bytes(format!("{:?}", f.field).as_bytes());
        scope(&mut d, model, &f.scope, &f.reach);
    }
    d.word(model.flows.len() as u64);
    for f in &model.flows {
        d.bytes(format!("{:?}", f.field).as_bytes());
        scope(&mut d, model, &f.scope, &f.reach);
    }
    d.finish()
}

fn surface(d: &mut Digest, s: &Surface) {
    d.real(s.friction);
    d.real(s.restitution);
    d.bytes(format!("{:?}{:?}", s.friction_combine, s.restitution_combine).as_bytes());
}

/// Whom a field acts on, and what carries it, by creation numbers.
fn scope(d: &mut Digest, model: &Model, scope: &Scope, reach: &Reach) {
    d.word(u64::from(scope.without_reaction) | (u64::from(reach.gone) << 1));
    let serial = |slot: usize| u64::from(model.serial[slot]);
    d.word(reach.carrier.map_or(u64::MAX, |slot| serial(slot as usize)));
    let Some(only) = &reach.only else { return };
    let mut serials: Vec<u64> = (0..only.len()).filter(|&slot| only[slot]).map(serial).collect();
    serials.sort_unstable();
    d.word(serials.len() as u64);
    serials.into_iter().for_each(|s| d.word(s));
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_bit_counts_and_zero_has_one_sign() {
        let of = |f: &dyn Fn(&mut Digest)| {
            let mut d = Digest::default();
            f(&mut d);
            d.finish()
        };
        assert_ne!(of(&|d| d.real(1.0)), of(&|d| d.real(1.0 + Real::EPSILON)));
        assert_ne!(of(&|d| d.word(0)), of(&|_| ()));
        assert_eq!(of(&|d| d.real(0.0)), of(&|d| d.real(-0.0)));
        let q = Quat::new(0.1, 0.2, 0.3, -0.9);
        let o = Quat::new(-0.1, -0.2, -0.3, 0.9);
        assert_eq!(of(&|d| d.orientation(q)), of(&|d| d.orientation(o)));
        let mut seen: Vec<u128> = (0..64).map(|bit| of(&|d| d.word(1 << bit))).collect();
        seen.sort_unstable();
        seen.dedup();
        assert_eq!(seen.len(), 64);
    }
}
