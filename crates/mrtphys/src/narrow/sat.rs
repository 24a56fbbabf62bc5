//! Separating axes of convex pieces (Gottschalk, Lin and Manocha, "OBBTree", 1996; edge pairs culled on the Gauss map as in
//! Gregorius, "The separating axis test between convex polyhedra", GDC 2013).
//!
//! Two convex pieces overlap exactly where the Minkowski difference holds the origin. Its faces are faces of A, faces of B,
//! and parallelograms of an edge of A with an edge of B whose arcs on the Gauss map cross. The depth along the normal n
//! of such a face is the amount by which the pieces overlap along n, and the least of these is the way out.
//!
//! Both pieces are turned into the world's axes, each about the centre of mass of its own body, and `offset` leads from
//! the first centre to the second. So the gap along n is n . offset + (min_B n.x - max_A n.x): exchanging the bodies
//! gives the same bits, and a scene far from the origin loses nothing beyond the rounding of its positions.

use crate::math::{Mat3, Real, Vec3};
use crate::shape::polyhedron::ConvexPiece;

/// Depths closer to each other than this part of the pair's size are tied: 2^-30. Far above the rounding of a depth
/// (about 2^-50), so that a pair of parallel faces never changes its mind from step to step; far below what moves anything.
pub(crate) const TIE: Real = 1.0 / (1u64 << 30) as Real;

/// Corners closer to a plane than this part of the pair's size lie on it: 2^-40. Large enough for a body that has turned
/// for thousands of steps with the rounding of its rotation, far below any depth that a step of motion leads to.
pub(crate) const FLAT: Real = 1.0 / (1u64 << 40) as Real;

/// A gap along the normal of two edges below this part of the pair's size is rounding: 2^-46. The faces have said by then
/// that the pieces are not apart; edges of two faces that touch must not contradict them by a last bit.
const ROUNDING_OF_GAP: Real = 1.0 / (1u64 << 46) as Real;

/// Square of the sine of the angle below which two edges are parallel: 2^-60. Leaving such a pair out changes the depth
/// by no more than the width of the parallelogram they span, 2^-30 of its length.
const PARALLEL: Real = 1.0 / (1u64 << 60) as Real;

/// Cosine above which two directions are one: an angle of 2^-20.
const SAME_DIRECTION: Real = 1.0 - 1.0 / (1u64 << 41) as Real;

/// The geometry of a convex piece in the world's axes, about the centre of mass of its body.
#[derive(Clone, Debug, Default)]
pub(crate) struct Turned {
    /// corners \[m\]
    pub corners: Vec<Vec3>,
    /// outward unit normals of the faces
    pub normals: Vec<Vec3>,
    /// offsets of the faces \[m\]
    pub offsets: Vec<Real>,
    /// edges, from the first end to the second \[m\]
    pub edges: Vec<Vec3>,
    /// a point inside \[m\]
    pub center: Vec3,
}

impl Turned {
    /// Turns the piece by the rotation.
    pub fn turn(&mut self, piece: &ConvexPiece, rotation: &Mat3) {
        self.corners.clear();
        self.corners.extend(piece.corners.iter().map(|&c| *rotation * c));
        self.normals.clear();
        self.normals.extend(piece.faces.iter().map(|f| *rotation * f.normal));
        self.offsets.clear();
        self.offsets.extend(piece.faces.iter().map(|f| f.offset));
        self.finish(piece);
    }

    /// Edges and centre from the corners.
    pub fn finish(&mut self, topology: &ConvexPiece) {
        self.edges.clear();
        let corners = &self.corners;
        let vector = |ends: [u32; 2]| corners[ends[1] as usize] - corners[ends[0] as usize];
        self.edges.extend(topology.edges.iter().map(|e| vector(e.ends)));
        let sum = corners.iter().fold(Vec3::ZERO, |s, &c| s + c);
        self.center = sum / corners.len() as Real;
    }

    /// Least n . x.
    #[inline]
    pub fn low(&self, n: Vec3) -> Real {
        self.corners.iter().fold(Real::INFINITY, |m, c| crate::math::min(m, n.dot(*c)))
    }

