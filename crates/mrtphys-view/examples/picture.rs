//! A picture of a scene: `cargo run -p mrtphys-view --example picture -- SCENE FILE.png [WORD ...]`, where a word is the name of
//! a mode, of a lighting equation (`light:phong`) or of a coloring (`color:speed`); `dark`; `no-marks`; a number of frames to
//! simulate before; `choose:NUMBER` of a body to outline; or what explains it: `contacts`, `impulses`, `velocities`, `spins`,
//! `balls`, `boxes`, `grid`, `tree`, `trails`, `grip`.

use mrtphys::World;
use mrtphys_view::explain::Pen;
use mrtphys_view::{Coloring, Dress, Frame, Illumination, Look, Mode, Poses, Renderer, Scale, Stage, Theme, film};

/// Poses that a trail shows.
const TRAIL: usize = 60;
const SIZE: (u32, u32) = (1280, 720);

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let args: Vec<String> = std::env::args().skip(1).collect();
    let [scene, file, words @ ..] = args.as_slice() else { return Err("SCENE FILE.png [WORD ...] are needed".into()) };
    let scene = match mrtphys_scene::gallery_scene(scene) {
        Some(text) => mrtphys_scene::Scene::from_text(scene, text)?,
        None => mrtphys_scene::Scene::load(scene.as_ref())?,
    };
    let has = |word: &str| words.iter().any(|w| w == word);
    let after = |start: &str| words.iter().find_map(|w| w.strip_prefix(start));
    let frames = words.iter().find_map(|w| w.parse::<usize>().ok()).unwrap_or(0);
    let look = Look {
        mode: Mode::ALL.iter().find(|m| has(m.1)).map_or(Mode::Phong, |m| m.0),
        illumination: Illumination::ALL
            .iter()
            .find(|i| after("light:") == Some(i.1))
            .map_or_else(Default::default, |i| i.0),
        smooth: Some(true),
        theme: if has("dark") { Theme::Dark } else { Theme::Light },
        marks: !has("no-marks"),
        ..Look::default()
    };
    let mut loaded = scene.build()?;
    let stage = Stage::new(&loaded);
    loaded.world.record_events(true);
    let mut trail = Vec::new();
    for i in 0..frames {
        let mut poses = Poses::default();
        stage.read(&loaded.world, &mut poses);
        if i + TRAIL >= frames {
            trail.push(poses);
        }
        loaded.world.frame()?;
    }
    let mut poses = Poses::default();
    stage.read(&loaded.world, &mut poses);
    let (mut contacts, velocities) = (Vec::new(), velocities_of(&loaded.world));
    stage.count_contacts(&loaded.world, &mut contacts);
    let highlight: Vec<usize> = after("choose:").and_then(|n| n.parse().ok()).into_iter().collect();
    let coloring = Coloring::ALL.iter().find(|c| after("color:") == Some(c.1)).map_or(Coloring::Own, |c| c.0);
    let dress =
        Dress { coloring, velocities: &velocities, contacts: &contacts, highlight: &highlight, ..Dress::default() };
    let mut frame = Frame::new(stage.camera(), look);
    if let Some(legend) = stage.fill_dressed(stage.camera(), look, &dress, &poses, &mut frame) {
        println!("{}: {} to {} {} {:?}", legend.title, legend.min, legend.max, legend.unit, legend.kinds);
    }
    let pen = Pen::new(&stage.camera(), &stage.bounds(), look.theme, SIZE.1);
    let impacts: Vec<_> = loaded.world.drain_events().collect();
    let recent = &impacts[impacts.len().saturating_sub(40)..];
    let (o, world) = (&mut frame.overlay, &loaded.world);
    let mut told = Vec::new();
    let mut scale = Scale::default();
    if has("contacts") {
        told.push(pen.contacts(o, &world.contacts().list));
    }
    if has("impulses") {
        told.push(pen.impulses(o, &mut scale, recent));
    }
    if has("velocities") {
        told.push(pen.velocities(o, &mut scale, &poses.positions, &velocities));
    }
    if has("spins") {
        told.push(pen.spins(o, &mut scale, &poses.positions, &velocities));
    }
    if has("balls") {
        told.push(pen.bounding_spheres(o, &stage, &poses));
    }
    if has("boxes") {
        let bounds = |id| world.body(id).map(|b| b.shape.bounding_box(b.position, &b.orientation.to_matrix()));
        let boxes: Vec<_> = stage.bodies().filter_map(|id| bounds(id).ok()).collect();
        told.push(pen.boxes(o, &boxes));
    }
    if has("grid") {
        told.push(pen.grid(o, &world.cells()).0);
    }
    if has("tree") {
        told.push(pen.tree(o, &world.cells()).0);
    }
    if has("trails") {
        told.push(pen.trails(o, &stage, &trail, &poses, None));
    }
    if has("grip") {
        pen.grip(
            o,
            poses.positions[0],
            poses.positions[0] + stage.camera().axes().up * (0.3 * stage.camera().distance()),
        );
    }
    println!("{told:?}");
    let mut renderer = Renderer::new()?;
    println!("{}", renderer.gpu().name);
    let image = renderer.render(&frame, SIZE.0, SIZE.1)?;
    let again = std::time::Instant::now();
    renderer.render(&frame, SIZE.0, SIZE.1)?;
    println!("a picture takes {:?}", again.elapsed());
    std::fs::write(file, film::png_bytes(&image)?)?;
    Ok(())
}

fn velocities_of(world: &World) -> Vec<(mrtphys::Vec3, mrtphys::Vec3)> {
    world.bodies().filter_map(|id| world.body(id).ok()).map(|b| (b.velocity, b.angular_velocity)).collect()
}
