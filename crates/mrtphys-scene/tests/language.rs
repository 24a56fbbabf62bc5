//! The language: the contract's own example, every shape and field, and exact messages.

use mrtphys::math::{Quat, Vec3};
use mrtphys_scene::scene::{Content, MassDesc};
use mrtphys_scene::{Diagnostics, Scene};

fn read(text: &str) -> Result<Scene, Diagnostics> {
    Scene::from_text("scene.toml", text)
}

/// The headlines of what is wrong with a text, found by reading or by building.
fn wrong(text: &str) -> Vec<String> {
    match read(text).and_then(|s| s.build()) {
        Ok(_) => Vec::new(),
        Err(e) => e.list.iter().map(|d| d.headline()).collect(),
    }
}

#[track_caller]
fn assert_wrong(text: &str, expected: &[&str]) {
    assert_eq!(wrong(text), expected, "\n{text}");
}

const BALL: &str = "format = 1\n[[body]]\nname = 'ball'\nshape = { kind = 'sphere', radius = 0.1 }\n";

#[test]
fn the_example_of_the_contract_is_read_and_built() {
    let folder = std::env::temp_dir().join(format!("mrtphys-scene-example-{}", std::process::id()));
    std::fs::create_dir_all(&folder).expect("a folder");
    let path = folder.join("scene.toml");
    std::fs::write(&path, include_str!("data/interface-example.toml")).expect("written");
    std::fs::write(folder.join("bodies.csv"), "px,py,pz,kind,radius,material\n9,9,9,sphere,0.1,rubber\n")
        .expect("written");
    let scene = Scene::load(&path).unwrap_or_else(|e| panic!("{e}"));
    let loaded = scene.build().unwrap_or_else(|e| panic!("{e}"));
    std::fs::remove_dir_all(&folder).expect("removed");

    assert_eq!(scene.title, "Spheres and tetrahedra in the unit cube");
    assert_eq!((scene.seconds, scene.seed), (10.0, 1));
    // Everything in [simulation] and [medium] is the default.
    assert_eq!(scene.settings, mrtphys::Settings::default());
    assert_eq!(loaded.world.body_count(), 1 + 512 + 1);
    let names: Vec<&str> = scene.contents.iter().map(|c| c.name()).collect();
    assert_eq!(names, ["ball", "lattice0", "body_table0"]);

    let ball = loaded.world.body(loaded.names.body("ball").expect("ball")).expect("a body");
    assert_eq!(ball.position, Vec3::splat(0.5));
    assert_eq!(ball.velocity, Vec3::X);
    assert!((ball.angular_velocity - Vec3::new(0.0, 0.0, 3.0)).max_abs() < 1e-15);
    // Values on the body win over its material.
    assert_eq!((ball.mass, ball.surface.friction, ball.surface.restitution), (1.0, 0.0, 1.0));
    let rubber = loaded.world.body(loaded.names.body("body_table0[0]").expect("a body")).expect("a body");
    assert_eq!((rubber.surface.friction, rubber.surface.restitution), (0.8, 0.9));
    assert!((rubber.mass - 1100.0 * rubber.volume).abs() < 1e-12 * rubber.mass);
    assert_eq!(loaded.names.body_name(loaded.names.bodies()[1]), Some("lattice0[0,0,0]".into()));
    assert!(loaded.names.boundary("boundary0.-x").is_some() && loaded.names.boundary("boundary0.+z").is_some());
    assert_eq!(loaded.color(ball.id).expect("a color").to_string(), "#c04040");
    assert_eq!((loaded.world.forces().len(), loaded.world.flows().len()), (1, 1));
    assert_eq!(scene.camera, Some(mrtphys_scene::scene::Camera::default()));
    assert_eq!(scene.lights, [mrtphys_scene::scene::Light::default()]);
}

