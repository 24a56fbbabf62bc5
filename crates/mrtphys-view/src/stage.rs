//! From a world to a picture: which body is drawn with which surface in which color, and where it is.

use crate::camera::{Camera, Ray};
use crate::dress::{Dress, Legend, Paint};
use crate::frame::{Batch, Frame, Highlighted, Instance, Light, Look, Wall};
use crate::mesh::Mesh;
use crate::palette::{Rgb, default_color, varied};
use crate::pick::{self, Hit};
use crate::poses::Poses;
use crate::walls;
use mrtphys::bounds::{Aabb, Ball};
use mrtphys::contact::Other;
use mrtphys::math::Quat;
use mrtphys::model::Inertia;
use mrtphys::shape::{Polyhedron, Quadrangle, Shape, Sphere};
use mrtphys::{BodyId, Real, Vec3, World};
use mrtphys_scene::Loaded;
use std::collections::BTreeMap;
use std::sync::Arc;

/// Where a viewer looks from unless the scene says it: to the front right and from above.
const FROM: Vec3 = Vec3::new(1.5, 1.0, 2.5);
/// Strength of the viewer's own light beside the first light of a scene without lights.
const FILL: f32 = 0.16;

/// A body as it is drawn.
#[derive(Clone, Debug)]
struct Actor {
    id: BodyId,
    /// number of a surface; `None`: a sphere
    mesh: Option<u32>,
    /// largest distance of a drawn point from the body's origin \[m\]
    reach: Real,
    color: Rgb,
    shape: Arc<dyn Shape>,
    /// smallest enclosing sphere, in the body's own coordinates
    ball: Ball,
    /// number of the name of its kind
    kind: u32,
    /// mass \[kg\]
    mass: Real,
    inertia: Inertia,
}

/// What the bodies and boundaries of a world look like. Made once for a scene, and again when bodies come or go.
pub struct Stage {
    actors: Vec<Actor>,
    /// number of the actor by the first part of the body's handle; beyond the actors: none
    numbers: Vec<u32>,
    kinds: Vec<String>,
    meshes: Vec<Arc<Mesh>>,
    walls: Vec<Wall>,
    lights: Vec<Light>,
    camera: Camera,
    bounds: Aabb,
}

impl Stage {
    /// Looks at a world as it is now.
    pub fn new(loaded: &Loaded) -> Stage {
        let mut cast = Casting::default();
        let world = &loaded.world;
        let actors: Vec<Actor> = world.bodies().filter_map(|id| cast.actor(loaded, id)).collect();
        let bounds = bounds_of(loaded, &actors);
        let camera = loaded.scene.camera.map(Camera::from).unwrap_or_else(|| {
            let mut camera = Camera { eye: FROM, look_at: Vec3::ZERO, up: Vec3::Y, fov_deg: 35.0 };
            camera.fit(&bounds, 1.0);
            camera
        });
        let lights = &loaded.scene.lights;
        let strength = 1.0 / (lights.len().max(1) as f32).sqrt();
        let light = |l: &mrtphys_scene::scene::Light| Light { direction: l.direction, color: l.color.rgb, strength };
        let lights = lights.iter().map(light).collect();
        let walls = walls::walls_of(loaded, &bounds, camera.up.try_normalize().unwrap_or(Vec3::Y));
        let numbers = numbers_of(&actors);
        Stage { actors, numbers, kinds: cast.kinds, meshes: cast.meshes, walls, lights, camera, bounds }
    }

    /// How many bodies there are.
    pub fn body_count(&self) -> usize {
        self.actors.len()
    }

