//! Errors of the sampling, each of which stops the control loop.

use thermal_display::device::safety::Fault;

/// Why a control tick has no valid samples. Each of these errors turns all bridges off and stops
/// sampling until the next reset.
#[derive(Clone, Copy, Debug, defmt::Format)]
pub enum SampleError {
    /// The DMA stream that stores the conversions has reported an error, or its blocks could not be
    /// exchanged.
    Bus,
    /// The DMA stream overwrote a block before the control tick took it: the tick before took
    /// longer than its period, 1 ms divided by the number of fingers.
    Late,
    /// The control tick switched the multiplexers only after the first scan of the next finger's
    /// block, so that the samples may belong to the wrong finger.
    LateSwitch,
    /// A block was complete too early or too late by more than a quarter of its period (1 ms
    /// divided by the number of fingers), as measured by SysTick: TIM2 or SysTick runs at a wrong
    /// rate.
    TickRate,
    /// The register RCC_CFGR, with the source and the prescalers of the clocks, has changed since
    /// the start.
    Clocks,
    /// ADC1 has lost a conversion, because the DMA stream did not fetch the conversion before it in
    /// time.
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
