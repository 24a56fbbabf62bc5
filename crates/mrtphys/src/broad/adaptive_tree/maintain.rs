//! Upkeep of the tree (section 6.4.2): rise, sink, split, join, enlarge, shrink.
//!
//! After each step a node has children exactly if more than the allowed number of objects lie strictly inside its cell and
//! it is not at the deepest level, and each object is in the smallest node that holds it. So the tree is a function of its
//! root's cell and of the objects: it equals the tree that would be built anew in this cell.

use super::super::BoundsView;
use super::node::{Arena, Direction, Frame, NONE, Node, ROOT, Span, nearness};
use super::{AdaptiveTree, Known};
use crate::math::{Real, max};

/// Doublings of the root in one step after which a new tree is built: twenty per axis are a factor of a million.
const MOST_DOUBLINGS: u32 = 64;
/// A root that lies further than this many times its size from the origin of its coordinates gets new ones.
const FARTHEST: Real = 1024.0;

impl AdaptiveTree {
    /// Adapts the tree to where the objects are now.
    pub(super) fn adapt(&mut self, view: &BoundsView<'_>) {
        let known = Known { epoch: view.epoch, bodies: view.balls.len(), boundaries: view.boundaries.len() };
        if self.known != Some(known) || !self.frame.is_usable() || self.is_remote() {
            self.known = Some(known);
            self.build(view);
            return;
        }
        let reach = self.scene.extent.reach;
        let mut settled = reach <= self.reach;
        self.reach = max(reach, self.reach);
        self.place(view);
        match self.enlarge() {
            Growth::None => {}
            Growth::Doubled => settled = false,
            Growth::Reshaped => {
                let root = Node { first: NONE, num: 0, child: NONE, ..self.arena.nodes[ROOT as usize] };
                self.plant(root);
                settled = false;
            }
            Growth::Excessive => {
                self.build(view);
                return;
            }
        }
        self.move_up(view, settled);
        self.join();
        self.move_down(view, settled);
        self.shrink_and_settle(view);
    }

    /// Builds the tree anew round the scene as it is.
    fn build(&mut self, view: &BoundsView<'_>) {
        self.frame = Frame::of(&self.scene.extent);
        self.reach = self.scene.extent.reach;
        self.spans.clear();
        self.arena.reset(Node::EMPTY, self.scene.objects());
        self.place(view);
        let root = Node::EMPTY;
        let inside = |s: &Span| *s == Span::NOWHERE || root.moved(s, &nearness(&root)) == Direction::No;
        if !self.spans.iter().all(inside) {
            // So far from the origin that numbers cannot tell the scene's sides apart: one cell holds everything.
            self.frame = Frame::UNUSABLE;
        }
        self.move_down(view, false);
        self.shrink_and_settle(view);
    }

    /// Makes a tree of one node with all objects in it.
    pub(super) fn plant(&mut self, root: Node) {
        self.arena.reset(root, self.spans.len());
        for (object, span) in self.spans.iter().enumerate() {
            if *span != Span::NOWHERE {
                self.arena.link(object as u32, ROOT);
            }
        }
    }

    /// Looks up where every object is. Objects that have come in start at the root, those that have gone are taken out.
    pub(super) fn place(&mut self, view: &BoundsView<'_>) {
        self.spans.resize(self.scene.objects(), Span::NOWHERE);
        for object in 0..self.spans.len() {
            let listed = self.scene.listed_box(view, object, self.reach);
            let was = self.arena.node_of[object] != NONE;
            match (was, listed.is_some()) {
                (false, true) => self.arena.link(object as u32, ROOT),
                (true, false) => self.arena.unlink(object as u32),
                _ => {}
            }
            self.spans[object] = listed.map_or(Span::NOWHERE, |b| self.frame.span(&b));
        }
    }

    /// Whether the root has drifted so far that its coordinates lose digits.
    fn is_remote(&self) -> bool {
        let root = &self.arena.nodes[ROOT as usize];
        (0..3).any(|k| max(root.cell.low[k].abs(), root.cell.high[k].abs()) > FARTHEST * root.size[k])
    }