    /// Largest n . x.
    #[inline]
    pub fn high(&self, n: Vec3) -> Real {
        self.corners.iter().fold(Real::NEG_INFINITY, |m, c| crate::math::max(m, n.dot(*c)))
    }
}

/// A convex piece in its place: its geometry, and who meets whom.
#[derive(Clone, Copy)]
pub(crate) struct Solid<'a> {
    /// corners, normals and offsets
    pub turned: &'a Turned,
    /// corners of the faces, faces of the edges; its own coordinates are not read
    pub topology: &'a ConvexPiece,
    /// what the piece is a piece of; `None` where it is the whole body
    pub whole: Option<Whole<'a>>,
}

/// The body that a convex piece is a part of.
#[derive(Clone, Copy)]
pub(crate) struct Whole<'a> {
    /// all pieces of the body
    pub pieces: &'a [ConvexPiece],
    /// which of them it is
    pub number: usize,
    /// rotation of the body
    pub rotation: &'a Mat3,
}

impl Whole<'_> {
    /// Whether a point on the surface of the piece is one where the surface of the whole body faces the direction: whether
    /// no other piece that holds the point reaches further along it. On a cut through the body some other piece does. The
    /// point relative to the body's centre of mass, both in the world's axes.
    pub fn faces(&self, point: Vec3, direction: Vec3) -> bool {
        // The pieces of a body fit each other to the tolerance with which it was cut.
        let tolerance = TIE * self.pieces[self.number].ball.radius;
        let (point, direction) = (self.rotation.transpose_mul(point), self.rotation.transpose_mul(direction));
        let height = direction.dot(point) + 2.0 * tolerance;
        self.pieces.iter().enumerate().all(|(i, p)| {
            i == self.number || !holds(p, point, tolerance) || p.corners.iter().all(|c| direction.dot(*c) <= height)
        })
    }
}

/// Whether a piece holds a point, up to a tolerance \[m\].
pub(crate) fn holds(piece: &ConvexPiece, point: Vec3, tolerance: Real) -> bool {
    let reach = piece.ball.radius + tolerance;
    (point - piece.ball.center).length_squared() <= reach * reach
        && piece.faces.iter().all(|f| f.normal.dot(point) - f.offset <= tolerance)
}

impl Solid<'_> {
    /// The corners of a face, relative to the body's centre of mass, in order round it. A piece of a larger body may have
    /// several faces in one plane, on the surface and on cuts; together they are what it turns to its partner there.
    pub fn rim(&self, face: usize, out: &mut Vec<Vec3>) {
        out.clear();
        match self.whole {
            None => {
                let numbers = &self.topology.faces[face].corners;
                out.extend(numbers.iter().map(|&c| self.turned.corners[c as usize]));
            }
            Some(whole) => {
                let n = self.turned.normals[face];
                let lowest = self.turned.high(n) - TIE * whole.pieces[whole.number].ball.radius;
                out.extend(self.turned.corners.iter().copied().filter(|&c| n.dot(c) >= lowest));
            }
        }
    }
}

/// Two convex pieces that may overlap.
#[derive(Clone, Copy)]
pub(crate) struct Pair<'a> {
    /// the first piece
    pub a: Solid<'a>,
    /// the second piece
    pub b: Solid<'a>,
    /// from the centre of mass of the first body to that of the second \[m\]
    pub offset: Vec3,
    /// sum of the radii of both pieces \[m\]: tolerances are parts of it
    pub size: Real,
    /// Two flat pieces in one plane: only directions in the plane count. Faces 0 and 1 of either piece lie in the plane.
    pub coplanar: bool,
}

/// What an axis is normal to.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Feature {
    /// a face of the first piece
    FaceA(u32),
    /// a face of the second piece
    FaceB(u32),
    /// an edge of the first and one of the second piece
    Edges(u32, u32),
    /// several tied features: the normal is their middle; the number of the first of them
    Several(u32),
}

