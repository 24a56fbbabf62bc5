//! Every pair: the thesis's `bSphere` method (section 5.3.4), and the slow exact twin of all other broad phases.

use super::{BoundsView, BroadPhase, Candidates};
use crate::bounds::{Ball, BoundaryBounds};
use rayon::prelude::*;

/// Rows of the pair triangle that one task takes. Fixed, so that the order of the output never depends on the threads.
const ROWS: usize = 64;
/// Below this many bodies the loop is over before another thread has woken up.
const SERIAL: usize = 512;

/// Compares every two bodies, and every body with every boundary: for `m` movable bodies and six limits
/// `(11 m + m^2) / 2` bounding-sphere tests.
#[derive(Clone, Copy, Debug, Default)]
pub struct BruteForce;

/// The bodies that take part, close together in memory: the inner loop reads nothing else.
#[derive(Debug, Default)]
struct Present {
    balls: Vec<Ball>,
    slots: Vec<u32>,
    /// bodies before this place are movable, those from here on are fixed
    movable: usize,
}

impl Present {
    fn gather(view: &BoundsView<'_>) -> Present {
        let mut present = Present::default();
        for fixed in [false, true] {
            for (slot, ball) in view.balls.iter().enumerate() {
                if !ball.is_empty() && view.is_fixed(slot as u32) == fixed {
                    present.balls.push(*ball);
                    present.slots.push(slot as u32);
                }
            }
            if !fixed {
                present.movable = present.balls.len();
            }
        }
        present
    }

    /// Rows `from..to` of the triangle of pairs: each movable body with all that are listed after it, then with the
    /// boundaries. Fixed bodies are listed last and have no row: two of them never meet here.
    fn rows(&self, from: usize, to: usize, boundaries: &[BoundaryBounds], out: &mut Candidates) {
        for i in from..to {
            let (ball, slot) = (self.balls[i], self.slots[i]);
            let later = &self.balls[i + 1..];
            for (k, other) in later.iter().enumerate() {
                if ball.meets(other) {
                    out.pairs.push([slot, self.slots[i + 1 + k]]);
                }
            }
            for (k, boundary) in boundaries.iter().enumerate() {
                if boundary.reaches(&ball) {
                    out.walls.push([slot, k as u32]);
                }
            }
            out.sphere_tests += (later.len() + boundaries.len()) as u64;
        }
    }
}

impl BroadPhase for BruteForce {
    fn name(&self) -> String {
        "brute-force".into()
    }

    fn find(&mut self, view: &BoundsView<'_>, out: &mut Candidates) {
        let present = Present::gather(view);
        let movable = present.movable;
        if movable <= SERIAL {
            present.rows(0, movable, view.boundaries, out);
            return;
        }
        let blocks: Vec<Candidates> = (0..movable.div_ceil(ROWS))
            .into_par_iter()
            .map(|block| {
                let mut found = Candidates::default();
                let from = block * ROWS;
                present.rows(from, (from + ROWS).min(movable), view.boundaries, &mut found);
                found
            })
            .collect();
        for block in &blocks {
            out.pairs.extend_from_slice(&block.pairs);
            out.walls.extend_from_slice(&block.walls);
            out.sphere_tests += block.sphere_tests;
        }
    }
}
