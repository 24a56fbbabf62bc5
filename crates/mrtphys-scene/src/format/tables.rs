//! The table of keys: everything a scene may say, once. Reading checks against it, the JSON schema is written from it.

use super::keys::{Case, Key, Kind, Range, Table};
use Kind::{Bool, Choice, Color, Direction, File, Integer, Name, Number, Text, Vector};
use mrtphys::def::{Algorithm, Combine, ContactMode, FrictionLaw, ImpactMode, InertiaMode, Integrator};

const ANY: Range = Range { low: -1e150, high: 1e150, text: "-1e150 to 1e150" };
const SIZE: Range = Range { low: 1e-50, high: 1e50, text: "a size from 1e-50 to 1e50 m" };
const MASS: Range = Range { low: 1e-100, high: 1e100, text: "positive: 1e-100 to 1e100" };
const UNIT: Range = Range { low: 0.0, high: 1.0, text: "0 to 1" };
const FRICTION: Range = Range { low: 0.0, high: 1e6, text: "0 to 1, or up to 1e6 for 'coulomb'" };
const NOT_NEGATIVE: Range = Range { low: 0.0, high: 1e150, text: "not negative" };
const SECONDS: Range = Range { low: 0.0, high: 1e9, text: "0 to 1e9 s" };
const FOV: Range = Range { low: 1.0, high: 179.0, text: "1 to 179 degrees" };
const MEDIUM: Range = Range { low: 0.0, high: 1e30, text: "0 to 1e30 kg/m3" };

/// Most points of one shape.
pub(crate) const MOST_POINTS: usize = 1_000_000;

macro_rules! names {
    ($t:ty) => {
        || <$t>::ALL.iter().map(|(name, _)| *name).collect()
    };
}

const fn choice(names: fn() -> Vec<&'static str>) -> Kind {
    Choice { names, refused: &[] }
}

const SURFACE: &[Key] = &[
    Key::new("friction", Number(FRICTION), "friction coefficient, 0 to 1; for the law 'coulomb' any size").or("0.0"),
    Key::new("restitution", Number(UNIT), "coefficient of restitution").or("1.0"),
    Key::new("friction_combine", choice(names!(Combine)), "how friction combines with the partner's")
        .or("\"multiply\""),
    Key::new("restitution_combine", choice(names!(Combine)), "how restitution combines with the partner's")
        .or("\"multiply\""),
];

const SUBSTANCE: &[Key] = &[
    Key::new("shape", Kind::Table(&SHAPE), "the shape").required(),
    Key::new("mass", Number(MASS), "mass [kg]").or("1.0"),
    Key::new("density", Number(MASS), "density [kg/m3], instead of a mass"),
    Key::new("fixed", Bool, "infinite mass: the body never moves").or("false"),
    Key::new("material", Name, "name of a material; values given here win over it"),
    Key::new("color", Color, "color for display, #rrggbb"),
];

const POINTS_4: Kind = Kind::Points { least: 4, most: 4 };

/// A shape.
pub(crate) static SHAPE: Table = Table {
    name: "shape",
    doc: "Geometry of a body.",
    cases: &[
        Case {
            name: "sphere",
            doc: "A sphere about the origin.",
            keys: &[Key::new("radius", Number(SIZE), "radius [m]").required()],
            exactly_one: &[],
        },
        Case {
            name: "tetrahedron",
            doc: "A regular tetrahedron with the vertices (1,1,1), (1,-1,-1), (-1,1,-1), (-1,-1,1) times circumradius / sqrt 3, or any four points.",
            keys: &[
                Key::new("circumradius", Number(SIZE), "radius of the sphere through the vertices [m]"),
                Key::new("points", POINTS_4, "the four vertices [m]"),
            ],
            exactly_one: &["circumradius", "points"],
        },
        Case {
            name: "box",
            doc: "A box about the origin.",
            keys: &[Key::new("size", Vector(SIZE), "edge lengths [m]").required()],
            exactly_one: &[],
        },
        Case {
            name: "polyhedron",
            doc: "A polyhedron, convex or not; faces counter-clockwise seen from outside.",
            keys: &[
                Key::new("points", Kind::Points { least: 4, most: MOST_POINTS }, "corners [m]").required(),
                Key::new("faces", Kind::Faces, "faces: corner numbers, counted from 0").required(),
            ],
            exactly_one: &[],
        },
        Case {
            name: "convex-hull",
            doc: "The convex hull of points.",
            keys: &[Key::new("points", Kind::Points { least: 4, most: MOST_POINTS }, "points [m]").required()],
            exactly_one: &[],
        },
        Case {
            name: "quadrangle",
            doc: "A thin plane convex quadrangle; it has no volume, so it needs a mass.",
            keys: &[Key::new("points", POINTS_4, "the corners in order [m]").required()],
            exactly_one: &[],
        },
    ],
    refused: &["capsule", "cylinder", "cone", "mesh", "compound"],
    ..Table::PLAIN
};

