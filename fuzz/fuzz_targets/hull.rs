//! Any points have a hull that holds them all, or are refused.
#![no_main]

use libfuzzer_sys::fuzz_target;
use mrtphys::Vec3;
use mrtphys::shape::{Polyhedron, Shape};

fuzz_target!(|data: Vec<(f64, f64, f64)>| {
    let points: Vec<Vec3> = data.iter().map(|&(x, y, z)| Vec3::new(x, y, z)).collect();
    let Ok(hull) = Polyhedron::convex_hull(&points) else { return };
    let shift = hull.author_origin();
    let size = points.iter().fold(0.0_f64, |m, p| m.max((*p + shift).max_abs()));
    for face in hull.faces() {
        for p in &points {
            let beyond = face.normal.dot(*p + shift) - face.offset;
            assert!(beyond <= 1e-9 * size, "a point is {beyond} outside of {size}");
        }
    }
    assert!(hull.mass_properties().is_some_and(|m| m.volume > 0.0));
});