#[test]
fn every_shape_is_built() {
    let shapes = [
        ("{ kind = 'sphere', radius = 1 }", 4.0 / 3.0 * std::f64::consts::PI),
        ("{ kind = 'tetrahedron', circumradius = 1.7320508075688772 }", 8.0 / 3.0),
        ("{ kind = 'tetrahedron', points = [[0,0,0], [1,0,0], [0,1,0], [0,0,1]] }", 1.0 / 6.0),
        ("{ kind = 'box', size = [1, 2, 3] }", 6.0),
        ("{ kind = 'convex-hull', points = [[0,0,0], [1,0,0], [0,1,0], [0,0,1], [0.1,0.1,0.1]] }", 1.0 / 6.0),
        (
            "{ kind = 'polyhedron', points = [[0,0,0], [1,0,0], [0,1,0], [0,0,1]], faces = [[0,2,1], [0,1,3], [0,3,2], [1,2,3]] }",
            1.0 / 6.0,
        ),
        ("{ kind = 'quadrangle', points = [[0,0,0], [1,0,0], [1,1,0], [0,1,0]] }", 0.0),
    ];
    for (shape, volume) in shapes {
        let text = format!(
            "format = 1\n[[body]]\nshape = {shape}\nposition = [1, 2, 3]\naxis_angle = {{ axis = [0, 0, 2], angle_deg = 90 }}\n"
        );
        let loaded = read(&text).and_then(|s| s.build()).unwrap_or_else(|e| panic!("{e}"));
        let body = loaded.world.body(loaded.names.body("body0").expect("a name")).expect("a body");
        assert!((body.volume - volume).abs() < 1e-12, "{shape}: {}", body.volume);
        // The author's origin lies at the position, wherever the centre of mass is.
        let origin = body.position + body.orientation.rotate(body.shape.author_origin());
        assert!((origin - Vec3::new(1.0, 2.0, 3.0)).length() < 1e-12, "{shape}");
    }
}

#[test]
fn the_center_of_mass_of_an_eccentric_shape_is_turned_with_it() {
    // The centroid of the tetrahedron is (1/4, 1/4, 1/4); a quarter turn about z takes it to (-1/4, 1/4, 1/4).
    let text = "format = 1\n[[body]]\nshape = { kind = 'tetrahedron', points = [[0,0,0], [1,0,0], [0,1,0], [0,0,1]] }\naxis_angle = { axis = [0, 0, 1], angle_deg = 90 }\nposition = [1, 0, 0]\n";
    let loaded = read(text).and_then(|s| s.build()).unwrap_or_else(|e| panic!("{e}"));
    let body = loaded.world.body(loaded.names.bodies()[0]).expect("a body");
    assert!((body.position - Vec3::new(0.75, 0.25, 0.25)).length() < 1e-15, "{:?}", body.position);
    let text = text.replace("position", "center_of_mass");
    let loaded = read(&text).and_then(|s| s.build()).unwrap_or_else(|e| panic!("{e}"));
    assert_eq!(loaded.world.body(loaded.names.bodies()[0]).expect("a body").position, Vec3::X);
}

#[test]
fn every_field_is_built_and_acts_where_it_should() {
    let text = "format = 1
[[body]]
name = 'sun'
shape = { kind = 'sphere', radius = 0.1 }
[[lattice]]
name = 'dust'
count = [2, 1, 1]
body = [ { shape = { kind = 'sphere', radius = 0.01 } } ]
[[force_field]]
[[force_field]]
kind = 'earth-gravity'
g = 2
direction = [0, 0, 1]
[[force_field]]
kind = 'uniform'
acceleration = [1, 0, 0]
only = ['dust', 'sun']
[[force_field]]
kind = 'point'
body = 'sun'
strength = 1
exponent = 3
reaction = false
[[force_field]]
kind = 'point'
position = [0, 1, 0]
strength = -1
[[force_field]]
kind = 'vortex'
point = [0, 0, 0]
axis = [0, 1, 0]
strength = 1
only = ['dust[1,0,0]']
[[flow_field]]
kind = 'uniform'
velocity = [1, 0, 0]
[[flow_field]]
kind = 'vortex'
axis = [0, 1, 0]
circulation = 2
[[flow_field]]
kind = 'sink'
point = [1, 1, 1]
strength = 0.1
body = 'sun'
";
    let loaded = read(text).and_then(|s| s.build()).unwrap_or_else(|e| panic!("{e}"));
    let (forces, flows) = (loaded.world.forces(), loaded.world.flows());
    assert_eq!((forces.len(), flows.len()), (6, 3));
    assert_eq!(forces[0].field.uniform(), Some(Vec3::new(0.0, -9.80665, 0.0)));
    assert_eq!(forces[1].field.uniform(), Some(Vec3::new(0.0, 0.0, 2.0)));
    let sun = loaded.names.body("sun").expect("the sun");
    assert_eq!(forces[2].scope.only.as_ref().map(|o| o.len()), Some(3));
    assert_eq!((forces[3].scope.carrier, forces[3].scope.without_reaction), (Some(sun), true));
    assert_eq!(forces[3].field.acceleration(Vec3::new(2.0, 0.0, 0.0), 1.0), Vec3::new(-0.125, 0.0, 0.0));
    assert_eq!(forces[5].scope.only, Some(vec![loaded.names.body("dust[1,0,0]").expect("dust")]));
    assert_eq!(flows[2].scope.carrier, Some(sun));
    assert_eq!(flows[0].field.velocity(Vec3::ZERO), Vec3::X);
}

