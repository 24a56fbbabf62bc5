//! What bodies wear, and what light does to them, where there is a graphics driver.

mod common;

use common::{BLUE, SIZE, apart, ball, bright, camera, changed, count, draw, empty, renderer, seen_at};
use mrtphys::Vec3;
use mrtphys::math::Quat;
use mrtphys::shape::{Polyhedron, Quadrangle};
use mrtphys_view::frame::{Batch, Highlighted, Light};
use mrtphys_view::mesh::Mesh;
use mrtphys_view::{Frame, Illumination, Look, Mode, Theme};
use std::sync::Arc;

/// Pixels of the outline's color.
fn accented(frame: &Frame, image: &mrtphys_view::Image) -> usize {
    count(image, |p| apart(p, frame.look.theme.colors().accent) < 40)
}

#[test]
fn a_chosen_body_is_outlined_in_every_mode_and_theme() {
    let Some(mut r) = renderer("a_chosen_body_is_outlined_in_every_mode_and_theme") else { return };
    for (mode, name) in Mode::ALL {
        for (theme, smooth) in [(Theme::Light, true), (Theme::Dark, false)] {
            let mut frame = ball(mode);
            (frame.look.theme, frame.look.smooth) = (theme, Some(smooth));
            let plain = draw(&mut r, &frame);
            frame.highlight.push(Highlighted { batch: None, body: frame.spheres[0] });
            let chosen = draw(&mut r, &frame);
            // A ring about three pixels wide round a ball of radius 40.8 pixels.
            let ring = accented(&frame, &chosen);
            assert_eq!(accented(&frame, &plain), 0, "{name} {theme:?}");
            assert!((300..1300).contains(&ring), "{name} {theme:?}: {ring}");
            for (x, y) in [(100, 80), (75, 80), (100, 110), (30, 80), (100, 20)] {
                assert_eq!(chosen.pixel(x, y), plain.pixel(x, y), "{name}: the body and what is far stay as they are");
            }
        }
    }
}

#[test]
fn what_is_hidden_or_tiny_or_a_plate_from_its_edge_is_outlined_as_well() {
    let Some(mut r) = renderer("what_is_hidden_or_tiny_or_a_plate_from_its_edge_is_outlined_as_well") else { return };
    let mut hidden = ball(Mode::Phong);
    let small = hidden.instance(Vec3::Z * -1.5, 0.3, Quat::IDENTITY, BLUE).unwrap();
    hidden.highlight.push(Highlighted { batch: None, body: small });
    let image = draw(&mut r, &hidden);
    assert!(accented(&hidden, &image) > 60);
    let mut tiny = empty(Look { smooth: Some(true), ..Look::default() });
    let speck = tiny.instance(Vec3::X, 1e-6, Quat::IDENTITY, BLUE).unwrap();
    tiny.highlight.push(Highlighted { batch: None, body: speck });
    let image = draw(&mut r, &tiny);
    assert!(accented(&tiny, &image) > 40);
    let c = [[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]].map(|p| Vec3::new(p[0], 0.0, p[1]));
    let mut plate = empty(Look { smooth: Some(true), ..Look::default() });
    let mesh = Arc::new(Mesh::quadrangle(&Quadrangle::new(c).unwrap(), 1.0));
    let body = plate.instance(Vec3::ZERO, 1.0, Quat::IDENTITY, BLUE).unwrap();
    plate.batches.push(Batch { mesh, instances: vec![body] });
    plate.highlight.push(Highlighted { batch: Some(0), body });
    let image = draw(&mut r, &plate);
    assert!(accented(&plate, &image) > 150);
    // And nothing of it is left in the next picture.
    let none = draw(&mut r, &ball(Mode::Phong));
    assert_eq!(accented(&plate, &none), 0);
}