static SIMULATION: Table = Table {
    name: "simulation",
    doc: "How the scene is simulated.",
    keys: &[&[
        Key::new("seconds", Number(SECONDS), "simulated time [s]").or("10.0"),
        Key::new("fps", Integer { low: 1, high: 1_000_000_000 }, "frames per second of simulated time").or("60"),
        Key::new("steps_per_frame", Integer { low: 1, high: 1_000_000_000 }, "physical steps per frame").or("8"),
        Key::new(
            "algorithm",
            Choice { names: names!(Algorithm), refused: &["event-driven", "rollback"] },
            "time-stepping algorithm",
        )
        .or("\"fixed-step\""),
        Key::new(
            "broad_phase",
            Kind::BroadPhase,
            "brute-force, regular-grid[:RESOLUTION], adaptive-tree[:OBJECTS_PER_CELL[:MAX_DEPTH]] or sorted-grid",
        )
        .or("\"sorted-grid\""),
        Key::new("friction_law", choice(names!(FrictionLaw)), "how an impact with friction is answered")
            .or("\"kurtenbach\""),
        Key::new("impact", choice(names!(ImpactMode)), "how simultaneous impacts are answered").or("\"sequential\""),
        Key::new("contact", choice(names!(ContactMode)), "which pair routines are used").or("\"exact\""),
        Key::new("inertia", choice(names!(InertiaMode)), "which inertia a body has").or("\"full\""),
        Key::new("integrator", choice(names!(Integrator)), "integrator of the motion between impacts")
            .or("\"parabola\""),
        Key::new("viscous_spin", Bool, "whether viscosity brakes the spin too").or("false"),
        Key::new("seed", Integer { low: 0, high: i64::MAX }, "seed of the lattices' random numbers").or("1"),
    ]],
    ..Table::PLAIN
};

static MEDIUM_TABLE: Table = Table {
    name: "medium",
    doc: "What the bodies move in.",
    keys: &[&[
        Key::new("viscosity", Number(UNIT), "v relaxes to the flow as (1 - viscosity)^(dt / 1 s)").or("0.0"),
        Key::new("density", Number(MEDIUM), "density [kg/m3], for buoyancy").or("0.0"),
    ]],
    ..Table::PLAIN
};

const SCOPE: &[Key] = &[
    Key::new("body", Name, "the body that carries the field; positions are then relative to its centre of mass"),
    Key::new("only", Kind::Names, "the bodies, lattices and body tables it acts on; missing: all"),
];
const REACTION: &[Key] =
    &[Key::new("reaction", Bool, "whether a field carried by a body of finite mass acts back on it").or("true")];

static FORCE_FIELD: Table = Table {
    name: "force_field",
    doc: "A field of acceleration.",
    keys: &[SCOPE, REACTION],
    cases: &[
        Case {
            name: "earth-gravity",
            doc: "Gravity at the earth's surface.",
            keys: &[
                Key::new("g", Number(ANY), "acceleration [m/s2]").or("9.80665"),
                Key::new("direction", Direction, "where it points").or("[0, -1, 0]"),
            ],
            exactly_one: &[],
        },
        Case {
            name: "uniform",
            doc: "The same acceleration everywhere.",
            keys: &[Key::new("acceleration", Vector(ANY), "acceleration [m/s2]").required()],
            exactly_one: &[],
        },
        Case {
            name: "point",
            doc: "Acceleration strength / r^exponent towards a point.",
            keys: &[
                Key::new("position", Vector(ANY), "the point [m]; or 'body'"),
                Key::new("strength", Number(ANY), "strength [m^(exponent+1)/s2]; negative repels").required(),
                Key::new("exponent", Integer { low: -16, high: 16 }, "exponent of the distance").or("2"),
            ],
            exactly_one: &["position", "body"],
        },
        Case {
            name: "vortex",
            doc: "Acceleration round an axis.",
            keys: &[
                Key::new("point", Vector(ANY), "a point of the axis [m]").or("[0, 0, 0]"),
                Key::new("axis", Direction, "direction of the axis").required(),
                Key::new("strength", Number(ANY), "strength [m2/s2]").required(),
            ],
            exactly_one: &[],
        },
    ],
    default_case: Some("earth-gravity"),
    ..Table::PLAIN
};