    /// Doubles the root until every object is inside (`enlargeTree`).
    ///
    /// The thesis puts new nodes above the root, each halved across the axis of its doubling. Where that is not the axis
    /// across which a cell of this form is halved, the same root is divided anew instead: otherwise the form of the tree,
    /// and with it the counts, would depend on the order in which objects once left the scene.
    fn enlarge(&mut self) -> Growth {
        let mut growth = Growth::None;
        let mut doublings = 0;
        let mut object = 0;
        // Objects found inside since the root was last changed: all of them must be, since what counts as near a side
        // grows with the root.
        let mut inside = 0;
        while inside < self.spans.len() {
            let root = self.arena.nodes[ROOT as usize];
            let opposite = match self.spans[object] {
                Span::NOWHERE => Direction::No,
                span => root.moved(&span, &nearness(&root)),
            };
            if opposite == Direction::No {
                inside += 1;
                object = (object + 1) % self.spans.len();
                continue;
            }
            (inside, doublings) = (0, doublings + 1);
            let Some(doubled) = doubled(&root, opposite) else { return Growth::Excessive };
            if doublings > MOST_DOUBLINGS {
                return Growth::Excessive;
            }
            if growth == Growth::Reshaped || self.frame.longest(&doubled.size) != opposite.axis() {
                growth = Growth::Reshaped;
                self.arena.nodes[ROOT as usize] =
                    Node { first: root.first, num: root.num, child: root.child, ..doubled };
            } else {
                growth = Growth::Doubled;
                put_above(&mut self.arena, doubled, opposite);
            }
        }
        growth
    }

    /// Moves every object that has left its cell up as far as necessary (`moveUpObjects`). On the way all nodes that are not
    /// marked with the opposite of the direction of leaving are skipped: their cells end at the same side.
    pub(super) fn move_up(&mut self, view: &BoundsView<'_>, settled: bool) {
        let near = nearness(&self.arena.nodes[ROOT as usize]);
        for object in 0..self.spans.len() as u32 {
            let start = self.arena.node_of[object as usize];
            if start == NONE || (settled && self.scene.is_immovable(view, object)) {
                continue;
            }
            let span = &self.spans[object as usize];
            let mut n = start;
            loop {
                let opposite = self.arena.nodes[n as usize].moved(span, &near);
                if opposite == Direction::No {
                    break;
                }
                while n != ROOT && self.arena.nodes[n as usize].dir != opposite {
                    n = self.arena.nodes[n as usize].parent;
                }
                if n == ROOT {
                    break;
                }
                n = self.arena.nodes[n as usize].parent;
            }
            if n != start {
                self.arena.move_item(object, n);
            }
        }
    }

    /// Joins two leaves with their parent if the three hold no more objects than a cell may, or if the parent has come to
    /// the deepest level (`joinCell`).
    fn join(&mut self) {
        let mut order = std::mem::take(&mut self.order);
        order.clear();
        order.extend(self.walk());
        // Children stand after their parents: backwards, they come first.
        for &(n, depth) in order.iter().rev() {
            let node = self.arena.nodes[n as usize];
            if node.is_leaf() {
                continue;
            }
            let [a, b] = [self.arena.nodes[node.child as usize], self.arena.nodes[node.child as usize + 1]];
            let few = node.num + a.num + b.num <= self.objects_per_cell;
            if a.is_leaf() && b.is_leaf() && (few || depth >= self.max_depth) {
                for first in [a.first, b.first] {
                    let mut object = first;
                    while object != NONE {
                        object = self.arena.move_item(object, n);
                    }
                }
                self.arena.nodes[n as usize].child = NONE;
                self.arena.free_pair(node.child);
            }
        }
        self.order = order;
    }

