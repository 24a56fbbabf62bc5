//! Sessions with their thread.

use super::*;

/// Waits until a report says so.
fn wait_for(session: &mut Session, what: &str, so: impl Fn(&Report) -> bool) {
    let start = Instant::now();
    while !so(session.report()) {
        assert!(start.elapsed() < Duration::from_secs(30), "{what} never came");
        std::thread::sleep(Duration::from_millis(2));
        session.poll();
    }
}

#[test]
fn a_thread_runs_stops_and_goes_back() {
    let woken = Arc::new(AtomicU64::new(0));
    let count = woken.clone();
    let mut s = Session::start(scene("thesis/cube-3"), move || {
        count.fetch_add(1, Ordering::Relaxed);
    })
    .unwrap();
    s.send(Command::Go(true));
    wait_for(&mut s, "frame 10", |r| r.timeline.now >= 10);
    s.send(Command::Go(false));
    wait_for(&mut s, "the stop", |r| !r.running);
    s.send(Command::Seek(5));
    wait_for(&mut s, "frame 5", |r| r.timeline.now == 5 && !r.timeline.restoring);
    let (tell, told) = std::sync::mpsc::channel();
    s.send(Command::Ask(Box::new(move |studio| {
        let _ = tell.send((studio.loaded.world.state_hash(), (studio.shots)().len()));
    })));
    let (hash, shots) = told.recv_timeout(Duration::from_secs(10)).unwrap();
    let mut twin = bench("thesis/cube-3");
    twin.frames(5);
    assert_eq!(hash, twin.hash());
    assert!(shots >= 11);
    // Standing still, it sleeps.
    std::thread::sleep(Duration::from_millis(50));
    let then = woken.load(Ordering::Relaxed);
    std::thread::sleep(Duration::from_millis(200));
    assert_eq!(woken.load(Ordering::Relaxed), then);
}

#[test]
fn a_thread_survives_a_panic_and_says_so() {
    let mut s = Session::start(scene("thesis/cube-2"), || {}).unwrap();
    s.send(Command::Frame);
    s.send(Command::Frame);
    wait_for(&mut s, "frame 2", |r| r.timeline.now == 2);
    s.edit(false, |_| panic!("a slip of the pen"));
    wait_for(&mut s, "the fault", |r| r.trouble.as_deref().is_some_and(|t| t.contains("a slip of the pen")));
    s.send(Command::Frame);
    wait_for(&mut s, "frame 3", |r| r.timeline.now == 3);
    let (tell, told) = std::sync::mpsc::channel();
    s.send(Command::Ask(Box::new(move |studio| {
        let _ = tell.send(studio.loaded.world.state_hash());
    })));
    let mut twin = bench("thesis/cube-2");
    twin.frames(3);
    assert_eq!(told.recv_timeout(Duration::from_secs(10)).unwrap(), twin.hash());
}

#[test]
fn samples_reach_a_window_that_looks_rarely() {
    let mut s = Session::start(scene("thesis/cube-2"), || {}).unwrap();
    s.send(Command::RealTime(RealTime::Off));
    s.send(Command::Go(true));
    std::thread::sleep(Duration::from_millis(300));
    s.send(Command::Go(false));
    s.send(Command::Frame);
    let mut frames = 0;
    let start = Instant::now();
    loop {
        if s.poll() {
            let r = s.report();
            frames += sums(&r.sides[0].samples).0;
            if !r.running && frames > 0 && r.timeline.now == frames {
                break;
            }
        }
        assert!(start.elapsed() < Duration::from_secs(30), "{frames} frames of {}", s.report().timeline.now);
        std::thread::sleep(Duration::from_millis(5));
    }
    assert!(frames > 10, "{frames}");
}
