//! ADC1 on what it can convert without a wire: reference, temperature, a quarter of the supply, and the output of the DAC, which
//! shares the pin PA4 with channel 4.

/// What the factory has measured at 3.3 V and stored in the system memory (data sheet, embedded reference voltage and
/// temperature sensor).
struct Factory;

impl Factory {
    const SUPPLY_MV: u32 = 3300;
    const REFERENCE: *const u16 = 0x1fff_7a2a as *const u16;
    /// At 30 and 110 °C.
    const TEMPERATURES: [*const u16; 2] = [0x1fff_7a2c as *const u16, 0x1fff_7a2e as *const u16];

    fn counts(address: *const u16) -> f32 {
        // SAFETY: the address is that of a calibration value in the system memory.
        f32::from(unsafe { address.read_volatile() })
    }
}

#[embedded_test::tests]
mod tests {
    use stm32f4xx_hal::pac::{ADC_COMMON, ADC1, DAC, GPIOA, Peripherals, RCC};

    use super::Factory;
    use crate::report;

    /// Channels of the internal signals (RM0390, 13.10 and 13.11).
    const REFERENCE: u8 = 17;
    const TEMPERATURE_OR_SUPPLY: u8 = 18;
    const CONVERSIONS: u32 = 1024;

    /// Mean, standard deviation and spread of many conversions, counts.
    struct Statistics {
        mean: f32,
        deviation: f32,
        spread: u16,
    }

    #[init]
    fn set_up() -> ADC1 {
        let peripherals = Peripherals::take().expect("once in a test");
        enable_clock(&peripherals.RCC);
        let adc = peripherals.ADC1;
        // 480 cycles of 8 MHz: the internal signals need 10 us (data sheet).
        adc.smpr1().write(|w| {
            w.smp17().cycles480();
            w.smp18().cycles480()
        });
        adc.cr2().write(|w| w.adon().enabled());
        select_internal_signal(false);
        // The converter takes 3 us to start, the reference and the temperature sensor 10 us; the core runs at 16 MHz.
        cortex_m::asm::delay(20 * 16);
        adc
    }

    fn enable_clock(rcc: &RCC) {
        rcc.apb2enr().modify(|_, w| w.adc1en().enabled());
        cortex_m::asm::dsb();
    }

    /// Channel 18 converts a quarter of the supply or, like channel 17 the reference, the temperature.
    fn select_internal_signal(supply: bool) {
        // SAFETY: only ADC1 is used.
        let common = unsafe { ADC_COMMON::steal() };
        common.ccr().write(|w| {
            w.adcpre().div2();
            w.vbate().bit(supply);
            w.tsvrefe().bit(!supply)
        });
    }

    fn convert(adc: &ADC1, channel: u8) -> u16 {
        // SAFETY: ADC1 has this channel.
        adc.sqr3().write(|w| unsafe { w.sq1().bits(channel) });
        adc.cr2().modify(|_, w| w.swstart().start());
        while adc.sr().read().eoc().bit_is_clear() {}
        adc.dr().read().data().bits()
    }

    fn statistics(adc: &ADC1, channel: u8) -> Statistics {
        let first = i32::from(convert(adc, channel));
        let (mut sum, mut squares, mut least, mut most) = (0, 0, u16::MAX, 0);
        for _ in 0..CONVERSIONS {
            let code = convert(adc, channel);
            let difference = i32::from(code) - first;
            sum += difference;
            squares += difference * difference;
            (least, most) = (least.min(code), most.max(code));
        }
        let mean = sum as f32 / CONVERSIONS as f32;
        Statistics {
            mean: first as f32 + mean,
            deviation: libm::sqrtf((squares as f32 / CONVERSIONS as f32 - mean * mean).max(0.0)),
            spread: most - least,
        }
    }

    fn supply_mv(adc: &ADC1) -> f32 {
        let factory = Factory::counts(Factory::REFERENCE);
        Factory::SUPPLY_MV as f32 * factory / statistics(adc, REFERENCE).mean
    }

