//! From text to [`Scene`].

use crate::diagnostics::{Diagnostic, Diagnostics};
use crate::format::read::{self, Findings, Record};
use crate::scene::{
    BodyDesc, BodyTableDesc, BoundaryDesc, BoundaryKind, Camera, Color, Content, FlowFieldDesc, FlowKind,
    ForceFieldDesc, ForceKind, LatticeDesc, Light, MOST_BODIES, MassDesc, Material, Placement, Scene, ScopeDesc,
    ShapeDesc, SubstanceDesc, SurfaceDesc, Turning,
};
use crate::source::{Source, Span};
use crate::table::{self, TableRows};
use mrtphys::def::{BroadPhaseKind, FrictionLaw, Settings};
use mrtphys::math::{Quat, Real, Vec3};
use std::path::Path;
use std::sync::Arc;
use toml::de::DeTable;

/// Most values in a scene text: bounds the memory of reading.
pub const MOST_VALUES: usize = 5_000_000;
/// Texts up to this size \[bytes\] are searched for more than one syntax error.
const SEARCHED_FOR_ALL: usize = 1 << 20;

impl Scene {
    /// Reads a scene file, and the body tables it names.
    ///
    /// # Errors
    /// The file cannot be read, or something in it is wrong: what, and where.
    pub fn load(path: &Path) -> Result<Scene, Diagnostics> {
        Scene::parse(Source::read(path)?)
    }

    /// Reads a scene from memory; it may name no files.
    ///
    /// # Errors
    /// Something in it is wrong: what, and where.
    pub fn from_text(name: &str, text: &str) -> Result<Scene, Diagnostics> {
        Scene::parse(Source::from_bytes(name, text.as_bytes(), None)?)
    }

    /// Reads a scene.
    ///
    /// # Errors
    /// Something in it is wrong: what, and where.
    pub fn parse(source: Source) -> Result<Scene, Diagnostics> {
        let mut found = Findings::default();
        let record = {
            let root = parse_toml(&source)?;
            read::document(root.get_ref(), Span::default(), &mut found)
        };
        finish(&source, std::mem::take(&mut found))?;
        let scene = scene(&source, &record, &mut found);
        check_names(&scene, &record, &mut found);
        check_friction(&scene, &record, &mut found);
        finish(&source, found)?;
        load_tables(scene)
    }
}

/// The findings as diagnostics, if there are any.
fn finish(source: &Source, found: Findings) -> Result<(), Diagnostics> {
    if found.list.is_empty() {
        return Ok(());
    }
    Err(report(source, found))
}

/// The findings as diagnostics.
pub(crate) fn report(source: &Source, mut found: Findings) -> Diagnostics {
    // In the order of the text; a line number costs a pass over the text, so it is asked for the reported ones only.
    found.list.sort_by_key(|(span, _)| span.start);
    let shown = found.list.len().min(crate::diagnostics::MOST_REPORTED);
    let more = found.list.len() - shown + found.more;
    let list = found.list.into_iter().take(shown).map(|(span, m)| source.diagnostic(span, m)).collect();
    let mut all = Diagnostics::new(list);
    all.more += more;
    all
}

fn parse_toml(source: &Source) -> Result<toml::Spanned<DeTable<'_>>, Diagnostics> {
    let text: &str = &source.text;
    // Every value but the first of a list follows one of these. More of them in strings and comments do no harm.
    let values = text.bytes().filter(|b| matches!(b, b',' | b'=' | b'[')).count();
    if values > MOST_VALUES {
        let message = format!("more than {MOST_VALUES} values; put many bodies into a [[body_table]]");
        return Err(Diagnostic::without_place(&source.name, message).into());
    }
    DeTable::parse(text).map_err(|first| {
        let errors = match text.len() <= SEARCHED_FOR_ALL {
            true => DeTable::parse_recoverable(text).1,
            false => vec![first],
        };
        let mut found = Findings::default();
        for e in &errors {
            let span = e.span().unwrap_or(0..0);
            found.push(span.start.min(text.len())..span.end.min(text.len()), format!("syntax: {}", e.message()));
        }
        report(source, found)
    })
}

