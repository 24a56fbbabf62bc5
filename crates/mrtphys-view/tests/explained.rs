//! What explains a picture is seen in it, where there is a graphics driver.

mod common;

use common::{apart, ball, camera, changed, count, draw, renderer, seen_at};
use mrtphys::bounds::Aabb;
use mrtphys::broad::Cell;
use mrtphys::contact::{Contact, Other};
use mrtphys::event::{ImpactEvent, Partner};
use mrtphys::{BodyId, Vec3};
use mrtphys_view::explain::Pen;
use mrtphys_view::{Frame, Image, Look, Mode, Poses, Renderer, Scale, Stage, Theme, frame_of};

/// The picture of the ball with what is drawn; the pen; how many pixels that changed.
fn with(r: &mut Renderer, theme: Theme, explain: impl Fn(&Pen, &mut Frame)) -> (Image, Pen, usize) {
    let mut frame = ball(Mode::Phong);
    frame.look.theme = theme;
    let plain = draw(r, &frame);
    // High enough a picture that the lines are wide enough to look for their colors.
    let bounds = Aabb { min: Vec3::splat(-1.0), max: Vec3::splat(1.0) };
    let pen = Pen::new(&camera(), &bounds, theme, 1440);
    explain(&pen, &mut frame);
    let image = draw(r, &frame);
    let n = changed(&plain, &image, 20);
    (image, pen, n)
}

fn assert_seen(image: &Image, at: Vec3, color: [u8; 3], what: &str) {
    let seen = seen_at(image, &camera(), at);
    assert!(apart(seen, color) < 45, "{what}: {seen:?} where {color:?} should be");
}

const THEMES: [Theme; 2] = [Theme::Light, Theme::Dark];
/// Of what is seen, the longest arrow and the normals.
const DIAGONAL: f64 = 3.464_101_615_137_754_6;

#[test]
fn contacts_and_impulses_are_seen() {
    let Some(mut r) = renderer("contacts_and_impulses_are_seen") else { return };
    let (normal, point) = (Vec3::X, Vec3::new(1.0, 0.0, 0.0));
    let contact = Contact {
        key: 0,
        a: 0,
        b: Other::Wall(0),
        feature: 0,
        normal,
        point,
        depth: 0.0,
        first_point: 0,
        point_count: 0,
    };
    let body = BodyId::from_parts(0, 0, 0);
    let impact = ImpactEvent {
        time: 0.0,
        a: body,
        b: Partner::Body(body),
        point,
        normal,
        impulse_n: 5.0,
        impulse_t: 0.0,
        energy_change: 0.0,
    };
    for theme in THEMES {
        let (image, pen, n) = with(&mut r, theme, |pen, f| {
            pen.contacts(&mut f.overlay, &[contact]);
        });
        assert_seen(&image, point, pen.inks.contact, "the point");
        assert_seen(&image, point + Vec3::X * (0.047 * DIAGONAL), pen.inks.normal, "the normal");
        assert!(n < 1200, "{n}");
        let (image, pen, _) = with(&mut r, theme, |pen, f| {
            pen.impulses(&mut f.overlay, &mut Scale::default(), &[impact]);
        });
        assert_seen(&image, point + Vec3::X * (0.07 * DIAGONAL), pen.inks.impulse, "the impulse");
    }
}

#[test]
fn velocities_and_spins_are_seen() {
    let Some(mut r) = renderer("velocities_and_spins_are_seen") else { return };
    for theme in THEMES {
        let v = [(Vec3::Y * 5.0, Vec3::X * -5.0)];
        let (image, pen, n) = with(&mut r, theme, |pen, f| {
            pen.velocities(&mut f.overlay, &mut Scale::default(), &[Vec3::ZERO], &v);
        });
        // Through the ball, for the half length of the longest arrow.
        assert_seen(&image, Vec3::Y * (0.5 * 0.15 * DIAGONAL), pen.inks.velocity, "the velocity");
        assert!((50..900).contains(&n), "{n}");
        let (image, pen, _) = with(&mut r, theme, |pen, f| {
            pen.spins(&mut f.overlay, &mut Scale::default(), &[Vec3::ZERO], &v);
        });
        assert_seen(&image, Vec3::X * (-0.3 * 0.15 * DIAGONAL), pen.inks.spin, "the axis");
        let arc = count(&image, |p| apart(p, pen.inks.spin) < 45);
        assert!(arc > 120, "{arc}");
    }
}

fn loaded(shape: &str) -> mrtphys_scene::Loaded {
    let text = format!("format = 1\n[[body]]\nshape = {{ {shape} }}\nposition = [0, 0, 0]\ncolor = \"#0072b2\"\n");
    mrtphys_scene::Scene::from_text("test", &text).unwrap().build().unwrap()
}