#[test]
fn an_outline_follows_the_form_and_grows_with_the_picture() {
    let Some(mut r) = renderer("an_outline_follows_the_form_and_grows_with_the_picture") else { return };
    let cube = Polyhedron::cuboid(Vec3::splat(1.0)).unwrap();
    let mut frame = empty(Look { smooth: Some(true), ..Look::default() });
    let body = frame.instance(Vec3::ZERO, 0.5, Quat::IDENTITY, BLUE).unwrap();
    frame.batches.push(Batch { mesh: Arc::new(Mesh::polyhedron(&cube, 0.5)), instances: vec![body] });
    frame.highlight.push(Highlighted { batch: Some(0), body });
    // The front face is 1 m at 4.5 m: 1 / (0.8 x 4.5) of the height. Looked for along a row and along a diagonal.
    for height in [160u32, 1440] {
        let image = r.render(&frame, height, height).unwrap();
        let (half, middle) = (f64::from(height) / 3.6 / 2.0, f64::from(height) / 2.0);
        let accent = frame.look.theme.colors().accent;
        let width = |dx: f64, dy: f64| {
            let steps = (0..height / 2).filter(|i| {
                let t = f64::from(*i);
                let pixel = image.pixel((middle + dx * t) as u32, (middle + dy * t) as u32);
                t > half && pixel.is_some_and(|p| apart(p, accent) < 60)
            });
            steps.count() as f64
        };
        let right = 4.2 * 0.62 * 1.2 * (f64::from(height) / 720.0).max(1.0);
        for (dx, dy) in [(1.0, 0.0), (0.0, -1.0), (-1.0, 0.2)] {
            assert!((width(dx, dy) - right).abs() < 0.35 * right + 1.0, "{height}: {} for {right}", width(dx, dy));
        }
    }
}

#[test]
fn marks_show_that_a_ball_turns() {
    let Some(mut r) = renderer("marks_show_that_a_ball_turns") else { return };
    for mode in [Mode::Flat, Mode::Gouraud, Mode::Phong] {
        let mut turned = |marks: f32, axis: Vec3, angle: f64| {
            let mut frame = ball(mode);
            frame.look.quality = mrtphys_view::Quality::Level(6);
            frame.spheres[0].marks = marks;
            let q = Quat::from_axis_angle(axis, angle);
            frame.spheres[0].rotation = [q.x, q.y, q.z, q.w].map(|x| x as f32);
            draw(&mut r, &frame)
        };
        for axis in [Vec3::X, Vec3::Y, Vec3::Z, Vec3::new(0.6, 0.0, 0.8)] {
            let [still, moved] = [0.0, 0.2].map(|angle| turned(1.0, axis, angle));
            let seen = changed(&still, &moved, 25);
            assert!(seen > 150, "{mode:?} {axis:?}: {seen}");
            // Half a turn about an axis of the pattern is told from none.
            let [still, moved] = [0.1, 0.1 + std::f64::consts::FRAC_PI_2].map(|angle| turned(1.0, axis, angle));
            assert!(changed(&still, &moved, 15) > 300, "{mode:?} {axis:?}");
            let [still, moved] = [0.0, 0.2].map(|angle| turned(0.0, axis, angle));
            let unseen = changed(&still, &moved, 25);
            assert!(unseen < 30, "{mode:?} {axis:?}: without marks {unseen}");
        }
    }
}

#[test]
fn marks_are_worn_by_spheres_where_the_look_says_so() {
    let text = "format = 1\n[[body]]\nshape = { kind = \"sphere\", radius = 1 }\nposition = [0, 0, 0]\n";
    let loaded = mrtphys_scene::Scene::from_text("test", text).unwrap().build().unwrap();
    for marks in [true, false] {
        let frame = mrtphys_view::frame_of(&loaded, Look { marks, ..Look::default() });
        assert_eq!(frame.spheres[0].marks, f32::from(marks));
    }
}

