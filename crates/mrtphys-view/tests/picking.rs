//! What is picked is what is seen there: every pixel of pictures in which each body has a color of its own.

mod common;

use common::renderer;
use mrtphys::Vec3;
use mrtphys::math::Quat;
use mrtphys_scene::Scene;
use mrtphys_view::frame::Instance;
use mrtphys_view::{Camera, Frame, Illumination, Image, Look, Mode, Poses, Quality, Renderer, Stage, Theme};

const SIZE: (u32, u32) = (160, 120);

/// Numbers from 0 to 1, the same in every run.
struct Numbers(u64);

impl Numbers {
    fn next(&mut self) -> f64 {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 40) as f64 / f64::from(1 << 24)
    }

    fn point(&mut self, half: f64) -> Vec3 {
        Vec3::new(self.next() - 0.5, self.next() - 0.5, self.next() - 0.5) * (2.0 * half)
    }
}

/// Spheres, tetrahedra, boxes, plates, and a body that is not convex.
fn stage() -> Stage {
    let mut text = String::from("format = 1\n");
    for i in 0..20 {
        let size = 0.3 + 0.05 * f64::from(i);
        let shape = match i % 5 {
            0 => format!("kind = \"sphere\", radius = {size}"),
            1 => format!("kind = \"tetrahedron\", circumradius = {size}"),
            2 => format!("kind = \"box\", size = [{size}, {}, {}]", 2.0 * size, 0.3 * size),
            3 => format!(
                "kind = \"quadrangle\", points = [[0, 0, 0], [{size}, 0, 0], [{size}, {size}, 0], [0, {}, 0]]",
                2.0 * size
            ),
            _ => {
                let s = size;
                let outline =
                    [[0.0, 0.0], [3.0, 0.0], [3.0, 3.0], [2.0, 3.0], [2.0, 1.0], [1.0, 1.0], [1.0, 3.0], [0.0, 3.0]];
                let point =
                    |z: f64| outline.map(|[x, y]| format!("[{}, {}, {}]", x * s / 2.0, y * s / 2.0, z * s)).join(", ");
                let side = |k: usize| format!("[{}, {}, {}, {}]", k, (k + 1) % 8, (k + 1) % 8 + 8, k + 8);
                let sides = (0..8).map(side).collect::<Vec<_>>().join(", ");
                let caps = "[7, 6, 5, 4, 3, 2, 1, 0], [8, 9, 10, 11, 12, 13, 14, 15]";
                format!("kind = \"polyhedron\", points = [{}, {}], faces = [{sides}, {caps}]", point(0.0), point(1.0))
            }
        };
        text += &format!("[[body]]\nshape = {{ {shape} }}\nposition = [{}, 0, 0]\n", 10 * i);
    }
    Stage::new(&Scene::from_text("test", &text).unwrap().build().unwrap())
}

/// The number of the body that each pixel shows, from two pictures: which channels are bright counts in base seven.
fn seen(renderer: &mut Renderer, stage: &Stage, camera: Camera, poses: &Poses) -> Vec<Option<usize>> {
    let look = Look {
        mode: Mode::Phong,
        illumination: Illumination::Ambient,
        quality: Quality::Level(6),
        theme: Theme::Dark,
        smooth: Some(false),
        marks: false,
        ..Look::default()
    };
    let mut frame = Frame::new(camera, look);
    let pictures = [1, 7].map(|place| {
        stage.fill(camera, look, poses, &mut frame);
        let bits = |n: usize| [1, 2, 4].map(|bit| if (n / place % 7 + 1) & bit == 0 { 0 } else { 255 });
        // A frame sorts bodies by surface: which one it is, its place says.
        let (origin, unit) = (frame.origin, frame.unit);
        let paint = |body: &mut Instance| {
            let there = |p: &Vec3| ((*p - origin) / unit).to_array().map(|x| x as f32) == body.position;
            let [r, g, b] = bits(poses.positions.iter().position(there).unwrap());
            body.color = [r, g, b, 255];
        };
        frame.spheres.iter_mut().chain(frame.batches.iter_mut().flat_map(|b| &mut b.instances)).for_each(paint);
        renderer.render(&frame, SIZE.0, SIZE.1).unwrap()
    });
    let digit = |image: &Image, i: usize| {
        let p = &image.rgba[4 * i..4 * i + 3];
        [1, 2, 4].iter().zip(p).filter(|(_, c)| **c > 100).map(|(bit, _)| *bit).sum::<usize>()
    };
    let of = |i: usize| Some((digit(&pictures[0], i).checked_sub(1)?) + 7 * digit(&pictures[1], i).checked_sub(1)?);
    (0..(SIZE.0 * SIZE.1) as usize).map(of).collect()
}

