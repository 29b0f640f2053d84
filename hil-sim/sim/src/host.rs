//! The computer at the other end of the serial line.

use std::ops::Range;

use thermal_client::client::upload_course;
use thermal_client::course::Course;
use thermal_device::reference::ContactModel;
use thermal_device::stimulus::TemperatureKind;
use thermal_protocol::LINE_MAX_BYTES;

use crate::scene::{FaultKind, Scene, custom_line};
use crate::upload;

/// Time since the start of the device, ms, from which a host may set it up.
pub(crate) const SET_UP_FROM_MS: u64 = 10;
/// Time between two lines, in which a device answers the first, ms.
const SPACING_MS: u64 = 3;
/// Time for the skin temperature filter of the device to settle before an object is presented, ms: ten time constants.
const SKIN_SETTLING_MS: u64 = 2600;
/// Start of the telemetry stream before time zero, ms.
const STREAM_MS: u64 = 20;
/// Interval of the blank lines that serve as heartbeat from the start of the stream on, ms.
const HEARTBEAT_MS: usize = 500;
const BLANK: &[u8] = b"\n";
/// Sent every half millisecond by a flooding host: as much as the serial line carries.
const FLOOD: &[u8] = b"state\nstate\nstate\nstate\nstate\nstate\nstate\nstate\n";
/// Half milliseconds between two lines of a host that uploads and plays courses: a device has answered the first by then.
const PLAYING_HALF_MS: u64 = 4;
/// The courses that it plays in turn: time, s, and temperature, °C, of their points.
const PLAYED: [[(f64, f64); 2]; 2] = [[(0.0, 42.0), (1.0, 40.0)], [(0.0, 15.0), (1.0, 17.0)]];
/// Bytes that are not valid lines.
const GARBAGE: &[u8] = b"\x00\xff\xfe\x80arm\x01\n\xc3\x28 start\n";

/// The host: the lines of a scene in the order in which they are sent.
#[derive(Clone, Debug)]
pub struct Host {
    /// Time since the start of the device, ms, and the bytes sent then.
    queue: Vec<(u64, Vec<u8>)>,
    next: usize,
    /// Time since the start of the device, ms, from which another host may set up its finger.
    set_up_ms: u64,
    /// Time ranges since the start of the device, ms, in which the host floods the line, and in which it is silent.
    floods: Vec<Range<u64>>,
    silences: Vec<Range<u64>>,
    playing: PlayingHost,
}

/// A host that uploads and plays courses without pause.
#[derive(Clone, Debug)]
struct PlayingHost {
    /// Time ranges since the start of the device, ms.
    times: Vec<Range<u64>>,
    /// Its lines, which it sends again and again.
    lines: Vec<Vec<u8>>,
    next: usize,
    /// Half millisecond since the start of the device from which on the next line may be sent.
    free_half_ms: u64,
}

impl PlayingHost {
    fn new(times: Vec<Range<u64>>) -> Self {
        let lines = PLAYED.iter().flat_map(|points| {
            let upload = upload_course(TemperatureKind::Absolute, points).into_iter();
            upload
                .map(|command| format!("{command}\n").into_bytes())
                .chain([b"play now\n".to_vec()])
        });
        Self { times, lines: lines.collect(), next: 0, free_half_ms: 0 }
    }

    /// The line sent at a half millisecond since the start of the device, if any.
    fn send(&mut self, half_ms: u64) -> Option<&[u8]> {
        if !within(&self.times, half_ms / 2) || half_ms < self.free_half_ms {
            return None;
        }
        self.free_half_ms = half_ms + PLAYING_HALF_MS;
        let line = self.lines.get(self.next);
        self.next = (self.next + 1) % self.lines.len();
        line.map(Vec::as_slice)
    }
}

/// The lines by which an operator chooses the object of a scene: its material, its temperature and, if it is no half-space,
/// that it is a slab, or else its relaxations. [`Host`] uploads those of a slab, too.
pub fn object_lines(scene: &Scene) -> Vec<String> {
    let mut lines = material_and_temperature(scene).to_vec();
    match scene.object.slab_line() {
        Some(slab) if !scene.object_as_half_space => lines.push(slab),
        _ => lines.extend(relaxations(scene)),
    }
    lines
}

fn material_and_temperature(scene: &Scene) -> [String; 2] {
    let object = &scene.object;
    let material = match object.name.as_str() {
        "custom" => custom_line(&object.material),
        name => format!("material {name}"),
    };
    let start_c = object.start_c;
    [material, start_c.map_or("object room".into(), |c| format!("object {c}"))]
}

/// The upload of an object that is no half-space; nothing for one that is.
fn relaxations(scene: &Scene) -> Vec<String> {
    let object = &scene.object;
    if scene.object_as_half_space || object.is_half_space() {
        return Vec::new();
    }
    let fit = upload::object_fit(&object.material, &object.layers, &object.back);
    let orders = thermal_client::client::upload(&fit.impedance());
    orders.iter().map(ToString::to_string).collect()
}