static FLOW_FIELD: Table = Table {
    name: "flow_field",
    doc: "A field of flow: motion of the medium, felt through its viscosity.",
    keys: &[SCOPE],
    cases: &[
        Case {
            name: "uniform",
            doc: "The same velocity everywhere.",
            keys: &[Key::new("velocity", Vector(ANY), "velocity [m/s]").or("[0, 0, 0]")],
            exactly_one: &[],
        },
        Case {
            name: "vortex",
            doc: "A potential vortex round an axis.",
            keys: &[
                Key::new("point", Vector(ANY), "a point of the axis [m]").or("[0, 0, 0]"),
                Key::new("axis", Direction, "direction of the axis").required(),
                Key::new("circulation", Number(ANY), "circulation [m2/s]").required(),
            ],
            exactly_one: &[],
        },
        Case {
            name: "sink",
            doc: "A point that swallows the medium.",
            keys: &[
                Key::new("point", Vector(ANY), "the point [m]").or("[0, 0, 0]"),
                Key::new("strength", Number(ANY), "volume swallowed per time [m3/s]; negative: a source").required(),
            ],
            exactly_one: &[],
        },
    ],
    default_case: Some("uniform"),
    ..Table::PLAIN
};

static MATERIAL: Table = Table {
    name: "material",
    doc: "Properties that bodies may share.",
    keys: &[SURFACE, &[Key::new("density", Number(MASS), "density [kg/m3]")]],
    ..Table::PLAIN
};

static AXIS_ANGLE: Table = Table {
    name: "axis_angle",
    doc: "A rotation.",
    keys: &[&[
        Key::new("axis", Direction, "axis of the rotation").required(),
        Key::new("angle", Number(ANY), "angle [rad]"),
        Key::new("angle_deg", Number(ANY), "angle [degrees]"),
    ]],
    at_most_one: &[&["angle", "angle_deg"]],
    ..Table::PLAIN
};

static BODY: Table = Table {
    name: "body",
    doc: "A body.",
    keys: &[
        &[
            Key::new("name", Name, "its name; missing: body0, body1 ... by its place among the bodies"),
            Key::new("position", Vector(ANY), "where the origin of the shape's coordinates is placed [m]")
                .or("[0, 0, 0]"),
            Key::new("center_of_mass", Vector(ANY), "where the centre of mass is placed [m], instead of 'position'"),
            Key::new("orientation", Kind::Quaternion, "quaternion xyzw").or("[0, 0, 0, 1]"),
            Key::new("axis_angle", Kind::Table(&AXIS_ANGLE), "orientation as axis and angle"),
            Key::new("velocity", Vector(ANY), "velocity of the centre of mass [m/s]").or("[0, 0, 0]"),
            Key::new("angular_velocity", Vector(ANY), "angular velocity [rad/s], world axes").or("[0, 0, 0]"),
            Key::new(
                "angular_momentum",
                Vector(ANY),
                "angular momentum about the centre of mass [Js], world axes, instead of 'angular_velocity'",
            ),
        ],
        SUBSTANCE,
        SURFACE,
    ],
    at_most_one: &[
        &["mass", "density"],
        &["position", "center_of_mass"],
        &["orientation", "axis_angle"],
        &["angular_velocity", "angular_momentum"],
    ],
    ..Table::PLAIN
};

static LATTICE_BODY: Table = Table {
    name: "body of a lattice",
    doc: "What a body of a lattice is made of.",
    keys: &[SUBSTANCE, SURFACE],
    at_most_one: &[&["mass", "density"]],
    ..Table::PLAIN
};

static LATTICE: Table = Table {
    name: "lattice",
    doc: "Bodies in rows and layers.",
    keys: &[&[
        Key::new("name", Name, "its name; missing: lattice0, lattice1 ... by its place among the lattices"),
        Key::new("count", Kind::Counts, "bodies along x, y and z").required(),
        Key::new("min", Vector(ANY), "lower corner of the region [m]").or("[0, 0, 0]"),
        Key::new("max", Vector(ANY), "upper corner of the region [m]").or("[1, 1, 1]"),
        Key::new("jitter", Number(UNIT), "random displacement, as a fraction of the free gap").or("0.0"),
        Key::new("speed", Number(NOT_NEGATIVE), "speed of every body [m/s], direction random").or("1.0"),
        Key::new("spin", Number(NOT_NEGATIVE), "angular speed of every body [rad/s], axis random").or("0.0"),
        Key::new("seed", Integer { low: 0, high: i64::MAX }, "its own seed; missing: the scene's plus its place"),
        Key::new("body", Kind::Tables { of: &LATTICE_BODY, least: 1 }, "what the bodies are made of, in turns")
            .required(),
    ]],
    ..Table::PLAIN
};

