//! Nodes of the tree, the lists of objects in them, and the tree's own coordinates.

use super::super::scene::Extent;
use crate::bounds::Aabb;
use crate::math::{Real, Vec3, max};

/// No node, no object.
pub(super) const NONE: u32 = u32::MAX;
/// The root's place; the place after it stays empty, so that two sisters always have places `2k` and `2k + 1`.
pub(super) const ROOT: u32 = 0;
/// An object that comes nearer to a cell's side than this part of the root's size has left the cell.
const NEAR: Real = 1.0 / (1u64 << 30) as Real;
/// The first root is this part of the scene's extent larger on each side, so that walls on the scene's border lie inside.
const MARGIN: Real = 1e-6;

/// Where a node lies beside its sister (figure 10), and where an object has left a cell.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Direction {
    /// the root; an object that is inside
    No,
    /// towards smaller x
    Left,
    /// towards larger x
    Right,
    /// towards smaller y
    Bottom,
    /// towards larger y
    Top,
    /// towards smaller z
    Back,
    /// towards larger z
    Front,
}

impl Direction {
    pub const LOW: [Direction; 3] = [Direction::Left, Direction::Bottom, Direction::Back];
    pub const HIGH: [Direction; 3] = [Direction::Right, Direction::Top, Direction::Front];

    /// The axis; x for `No`.
    pub fn axis(self) -> usize {
        match self {
            Direction::No | Direction::Left | Direction::Right => 0,
            Direction::Bottom | Direction::Top => 1,
            Direction::Back | Direction::Front => 2,
        }
    }

    /// Whether it points to larger coordinates.
    pub fn is_high(self) -> bool {
        matches!(self, Direction::Right | Direction::Top | Direction::Front)
    }
}

/// A box in the tree's own coordinates.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Span {
    pub low: [Real; 3],
    pub high: [Real; 3],
}

impl Span {
    /// The first root: coordinates are measured from the middle of the first scene, in units of its size, so that every
    /// side of every cell is a short binary fraction and halving and doubling are exact.
    pub const UNIT: Span = Span { low: [-0.5; 3], high: [0.5; 3] };
    /// What is not in the tree.
    pub const NOWHERE: Span = Span { low: [Real::INFINITY; 3], high: [Real::NEG_INFINITY; 3] };

    /// Whether the two meet; touching counts.
    #[inline]
    pub fn meets(&self, o: &Span) -> bool {
        (0..3).all(|k| self.low[k] <= o.high[k] && o.low[k] <= self.high[k])
    }
}

/// Node of the binary tree (the thesis's `TreeItem`).
#[derive(Clone, Copy, Debug)]
pub(super) struct Node {
    pub cell: Span,
    /// size of the cell in the tree's coordinates: powers of two, exact where `high - low` is rounded
    pub size: [Real; 3],
    /// first object of its list, and how many there are
    pub first: u32,
    pub num: u32,
    /// the lower of its two children, the other has the next place; [`NONE`]: a leaf
    pub child: u32,
    pub parent: u32,
    pub dir: Direction,
}

impl Node {
    pub const EMPTY: Node =
        Node { cell: Span::UNIT, size: [1.0; 3], first: NONE, num: 0, child: NONE, parent: NONE, dir: Direction::No };

    pub fn is_leaf(&self) -> bool {
        self.child == NONE
    }

    /// The place where the cell is halved across an axis.
    #[inline]
    pub fn middle(&self, axis: usize) -> Real {
        0.5 * (self.cell.low[axis] + self.cell.high[axis])
    }

    /// The lower or upper half.
    pub fn half(&self, axis: usize, high: bool, parent: u32) -> Node {
        let mut half = Node { cell: self.cell, size: self.size, parent, ..Node::EMPTY };
        half.size[axis] *= 0.5;
        if high {
            half.cell.low[axis] = self.middle(axis);
            half.dir = Direction::HIGH[axis];
        } else {
            half.cell.high[axis] = self.middle(axis);
            half.dir = Direction::LOW[axis];
        }
        half
    }

    /// The opposite of the direction in which the object has left the cell, `No` if it is inside. Being equal suffices for
    /// having left, and so does being nearer than `near`.
    #[inline]
    pub fn moved(&self, object: &Span, near: &[Real; 3]) -> Direction {
        for (k, &near) in near.iter().enumerate() {
            if object.low[k] <= self.cell.low[k] + near {
                return Direction::HIGH[k];
            }
            if object.high[k] >= self.cell.high[k] - near {
                return Direction::LOW[k];
            }
        }
        Direction::No
    }
}

/// The tree's coordinates in the world. They change only when the tree is built anew.
#[derive(Clone, Copy, Debug)]
pub(super) struct Frame {
    origin: Vec3,
    /// size of the first root \[m\]
    pub unit: Vec3,
    /// coordinates per length \[1/m\]; zero: the scene has no extent that numbers can hold
    scale: Vec3,
}

impl Frame {
    /// Everything is in one cell.
    pub const UNUSABLE: Frame = Frame { origin: Vec3::ZERO, unit: Vec3::ZERO, scale: Vec3::ZERO };

    /// The frame in which the scene's box, a little widened, is [`Span::UNIT`]. The margin is a part of the largest extent,
    /// so that a flat scene has cells with a volume; and it covers the rounding of corners far from the origin.
    pub fn of(extent: &Extent) -> Frame {
        let (low, high) = (extent.bounds.min, extent.bounds.max);
        let size = high - low;
        let largest = max(max(size.x, size.y), size.z);
        let margin = MARGIN * largest + extent.reach;
        let unit = size + Vec3::splat(2.0 * margin);
        let scale = Vec3::new(1.0 / unit.x, 1.0 / unit.y, 1.0 / unit.z);
        let usable = largest > 0.0 && unit.is_finite() && scale.is_finite();
        let origin = low * 0.5 + high * 0.5;
        if usable { Frame { origin, unit, scale } } else { Frame::UNUSABLE }
    }