    /// The bodies, in the order of the poses.
    pub fn bodies(&self) -> impl ExactSizeIterator<Item = BodyId> + '_ {
        self.actors.iter().map(|a| a.id)
    }

    /// The number of a body in the stage and its poses; `None`: it is not of this stage.
    pub fn index(&self, id: BodyId) -> Option<usize> {
        let number = *self.numbers.get(id.to_parts().0 as usize)? as usize;
        (self.actors.get(number)?.id == id).then_some(number)
    }

    /// The body of a number.
    pub fn body(&self, index: usize) -> Option<BodyId> {
        self.actors.get(index).map(|a| a.id)
    }

    /// The body's own color. Panics if there is no body of this number, as do the following.
    pub fn color(&self, index: usize) -> Rgb {
        self.actors[index].color
    }

    /// The name of the kind of the body's shape.
    pub fn kind(&self, index: usize) -> &str {
        &self.kinds[self.actors[index].kind as usize]
    }

    /// Whether the body never moves: its mass is infinite.
    pub fn is_fixed(&self, index: usize) -> bool {
        self.actors[index].mass == Real::INFINITY
    }

    /// Largest distance of a drawn point from the body's origin \[m\].
    pub fn reach(&self, index: usize) -> Real {
        self.actors[index].reach
    }

    /// Smallest enclosing sphere of the body, in its own coordinates.
    pub fn bounding_sphere(&self, index: usize) -> Ball {
        self.actors[index].ball
    }

    /// Whether the body is drawn as a sphere about its origin.
    pub fn is_sphere(&self, index: usize) -> bool {
        self.actors[index].mesh.is_none()
    }

    /// Kinetic energy \[J\] of the body with this orientation and these velocities, with the mass that it had when the stage
    /// was made; zero for one that never moves.
    pub fn kinetic_energy(&self, index: usize, orientation: Quat, velocity: Vec3, angular_velocity: Vec3) -> Real {
        let Actor { mass, inertia, .. } = &self.actors[index];
        if *mass == Real::INFINITY {
            return 0.0;
        }
        let momentum = inertia.angular_momentum(orientation, angular_velocity);
        0.5 * (mass * velocity.length_squared() + momentum.dot(angular_velocity))
    }

    /// The kinds of shape that there are.
    pub fn kinds(&self) -> &[String] {
        &self.kinds
    }

    /// The front-most body that a ray meets, exactly: a sphere, or the triangles of a polyhedron, entered from outside; a plate
    /// from either side. As in the picture of [`Camera::ray`]'s camera, whatever its [`Look`].
    pub fn pick(&self, poses: &Poses, ray: Ray) -> Option<Hit> {
        let mut best: Option<Hit> = None;
        let mut most = Real::INFINITY;
        let placed = self.actors.iter().zip(&poses.positions).zip(&poses.orientations);
        for (index, ((actor, &position), &q)) in placed.enumerate() {
            if !pick::comes_near(&ray, position, actor.reach, most) {
                continue;
            }
            let found = pick::enters(&ray, &*actor.shape, actor.reach, position, q);
            if let Some(distance) = found.filter(|d| *d < most) {
                most = distance;
                best = Some(Hit { body: actor.id, index, point: ray.at(distance), distance });
            }
        }
        best
    }

    /// Counts the contacts of every body in the world's last step, in the order of the stage.
    pub fn count_contacts(&self, world: &World, counts: &mut Vec<u32>) {
        counts.clear();
        counts.resize(self.actors.len(), 0);
        let mut count = |slot: u32| {
            if let Some(i) = world.body_in_slot(slot).and_then(|id| self.index(id)) {
                counts[i] += 1;
            }
        };
        for contact in &world.contacts().list {
            count(contact.a);
            if let Other::Body(b) = contact.b {
                count(b);
            }
        }
    }

    /// The scene's camera, else one that shows everything.
    pub fn camera(&self) -> Camera {
        self.camera
    }

    /// A box round the bodies as they were, and the finite boundaries.
    pub fn bounds(&self) -> Aabb {
        self.bounds
    }

    /// Reads where the bodies are now. One that is gone stays where the poses had it, out of sight.
    pub fn read(&self, world: &World, poses: &mut Poses) {
        poses.positions.clear();
        poses.orientations.clear();
        for actor in &self.actors {
            let gone = (Vec3::splat(Real::NAN), Quat::IDENTITY);
            let (position, orientation) = world.pose(actor.id).unwrap_or(gone);
            poses.positions.push(position);
            poses.orientations.push(orientation);
        }
    }

    /// Fills a picture of the bodies as the scene colors them. Its overlay is left as it is.
    pub fn fill(&self, camera: Camera, look: Look, poses: &Poses, frame: &mut Frame) {
        self.fill_dressed(camera, look, &Dress::default(), poses, frame);
    }

    /// Fills a picture of the bodies in this dress. Its overlay is left as it is. Returns what the colors mean; `None`: they are
    /// the bodies' own, because that was asked for or what the coloring needs is missing or not of as many bodies.
    pub fn fill_dressed(
        &self,
        camera: Camera,
        look: Look,
        dress: &Dress<'_>,
        poses: &Poses,
        frame: &mut Frame,
    ) -> Option<Legend> {
        frame.restart(camera, look);
        if frame.batches.len() != self.meshes.len()
            || !frame.batches.iter().zip(&self.meshes).all(|(b, m)| Arc::ptr_eq(&b.mesh, m))
        {
            frame.batches = self.meshes.iter().map(|m| Batch { mesh: m.clone(), instances: Vec::new() }).collect();
        }
        let paint = Paint::new(self, dress, look.theme, poses);
        let placed = self.actors.iter().zip(&poses.positions).zip(&poses.orientations);
        for (i, ((actor, &position), &q)) in placed.enumerate() {
            let [r, g, b] = paint.color(i);
            let Some(instance) = frame.instance(position, actor.reach, q, [r, g, b, 255]) else { continue };
            match actor.mesh {
                None => frame.spheres.push(Instance { marks: look.marks.into(), ..instance }),
                Some(m) => frame.batches[m as usize].instances.push(instance),
            }
        }
        self.outline(dress, poses, frame);
        self.surroundings(camera, look, poses, frame);
        paint.legend()
    }

    fn outline(&self, dress: &Dress<'_>, poses: &Poses, frame: &mut Frame) {
        for &i in dress.highlight {
            let Some(actor) = self.actors.get(i) else { continue };
            let (Some(&position), Some(&q)) = (poses.positions.get(i), poses.orientations.get(i)) else { continue };
            if let Some(body) = frame.instance(position, actor.reach, q, [255; 4]) {
                frame.highlight.push(Highlighted { batch: actor.mesh.map(|m| m as usize), body });
            }
        }
    }

    fn surroundings(&self, camera: Camera, look: Look, poses: &Poses, frame: &mut Frame) {
        if look.walls {
            // Where the bodies have come to: what is not finite is left out.
            let there = poses.positions.iter().copied().filter(|p| p.is_finite());
            let bodies =
                if self.walls.iter().any(|w| w.endless.is_some()) { Aabb::of_points(there) } else { self.bounds };
            frame.walls.extend(self.walls.iter().map(|w| walls::grown(w, &bodies)));
        }
        if self.lights.is_empty() {
            frame.lights.extend(default_lights(&camera));
        } else {
            frame.lights.extend_from_slice(&self.lights);
        }
    }
}

