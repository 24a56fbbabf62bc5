//! Any bytes are refused as a snapshot, and the world is what it was.
#![no_main]

use libfuzzer_sys::fuzz_target;
use mrtphys::shape::Sphere;
use mrtphys::{BodyDef, Settings, Surface, Vec3, World};

fuzz_target!(|data: (usize, Vec<u8>)| {
    let (place, bytes) = data;
    let mut world = World::new(Settings::default()).expect("settings");
    world.add_box("box", Vec3::ZERO, Vec3::splat(1.0), Surface::default()).expect("box");
    let ball = BodyDef { position: Vec3::splat(0.5), velocity: Vec3::X, ..BodyDef::new(Sphere::new(0.1).expect("ball")) };
    world.add_body(ball).expect("body");
    world.step().expect("step");
    let hash = world.state_hash();
    // A good snapshot with a piece of it overwritten reaches further than noise does.
    let mut snapshot = world.snapshot();
    let place = place % snapshot.len();
    let end = (place + bytes.len()).min(snapshot.len());
    let changed = snapshot[place..end] != bytes[..end - place];
    snapshot[place..end].copy_from_slice(&bytes[..end - place]);
    let restored = world.restore(&snapshot);
    assert_eq!(restored.is_err(), changed);
    assert_eq!(world.state_hash(), hash);
});
