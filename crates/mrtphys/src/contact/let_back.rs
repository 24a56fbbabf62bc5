//! The let-back memory of two-sided planes (thesis, section 6.7.1).
//!
//! The thesis keeps a list of the bodies that have crossed a plane, so that they are let back instead of being reflected once
//! more, and finds out where a body came from by going back from c to c - v dt. That is wrong when v changed in the same
//! step, and a body that is pushed away again while on the list is lost. Here each body's **home side** is remembered from
//! the first time it is seen; the plane is then the half-space of that side, and a body behind it is let back however it got
//! there. Whether it has crossed is remembered too: that is the thesis's list.

use crate::bounds::Ball;
use crate::math::{Real, Vec3};

/// Where a body stands towards a plane.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Standing {
    /// signed distance of its centre from the plane, along the plane's normal \[m\]
    pub distance: Real,
    /// velocity along the plane's normal \[m/s\]
    pub speed: Real,
    /// radius of its bounding sphere \[m\]
    pub radius: Real,
}

impl Standing {
    /// Of a body with this bounding sphere \[m\] and velocity \[m/s\], towards the plane through `point` \[m\].
    #[inline]
    pub fn of(point: Vec3, normal: Vec3, ball: &Ball, velocity: Vec3) -> Standing {
        let distance = normal.dot(ball.center - point);
        Standing { distance, speed: normal.dot(velocity), radius: ball.radius }
    }

    /// The side on which the centre is. Exactly on the plane: the side it comes from; at rest there: the normal's.
    fn side(&self) -> i8 {
        let decisive = if self.distance == 0.0 { -self.speed } else { self.distance };
        if decisive < 0.0 { -1 } else { 1 }
    }
}

/// What [`LetBack::settle`] found.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Passage {
    /// seen for the first time: this side is its home now
    Settled,
    /// nothing has changed
    Unchanged,
    /// its centre has crossed the plane: it is on the list now
    Crossed,
    /// it is wholly back on its home side: it is off the list
    Returned,
}

/// What is remembered of a body and a plane.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Entry {
    /// index of the boundary
    pub boundary: u32,
    /// creation number of the body
    pub serial: u32,
    /// home side: +1 the normal's, -1 the other
    pub side: i8,
    /// whether it has crossed and is not yet wholly back
    pub crossed: bool,
}

/// Which side of each two-sided plane each body is at home on, and which bodies have crossed.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct LetBack {
    /// by boundary, ascending; none empty
    planes: Vec<Plane>,
}

/// The bodies of one plane by creation number, ascending: a new body goes to the end.
#[derive(Clone, Debug, PartialEq)]
struct Plane {
    boundary: u32,
    bodies: Vec<Entry>,
}

impl Plane {
    /// Where the body is, or where it belongs.
    fn find(&self, serial: u32) -> Result<usize, usize> {
        // Nobody was ever removed: the place is the number itself.
        match self.bodies.get(serial as usize) {
            Some(e) if e.serial == serial => Ok(serial as usize),
            _ => self.bodies.binary_search_by_key(&serial, |e| e.serial),
        }
    }
}

impl LetBack {
    /// The side (+1 or -1) of the boundary on which the body is at home; 0 where it was never seen.
    #[inline]
    pub fn home_side(&self, boundary: u32, serial: u32) -> Real {
        self.entry(boundary, serial).map_or(0.0, |e| e.side as Real)
    }

    /// Whether the body has crossed the boundary and is not yet wholly back.
    pub fn has_crossed(&self, boundary: u32, serial: u32) -> bool {
        self.entry(boundary, serial).is_some_and(|e| e.crossed)
    }

    /// Remembers where a body stands. Called for every body and every two-sided plane: once before the body first moves (when
    /// it is made or set by hand, or when the plane is made), which settles its home side, and in every step between motion
    /// and contacts, which keeps the list: a body whose centre has left the home side is on it, until it is wholly back.
    pub fn settle(&mut self, boundary: u32, serial: u32, standing: &Standing) -> Passage {
        let bodies = self.bodies_of(boundary);
        let at = match bodies.find(serial) {
            Ok(at) => at,
            Err(at) => {
                bodies.bodies.insert(at, Entry { boundary, serial, side: standing.side(), crossed: false });
                return Passage::Settled;
            }
        };
        let entry = &mut bodies.bodies[at];
        let at_home = standing.distance * entry.side as Real;
        if !entry.crossed && at_home < 0.0 {
            entry.crossed = true;
            Passage::Crossed
        } else if entry.crossed && at_home > standing.radius {
            entry.crossed = false;
            Passage::Returned
        } else {
            Passage::Unchanged
        }
    }

