//! Errors of the sampling, each of which stops the control loop.

use thermal_display::device::safety::Fault;

/// Why a control tick has no valid samples. Each of these errors turns all bridges off, trips all
/// fingers by the fault that [`fault`](Self::fault) returns, and stops sampling, so that the
/// watchdogs reset the device.
#[derive(Clone, Copy, Debug, defmt::Format)]
pub enum SampleError {
    /// The DMA stream that stores the conversions has reported an error, or the control tick could
    /// not exchange the full block for an empty one.
    Bus,
    /// The DMA stream overwrote a full block before the control tick took it: the tick came more
    /// than one block period (1 ms divided by the number of fingers) after the block was full.
    Late,
    /// The control tick switched the multiplexers only after the first scan of the next finger's
    /// block, so that the samples may belong to the wrong finger.
    LateSwitch,
    /// The control tick came early or late by more than a quarter of its period (1 ms divided by
    /// the number of fingers), compared with the time at which it was due by SysTick: TIM2 or
    /// SysTick runs at a wrong rate, or the tick was delayed.
    TickRate,
    /// The register RCC_CFGR, with the source and the prescalers of the clocks, has changed since
    /// the start, or the clock security system has been switched off.
    Clocks,
    /// ADC1 has lost a conversion: its result was ready before the DMA stream had fetched the one
    /// before.
    Overrun,
}

impl SampleError {
    /// The fault by which this error trips all fingers.
    pub const fn fault(self) -> Fault {
        match self {
            Self::Bus | Self::Late | Self::LateSwitch | Self::TickRate | Self::Overrun => {
                Fault::Sampling
            }
            Self::Clocks => Fault::Clock,
        }
    }
}
