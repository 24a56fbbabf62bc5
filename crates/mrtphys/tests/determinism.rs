//! The same bits under every broad phase, thread count and scale, in the mirror, without scratch, and after a snapshot.

mod support;

use mrtphys::field::{EarthGravity, Scope, UniformField};
use mrtphys::{BroadPhaseKind, Error, FrictionLaw, ImpactMode, Settings, Vec3, World};
use std::sync::Arc;
use support::{KINDS, Kind, gas};

const BROAD_PHASES: [BroadPhaseKind; 5] = [
    BroadPhaseKind::BruteForce,
    BroadPhaseKind::RegularGrid { resolution: None },
    BroadPhaseKind::RegularGrid { resolution: Some(3) },
    BroadPhaseKind::AdaptiveTree { objects_per_cell: 4, max_depth: 16 },
    BroadPhaseKind::SortedGrid,
];

fn settings() -> Settings {
    Settings { fps: 64, steps_per_frame: 8, ..Settings::default() }
}

fn run(world: &mut World, steps: usize) {
    (0..steps).for_each(|_| world.step().unwrap());
}

fn with_gravity(mut world: World, scale: f64) -> World {
    let g = UniformField::new(Vec3::new(0.0, -9.75 * scale, 0.0)).unwrap();
    world.add_force(Arc::new(g), Scope::default()).unwrap();
    world
}

#[test]
fn every_broad_phase_gives_the_same_trajectory() {
    for kind in KINDS {
        let hashes = BROAD_PHASES.map(|broad_phase| {
            let mut world = with_gravity(gas(kind, 5, Settings { broad_phase, ..settings() }, 1.0), 1.0);
            run(&mut world, 400);
            assert!(world.totals().impacts > 100, "{kind:?} {broad_phase} {:?}", world.totals());
            world.state_hash()
        });
        assert!(hashes.iter().all(|h| *h == hashes[0]), "{kind:?}: {hashes:?}");
    }
}

#[test]
fn every_number_of_threads_gives_the_same_bits() {
    for kind in [Kind::Spheres, Kind::Tetrahedra] {
        for broad_phase in [BroadPhaseKind::BruteForce, BroadPhaseKind::SortedGrid] {
            let hashes = [1, 2, 8].map(|threads| {
                let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
                pool.install(|| {
                    let mut world = gas(kind, 18, Settings { broad_phase, ..settings() }, 1.0);
                    run(&mut world, 40);
                    world.state_hash()
                })
            });
            assert!(hashes.iter().all(|h| *h == hashes[0]), "{kind:?} {broad_phase}: {hashes:?}");
        }
    }
}

/// Large enough for everything that several threads share: slabs of the broad phase, the order of contacts, parts of the
/// storage, storage sorted again. One thread answers contacts one after the other.
#[test]
fn every_number_of_threads_gives_the_same_bits_in_a_large_gas() {
    for rough in [false, true] {
        let runs = [1, 2, 3, 8].map(|threads| {
            let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
            pool.install(|| {
                let mut world = gas(Kind::Spheres, 32, Settings { steps_per_frame: 4, ..settings() }, 1.0);
                let ids: Vec<_> = world.bodies().collect();
                let surface = mrtphys::Surface { friction: 0.3, restitution: 0.8, ..Default::default() };
                for &id in ids.iter().filter(|_| rough).step_by(7) {
                    world.set_surface(id, surface).unwrap();
                }
                for _ in 0..36 {
                    world.step().unwrap();
                    let contacts = &world.contacts().list;
                    assert_eq!(contacts.len() as u64, world.counters().contacts);
                    assert!(contacts.windows(2).all(|c| c[0].key < c[1].key), "in order, no pair twice");
                }
                assert!(world.counters().contacts > 2000, "{:?}", world.counters());
                (world.state_hash(), *world.totals(), *world.ledger())
            })
        });
        assert!(runs.iter().all(|r| *r == runs[0]), "{rough}: {runs:?}");
    }
}