    /// Whether the scene has an extent that can be divided.
    pub fn is_usable(&self) -> bool {
        self.scale != Vec3::ZERO
    }

    /// A box in the tree's coordinates. Rounding is monotone: boxes that meet do so in these coordinates.
    #[inline]
    pub fn span(&self, b: &Aabb) -> Span {
        if !self.is_usable() {
            return Span { low: [0.0; 3], high: [0.0; 3] };
        }
        let place = |p: Vec3| (p - self.origin).mul_elements(self.scale).to_array();
        Span { low: place(b.min), high: place(b.max) }
    }

    /// A cell in the world.
    pub fn bounds(&self, cell: &Span) -> Aabb {
        let place = |p: [Real; 3]| self.origin + Vec3::from(p).mul_elements(self.unit);
        Aabb { min: place(cell.low), max: place(cell.high) }
    }

    /// The axis along which a cell of this size is longest; of equally long ones the first.
    pub fn longest(&self, size: &[Real; 3]) -> usize {
        let length = Vec3::from(*size).mul_elements(self.unit);
        if length.x >= length.y && length.x >= length.z {
            0
        } else if length.y >= length.z {
            1
        } else {
            2
        }
    }
}

/// Nodes and the doubly linked lists of objects in them.
#[derive(Clone, Debug, Default)]
pub(super) struct Arena {
    pub nodes: Vec<Node>,
    /// lower places of pairs of nodes that are free
    free: Vec<u32>,
    /// by object: the node it is in, and its neighbours in that node's list
    pub node_of: Vec<u32>,
    next: Vec<u32>,
    pre: Vec<u32>,
}

impl Arena {
    /// Forgets all nodes but the root, which gets this cell, and all places of objects.
    pub fn reset(&mut self, root: Node, objects: usize) {
        self.nodes.clear();
        self.free.clear();
        self.node_of.clear();
        // What a much larger scene has left is given back.
        self.nodes.shrink_to(8 * objects + 2);
        self.free.shrink_to(4 * objects);
        self.nodes.extend([root, Node::EMPTY]);
        for list in [&mut self.node_of, &mut self.next, &mut self.pre] {
            list.shrink_to(4 * objects);
            list.resize(objects, NONE);
        }
    }

    /// Puts an object that is nowhere in front of a node's list.
    pub fn link(&mut self, object: u32, node: u32) {
        let n = &mut self.nodes[node as usize];
        let second = std::mem::replace(&mut n.first, object);
        n.num += 1;
        if second != NONE {
            self.pre[second as usize] = object;
        }
        self.next[object as usize] = second;
        self.pre[object as usize] = NONE;
        self.node_of[object as usize] = node;
    }

    /// Takes an object out of its list.
    pub fn unlink(&mut self, object: u32) {
        let (pre, next) = (self.pre[object as usize], self.next[object as usize]);
        let node = &mut self.nodes[self.node_of[object as usize] as usize];
        node.num -= 1;
        if pre == NONE {
            node.first = next;
        } else {
            self.next[pre as usize] = next;
        }
        if next != NONE {
            self.pre[next as usize] = pre;
        }
        self.node_of[object as usize] = NONE;
    }

    /// Moves an object to another node; the object that followed it (the thesis's `moveItem`).
    pub fn move_item(&mut self, object: u32, node: u32) -> u32 {
        let next = self.next[object as usize];
        self.unlink(object);
        self.link(object, node);
        next
    }

    /// The object listed after this one.
    #[inline]
    pub fn next(&self, object: u32) -> u32 {
        self.next[object as usize]
    }

    /// The objects listed in a node.
    pub fn listed(&self, node: u32) -> impl Iterator<Item = u32> + '_ {
        self.from(self.nodes[node as usize].first)
    }

    /// The objects of a list from this one on.
    #[inline]
    pub fn from(&self, object: u32) -> impl Iterator<Item = u32> + '_ {
        let some = |o: u32| if o == NONE { None } else { Some(o) };
        std::iter::successors(some(object), move |&o| some(self.next(o)))
    }

    /// Room for two sisters; the lower place.
    pub fn take_pair(&mut self, nodes: [Node; 2]) -> u32 {
        if let Some(place) = self.free.pop() {
            self.nodes[place as usize..place as usize + 2].copy_from_slice(&nodes);
            return place;
        }
        self.nodes.extend(nodes);
        self.nodes.len() as u32 - 2
    }

    /// Gives the room of two sisters back.
    pub fn free_pair(&mut self, place: u32) {
        self.free.push(place);
    }

    /// Number of nodes in the tree.
    pub fn count(&self) -> usize {
        (self.nodes.len() - 2 * self.free.len()).saturating_sub(1)
    }

    /// Puts the content of one node at another's place: its list and its children follow it.
    pub fn rehouse(&mut self, node: Node, place: u32) {
        self.nodes[place as usize] = node;
        if !node.is_leaf() {
            self.nodes[node.child as usize].parent = place;
            self.nodes[node.child as usize + 1].parent = place;
        }
        let mut object = node.first;
        while object != NONE {
            self.node_of[object as usize] = place;
            object = self.next[object as usize];
        }
    }
}

/// How near to a side of a cell an object must come to have left it, for a root of this size.
pub(super) fn nearness(root: &Node) -> [Real; 3] {
    root.size.map(|s| s * NEAR)
}
