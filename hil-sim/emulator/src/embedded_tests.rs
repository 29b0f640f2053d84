//! Runs the tests of an image built with the crate `embedded-test` 0.7, one after the other, as probe-rs runs them on a board: it
//! reads their names and addresses from the ELF file, and for each test resets the chip, answers the test's question for its
//! command line, prints what it prints, and waits for its exit, all by semihosting (Arm, Semihosting for AArch32 and AArch64).
use super::Wiring;
use super::debugger::Halted;
use super::elf::{Firmware, ImageError};
use super::mcu::Machine;
use super::stop::Stop;
use object::read::elf::ElfFile32;
use object::{Endianness, Object, ObjectSection, ObjectSymbol};
use serde::Deserialize;
use std::path::Path;
use thermal_client::text;

/// Version of the protocol in which the ELF file lists the tests.
const PROTOCOL: [u8; 4] = 1u32.to_le_bytes();
/// BKPT number of a semihosting call (section 3.1).
const SEMIHOSTING: u8 = 0xab;
/// Numbers of the calls (section 5).
const OPEN: u32 = 0x01;
const CLOSE: u32 = 0x02;
const WRITEC: u32 = 0x03;
const WRITE0: u32 = 0x04;
const WRITE: u32 = 0x05;
const ERRNO: u32 = 0x13;
const GET_CMDLINE: u32 = 0x15;
const EXIT: u32 = 0x18;
const EXIT_EXTENDED: u32 = 0x20;
/// Reason of a call to exit that is no error.
const APPLICATION_EXIT: u32 = 0x2_0026;
/// The only handle: the console.
const CONSOLE: u32 = 1;
/// Longest text that a program writes without its length.
const TEXT_BYTES: u32 = 4096;
/// A probe looks for a halted core ten times a second, so a call may halt it for that long.
const HALT_PS: u64 = 100_000_000_000;
const SECOND_PS: u64 = 1_000_000_000_000;
const DEFAULT_TIMEOUT_S: u32 = 60;

/// Why a file has no tests to run.
#[derive(Debug, thiserror::Error)]
pub enum NotATestImage {
    /// The file could not be read.
    #[error("cannot be read: {0}")]
    Unreadable(#[from] std::io::Error),
    /// It is no image for this chip.
    #[error(transparent)]
    Image(#[from] ImageError),
    /// Its list of tests is missing or damaged.
    #[error("no tests of embedded-test 0.7: {0}")]
    List(String),
}

/// A test of an image.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct EmbeddedTest {
    /// Modules and function, without the crate.
    pub name: String,
    /// Not run unless it is asked for.
    pub ignored: bool,
    should_panic: bool,
    timeout_s: u32,
    /// Of the function that runs it.
    address: u32,
}

/// What the name of a test's symbol says.
#[derive(Deserialize)]
struct Definition {
    name: String,
    ignored: bool,
    should_panic: bool,
    timeout: Option<u32>,
}

/// An image and its tests, in the order of their names.
#[derive(Debug, Clone)]
pub struct EmbeddedTests {
    /// The image.
    pub firmware: Firmware,
    /// Its tests.
    pub tests: Vec<EmbeddedTest>,
}

impl EmbeddedTests {
    /// Reads an ELF file.
    ///
    /// # Errors
    /// It is no image for the STM32F446RE, or was not built with `embedded-test` 0.7.
    pub fn from_file(path: &Path) -> Result<Self, NotATestImage> {
        let bytes = text::read_bytes(path, text::TABLE_BYTES_MAX)?;
        let firmware = Firmware::from_elf(&bytes)?;
        let tests = tests(&bytes).map_err(NotATestImage::List)?;
        Ok(Self { firmware, tests })
    }
}

/// The tests that an ELF file lists.
fn tests(bytes: &[u8]) -> Result<Vec<EmbeddedTest>, String> {
    let file: ElfFile32<'_, Endianness> = ElfFile32::parse(bytes).map_err(|e| e.to_string())?;
    let list = file.section_by_name(".embedded_test");
    let list = list.ok_or("the file has no section .embedded_test")?;
    let contents = |at: u64, size: u64| list.data_range(at, size).ok().flatten();
    let version = file.symbol_by_name("EMBEDDED_TEST_VERSION");
    let version = version.and_then(|symbol| contents(symbol.address(), 4));
    if version != Some(&PROTOCOL) {
        return Err(format!("its protocol is {version:?}, not {PROTOCOL:?}"));
    }
    let mut tests = Vec::new();
    for symbol in file.symbols() {
        let name = symbol.name().map_err(|e| e.to_string())?;
        if symbol.section_index() != Some(list.index()) || !name.starts_with('{') {
            continue;
        }
        let about: Definition =
            serde_json::from_str(name).map_err(|error| format!("symbol {name}: {error}"))?;
        // Address of the function; address and length of the path of its module.
        let words =
            contents(symbol.address(), 12).and_then(|words| words.as_chunks().0.first_chunk());
        let [address, path, path_bytes] = words
            .ok_or_else(|| format!("symbol {name} is no entry of three words"))?
            .map(u32::from_le_bytes);
        let module = file
            .sections()
            .find_map(|s| s.data_range(path.into(), path_bytes.into()).ok().flatten());
        let module = module.map(String::from_utf8_lossy).unwrap_or_default();
        let module = module.split_once("::").map_or("", |(_, module)| module);
        tests.push(EmbeddedTest {
            name: format!("{module}::{}", about.name),
            ignored: about.ignored,
            should_panic: about.should_panic,
            timeout_s: about.timeout.unwrap_or(DEFAULT_TIMEOUT_S),
            address,
        });
    }
    tests.sort_by(|a, b| a.name.cmp(&b.name));
    Ok(tests)
}

/// What the host does after a call.
enum Next {
    /// The core continues with this in R0, or with R0 as it is.
    Continue(Option<u32>),
    /// The test has ended, with success or not.
    Ended(bool),
}

impl EmbeddedTest {
    /// Resets the machine and runs the test; hands what it prints to `print`.
    ///
    /// # Errors
    /// Why it failed.
    pub fn run<W: Wiring + 'static>(
        &self,
        machine: &mut Machine<W>,
        print: &mut dyn FnMut(&str),
    ) -> Result<(), String> {
        let stopped = |stop: Stop| stop.to_string();
        machine.restart_under_debugger().map_err(stopped)?;
        let mut command_line = Some(format!("run_addr {}", self.address));
        let limit = machine.ps_at(machine.now()) + u64::from(self.timeout_s) * SECOND_PS;
        loop {
            match machine.run_until_halted(limit).map_err(stopped)? {
                Some(Halted::Breakpoint(SEMIHOSTING)) => {}
                Some(Halted::Breakpoint(number)) => {
                    return Err(format!("BKPT {number:#04x} is no semihosting call"));
                }
                Some(Halted::HardFault { cause, place }) => {
                    return Err(format!("hard fault: {cause}, in {place}"));
                }
                Some(Halted::Reset(cause)) => {
                    return Err(format!("a reset that it did not announce: {cause}"));
                }
                None => return Err(format!("not ended after {} s", self.timeout_s)),
            }
            let next = self.answer(machine, &mut command_line, print)?;
            let halt_ends = machine.ps_at(machine.now()) + HALT_PS;
            if let Some(halted) = machine.run_until_halted(halt_ends).map_err(stopped)? {
                return Err(format!("{halted:?} while a semihosting call halted the core"));
            }
            match next {
                Next::Continue(r0) => machine.continue_behind_breakpoint(r0).map_err(stopped)?,
                Next::Ended(success) if success != self.should_panic => return Ok(()),
                Next::Ended(true) => return Err("it should have panicked".into()),
                Next::Ended(false) => return Err("it has panicked".into()),
            }
        }
    }

