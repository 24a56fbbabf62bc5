//! Any points and faces are a polyhedron whose pieces have its volume, or are refused.
#![no_main]

use libfuzzer_sys::fuzz_target;
use mrtphys::Vec3;
use mrtphys::shape::{Polyhedron, Shape};

fuzz_target!(|data: (Vec<(i8, i8, i8)>, Vec<Vec<u8>>)| {
    let points: Vec<Vec3> = data.0.iter().map(|&(x, y, z)| Vec3::new(x.into(), y.into(), z.into())).collect();
    let faces: Vec<Vec<u32>> = data.1.iter().map(|f| f.iter().map(|&i| i.into()).collect()).collect();
    let Ok(body) = Polyhedron::from_mesh(&points, &faces) else { return };
    let volume = body.mass_properties().expect("a polyhedron has mass properties").volume;
    let pieces: f64 = body.pieces().iter().map(|p| p.volume()).sum();
    assert!((pieces / volume - 1.0).abs() < 1e-9, "{pieces} {volume}");
});
