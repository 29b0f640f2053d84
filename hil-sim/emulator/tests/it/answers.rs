//! The emulated core against QEMU's: the same programs, and what they left in memory when QEMU ran them.
use stm32_emulator::Machine;
use thermal_sim::processor::ChipState;

use crate::probe::{self, Bench};

/// Inputs have four groups with modes of the floating-point unit of their own; see `probe/src/bin/instructions/main.rs`.
const GROUPS: usize = 4;
/// Words of an answer: check sums, positions of changed registers, their values.
const ANSWER: usize = GROUPS + 1 + 4;

/// What QEMU said about a form.
struct Answer {
    sums: Vec<u32>,
    form: &'static str,
    /// Registers that one input changed, for whoever looks for the reason of a difference.
    sample: &'static str,
}

/// The answers of QEMU 7.2 (`netduinoplus2`), in the order of the program's table.
fn answers() -> impl Iterator<Item = Answer> {
    include_str!("../answers/instructions.txt").lines().map(|line| {
        let [sums, form, sample] = line
            .splitn(3, '|')
            .map(str::trim)
            .collect::<Vec<_>>()
            .try_into()
            .expect("three columns");
        let hexadecimal = |word| u32::from_str_radix(word, 16).expect("a number");
        let sums = sums.split(' ').map(hexadecimal).collect();
        Answer { sums, form, sample }
    })
}

#[test]
fn every_form_of_every_instruction_gives_the_results_that_qemu_gives() {
    let firmware = probe::program("instructions");
    let mut machine = Machine::new(&firmware, Bench::default()).expect("powers up");
    machine.run_until(1_500_000_000).expect("runs");
    let forms = probe::words_of(&firmware, &machine, "FORMS_RUN", 1)[0] as usize;
    let results = probe::words_of(&firmware, &machine, "ANSWERS", forms * ANSWER);
    assert_eq!(answers().count(), forms, "tests/answers/from_qemu.py was not run");
    let mut differing = Vec::new();
    for (result, answer) in results.chunks(ANSWER).zip(answers()) {
        for group in 0..GROUPS {
            if result[group] != answer.sums[group] {
                let [positions, values @ ..] = &result[GROUPS..] else {
                    unreachable!("an answer has that many words")
                };
                differing.push(format!(
                    "{}, group {group}: QEMU's sample {}; here {:?} = {values:08x?}",
                    answer.form,
                    answer.sample,
                    positions.to_le_bytes(),
                ));
            }
        }
    }
    assert!(differing.is_empty(), "{}", differing.join("\n"));
}

/// What the program logs; a line is a step of it, which begins with a word that has one of these upper halves.
fn exceptions_logged(strict: bool) -> Vec<String> {
    const STEPS: [u32; 6] = [0x9000, 0xa000, 0xb000, 0xc000, 0xd000, 0xf000];
    const ENTRIES: u32 = 4000;
    let firmware = probe::program("exceptions");
    let chip = ChipState { strict, ..ChipState::default() };
    let machine = Machine::with_chip(&firmware, Bench::default(), &chip);
    let mut machine = machine.expect("powers up");
    machine.run_until(5_000_000).expect("runs");
    let logged = probe::words_of(&firmware, &machine, "LOG", 1)[0].min(ENTRIES) as usize;
    let log = probe::words_of(&firmware, &machine, "LOG", logged + 1);
    let mut lines: Vec<String> = Vec::new();
    for word in &log[1..] {
        match lines.last_mut() {
            Some(line) if !STEPS.contains(&(word >> 16)) => *line += &format!(" {word:08x}"),
            _ => lines.push(format!("{word:08x}")),
        }
    }
    lines
}

/// The answers of QEMU 7.2 (`netduinoplus2`) and what is logged here, where they differ.
fn differing_exceptions(strict: bool) -> Vec<(&'static str, String)> {
    let answers = include_str!("../answers/exceptions.txt");
    let logged = exceptions_logged(strict);
    assert_eq!(logged.len(), answers.lines().count(), "steps");
    let pairs = answers.lines().zip(logged);
    pairs.filter(|(answer, here)| answer != here).collect()
}

#[test]
fn exceptions_and_faults_are_those_of_qemu() {
    assert_eq!(differing_exceptions(true), []);
}

/// Steps that end with the fault of an access that is not aligned begin with 0xc0000002 to 0xc000000b; those after them are of
/// exclusive accesses.
#[test]
fn a_machine_that_is_not_strict_accepts_only_accesses_to_several_words_that_are_not_aligned() {
    const STEPS: u32 = 10;
    const OFFSETS: u32 = 3;
    let differing = differing_exceptions(false);
    for (answer, here) in &differing {
        let step = answer.split(' ').next().expect("a step");
        assert!(answer.contains(" 01000000 "), "{answer}");
        assert!(("c0000002"..="c000000b").contains(&step), "{answer}");
        assert_eq!(*here, format!("{step} 00000000"), "no fault");
    }
    assert_eq!(differing.len() as u32, STEPS * OFFSETS);
}

/// The program writes for each block of code, handler and stack a check sum of what the block leaves, how many interrupted runs
/// leave something else, and how many places of the block no run was interrupted at.
#[test]
fn code_that_is_interrupted_at_any_instruction_leaves_what_it_leaves_in_qemu() {
    let answers = include_str!("../answers/interrupted.txt");
    let firmware = probe::program("interrupted");
    let mut machine = Machine::new(&firmware, Bench::default()).expect("powers up");
    machine.run_until(1_500_000_000).expect("runs");
    assert_eq!(probe::words_of(&firmware, &machine, "FINISHED", 1), [1]);
    let outcomes = probe::words_of(&firmware, &machine, "OUTCOMES", 3 * answers.lines().count());
    for (n, (outcome, answer)) in outcomes.chunks(3).zip(answers.lines()).enumerate() {
        let &[sum, different, missed] = outcome else { unreachable!("chunks of three") };
        assert_eq!(format!("{sum:08x} {different} {missed}"), answer, "line {n}");
    }
}
