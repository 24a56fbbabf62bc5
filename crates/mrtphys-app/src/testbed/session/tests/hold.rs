//! The hand.

use super::*;

#[test]
fn a_hand_brings_a_body_to_its_place_and_the_books_balance() {
    for mass in [1e-6, 2.0, 1e9] {
        for steps in [1, 8] {
            let mut b = ball();
            b.edit(false, move |l| {
                let id = first_body(l);
                l.world.set_mass(id, mrtphys::def::Mass::Value(mass)).map_err(|e| e.to_string())
            });
            b.send(Command::StepsPerFrame(steps));
            let id = b.body("ball");
            b.send(Command::Go(true));
            b.run(0.1);
            let target = Vec3::new(1.0, 1.0, 0.0);
            b.send(Command::Hold(Some(Grip { body: id, point: Vec3::new(0.0, 0.1, 0.0), target })));
            let mut farthest: f64 = 0.0;
            for _ in 0..120 {
                b.run(1.0 / 60.0);
                farthest = farthest.max(b.core.loaded().world.body(id).unwrap().position.x);
            }
            let world = &b.core.loaded().world;
            let body = world.body(id).unwrap();
            let grip = body.position + body.orientation.rotate(Vec3::new(0.0, 0.1, 0.0));
            assert!((grip - target).length() < 1e-3, "mass {mass}, {steps} steps: {grip:?}");
            assert!(farthest < 1.1 * 1.05, "mass {mass}: overshoot to {farthest}");
            assert!(body.velocity.length() < 0.01 && body.angular_velocity.length() < 0.05, "{body:?}");
            let residual = world.energy().total() - world.initial_energy().total() - world.ledger().sum();
            let flow = 0.5 * mass * 400.0;
            assert!(
                residual.abs() <= 1e-12 * flow.max(world.ledger().sum_abs()),
                "{residual} J of {:?}",
                world.ledger()
            );
        }
    }
}

#[test]
fn nobody_is_held_by_the_hand_of_the_past() {
    let mut b = ball();
    let id = b.body("ball");
    b.send(Command::Go(true));
    b.run(0.1);
    b.send(Command::Hold(Some(Grip { body: id, point: Vec3::ZERO, target: Vec3::new(9.0, 1.0, 0.0) })));
    b.run(0.5);
    let now = b.report().timeline.now;
    b.send(Command::Hold(None));
    b.run(0.1);
    b.send(Command::Seek(now - 3)).settle();
    b.frames(1);
    let v = b.core.loaded().world.body(id).unwrap().velocity;
    b.frames(10);
    assert_eq!(b.core.loaded().world.body(id).unwrap().velocity, v);
}

#[test]
fn letting_go_throws() {
    let mut b = ball();
    let id = b.body("ball");
    b.send(Command::Go(true));
    let mut target = Vec3::new(0.0, 1.0, 0.0);
    for _ in 0..60 {
        target += Vec3::new(2.0 / 60.0, 0.0, 0.0);
        b.send(Command::Hold(Some(Grip { body: id, point: Vec3::ZERO, target })));
        b.run(1.0 / 60.0);
    }
    b.send(Command::Hold(None));
    b.run(0.5);
    let v = b.core.loaded().world.body(id).unwrap().velocity;
    assert!((v - Vec3::new(2.0, 0.0, 0.0)).length() < 0.1, "{v:?}");
}

#[test]
fn a_standing_world_and_a_fixed_body_follow_the_hand() {
    let mut b = ball();
    let id = b.body("ball");
    let grip = |x: f64| Grip { body: id, point: Vec3::new(0.0, 0.1, 0.0), target: Vec3::new(x, 2.0, 0.0) };
    b.frames(1);
    for i in 0..10 {
        b.send(Command::Hold(Some(grip(f64::from(i)))));
    }
    assert_eq!(b.core.loaded().world.body(id).unwrap().position, Vec3::new(9.0, 1.9, 0.0));
    assert_eq!(b.report().sides[0].shot.poses.positions[0], Vec3::new(9.0, 1.9, 0.0), "it is seen at once");
    b.send(Command::Hold(None));
    let carried = b.hash();
    b.frames(3);
    b.send(Command::Seek(1)).settle();
    assert_eq!(b.hash(), carried);
    b.edit(true, move |l| l.world.set_mass(id, mrtphys::def::Mass::Infinite).map_err(|e| e.to_string()));
    b.send(Command::Hold(Some(grip(0.0)))).send(Command::Hold(None));
    b.send(Command::Go(true)).send(Command::Hold(Some(grip(1.0))));
    b.run(1.0);
    assert!((b.core.loaded().world.body(id).unwrap().position - Vec3::new(1.0, 1.9, 0.0)).length() < 1e-9);
    b.send(Command::Hold(Some(Grip { target: Vec3::splat(f64::NAN), ..grip(0.0) })));
    assert!(b.report().trouble.unwrap().contains("ball"));
}