fn scene(source: &Source, r: &Record, found: &mut Findings) -> Scene {
    let simulation = r.table("simulation");
    Scene {
        source: source.clone(),
        title: r.text("title").unwrap_or_default(),
        seconds: simulation.and_then(|s| s.number("seconds")).unwrap_or(10.0),
        settings: settings(simulation, r.table("medium")),
        seed: simulation.and_then(|s| s.integer("seed")).unwrap_or(1) as u64,
        force_fields: r.tables("force_field").iter().map(force_field).collect(),
        flow_fields: r.tables("flow_field").iter().map(flow_field).collect(),
        materials: r.map("material").iter().map(|(name, m)| material(name, m)).collect(),
        contents: contents(r, found),
        boundaries: r.tables("boundary").iter().enumerate().map(|(i, b)| boundary(i, b, found)).collect(),
        camera: r.table("camera").map(camera),
        lights: r.tables("light").iter().map(light).collect(),
    }
}

fn settings(simulation: Option<&Record>, medium: Option<&Record>) -> Settings {
    let d = Settings::default();
    let mut s = match simulation {
        None => d,
        Some(r) => Settings {
            algorithm: r.choice("algorithm").unwrap_or(d.algorithm),
            broad_phase: r.choice::<BroadPhaseKind>("broad_phase").unwrap_or(d.broad_phase),
            friction_law: r.choice("friction_law").unwrap_or(d.friction_law),
            impact: r.choice("impact").unwrap_or(d.impact),
            contact: r.choice("contact").unwrap_or(d.contact),
            inertia: r.choice("inertia").unwrap_or(d.inertia),
            integrator: r.choice("integrator").unwrap_or(d.integrator),
            fps: r.integer("fps").map_or(d.fps, |n| n as u32),
            steps_per_frame: r.integer("steps_per_frame").map_or(d.steps_per_frame, |n| n as u32),
            viscous_spin: r.bool("viscous_spin").unwrap_or(d.viscous_spin),
            ..d
        },
    };
    if let Some(m) = medium {
        s.viscosity = m.number("viscosity").unwrap_or(s.viscosity);
        s.medium_density = m.number("density").unwrap_or(s.medium_density);
    }
    s
}

fn scope(r: &Record) -> ScopeDesc {
    ScopeDesc {
        carrier: r.text("body"),
        only: r.names("only"),
        reaction: r.bool("reaction").unwrap_or(true),
        span: r.span,
    }
}

fn force_field(r: &Record) -> ForceFieldDesc {
    let vector = |key| r.vector(key).unwrap_or(Vec3::ZERO);
    let strength = r.number("strength").unwrap_or(0.0);
    let kind = match r.case_name() {
        "uniform" => ForceKind::Uniform { acceleration: vector("acceleration") },
        "point" => ForceKind::Point {
            position: vector("position"),
            strength,
            exponent: r.integer("exponent").unwrap_or(2) as i32,
        },
        "vortex" => ForceKind::Vortex { point: vector("point"), axis: vector("axis"), strength },
        _ => ForceKind::EarthGravity {
            g: r.number("g").unwrap_or(9.80665),
            direction: r.vector("direction").unwrap_or(Vec3::new(0.0, -1.0, 0.0)),
        },
    };
    ForceFieldDesc { kind, scope: scope(r) }
}

fn flow_field(r: &Record) -> FlowFieldDesc {
    let vector = |key| r.vector(key).unwrap_or(Vec3::ZERO);
    let number = |key| r.number(key).unwrap_or(0.0);
    let kind = match r.case_name() {
        "vortex" => {
            FlowKind::Vortex { point: vector("point"), axis: vector("axis"), circulation: number("circulation") }
        }
        "sink" => FlowKind::Sink { point: vector("point"), strength: number("strength") },
        _ => FlowKind::Uniform { velocity: vector("velocity") },
    };
    FlowFieldDesc { kind, scope: scope(r) }
}