/// A direction and the gap along it.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Axis {
    /// unit normal from the first piece to the second
    pub normal: Vec3,
    /// n . offset + (min_B n.x - max_A n.x) \[m\]; negative: overlap
    pub gap: Real,
    /// where it comes from
    pub feature: Feature,
}

/// Memory of the search, kept from call to call.
#[derive(Clone, Debug, Default)]
pub(crate) struct AxisScratch {
    tied: Vec<Axis>,
    distinct: Vec<Axis>,
    reach_a: Vec<Real>,
    reach_b: Vec<Real>,
    row: Vec<Real>,
    near_b: Vec<u32>,
}

impl Pair<'_> {
    /// The gap along a unit normal.
    #[inline]
    pub fn gap(&self, n: Vec3) -> Real {
        n.dot(self.offset) + (self.b.turned.low(n) - self.a.turned.high(n))
    }

    /// Which of two tied features of one direction stands: faces before edges; last the rim of a quadrangle,
    /// which is no face to lie on, and a cut that lies in the plane of a face.
    fn rank(&self, feature: Feature) -> u32 {
        let face = match feature {
            Feature::FaceA(i) => &self.a.topology.faces[i as usize],
            Feature::FaceB(i) => &self.b.topology.faces[i as usize],
            _ => return 1,
        };
        if face.corners.len() < 3 || face.internal { 2 } else { 0 }
    }

    /// The axis of least overlap, or `None` where an axis separates the pieces; pieces that touch are not separated.
    /// `accept` says whether an axis can be the normal; where there is none that can, the others have to do.
    pub fn least_overlap(&self, scratch: &mut AxisScratch, accept: impl FnMut(&Axis) -> bool) -> Option<Axis> {
        let mut search = Search { pair: self, best: Real::NEG_INFINITY, spare: None, scratch, accept };
        search.scratch.tied.clear();
        search.reaches();
        if search.separated_by_a_face() || (!self.coplanar && search.separated_by_edges()) {
            return None;
        }
        search.choose()
    }
}

struct Search<'p, 's, F> {
    pair: &'p Pair<'p>,
    /// largest gap of an axis that may be a normal
    best: Real,
    /// the best of the axes that only separate: used where nothing else is there
    spare: Option<Axis>,
    scratch: &'s mut AxisScratch,
    accept: F,
}

impl<F: FnMut(&Axis) -> bool> Search<'_, '_, F> {
    fn tie(&self) -> Real {
        TIE * self.pair.size
    }

    /// For each face the height of the other piece's centre above it. The centre belongs to the piece, so no gap along the
    /// face's normal is larger: faces with a small reach need no look at the corners.
    fn reaches(&mut self) {
        let (a, b) = (self.pair.a.turned, self.pair.b.turned);
        let seen_from_a = self.pair.offset + b.center;
        let seen_from_b = a.center - self.pair.offset;
        let reach = |t: &Turned, p: Vec3, out: &mut Vec<Real>| {
            out.clear();
            out.extend(t.normals.iter().zip(&t.offsets).map(|(n, o)| n.dot(p) - o));
        };
        reach(a, seen_from_a, &mut self.scratch.reach_a);
        reach(b, seen_from_b, &mut self.scratch.reach_b);
    }

    /// Gap along the normal of a face of the first piece.
    #[inline]
    fn gap_a(&self, face: usize) -> Real {
        let n = self.pair.a.turned.normals[face];
        n.dot(self.pair.offset) + (self.pair.b.turned.low(n) - self.pair.a.turned.offsets[face])
    }

    /// Gap along the inward normal of a face of the second piece.
    #[inline]
    fn gap_b(&self, face: usize) -> Real {
        let n = -self.pair.b.turned.normals[face];
        n.dot(self.pair.offset) + (-self.pair.b.turned.offsets[face] - self.pair.a.turned.high(n))
    }

