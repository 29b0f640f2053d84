//! The converter of the heat-flux sensor: ADC2, which converts once a tick.

use stm32f4xx_hal::gpio::{Analog, PC5};
use stm32f4xx_hal::pac::ADC2;
use stm32f4xx_hal::rcc::{Enable, Rcc};

/// ADC2 with the heat-flux sensor on its input 15.
///
/// A tick begins when ADC1 has ended a scan. The conversion that it starts takes 480 + 12 cycles at 22.5 MHz, 21.9 us, and so ends
/// before the next scan, which begins 38 us later: the converters do not disturb each other.
pub struct FluxConverter {
    adc: ADC2,
    _input: PC5<Analog>,
}

impl FluxConverter {
    /// Sets up ADC2. To be called after the set-up of ADC1, which resets all converters and sets their common clock. No conversion
    /// may start within the next 3 us (datasheet, t_STAB).
    pub fn new(adc: ADC2, input: PC5<Analog>, rcc: &mut Rcc) -> Self {
        ADC2::enable(rcc);
        adc.smpr1().write(|w| w.smp15().cycles480());
        // SAFETY: ADC2 has this channel, PC5.
        adc.sqr3().write(|w| unsafe { w.sq1().bits(15) });
        adc.cr2().write(|w| w.adon().enabled());
        Self { adc, _input: input }
    }

    /// Returns the code, 0 to 4095, of the conversion that the last call has started, and starts the next one. `None` if it has not
    /// ended, and at the first call.
    #[inline(always)]
    pub fn take_code_and_start_next(&mut self) -> Option<u16> {
        let has_ended = self.adc.sr().read().eoc().is_complete();
        let code = has_ended.then(|| self.adc.dr().read().data().bits());
        (self.adc.cr2()).write(|w| w.adon().enabled().swstart().start());
        code
    }
}