#[test]
fn a_scene_scaled_by_a_power_of_two_runs_bit_identically() {
    for kind in KINDS {
        for law in [FrictionLaw::Kurtenbach, FrictionLaw::Coulomb] {
            for k in [-40, -1, 7, 40] {
                let scale = libm::ldexp(1.0, k);
                let make = |scale| {
                    let mut w = with_gravity(gas(kind, 3, Settings { friction_law: law, ..settings() }, scale), scale);
                    let ids: Vec<_> = w.bodies().collect();
                    for (i, &id) in ids.iter().enumerate() {
                        let restitution = if i % 2 == 0 { 1.0 } else { 0.7 };
                        let surface = mrtphys::Surface { friction: 0.5, restitution, ..Default::default() };
                        w.set_surface(id, surface).unwrap();
                    }
                    w
                };
                let (mut one, mut other) = (make(1.0), make(scale));
                run(&mut one, 300);
                run(&mut other, 300);
                assert!(one.totals().impacts > 50);
                for (a, b) in one.bodies().zip(other.bodies()) {
                    let (a, b) = (one.body(a).unwrap(), other.body(b).unwrap());
                    assert_eq!((a.position * scale, a.velocity * scale), (b.position, b.velocity), "{kind:?} 2^{k}");
                    assert_eq!((a.orientation, a.angular_velocity), (b.orientation, b.angular_velocity));
                }
                assert_eq!(one.totals(), other.totals());
            }
        }
    }
}

#[test]
fn the_mirror_image_of_a_gas_of_spheres_is_a_run_of_its_own() {
    let mut one = gas(Kind::Spheres, 5, settings(), 1.0);
    let mut other = World::new(settings()).unwrap();
    let low = Vec3::new(-1.0, 0.0, 0.0);
    other.add_box("box", low, Vec3::new(0.0, 1.0, 1.0), Default::default()).unwrap();
    let mirror = |v: Vec3| Vec3::new(-v.x, v.y, v.z);
    for id in one.bodies() {
        let b = one.body(id).unwrap();
        let def = mrtphys::BodyDef {
            position: mirror(b.position),
            velocity: mirror(b.velocity),
            ..mrtphys::BodyDef::new(b.shape)
        };
        other.add_body(def).unwrap();
    }
    run(&mut one, 1000);
    run(&mut other, 1000);
    for (a, b) in one.bodies().zip(other.bodies()) {
        let (a, b) = (one.body(a).unwrap(), other.body(b).unwrap());
        assert_eq!((mirror(a.position), mirror(a.velocity)), (b.position, b.velocity));
    }
}

#[test]
fn scratch_can_be_dropped_between_steps() {
    for broad_phase in BROAD_PHASES {
        let make = || gas(Kind::Tetrahedra, 4, Settings { broad_phase, ..settings() }, 1.0);
        let (mut one, mut other) = (make(), make());
        for _ in 0..200 {
            one.step().unwrap();
            other.forget_scratch();
            other.step().unwrap();
        }
        assert_eq!(one.state_hash(), other.state_hash(), "{broad_phase}");
    }
}

#[test]
fn writing_events_down_changes_nothing_and_they_add_up() {
    for kind in KINDS {
        let make = || {
            let mut w = with_gravity(gas(kind, 4, settings(), 1.0), 1.0);
            let ids: Vec<_> = w.bodies().collect();
            let surface = mrtphys::Surface { friction: 0.7, restitution: 0.9, ..Default::default() };
            ids.iter().step_by(2).for_each(|&id| w.set_surface(id, surface).unwrap());
            w
        };
        let (mut one, mut other) = (make(), make());
        other.record_events(true);
        run(&mut one, 300);
        run(&mut other, 300);
        assert_eq!(one.state_hash(), other.state_hash(), "{kind:?}");
        let events: Vec<_> = other.drain_events().collect();
        assert_eq!(events.len() as u64, other.totals().impacts);
        let booked = other.ledger().friction + other.ledger().restitution;
        let sum: f64 = events.iter().map(|e| e.energy_change).sum();
        assert!(booked < 0.0 && (sum - booked).abs() < 1e-12 * booked.abs().max(1.0), "{sum} {booked}");
    }
}

