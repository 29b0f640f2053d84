//! Programs of others for the Cortex-M4 whose cycles are published.
use crate::{log, read, write};

const DEMCR: usize = 0xe000_edfc;
const DWT_CTRL: usize = 0xe000_1000;
const DWT_CYCCNT: usize = 0xe000_1004;

/// Runs `work` and logs its cycles.
#[inline(never)]
fn timed(work: impl FnOnce() -> bool) -> bool {
    let start = read(DWT_CYCCNT);
    let done = work();
    log(read(DWT_CYCCNT).wrapping_sub(start));
    done
}

/// Key generation and shared secret of two parties on the curve P-256. Logs the cycles of each, and 1 if both parties have the
/// same secret.
pub fn elliptic_curve() {
    write(DEMCR, 1 << 24);
    write(DWT_CTRL, 1);
    let keys = [3u32, 5].map(|seed| {
        core::array::from_fn::<u32, 8, _>(|i| 0x1234_5671u32.wrapping_mul(i as u32 + seed))
    });
    let mut public = [[[0; 8]; 2]; 2];
    let mut done = true;
    for (key, [x, y]) in keys.iter().zip(&mut public) {
        done &= timed(|| p256_cm4::keygen(x, y, key));
    }
    let mut secrets = [[0; 32]; 2];
    for (i, secret) in secrets.iter_mut().enumerate() {
        let [x, y] = &public[1 - i];
        done &= timed(|| p256_cm4::ecdh_calc_shared_secret(secret, &keys[i], x, y));
    }
    log(u32::from(done && secrets[0] == secrets[1]));
}
