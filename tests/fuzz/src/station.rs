//! Samples of any kind, and lines in between.

use arbitrary::{Arbitrary, Unstructured};
use thermal_display::commissioning::SENSOR_WORDS;
use thermal_display::device::Finger;
use thermal_display::device::drive::Drive;
use thermal_display::device::safety::Fault;
use thermal_display::device::sense::{CHANNELS, SCANS_PER_TICK, Samples, Scan};

use crate::start::StartDevices;

static STARTS: StartDevices<1> = StartDevices::new();
const FINGER: Finger<1> = Finger::FIRST;

/// Ticks of one input, at most.
const TICKS: u32 = 2500;

/// What happens to the device, from a state on.
#[derive(Arbitrary, Debug)]
struct Course {
    start: u8,
    events: Vec<Event>,
}

/// One thing that happens.
#[derive(Arbitrary, Debug)]
enum Event {
    /// Ticks on the tile.
    Run(u8),
    /// A tick with any sums.
    Sums([u16; CHANNELS], bool),
    /// A tick of any conversions, the last unlike the others.
    Scans([u16; CHANNELS], [u16; CHANNELS]),
    /// Ticks on the tile in which one channel says something else.
    Stuck { channel: u8, sum: u16, ticks: u8 },
    /// Ticks on the tile in which one channel is off, by so much more every tick.
    Off {
        channel: u8,
        by: i16,
        more: i8,
        ticks: u8,
    },
    /// A tick in which the bridge's fault line is pulled.
    BridgeFault,
    /// Force in 16ths of a newton.
    Press(u8),
    /// Sink, skin and room, in half degrees.
    Surround(u8, u8, u8),
    /// A reason that samples do not show.
    Trip(u8),
    /// The host is heard.
    Hear,
    /// A line.
    Say(Line),
}

/// A line of the protocol whose numbers are most often allowed.
#[derive(Arbitrary, Debug)]
enum Line {
    Word(u8),
    Material(u8),
    Custom([u16; 5]),
    Object(i8),
    Hold(u8),
    Stream(u8),
    Steps(u8, Vec<i8>),
    Correction(u8, [i16; 3]),
    Tile([u16; 5]),
    Point(u8, u16),
}

/// Lines without numbers.
const WORDS: [&str; 21] = [
    "arm",
    "start",
    "abort",
    "clear",
    "tune",
    "tune result",
    "margins",
    "state",
    "cause",
    "settings",
    "id",
    "law",
    "law model",
    "law pi",
    "law pi-10hz",
    "mode contact",
    "mode semi-infinite",
    "object room",
    "calibrate display clear",
    "calibrate check clear",
    "calibrate sink clear",
];

const MATERIALS: [&str; 9] = [
    "copper",
    "bronze",
    "stainless-steel",
    "granite",
    "g10",
    "abs",
    "foam",
    "baf2",
    "zns",
];

/// One of several, counted modulo their number.
fn of<T: Copy>(all: &[T], which: u8) -> T {
    all[usize::from(which) % all.len()]
}

impl Line {
    fn text(&self) -> String {
        let fraction = |value: u16, most: f64| most * f64::from(value) / 65535.0;
        match self {
            Self::Word(which) => of(&WORDS, *which).into(),
            Self::Material(which) => format!("material {}", of(&MATERIALS, *which)),
            Self::Custom(values) => {
                let most = [5000.0, 30_000.0, 10_000.0, 1000.0, 1.5];
                let values = values.iter().zip(most).map(|(value, most)| {
                    // By decades: a property of one material is a thousandth of another's.
                    let decades = f64::from(value >> 8) / 256.0 * 5.0;
                    format!(
                        " {:.6}",
                        most * 10f64.powf(-decades) * (1.0 - fraction(value & 0xff, 100.0))
                    )
                });
                format!("material custom{}", values.collect::<String>())
            }
            Self::Object(celsius) => format!("object {celsius}"),
            Self::Hold(half_c) => format!("hold {}", 0.5 * f64::from(*half_c)),
            Self::Stream(ms) => format!("stream {ms}"),
            Self::Steps(border, steps) => {
                let steps = steps
                    .iter()
                    .take(7)
                    .map(|step| format!(" {}", f64::from(*step) / 32.0));
                format!(
                    "set steps {}{}",
                    10 + border % 13,
                    steps.collect::<String>()
                )
            }
            Self::Correction(sensor, [offset, slope, curvature]) => {
                let part = |value: &i16, most: f64| most * f64::from(*value) / 32768.0;
                format!(
                    "set correction {} {:.6} {:.7} {:.8}",
                    of(&SENSOR_WORDS, *sensor),
                    part(offset, 1.2),
                    part(slope, 0.05),
                    part(curvature, 0.002)
                )
            }
            Self::Tile(values) => {
                let most = [15.0, 0.5, 5.0, 5.0, 1.0];
                let values = values
                    .iter()
                    .zip(most)
                    .map(|(value, most)| format!(" {:.6}", fraction(*value, most)));
                format!("set tile{}", values.collect::<String>())
            }
            Self::Point(sensor, celsius) => {
                format!(
                    "calibrate {} {:.3}",
                    of(&SENSOR_WORDS, *sensor),
                    fraction(*celsius, 60.0)
                )
            }
        }
    }
}

