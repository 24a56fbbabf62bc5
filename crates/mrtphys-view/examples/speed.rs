//! How long the processor takes for a picture of many bodies, without the driver:
//! `cargo run --release -p mrtphys-view --example speed [-- SCENE]`.

use mrtphys_view::{Coloring, Dress, Frame, Look, Pen, Poses, Scale, Stage, Theme};
use std::time::{Duration, Instant};

/// Pictures of which the fastest is told: what other programs do then counts least.
const PICTURES: usize = 41;

fn fastest(mut what: impl FnMut()) -> Duration {
    let times = (0..PICTURES).map(|_| {
        let start = Instant::now();
        what();
        start.elapsed()
    });
    times.min().unwrap_or_default()
}

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let name = std::env::args().nth(1).unwrap_or_else(|| "gas-100k".into());
    let text = mrtphys_scene::gallery_scene(&name).ok_or("no such scene")?;
    let loaded = mrtphys_scene::Scene::from_text(&name, text)?.build()?;
    let start = Instant::now();
    let stage = Stage::new(&loaded);
    println!("{} bodies; stage {:?}", stage.body_count(), start.elapsed());
    let (mut poses, camera, look) = (Poses::default(), stage.camera(), Look::default());
    let mut frame = Frame::new(camera, look);
    let body = |id| loaded.world.body(id).map(|b| (b.velocity, b.angular_velocity));
    let velocities: Vec<_> = loaded.world.bodies().filter_map(|id| body(id).ok()).collect();
    println!("read         {:?}", fastest(|| stage.read(&loaded.world, &mut poses)));
    let (a, mut between) = (poses.clone(), Poses::default());
    println!("set_between  {:?}", fastest(|| between.set_between(&a, &poses, 0.5)));
    println!("fill         {:?}", fastest(|| stage.fill(camera, look, &poses, &mut frame)));
    for (coloring, name) in Coloring::ALL {
        let dress = Dress { coloring, velocities: &velocities, highlight: &[0], ..Dress::default() };
        let time = fastest(|| drop(stage.fill_dressed(camera, look, &dress, &poses, &mut frame)));
        println!("fill by {name:14} {time:?}");
    }
    let mut drawing = mrtphys_view::Sorting::default();
    let mut count = 0;
    let time = fastest(|| count = drawing.triangles(&frame, 1280, 720));
    println!("sort         {time:?}, {count} triangles");
    let mut ray = camera.ray(0.5, 0.5, 16.0 / 9.0);
    println!("pick         {:?}", fastest(|| ray.origin = stage.pick(&poses, ray).map_or(ray.origin, |_| ray.origin)));
    let pen = Pen::new(&camera, &stage.bounds(), Theme::Light, 720);
    let mut scale = Scale::default();
    let time = fastest(|| {
        frame.overlay.clear();
        pen.velocities(&mut frame.overlay, &mut scale, &poses.positions, &velocities);
    });
    println!("velocities   {time:?}, {} lines", frame.overlay.lines.len());
    Ok(())
}