/// One light from above, and a weak one from the viewer, so that no side is black.
fn default_lights(camera: &Camera) -> [Light; 2] {
    let axes = camera.axes();
    let own = axes.forward - axes.up * 0.3 - axes.right * 0.5;
    let key = mrtphys_scene::scene::Light::default();
    [
        Light { direction: key.direction, color: [255, 251, 244], strength: 1.0 },
        Light { direction: own, color: [232, 240, 255], strength: FILL },
    ]
}

/// A picture of a world as it is now, from the scene's camera.
pub fn frame_of(loaded: &Loaded, look: Look) -> Frame {
    let stage = Stage::new(loaded);
    let mut poses = Poses::default();
    stage.read(&loaded.world, &mut poses);
    let mut frame = Frame::new(stage.camera(), look);
    stage.fill(stage.camera(), look, &poses, &mut frame);
    frame
}

fn numbers_of(actors: &[Actor]) -> Vec<u32> {
    let place = |a: &Actor| a.id.to_parts().0 as usize;
    let mut numbers = vec![u32::MAX; actors.iter().map(|a| place(a) + 1).max().unwrap_or(0)];
    actors.iter().enumerate().for_each(|(i, a)| numbers[place(a)] = i as u32);
    numbers
}

fn bounds_of(loaded: &Loaded, actors: &[Actor]) -> Aabb {
    let around = |a: &Actor| {
        let (p, _) = loaded.world.pose(a.id).ok()?;
        let reach = Vec3::splat(a.reach);
        p.is_finite().then_some([p - reach, p + reach])
    };
    let bodies = actors.iter().filter_map(around).flatten();
    let bounds = Aabb::of_points(bodies.chain(walls::finite_corners(loaded)));
    if bounds.min.is_finite() && bounds.max.is_finite() {
        bounds
    } else {
        Aabb { min: Vec3::splat(-1.0), max: Vec3::splat(1.0) }
    }
}