#[test]
fn every_pixel_shows_the_body_that_is_picked_there() {
    let Some(mut r) = renderer("every_pixel_shows_the_body_that_is_picked_there") else { return };
    let stage = stage();
    let (w, h) = (SIZE.0 as usize, SIZE.1 as usize);
    let aspect = f64::from(SIZE.0) / f64::from(SIZE.1);
    let mut numbers = Numbers(2026);
    let mut bodies_seen = std::collections::BTreeSet::new();
    for _ in 0..8 {
        let mut poses = Poses::default();
        for _ in 0..stage.body_count() {
            poses.positions.push(numbers.point(2.0));
            let axis = numbers.point(1.0).try_normalize().unwrap();
            poses.orientations.push(Quat::from_axis_angle(axis, 6.0 * numbers.next()));
        }
        let eye = numbers.point(1.0).try_normalize().unwrap() * 6.0;
        let camera = Camera { eye, look_at: numbers.point(0.3), up: Vec3::Y, fov_deg: 50.0 };
        let seen = seen(&mut r, &stage, camera, &poses);
        bodies_seen.extend(seen.iter().flatten().copied());
        let mut edge = 0;
        for (i, shown) in seen.iter().enumerate() {
            let (x, y) = (i % w, i / w);
            let at = |k: usize, n: u32| (k as f64 + 0.5) / f64::from(n);
            let hit = stage.pick(&poses, camera.ray(at(x, SIZE.0), at(y, SIZE.1), aspect));
            if hit.map(|h| h.index) == *shown {
                if let Some(hit) = hit {
                    let (px, py) = camera.place(hit.point, aspect).unwrap();
                    assert!((px - at(x, SIZE.0)).abs() < 1e-9 && (py - at(y, SIZE.1)).abs() < 1e-9);
                    assert_eq!(stage.index(hit.body), Some(hit.index));
                }
                continue;
            }
            // Only where bodies meet in the picture, by a part of a pixel.
            edge += 1;
            let near = (x.saturating_sub(1)..=(x + 1).min(w - 1))
                .flat_map(|x| (y.saturating_sub(1)..=(y + 1).min(h - 1)).map(move |y| (x, y)));
            let there = near.clone().any(|(x, y)| seen[y * w + x] == hit.map(|h| h.index));
            assert!(there, "{:?} is picked where {shown:?} is seen, at {x} {y}", hit.map(|h| h.index));
        }
        assert!(edge < w * h / 200, "{edge}");
    }
    assert!(bodies_seen.len() >= 18, "{bodies_seen:?}");
}

#[test]
fn picking_is_fast_and_exact_among_many() {
    let text = "format = 1
[[lattice]]
count = [12, 12, 12]
min = [0, 0, 0]
max = [30, 30, 30]
body = [ { shape = { kind = \"sphere\", radius = 0.4 } } ]
";
    let loaded = Scene::from_text("test", text).unwrap().build().unwrap();
    let stage = Stage::new(&loaded);
    let mut poses = Poses::default();
    stage.read(&loaded.world, &mut poses);
    let mut numbers = Numbers(7);
    let mut hits = 0;
    for _ in 0..200 {
        let (from, to) = (Vec3::splat(15.0) + numbers.point(40.0), Vec3::splat(15.0) + numbers.point(15.0));
        let camera = Camera { eye: from, look_at: to, up: Vec3::Y, fov_deg: 40.0 };
        let ray = camera.ray(0.5, 0.5, 1.0);
        let found = stage.pick(&poses, ray);
        // The slow way: the quadratic equation for every ball.
        let slow = poses.positions.iter().enumerate().filter_map(|(i, c)| {
            let to = ray.origin - *c;
            let (b, c) = (to.dot(ray.direction), to.length_squared() - 0.16);
            let root = (b * b - c).sqrt();
            (-b - root >= 0.0).then_some((i, -b - root))
        });
        let slow = slow.min_by(|a, b| a.1.total_cmp(&b.1));
        assert_eq!(found.map(|h| h.index), slow.map(|s| s.0));
        if let (Some(hit), Some(slow)) = (found, slow) {
            assert!((hit.distance - slow.1).abs() < 1e-9);
            assert!(((hit.point - poses.positions[hit.index]).length() - 0.4).abs() < 1e-9);
            hits += 1;
        }
    }
    assert!((50..200).contains(&hits), "{hits}");
    poses.positions[0] = Vec3::splat(f64::NAN);
    let camera = Camera { eye: Vec3::splat(-9.0), look_at: Vec3::splat(0.5), up: Vec3::Y, fov_deg: 40.0 };
    assert_ne!(stage.pick(&poses, camera.ray(0.5, 0.5, 1.0)).map(|h| h.index), Some(0));
}