#[test]
fn values_of_the_body_win_over_its_material_over_the_default() {
    let text = "format = 1
[material.steel]
density = 8000
friction = 0.5
restitution_combine = 'average'
[[body]]
shape = { kind = 'box', size = [1, 1, 1] }
material = 'steel'
[[body]]
shape = { kind = 'box', size = [1, 1, 1] }
material = 'steel'
density = 10
friction = 0.25
friction_combine = 'maximum'
[[body]]
shape = { kind = 'box', size = [1, 1, 1] }
[[body]]
shape = { kind = 'box', size = [1, 1, 1] }
material = 'steel'
fixed = true
[[boundary]]
kind = 'half-space'
normal = [0, 1, 0]
material = 'steel'
";
    let loaded = read(text).and_then(|s| s.build()).unwrap_or_else(|e| panic!("{e}"));
    let bodies: Vec<_> = loaded.world.bodies().map(|id| loaded.world.body(id).expect("a body")).collect();
    assert_eq!(bodies.iter().map(|b| b.mass).collect::<Vec<_>>(), [8000.0, 10.0, 1.0, f64::INFINITY]);
    assert_eq!(bodies.iter().map(|b| b.surface.friction).collect::<Vec<_>>(), [0.5, 0.25, 0.0, 0.5]);
    let modes: Vec<_> =
        bodies.iter().map(|b| (b.surface.friction_combine.name(), b.surface.restitution_combine.name())).collect();
    assert_eq!(
        modes,
        [("multiply", "average"), ("maximum", "average"), ("multiply", "multiply"), ("multiply", "average")]
    );
    let wall = loaded.world.boundary(loaded.names.boundary("boundary0").expect("a wall")).expect("a wall");
    assert_eq!((wall.surface.friction, wall.surface.restitution), (0.5, 1.0));
}

#[test]
fn the_order_of_creation_is_that_of_the_text() {
    let text = "format = 1
[[lattice]]
count = [1, 1, 2]
body = [ { shape = { kind = 'sphere', radius = 0.01 } } ]
[[body]]
shape = { kind = 'sphere', radius = 0.01 }
position = [5, 0, 0]
[[lattice]]
count = [1, 1, 1]
min = [2, 0, 0]
max = [3, 1, 1]
body = [ { shape = { kind = 'sphere', radius = 0.01 } } ]
";
    let loaded = read(text).and_then(|s| s.build()).unwrap_or_else(|e| panic!("{e}"));
    let names: Vec<_> = loaded.world.bodies().map(|id| loaded.names.body_name(id).expect("a name")).collect();
    assert_eq!(names, ["lattice0[0,0,0]", "lattice0[0,0,1]", "body0", "lattice1[0,0,0]"]);
    for (name, id) in names.iter().zip(loaded.world.bodies()) {
        assert_eq!(loaded.names.body(name), Some(id));
    }
    for none in ["lattice0", "lattice0[0,0,2]", "lattice0[0,0]", "lattice0[0,0,00]", "lattice0[0,0,+1]", "body1", ""] {
        assert_eq!(loaded.names.body(none), None, "{none}");
    }
    assert_eq!(loaded.names.bodies_of("lattice0").map(|b| b.len()), Some(2));
}