    /// Forgets a body that was removed or set by hand.
    pub fn forget(&mut self, serial: u32) {
        for plane in &mut self.planes {
            if let Ok(at) = plane.find(serial) {
                plane.bodies.remove(at);
            }
        }
        self.planes.retain(|p| !p.bodies.is_empty());
    }

    /// Everything that is remembered, by boundary and then by creation number, ascending.
    pub fn entries(&self) -> impl Iterator<Item = &Entry> {
        self.planes.iter().flat_map(|p| &p.bodies)
    }

    /// The memory that [`LetBack::entries`] came from; `None` where the entries are not ascending or a side is not +1 or -1.
    pub fn from_entries(entries: impl IntoIterator<Item = Entry>) -> Option<LetBack> {
        let (mut memory, mut last) = (LetBack::default(), None);
        for e in entries {
            let key = (e.boundary, e.serial);
            if last.is_some_and(|l| l >= key) || (e.side != 1 && e.side != -1) {
                return None;
            }
            last = Some(key);
            memory.bodies_of(e.boundary).bodies.push(e);
        }
        Some(memory)
    }

    fn entry(&self, boundary: u32, serial: u32) -> Option<&Entry> {
        let plane = &self.planes[self.planes.binary_search_by_key(&boundary, |p| p.boundary).ok()?];
        plane.find(serial).ok().map(|at| &plane.bodies[at])
    }

    fn bodies_of(&mut self, boundary: u32) -> &mut Plane {
        let at = match self.planes.binary_search_by_key(&boundary, |p| p.boundary) {
            Ok(at) => at,
            Err(at) => {
                self.planes.insert(at, Plane { boundary, bodies: Vec::new() });
                at
            }
        };
        &mut self.planes[at]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn at(distance: Real, speed: Real) -> Standing {
        Standing { distance, speed, radius: 1.0 }
    }

    #[test]
    fn the_first_sight_settles_the_side() {
        let mut m = LetBack::default();
        assert_eq!(m.home_side(0, 0), 0.0);
        for (serial, standing, side) in [
            (0, at(0.1, -9.0), 1.0),
            (1, at(-0.1, -9.0), -1.0),
            (2, at(0.0, 5.0), -1.0),
            (3, at(0.0, -5.0), 1.0),
            (4, at(0.0, 0.0), 1.0),
            (5, at(-0.0, 0.0), 1.0),
        ] {
            assert_eq!(m.settle(7, serial, &standing), Passage::Settled);
            assert_eq!(m.home_side(7, serial), side, "{standing:?}");
        }
        assert_eq!(m.home_side(6, 0), 0.0);
    }

    #[test]
    fn on_the_list_from_crossing_until_wholly_back() {
        for side in [1.0, -1.0] {
            let mut m = LetBack::default();
            m.settle(0, 0, &at(3.0 * side, 0.0));
            for (distance, passage, crossed) in [
                (0.5, Passage::Unchanged, false),
                (0.0, Passage::Unchanged, false),
                (-0.1, Passage::Crossed, true),
                (-5.0, Passage::Unchanged, true),
                (0.5, Passage::Unchanged, true),
                (-0.5, Passage::Unchanged, true),
                (1.0, Passage::Unchanged, true),
                (1.5, Passage::Returned, false),
                (1.5, Passage::Unchanged, false),
            ] {
                assert_eq!(m.settle(0, 0, &at(distance * side, 0.0)), passage);
                assert_eq!((m.has_crossed(0, 0), m.home_side(0, 0)), (crossed, side));
            }
        }
    }

    #[test]
    fn forgetting_leaves_no_trace_and_entries_round_trip() {
        let (mut m, mut never) = (LetBack::default(), LetBack::default());
        for serial in [4, 0, 9, 2] {
            for boundary in [3, 1] {
                m.settle(boundary, serial, &at(if serial == 2 { -1.0 } else { 1.0 }, 0.0));
                if serial != 9 {
                    never.settle(boundary, serial, &at(if serial == 2 { -1.0 } else { 1.0 }, 0.0));
                }
            }
        }
        m.forget(9);
        m.forget(77);
        assert_eq!(m, never);
        let keys: Vec<_> = m.entries().map(|e| (e.boundary, e.serial)).collect();
        assert_eq!(keys, [(1, 0), (1, 2), (1, 4), (3, 0), (3, 2), (3, 4)]);
        assert_eq!(LetBack::from_entries(m.entries().copied()), Some(m.clone()));
        assert_eq!(LetBack::from_entries(m.entries().copied().collect::<Vec<_>>().into_iter().rev()), None);
        assert_eq!((m.home_side(3, 2), m.home_side(3, 4)), (-1.0, 1.0));
        [0, 2, 4].into_iter().for_each(|s| m.forget(s));
        assert_eq!(m, LetBack::default());
    }
}
