//! What fetching code from the flash may cost beyond the estimate of `cost.rs`.
use super::path::Ran;

/// Wait states at 180 MHz and 3.3 V (RM0390 table 5).
const WAIT_STATES: u64 = 5;
/// The accelerator's instruction cache, and its lines (RM0390 3.4.2): 64 of 128 bits.
const LINES: usize = 64;
const LINE_BYTES: u32 = 16;

/// Cycles that the core waits for instructions on a way through the code that begins with an empty cache: a line that is
/// not in the cache takes the wait states, less what ran since the line before it began if it is the next one and so
/// has been prefetched. Constants that code loads from the flash are not in it.
#[must_use]
pub fn cold_fetch_stalls(path: &[Ran], mut cycles: impl FnMut(Ran) -> Vec<(u32, u16)>) -> u64 {
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
    fn straight((address, bytes): Ran) -> Vec<(u32, u16)> {
        (0..u32::from(bytes) / 4)
            .map(|i| (address + 4 * i, 1))
            .collect()
    }

    #[test]
    fn straight_code_waits_for_what_the_prefetch_lacks_and_loops_wait_once() {
        // Four cycles a line: one wait state is left at each line but the first.
        let line = (0x0800_0000, 160);
        assert_eq!(cold_fetch_stalls(&[line], straight), 5 + 9);
        assert_eq!(
            cold_fetch_stalls(&[line; 7], straight),
            5 + 9,
            "a loop of 10 lines fits"
        );
        let far: Vec<Ran> = (0..80).map(|i| (0x0800_0000 + 64 * i, 16)).collect();
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