static BODY_TABLE: Table = Table {
    name: "body_table",
    doc: "Bodies from a file beside the scene, .csv or .bin.",
    keys: &[&[
        Key::new("name", Name, "its name; missing: body_table0, body_table1 ... by its place among the tables"),
        Key::new("file", File, "the file, relative to the scene's folder").required(),
    ]],
    ..Table::PLAIN
};

static BOUNDARY: Table = Table {
    name: "boundary",
    doc: "An immovable limit of the scene.",
    keys: &[
        &[
            Key::new("name", Name, "its name; missing: boundary0, boundary1 ... by its place among the boundaries"),
            Key::new("material", Name, "name of a material; values given here win over it"),
            Key::new("color", Color, "color for display, #rrggbb"),
        ],
        SURFACE,
    ],
    cases: &[
        Case {
            name: "box",
            doc: "Six limit quadrangles facing inward, named NAME.-x, NAME.+x ... NAME.+z.",
            keys: &[
                Key::new("min", Vector(ANY), "lower corner [m]").or("[0, 0, 0]"),
                Key::new("max", Vector(ANY), "upper corner [m]").or("[1, 1, 1]"),
            ],
            exactly_one: &[],
        },
        Case { name: "half-space", doc: "Everything behind a plane is forbidden.", keys: PLANE, exactly_one: &[] },
        Case { name: "plane", doc: "A plane that reflects from both sides.", keys: PLANE, exactly_one: &[] },
        Case {
            name: "quadrangle",
            doc: "A half-space with a finite face.",
            keys: &[
                Key::new("points", POINTS_4, "corners in order [m]").required(),
                Key::new("normal", Direction, "normal into the allowed side").required(),
            ],
            exactly_one: &[],
        },
    ],
    default_case: Some("box"),
    ..Table::PLAIN
};

const PLANE: &[Key] = &[
    Key::new("point", Vector(ANY), "a point of the plane [m]").or("[0, 0, 0]"),
    Key::new("normal", Direction, "normal into the allowed side").required(),
];

static CAMERA: Table = Table {
    name: "camera",
    doc: "Where a viewer looks from.",
    keys: &[&[
        Key::new("eye", Vector(ANY), "position of the eye [m]").or("[2, 1.5, 3]"),
        Key::new("look_at", Vector(ANY), "the point looked at [m]").or("[0.5, 0.5, 0.5]"),
        Key::new("up", Direction, "upwards").or("[0, 1, 0]"),
        Key::new("fov_deg", Number(FOV), "vertical angle of view [degrees]").or("45"),
    ]],
    ..Table::PLAIN
};

static LIGHT: Table = Table {
    name: "light",
    doc: "A light from afar.",
    keys: &[&[
        Key::new("direction", Direction, "where the light goes").or("[-1, -2, -1]"),
        Key::new("color", Color, "color, #rrggbb").or("\"#ffffff\""),
    ]],
    ..Table::PLAIN
};

/// The scene itself.
pub(crate) static SCENE: Table = Table {
    name: "scene",
    doc: "A scene of mrtphys. SI units, radians unless a name ends in _deg, right-handed, y up.",
    keys: &[&[
        Key::new("format", Integer { low: 1, high: 1 }, "version of the format").required(),
        Key::new("title", Text, "title for display").or("\"\""),
        Key::new("simulation", Kind::Table(&SIMULATION), "how the scene is simulated"),
        Key::new("medium", Kind::Table(&MEDIUM_TABLE), "what the bodies move in"),
        Key::new("force_field", Kind::Tables { of: &FORCE_FIELD, least: 0 }, "fields of acceleration"),
        Key::new("flow_field", Kind::Tables { of: &FLOW_FIELD, least: 0 }, "fields of flow"),
        Key::new("material", Kind::Map(&MATERIAL), "materials by name"),
        Key::new("body", Kind::Tables { of: &BODY, least: 0 }, "bodies"),
        Key::new("boundary", Kind::Tables { of: &BOUNDARY, least: 0 }, "immovable limits"),
        Key::new("lattice", Kind::Tables { of: &LATTICE, least: 0 }, "lattices of bodies"),
        Key::new("body_table", Kind::Tables { of: &BODY_TABLE, least: 0 }, "bodies from files"),
        Key::new("camera", Kind::Table(&CAMERA), "where a viewer looks from"),
        Key::new("light", Kind::Tables { of: &LIGHT, least: 0 }, "lights"),
    ]],
    ..Table::PLAIN
};

/// Choices that exist, but not in this version.
pub(crate) const REFUSED_BROAD_PHASES: &[&str] = &["bvh"];