#[test]
fn integers_stand_for_numbers() {
    let scene = read(&format!("{BALL}mass = 2\nposition = [1, -0, 0x10]\n")).unwrap_or_else(|e| panic!("{e}"));
    let Content::Body(body) = &scene.contents[0] else { panic!("a body") };
    assert_eq!(body.substance.mass, MassDesc::Value(2.0));
    assert_eq!(body.placement, mrtphys_scene::scene::Placement::Origin(Vec3::new(1.0, 0.0, 16.0)));
    assert_eq!(body.orientation, Quat::IDENTITY);
}

#[test]
fn unknown_keys_and_values_get_a_suggestion() {
    assert_wrong(
        "format = 1\n[[body]]\nname = 'ball'\nshape = { kind = 'sphere', radus = 0.1 }\n",
        &[
            "scene.toml:4:9: body 'ball': shape: key 'radius' is missing",
            "scene.toml:4:28: body 'ball': shape: unknown key 'radus', did you mean 'radius'?",
        ],
    );
    assert_wrong(
        &format!("{BALL}    velocty = [1, 0, 0]\n"),
        &["scene.toml:5:5: body 'ball': unknown key 'velocty', did you mean 'velocity'?"],
    );
    assert_wrong("format = 1\n[[bodies]]\n", &["scene.toml:2:3: scene: unknown key 'bodies', did you mean 'body'?"]);
    assert_wrong(
        "format = 1\n[simulation]\nfriction_law = 'couloumb'\nfps = 1.5\n",
        &[
            "scene.toml:3:16: simulation: friction_law: unknown value 'couloumb', did you mean 'coulomb'?",
            "scene.toml:4:7: simulation: fps: expected an integer, found a number",
        ],
    );
    assert_wrong(
        "format = 1\n[simulation]\nbroad_phase = 'adaptiv-tree:4'\n",
        &["scene.toml:3:15: simulation: broad_phase: unknown value 'adaptiv-tree:4', did you mean 'adaptive-tree'?"],
    );
    assert_wrong(
        "format = 1\n[[force_field]]\nkind = 'uniform'\nacceleration = [0, 0, 0]\nexponent = 2\n",
        &["scene.toml:5:1: force_field 0: key 'exponent' does not belong to kind 'uniform'"],
    );
}

#[test]
fn what_this_version_does_not_have_is_refused_by_name() {
    for shape in ["capsule", "cylinder", "cone", "mesh", "compound"] {
        let text = format!("format = 1\n[[body]]\nshape = {{ kind = '{shape}', radius = 1 }}\n");
        assert_wrong(&text, &[&format!("scene.toml:3:18: body 'body0': shape.kind: '{shape}': not in this version")]);
    }
    for (key, value, column) in
        [("algorithm", "event-driven", 13), ("algorithm", "rollback", 13), ("broad_phase", "bvh", 15)]
    {
        let text = format!("format = 1\n[simulation]\n{key} = '{value}'\n");
        assert_wrong(&text, &[&format!("scene.toml:3:{column}: simulation: {key}: '{value}': not in this version")]);
    }
}

