//! The window round a session.

// What is shared.
mod action;
mod ask;
mod desk;
mod format;
mod pending;
mod plot;
mod probe;
mod quantity;
mod seeing;
mod table;
mod typed;

// The parts that stand still.
mod menu;
mod panel;
mod transport;

// The picture.
mod detail;
mod drawing;
mod labels;
mod mouse;
mod picture;
mod viewport;

// The parts that float.
mod browser;
mod export;
mod files;
mod gallery;
mod help;
mod leaving;
mod messages;
mod trouble;

// What goes on beside.
mod jobs;
mod opening;
mod reel;
mod save;

// The program.
mod app;
mod appearance;
mod keys;
mod preferences;
mod status;

use crate::cli::ViewArgs;
use crate::exit::{Failure, Outcome};
use crate::setup;
use app::{Beginning, Testbed};
use eframe::egui;
use mrtphys_scene::gallery;
use opening::{Changes, Origin};
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// The scene behind the gallery when none was named.
const FIRST_SCENE: &str = "thesis/cube-8";
/// Size of the window at first, and at least \[points\].
const SIZE: [f32; 2] = [1280.0, 800.0];
const SMALLEST: [f32; 2] = [800.0, 500.0];
const WITHOUT: &str =
    "without them, 'mrtphys run SCENE' simulates and 'mrtphys render SCENE -o FILE' makes pictures and films";

/// Opens the testbed on a scene, or with the gallery, and stays until it is closed.
///
/// # Errors
/// The scene or an option is wrong; there is no display or no graphics driver: what to install, and what works without.
pub fn open(args: &ViewArgs) -> Outcome {
    if args.simulation.threads > 0 {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(args.simulation.threads as usize);
        pool.build_global().map_err(|e| Failure::Stopped(format!("cannot start the threads: {e}")))?;
    }
    let name = args.scene.clone().unwrap_or_else(|| FIRST_SCENE.into());
    let mut scene = setup::load(&name)?;
    let changes = changes_of(args);
    changes(&mut scene);
    let snapshot = read_snapshot(args, &scene)?;
    check_display()?;
    let origin = origin_of(&name);
    let [gallery, paused, status] = [args.scene.is_none(), args.paused, args.status.is_some()];
    let status = args.status.clone().filter(|_| status);
    let native = eframe::NativeOptions {
        viewport: egui::ViewportBuilder::default()
            .with_title("mrtphys")
            .with_app_id("mrtphys")
            .with_inner_size(args.size.map_or(SIZE, |(w, h)| [w as f32, h as f32]))
            .with_min_inner_size(SMALLEST),
        ..Default::default()
    };
    let create: eframe::AppCreator<'_> = Box::new(move |cc| {
        let session = desk::start(scene, &cc.egui_ctx)?;
        if let Some(bytes) = snapshot {
            session.edit(false, move |loaded| loaded.world.restore(&bytes).map_err(|e| e.to_string()));
        }
        let begin = Beginning { session, origin, changes: Some(changes), gallery, paused, status };
        Ok(Box::new(Testbed::new(cc, begin)?))
    });
    eframe::run_native("mrtphys", native, create).map_err(|e| {
        let why = e.to_string().replace('\n', " ");
        Failure::Wrong(format!("the testbed needs a display and a graphics driver ({why}); {WITHOUT}"))
    })
}

fn changes_of(args: &ViewArgs) -> Changes {
    let (simulation, fps) = (args.simulation.clone(), args.fps);
    Arc::new(move |scene| setup::apply(&simulation, fps, scene))
}

/// As `setup::load`: a file wins over the gallery.
fn origin_of(name: &std::ffi::OsStr) -> Origin {
    let text = name.to_string_lossy();
    let is_gallery = !Path::new(name).exists() && gallery().iter().any(|entry| entry.0 == text);
    if is_gallery { Origin::Gallery(text.into_owned()) } else { Origin::File(PathBuf::from(name)) }
}

/// The bytes of a snapshot that fits the scene: that it does not is to be said before there is a window.
fn read_snapshot(args: &ViewArgs, scene: &mrtphys_scene::Scene) -> Outcome<Option<Vec<u8>>> {
    let Some(path) = &args.simulation.resume else { return Ok(None) };
    let (mut world, _) = setup::build(scene)?;
    setup::take_up(&args.simulation, &mut world)?;
    let bytes = std::fs::read(path).map_err(|e| Failure::Wrong(format!("--resume '{}': {e}", path.display())))?;
    Ok(Some(bytes))
}

/// Where windows come from a display server, that there is one: the libraries below would complain at length.
fn check_display() -> Outcome {
    if cfg!(any(windows, target_os = "macos")) {
        return Ok(());
    }
    let named = |name: &str| std::env::var_os(name).is_some_and(|v| !v.is_empty());
    if ["DISPLAY", "WAYLAND_DISPLAY", "WAYLAND_SOCKET"].into_iter().any(named) {
        return Ok(());
    }
    Err(Failure::Wrong(format!(
        "the testbed needs a display and a graphics driver, and there is no display (neither DISPLAY nor WAYLAND_DISPLAY is set); {WITHOUT}"
    )))
}
