//! Events, trajectories, records, snapshots, and files that cannot be written.

mod common;
use common::{Folder, csv, number, numbers};
use serde_json::Value;

fn sum_of_column(rows: &[Vec<String>], column: usize) -> f64 {
    rows[1..].iter().map(|r| number(&r[column])).sum()
}

#[test]
fn the_events_add_up_to_the_ledger() {
    let folder = Folder::with_scenes("events");
    let r = folder.report("rain.toml --events e.csv");
    let rows = csv(&folder.text("e.csv"));
    let header = "time body_a body_b px py pz nx ny nz impulse_n impulse_t energy_change";
    assert_eq!(rows[0], header.split(' ').collect::<Vec<_>>());
    assert!(rows.iter().all(|row| row.len() == 12));
    assert_eq!(rows.len() as u64 - 1, r["counters"]["impacts"].as_u64().unwrap());
    assert!(rows.len() > 3);
    let booked = r["ledger"]["friction"].as_f64().unwrap() + r["ledger"]["restitution"].as_f64().unwrap();
    let written = sum_of_column(&rows, 11);
    assert!(booked < -0.1 && (booked - written).abs() <= 1e-12 * booked.abs() * 100.0, "{booked} {written}");
    let times: Vec<f64> = rows[1..].iter().map(|r| number(&r[0])).collect();
    assert!(times.is_sorted() && times.iter().all(|t| (0.0..=1.0).contains(t)));
    assert!(rows[1..].iter().any(|r| r[1] == "a \"quoted\", name"), "a name that needs quotes comes back");
    let on_floor = rows.iter().find(|r| r[2] == "floor").expect("something hits the floor");
    assert_eq!(number(&on_floor[7]), -1.0, "the normal points from the body to the floor");
}

#[test]
fn events_only_keeps_those_of_the_names() {
    let folder = Folder::with_scenes("only");
    let events = |only: &str| {
        folder.run_args(["run", "gas.toml", "--quiet", "--events", "e.csv", "--events-only", only]).expect(0);
        csv(&folder.text("e.csv")).split_off(1)
    };
    folder.run("run gas.toml --quiet --events all.csv").expect(0);
    let all = csv(&folder.text("all.csv")).split_off(1);
    let with = |name: &str| all.iter().filter(|r| r[1..3].iter().any(|n| n.starts_with(name))).count();
    assert!(with("gas[1,1,1]") > 0 && with("gas[1,1,1]") < all.len());
    assert_eq!(events("gas[1,1,1]").len(), with("gas[1,1,1]"));
    assert_eq!(events("walls").len(), with("walls"));
    assert_eq!(events("walls.-x").len(), with("walls.-x"));
    assert_eq!(events("walls, gas").len(), all.len());
    let wrong = ["run", "gas.toml", "--events", "x.csv", "--events-only", "wals"];
    folder.run_args(wrong).refused(&["--events-only", "'wals'", "walls"]);
    assert!(!common::exists(&folder.path("x.csv")), "nothing is emptied for a wrong name");
}

#[test]
fn a_trajectory_has_every_body_at_frame_0_and_after_each() {
    let folder = Folder::with_scenes("trajectory");
    let r = folder.report("rain.toml --seconds 0.11 --trajectory t.csv");
    let rows = csv(&folder.text("t.csv"));
    assert_eq!(rows[0], "time body px py pz qx qy qz qw vx vy vz wx wy wz".split(' ').collect::<Vec<_>>());
    // 6 whole frames, a shortened one, and frame 0
    assert_eq!(rows.len(), 1 + 8 * 3);
    assert_eq!(rows[1][..5], ["0.0", "a \"quoted\", name", "0.0", "1.0", "0.0"]);
    let times: Vec<f64> = rows[1..].chunks(3).map(|frame| number(&frame[0][0])).collect();
    for (frame, time) in times.iter().enumerate().take(7) {
        assert_eq!(*time, (frame * 8) as f64 / 480.0);
    }
    assert_eq!(times[7], 0.11);
    let last = &rows[rows.len() - 2];
    let body = &r["bodies"][1];
    let values = |member: &str| numbers(&body[member]);
    let reported = [values("position"), values("orientation"), values("velocity"), values("angular_velocity")].concat();
    let written: Vec<f64> = last[2..].iter().map(|f| number(f)).collect();
    assert_eq!(written, reported, "the last frame is the state of the report, bit for bit");
}

/// Header and records of a binary file, each record as words.
fn records(bytes: &[u8], magic: &[u8]) -> (Vec<String>, Vec<Vec<u64>>, usize) {
    let word = |at: usize| u64::from_le_bytes(bytes[at..at + 8].try_into().unwrap());
    let half = |at: usize| u32::from_le_bytes(bytes[at..at + 4].try_into().unwrap());
    assert_eq!((&bytes[..8], half(8)), (magic, 1));
    let (size, count, table) = (half(12) as usize, word(16) + word(24), word(32) as usize);
    assert!(size.is_multiple_of(8) && table.is_multiple_of(8));
    let (mut at, mut names) = (40, Vec::new());
    for _ in 0..count {
        let length = half(at) as usize;
        names.push(String::from_utf8(bytes[at + 4..at + 4 + length].to_vec()).unwrap());
        at += 4 + length;
    }
    assert!(40 + table - at < 8 && bytes[at..40 + table].iter().all(|&b| b == 0));
    let rest = &bytes[40 + table..];
    let records = rest.chunks_exact(size);
    let records = records.map(|r| r.chunks(8).map(|w| u64::from_le_bytes(w.try_into().unwrap())).collect());
    (names, records.collect(), size)
}

