//! Two worlds side by side.

use super::*;

#[test]
fn a_rival_with_another_broad_phase_agrees_to_the_last_bit() {
    let mut b = bench("thesis/cube-4");
    b.edit(false, gravity);
    b.frames(3);
    let settings = Settings {
        broad_phase: BroadPhaseKind::AdaptiveTree { objects_per_cell: 4, max_depth: 16 },
        ..b.core.loaded().world.settings().clone()
    };
    b.send(Command::Rival(Some(settings.clone()))).settle();
    assert_eq!(b.report().rival_agrees, Some(true));
    b.send(Command::RealTime(RealTime::Off)).send(Command::Go(true));
    for _ in 0..400 {
        b.core.work();
        let report = b.report();
        assert_eq!(report.rival_agrees, Some(true));
        assert_eq!(report.sides.len(), 2);
    }
    b.send(Command::Go(false)).send(Command::Frame).settle();
    b.send(Command::StepsPerFrame(5));
    b.frames(3);
    let report = b.report();
    assert_eq!(report.rival_agrees, Some(true));
    assert_eq!(report.sides[1].numbers.settings.broad_phase, settings.broad_phase, "its own stays");
    assert_eq!(report.sides[1].numbers.settings.steps_per_frame, 5, "the rest is common");
    assert_eq!(sums(&report.sides[0].samples).1, sums(&report.sides[1].samples).1);
    // Back to before there was a rival, it is made anew; later, it is restored.
    let now = report.timeline.now;
    b.send(Command::Seek(1)).settle();
    assert_eq!((b.report().sides.len(), b.report().rival_agrees), (2, Some(true)));
    b.send(Command::Seek(now)).settle();
    assert_eq!(b.report().rival_agrees, Some(true));
    b.send(Command::Rival(None));
    assert_eq!((b.report().sides.len(), b.report().rival_agrees), (1, None));
}

#[test]
fn a_rival_with_another_law_goes_its_own_way_and_comes_back_the_same() {
    let mut b = bench("superball");
    let law = if b.core.loaded().world.settings().friction_law == FrictionLaw::Rough {
        FrictionLaw::Frictionless
    } else {
        FrictionLaw::Rough
    };
    let settings = Settings { friction_law: law, ..b.core.loaded().world.settings().clone() };
    b.send(Command::Rival(Some(settings))).settle();
    let mut hashes = Vec::new();
    for _ in 0..120 {
        b.frames(1);
        hashes.push(b.core.lanes[1].machine.world().state_hash());
    }
    assert_eq!(b.report().rival_agrees, Some(false));
    for tick in [40, 119, 80, 1] {
        b.send(Command::Seek(tick)).settle();
        assert_eq!(b.core.lanes[1].machine.world().state_hash(), hashes[tick as usize - 1]);
        assert_eq!(b.report().sides[1].shot.tick, tick);
    }
    let wrong = Settings { viscosity: 2.0, ..Settings::default() };
    b.send(Command::Rival(Some(wrong))).settle();
    let report = b.report();
    assert!(report.sides.len() == 1 && report.trouble.unwrap().contains("viscosity"));
}

#[test]
fn worlds_take_turns_in_going_first() {
    let mut b = bench("thesis/cube-2");
    let settings = b.core.loaded().world.settings().clone();
    b.send(Command::Rival(Some(settings))).settle();
    let mut firsts = Vec::new();
    b.send(Command::RealTime(RealTime::Off)).send(Command::Go(true));
    while firsts.len() < 4 {
        let whole = !b.core.is_inside();
        b.core.work();
        if whole {
            b.core.work();
            let done = |i: usize| b.core.lanes[i].machine.position().done;
            firsts.push(done(0) > done(1));
        }
    }
    assert_eq!(firsts, [true, false, true, false]);
}

#[test]
fn an_edit_in_the_middle_of_a_frame_reaches_both_worlds_at_the_same_time() {
    let mut b = bench("thesis/cube-3");
    let settings = Settings { broad_phase: BroadPhaseKind::BruteForce, ..b.core.loaded().world.settings().clone() };
    b.send(Command::Rival(Some(settings))).send(Command::RealTime(RealTime::Off)).send(Command::Go(true));
    for _ in 0..5 {
        b.core.work();
    }
    assert!(b.core.is_inside());
    b.edit(false, gravity);
    b.send(Command::Go(false)).settle();
    b.frames(3);
    assert_eq!(b.core.loaded().world.forces().len(), 1 + scene("thesis/cube-3").force_fields.len());
    assert_eq!(b.report().rival_agrees, Some(true));
}