    /// Moves every object down as far as possible and splits the leaves that hold too many (`moveDownObjects`,
    /// `splitCell`). An object inside of a cell is only compared with the side where the cell is halved.
    pub(super) fn move_down(&mut self, view: &BoundsView<'_>, settled: bool) {
        let near = nearness(&self.arena.nodes[ROOT as usize]);
        let mut stack = std::mem::take(&mut self.order);
        stack.clear();
        stack.push((ROOT, 0));
        while let Some((n, depth)) = stack.pop() {
            let node = self.arena.nodes[n as usize];
            let full = node.is_leaf() && node.num > self.objects_per_cell;
            if node.is_leaf() && !(full && depth < self.max_depth && self.frame.is_usable()) {
                continue;
            }
            if full {
                let axis = self.frame.longest(&node.size);
                let pair = [node.half(axis, false, n), node.half(axis, true, n)];
                self.arena.nodes[n as usize].child = self.arena.take_pair(pair);
            }
            let child = self.arena.nodes[n as usize].child;
            let axis = self.arena.nodes[child as usize].dir.axis();
            let middle = node.middle(axis);
            let mut object = node.first;
            while object != NONE {
                let span = &self.spans[object as usize];
                let stays = settled && !full && self.scene.is_immovable(view, object);
                object = if !stays && span.high[axis] < middle - near[axis] {
                    self.arena.move_item(object, child)
                } else if !stays && span.low[axis] > middle + near[axis] {
                    self.arena.move_item(object, child + 1)
                } else {
                    self.arena.next(object)
                };
            }
            stack.extend([(child, depth + 1), (child + 1, depth + 1)]);
        }
        self.order = stack;
    }

    /// Makes the topmost node that is needed the root (`shrinkTree`), as long as everything is in one child; then the levels
    /// below may be used again.
    fn shrink_and_settle(&mut self, view: &BoundsView<'_>) {
        let mut shrunk = false;
        loop {
            let root = self.arena.nodes[ROOT as usize];
            if root.is_leaf() || root.num > 0 {
                break;
            }
            let is_empty = |n: u32| self.arena.nodes[n as usize].is_leaf() && self.arena.nodes[n as usize].num == 0;
            let kept = match (is_empty(root.child), is_empty(root.child + 1)) {
                (true, false) => root.child + 1,
                (false, true) => root.child,
                _ => break,
            };
            let node = Node { parent: NONE, dir: Direction::No, ..self.arena.nodes[kept as usize] };
            self.arena.rehouse(node, ROOT);
            self.arena.free_pair(root.child);
            shrunk = true;
        }
        if shrunk {
            self.move_down(view, false);
        }
    }
}

/// What has become of the root.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Growth {
    /// it holds everything
    None,
    /// it was doubled, the tree below is as it was
    Doubled,
    /// it was doubled in a way that divides it differently
    Reshaped,
    /// it would have to grow too much, or past what numbers can hold
    Excessive,
}

/// The root doubled to the side that is opposite to `opposite`; `None` if its sides could not be told exactly.
fn doubled(root: &Node, opposite: Direction) -> Option<Node> {
    let axis = opposite.axis();
    let mut big = Node { cell: root.cell, size: root.size, ..Node::EMPTY };
    big.size[axis] *= 2.0;
    let (low, high) = (&mut big.cell.low[axis], &mut big.cell.high[axis]);
    let old = if opposite.is_high() {
        *low -= root.size[axis];
        root.cell.low[axis]
    } else {
        *high += root.size[axis];
        root.cell.high[axis]
    };
    let exact = *high - *low == big.size[axis] && big.middle(axis) == old;
    exact.then_some(big)
}

/// Puts a new root above the old one, with an empty sister for this.
fn put_above(arena: &mut Arena, doubled: Node, opposite: Direction) {
    let axis = opposite.axis();
    let pair = [doubled.half(axis, false, ROOT), doubled.half(axis, true, ROOT)];
    let old = arena.nodes[ROOT as usize];
    let child = arena.take_pair(pair);
    // An object that went to the lower side leaves the old root as the upper half.
    let place = child + u32::from(opposite.is_high());
    arena.rehouse(Node { parent: ROOT, dir: opposite, ..old }, place);
    arena.nodes[ROOT as usize] = Node { child, ..doubled };
}