/// The channel's place in the samples, counted modulo their number.
fn channel(samples: &mut Samples, which: u8) -> &mut u16 {
    match usize::from(which) % CHANNELS {
        0 => &mut samples.display,
        1 => &mut samples.display_check,
        2 => &mut samples.sink,
        3 => &mut samples.skin,
        4 => &mut samples.room,
        5 => &mut samples.force,
        _ => &mut samples.current,
    }
}

/// See [`Course`].
pub fn run(input: &[u8]) -> bool {
    let Ok(course) = Course::arbitrary_take_rest(Unstructured::new(input)) else {
        return false;
    };
    let mut device = STARTS.get(course.start);
    let mut left = TICKS;
    let mut limited = |ticks: u8| {
        let ticks = left.min(u32::from(ticks));
        left -= ticks;
        ticks
    };
    for event in &course.events {
        match *event {
            Event::Run(ticks) => device.run(limited(ticks)),
            Event::Sums(
                [display, display_check, sink, skin, room, force, current],
                bridge_fault,
            ) => {
                let samples = Samples {
                    display,
                    display_check,
                    sink,
                    skin,
                    room,
                    force,
                    current,
                    bridge_fault,
                };
                device.step(FINGER, &samples);
            }
            Event::Scans(counts, last) => {
                let scan = |counts: [u16; CHANNELS]| -> Scan { counts.map(|count| count & 0x0fff) };
                let mut scans = [scan(counts); SCANS_PER_TICK];
                scans[SCANS_PER_TICK - 1] = scan(last);
                let broken = scan(last)[..5]
                    .iter()
                    .any(|count| matches!(count, 0 | 4095));
                let outputs = device.step(FINGER, &Samples::from_scans(&scans, false));
                assert!(
                    !broken || outputs.drive == Drive::Off,
                    "driven in the tick in which a wire broke"
                );
            }
            Event::Stuck {
                channel: which,
                sum,
                ticks,
            } => {
                for _ in 0..limited(ticks) {
                    device.tick_with(FINGER, |samples| *channel(samples, which) = sum);
                }
            }
            Event::Off {
                channel: which,
                by,
                more,
                ticks,
            } => {
                for tick in 0..limited(ticks) as i32 {
                    let off = i32::from(by) + tick * i32::from(more);
                    device.tick_with(FINGER, |samples| {
                        let place = channel(samples, which);
                        *place = (i32::from(*place) + off).clamp(0, 65_535) as u16;
                    });
                }
            }
            Event::BridgeFault => device.tick_with(FINGER, |samples| samples.bridge_fault = true),
            Event::Press(part) => device.tile(FINGER).press(f64::from(part) / 16.0),
            Event::Surround(sink, skin, room) => {
                let [sink, skin, room] = [sink, skin, room].map(|half| 0.5 * f64::from(half));
                device.tile(FINGER).surround(sink, skin, room);
            }
            Event::Trip(which) => device.trip_all(of(Fault::ALL, which)),
            Event::Hear => device.note_host_activity(),
            Event::Say(ref line) => {
                let _ = device.line(&line.text());
            }
        }
    }
    true
}

/// The course, line by line.
pub fn show(input: &[u8]) -> String {
    match Course::arbitrary_take_rest(Unstructured::new(input)) {
        Ok(course) => {
            let told = course.events.iter().map(|event| match event {
                Event::Say(line) => format!("say {:?}\n", line.text()),
                event => format!("{event:?}\n"),
            });
            format!("start {}\n{}", course.start, told.collect::<String>())
        }
        Err(error) => error.to_string(),
    }
}