fn surface(r: &Record) -> SurfaceDesc {
    SurfaceDesc {
        friction: r.number("friction"),
        restitution: r.number("restitution"),
        friction_combine: r.choice("friction_combine"),
        restitution_combine: r.choice("restitution_combine"),
    }
}

fn material(name: &str, r: &Record) -> Material {
    Material { name: name.to_string(), density: r.number("density"), surface: surface(r) }
}

fn color(r: &Record) -> Option<Color> {
    r.text("color").and_then(|c| Color::parse(&c))
}

/// Bodies, lattices and body tables in the order of the text.
fn contents(r: &Record, found: &mut Findings) -> Vec<Content> {
    let mut all: Vec<Content> = Vec::new();
    all.extend(r.tables("body").iter().enumerate().map(|(i, b)| Content::Body(body(i, b, found))));
    all.extend(r.tables("lattice").iter().enumerate().map(|(i, l)| Content::Lattice(lattice(i, l, found))));
    all.extend(r.tables("body_table").iter().enumerate().map(|(i, t)| Content::Table(body_table(i, t))));
    all.sort_by_key(|c| c.span().start);
    check_count(&all, found);
    all
}

/// A scene may not hold more than [`MOST_BODIES`]; said before any of them is made.
pub(crate) fn check_count(all: &[Content], found: &mut Findings) {
    let bodies = all.iter().map(Content::count).fold(0, u64::saturating_add);
    if bodies > MOST_BODIES {
        let last = all.last().map_or(Span::default(), Content::span);
        found.push(last, format!("scene: {bodies} bodies are more than the {MOST_BODIES} that a scene may hold"));
    }
}

fn name_of(r: &Record, kind: &str, place: usize) -> String {
    r.text("name").unwrap_or_else(|| format!("{kind}{place}"))
}

fn body(place: usize, r: &Record, found: &mut Findings) -> BodyDesc {
    let name = name_of(r, "body", place);
    let placement = match r.vector("center_of_mass") {
        Some(c) => Placement::CenterOfMass(c),
        None => Placement::Origin(r.vector("position").unwrap_or(Vec3::ZERO)),
    };
    let turning = match r.vector("angular_momentum") {
        Some(l) => Turning::Momentum(l),
        None => Turning::Velocity(r.vector("angular_velocity").unwrap_or(Vec3::ZERO)),
    };
    let orientation = match r.table("axis_angle") {
        Some(a) => axis_angle(a),
        None => r.quaternion("orientation").unwrap_or(Quat::IDENTITY),
    };
    BodyDesc {
        substance: substance(&format!("body '{name}'"), r, found),
        name,
        placement,
        orientation,
        velocity: r.vector("velocity").unwrap_or(Vec3::ZERO),
        turning,
        span: r.span,
    }
}

fn axis_angle(r: &Record) -> Quat {
    let axis = r.vector("axis").and_then(Vec3::try_normalize).unwrap_or(Vec3::X);
    let angle = match r.number("angle_deg") {
        Some(degrees) => degrees * (std::f64::consts::PI / 180.0),
        None => r.number("angle").unwrap_or(0.0),
    };
    Quat::from_axis_angle(axis, angle)
}

fn substance(object: &str, r: &Record, found: &mut Findings) -> SubstanceDesc {
    let fixed = r.bool("fixed").unwrap_or(false);
    let mass = match (r.number("mass"), r.number("density")) {
        (None, None) if fixed => MassDesc::Fixed,
        (Some(_), _) | (_, Some(_)) if fixed => {
            let key = if r.number("mass").is_some() { "mass" } else { "density" };
            found.push(r.span_of(key), format!("{object}: {key}: a fixed body has infinite mass; leave '{key}' out"));
            MassDesc::Fixed
        }
        (Some(m), _) => MassDesc::Value(m),
        (_, Some(d)) => MassDesc::Density(d),
        (None, None) => MassDesc::Unset,
    };
    SubstanceDesc {
        shape: shape(object, r, found),
        mass,
        material: r.text("material"),
        surface: surface(r),
        color: color(r),
        shape_span: r.span_of("shape"),
    }
}