    /// Answers the semihosting call at which the core is halted.
    fn answer<W: Wiring + 'static>(
        &self,
        machine: &mut Machine<W>,
        command_line: &mut Option<String>,
        print: &mut dyn FnMut(&str),
    ) -> Result<Next, String> {
        let [operation, parameter] = machine.call_registers();
        let bad = |what: &str| format!("semihosting call {operation:#x}: {what} {parameter:#010x}");
        let words = |count: usize| {
            let bytes = machine.memory(parameter, 4 * count);
            let bytes = bytes.ok_or_else(|| bad("no memory at"))?;
            let words = bytes.as_chunks().0.iter().copied().map(u32::from_le_bytes);
            Ok::<_, String>(words.collect::<Vec<u32>>())
        };
        let text = |address: u32, bytes: u32| {
            let bytes = machine.memory(address, bytes as usize);
            let bytes = bytes.ok_or_else(|| bad("no text at the address in"))?;
            Ok::<_, String>(String::from_utf8_lossy(&bytes).into_owned())
        };
        Ok(match operation {
            GET_CMDLINE => {
                let line = command_line.take().ok_or("it asked for its command line twice")?;
                let block = words(2)?;
                let mut line = line.into_bytes();
                line.push(0);
                let length = (line.len() as u32 - 1).to_le_bytes();
                let fits = line.len() <= block[1] as usize
                    && machine.write_ram(block[0], &line)
                    && machine.write_ram(parameter + 4, &length);
                if !fits {
                    return Err(bad("no room for the command line by the words at"));
                }
                Next::Continue(Some(0))
            }
            EXIT => Next::Ended(parameter == APPLICATION_EXIT),
            EXIT_EXTENDED => Next::Ended(words(2)? == [APPLICATION_EXIT, 0]),
            WRITEC => {
                print(&text(parameter, 1)?);
                Next::Continue(None)
            }
            WRITE0 => {
                // The text may end close to the end of the memory.
                let bytes = (parameter..parameter.saturating_add(TEXT_BYTES))
                    .map_while(|at| machine.memory(at, 1))
                    .flatten()
                    .take_while(|byte| *byte != 0);
                print(&String::from_utf8_lossy(&bytes.collect::<Vec<_>>()));
                Next::Continue(None)
            }
            OPEN if text(words(3)?[0], words(3)?[2])? == ":tt" && words(3)?[1] >= 4 => {
                Next::Continue(Some(CONSOLE))
            }
            OPEN => {
                return Err(bad("only the console can be opened for output, by the words at"));
            }
            WRITE => {
                let block = words(3)?;
                print(&text(block[1], block[2])?);
                Next::Continue(Some(0))
            }
            CLOSE => Next::Continue(Some(0)),
            ERRNO => Next::Continue(None),
            _ => return Err(bad("not modelled, parameter")),
        })
    }
}
