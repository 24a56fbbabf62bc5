//! The motion stage.
use crate::counters::Counters;
use crate::ledger::Ledger;
use crate::math::Real;
use crate::model::Model;
use crate::state::State;
use crate::work::Work;
/// Moves and turns every body for `dt`.
pub fn advance(
    _model: &Model,
    _state: &mut State,
    _work: &mut Work,
    _dt: Real,
    _ledger: &mut Ledger,
    _counters: &mut Counters,
) -> crate::error::Result<()> {
    Ok(())
}