#[test]
fn wrong_types_ranges_and_missing_keys_name_object_field_and_place() {
    assert_wrong(
        "format = 1\n[[body]]\nname = 'ball'\nshape = { kind = 'sphere', radius = -1 }\nposition = [1, 2]\nvelocity = [1, 'x', 3]\nmass = 'heavy'\nrestitution = 1.5\n",
        &[
            "scene.toml:4:37: body 'ball': shape.radius = -1.0 is out of range: a size from 1e-50 to 1e50 m",
            "scene.toml:5:12: body 'ball': position: expected 3 numbers [x, y, z], found 2",
            "scene.toml:6:16: body 'ball': velocity: expected a number, found a string",
            "scene.toml:7:8: body 'ball': mass: expected a number, found a string",
            "scene.toml:8:15: body 'ball': restitution = 1.5 is out of range: 0 to 1",
        ],
    );
    assert_wrong("", &["scene.toml:1:1: scene: key 'format' is missing"]);
    assert_wrong("format = 2\n", &["scene.toml:1:10: scene: format = 2: not in this version; there is 1"]);
    assert_wrong(
        "format = 1\n[body]\n",
        &["scene.toml:2:1: scene: body: expected a list of tables, found a table: write [[body]] instead of [body]"],
    );
    assert_wrong(
        &format!("{BALL}mass = 1\ndensity = 1\n"),
        &["scene.toml:6:1: body 'ball': 'mass' and 'density' exclude each other"],
    );
    assert_wrong(
        &format!("{BALL}mass = 1\nfixed = true\n"),
        &["scene.toml:5:8: body 'ball': mass: a fixed body has infinite mass; leave 'mass' out"],
    );
    assert_wrong(
        &format!("{BALL}material = 'gold'\n"),
        &["scene.toml:5:12: body 'ball': material: there is no material 'gold'"],
    );
    assert_wrong(
        &format!("{BALL}color = 'red'\n"),
        &["scene.toml:5:9: body 'ball': color: 'red' is not a color, expected '#rrggbb'"],
    );
    assert_wrong(
        "format = 1\n[[lattice]]\ncount = [2, 0, 2]\nbody = []\n",
        &[
            "scene.toml:3:13: lattice 'lattice0': count = 0 is out of range: 1 to 10000000",
            "scene.toml:4:8: lattice 'lattice0': body: expected at least 1 table(s), found 0",
        ],
    );
    assert_wrong(
        &format!("{BALL}friction = 2\n"),
        &["scene.toml:5:12: body 'ball': friction = 2.0 is out of range: 0 to 1 for the friction law 'kurtenbach'"],
    );
    assert_wrong(&format!("{BALL}friction = 2\n[simulation]\nfriction_law = 'coulomb'\n"), &[]);
    assert_wrong(
        "format = 1\n[[force_field]]\nkind = 'point'\nstrength = 1\n",
        &["scene.toml:2:1: force_field 0: key 'position' or 'body' is missing"],
    );
}

#[test]
fn what_only_the_world_can_tell_names_the_object_too() {
    assert_wrong(
        "format = 1\n[[body]]\nname = 'flat'\nshape = { kind = 'convex-hull', points = [[0,0,0], [1,0,0], [0,1,0], [1,1,0]] }\n",
        &["scene.toml:4:9: body 'flat': shape: convex hull: the points are degenerate: they span 2 dimension(s)"],
    );
    assert_wrong(
        "format = 1\n[[body]]\nname = 'sheet'\nshape = { kind = 'quadrangle', points = [[0,0,0], [1,0,0], [1,1,0], [0,1,0]] }\ndensity = 1.0\n",
        &["scene.toml:2:1: body 'sheet': density = 1 is out of range: a mass instead: the shape has no volume"],
    );
    assert_wrong(
        &format!("{BALL}[[body]]\nname = 'ball'\nshape = {{ kind = 'sphere', radius = 1 }}\n"),
        &["scene.toml:5:1: the name 'ball' is there twice"],
    );
    assert_wrong(
        &format!("{BALL}[[force_field]]\nbody = 'bell'\nonly = ['boll']\n"),
        &[
            "scene.toml:5:1: force_field 0: body: there is no body 'bell', did you mean 'ball'?",
            "scene.toml:5:1: force_field 0: only: there is no body, lattice or body table 'boll', did you mean 'ball'?",
        ],
    );
    assert_wrong(
        "format = 1\n[[lattice]]\nname = 'gas'\ncount = [2, 2, 2]\nbody = [ { shape = { kind = 'sphere', radius = 0.01 } } ]\n[[body]]\nname = 'gas[1,0,1]'\nshape = { kind = 'sphere', radius = 1 }\n",
        &["scene.toml:6:1: the name 'gas[1,0,1]' is that of a body of a lattice or table"],
    );
    assert_wrong(
        &format!(
            "{BALL}[[boundary]]\nname = 'tank'\n[[boundary]]\nname = 'tank.+y'\nkind = 'plane'\nnormal = [0, 1, 0]\n"
        ),
        &["scene.toml:7:1: the name 'tank.+y' is there twice"],
    );
}

