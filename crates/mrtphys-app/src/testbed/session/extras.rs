//! What a report contains only where it was wished for.

use super::command::Wish;
use super::report::Extras;
use mrtphys::Real;
use mrtphys_scene::Loaded;
use mrtphys_view::Stage;

/// Looks at a world. Impacts and the trail are not the world's to tell.
pub fn extras(loaded: &Loaded, stage: &Stage, wish: &Wish) -> Extras {
    let world = &loaded.world;
    let mut out = Extras::default();
    if wish.contacts {
        out.contacts = world.contacts().list.clone();
    }
    if wish.cells {
        out.cells = world.cells();
    }
    if wish.velocities {
        out.velocities = stage.bodies().map(|id| world.motion(id).unwrap_or_default()).collect();
    }
    if wish.boxes {
        let gone = mrtphys::bounds::Aabb::EMPTY;
        out.boxes = stage.bodies().map(|id| world.bounding_box(id).unwrap_or(gone)).collect();
    }
    if wish.speeds {
        let speed = |id| Some((world.mass(id).ok()?, world.motion(id).ok()?.0.length()));
        out.speeds = stage.bodies().filter_map(speed).filter(|(mass, _)| *mass < Real::INFINITY).collect();
    }
    out.selected = wish.selected.and_then(|id| {
        let body = world.body(id).ok()?;
        Some((id, loaded.names.body_name(id).unwrap_or_default(), body))
    });
    out
}
