//! Errors of the sampling, each of which stops the control loop.

use thermal_display::device::safety::Fault;

/// Why there is no valid block of samples.
#[derive(Clone, Copy, Debug, defmt::Format)]
pub enum SampleError {
    /// The DMA stream has reported an error.
    Bus,
    /// A block was overwritten before the tick took it: the last tick took longer than its period.
    Late,
    /// The multiplexers were switched after the first scan of the next block.
    LateSwitch,
    /// A block was complete too early or too late: TIM2 or SysTick runs at a wrong rate.
    TickRate,
    /// The clock settings have changed since the start.
    Clocks,
    /// The converter has lost a conversion, because the stream did not fetch the one before in
    /// time.
    Overrun,
}

impl SampleError {
    /// The fault that this error trips.
    pub const fn fault(self) -> Fault {
        match self {
            Self::Bus | Self::Late | Self::LateSwitch | Self::TickRate | Self::Overrun => {
                Fault::Sampling
            }
            Self::Clocks => Fault::Clock,
        }
    }
}
