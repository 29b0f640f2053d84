//! The machine's registers against a description that others wrote (`stm32f446.csv`, see `generate.py`), bit by bit.
//!
//! For every register of a modelled peripheral: it has its reset value; a bit that can be written keeps what is written, or
//! ends the run; a bit that cannot be written does not change; a flag is cleared as the table says. `exceptions.toml` has
//! what differs and why. Core registers have no such table.
use super::tests::Bench;
use crate::names;
use crate::stop::Refusal;
use serde::Deserialize;
use std::collections::{BTreeMap, BTreeSet};

/// A row of the table.
struct Register {
    name: String,
    address: u32,
    readable: bool,
    is_writable: bool,
    reset: u32,
    writable: u32,
    /// Bits that a write of 1, and of 0, clears or sets.
    one_modifies: u32,
    zero_modifies: u32,
}

fn table() -> Vec<Register> {
    let rows = include_str!("stm32f446.csv").lines().skip(2);
    rows.map(|row| {
        let cells: Vec<&str> = row.split(',').collect();
        let number = |cell: usize| u32::from_str_radix(cells[cell], 16).expect("hexadecimal");
        Register {
            name: format!("{}_{}", cells[0], cells[1]),
            address: number(2),
            readable: cells[3].contains('r'),
            is_writable: cells[3].contains('w'),
            reset: number(4),
            writable: number(5),
            one_modifies: number(6),
            zero_modifies: number(7),
        }
    })
    .collect()
}

/// What `exceptions.toml` holds; names of registers may have `*` for any text.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Exceptions {
    /// Registers without a model: every access ends the run.
    not_modelled: Vec<Exception>,
    /// Registers with another reset value than the table's.
    reset: Vec<Exception>,
    /// Bits that behave otherwise than by the rules above.
    bits: Vec<Exception>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Exception {
    registers: Vec<String>,
    /// Mask of the bits concerned, or the machine's reset value.
    #[serde(default)]
    bits: u32,
    #[expect(dead_code, reason = "for the reader")]
    reason: String,
}

/// Whether a pattern stands for a register.
fn matches(pattern: &str, register: &str) -> bool {
    match pattern.split_once('*') {
        Some((start, end)) => register.starts_with(start) && register[start.len()..].ends_with(end),
        None => pattern == register,
    }
}

fn find<'a>(exceptions: &'a [Exception], register: &str) -> Option<&'a Exception> {
    let names = |pattern: &String| matches(pattern, register);
    (exceptions.iter()).find(|exception| exception.registers.iter().any(names))
}

fn exceptions() -> Exceptions {
    toml::from_str(include_str!("exceptions.toml")).expect("exceptions.toml")
}

/// Clock enables, which [`Bench::reset`] sets.
const ENABLES: [&str; 3] = ["RCC_AHB1ENR", "RCC_APB1ENR", "RCC_APB2ENR"];

#[test]
fn every_exception_concerns_a_register_of_the_table() {
    let (table, all) = (table(), exceptions());
    let lists = [all.not_modelled, all.reset, all.bits];
    let patterns = lists.iter().flatten().flat_map(|exception| &exception.registers);
    let unused: Vec<_> = patterns
        .filter(|pattern| !table.iter().any(|register| matches(pattern, &register.name)))
        .collect();
    assert_eq!(unused, [""; 0]);
}

#[test]
fn registers_are_where_the_table_has_them_and_have_its_reset_values() {
    let (mut bench, exceptions) = (Bench::new(), exceptions());
    let mut found = Vec::new();
    for register in table() {
        bench.reset();
        let name = &register.name;
        let read = bench.read(register.address);
        let written = bench.write(register.address, register.reset);
        let absent = read == Err(Refusal::Offset) && written == Err(Refusal::Offset);
        if absent != find(&exceptions.not_modelled, name).is_some() {
            found.push(format!("{name}: {read:?} {written:?}"));
        }
        if absent || !register.readable || ENABLES.contains(&name.as_str()) {
            continue;
        }
        let expected = find(&exceptions.reset, name).map_or(register.reset, |e| e.bits);
        if read != Ok(expected) {
            found.push(format!("{name}: {read:x?} instead of {expected:#x}"));
        }
    }
    assert_eq!(found, [""; 0]);
}

/// What a bit does when the register is written with it the other way round.
#[derive(Debug, PartialEq, Eq, PartialOrd, Ord, Clone, Copy)]
enum Outcome {
    Changes,
    Stays,
    EndsRun,
}

fn outcome(bench: &mut Bench, register: &Register, bit: u32) -> Outcome {
    bench.reset();
    let before = bench.read(register.address).expect("readable");
    match bench.write(register.address, before ^ bit) {
        Err(_) => Outcome::EndsRun,
        Ok(()) if bench.read(register.address) == Ok(before) => Outcome::Stays,
        Ok(()) => Outcome::Changes,
    }
}

