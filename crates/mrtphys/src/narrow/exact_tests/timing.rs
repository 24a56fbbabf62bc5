//! How long a pair takes. Printed, never judged: `cargo test -p mrtphys --lib timing -- --nocapture`.

use super::bodies::*;
use crate::math::{Real, Vec3};
use crate::narrow::Touches;
use crate::narrow::pairs::polyhedron_polyhedron;
use std::time::Instant;

#[test]
fn candidate_pairs_of_tetrahedra() {
    let mut dice = Dice::new(31);
    let s = 0.5;
    let shape = hull(&[(s, s, s), (s, -s, -s), (-s, s, -s), (-s, -s, s)].map(|(x, y, z)| Vec3::new(x, y, z)));
    let poses: Vec<_> = (0..4000)
        .map(|_| {
            let distance = libm::cbrt(dice.unit()) * 2.0 * shape.ball.radius;
            (dice.direction() * distance, dice.rotation(), dice.rotation())
        })
        .collect();
    for (name, meets) in [("separate", false), ("overlapping", true)] {
        let chosen: Vec<_> = poses
            .iter()
            .filter(|(at, ra, rb)| {
                let t =
                    contacts(polyhedron_polyhedron::touch, &placed(&shape, Vec3::ZERO, ra), &placed(&shape, *at, rb));
                t.list.is_empty() != meets
            })
            .collect();
        let pairs: Vec<_> =
            chosen.iter().map(|(at, ra, rb)| (placed(&shape, Vec3::ZERO, ra), placed(&shape, *at, rb))).collect();
        let mut out = Touches::default();
        let mut best = Real::INFINITY;
        for _ in 0..5 {
            let start = Instant::now();
            for (a, b) in &pairs {
                out.clear();
                polyhedron_polyhedron::touch(a, b, &mut out);
            }
            best = best.min(start.elapsed().as_secs_f64() / pairs.len() as Real);
        }
        println!("{} {name} pairs of tetrahedra: {:.0} ns each", pairs.len(), best * 1e9);
        assert!(!pairs.is_empty());
    }
}