#[test]
fn the_line_is_shown_with_a_caret_below_the_place() {
    let e = read("format = 1\n[[body]]\nname = 'Bälle'\n\t'shäpe' = 1\nshape = { kind = 'sphere', radius = 1 }\n")
        .expect_err("wrong");
    // Columns are characters; the tab is kept, so that the caret is right at any tab width.
    assert_eq!(
        read("format = 1\ntitle = 'ä'  x\n").expect_err("wrong").first().map(|d| d.headline()),
        Some("scene.toml:2:14: syntax: unexpected key or value, expected newline, `#`".into())
    );
    let text = e.to_string();
    assert!(text.contains("scene.toml:4:2: body 'Bälle': unknown key 'shäpe', did you mean 'shape'?\n"), "{text}");
    let e = read("format = 1\n[[body]]\nname = 'ball'\n\tshape = { kind = 'sphere', radus = 0.1, radius = 1 }\n")
        .expect_err("wrong");
    assert_eq!(
        e.to_string(),
        "scene.toml:4:29: body 'ball': shape: unknown key 'radus', did you mean 'radius'?\n  |\n4 | \tshape = { kind = 'sphere', radus = 0.1, radius = 1 }\n  | \t                           ^^^^^"
    );
}

#[test]
fn at_most_twenty_errors_are_shown_and_the_rest_counted() {
    let text = format!("format = 1\n{}", "[[light]]\ndirection = [0, 0, 0]\n".repeat(50));
    let e = read(&text).expect_err("wrong");
    assert_eq!((e.list.len(), e.more), (20, 30));
    assert_eq!(e.list[1].headline(), "scene.toml:5:13: light 1: direction: a direction must not be [0, 0, 0]");
    assert!(e.to_string().ends_with("and 30 more"));
}

#[test]
fn names_that_are_not_there_come_with_a_suggestion() {
    let oiled =
        "format = 1\n[material.rubber]\n[[body]]\nmaterial = 'ruber'\nshape = { kind = 'sphere', radius = 1 }\n";
    assert_wrong(
        oiled,
        &["scene.toml:4:12: body 'body0': material: there is no material 'ruber', did you mean 'rubber'?"],
    );
    assert_wrong(
        &format!(
            "{BALL}[[force_field]]\nkind = 'point'\nbody = 'bal'\nstrength = 1\n[[flow_field]]\nonly = ['bll', 'x']\n"
        ),
        &[
            "scene.toml:5:1: force_field 0: body: there is no body 'bal', did you mean 'ball'?",
            "scene.toml:9:1: flow_field 0: only: there is no body, lattice or body table 'bll', did you mean 'ball'?",
            "scene.toml:9:1: flow_field 0: only: there is no body, lattice or body table 'x'",
        ],
    );
}

#[test]
fn a_box_that_is_inside_out_is_told_at_its_corner() {
    assert_wrong(
        "format = 1\n[[boundary]]\nname = 'tank'\nmin = [0, 2, 0]\nmax = [1, 1, 1]\n",
        &["scene.toml:5:7: boundary 'tank': max must be greater than min along every axis"],
    );
    assert_wrong(
        "format = 1\n[[boundary]]\nmin = [0, 2, 0]\n",
        &["scene.toml:2:1: boundary 'boundary0': max must be greater than min along every axis"],
    );
}

#[test]
fn a_broad_phase_given_too_much_says_what_is_too_much() {
    for (text, message) in
        [("sorted-grid:3", "'3' is more than 'sorted-grid' can be given"), ("adaptive-tree:4:6:7", "'7' is more than")]
    {
        let found = wrong(&format!("format = 1\n[simulation]\nbroad_phase = '{text}'\n"));
        assert!(found.len() == 1 && found[0].contains(message), "{found:?}");
    }
}
