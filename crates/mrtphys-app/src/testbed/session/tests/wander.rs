//! Any commands in any order.

use super::*;

/// Any commands in any order: a frame that was seen is the same when it is gone back to, and a rival that differs in the
/// broad phase alone agrees.
#[test]
fn any_commands_in_any_order_can_be_gone_back_on() {
    for seed in 0..16 {
        wander(seed, 120);
    }
}

fn wander(seed: u64, commands: usize) {
    let watch = Watch::new();
    let mut random = mrtphys_scene::Random::new(seed);
    let budget = if seed.is_multiple_of(2) { 60 << 10 } else { 8 << 20 };
    let mut b =
        Bench { core: Core::with_budget(scene("thesis/cube-2").build().unwrap(), watch.clock(), budget), watch };
    let mut known = std::collections::BTreeMap::from([(0, b.hash())]);
    for n in 0..commands {
        let pick = random.bits() % 16;
        b.watch.per_look.store(random.bits() % 30_000_000, Ordering::Relaxed);
        let mut went = false;
        let before = b.core.position().tick;
        let at = Vec3::new(random.unit(), random.unit(), random.unit());
        match pick {
            0..=3 => b.frames(1 + (random.bits() % 4) as usize),
            4 => drop(b.send(Command::Step).settle()),
            5 => b.edit(false, gravity),
            6 => b.edit(true, |l| {
                let id = l.world.bodies().next().ok_or("there is no body")?;
                l.world.remove_body(id).map_err(|e| e.to_string())
            }),
            7 => b.edit(true, move |l| add_like(l, &format!("late {n}"), at).map(drop)),
            8 => drop(b.send(Command::StepsPerFrame(1 + (random.bits() % 6) as u32))),
            9 => drop(b.send(Command::Fps(10 + (random.bits() % 40) as u32))),
            10 => {
                b.send(Command::RealTime(RealTime::Forced)).send(Command::Go(true));
                for _ in 0..random.bits() % 40 {
                    b.watch.wait(random.unit() * 0.1);
                    b.core.work();
                }
                b.send(Command::Go(false)).settle();
            }
            11 => {
                let body = b.core.loaded().world.bodies().next();
                let grip = body.map(|body| Grip { body, point: Vec3::ZERO, target: at });
                b.send(Command::Hold(grip)).settle();
            }
            12 => drop(b.send(Command::Hold(None))),
            13 => {
                let settings = b.core.loaded().world.settings().clone();
                let rival = Settings { broad_phase: BroadPhaseKind::BruteForce, ..settings };
                b.send(Command::Rival((!random.bits().is_multiple_of(3)).then_some(rival)));
            }
            _ => {
                let (first, last) = b.core.tape.range();
                let target = first + random.bits() % (last - first + 1);
                b.send(if pick == 14 { Command::Seek(target) } else { Command::Back });
                went = true;
            }
        }
        b.settle();
        let report = b.report();
        assert_ne!(report.rival_agrees, Some(false), "seed {seed}, command {n} ({pick})");
        let stage: Vec<_> = report.sides[0].shot.stage.bodies().collect();
        assert_eq!(stage, b.core.loaded().world.bodies().collect::<Vec<_>>(), "seed {seed}, command {n} ({pick})");
        assert!(!report.timeline.restoring);
        let ticks: Vec<u64> = b.core.tape.shots().map(|s| s.tick).collect();
        assert!(ticks.windows(2).all(|w| w[0] < w[1]), "seed {seed}, command {n} ({pick}): {ticks:?}");
        let now = report.timeline.now;
        if !went && (now > before || b.core.is_inside()) {
            known.retain(|tick, _| *tick <= before);
        }
        if b.core.is_inside() {
            continue;
        }
        if went && let Some(hash) = known.get(&now) {
            assert_eq!(*hash, b.hash(), "seed {seed}, command {n} ({pick}): frame {now}");
            assert_eq!(report.sides[0].shot.time, b.core.loaded().world.time());
        }
        known.insert(now, b.hash());
        known.retain(|tick, _| *tick <= report.timeline.last);
    }
}