#[test]
fn the_order_in_memory_changes_nothing() {
    for kind in [Kind::Spheres, Kind::Boxes] {
        let make = || {
            let mut w = with_gravity(gas(kind, 5, settings(), 1.0), 1.0);
            let ids: Vec<_> = w.bodies().collect();
            let surface = mrtphys::Surface { friction: 0.7, restitution: 0.9, ..Default::default() };
            ids.iter().step_by(3).for_each(|&id| w.set_surface(id, surface).unwrap());
            w.record_events(true);
            w
        };
        let (mut one, mut other) = (make(), make());
        let handles: Vec<_> = one.bodies().zip(other.bodies()).collect();
        for step in 0..300 {
            one.step().unwrap();
            other.step().unwrap();
            if step % 7 == 0 {
                other.sort_storage();
            }
            if step == 100 {
                one.remove_body(handles[17].0).unwrap();
                other.remove_body(handles[17].1).unwrap();
            }
        }
        assert_eq!(one.state_hash(), other.state_hash(), "{kind:?}");
        for &(a, b) in handles.iter().filter(|h| h.0 != handles[17].0) {
            assert_eq!(one.body(a).unwrap().position, other.body(b).unwrap().position);
        }
        let events = |w: &mut World| w.drain_events().map(|e| (e.time, e.point, e.impulse_n)).collect::<Vec<_>>();
        assert_eq!(events(&mut one), events(&mut other));
        assert_eq!((one.ledger(), one.energy()), (other.ledger(), other.energy()));
    }
}

#[test]
fn a_snapshot_goes_on_bit_for_bit() {
    for impact in [ImpactMode::Sequential, ImpactMode::Reflection] {
        let make = || {
            let s = Settings { impact, friction_law: FrictionLaw::Kurtenbach, ..settings() };
            let mut w = gas(Kind::Boxes, 4, s, 1.0);
            w.add_force(Arc::new(EarthGravity::default()), Scope::default()).unwrap();
            let ids: Vec<_> = w.bodies().collect();
            let surface = mrtphys::Surface { friction: 0.7, ..Default::default() };
            ids.iter().for_each(|&id| w.set_surface(id, surface).unwrap());
            w
        };
        let mut whole = make();
        run(&mut whole, 150);
        let snapshot = whole.snapshot();
        let mut copy = whole.clone();
        // A copy lives on by itself: its structure may change without a trace in the original.
        let mut other = whole.clone();
        let first = other.bodies().next().unwrap();
        other.remove_body(first).unwrap();
        run(&mut other, 10);
        run(&mut whole, 150);
        run(&mut copy, 150);
        assert_eq!(copy.snapshot(), whole.snapshot());
        assert_eq!(copy.body(first).unwrap().position, whole.body(first).unwrap().position);
        let mut resumed = make();
        resumed.restore(&snapshot).unwrap();
        assert_eq!(resumed.snapshot(), snapshot);
        run(&mut resumed, 150);
        assert_eq!(resumed.state_hash(), whole.state_hash());
        assert_eq!((resumed.ledger(), resumed.totals()), (whole.ledger(), whole.totals()));
    }
}

#[test]
fn a_damaged_snapshot_is_refused() {
    let mut world = gas(Kind::Spheres, 2, settings(), 1.0);
    run(&mut world, 10);
    let good = world.snapshot();
    let hash = world.state_hash();
    for place in 0..good.len() {
        let mut bad = good.clone();
        bad[place] ^= 1 << (place % 8);
        assert!(matches!(world.restore(&bad), Err(Error::Snapshot { .. })), "byte {place}");
        assert!(world.restore(&good[..place]).is_err(), "cut at {place}");
    }
    assert_eq!(world.state_hash(), hash);
    let mut other = gas(Kind::Spheres, 3, settings(), 1.0);
    assert!(other.restore(&good).is_err(), "a world with other bodies");
}
