use super::*;
use crate::testbed::window::jobs::Jobs;
use crate::testbed::window::seeing::{Layer, Sight};
use mrtphys_scene::{Loaded, Scene};
use mrtphys_view::{Look, Stage};

fn take(from: f64, to: f64, fps: u32, speed: f64) -> Take {
    let camera = Camera { eye: Vec3::Z, look_at: Vec3::ZERO, up: Vec3::Y, fov_deg: 45.0 };
    let (look, sight) = (Look { smooth: Some(true), ..Look::default() }, Sight::default());
    let view = View { camera, look, sight, selected: None, spring: None, size: (64, 64), part: 1.0 };
    Take { from, to, fps, speed, view, follow: None, rival: true, path: "film.gif".into() }
}

#[test]
fn a_film_has_the_pictures_of_its_time() {
    assert_eq!(take(0.0, 2.0, 30, 1.0).pictures(), 60);
    assert_eq!(take(1.0, 2.0, 25, 0.1).pictures(), 250);
    assert_eq!(take(0.0, 0.1 + 0.2, 10, 1.0).pictures(), 3, "0.30000000000000004 s");
    assert_eq!(take(0.0, 0.0, 30, 1.0).pictures(), 1);
    assert_eq!(take(2.0, 1.0, 30, 1.0).pictures(), 1);
    assert!(take(0.0, 1e300, 240, 1e-9).pictures() > MOST_PICTURES);
}

#[test]
fn a_picture_lies_between_the_frames_round_it() {
    let times = [1.0, 2.0, 4.0];
    assert_eq!(place(&times, 0.0), (0, 0.0));
    assert_eq!(place(&times, 1.0), (0, 0.0));
    assert_eq!(place(&times, 1.25), (0, 0.25));
    assert_eq!(place(&times, 3.0), (1, 0.5));
    assert_eq!(place(&times, 9.0), (2, 0.0));
    assert_eq!(place(&[1.0, 1.0, 2.0], 1.0), (1, 0.0), "two frames of one time");
}