/// Finds a surface for each body; similar bodies share one.
#[derive(Default)]
struct Casting {
    kinds: Vec<String>,
    meshes: Vec<Arc<Mesh>>,
    /// surface by the bits of its single-precision corners
    by_form: BTreeMap<Vec<u32>, u32>,
    /// the latest shape and what was found for it: bodies of the same shape often follow each other
    latest: Vec<(Arc<dyn Shape>, Option<u32>, Real)>,
}

/// How many of the latest shapes are remembered.
const REMEMBERED: usize = 16;

impl Casting {
    fn actor(&mut self, loaded: &Loaded, id: BodyId) -> Option<Actor> {
        let body = loaded.world.body(id).ok()?;
        let (mesh, reach) = self.surface(&body.shape);
        let number = id.to_parts().0 as usize;
        let by_default = || varied(default_color(&body.kind, body.mass == Real::INFINITY), number);
        let color = loaded.color(id).map_or_else(by_default, |c| c.rgb);
        let kind = self.kind(&body.kind);
        let ball = body.shape.bounding_sphere();
        Some(Actor { id, mesh, reach, color, shape: body.shape, ball, kind, mass: body.mass, inertia: body.inertia })
    }

    fn kind(&mut self, name: &str) -> u32 {
        let found = self.kinds.iter().position(|k| k == name);
        found.unwrap_or_else(|| {
            self.kinds.push(name.to_string());
            self.kinds.len() - 1
        }) as u32
    }

    fn surface(&mut self, shape: &Arc<dyn Shape>) -> (Option<u32>, Real) {
        if let Some((_, mesh, reach)) = self.latest.iter().find(|(s, ..)| Arc::ptr_eq(s, shape)) {
            return (*mesh, *reach);
        }
        let (mesh, reach) = self.new_surface(&**shape);
        if self.latest.len() == REMEMBERED {
            self.latest.remove(0);
        }
        self.latest.push((shape.clone(), mesh, reach));
        (mesh, reach)
    }

    /// A shape that is none of the library's is drawn as its bounding sphere.
    fn new_surface(&mut self, shape: &dyn Shape) -> (Option<u32>, Real) {
        let farthest = |points: &[Vec3]| points.iter().map(|p| p.length()).fold(0.0, Real::max);
        if let Some(s) = shape.downcast::<Sphere>() {
            (None, s.radius())
        } else if let Some(p) = shape.downcast::<Polyhedron>() {
            let reach = farthest(p.corners());
            (Some(self.mesh(Mesh::polyhedron(p, reach))), reach)
        } else if let Some(q) = shape.downcast::<Quadrangle>() {
            let reach = farthest(q.corners());
            (Some(self.mesh(Mesh::quadrangle(q, reach))), reach)
        } else {
            let ball = shape.bounding_sphere();
            (None, ball.center.length() + ball.radius)
        }
    }

