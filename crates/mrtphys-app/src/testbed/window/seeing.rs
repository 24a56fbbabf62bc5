//! How the user looks at the scene: what is drawn over it, what is followed, whether the hand is on.

use crate::testbed::session::Wish;
use mrtphys::BodyId;
use mrtphys_view::{Coloring, Drawn, Legend};

/// Something that can be drawn over the bodies.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Layer {
    /// contact points and normals
    Contacts,
    /// impulses of impacts
    Impulses,
    /// velocities
    Velocities,
    /// angular velocities
    Spins,
    /// where bodies have been
    Trails,
    /// bounding spheres
    Balls,
    /// axis-parallel boxes
    Boxes,
    /// cells of the broad phase
    Cells,
}

impl Layer {
    /// All of them: name, and what it is.
    pub const ALL: [(Layer, &'static str, &'static str); 8] = [
        (
            Layer::Contacts,
            "Contacts and normals",
            "where bodies touch in the last step, with the normal from the first body to the second",
        ),
        (
            Layer::Impulses,
            "Impulses",
            "impulses of the latest impacts; the length goes with the square root of the impulse",
        ),
        (Layer::Velocities, "Velocities", "velocities of the centres of mass"),
        (Layer::Spins, "Angular velocities", "axes of rotation, with an arc in the sense of rotation"),
        (Layer::Trails, "Trails", "where bodies have been, from the recording"),
        (Layer::Balls, "Bounding spheres", "the spheres that are tested first"),
        (Layer::Boxes, "Bounding boxes", "the axis-parallel boxes that the grids use"),
        (
            Layer::Cells,
            "Cells",
            "cells of the grid, tinted by their number of objects, or of the tree, tinted by their depth",
        ),
    ];

    fn bit(self) -> u8 {
        1 << self as u8
    }
}

/// Longest trail \[frames\].
pub const LONGEST_TRAIL: usize = 1000;

/// What is drawn over the bodies, and how they are colored: what a picture depends on.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sight {
    layers: u8,
    /// how bodies are colored
    pub coloring: Coloring,
    /// length of trails \[frames\]
    pub trail: usize,
    /// the selected body has a trail, whatever the others have
    pub trail_of_selected: bool,
}

impl Default for Sight {
    fn default() -> Sight {
        Sight { layers: 0, coloring: Coloring::Own, trail: 120, trail_of_selected: false }
    }
}

impl Sight {
    /// Whether a layer is on.
    pub fn has(&self, layer: Layer) -> bool {
        self.layers & layer.bit() != 0
    }

    /// Switches a layer.
    pub fn set(&mut self, layer: Layer, on: bool) {
        self.layers = if on { self.layers | layer.bit() } else { self.layers & !layer.bit() };
    }

    /// Asks for what is needed to draw it, and for nothing more.
    pub fn wish(&self, wish: &mut Wish) {
        wish.contacts |= self.has(Layer::Contacts) || self.coloring.needs_contacts();
        wish.impacts |= self.has(Layer::Impulses);
        wish.velocities |= self.has(Layer::Velocities) || self.has(Layer::Spins) || self.coloring.needs_velocities();
        wish.boxes |= self.has(Layer::Boxes);
        wish.cells |= self.has(Layer::Cells);
        if self.has(Layer::Trails) || self.trail_of_selected && wish.selected.is_some() {
            wish.trail = wish.trail.max(self.trail.min(LONGEST_TRAIL));
        }
    }
}

/// The user's way of looking.
#[derive(Clone, Debug)]
pub struct Seeing {
    /// what is drawn over the bodies, and how they are colored
    pub sight: Sight,
    /// whether name and speed stand beside the body under the mouse and the selected one
    pub labels: bool,
    /// whether the camera follows the selected body
    pub follow: bool,
    /// whether a left drag on a body pulls it
    pub hand: bool,
    /// the body that the camera is to be turned to
    pub look_at: Option<BodyId>,
    /// what was drawn of what there is
    pub drawn: Vec<(Layer, Drawn)>,
    /// what the colors mean
    pub legends: Vec<Legend>,
}

impl Default for Seeing {
    fn default() -> Seeing {
        Seeing {
            sight: Sight::default(),
            labels: true,
            follow: false,
            hand: false,
            look_at: None,
            drawn: Vec::new(),
            legends: Vec::new(),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_off_costs_nothing() {
        let mut wish = Wish::default();
        Sight::default().wish(&mut wish);
        assert_eq!(wish, Wish::default());
    }

    #[test]
    fn layers_are_independent_and_ask_for_what_they_need() {
        for (layer, ..) in Layer::ALL {
            let mut seeing = Sight::default();
            seeing.set(layer, true);
            let on: Vec<Layer> = Layer::ALL.iter().map(|l| l.0).filter(|l| seeing.has(*l)).collect();
            assert_eq!(on, [layer]);
            let mut wish = Wish::default();
            seeing.wish(&mut wish);
            assert_eq!(
                wish == Wish::default(),
                layer == Layer::Balls,
                "{layer:?}: only bounding spheres are known already"
            );
            seeing.set(layer, false);
            assert_eq!(seeing, Sight::default());
        }
    }

    #[test]
    fn a_trail_of_nobody_is_not_asked_for() {
        let seeing = Sight { trail_of_selected: true, trail: 5000, ..Sight::default() };
        let mut wish = Wish::default();
        seeing.wish(&mut wish);
        assert_eq!(wish.trail, 0);
        wish.selected = Some(BodyId::from_parts(0, 0, 0));
        seeing.wish(&mut wish);
        assert_eq!(wish.trail, LONGEST_TRAIL);
    }
}