fn four(points: Vec<Vec3>) -> [Vec3; 4] {
    points.try_into().unwrap_or([Vec3::ZERO; 4])
}

fn shape(object: &str, r: &Record, found: &mut Findings) -> ShapeDesc {
    let Some(s) = r.table("shape") else { return ShapeDesc::Sphere { radius: 1.0 } };
    let points = || s.points("points").unwrap_or_default();
    match s.case_name() {
        "tetrahedron" => match s.number("circumradius") {
            Some(circumradius) => ShapeDesc::Tetrahedron { circumradius },
            None => ShapeDesc::TetrahedronPoints(four(points())),
        },
        "box" => ShapeDesc::Cuboid { size: s.vector("size").unwrap_or(Vec3::ZERO) },
        "polyhedron" => {
            let (points, faces) = (points(), s.faces("faces").unwrap_or_default());
            if let Some(face) = faces.iter().position(|f| f.iter().any(|&c| c as usize >= points.len())) {
                let n = points.len();
                found.push(
                    s.span_of("faces"),
                    format!("{object}: shape.faces: face {face} names a corner beyond the {n} points"),
                );
            }
            ShapeDesc::Polyhedron { points: points.into(), faces: faces.into() }
        }
        "convex-hull" => ShapeDesc::ConvexHull { points: points().into() },
        "quadrangle" => ShapeDesc::Quadrangle(four(points())),
        _ => ShapeDesc::Sphere { radius: s.number("radius").unwrap_or(0.0) },
    }
}

fn lattice(place: usize, r: &Record, found: &mut Findings) -> LatticeDesc {
    let name = name_of(r, "lattice", place);
    let (min, max) = corners(r);
    let object = format!("lattice '{name}'");
    check_corners(&object, min, max, r, found);
    LatticeDesc {
        bodies: r
            .tables("body")
            .iter()
            .enumerate()
            .map(|(i, b)| substance(&format!("{object}: body[{i}]"), b, found))
            .collect(),
        count: r.counts("count").unwrap_or([1; 3]),
        min,
        max,
        jitter: r.number("jitter").unwrap_or(0.0),
        speed: r.number("speed").unwrap_or(1.0),
        spin: r.number("spin").unwrap_or(0.0),
        seed: r.integer("seed").map(|s| s as u64),
        place: place as u64,
        span: r.span,
        name,
    }
}

fn corners(r: &Record) -> (Vec3, Vec3) {
    (r.vector("min").unwrap_or(Vec3::ZERO), r.vector("max").unwrap_or(Vec3::splat(1.0)))
}

fn check_corners(object: &str, min: Vec3, max: Vec3, r: &Record, found: &mut Findings) {
    if !(min.x < max.x && min.y < max.y && min.z < max.z) {
        found.push(r.span_of("max"), format!("{object}: max must be greater than min along every axis"));
    }
}

fn body_table(place: usize, r: &Record) -> BodyTableDesc {
    BodyTableDesc {
        name: name_of(r, "body_table", place),
        file: r.text("file").unwrap_or_default(),
        rows: Arc::new(TableRows::default()),
        span: r.span,
    }
}

