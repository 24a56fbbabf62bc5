//! Smallest enclosing spheres.
use crate::bounds::Ball;
use crate::math::Vec3;
/// Smallest sphere that holds all the points.
pub fn smallest_enclosing_sphere(_points: &[Vec3]) -> Ball {
    Ball::EMPTY
}