    #[test]
    fn the_reference_gives_a_supply_of_3_3_v_with_little_noise(adc: ADC1) {
        let reference = statistics(&adc, REFERENCE);
        let supply_mv = supply_mv(&adc);
        report::figure("supply", format_args!("{supply_mv:.0}"), "mV");
        report::figure("converter_noise", format_args!("{:.2}", reference.deviation), "counts rms");
        report::figure("converter_spread", reference.spread, "counts");
        assert!((3200.0..3400.0).contains(&supply_mv), "{supply_mv} mV");
        assert!(reference.deviation < 3.0 && reference.spread < 40);
    }

    #[test]
    fn the_chip_has_the_temperature_of_a_room(adc: ADC1) {
        let supply_mv = supply_mv(&adc);
        let counts = statistics(&adc, TEMPERATURE_OR_SUPPLY).mean;
        let [at_30, at_110] = Factory::TEMPERATURES.map(Factory::counts);
        let at_factory_supply = counts * supply_mv / Factory::SUPPLY_MV as f32;
        let chip_c = 30.0 + 80.0 * (at_factory_supply - at_30) / (at_110 - at_30);
        report::figure("chip_temperature", format_args!("{chip_c:.1}"), "C");
        assert!((5.0..60.0).contains(&chip_c), "{chip_c} C");
    }

    /// The NUCLEO connects VBAT to the supply that is also the converter's reference, so a quarter of it is a quarter of the
    /// range: with the reference the second point of a straight line through zero.
    #[test]
    fn a_quarter_of_the_supply_is_a_quarter_of_the_range(adc: ADC1) {
        select_internal_signal(true);
        cortex_m::asm::delay(20 * 16);
        let quarter = statistics(&adc, TEMPERATURE_OR_SUPPLY).mean;
        select_internal_signal(false);
        report::figure("quarter_of_supply", format_args!("{quarter:.2}"), "counts");
        // The divider has 1 % (data sheet, VBAT monitoring).
        assert!((1024.0 - 12.0..1024.0 + 12.0).contains(&quarter), "{quarter} counts");
    }

    /// Both converters have a straight characteristic between their ends; their offsets and gains do not count.
    #[test]
    fn the_converter_is_linear_over_the_range_of_the_dac(adc: ADC1) {
        /// The data sheet allows 4 counts to the DAC and 3 to ADC1.
        const DEVIATION_MAX: f32 = 7.0;
        /// Without its buffer the DAC has 15 kOhm, and is not exact at the ends of its range.
        const CODES: [u16; 15] =
            [128, 400, 672, 944, 1216, 1488, 1760, 2032, 2304, 2576, 2848, 3120, 3392, 3664, 3936];
        const DAC_CHANNEL: u8 = 4;
        // SAFETY: nothing else uses them.
        let (rcc, port, dac) = unsafe { (RCC::steal(), GPIOA::steal(), DAC::steal()) };
        rcc.ahb1enr().modify(|_, w| w.gpioaen().enabled());
        rcc.apb1enr().modify(|_, w| w.dacen().enabled());
        cortex_m::asm::dsb();
        port.moder().modify(|_, w| w.moder4().analog());
        adc.smpr2().write(|w| w.smp4().cycles480());
        dac.cr().write(|w| {
            w.boff1().disabled();
            w.en1().enabled()
        });
        let counts = CODES.map(|code| {
            dac.dhr12r1().write(|w| w.daccdhr().set(code));
            cortex_m::asm::delay(50 * 16);
            statistics(&adc, DAC_CHANNEL).mean
        });
        dac.cr().reset();
        let [first, .., last] = counts;
        let ends = (f32::from(CODES[0]), f32::from(CODES[CODES.len() - 1]));
        let slope = (last - first) / (ends.1 - ends.0);
        let deviations = CODES
            .iter()
            .zip(counts)
            .map(|(code, counts)| (counts - first - slope * (f32::from(*code) - ends.0)).abs());
        let worst = deviations.fold(0.0, f32::max);
        report::figure("converter_linearity", format_args!("{worst:.2}"), "counts");
        report::line(format_args!("{slope:.4} counts of ADC1 for a count of the DAC"));
        assert!(worst <= DEVIATION_MAX && (slope - 1.0).abs() < 0.02);
    }
}