#[test]
fn records_hold_what_the_text_holds() {
    let folder = Folder::with_scenes("records");
    let r = folder.report("rain.toml --events e.csv --trajectory t.csv");
    folder.run("run rain.toml --quiet --events e.bin --trajectory t.bin --report r.bin").expect(0);
    let bytes = |name: &str| std::fs::read(folder.path(name)).unwrap();
    let real = f64::from_bits;

    let (names, events, size) = records(&bytes("e.bin"), b"MRTPEVNT");
    assert_eq!((names.len(), size), (4, 96));
    let rows = csv(&folder.text("e.csv"));
    assert_eq!(events.len(), rows.len() - 1);
    for (record, row) in events.iter().zip(&rows[1..]) {
        assert_eq!([&names[record[0] as usize], &names[record[1] as usize]], [&row[1], &row[2]]);
        assert_eq!(real(record[2]), number(&row[0]));
        assert!((3..12).all(|i| record[i] == number(&row[i]).to_bits()));
    }

    let (names, bodies, size) = records(&bytes("t.bin"), b"MRTPTRAJ");
    assert_eq!(size, 120);
    let rows = csv(&folder.text("t.csv"));
    assert_eq!(bodies.len(), rows.len() - 1);
    for (record, row) in bodies.iter().zip(&rows[1..]) {
        assert_eq!((&names[record[0] as usize], real(record[1])), (&row[1], number(&row[0])));
        assert!((2..15).all(|i| record[i] == number(&row[i]).to_bits()));
    }

    let file = bytes("r.bin");
    let (_, bodies, size) = records(&file, b"MRTPREPT");
    let table = u64::from_le_bytes(file[32..40].try_into().unwrap()) as usize;
    let json: Value = serde_json::from_slice(&file[40 + table + 3 * size..]).unwrap();
    assert_eq!(json["state_hash"], r["state_hash"]);
    assert!(json.get("bodies").is_none());
    assert_eq!(json["kinds"][bodies[0][0] as usize], "sphere");
    assert_eq!([real(bodies[1][1]), real(bodies[2][1])], [2.0, f64::INFINITY]);
    assert_eq!(bodies[1][2..5].iter().map(|&w| real(w)).collect::<Vec<_>>(), numbers(&r["bodies"][1]["position"]));
}

#[test]
fn a_run_in_two_parts_ends_as_a_run_in_one() {
    let folder = Folder::with_scenes("resume");
    for scene in ["gas.toml", "rain.toml"] {
        let whole = folder.report(scene);
        folder.run(&format!("run {scene} --quiet --frames 11 --snapshot s.snap")).expect(0);
        let rest = folder.report(&format!("{scene} --resume s.snap --trajectory t.csv"));
        for member in ["state_hash", "time", "steps", "frames", "energy", "initial_energy", "ledger", "largest_step"] {
            assert_eq!(rest[member], whole[member], "{scene}: {member}");
        }
        assert_eq!(rest["counters"]["impacts"], whole["counters"]["impacts"]);
        let rows = csv(&folder.text("t.csv"));
        assert_eq!(number(&rows[1][0]), 88.0 / 480.0, "the trajectory goes on where the snapshot was taken");
    }
    // The same file, step by step; and nothing left to do.
    folder.run("run gas.toml --quiet --frames 1 --snapshot s.snap").expect(0);
    for frame in 2..=4 {
        folder.run(&format!("run gas.toml --quiet --frames {frame} --resume s.snap --snapshot s.snap")).expect(0);
    }
    let four = folder.report("gas.toml --frames 4");
    let again = folder.run("run gas.toml --frames 3 --resume s.snap --report again.json").expect(0);
    assert!(again.err.contains("warning") && again.err.contains("no step"), "{}", again.err);
    assert_eq!(folder.json("again.json")["state_hash"], four["state_hash"]);
}

#[test]
fn a_snapshot_that_does_not_fit_is_refused() {
    let folder = Folder::with_scenes("unfit");
    folder.run("run gas.toml --quiet --frames 1 --snapshot s.snap").expect(0);
    folder.run("run rain.toml --resume s.snap").refused(&["s.snap", "bodies"]);
    folder.run("run gas.toml --resume none.snap").refused(&["none.snap"]);
    let mut bytes = std::fs::read(folder.path("s.snap")).unwrap();
    let middle = bytes.len() / 2;
    bytes[middle] ^= 1;
    std::fs::write(folder.path("bad.snap"), bytes).unwrap();
    folder.run("run gas.toml --resume bad.snap").refused(&["bad.snap", "checksum"]);
    folder.run("run gas.toml --resume gas.toml").refused(&["gas.toml", "not a snapshot"]);
}

