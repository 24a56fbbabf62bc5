//! The clock of the comparison, in a process where nothing else runs.

use mrtphys_bench::compare::stats::Clock;
use std::time::Duration;

#[test]
fn processor_time_counts_work_of_all_threads_and_no_sleep() {
    let clock = Clock::start().unwrap();
    std::thread::sleep(Duration::from_millis(80));
    let (asleep, wall) = clock.read();
    assert!(wall >= Duration::from_millis(80));
    assert!(asleep < Duration::from_millis(20), "{asleep:?} of work in sleep");

    // A fixed amount of work, some tens of milliseconds of a processor however long that takes on a busy machine.
    let work = || {
        let mut x = 0.4f64;
        for _ in 0..20_000_000 {
            x = std::hint::black_box(3.9 * x * (1.0 - x));
        }
    };
    let alone = Clock::start().unwrap();
    work();
    let (one, _) = alone.read();
    let both = Clock::start().unwrap();
    std::thread::scope(|scope| {
        scope.spawn(work);
        scope.spawn(work);
    });
    let (two, _) = both.read();
    assert!(one >= Duration::from_millis(10), "{one:?}");
    // Twice the work is twice the time, give or take what neighbours on a shared core do to it.
    assert!(two.as_secs_f64() > 1.2 * one.as_secs_f64(), "{one:?} {two:?}");
}
