//! Integrators of translation: the motion of one body under a constant acceleration in a medium of constant flow.
//! Where fields vary, `varying` evaluates them along the way and uses the same formulas.

use crate::math::{Real, Vec3};

/// The drag of the medium over a step.
///
/// Decision (the thesis gives no formula): v relaxes to the flow u as (1 - viscosity)^(t / 1 s), that is
/// v' = a - k (v - u) with k = -ln(1 - viscosity), whose solution for constant a and u is, with z = k t,
/// v(t) = u + (v - u) e^-z + a t f1(z), x(t) = x + u t + (v - u) t f1(z) + a t^2 f2(z),
/// f1(z) = (1 - e^-z)/z, f2(z) = (e^-z - 1 + z)/z^2. Without viscosity f1 = 1 and f2 = 1/2: the parabola.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Drag {
    /// length of the step \[s\]
    pub dt: Real,
    /// k \[1/s\]; infinite for viscosity 1
    pub rate: Real,
    /// e^-z: what is left of a velocity relative to the flow
    pub decay: Real,
    /// t f1(z) \[s\]: the way of a body that starts with unit velocity, and the velocity by unit acceleration
    pub reach: Real,
    /// t^2 f2(z) \[s2\]: the way by unit acceleration
    pub fall: Real,
}

impl Drag {
    /// The drag over a step of `dt` \[s\] in a medium of this viscosity, 0 to 1.
    pub fn new(viscosity: Real, dt: Real) -> Drag {
        if viscosity == 0.0 {
            return Drag { dt, rate: 0.0, decay: 1.0, reach: dt, fall: 0.5 * (dt * dt) };
        }
        if viscosity >= 1.0 {
            return Drag { dt, rate: Real::INFINITY, decay: 0.0, reach: 0.0, fall: 0.0 };
        }
        let rate = -libm::log1p(-viscosity);
        let z = rate * dt;
        Drag { dt, rate, decay: libm::exp(-z), reach: -libm::expm1(-z) / rate, fall: dt * dt * second(z) }
    }

    /// Whether there is no medium.
    #[inline]
    pub fn is_void(&self) -> bool {
        self.rate == 0.0
    }

    /// Whether velocities are those of the flow at once (viscosity 1).
    #[inline]
    pub fn is_rigid(&self) -> bool {
        self.rate == Real::INFINITY
    }

    /// Velocity after the step, from `v`, with acceleration `a` and flow `u`.
    #[inline]
    pub fn velocity(&self, v: Vec3, a: Vec3, u: Vec3) -> Vec3 {
        u + (v - u) * self.decay + a * self.reach
    }

    /// Way in the step.
    #[inline]
    pub fn way(&self, v: Vec3, a: Vec3, u: Vec3) -> Vec3 {
        u * self.dt + (v - u) * self.reach + a * self.fall
    }

    /// Velocity after drag alone: what the Euler schemes apply after the acceleration.
    #[inline]
    pub fn brake(&self, v: Vec3, u: Vec3) -> Vec3 {
        u + (v - u) * self.decay
    }
}

/// (e^-z - 1 + z)/z^2 = 1/2 - z/6 + z^2/24 - ...: the series where the closed form would cancel.
fn second(z: Real) -> Real {
    if z >= 1.0 {
        return (libm::expm1(-z) + z) / (z * z);
    }
    // 1/(n + 2)! falls below 1e-18 for n = 18; Horner's scheme from the far end.
    let mut sum = 0.0;
    for n in (1..=18u32).rev() {
        sum = (1.0 - sum) * z / Real::from(n + 2);
    }
    0.5 * (1.0 - sum)
}

/// A body's position and velocity after a step.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Moved {
    /// position \[m\]
    pub x: Vec3,
    /// velocity \[m/s\]
    pub v: Vec3,
    /// velocity before the drag of an Euler scheme was applied: what drag took is the difference of energies \[m/s\]
    pub undamped: Vec3,
}

/// The exact motion for constant acceleration and flow. `VOID`: there is no drag, and no need to know the flow.
#[inline]
pub fn parabola<const VOID: bool>(x: Vec3, v: Vec3, a: Vec3, u: Vec3, drag: &Drag) -> Moved {
    if VOID {
        let next = v + a * drag.dt;
        return Moved { x: x + (v * drag.dt + a * drag.fall), v: next, undamped: next };
    }
    let next = drag.velocity(v, a, u);
    Moved { x: x + drag.way(v, a, u), v: next, undamped: next }
}

/// Explicit Euler, the order of the thesis: x += v dt, then v += a dt, then drag.
#[inline]
pub fn explicit_euler(x: Vec3, v: Vec3, a: Vec3, u: Vec3, drag: &Drag) -> Moved {
    let undamped = v + a * drag.dt;
    Moved { x: x + v * drag.dt, v: if drag.is_void() { undamped } else { drag.brake(undamped, u) }, undamped }
}

/// Semi-implicit Euler: v += a dt, then drag, then x += v dt.
#[inline]
pub fn semi_implicit_euler(x: Vec3, v: Vec3, a: Vec3, u: Vec3, drag: &Drag) -> Moved {
    let undamped = v + a * drag.dt;
    let v = if drag.is_void() { undamped } else { drag.brake(undamped, u) };
    Moved { x: x + v * drag.dt, v, undamped }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn coefficients_keep_their_digits() {
        // The series and the closed form meet.
        for z in [1.0, 1.5, 3.0] {
            let mut series = 0.0;
            for n in (1..=40u32).rev() {
                series = (1.0 - series) * z / Real::from(n + 2);
            }
            assert!((second(z) - 0.5 * (1.0 - series)).abs() < 1e-15, "{z}");
        }
        assert!((second(0.999_999_999) - second(1.0)).abs() < 1e-9);
        assert_eq!(second(0.0), 0.5);
        assert!((second(1e-8) - (0.5 - 1e-8 / 6.0)).abs() < 1e-16);
        // No viscosity is the limit of little viscosity.
        let (none, little) = (Drag::new(0.0, 0.125), Drag::new(1e-17, 0.125));
        for (a, b) in [(none.decay, little.decay), (none.reach, little.reach), (none.fall, little.fall)] {
            assert!((a - b).abs() <= 1e-16, "{a} {b}");
        }
    }
}