const SCENE: &str = "format = 1
[[force_field]]
kind = \"uniform\"
acceleration = [0, -9.8, 0]
[[body]]
shape = { kind = \"sphere\", radius = 0.05 }
position = [0, 1, 0]
velocity = [4, 1, 0]
[[body]]
shape = { kind = \"box\", size = [0.4, 0.3, 0.5] }
position = [0, -1, 0]
angular_velocity = [1, 2, 3]
";

fn loaded(text: &str) -> Loaded {
    Scene::from_text("test", text).unwrap().build().unwrap()
}

/// Frames of a world; the rival is there from the fifth on, and sees gravity the other way round.
fn recording() -> (Vec<Recorded>, Arc<Stage>) {
    let mut worlds = [loaded(SCENE), loaded(&SCENE.replace("-9.8", "9.8"))];
    let stage = Arc::new(Stage::new(&worlds[0]));
    let stages = [stage.clone(), Arc::new(Stage::new(&worlds[1]))];
    let mut frames = Vec::new();
    for tick in 0..12 {
        let mut shots = worlds.iter_mut().zip(&stages).map(|(loaded, stage)| {
            let mut poses = Poses::default();
            stage.read(&loaded.world, &mut poses);
            let time = loaded.world.time();
            loaded.world.frame().unwrap();
            Arc::new(Shot { tick, frame: tick, time, stage: stage.clone(), poses: Arc::new(poses) })
        });
        let shot = shots.next().unwrap();
        frames.push(Recorded { shot, rival: shots.next().filter(|_| tick >= 4) });
    }
    (frames, stage)
}

#[test]
fn only_the_frames_of_a_film_are_kept_and_those_of_its_trails() {
    let (all, stage) = recording();
    let ticks = |take: &Take| take.needed(all.clone()).iter().map(|f| f.shot.tick).collect::<Vec<_>>();
    let at = |i: usize| all[i].shot.time;
    let whole = take(at(0), at(11), 30, 1.0);
    assert_eq!(ticks(&whole), (0..12).collect::<Vec<_>>());
    let between = |a: usize| (at(a) + at(a + 1)) / 2.0;
    let mut part = take(between(5), between(7), 30, 1.0);
    assert_eq!(ticks(&part), [5, 6, 7, 8]);
    part.view.sight.trail_of_selected = true;
    part.view.sight.trail = 3;
    assert_eq!(ticks(&part), [5, 6, 7, 8], "nobody is selected");
    part.view.selected = stage.body(0);
    assert_eq!(ticks(&part), [2, 3, 4, 5, 6, 7, 8]);
    part.view.sight.trail = 1000;
    assert_eq!(ticks(&part), (0..9).collect::<Vec<_>>());
    assert!(take(0.0, 1.0, 30, 1.0).needed(Vec::new()).is_empty());
    assert_eq!(ticks(&take(1e3, 2e3, 30, 1.0)), [11]);
}

#[test]
fn the_camera_goes_with_the_body_that_it_follows() {
    let (frames, stage) = recording();
    let mut take = take(0.0, 1.0, 30, 1.0);
    let (first, later) = (&frames[0].shot, &frames[9].shot);
    assert_eq!(take.camera(later, &later.poses), take.view.camera);
    (take.view.selected, take.follow) = (stage.body(0), Some(first.poses.positions[0]));
    let moved = take.camera(later, &later.poses);
    let by = later.poses.positions[0] - first.poses.positions[0];
    assert!(by.length() > 0.1);
    assert_eq!((moved.eye, moved.look_at), (take.view.camera.eye + by, take.view.camera.look_at + by));
}

/// The pictures of a film are those that the window would show of the same moment.
#[test]
fn a_film_shows_what_the_window_shows() {
    let mut renderer = match Renderer::new() {
        Ok(renderer) => renderer,
        Err(e) => return eprintln!("SKIPPED a_film_shows_what_the_window_shows: {e}"),
    };
    let (frames, stage) = recording();
    let mut take = take(0.0, 1.0, 30, 1.0);
    (take.view.camera, take.view.size) = (stage.camera(), (160, 90));
    take.view.selected = stage.body(1);
    take.view.sight.set(Layer::Trails, true);
    take.view.sight.set(Layer::Balls, true);
    take.view.sight.coloring = mrtphys_view::Coloring::Kind;
    let mut set = Set::new(&take);
    // By hand what the window has between two frames.
    let mut window = |i: usize, side: usize, part: f64, wide: u32, sight: Sight| {
        let shots: Vec<&Arc<Shot>> = frames[..i + 2].iter().filter_map(|f| f.side(side)).collect();
        let (earlier, [before, now]) = shots.split_at(shots.len() - 2) else { unreachable!() };
        let mut poses = Poses::default();
        poses.set_between(&before.poses, &now.poses, part);
        let trail = earlier.iter().chain([before]).map(|s| s.poses.clone()).collect();
        let extras = Extras { trail, ..Extras::default() };
        let moment = Moment { stage: &now.stage, poses: &poses, extras: &extras, is_tree: false };
        let view = View { size: (wide, 90), sight, ..take.view };
        let mut frame = Frame::new(view.camera, view.look);
        drawing::fill(&mut frame, &moment, &view, &mut Scales::default());
        renderer.render(&frame, wide, 90).unwrap()
    };
    let mut other = Renderer::new().unwrap();
    let alone = set.picture(&mut other, &frames, 2, 0.25).unwrap();
    assert!(*alone == window(2, 0, 0.25, 160, take.view.sight), "one world");
    assert!(*alone != window(2, 0, 0.25, 160, Sight::default()), "trails, spheres, and colors are seen");
    let (mut trails, mut spheres) = (take.view.sight, take.view.sight);
    trails.set(Layer::Balls, false);
    spheres.set(Layer::Trails, false);
    assert!(*alone != window(2, 0, 0.25, 160, trails) && *alone != window(2, 0, 0.25, 160, spheres), "each is seen");
    let both = set.picture(&mut other, &frames, 7, 0.5).unwrap().clone();
    let mut right = drawing::board((160, 90), Theme::Light);
    drawing::put(&mut right, 0, &window(7, 0, 0.5, 79, take.view.sight));
    drawing::put(&mut right, 80, &window(7, 1, 0.5, 80, take.view.sight));
    assert!(both == right, "two worlds next to each other");
    let single = Take { rival: false, ..take.clone() };
    let alone = Set::new(&single).picture(&mut other, &frames, 7, 0.5).unwrap().clone();
    assert!(alone == window(7, 0, 0.5, 160, take.view.sight), "without the rival");
    // After a picture of two worlds, one of one world is whole again.
    let again = set.picture(&mut other, &frames, 2, 0.25).unwrap();
    assert!(*again == window(2, 0, 0.25, 160, take.view.sight));
}

#[test]
fn a_film_is_written_and_one_that_is_called_off_leaves_nothing() {
    if let Err(e) = Renderer::new() {
        return eprintln!("SKIPPED a_film_is_written_and_one_that_is_called_off_leaves_nothing: {e}");
    }
    let (frames, stage) = recording();
    let folder = std::env::temp_dir().join(format!("mrtphys-reel-{}", std::process::id()));
    std::fs::create_dir_all(&folder).unwrap();
    let mut take = take(0.0, frames[11].shot.time, 20, 1.0);
    (take.view.camera, take.path) = (stage.camera(), folder.join("film.gif"));
    let mut jobs = Jobs::default();
    let ticket = jobs.begin("film", true, &eframe::egui::Context::default());
    let said = take.make(&frames, &ticket).unwrap().unwrap();
    assert!(said.contains(&format!("{} pictures of 64 x 64", take.pictures())) && take.pictures() > 2, "{said}");
    let bytes = std::fs::read(&take.path).unwrap();
    assert!(bytes.starts_with(b"GIF89a") && bytes.ends_with(&[0x3b]));
    take.path = folder.join("other.gif");
    ticket.progress.call_off();
    assert_eq!(take.make(&frames, &ticket), Ok(None));
    assert!(take.make(&[], &ticket).unwrap_err().contains("nothing is recorded"));
    assert_eq!(std::fs::read_dir(&folder).unwrap().count(), 1);
    std::fs::remove_dir_all(&folder).unwrap();
}
