//! One program that others wrote for the chip: an example of the published crate stm32f4xx-hal 0.23. It has its own set-up of
//! clocks, DMA streams and serial port. `cargo xtask soak` runs the others.

use stm32_emulator::{Firmware, Machine};

use crate::support::{Bench, build};

/// Six bytes by DMA, then six without, at 115 200 bit/s.
#[test]
fn a_serial_port_echoes() {
    let program = build(&["foreign"]).join("serial-dma");
    let firmware = Firmware::from_file(&program).expect("the program is an image");
    let mut machine = Machine::new(&firmware, Bench::default()).expect("the machine powers up");
    machine.set_host_baud(115_200);
    for (ms, bytes) in [(5, "by DMA"), (10, "by CPU"), (15, "")] {
        machine.run_until_ps(ms * 1_000_000_000).unwrap_or_else(|stop| panic!("{stop}"));
        machine.uart_send(bytes.as_bytes());
    }
    let sent: Vec<u8> = machine.wiring().sent.iter().map(|(byte, _)| *byte).collect();
    assert_eq!(String::from_utf8_lossy(&sent), "by DMAby CPU");
    assert_eq!(machine.wiring().baud, 115_108, "16 MHz / 139");
}
