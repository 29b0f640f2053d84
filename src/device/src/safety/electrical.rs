//! The current that is measured against the one that was asked for.

use super::Fault;
use super::lasting::Lasting;
use crate::drive::Current;

/// Most that they differ: this, and a quarter of what is asked for. Modules, leads and supply differ from their class
/// by 10 %, the mirror by 5, and near zero the bridge's dead times make up to half an ampere.
const APART: Current = Current::lit("1");
const APART_SHIFT: u32 = 2;
/// For how many ticks: a driver that is overloaded tries again every 4 ms and tells so by its fault pin first.
const TICKS: u8 = 30;

/// How long it has been wrong, either way: what a leg that is stuck does turns with the current that is asked for.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Electrical(Lasting);

impl Electrical {
    /// Takes one tick: the current asked for in the one before, none while the bridge was off, and the magnitude
    /// measured since.
    ///
    /// # Errors
    /// Too much or too little has flowed for 30 ms; named after what flows at their end.
    pub fn check(&mut self, asked: Current, measured: Current) -> Result<(), Fault> {
        let asked = asked.saturating_abs();
        let apart = APART.saturating_add(asked >> APART_SHIFT);
        let high = measured > asked.saturating_add(apart);
        let low = measured < asked.saturating_sub(apart);
        if !self.0.has(high || low, TICKS) {
            Ok(())
        } else if high {
            Err(Fault::CurrentHigh)
        } else {
            Err(Fault::CurrentLow)
        }
    }
}
