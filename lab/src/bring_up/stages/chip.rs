//! The microcontroller: option bytes, clock, watchdogs, and its pins in reset.

use super::super::check::{ManualStep, Reading, Routine, Stage, StageId, Step, Value};
use super::super::unit::Unit::Volt;
use super::{manual, meter, read, routine};

pub const CHIP: Stage = Stage {
    id: StageId::Chip,
    name: "chip",
    title: "Microcontroller: firmware, option bytes, clock, watchdogs, locks",
    needs: ManualStep {
        say: "USB plugged in, then 12 V with a limit of 0.2 A, emergency stop pressed.",
        lines: &["press stop", "fit usb", "fit supply"],
    },
    steps: &[
        routine(Routine::Identify),
        read(
            "brown-out-level",
            "brown-out level, BOR_LEV of the option bytes",
            Reading::Board(|board| Value::Word(board.bor.to_string())),
        )
            .words(&["3"])
            .basis("level 3 resets below some 2.8 V; flash wait states at 180 MHz are specified from \
                 2.7 V on")
            .low("the brown-out level is not 3: set BOR_LEV of the option bytes to 00, \
                 `STM32_Programmer_CLI -c port=SWD -ob BOR_LEV=0`, then switch everything off and on")
            .blocks(StageId::Latch)
            .step(),
        read(
            "clock",
            "clock",
            Reading::Board(|board| Value::Word(board.clock.name().into())),
        )
            .words(&["hse"])
            .basis("8 MHz from the probe")
            .low("the 8 MHz clock of the probe does not reach PH0: close SB16 and SB50 (open on \
                 MB1136 C-01), or USB is not plugged in. The device restarts by itself one second after the \
                 clock has come")
            .blocks(StageId::Latch)
            .step(),
        read(
            "watchdogs",
            "watchdogs",
            Reading::Board(|board| Value::Word(board.watchdogs.name().into())),
        )
            .words(&["running"])
            .basis("DBGMCU_APB1_FZ has no bit of IWDG or WWDG")
            .low("a debugger has frozen the watchdogs (DBGMCU_APB1_FZ): remove it, and switch \
                 everything off, USB included")
            .blocks(StageId::Latch)
            .step(),
        read(
            "pwm-lock",
            "lock of the PWM timer",
            Reading::Board(|board| Value::Word(board.pwm_lock.to_string())),
        )
            .words(&["3"])
            .basis("LOCK level 3 of TIM1_BDTR, read back")
            .low("the PWM timer's settings are not locked (TIM1_BDTR): not the firmware of this \
                 repository, or a chip on which the lock does not take effect; do not drive a bridge")
            .blocks(StageId::Latch)
            .step(),
    ],
};

const IN_RESET: &str = "hold the Nucleo's reset button and measure from the pin to analog ground (CN7-20); \
                 look with an oscilloscope for pulses when you press and release it";

/// A pin that must stay low while the microcontroller is in reset.
const fn low_in_reset(
    name: &'static str,
    what: &'static str,
    point: &'static str,
    finding: &'static str,
) -> Step {
    meter(name, what, point, IN_RESET)
        .range(0.0, 0.4, Volt)
        .basis("the pull-down holds it; an input is low below 0.8 V")
        .high(finding)
        .blocks(StageId::Supply)
        .step()
}

pub const RESET: Stage = Stage {
    id: StageId::Reset,
    name: "reset",
    title: "Pins of the bridge while the microcontroller is in reset",
    needs: ManualStep {
        say: "USB plugged in, then 12 V with a limit of 0.2 A, emergency stop pressed.",
        lines: &["press stop", "fit usb", "fit supply"],
    },
    steps: &[
        manual("Hold the Nucleo's reset button (B2) during the next readings.", &["press reset"]),
        low_in_reset(
            "in1-in-reset",
            "bridge IN1, PA8 (D7), in reset",
            "volt in1",
            "bridge IN1, PA8 (D7), is not low in reset: pull-down R1 (4.7 kΩ, block bridge)",
        ),
        low_in_reset(
            "in2-in-reset",
            "bridge IN2, PA9 (D8), in reset",
            "volt in2",
            "bridge IN2, PA9 (D8), is not low in reset: pull-down R2 (4.7 kΩ, block bridge)",
        ),
        low_in_reset(
            "enable-in-reset",
            "bridge enable, PB10 (D6), in reset",
            "volt enable",
            "bridge enable, PB10 (D6), is not low in reset: pull-down R3 (4.7 kΩ, block bridge)",
        ),
        low_in_reset(
            "test-in-reset",
            "comparator test, PC3 (CN7-37), in reset",
            "volt test",
            "comparator test, PC3 (CN7-37), is not low in reset: pull-down R8 (4.7 kΩ, block \
                 comparator)",
        ),
        low_in_reset(
            "boot0",
            "BOOT0, CN7-7",
            "volt boot0",
            "BOOT0, CN7-7, is not low: its pull-down (4.7 kΩ), or VDD beside it, CN7-5",
        ),
        manual("Release the reset button.", &["release reset"]),
        routine(Routine::Wait(1000)),
    ],
};
