//! The comparison: its scene file, its checks with an engine that is right and with engines that are wrong, its program.

use mrtphys_bench::compare::check::MOVED_ENOUGH;
use mrtphys_bench::compare::scenes::{Plan, Scene, Subject, catalogue};
use mrtphys_bench::compare::session::Session;
use mrtphys_bench::peers::scene::{NeutralBody, NeutralShape, SceneData};
use mrtphys_bench::peers::{Engine, EngineKind, Margin, Setup, State};
use std::path::PathBuf;
use std::process::Command;
use std::sync::Arc;

fn scene(name: &str) -> Scene {
    catalogue().into_iter().find(|s| s.name == name).unwrap()
}

/// What is wrong with a toy.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Wrong {
    /// nothing, except that bodies pass through each other
    Nothing,
    /// every second body stands still and keeps its velocity
    Freezes,
    /// velocities fade, by this factor a step
    Leaks(f64),
    /// there are no walls
    LetsThrough,
    /// a velocity is no number
    LosesItself,
    /// it has mirrored the scene
    Misreads,
    /// it gives up
    Fails,
}

/// Bodies that fly straight on, and turn round at the walls.
struct Toy {
    scene: SceneData,
    state: State,
    wrong: Wrong,
}

impl Toy {
    fn session(scene: &SceneData, wrong: Wrong) -> Result<Session, String> {
        let mut state = State::default();
        let sign = if wrong == Wrong::Misreads { -1.0 } else { 1.0 };
        for body in &scene.bodies {
            state.push(body.position, body.orientation, body.velocity.map(|v| sign * v), body.spin);
        }
        Session::new(scene.clone(), Box::new(Toy { scene: scene.clone(), state, wrong }))
    }
}

impl Engine for Toy {
    fn version(&self) -> String {
        "toy".into()
    }

    fn settings(&self) -> String {
        format!("{:?}", self.wrong)
    }

    fn step(&mut self) -> Result<(), String> {
        let radius = self.scene.shapes[0].radius();
        for (i, (x, v)) in self.state.position.iter_mut().zip(&mut self.state.velocity).enumerate() {
            for k in 0..3 {
                if self.wrong != Wrong::Freezes || i % 2 == 0 {
                    x[k] += v[k] * self.scene.dt;
                }
                let outwards = (x[k] < radius && v[k] < 0.0) || (x[k] > 1.0 - radius && v[k] > 0.0);
                if outwards && self.wrong != Wrong::LetsThrough {
                    v[k] = -v[k];
                }
                if let Wrong::Leaks(factor) = self.wrong {
                    v[k] *= factor;
                }
            }
        }
        match self.wrong {
            Wrong::LosesItself => self.state.velocity[0][1] = f64::NAN,
            Wrong::Fails => return Err("toys break".into()),
            _ => {}
        }
        Ok(())
    }

    fn read(&self, state: &mut State) {
        state.clone_from(&self.state);
    }
}

fn ours(scene: &Scene) -> Session {
    let setup = Setup { margin: Margin::Default, threads: 1 };
    Session::new(scene.subject.data(), EngineKind::Ours.create(&scene.subject.data(), setup).unwrap()).unwrap()
}

#[test]
fn our_engine_passes_every_check() {
    let scene = scene("spheres-8@512");
    let mut session = ours(&scene);
    session.run(256).unwrap();
    let watched = session.watch(1024).unwrap();
    assert_eq!(watched.moved_part(), Some(1.0));
    let theory = scene.subject.theory(watched.speed / watched.steps as f64).unwrap();
    let ratio = watched.rate(1.0 / 512.0) / theory;
    assert!((0.95..1.05).contains(&ratio), "changes of velocity by theory {ratio}");
    let truth = session.truth();
    assert!((truth.energy - 1.0).abs() < 1e-12);
    assert_eq!(truth.escaped, 0);
    assert!(truth.overlaps.pairs < 20 && truth.overlaps.worst < 0.2, "{truth:?}");
}

