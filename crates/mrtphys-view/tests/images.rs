//! Pictures, where there is a graphics driver. Without one the tests say that they were skipped.

mod common;

use common::{SIZE, ball, bright, count, draw, renderer};
use mrtphys::Vec3;
use mrtphys::math::Quat;
use mrtphys::shape::Quadrangle;
use mrtphys_view::frame::Batch;
use mrtphys_view::mesh::Mesh;
use mrtphys_view::overlay::{Block, Line, Point};
use mrtphys_view::{Image, Look, Mode, Quality, Renderer, Theme, ViewError, frame_of};
use std::sync::Arc;

fn is_blue(p: [u8; 3]) -> bool {
    i32::from(p[2]) > i32::from(p[0]) + 40
}

fn blue_part(image: &Image) -> f64 {
    count(image, is_blue) as f64 / f64::from(image.width * image.height)
}

#[test]
fn a_lit_ball_is_round_and_brighter_towards_the_light() {
    let Some(mut r) = renderer("a_lit_ball_is_round_and_brighter_towards_the_light") else { return };
    for mode in [Mode::Flat, Mode::Gouraud, Mode::Phong] {
        let image = draw(&mut r, &ball(mode));
        // The tangent of the outline is 1/sqrt(5^2 - 1), that of the picture's upper edge 0.4: 80 pixels.
        let radius = 1.0 / 24f64.sqrt() / 0.4 * 80.0;
        let right = std::f64::consts::PI * radius * radius / f64::from(SIZE.0 * SIZE.1);
        let part = blue_part(&image);
        assert!((part / right - 1.0).abs() < 0.03, "{mode:?}: {part} of {right}");
        let at = |x, y| bright(image.pixel(x, y).unwrap());
        assert!(at(115, 65) > at(85, 95) + 60, "{mode:?}: {} {}", at(115, 65), at(85, 95));
        assert!(!is_blue(image.pixel(2, 2).unwrap()) && image.pixel(2, 2).unwrap()[0] > 220);
    }
}

#[test]
fn flat_shows_triangles_and_phong_does_not() {
    let Some(mut r) = renderer("flat_shows_triangles_and_phong_does_not") else { return };
    let colors = |r: &mut Renderer, mode| {
        let mut frame = ball(mode);
        frame.look.quality = Quality::Level(1);
        let image = draw(r, &frame);
        let mut all: Vec<[u8; 3]> = (70..130).flat_map(|x| image.pixel(x, 80)).collect();
        all.dedup_by(|a, b| bright(*a).abs_diff(bright(*b)) <= 2);
        all.len()
    };
    let (flat, phong) = (colors(&mut r, Mode::Flat), colors(&mut r, Mode::Phong));
    assert!(flat < phong && phong > 20, "{flat} {phong}");
}

#[test]
fn line_modes_draw_lines_and_hide_what_is_behind() {
    let Some(mut r) = renderer("line_modes_draw_lines_and_hide_what_is_behind") else { return };
    let parts = [Mode::Wireframe, Mode::HiddenLine].map(|mode| {
        let mut frame = ball(mode);
        frame.look.quality = Quality::Level(1);
        blue_part(&draw(&mut r, &frame))
    });
    let filled = blue_part(&draw(&mut r, &ball(Mode::Phong)));
    assert!(parts[1] > 0.01 && parts[1] < 0.8 * parts[0] && parts[0] < 0.8 * filled, "{parts:?} {filled}");
}

#[test]
fn a_quadrangle_is_seen_from_both_sides() {
    let Some(mut r) = renderer("a_quadrangle_is_seen_from_both_sides") else { return };
    let c = [[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]].map(|p| Vec3::new(p[0], p[1], 0.0));
    let mesh = Arc::new(Mesh::quadrangle(&Quadrangle::new(c).unwrap(), 1.0));
    for angle in [0.0, std::f64::consts::PI] {
        let mut frame = ball(Mode::Phong);
        frame.spheres.clear();
        let turned = Quat::from_axis_angle(Vec3::Y, angle);
        let one = frame.instance(Vec3::ZERO, 1.0, turned, [0, 114, 178, 255]);
        frame.batches.push(Batch { mesh: mesh.clone(), instances: one.into_iter().collect() });
        let part = blue_part(&draw(&mut r, &frame));
        // 2 m of 4 m upwards and of 5 m sideways
        assert!((part - 0.2).abs() < 0.01, "{angle}: {part}");
    }
}