#[test]
fn bounds_are_seen_about_a_sphere_and_about_a_box() {
    let Some(mut r) = renderer("bounds_are_seen_about_a_sphere_and_about_a_box") else { return };
    for (shape, radius) in
        [("kind = \"sphere\", radius = 1", 1.0), ("kind = \"box\", size = [1.2, 1.2, 1.2]", 1.2 * 0.75f64.sqrt())]
    {
        let loaded = loaded(shape);
        let stage = Stage::new(&loaded);
        let mut poses = Poses::default();
        stage.read(&loaded.world, &mut poses);
        for theme in THEMES {
            let (image, pen, _) = with(&mut r, theme, |pen, f| {
                f.spheres.clear();
                pen.bounding_spheres(&mut f.overlay, &stage, &poses);
            });
            // The circle in which lines of sight touch.
            let (z, r) = (radius * radius / 5.0, radius * (1.0 - radius * radius / 25.0).sqrt());
            for (x, y) in [(r, 0.0), (-r, 0.0), (0.6 * r, 0.8 * r)] {
                assert_seen(&image, Vec3::new(x, y, z), pen.inks.ball, shape);
            }
        }
    }
    for theme in THEMES {
        let (image, pen, n) = with(&mut r, theme, |pen, f| {
            pen.boxes(&mut f.overlay, &[Aabb { min: Vec3::splat(-1.0), max: Vec3::splat(1.0) }]);
        });
        let seen = seen_at(&image, &camera(), Vec3::new(0.3, 1.0, 1.0));
        assert!(apart(seen, pen.inks.aabb) < 140, "{seen:?}");
        assert!(n > 800, "{n}");
    }
}

#[test]
fn cells_are_seen_in_their_tints() {
    let Some(mut r) = renderer("cells_are_seen_in_their_tints") else { return };
    let cell = |x: f64, depth: u32, objects: u32| {
        let min = Vec3::new(x, 1.05, 0.0);
        Cell { bounds: Aabb { min, max: min + Vec3::splat(0.6) }, depth, objects }
    };
    let cells = [cell(-1.5, 0, 1), cell(-0.3, 0, 0), cell(0.9, 2, 9)];
    let middle = |c: &Cell| (c.bounds.min + c.bounds.max) * 0.5;
    for theme in THEMES {
        let (plain, ..) = with(&mut r, theme, |_, _| {});
        let (image, ..) = with(&mut r, theme, |pen, f| {
            pen.grid(&mut f.overlay, &cells);
        });
        let tint = |i: usize| {
            let at = middle(&cells[i]);
            let (before, after) = (seen_at(&plain, &camera(), at), seen_at(&image, &camera(), at));
            [0, 1, 2].map(|k| i32::from(after[k]) - i32::from(before[k]))
        };
        let size = |t: [i32; 3]| t.iter().map(|c| c.abs()).sum::<i32>();
        assert!(size(tint(0)) > 25 && size(tint(2)) > 25, "{:?} {:?}", tint(0), tint(2));
        assert_eq!(size(tint(1)), 0, "an empty cell is not drawn");
        // The fuller one is yellower.
        assert!(tint(2)[0] - tint(2)[2] > tint(0)[0] - tint(0)[2] + 10, "{:?} {:?}", tint(0), tint(2));
        let (image, pen, _) = with(&mut r, theme, |pen, f| {
            pen.tree(&mut f.overlay, &cells);
        });
        let (_, legend) = pen.tree(&mut mrtphys_view::Overlay::default(), &cells);
        for (c, depth) in [(&cells[0], 0.0), (&cells[2], 2.0)] {
            // The lower edge in front.
            let at = Vec3::new(middle(c).x, c.bounds.min.y, c.bounds.max.z);
            let seen = seen_at(&image, &camera(), at);
            assert!(apart(seen, legend.color(depth)) < 110, "{seen:?} for {:?}", legend.color(depth));
        }
    }
}

#[test]
fn trails_fade_and_the_spring_is_seen() {
    let Some(mut r) = renderer("trails_fade_and_the_spring_is_seen") else { return };
    let loaded = loaded("kind = \"sphere\", radius = 0.1");
    let stage = Stage::new(&loaded);
    let place = |y: f64| Poses { positions: vec![Vec3::new(1.4, y, 0.0)], orientations: vec![Default::default()] };
    let trail: Vec<Poses> = (0..10).map(|i| place(-1.5 + 0.3 * f64::from(i))).collect();
    for theme in THEMES {
        let (plain, ..) = with(&mut r, theme, |_, _| {});
        let (image, ..) = with(&mut r, theme, |pen, f| {
            pen.trails(&mut f.overlay, &stage, &trail, &place(1.5), None);
        });
        let seen = |y: f64| {
            let at = Vec3::new(1.4, y, 0.0);
            apart(seen_at(&plain, &camera(), at), seen_at(&image, &camera(), at))
        };
        assert!(
            seen(1.4) > 100 && seen(0.3) < seen(1.4) && seen(-1.2) < seen(0.3),
            "{} {} {}",
            seen(1.4),
            seen(0.3),
            seen(-1.2)
        );
        let (held, hand) = (Vec3::new(0.0, 0.2, 0.5), Vec3::new(1.3, 1.2, 0.0));
        let (image, pen, n) = with(&mut r, theme, |pen, f| pen.grip(&mut f.overlay, held, hand));
        assert_seen(&image, held, pen.inks.grip, "where it is held");
        assert_seen(&image, hand, pen.inks.grip, "the hand");
        assert!(n > 300, "{n}");
    }
}

#[test]
fn the_pen_is_made_for_a_scene_and_its_picture() {
    let loaded = loaded("kind = \"sphere\", radius = 1");
    let frame = frame_of(&loaded, Look::default());
    let stage = Stage::new(&loaded);
    let pens = [360, 720, 2160].map(|h| Pen::new(&frame.camera, &stage.bounds(), Theme::Light, h));
    let width = |pen: &Pen| {
        let mut o = mrtphys_view::Overlay::default();
        pen.grip(&mut o, Vec3::X, Vec3::Y);
        o.lines[0].width
    };
    assert_eq!(width(&pens[0]), width(&pens[1]));
    assert!((width(&pens[2]) / width(&pens[1]) - 3.0).abs() < 1e-6);
}