#[test]
fn tetrahedra_begin_with_equal_energies_and_keep_them() {
    let mut session = ours(&scene("tetrahedra-8@512"));
    session.run(200).unwrap();
    assert!((session.truth().energy - 1.0).abs() < 1e-12);
    let data = scene("tetrahedra-8@512").subject.data();
    let (mass, properties) = data.shapes[0].mass().unwrap();
    let square = |v: [f64; 3]| v.iter().map(|x| x * x).sum::<f64>();
    let linear: f64 = data.bodies.iter().map(|b| 0.5 * mass * square(b.velocity)).sum();
    let moment = mass * properties.moments_per_mass.x;
    let rotational: f64 = data.bodies.iter().map(|b| 0.5 * moment * square(b.spin)).sum();
    assert!((rotational / linear - 1.0).abs() < 1e-12);
}

#[test]
fn a_toy_without_collisions_misses_them_and_overlaps() {
    let scene = scene("spheres-8@512");
    let mut session = Toy::session(&scene.subject.data(), Wrong::Nothing).unwrap();
    let watched = session.watch(512).unwrap();
    assert_eq!(watched.moved_part(), Some(1.0));
    let ratio = watched.rate(1.0 / 512.0) / scene.subject.theory(watched.speed / watched.steps as f64).unwrap();
    assert!(ratio < 0.5, "{ratio}");
    let truth = session.truth();
    assert!((truth.energy - 1.0).abs() < 1e-12 && truth.escaped == 0);
    assert!(truth.overlaps.pairs > 40 && truth.overlaps.worst > 0.8, "{truth:?}");
}

#[test]
fn every_check_finds_the_toy_that_is_wrong_in_it() {
    let data = scene("spheres-8@512").subject.data();
    let begin = |wrong| Toy::session(&data, wrong).unwrap();

    // Energy and velocities of frozen bodies are perfect: only where they are gives them away.
    let mut frozen = begin(Wrong::Freezes);
    let part = frozen.watch(8).unwrap().moved_part().unwrap();
    assert!((part - 0.5).abs() < 0.02 && part < MOVED_ENOUGH, "{part}");
    assert!((frozen.truth().energy - 1.0).abs() < 1e-12);

    // A leak below what counts as a collision shows in the energy; a faster one makes every step a collision as well.
    let mut leaking = begin(Wrong::Leaks(1.0 - 1e-5));
    assert_eq!(leaking.watch(100).unwrap().moved_part(), Some(1.0));
    assert!((leaking.truth().energy - (1.0f64 - 1e-5).powi(200)).abs() < 1e-9);
    assert_eq!(begin(Wrong::Leaks(0.99)).watch(4).unwrap().moved_part(), None);

    let mut open = begin(Wrong::LetsThrough);
    open.run(100).unwrap();
    assert!(open.truth().escaped > 20);

    let mut lost = begin(Wrong::LosesItself);
    let watched = lost.watch(3).unwrap();
    assert!(watched.changes >= 3);
    let truth = lost.truth();
    assert!(truth.energy.is_nan() && truth.escaped >= 1);

    let error = Toy::session(&data, Wrong::Misreads).err().unwrap();
    assert!(error.contains("velocity"), "{error}");
    for result in
        [begin(Wrong::Fails).run(1), begin(Wrong::Fails).watch(1).map(drop), begin(Wrong::Fails).time(1).map(drop)]
    {
        assert_eq!(result, Err("toys break".into()));
    }
}

#[test]
fn times_are_of_steps() {
    let mut session = Toy::session(&scene("spheres-8@512").subject.data(), Wrong::Nothing).unwrap();
    let burst = session.time(50).unwrap();
    assert!(burst.cpu.median > 0.0 && burst.cpu.mean * 50.0 <= burst.cpu.total, "{burst:?}");
    assert!(burst.wall.median > 0.0 && burst.wall.mean * 50.0 <= burst.wall.total, "{burst:?}");
    let x = session.watch(1).unwrap();
    assert_eq!((x.steps, x.body_steps), (1, 512));
}

/// Three boxes on a fixed one, with gravity and friction: nothing that the gases have.
struct Stack;

