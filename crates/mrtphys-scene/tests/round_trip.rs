//! A world that has lived, and that was changed by hand, is written and read back with the same state.

use mrtphys::def::{FrictionLaw, Mass, Surface};
use mrtphys::math::Vec3;
use mrtphys::world::Body;
use mrtphys_scene::scene::{Content, MassDesc, Placement};
use mrtphys_scene::{Loaded, Scene, gallery_scene, to_toml};

fn build(text: &str) -> Loaded {
    Scene::from_text("scene.toml", text).and_then(|s| s.build()).unwrap_or_else(|e| panic!("{e}"))
}

fn write(loaded: &Loaded) -> String {
    to_toml(loaded).unwrap_or_else(|e| panic!("{e}"))
}

fn bodies(loaded: &Loaded) -> Vec<(String, Body)> {
    let named = |id| (loaded.names.body_name(id).expect("a name"), loaded.world.body(id).expect("a body"));
    loaded.world.bodies().map(named).collect()
}

/// The same bodies under the same names with the same state, bit for bit.
#[track_caller]
fn assert_same(a: &Loaded, b: &Loaded) {
    let (a, b) = (bodies(a), bodies(b));
    assert_eq!(a.len(), b.len());
    for ((name, a), (name_b, b)) in a.iter().zip(&b) {
        assert_eq!(name, name_b);
        assert_eq!((a.position, a.velocity), (b.position, b.velocity), "{name}");
        assert_eq!((a.orientation, a.angular_momentum), (b.orientation, b.angular_momentum), "{name}");
        assert_eq!((a.mass, a.inertia, a.surface), (b.mass, b.inertia, b.surface), "{name}");
        assert_eq!((a.shape.kind(), a.shape.bounding_sphere()), (b.shape.kind(), b.shape.bounding_sphere()), "{name}");
    }
}

#[test]
fn worlds_that_have_lived() {
    for name in ["thesis/cube-3", "tops", "u-shapes", "planets", "buoyancy", "break-shot", "two-gases", "wind"] {
        let mut loaded = build(gallery_scene(name).expect("in the gallery"));
        for _ in 0..20 {
            loaded.world.step().expect("a step");
        }
        let text = write(&loaded);
        let again = build(&text);
        assert_same(&loaded, &again);
        assert_eq!(write(&again), text, "{name}");
        // What follows is the same too, where it does not depend on time or on contacts in progress.
        assert_eq!(loaded.world.forces().len(), again.world.forces().len());
        assert_eq!(loaded.world.boundaries().len(), again.world.boundaries().len());
    }
}

#[test]
fn only_what_changed_is_written_as_bodies() {
    let mut loaded = build(gallery_scene("two-gases").expect("in the gallery"));
    let id = loaded.names.body("hot[0,0,0]").expect("a body");
    loaded.world.set_velocity(id, Vec3::new(0.0, 0.0, 9.0)).expect("set");
    let text = write(&loaded);
    assert_eq!(text.matches("[[lattice]]").count(), 1);
    assert_eq!(text.matches("[[body]]").count(), 216);
    // The lattice that is left was the second; it keeps its random numbers.
    assert!(text.contains("name = \"cold\"") && text.contains("seed = 2\nbody"), "{text}");
    assert_same(&loaded, &build(&text));
}

#[test]
fn changes_by_hand() {
    let text = "format = 1
[[body]]
name = 'a'
shape = { kind = 'tetrahedron', points = [[0,0,0], [1,0,0], [0,1,0], [0,0,1]] }
position = [3, 0, 0]
axis_angle = { axis = [1, 2, 3], angle = 1 }
angular_velocity = [1, 2, 3]
color = '#123456'
[[body]]
name = 'b'
shape = { kind = 'sphere', radius = 0.1 }
[[body]]
name = 'c'
shape = { kind = 'box', size = [1, 2, 3] }
position = [9, 0, 0]
density = 3.0
[[force_field]]
kind = 'point'
body = 'b'
strength = 1
only = ['a', 'c']
[[force_field]]
kind = 'earth-gravity'
only = ['a', 'b']
[[boundary]]
name = 'box'
min = [-100, -100, -100]
max = [100, 100, 100]
";
    let mut loaded = build(text);
    assert_same(&loaded, &build(&write(&loaded)));
    let of = |loaded: &Loaded, name| loaded.names.body(name).expect("a body");
    let (a, b, c) = (of(&loaded, "a"), of(&loaded, "b"), of(&loaded, "c"));
    let surface = Surface { friction: 0.5, ..Surface::default() };
    loaded.world.set_surface(a, surface).expect("set");
    loaded.world.set_mass(c, Mass::Infinite).expect("set");
    loaded.world.remove_body(b).expect("removed");
    let settings = mrtphys::Settings {
        fps: 100,
        friction_law: FrictionLaw::Velocity,
        viscosity: 0.25,
        ..loaded.world.settings().clone()
    };
    loaded.world.set_settings(settings.clone()).expect("set");
    for &wall in &loaded.names.boundaries()[2..4] {
        loaded.world.set_boundary_surface(wall, surface).expect("set");
    }
    // A body that the user drops in.
    let Content::Body(mut new) = loaded.scene.contents[2].clone() else { panic!("a body") };
    new.name = "a".into();
    assert!(loaded.add_body(new.clone()).is_err(), "the name is taken");
    new.name = "new".into();
    new.placement = Placement::CenterOfMass(Vec3::new(-9.0, 0.1, 0.0));
    new.substance.mass = MassDesc::Value(0.3);
    let id = loaded.add_body(new).expect("added");
    assert_eq!((loaded.names.body_name(id).as_deref(), of(&loaded, "new")), (Some("new"), id));

    let text = write(&loaded);
    let again = build(&text);
    assert_same(&loaded, &again);
    assert_eq!(again.world.settings(), &settings);
    assert!(text.contains("color = \"#123456\""));
    // The field that the removed body carried is gone with it, and the name from the other's list.
    assert_eq!(again.world.forces().len(), 1);
    assert_eq!(again.world.forces()[0].scope.only.as_ref().map(|o| o.len()), Some(1));
    let walls = |l: &Loaded| -> Vec<_> {
        let view = |&id| l.world.boundary(id).expect("a wall");
        l.names
            .boundaries()
            .iter()
            .map(|id| (l.names.boundary_name(*id).map(String::from), view(id).surface, view(id).position))
            .collect()
    };
    assert_eq!(walls(&loaded), walls(&again));
}

#[test]
fn texts_of_any_kind_survive() {
    let title = "quotes \" and ' and \\, tab \t, line \n, euro €, \u{7f}";
    let mut loaded = build(
        "format = 1\n[material.'a \"b\"']\nfriction = 0.25\n[[body]]\nname = \"o'b \\\" \\\\ ü\"\nshape = { kind = 'sphere', radius = 1 }\nmaterial = 'a \"b\"'\n",
    );
    loaded.scene.title = title.into();
    let again = build(&write(&loaded));
    assert_eq!(again.scene.title, title);
    assert_eq!(again.scene.contents[0].name(), "o'b \" \\ ü");
    assert_same(&loaded, &again);
}
