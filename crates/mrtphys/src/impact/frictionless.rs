//! The frictionless impact, thesis section 3.8.2, equations (41) to (53).

use super::{Encounter, ImpactLaw, Impulse};

/// The impulse acts along the contact normal alone.
///
/// On the line `dp1 = s n` the kinetic energy changes by `s (v12.n) + s^2 B(n)/2`, with `B(n) = n.K.n` (53). It is restored by
/// the non-zero root `s = -2 (v12.n)/B(n)` (the sign that got lost between (47) and (50)); restitution e makes the 2 a 1 + e:
/// the approach speed then becomes -e times what it was, and the energy changes by `-(1 - e^2)/2 (v12.n)^2/B(n) <= 0`.
#[derive(Clone, Copy, Debug)]
pub struct Frictionless;

impl ImpactLaw for Frictionless {
    fn is_frictionless_at_zero(&self) -> bool {
        true
    }

    fn name(&self) -> &str {
        "frictionless"
    }

    fn impulse(&self, e: &Encounter) -> Option<Impulse> {
        let on_a = e.frictionless_impulse()?;
        Some(Impulse { on_a, fallback: false })
    }
}