#[test]
fn bits_that_can_be_written_keep_what_is_written_and_others_do_not() {
    let (mut bench, exceptions) = (Bench::new(), exceptions());
    let mut found = Vec::new();
    let mut writable = BTreeMap::<_, u32>::new();
    for register in table() {
        let name = &register.name;
        if find(&exceptions.not_modelled, name).is_some() || !register.readable {
            continue;
        }
        let flags = register.one_modifies | register.zero_modifies;
        let mut deviating = 0;
        for bit in (0..32).map(|bit| 1 << bit).filter(|bit| flags & bit == 0) {
            let can_be_written = register.is_writable && register.writable & bit != 0;
            let outcome = outcome(&mut bench, &register, bit);
            let wrong = match can_be_written {
                true => Outcome::Stays,
                false => Outcome::Changes,
            };
            deviating |= if outcome == wrong { bit } else { 0 };
            if can_be_written {
                *writable.entry(outcome).or_default() += 1;
            }
        }
        let expected = find(&exceptions.bits, name).map_or(0, |exception| exception.bits);
        if deviating != expected {
            found.push(format!("{name}: {deviating:#x}, excepted are {expected:#x}"));
        }
    }
    assert_eq!(found, [""; 0]);
    // Were all bits to end the run, the rest would show nothing.
    assert!(writable[&Outcome::Changes] > 8 * writable[&Outcome::EndsRun], "{writable:?}");
}

/// Sets flags of a register, as far as the modelled functions of its peripheral do.
fn raise(bench: &mut Bench, register: &Register) {
    bench.reset();
    let first = register.address & !0x3ff;
    match register.name.as_str() {
        name if name.starts_with("TIM") => {
            for event in (0..8).map(|bit| 1 << bit) {
                let _ = bench.write(first + 0x14, event);
            }
        }
        "EXTI_PR" => {
            bench.write(first, 0xffff).expect("IMR");
            bench.write(first + 0x10, 0xffff).expect("SWIER");
        }
        "ADC1_SR" | "ADC2_SR" => {
            // end of conversion of each item; the second overruns
            let cr2 = register.address + 8;
            bench.write(cr2, 1 << 10 | 1 << 1 | 1).expect("CR2");
            bench.now += 100;
            let adc = &mut bench.chip.adcs[usize::from(register.name == "ADC2_SR")];
            for _ in 0..2 {
                adc.start(bench.now).expect("stable");
                adc.finish(0);
            }
        }
        "USART2_SR" => {
            bench.write(first + 8, 16).expect("BRR");
            bench.write(first + 0xc, 1 << 13 | 1 << 2).expect("CR1");
            bench.chip.usart.send(b"x", bench.now);
            bench.chip.usart.receive(true);
        }
        "WWDG_SR" => {
            bench.now += 0x40 * 4096;
            bench.chip.wwdg.sync(bench.now);
        }
        "FLASH_SR" => {
            let locked = bench.chip.store_flash(0x0800_4000, 4, 0, bench.now);
            locked.expect("sets PGSERR");
        }
        name => panic!("{name} has flags; say how they are raised"),
    }
}

#[test]
fn flags_are_cleared_one_by_one_as_the_table_says() {
    let (mut bench, mut raised_flags) = (Bench::new(), 0);
    for register in table() {
        let name = &register.name;
        let flags = register.one_modifies | register.zero_modifies;
        if flags == 0 {
            continue;
        }
        raise(&mut bench, &register);
        let raised = bench.read(register.address).expect("readable");
        assert_ne!(raised & flags, 0, "{name}");
        for flag in (0..32).map(|bit| 1 << bit).filter(|bit| raised & flags & bit != 0) {
            raise(&mut bench, &register);
            let clears_none = register.zero_modifies;
            bench.write(register.address, clears_none).expect("no change");
            assert_eq!(bench.read(register.address), Ok(raised), "{name} {flag:#x}");
            bench.write(register.address, clears_none ^ flag).expect("clears one");
            assert_eq!(bench.read(register.address), Ok(raised & !flag), "{name} {flag:#x}");
            raised_flags += 1;
        }
    }
    assert!(raised_flags > 60, "{raised_flags}");
}

#[test]
fn every_other_register_ends_the_run() {
    let mut bench = Bench::new();
    bench.reset();
    let known: BTreeSet<u32> = table().iter().map(|register| register.address).collect();
    let modelled = |address: u32| known.contains(&address);
    let mut answered = Vec::new();
    for first in (0x4000_0000..0x4008_0000).step_by(0x400).chain([0x5000_0000, 0xa000_1000]) {
        for address in (first..first + 0x400).step_by(4).filter(|address| !modelled(*address)) {
            let expected = match names::peripheral(address) {
                Some(_) => Refusal::Offset,
                None => Refusal::BusError,
            };
            if (bench.read(address), bench.write(address, 0)) != (Err(expected), Err(expected)) {
                answered.push(format!("{} {address:#010x}", names::register(address)));
            }
        }
    }
    assert_eq!(answered, [""; 0]);
}