fn boundary(place: usize, r: &Record, found: &mut Findings) -> BoundaryDesc {
    let point = r.vector("point").unwrap_or(Vec3::ZERO);
    let normal = r.vector("normal").unwrap_or(Vec3::ZERO);
    let (min, max) = corners(r);
    if r.case_name() == "box" {
        check_corners(&format!("boundary '{}'", name_of(r, "boundary", place)), min, max, r, found);
    }
    let kind = match r.case_name() {
        "half-space" => BoundaryKind::HalfSpace { point, normal },
        "plane" => BoundaryKind::Plane { point, normal },
        "quadrangle" => BoundaryKind::Quadrangle { points: four(r.points("points").unwrap_or_default()), normal },
        _ => BoundaryKind::Box { min, max },
    };
    BoundaryDesc {
        name: name_of(r, "boundary", place),
        kind,
        surface: surface(r),
        material: r.text("material"),
        color: color(r),
        span: r.span,
    }
}

fn camera(r: &Record) -> Camera {
    let d = Camera::default();
    Camera {
        eye: r.vector("eye").unwrap_or(d.eye),
        look_at: r.vector("look_at").unwrap_or(d.look_at),
        up: r.vector("up").unwrap_or(d.up),
        fov_deg: r.number("fov_deg").unwrap_or(d.fov_deg),
    }
}

fn light(r: &Record) -> Light {
    let d = Light::default();
    Light { direction: r.vector("direction").unwrap_or(d.direction), color: color(r).unwrap_or(d.color) }
}

/// Every material that is named must be there.
fn check_names(scene: &Scene, record: &Record, found: &mut Findings) {
    let known = |m: &str| scene.materials.binary_search_by(|k| k.name.as_str().cmp(m)).is_ok();
    each_surface(scene, record, |object, r| {
        if let Some(name) = r.text("material")
            && !known(&name)
        {
            let at = r.span_of("material");
            let names: Vec<&str> = scene.materials.iter().map(|m| m.name.as_str()).collect();
            let tip = read::tip(&name, &names);
            found.push(at, format!("{object}: material: there is no material '{name}'{tip}"));
        }
    });
}

/// Friction above 1 is for `coulomb` only.
fn check_friction(scene: &Scene, record: &Record, found: &mut Findings) {
    if scene.settings.friction_law == FrictionLaw::Coulomb {
        return;
    }
    let law = scene.settings.friction_law;
    each_surface(scene, record, |object, r| {
        if let Some(value) = r.number("friction").filter(|f| *f > LARGEST_FRICTION) {
            let at = r.span_of("friction");
            found.push(at, format!("{object}: {}", friction_message(value, law)));
        }
    });
}

/// Largest friction coefficient of the thesis's laws.
pub(crate) const LARGEST_FRICTION: Real = 1.0;

pub(crate) fn friction_message(value: Real, law: FrictionLaw) -> String {
    format!("friction = {value:?} is out of range: 0 to 1 for the friction law '{law}'")
}

/// Calls for every record that describes a surface.
fn each_surface(scene: &Scene, record: &Record, mut call: impl FnMut(&str, &Record)) {
    for (name, r) in record.map("material") {
        call(&format!("material '{name}'"), r);
    }
    for (i, r) in record.tables("body").iter().enumerate() {
        call(&format!("body '{}'", name_of(r, "body", i)), r);
    }
    for (i, r) in record.tables("lattice").iter().enumerate() {
        let name = name_of(r, "lattice", i);
        for (k, b) in r.tables("body").iter().enumerate() {
            call(&format!("lattice '{name}': body[{k}]"), b);
        }
    }
    for (b, r) in scene.boundaries.iter().zip(record.tables("boundary")) {
        call(&format!("boundary '{}'", b.name), r);
    }
}

/// Reads the files of the body tables.
fn load_tables(mut scene: Scene) -> Result<Scene, Diagnostics> {
    let mut left = MOST_BODIES - scene.contents.iter().map(Content::count).sum::<u64>();
    let (source, materials) = (scene.source.clone(), scene.materials.clone());
    for content in &mut scene.contents {
        if let Content::Table(t) = content {
            let rows = table::load(&source, t, &materials, left)?;
            left -= rows.len() as u64;
            t.rows = Arc::new(rows);
        }
    }
    Ok(scene)
}