    /// Tries all faces of both pieces, first the one that the other piece's centre is highest above: most pairs end there.
    fn separated_by_a_face(&mut self) -> bool {
        let skip = if self.pair.coplanar { 2 } else { 0 };
        let highest = |reach: &[Real]| {
            let seed = (skip, Real::NEG_INFINITY);
            reach.iter().enumerate().skip(skip).fold(seed, |m, (i, &r)| if r > m.1 { (i, r) } else { m })
        };
        let (fa, ra) = highest(&self.scratch.reach_a);
        let (fb, rb) = highest(&self.scratch.reach_b);
        if (ra > 0.0 && self.gap_a(fa) > 0.0) || (rb > 0.0 && self.gap_b(fb) > 0.0) {
            return true;
        }
        for i in skip..self.scratch.reach_a.len() {
            if self.worth(self.scratch.reach_a[i]) {
                let gap = self.gap_a(i);
                let normal = self.pair.a.turned.normals[i];
                if gap > 0.0 {
                    return true;
                }
                self.keep(Axis { normal, gap, feature: Feature::FaceA(i as u32) });
            }
        }
        for i in skip..self.scratch.reach_b.len() {
            if self.worth(self.scratch.reach_b[i]) {
                let gap = self.gap_b(i);
                let normal = -self.pair.b.turned.normals[i];
                if gap > 0.0 {
                    return true;
                }
                self.keep(Axis { normal, gap, feature: Feature::FaceB(i as u32) });
            }
        }
        false
    }

    /// Whether an axis whose gap is at most `reach` can separate or be the normal.
    #[inline]
    fn worth(&self, reach: Real) -> bool {
        reach >= 0.0 || reach >= self.best - self.tie()
    }

    /// Notes an axis.
    fn keep(&mut self, axis: Axis) {
        if axis.gap < self.best - self.tie() {
            return;
        }
        if (self.accept)(&axis) {
            self.best = crate::math::max(self.best, axis.gap);
            self.scratch.tied.push(axis);
        } else if self.spare.is_none_or(|s| axis.gap > s.gap) {
            self.spare = Some(axis);
        }
    }

    /// Whether an edge can give a separating axis or the normal. All outward directions at an edge are n = s n1 + t n2 with
    /// s, t >= 0 and s + t >= 1, so if the other centre is below both faces by more than x, it is so along n: the gap is
    /// below -x too.
    #[inline]
    fn edge_is_worth(&self, reach: &[Real], solid: &Solid<'_>, edge: usize) -> bool {
        let [f, g] = solid.topology.edges[edge].faces;
        let highest = crate::math::max(reach[f as usize], reach[g as usize]);
        self.worth(highest)
    }

