//! The line to the host at 1 Mbaud, looped back inside the chip: in single-wire mode the transmitter hears itself.

#[embedded_test::tests]
mod tests {
    use core::fmt::Write as _;

    use cortex_m::peripheral::NVIC;
    use stm32f4xx_hal::pac::{GPIOA, Interrupt, USART2};
    use thermal_display::protocol::OutgoingLine;

    use crate::running_board::{set_up, take_request};
    use crate::{cycles, report};

    const TEXT: &str = "abcdefghijklmnopqrstuvwxyz 0123456789 ABCDEFGHIJKLMNOPQRSTUVWXYZ";
    const CYCLES_PER_BYTE: u32 = 10 * 180;

    #[test]
    fn a_line_comes_back_whole_at_1_mbaud() {
        let mut board = set_up();
        // SAFETY: the drivers do not use these registers any more.
        let (usart, pins) = unsafe { (USART2::steal(), GPIOA::steal()) };
        // The transmitter releases its pin, PA2, between two frames.
        pins.pupdr().modify(|_, w| w.pupdr(2).pull_up());
        usart.cr1().modify(|_, w| w.ue().disabled());
        usart.cr3().modify(|_, w| w.hdsel().half_duplex());
        usart.cr1().modify(|_, w| w.ue().enabled());
        board.console.outbox.enqueue_or_drop(|line| {
            *line = OutgoingLine::new();
            let _ = writeln!(line, "{TEXT}");
        });
        let begun = cycles::now();
        let limit = 2 * CYCLES_PER_BYTE * TEXT.len() as u32;
        let (mut first, mut last, mut received) = (None, 0, None);
        while received.is_none() && cycles::now().wrapping_sub(begun) < limit {
            if take_request(Interrupt::DMA1_STREAM6) {
                board.transmitter.send_next();
            }
            if NVIC::is_pending(Interrupt::USART2) {
                last = cycles::now();
                first.get_or_insert(last);
                if board.receiver.receive_byte_and_queue_line().is_some() {
                    received = board.console.lines.dequeue_line_or_queue_full();
                }
                NVIC::unpend(Interrupt::USART2);
            }
        }
        let line = received.expect("a line comes back");
        let line = line.expect("without an error of reception");
        assert_eq!(line.as_bytes(), TEXT.as_bytes());
        // The end of the line is one byte more.
        let took = last.wrapping_sub(first.expect("a first byte"));
        let per_byte = took as f32 / TEXT.len() as f32;
        report::figure("serial_byte", format_args!("{per_byte:.1}"), "cycles");
        assert!((per_byte - CYCLES_PER_BYTE as f32).abs() < 10.0, "{per_byte} cycles");
    }
}
