//! The plane quadrangle (thesis, sections 6.6.3 and A.16).
use super::{MassProperties, Shape};
use crate::bounds::Ball;
use crate::math::{Real, Vec3};
/// A thin plane convex quadrangle; its centre of mass is the origin of its coordinates.
#[derive(Clone, Debug, PartialEq)]
pub struct Quadrangle {
    pub(crate) corners: [Vec3; 4],
    pub(crate) normal: Vec3,
    pub(crate) ball: Ball,
    pub(crate) mass: MassProperties,
    pub(crate) author_origin: Vec3,
}
impl Shape for Quadrangle {
    fn kind(&self) -> &'static str {
        "quadrangle"
    }
    fn bounding_sphere(&self) -> Ball {
        self.ball
    }
    fn mass_properties(&self) -> Option<MassProperties> {
        Some(self.mass)
    }
    fn volume(&self) -> Real {
        0.0
    }
    fn author_origin(&self) -> Vec3 {
        self.author_origin
    }
}