    fn mesh(&mut self, mesh: Mesh) -> u32 {
        let corners = mesh.vertices.iter().flat_map(|v| v.position);
        let form: Vec<u32> = corners.map(f32::to_bits).chain(mesh.triangles.iter().flatten().copied()).collect();
        *self.by_form.entry(form).or_insert_with(|| {
            self.meshes.push(Arc::new(mesh));
            self.meshes.len() as u32 - 1
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use mrtphys_scene::{Scene, gallery};

    fn loaded(text: &str) -> Loaded {
        Scene::from_text("test", text).unwrap().build().unwrap()
    }

    #[test]
    fn every_body_of_every_small_gallery_scene_is_in_the_picture() {
        for (name, text) in gallery().iter().filter(|(name, _)| !name.ends_with("100k")) {
            let loaded = loaded(text);
            let frame = frame_of(&loaded, Look::default());
            assert_eq!(frame.bodies().count(), loaded.world.body_count(), "{name}");
            assert!(frame.walls.len() >= loaded.world.boundaries().len(), "{name}");
            assert!(frame.batches.len() <= 8, "{name}: similar bodies share a surface");
            let all = frame.bodies().all(|b| b.scale > 0.0 && b.position.iter().all(|x| x.is_finite()));
            assert!(all, "{name}");
        }
    }

    #[test]
    fn scaled_bodies_share_a_surface() {
        let body = |r: f64| {
            format!(
                "[[body]]\nposition = [{}, 0, 0]\nshape = {{ kind = \"tetrahedron\", circumradius = {r} }}\n",
                r * 8.0
            )
        };
        let text: String = [0.5, 1.0, 4.0].map(body).concat();
        let frame = frame_of(&loaded(&format!("format = 1\n{text}")), Look::default());
        assert_eq!((frame.batches.len(), frame.batches[0].instances.len()), (1, 3));
        let scale = |i: usize| frame.batches[0].instances[i].scale;
        assert_eq!((scale(1) / scale(0), scale(2) / scale(1)), (2.0, 4.0));
    }

    #[test]
    fn a_picture_does_not_depend_on_the_unit_of_length() {
        let scene = |k: f64| {
            loaded(&format!(
                "format = 1\n[[body]]\nshape = {{ kind = \"sphere\", radius = {:e} }}\nposition = [{:e}, 0, 0]\n[camera]\neye = [0, 0, {:e}]\nlook_at = [0, 0, 0]\n",
                0.5 * k,
                2.0 * k,
                8.0 * k
            ))
        };
        let small = frame_of(&scene(2f64.powi(-60)), Look::default());
        let large = frame_of(&scene(2f64.powi(60)), Look::default());
        assert_eq!(small.spheres, large.spheres);
        assert_eq!(small.spheres[0].position, [0.25, 0.0, 0.0]);
    }

    #[test]
    fn filling_again_allocates_no_new_lists() {
        let loaded = loaded(mrtphys_scene::gallery_scene("thesis/cube-4").unwrap());
        let stage = Stage::new(&loaded);
        let mut poses = Poses::default();
        stage.read(&loaded.world, &mut poses);
        let mut frame = Frame::new(stage.camera(), Look::default());
        stage.fill(stage.camera(), Look::default(), &poses, &mut frame);
        let places = |f: &Frame, p: &Poses| {
            (f.spheres.as_ptr(), f.batches[0].instances.as_ptr(), f.walls.as_ptr(), p.positions.as_ptr())
        };
        let before = places(&frame, &poses);
        stage.read(&loaded.world, &mut poses);
        stage.fill(stage.camera(), Look::default(), &poses, &mut frame);
        assert_eq!(before, places(&frame, &poses));
    }

    #[test]
    fn contacts_are_counted_for_the_bodies_that_have_them_wherever_they_are_stored() {
        let mut loaded = loaded(mrtphys_scene::gallery_scene("thesis/cube-4").unwrap());
        let stage = Stage::new(&loaded);
        let mut counts = Vec::new();
        let mut seen = 0;
        for _ in 0..60 {
            loaded.world.sort_storage();
            loaded.world.frame().unwrap();
            stage.count_contacts(&loaded.world, &mut counts);
            let list = &loaded.world.contacts().list;
            let sides = list.iter().map(|c| if matches!(c.b, Other::Body(_)) { 2 } else { 1 });
            assert_eq!(counts.iter().sum::<u32>(), sides.sum::<u32>());
            for contact in list {
                // The point lies on the body that is said to touch there.
                let id = loaded.world.body_in_slot(contact.a).unwrap();
                let i = stage.index(id).unwrap();
                assert!(counts[i] > 0 && stage.body(i) == Some(id));
                let distance = (loaded.world.pose(id).unwrap().0 - contact.point).length();
                assert!(distance < 1.2 * stage.reach(i), "{distance} of {}", stage.reach(i));
                seen += 1;
            }
        }
        assert!(seen > 20, "{seen}");
        assert_eq!(loaded.world.body_in_slot(u32::MAX), None);
        assert_eq!((stage.index(BodyId::from_parts(0, 9, 9)), stage.body(9999)), (None, None));
    }

    #[test]
    fn a_body_that_cannot_be_drawn_is_left_out() {
        let mut poses = Poses::default();
        let loaded = loaded(mrtphys_scene::gallery_scene("cradle").unwrap());
        let stage = Stage::new(&loaded);
        stage.read(&loaded.world, &mut poses);
        poses.positions[0] = Vec3::splat(Real::NAN);
        poses.positions[1] = Vec3::splat(1e300);
        let mut frame = Frame::new(stage.camera(), Look::default());
        stage.fill(stage.camera(), Look::default(), &poses, &mut frame);
        assert_eq!(frame.spheres.len(), stage.body_count() - 2);
    }
}