#[test]
fn each_lighting_equation_does_what_it_says() {
    let Some(mut r) = renderer("each_lighting_equation_does_what_it_says") else { return };
    for mode in [Mode::Gouraud, Mode::Phong] {
        let mut lit = |illumination, toward: Vec3| {
            let mut frame = ball(mode);
            (frame.look.illumination, frame.look.quality) = (illumination, mrtphys_view::Quality::Level(6));
            frame.lights = vec![Light { direction: -toward, color: [255; 3], strength: 1.0 }];
            draw(&mut r, &frame)
        };
        let (right, left) = (Vec3::new(1.0, 1.0, 1.0), Vec3::new(-1.0, 1.0, 1.0));
        // Ambient light has no direction; that of a lamp has.
        assert_eq!(changed(&lit(Illumination::Ambient, right), &lit(Illumination::Ambient, left), 0), 0);
        for equation in [Illumination::Lambert, Illumination::Phong, Illumination::Blinn] {
            assert!(changed(&lit(equation, right), &lit(equation, left), 30) > 1000, "{equation:?}");
        }
        // A blue ball shows red only where it shines.
        let redness = |image: &mrtphys_view::Image| {
            let inside = |x: u32, y: u32| (f64::from(x) - 100.0).hypot(f64::from(y) - 80.0) < 36.0;
            let all = (0..SIZE.0).flat_map(|x| (0..SIZE.1).map(move |y| (x, y))).filter(|(x, y)| inside(*x, *y));
            let red = |(x, y): (u32, u32)| f64::from(image.pixel(x, y).unwrap()[0]);
            let spots: Vec<((u32, u32), f64)> = all.map(|at| (at, red(at))).filter(|s| s.1 > 60.0).collect();
            let sum: f64 = spots.iter().map(|s| s.1).sum();
            let mean = |k: fn((u32, u32)) -> u32| spots.iter().map(|s| f64::from(k(s.0)) * s.1).sum::<f64>() / sum;
            (spots.len(), mean(|p| p.0), mean(|p| p.1))
        };
        for equation in [Illumination::Ambient, Illumination::Lambert] {
            assert_eq!(redness(&lit(equation, right)).0, 0, "{mode:?} {equation:?}");
        }
        // Where the normal is half-way between the lamp and the eye, which is near: found by iteration.
        let lamp = right.try_normalize().unwrap();
        let halfway =
            (0..20).fold(Vec3::Z, |n, _| (lamp + (camera().eye - n).try_normalize().unwrap()).try_normalize().unwrap());
        let (px, py) = camera().place(halfway, 1.25).unwrap();
        for equation in [Illumination::Phong, Illumination::Blinn] {
            let (size, x, y) = redness(&lit(equation, right));
            assert!((30..700).contains(&size), "{mode:?} {equation:?}: {size}");
            let off = (x - px * 200.0).hypot(y - py * 160.0);
            assert!(off < 4.0, "{mode:?} {equation:?}: {off} pixels off");
        }
        let (phong, blinn) = (lit(Illumination::Phong, left), lit(Illumination::Blinn, left));
        assert!(changed(&phong, &blinn, 6) > 20, "the two highlights differ");
    }
}

#[test]
fn only_lamps_throw_shadows_and_they_reach_a_floor_far_below() {
    let Some(mut r) = renderer("only_lamps_throw_shadows_and_they_reach_a_floor_far_below") else { return };
    let text = "format = 1
[[body]]
shape = { kind = \"sphere\", radius = 0.2 }
position = [0, 3, 0]
[[boundary]]
kind = \"half-space\"
normal = [0, 1, 0]
point = [0, 0, 0]
[[light]]
direction = [0, -1, 0]
[camera]
eye = [0, 2, 6]
look_at = [0, 1, 0]
fov_deg = 60
";
    let loaded = mrtphys_scene::Scene::from_text("test", text).unwrap().build().unwrap();
    let mut shade = |illumination| {
        let look = Look { illumination, smooth: Some(false), ..Look::default() };
        let frame = mrtphys_view::frame_of(&loaded, look);
        let image = draw(&mut r, &frame);
        let at = |x: f64| bright(seen_at(&image, &frame.camera, Vec3::new(x, 0.0, 0.0)));
        at(0.6) - at(0.0)
    };
    assert!(shade(Illumination::Blinn) > 60);
    assert!(shade(Illumination::Ambient).abs() < 12);
}