impl Subject for Stack {
    fn data(&self) -> SceneData {
        let body = |(shape, y): (u32, f64)| NeutralBody {
            shape,
            fixed: shape == 0,
            position: [0.0, y, 0.0],
            orientation: [0.0, 0.0, 0.0, 1.0],
            velocity: [0.0; 3],
            spin: [0.0; 3],
        };
        SceneData {
            dt: 1.0 / 60.0,
            unit: 1.0,
            restitution: 0.0,
            friction: 0.6,
            gravity: [0.0, -9.81, 0.0],
            container: None,
            shapes: vec![NeutralShape::Box { half: [5.0, 0.5, 5.0] }, NeutralShape::Box { half: [0.5; 3] }],
            bodies: [(0, -0.5), (1, 0.5), (1, 1.5), (1, 2.5)].map(body).to_vec(),
        }
    }

    fn flies(&self) -> bool {
        false
    }
}

/// The comparison is about gases today, its structure is not.
#[test]
fn a_stack_stands_in_every_engine_that_was_built() {
    let plan = Plan { burst: 4, rounds: 1, late: None, watch: 4, end: 8, thin: false };
    let scene = Scene { name: "stack-3@60".into(), subject: Arc::new(Stack), plan };
    let data = scene.subject.data();
    assert_eq!((scene.group(), scene.subject.theory(1.0)), ("stack-3", None));
    for kind in EngineKind::ALL.map(|e| e.0).into_iter().filter(|e| e.built()) {
        let engine = kind.create(&data, Setup { margin: Margin::Default, threads: 1 }).unwrap();
        let mut session = Session::new(data.clone(), engine).unwrap();
        session.run(60).unwrap();
        let watched = session.watch(1).unwrap();
        assert_eq!(watched.body_steps, 3, "{kind:?}: the fixed body is none of those that are watched");
        let truth = session.truth();
        assert!(truth.overlaps.worst < 0.05 && truth.escaped == 0, "{kind:?}: {truth:?}");
        let mut state = State::default();
        session.engine().read(&mut state);
        for (body, at) in data.bodies.iter().zip(&state.position) {
            let off = (0..3).map(|k| (at[k] - body.position[k]).abs()).fold(0.0, f64::max);
            assert!(off <= if body.fixed { 0.0 } else { 0.05 }, "{kind:?}: {:?} became {at:?}", body.position);
        }
    }
}

#[test]
fn the_scene_file_holds_every_bit_and_nothing_else() {
    for name in ["spheres-8@64", "tetrahedra-8@512"] {
        let mut data = scene(name).subject.data();
        data.shapes.push(NeutralShape::Box { half: [1.0, 2.0, 0.1] });
        (data.gravity, data.friction, data.bodies[3].fixed, data.bodies[4].shape) = ([0.0, -9.81, 0.0], 0.3, true, 1);
        let bytes = data.to_bytes();
        assert_eq!(SceneData::from_bytes(&bytes).unwrap(), data);
        data.container = None;
        assert_eq!(SceneData::from_bytes(&data.to_bytes()).unwrap(), data);
        for end in [0, 7, 8, 20, 24, 100, 136, bytes.len() / 2, bytes.len() - 1] {
            assert!(SceneData::from_bytes(&bytes[..end]).is_err(), "{end}");
        }
        assert!(SceneData::from_bytes(&[&bytes[..], &[0]].concat()).is_err());
    }
}

#[test]
fn wrong_scene_files_are_refused() {
    let bytes = scene("spheres-8@64").subject.data().to_bytes();
    let refused = |at: usize, with: &[u8]| {
        let mut bytes = bytes.clone();
        bytes[at..at + with.len()].copy_from_slice(with);
        SceneData::from_bytes(&bytes).unwrap_err()
    };
    assert!(refused(0, b"X").contains("not a scene file"));
    assert!(refused(8, &2u32.to_le_bytes()).contains("version 2"));
    assert!(refused(24, &0f64.to_le_bytes()).contains("not positive"));
    assert!(refused(24, &f64::NAN.to_le_bytes()).contains("not finite"));
    // 128 bytes of head, then the only shape, then the bodies.
    assert!(refused(128, &7u32.to_le_bytes()).contains("kind 7"));
    assert!(refused(160, &1u32.to_le_bytes()).contains("shape 1"));
    // A flag that says more than this program knows, of the container and of a body.
    assert!(refused(20, &2u32.to_le_bytes()).contains("flag 2"));
    assert!(refused(164, &3u32.to_le_bytes()).contains("flag 3"));
    let error = SceneData::read(&PathBuf::from("/no/such/scene")).unwrap_err();
    assert!(error.contains("/no/such/scene"));
}

