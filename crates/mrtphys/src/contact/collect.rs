//! Stages 3 and 4: from bounds to candidates, from candidates to contacts.

use super::found::Block;
use super::let_back::{LetBack, Standing};
use super::memory::{pair_key, wall_key};
use super::{Contact, Other};
use crate::bounds::Ball;
use crate::broad::BoundsView;
use crate::cache::prefetch;
use crate::def::ContactMode;
use crate::math::{Mat3, Vec3};
use crate::model::Model;
use crate::narrow::Placed;
use crate::narrow::pairs::sphere_sphere;
use crate::par;
use crate::shape::LimitPlane;
use crate::state::State;
use crate::work::Work;

/// Candidates in a block of the narrow phase.
const BLOCK: usize = 512;

/// Pairs by which bodies are asked for ahead.
const AHEAD: usize = 12;

/// Asks the broad phase.
pub fn find_candidates(model: &Model, work: &mut Work) {
    let view = BoundsView {
        balls: &work.balls,
        boxes: &work.boxes,
        fixed: if model.fixed.contains(&true) { &model.fixed } else { &[] },
        boundaries: &model.wall_bounds,
        epoch: model.epoch,
    };
    work.candidates.clear();
    if let Some(broad) = &mut work.broad {
        broad.find(&view, &mut work.candidates);
    }
    work.counters.sphere_tests += work.candidates.sphere_tests;
    work.counters.detect_calls += (work.candidates.pairs.len() + work.candidates.walls.len()) as u64;
}

/// Asks the pair routines.
pub fn collect(model: &Model, state: &State, let_back: &mut LetBack, work: &mut Work) {
    settle_planes(model, state, let_back);
    let scene = Scene {
        model,
        state,
        let_back,
        balls: &work.balls,
        rotations: &work.rotations,
        mode: model.settings.contact,
        only_spheres: model.all_spheres && model.spheres_meet_as_spheres,
    };
    let pairs = par::blocks_into(&work.candidates.pairs, BLOCK, &mut work.contacts.pairs.0, |pairs, block| {
        block.clear();
        for (k, &[i, j]) in pairs.iter().enumerate() {
            if let Some(&next) = pairs.get(k + AHEAD) {
                scene.prefetch(next);
            }
            scene.touch_pair(i, j, block);
        }
    });
    let walls = par::blocks_into(&work.candidates.walls, BLOCK, &mut work.contacts.walls.0, |walls, block| {
        block.clear();
        walls.iter().for_each(|&[body, wall]| scene.touch_wall(body, wall, block));
    });
    (work.contacts.pairs.1, work.contacts.walls.1) = (pairs, walls);
    work.contacts.renew();
    work.counters.contacts += work.contacts.count() as u64;
}

/// Two-sided planes must know on which side each body is at home: called before a body first moves, and after every motion.
pub fn settle_planes(model: &Model, state: &State, let_back: &mut LetBack) {
    for (index, boundary) in model.boundaries.iter().enumerate() {
        let Some(plane) = boundary.shape.downcast::<LimitPlane>() else { continue };
        for (slot, (&serial, line)) in model.serial.iter().zip(&state.lines).enumerate() {
            if line.radius < 0.0 || model.fixed[slot] {
                continue;
            }
            let ball = Ball { center: line.x, radius: line.radius };
            let standing = Standing::of(boundary.position, plane.normal(), &ball, line.v);
            let_back.settle(index as u32, serial, &standing);
        }
    }
}

/// What the narrow phase reads.
struct Scene<'a> {
    model: &'a Model,
    state: &'a State,
    let_back: &'a LetBack,
    balls: &'a [Ball],
    rotations: &'a [Mat3],
    mode: ContactMode,
    /// every body is a sphere, and spheres have the routine of spheres
    only_spheres: bool,
}

impl Scene<'_> {
    fn placed(&self, slot: u32) -> Placed<'_> {
        let i = slot as usize;
        Placed {
            shape: &*self.model.body(i).shape,
            position: self.state.lines[i].x,
            rotation: self.rotations.get(i).unwrap_or(&Mat3::IDENTITY),
            ball: self.balls[i],
            home_side: 0.0,
        }
    }

    /// Asks for what [`touch_pair`](Scene::touch_pair) will read.
    #[inline]
    fn prefetch(&self, pair: [u32; 2]) {
        for slot in pair {
            prefetch(&self.balls[slot as usize]);
            prefetch(&self.model.serial[slot as usize]);
        }
    }

    /// Contacts of two bodies; the first is the one created earlier.
    fn touch_pair(&self, i: u32, j: u32, block: &mut Block) {
        let (si, sj) = (self.model.serial[i as usize], self.model.serial[j as usize]);
        let ((a, low), (b, high)) = if si < sj { ((i, si), (j, sj)) } else { ((j, sj), (i, si)) };
        let key = pair_key(low, high, self.mode);
        if self.only_spheres {
            return self.touch_spheres(key, a, b, block);
        }
        let entry = self.model.table.lookup(self.model.body(a as usize).kind, self.model.body(b as usize).kind);
        let (first, second) = (self.placed(a), self.placed(b));
        let start = block.touches.list.len();
        entry.call(&first, &second, &mut block.touches);
        self.emit(key, a, Other::Body(b), start, block);
    }

    /// What the table's routine for spheres reports, without asking the table.
    #[inline]
    fn touch_spheres(&self, key: u64, a: u32, b: u32, block: &mut Block) {
        if let Some(m) = sphere_sphere::meet(&self.balls[a as usize], &self.balls[b as usize]) {
            block.contacts.push(Contact {
                key,
                a,
                b: Other::Body(b),
                feature: 0,
                normal: m.normal,
                point: m.middle(),
                depth: m.depth,
                first_point: 0,
                point_count: 0,
            });
        }
    }

    /// Contacts of a body and a boundary.
    fn touch_wall(&self, body: u32, wall: u32, block: &mut Block) {
        let boundary = &self.model.boundaries[wall as usize];
        let serial = self.model.serial[body as usize];
        let entry = self.model.table.lookup(self.model.body(body as usize).kind, boundary.kind);
        let first = self.placed(body);
        let second = Placed {
            shape: &*boundary.shape,
            position: boundary.position,
            rotation: &Mat3::IDENTITY,
            ball: self.model.wall_bounds[wall as usize].ball,
            home_side: self.let_back.home_side(wall, serial),
        };
        let start = block.touches.list.len();
        entry.call(&first, &second, &mut block.touches);
        let key = wall_key(serial, wall, self.mode);
        self.emit(key, body, Other::Wall(wall), start, block);
    }

    fn emit(&self, key: u64, a: u32, b: Other, start: usize, block: &mut Block) {
        for t in &block.touches.list[start..] {
            debug_assert!(t.normal.is_finite() && t.point.is_finite() && t.depth >= 0.0, "{t:?}");
            block.contacts.push(Contact {
                key,
                a,
                b,
                feature: t.feature,
                normal: t.normal,
                point: t.point,
                depth: t.depth,
                first_point: t.first_point,
                point_count: t.point_count,
            });
        }
    }
}

/// Points of a contact: those of its manifold, or the contact point alone.
pub fn manifold<'a>(contact: &'a Contact, points: &'a [Vec3]) -> &'a [Vec3] {
    if contact.point_count == 0 {
        return std::slice::from_ref(&contact.point);
    }
    &points[contact.first_point as usize..][..contact.point_count as usize]
}
