//! The computer at the other end of the serial line.

use std::ops::Range;

use thermal_device::reference::Mode;
use thermal_protocol::LINE_MAX_BYTES;

use crate::scene::{FaultKind, Scene, custom_line};

/// Milliseconds after the device's start at which it is armed, and between two lines.
const ARM_MS: u64 = 10;
const SPACING_MS: u64 = 3;
/// How long the skin is watched before an object is presented, ms: ten time constants of the device's filter.
const WATCH_MS: u64 = 2600;
/// Milliseconds before time zero from which telemetry is streamed.
const STREAM_MS: u64 = 20;
/// Interval of the blank lines that say that the host is alive, from the stream's begin on, ms.
const ALIVE_MS: usize = 500;
const BLANK: &[u8] = b"\n";
/// What a host sends each half millisecond that wants to know everything: as much as the line carries.
const FLOOD: &[u8] = b"state\nstate\nstate\nstate\nstate\nstate\nstate\nstate\n";
/// What a host that has lost its mind sends.
const GARBAGE: &[u8] = b"\x00\xff\xfe\x80arm\x01\n\xc3\x28 start\n";

/// Lines in the order in which they are sent.
#[derive(Clone, Debug)]
pub struct Host {
    /// Millisecond since the device's start, and the bytes.
    queue: Vec<(u64, Vec<u8>)>,
    next: usize,
    /// Milliseconds since the device's start in which it floods the device, and in which it sends nothing.
    floods: Vec<Range<u64>>,
    silences: Vec<Range<u64>>,
}

impl Host {
    /// The lines that restore a device's settings, those that set a scene up, telemetry every `stream_ms` included,
    /// those of the scene itself, and blank ones that say that it is alive.
    #[must_use]
    pub fn new(scene: &Scene, settings: &[String], stream_ms: u32) -> Self {
        let zero_ms = scene.settle_ms();
        // What never comes is at the end of numbers.
        let at = |t_s: f64| zero_ms.saturating_add((t_s * 1e3).round() as u64);
        let material = match scene.object.name.as_str() {
            "custom" => custom_line(&scene.object.material),
            name => format!("material {name}"),
        };
        let object = scene
            .object
            .start_c
            .map_or("object room".into(), |c| format!("object {c}"));
        let mode = match scene.mode {
            Mode::ContactResistance => "mode contact",
            Mode::SemiInfinite => "mode semi-infinite",
        };
        let law = scene.law.map(|law| format!("law {}", law.name()));
        let set_up = [material, object, mode.into()].into_iter().chain(law);
        let set_up = set_up.chain(["arm".into()]);
        let arm_ms = ARM_MS + SPACING_MS * settings.len() as u64;
        let mut queue: Vec<_> = (settings.iter().cloned().chain(set_up).zip(0..))
            .map(|(line, i)| (ARM_MS + i * SPACING_MS, line))
            .collect();
        let start_ms = if scene.object.appears_t_s > 0.0 {
            at(scene.object.appears_t_s)
        } else {
            arm_ms + WATCH_MS
        };
        queue.push((start_ms, "start".into()));
        queue.push((zero_ms - STREAM_MS, format!("stream {stream_ms}")));
        queue.extend(
            scene
                .host
                .iter()
                .map(|host| (at(host.t_s), host.line.clone())),
        );
        let lines = queue
            .into_iter()
            .map(|(ms, line)| (ms, [line.as_bytes(), b"\n"].concat()));
        let times = |kind| -> Vec<Range<u64>> {
            let faults = scene
                .faults
                .iter()
                .filter(|fault| fault.broken.kind == kind);
            faults
                .map(|fault| at(fault.t_s)..at(fault.until_s))
                .collect()
        };
        let garbage = times(FaultKind::HostGarbage).into_iter();
        let garbage = garbage.map(|times| (times.start, GARBAGE.to_vec()));
        // Lines first: they shall not wait.
        let alive = (zero_ms - STREAM_MS..at(scene.duration_s))
            .step_by(ALIVE_MS)
            .skip(1);
        let alive = alive.map(|ms| (ms, BLANK.to_vec()));
        let (floods, silences) = (times(FaultKind::HostFlood), times(FaultKind::HostSilent));
        let mut queue: Vec<_> = (lines.chain(garbage).chain(alive))
            .filter(|(ms, _)| !within(&silences, *ms))
            .collect();
        queue.sort_by_key(|(ms, _)| *ms);
        space_out(&mut queue);
        Self {
            queue,
            next: 0,
            floods,
            silences,
        }
    }

    /// The bytes that leave at a half millisecond since the device's start, if any.
    pub fn send(&mut self, half_ms: u64) -> Option<&[u8]> {
        let next = self.queue.get(self.next);
        let Some((_, bytes)) = next.filter(|(ms, bytes)| half_ms >= 2 * ms + leaves_at_half(bytes))
        else {
            let now_ms = half_ms / 2;
            let floods = within(&self.floods, now_ms) && !within(&self.silences, now_ms);
            return floods.then_some(FLOOD);
        };
        self.next += 1;
        Some(bytes)
    }
}

fn within(times: &[Range<u64>], ms: u64) -> bool {
    times.iter().any(|times| times.contains(&ms))
}

/// The half of a millisecond at whose boundary bytes leave: the one after which their last byte is far from a tick, so
/// that both engines execute them in the same tick.
pub(crate) fn leaves_at_half(bytes: &[u8]) -> u64 {
    (31..=80).contains(&bytes.len()).into()
}

/// Delays lines that would leave before the line ahead of them was answered.
fn space_out(queue: &mut [(u64, Vec<u8>)]) {
    let mut free_ms = 0;
    for (ms, bytes) in queue {
        *ms = (*ms).max(free_ms);
        let line_ms = (bytes.len() / LINE_MAX_BYTES) as u64;
        // A blank line has no answer.
        let answered_ms = if bytes == BLANK { 1 } else { SPACING_MS };
        free_ms = *ms + line_ms + answered_ms;
    }
}