impl Host {
    /// Queues the lines that restore the settings of the device, set up the scene and request telemetry every
    /// `stream_ms`, the lines of the scene itself, and blank lines as heartbeat. The set-up begins `set_up_from_ms` after the
    /// device's start: hosts of several fingers take turns.
    pub fn new(scene: &Scene, settings: &[String], stream_ms: u32, set_up_from_ms: u64) -> Self {
        let zero_ms = scene.settle_ms();
        // An infinite time saturates.
        let at = |t_s: f64| zero_ms.saturating_add_signed((t_s * 1e3).round() as i64);
        let mode = match scene.mode {
            ContactModel::ContactResistance => "mode contact",
            ContactModel::SemiInfinite => "mode semi-infinite",
        };
        let law = scene.law.map(|law| format!("law {}", law.name()));
        let set_up = material_and_temperature(scene).into_iter();
        let set_up = set_up.chain([mode.into()]).chain(law);
        let upload = (scene.course.as_ref()).map_or_else(Vec::new, Course::upload_lines);
        // What the device assumes follows the command that arms it, which so is sent at the same time for all scenes.
        let finger = format!("finger {}", scene.assumed_finger.name());
        let set_up = set_up
            .chain(["arm".into(), finger])
            .chain(relaxations(scene))
            .chain(upload.iter().map(ToString::to_string));
        let arm_ms = set_up_from_ms + SPACING_MS * settings.len() as u64;
        let mut queue: Vec<_> = (settings.iter().cloned().chain(set_up).zip(0..))
            .map(|(line, i)| (set_up_from_ms + i * SPACING_MS, line))
            .collect();
        let set_up_ms = set_up_from_ms + SPACING_MS * queue.len() as u64;
        let start_ms = if scene.object.appears_t_s > 0.0 {
            at(scene.object.appears_t_s)
        } else {
            arm_ms + SKIN_SETTLING_MS
        };
        let start = if scene.course.is_some() { "play landing" } else { "start" };
        queue.push((start_ms, start.into()));
        queue.push((zero_ms - STREAM_MS, format!("stream {stream_ms}")));
        queue.extend(scene.host.iter().map(|host| (at(host.t_s), host.line.clone())));
        let lines = queue.into_iter().map(|(ms, line)| (ms, [line.as_bytes(), b"\n"].concat()));
        let times = |kind| -> Vec<Range<u64>> {
            let faults = scene.faults.iter().filter(|fault| fault.fault.kind == kind);
            faults.map(|fault| at(fault.t_s)..at(fault.until_s)).collect()
        };
        let garbage = times(FaultKind::HostGarbage).into_iter();
        let garbage = garbage.map(|times| (times.start, GARBAGE.to_vec()));
        // Lines come before heartbeats of the same time, so that they are not delayed.
        let heartbeats = (zero_ms - STREAM_MS..at(scene.duration_s)).step_by(HEARTBEAT_MS).skip(1);
        let heartbeats = heartbeats.map(|ms| (ms, BLANK.to_vec()));
        let (floods, silences) = (times(FaultKind::HostFlood), times(FaultKind::HostSilent));
        let playing = PlayingHost::new(times(FaultKind::HostPlays));
        let mut queue: Vec<_> = (lines.chain(garbage).chain(heartbeats))
            .filter(|(ms, _)| !within(&silences, *ms))
            .collect();
        queue.sort_by_key(|(ms, _)| *ms);
        space_out(&mut queue);
        Self { set_up_ms, queue, next: 0, floods, silences, playing }
    }

    /// Time since the start of the device, ms, from which another host may set up its finger: after this one's set-up.
    pub const fn set_up_ms(&self) -> u64 {
        self.set_up_ms
    }

    /// The bytes sent at a half millisecond since the start of the device, if any.
    pub fn send(&mut self, half_ms: u64) -> Option<&[u8]> {
        let next = self.queue.get(self.next);
        let Some((_, bytes)) = next.filter(|(ms, bytes)| half_ms >= 2 * ms + sending_half(bytes))
        else {
            let now_ms = half_ms / 2;
            if within(&self.silences, now_ms) {
                return None;
            }
            let floods = within(&self.floods, now_ms);
            return (floods.then_some(FLOOD)).or_else(|| self.playing.send(half_ms));
        };
        self.next += 1;
        Some(bytes)
    }
}

fn within(times: &[Range<u64>], ms: u64) -> bool {
    times.iter().any(|times| times.contains(&ms))
}

/// The half of the millisecond at whose start bytes are sent: the one for which their last byte arrives far from a tick,
/// so that both engines execute the line in the same tick.
pub(crate) fn sending_half(bytes: &[u8]) -> u64 {
    (31..=80).contains(&bytes.len()).into()
}

/// Delays lines that would be sent before the previous line has been answered.
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