#[test]
fn a_ball_throws_a_shadow_on_another() {
    let Some(mut r) = renderer("a_ball_throws_a_shadow_on_another") else { return };
    let picture = |r: &mut Renderer, shadows| {
        let mut frame = ball(Mode::Phong);
        frame.look.shadows = shadows;
        // On the way of the light to the front of the ball.
        let at = Vec3::new(1.0, 1.0, 1.6);
        frame.spheres.extend(frame.instance(at, 0.3, Quat::IDENTITY, [230, 159, 0, 255]));
        draw(r, &frame)
    };
    let (lit, shaded) = (picture(&mut r, false), picture(&mut r, true));
    let pairs = lit.rgba.chunks_exact(4).zip(shaded.rgba.chunks_exact(4));
    let darker = pairs.filter(|(a, b)| bright([a[0], a[1], a[2]]) > bright([b[0], b[1], b[2]]) + 60).count();
    // The shadow's width is the small ball's: pi (0.3 / 4 x 160)^2 = 452 pixels, slanted.
    assert!((150..1500).contains(&darker), "{darker}");
}

#[test]
fn the_overlay_lies_in_space_unless_it_is_on_top() {
    let Some(mut r) = renderer("the_overlay_lies_in_space_unless_it_is_on_top") else { return };
    let red = [220, 0, 0, 255];
    let counts = [false, true].map(|on_top| {
        let mut frame = ball(Mode::Phong);
        let behind = |x| Vec3::new(x, 0.0, -1.0);
        frame.overlay.lines.push(Line { from: behind(-2.0), to: behind(2.0), color: red, width: 3.0, on_top });
        frame.overlay.points.push(Point { at: behind(0.0), color: red, size: 12.0, on_top });
        count(&draw(&mut r, &frame), |p| p[0] > 150 && p[1] < 90)
    });
    assert!(counts[0] > 100 && counts[1] > counts[0] + 250, "{counts:?}");
    let mut frame = ball(Mode::Phong);
    let half = Vec3::splat(1.2);
    frame.overlay.blocks.push(Block { center: Vec3::ZERO, half, orientation: Quat::IDENTITY, color: [255, 0, 0, 80] });
    let (plain, boxed) = (draw(&mut r, &ball(Mode::Phong)), draw(&mut r, &frame));
    let (p, b) = (plain.pixel(100, 80).unwrap(), boxed.pixel(100, 80).unwrap());
    assert!(b[0] > p[0] + 20 && b[2] > 60, "the ball is seen through the box: {p:?} {b:?}");
}

#[test]
fn pictures_are_repeatable_and_nothing_is_left_of_the_last_one() {
    let Some(mut r) = renderer("pictures_are_repeatable_and_nothing_is_left_of_the_last_one") else { return };
    let scene = |name| {
        let text = mrtphys_scene::gallery_scene(name).unwrap();
        let loaded = mrtphys_scene::Scene::from_text(name, text).unwrap().build().unwrap();
        frame_of(&loaded, Look { smooth: Some(false), ..Look::default() })
    };
    let (mut u, cube) = (scene("u-shapes"), scene("thesis/cube-3"));
    let first = draw(&mut r, &u);
    assert_ne!(draw(&mut r, &cube), first);
    assert_eq!(draw(&mut r, &u), first);
    assert_eq!(draw(&mut Renderer::new().unwrap(), &u), first);
    u.look.theme = Theme::Dark;
    assert!(bright(draw(&mut r, &u).pixel(3, 3).unwrap()) < 150);
}

#[test]
fn impossible_sizes_are_refused() {
    let Some(mut r) = renderer("impossible_sizes_are_refused") else { return };
    for (w, h) in [(0, 10), (10, 0), (1_000_000, 10)] {
        assert!(matches!(r.render(&ball(Mode::Phong), w, h), Err(ViewError::Size { .. })));
    }
    assert_eq!(r.render(&ball(Mode::Phong), 1, 1).unwrap().rgba.len(), 4);
}