#[test]
fn walls_are_six_boxes_around_the_container() {
    let data = scene("spheres-8@64").subject.data();
    let walls = data.walls();
    assert_eq!(walls.len(), 6);
    let touches =
        |p: [f64; 3]| walls.iter().filter(|(centre, half)| (0..3).all(|k| (p[k] - centre[k]).abs() <= half[k])).count();
    assert_eq!(touches([0.5, 0.5, 0.5]), 0);
    assert_eq!(touches([0.01, 0.99, 0.5]), 0);
    for k in 0..3 {
        for outside in [-0.01, -0.49, 1.01, 1.49] {
            let mut p = [0.3, 0.6, 0.5];
            p[k] = outside;
            assert_eq!(touches(p), 1, "{p:?}");
        }
    }
    assert!(touches([-0.01, -0.01, -0.01]) == 3);
}

struct Folder(PathBuf);

impl Folder {
    fn new(name: &str) -> Folder {
        let path = std::env::temp_dir().join(format!("mrtphys-compare-{name}-{}", std::process::id()));
        let _ = std::fs::remove_dir_all(&path);
        Folder(path)
    }

    fn run(&self, args: &[&str]) -> (bool, String, String) {
        let program = env!("CARGO_BIN_EXE_mrtphys-bench");
        let output = Command::new(program).arg("peers").args(args).arg("-o").arg(&self.0).output().unwrap();
        let text = |bytes: &[u8]| String::from_utf8_lossy(bytes).into_owned();
        (output.status.success(), text(&output.stdout), text(&output.stderr))
    }
}

impl Drop for Folder {
    fn drop(&mut self) {
        let _ = std::fs::remove_dir_all(&self.0);
    }
}

/// With every engine that was built in: in a default build, ours.
#[test]
fn the_program_compares_and_makes_its_tables_again() {
    let folder = Folder::new("run");
    let (good, tables, errors) = folder.run(&["--quick", "--scenes", "spheres-8,tetrahedra-8@512"]);
    assert!(good, "{errors}");
    assert!(tables.contains("spheres-8@64") && tables.contains("mrtphys"), "{tables}");
    assert!(!tables.contains("INVALID") && !tables.contains("failed"), "{tables}");
    let results = folder.0.join("results.jsonl");
    let text = std::fs::read_to_string(&results).unwrap();
    let records: Vec<serde_json::Value> = text.lines().map(|l| serde_json::from_str(l).unwrap()).collect();
    let ends: Vec<_> = records.iter().filter(|r| r["what"] == "truth").collect();
    let built = EngineKind::ALL.iter().filter(|e| e.0.built()).map(|e| if e.0.has_margin() { 2 } else { 1 });
    assert_eq!(ends.len(), 3 * built.sum::<usize>());
    for end in ends {
        let energy = end["energy"].as_f64().unwrap();
        assert!((energy - 1.0).abs() < 0.1, "{end}");
        assert_eq!(end["steps"], 24);
    }
    assert_eq!(std::fs::read_dir(&folder.0).unwrap().count(), 1, "no scene file is left");

    let from = results.to_str().unwrap();
    let (good, again, _) = folder.run(&["--from", from]);
    assert!(good && tables.ends_with(&again), "{again}");
    // A run that was broken off: what was measured is there.
    std::fs::write(&results, &text[..text.len() / 2]).unwrap();
    let (good, part, errors) = folder.run(&["--from", from]);
    assert!(good && part.contains("spheres-8@512") && part.len() < tables.len(), "{part}{errors}");
}

#[test]
fn a_process_that_cannot_serve_says_why() {
    let program = env!("CARGO_BIN_EXE_mrtphys-bench");
    for (args, word) in [
        (vec!["ours", "default", "1", "/no/such/scene"], "/no/such/scene"),
        (vec!["ours"], "by hand"),
        (vec!["havok", "default", "1", "x"], "no such engine"),
    ] {
        let output = Command::new(program).args(["peers", "--serve"]).args(args).output().unwrap();
        assert!(!output.status.success());
        let said = String::from_utf8_lossy(&output.stdout).into_owned() + &String::from_utf8_lossy(&output.stderr);
        assert!(said.contains(word), "{said}");
    }
}
