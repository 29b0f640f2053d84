//! Stalls of instruction fetches from the flash, which the estimate of `cost.rs` leaves out.
use super::execution_path::ExecutedBlock;

/// Wait states at 180 MHz and 3.3 V (RM0390 table 5).
const WAIT_STATES: u64 = 5;
/// The accelerator's instruction cache, and its lines (RM0390 3.4.2): 64 of 128 bits.
const LINES: usize = 64;
const LINE_BYTES: u32 = 16;

/// Cycles that the core waits for instructions along an execution path that begins with an empty cache. A line outside the
/// cache takes the wait states; the next line in order is prefetched while the line before it executes. Loads of constants
/// from the flash are not included.
#[must_use]
pub fn cold_fetch_stalls(
    path: &[ExecutedBlock],
    mut cycles: impl FnMut(ExecutedBlock) -> Vec<(u32, u16)>,
) -> u64 {
    // Least recently used first.
    let mut cache: Vec<u32> = Vec::with_capacity(LINES);
    let (mut stalls, mut in_line, mut line) = (0, 0, None);
    for &block in path {
        for (address, took) in cycles(block) {
            let wanted = address / LINE_BYTES;
            if line != Some(wanted) {
                match cache.iter().position(|cached| *cached == wanted) {
                    Some(at) => {
                        cache.remove(at);
                    }
                    None => {
                        let next = line.is_some_and(|line| line + 1 == wanted);
                        stalls += WAIT_STATES.saturating_sub(if next { in_line } else { 0 });
                        if cache.len() == LINES {
                            cache.remove(0);
                        }
                    }
                }
                cache.push(wanted);
                (line, in_line) = (Some(wanted), 0);
            }
            in_line += u64::from(took);
        }
    }
    stalls
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Four-byte instructions of one cycle.
    fn straight((address, bytes): ExecutedBlock) -> Vec<(u32, u16)> {
        (0..u32::from(bytes) / 4)
            .map(|i| (address + 4 * i, 1))
            .collect()
    }

    #[test]
    fn prefetch_shortens_stalls_of_straight_code_and_cached_loops_stall_once() {
        // Four cycles a line: one wait state is left at each line but the first.
        let line = (0x0800_0000, 160);
        assert_eq!(cold_fetch_stalls(&[line], straight), 5 + 9);
        assert_eq!(
            cold_fetch_stalls(&[line; 7], straight),
            5 + 9,
            "a loop of 10 lines fits"
        );
        let far: Vec<ExecutedBlock> = (0..80).map(|i| (0x0800_0000 + 64 * i, 16)).collect();
        assert_eq!(
            cold_fetch_stalls(&far, straight),
            80 * 5,
            "a jump has no prefetch"
        );
        let twice = [far.clone(), far].concat();
        assert_eq!(
            cold_fetch_stalls(&twice, straight),
            160 * 5,
            "80 lines do not fit"
        );
    }
}
