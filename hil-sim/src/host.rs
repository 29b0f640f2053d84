//! The computer at the other end of the serial line.

use thermal_display::protocol::LINE_MAX;
use thermal_display::render::Mode;

use crate::scene::{FaultKind, Scene, custom_line};

/// Milliseconds after the device's start at which it is armed, and between two lines.
const ARM_MS: u64 = 10;
const SPACING_MS: u64 = 3;
/// How long the skin is watched before an object is presented, ms: ten time constants of the device's filter.
const WATCH_MS: u64 = 2600;
/// Milliseconds before time zero from which telemetry is streamed.
const STREAM_MS: u64 = 20;
/// What a host that has lost its mind sends.
const GARBAGE: &[u8] = b"\x00\xff\xfe\x80arm\x01\n\xc3\x28 start\n";

/// Lines in the order in which they are sent.
#[derive(Clone, Debug)]
pub struct Host {
    /// Millisecond since the device's start, and the bytes.
    queue: Vec<(u64, Vec<u8>)>,
    next: usize,
}

impl Host {
    /// The lines that restore a device's settings, those that set a scene up, telemetry every `stream_ms` included,
    /// and those of the scene itself.
    #[must_use]
    pub fn new(scene: &Scene, settings: &[String], stream_ms: u32) -> Self {
        let zero_ms = scene.settle_ms();
        let at = |t_s: f64| zero_ms + (t_s * 1e3).round() as u64;
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
        queue.extend(scene.host.iter().map(|host| (at(host.t_s), host.line.clone())));
        let lines = queue
            .into_iter()
            .map(|(ms, line)| (ms, [line.as_bytes(), b"\n"].concat()));
        let garbage = (scene.faults.iter())
            .filter(|fault| fault.kind == FaultKind::HostGarbage)
            .map(|fault| (at(fault.t_s), GARBAGE.to_vec()));
        let mut queue: Vec<_> = lines.chain(garbage).collect();
        queue.sort_by_key(|(ms, _)| *ms);
        space_out(&mut queue);
        Self { queue, next: 0 }
    }

    /// The bytes that leave at a half millisecond since the device's start, if any.
    pub fn send(&mut self, half_ms: u64) -> Option<&[u8]> {
        let (ms, bytes) = self.queue.get(self.next)?;
        if half_ms < 2 * ms + leaves_at_half(bytes) {
            return None;
        }
        self.next += 1;
        self.queue.get(self.next - 1).map(|(_, bytes)| bytes.as_slice())
    }
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
        let line_ms = (bytes.len() / LINE_MAX) as u64;
        free_ms = *ms + line_ms + SPACING_MS;
    }
}
