//! A picture of a scene: `cargo run -p mrtphys-view --example picture -- SCENE FILE.png [MODE]`.

use mrtphys_view::{Look, Mode, Renderer, Theme, film, frame_of};

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let args: Vec<String> = std::env::args().skip(1).collect();
    let [scene, file, rest @ ..] = args.as_slice() else { return Err("SCENE FILE.png [MODE] are needed".into()) };
    let scene = match mrtphys_scene::gallery_scene(scene) {
        Some(text) => mrtphys_scene::Scene::from_text(scene, text)?,
        None => mrtphys_scene::Scene::load(scene.as_ref())?,
    };
    let mode = rest.first().and_then(|name| Mode::ALL.iter().find(|m| m.1 == name));
    let theme = if rest.iter().any(|r| r == "dark") { Theme::Dark } else { Theme::Light };
    let look = Look { mode: mode.map_or(Mode::Phong, |m| m.0), smooth: Some(true), theme, ..Look::default() };
    let mut renderer = Renderer::new()?;
    println!("{}", renderer.gpu().name);
    let start = std::time::Instant::now();
    let frame = frame_of(&scene.build()?, look);
    let made = start.elapsed();
    let image = renderer.render(&frame, 1280, 720)?;
    println!("frame {made:?}, picture {:?}", start.elapsed() - made);
    let again = std::time::Instant::now();
    renderer.render(&frame, 1280, 720)?;
    println!("again {:?}", again.elapsed());
    std::fs::write(file, film::png_bytes(&image)?)?;
    Ok(())
}