#[test]
fn what_cannot_be_written_is_told_before_the_simulation() {
    let folder = Folder::with_scenes("unwritable");
    // A run of this length would not end.
    let long = "run gas.toml --quiet --seconds 100000";
    for option in ["--report", "--events", "--trajectory", "--snapshot"] {
        folder.run(&format!("{long} {option} no/such/folder/file.csv")).refused(&["no/such/folder/file.csv"]);
        folder.run(&format!("{long} {option} .")).refused(&["'.'"]);
        folder.run(&format!("{long} {option} gas.toml")).refused(&[option, "the scene", "same file"]);
    }
    folder.run(&format!("{long} --events x.csv --trajectory ./x.csv")).refused(&[
        "--events",
        "--trajectory",
        "same file",
    ]);
    assert_eq!(folder.text("gas.toml"), common::GAS);
    // An output that is fine is not emptied because another is not.
    folder.put("old.json", "{}");
    folder.run(&format!("{long} --report old.json --snapshot no/such.snap")).expect(1);
    assert_eq!(folder.text("old.json"), "{}");
    assert_eq!(folder.files(), ["gas.toml", "old.json", "rain.toml"]);
}

#[cfg(target_os = "linux")]
#[test]
fn a_full_disk_ends_the_run_with_2_and_the_other_files_are_written() {
    let folder = Folder::with_scenes("full");
    for option in ["--events", "--trajectory"] {
        let done = folder.run(&format!("run gas.toml --quiet {option} /dev/full --report r.json")).expect(2);
        assert!(done.err.contains("/dev/full"), "{}", done.err);
        assert!(folder.json("r.json")["steps"].as_u64().unwrap() > 0);
        std::fs::remove_file(folder.path("r.json")).unwrap();
    }
}

// These tests keep away from `/dev`: a program that renamed over what is there would, as root, take it from everybody.

#[cfg(unix)]
#[test]
fn a_report_that_does_not_fit_ends_the_run_with_2_and_leaves_the_old_one() {
    let folder = Folder::with_scenes("limit");
    for option in ["--report", "--snapshot"] {
        folder.put("old", "old");
        // No file may grow beyond a kilobyte; the signal that would tell is ignored, so that writing fails.
        let line =
            format!("trap '' XFSZ; ulimit -f 1; exec \"$0\" run gas.toml --quiet {option} old --events /dev/null");
        let done = std::process::Command::new("sh")
            .args(["-c", &line, env!("CARGO_BIN_EXE_mrtphys")])
            .current_dir(&folder.0)
            .output()
            .unwrap();
        let done = common::Done::from(done).expect(2);
        assert!(done.err.contains("'old'") && done.out.contains("state hash"), "{}", done.err);
        assert_eq!(folder.text("old"), "old");
        assert_eq!(folder.files(), ["gas.toml", "old", "rain.toml"]);
    }
}

#[cfg(unix)]
#[test]
fn a_report_goes_into_a_pipe_and_through_a_link() {
    use std::os::unix::fs::FileTypeExt;
    let folder = Folder::with_scenes("pipe");
    let pipe = folder.path("pipe");
    assert!(std::process::Command::new("mkfifo").arg(&pipe).status().unwrap().success());
    let reader = std::thread::spawn({
        let pipe = pipe.clone();
        move || std::fs::read_to_string(pipe).unwrap()
    });
    folder.run("run gas.toml --quiet --frames 2 --report pipe").expect(0);
    let report: Value = serde_json::from_str(&reader.join().unwrap()).unwrap();
    assert_eq!(report["steps"], 16);
    assert!(std::fs::metadata(&pipe).unwrap().file_type().is_fifo());

    folder.put("real.json", "{}");
    std::os::unix::fs::symlink("real.json", folder.path("link.json")).unwrap();
    folder.run("run gas.toml --quiet --frames 3 --report link.json").expect(0);
    assert_eq!(folder.json("real.json")["steps"], 24);
    assert!(std::fs::symlink_metadata(folder.path("link.json")).unwrap().is_symlink());
}

#[test]
fn writing_things_down_changes_nothing() {
    let folder = Folder::with_scenes("observed");
    for scene in ["gas.toml", "rain.toml"] {
        // Far enough for a difference in the last bit of one impact to show.
        let plain = folder.report(&format!("{scene} --frames 120"));
        let observed = folder.report(&format!("{scene} --frames 120 --events e.csv --trajectory t.csv"));
        for member in ["state_hash", "counters", "ledger", "energy"] {
            assert_eq!(observed[member], plain[member], "{scene}: {member}");
        }
        let impacts = plain["counters"]["impacts"].as_u64().unwrap();
        assert_eq!(csv(&folder.text("e.csv")).len() as u64, impacts + 1, "{scene}");
    }
}
