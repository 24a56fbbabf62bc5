//! What the image tests share.
#![allow(dead_code, reason = "each test uses a part of it")]

use mrtphys::Vec3;
use mrtphys::math::Quat;
use mrtphys_view::frame::Light;
use mrtphys_view::{Camera, Frame, Image, Look, Mode, Renderer, ViewError};

pub const SIZE: (u32, u32) = (200, 160);

/// The blue of [`ball`]; there is no red in it.
pub const BLUE: [u8; 4] = [0, 114, 178, 255];

/// `None`: there is no graphics driver, and the test says that it was skipped.
pub fn renderer(test: &str) -> Option<Renderer> {
    match Renderer::new() {
        Ok(renderer) => Some(renderer),
        Err(e @ ViewError::NoAdapter(_)) => {
            // Past the capture of the test harness: a test that did nothing must not look like one that passed.
            use std::io::Write;
            let _ = writeln!(std::io::stderr(), "SKIPPED {test}: {e}");
            None
        }
        Err(e) => panic!("{e}"),
    }
}

/// From 5 m before the origin; a picture is 4 m high there.
pub fn camera() -> Camera {
    let fov_deg = 2.0 * 0.4f64.atan().to_degrees();
    Camera { eye: Vec3::new(0.0, 0.0, 5.0), look_at: Vec3::ZERO, up: Vec3::Y, fov_deg }
}

/// A picture of nothing, lit from the upper right.
pub fn empty(look: Look) -> Frame {
    let mut frame = Frame::new(camera(), look);
    frame.lights.push(Light { direction: Vec3::new(-1.0, -1.0, -1.0), color: [255; 3], strength: 1.0 });
    frame
}

/// A blue ball of radius 1 m in the middle, without marks.
pub fn ball(mode: Mode) -> Frame {
    let mut frame = empty(Look { mode, smooth: Some(true), shadows: false, ..Look::default() });
    frame.spheres.extend(frame.instance(Vec3::ZERO, 1.0, Quat::IDENTITY, BLUE));
    frame
}

pub fn draw(renderer: &mut Renderer, frame: &Frame) -> Image {
    renderer.render(frame, SIZE.0, SIZE.1).unwrap()
}

/// The color where a point is.
pub fn seen_at(image: &Image, camera: &Camera, point: Vec3) -> [u8; 3] {
    let (w, h) = (f64::from(image.width), f64::from(image.height));
    let (x, y) = camera.place(point, w / h).unwrap();
    image.pixel((x * w) as u32, (y * h) as u32).unwrap()
}

/// Sum of the differences of the channels.
pub fn apart(a: [u8; 3], b: [u8; 3]) -> u32 {
    a.iter().zip(b).map(|(x, y)| u32::from(x.abs_diff(y))).sum()
}

pub fn bright(p: [u8; 3]) -> i32 {
    p.iter().map(|&c| i32::from(c)).sum()
}

pub fn count(image: &Image, is: impl Fn([u8; 3]) -> bool) -> usize {
    image.rgba.chunks_exact(4).filter(|p| is([p[0], p[1], p[2]])).count()
}

/// Pixels that differ by more than `by`.
pub fn changed(a: &Image, b: &Image, by: u32) -> usize {
    let pairs = a.rgba.chunks_exact(4).zip(b.rgba.chunks_exact(4));
    pairs.filter(|(p, q)| apart([p[0], p[1], p[2]], [q[0], q[1], q[2]]) > by).count()
}