    /// Tries all pairs of edges whose arcs on the Gauss map cross.
    fn separated_by_edges(&mut self) -> bool {
        let (a, b) = (self.pair.a, self.pair.b);
        let mut near_b = std::mem::take(&mut self.scratch.near_b);
        let mut row = std::mem::take(&mut self.scratch.row);
        near_b.clear();
        let worth_b = |e: &usize| self.edge_is_worth(&self.scratch.reach_b, &b, *e);
        near_b.extend((0..b.turned.edges.len()).filter(worth_b).map(|e| e as u32));
        let mut separated = false;
        'all: for i in 0..a.turned.edges.len() {
            if !self.edge_is_worth(&self.scratch.reach_a, &a, i) {
                continue;
            }
            let along = a.turned.edges[i];
            row.clear();
            row.extend(b.turned.normals.iter().map(|n| n.dot(along)));
            for &j in &near_b {
                let [g1, g2] = b.topology.edges[j as usize].faces;
                let (y1, y2) = (row[g1 as usize], row[g2 as usize]);
                if (y1 < 0.0 && y2 > 0.0 || y1 > 0.0 && y2 < 0.0) && self.separated_by_edge_pair(i, j as usize, y1, y2)
                {
                    separated = true;
                    break 'all;
                }
            }
        }
        self.scratch.near_b = near_b;
        self.scratch.row = row;
        separated
    }

    /// One pair of edges; `y1`, `y2`: the normals of the faces at B's edge times A's edge, of opposite sign.
    #[inline]
    fn separated_by_edge_pair(&mut self, i: usize, j: usize, y1: Real, y2: Real) -> bool {
        let (a, b) = (self.pair.a, self.pair.b);
        let (u, v) = (a.turned.edges[i], b.turned.edges[j]);
        let [f1, f2] = a.topology.edges[i].faces;
        let (n1, n2) = (a.turned.normals[f1 as usize], a.turned.normals[f2 as usize]);
        let (x1, x2) = (n1.dot(v), n2.dot(v));
        if !(x1 < 0.0 && x2 > 0.0 || x1 > 0.0 && x2 < 0.0) {
            return false;
        }
        let across = u.cross(v);
        let length_squared = across.length_squared();
        if length_squared <= PARALLEL * (u.length_squared() * v.length_squared()) {
            return false;
        }
        // The points of the two arcs that are perpendicular to both edges, up to positive factors. The arcs cross where
        // A's point is the opposite of B's: outward for one is inward for the other.
        let [g1, g2] = b.topology.edges[j].faces;
        let (m1, m2) = (b.turned.normals[g1 as usize], b.turned.normals[g2 as usize]);
        let outward_a = across.dot(n1 * x2.abs() + n2 * x1.abs());
        let outward_b = across.dot(m1 * y2.abs() + m2 * y1.abs());
        if outward_a == 0.0 || (outward_a > 0.0) == (outward_b > 0.0) {
            return false;
        }
        let length = length_squared.sqrt();
        let n = across / if outward_a > 0.0 { length } else { -length };
        let p = a.turned.corners[a.topology.edges[i].ends[0] as usize];
        let q = b.turned.corners[b.topology.edges[j].ends[0] as usize];
        let near = n.dot(self.pair.offset) + (n.dot(q) - n.dot(p));
        let rounding = ROUNDING_OF_GAP * self.pair.size;
        if near <= rounding && near < self.best - self.tie() {
            return false;
        }
        // Nearly parallel edges give a direction that is off by its rounding, and then the edges need not be what reaches
        // furthest along it. The corners settle it: whatever the edges say, this is the true gap along n.
        let gap = self.pair.gap(n);
        if gap > rounding {
            return true;
        }
        self.keep(Axis { normal: n, gap: crate::math::min(gap, 0.0), feature: Feature::Edges(i as u32, j as u32) });
        false
    }

    /// The axis of least overlap. Of tied axes in one direction the first stands: faces before edges, A before B. Where
    /// tied axes point in clearly different directions (edge meets parallel edge, corner meets corner, one box exactly
    /// diagonal to the other), choosing one would turn the bodies for no reason, and choosing the other would turn them
    /// the other way: the normal is the middle of all.
    fn choose(&mut self) -> Option<Axis> {
        let limit = self.best - self.tie();
        let distinct = &mut self.scratch.distinct;
        distinct.clear();
        for axis in self.scratch.tied.iter().filter(|t| t.gap >= limit) {
            match distinct.iter_mut().find(|d| d.normal.dot(axis.normal) >= SAME_DIRECTION) {
                None => distinct.push(*axis),
                Some(d) if self.pair.rank(axis.feature) < self.pair.rank(d.feature) => *d = *axis,
                Some(_) => {}
            }
        }
        match distinct.as_slice() {
            [] => self.spare,
            [only] => Some(*only),
            several => Some(middle(self.pair, several)),
        }
    }
}

/// The middle of tied axes; where they cancel (identical poses), the one most along the line of centres, and where that
/// does not decide, the first.
fn middle(pair: &Pair<'_>, tied: &[Axis]) -> Axis {
    let sum: Vec3 = tied.iter().map(|t| t.normal).sum();
    let number = match tied[0].feature {
        Feature::FaceA(i) | Feature::FaceB(i) | Feature::Edges(i, _) | Feature::Several(i) => i,
    };
    if sum.length() > 1e-3
        && let Some(normal) = sum.try_normalize()
    {
        return Axis { normal, gap: crate::math::min(pair.gap(normal), 0.0), feature: Feature::Several(number) };
    }
    let between = pair.offset + (pair.b.turned.center - pair.a.turned.center);
    let mut best = tied[0];
    for t in &tied[1..] {
        if t.normal.dot(between) > best.normal.dot(between) + TIE * pair.size {
            best = *t;
        }
    }
    best
}
