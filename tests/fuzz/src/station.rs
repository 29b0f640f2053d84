//! A device with one finger under samples of any kind, with lines and faults in between.

use arbitrary::{Arbitrary, Unstructured};
use contact_model::fixed_point::WEIGHTS;
use contact_model::material::THESIS_MATERIALS;
use fixed::types::{I2F30, I4F28, I10F22};
use thermal_display::device::FingerIndex;
use thermal_display::device::drive::Drive;
use thermal_display::device::safety::Fault;
use thermal_display::device::safety::ThermistorId;
use thermal_display::device::sense::{
    ADC_CHANNELS_PER_FINGER, DigitalInputs, SCANS_PER_TICK, Samples, Scan,
};
use thermal_display::settings::Vocabulary as _;

use thermal_display::device::learning::FingerKnowledge;
use thermal_learner::{Learner, LearnerInput, LearnerOutput, Trust};

use crate::device::{Answers, FluxCodes};
use crate::start::StartDevices;

static STARTS: StartDevices<1> = StartDevices::new();
const FINGER: FingerIndex<1> = FingerIndex::FIRST;

/// Largest number of ticks of one input.
const TICKS: u32 = 2500;

/// The initial state of the device, and the events that follow.
#[derive(Arbitrary, Debug)]
struct Input {
    start: u8,
    events: Vec<Event>,
}

/// An event.
#[derive(Arbitrary, Debug)]
enum Event {
    /// Ticks on the tile.
    Run(u8),
    /// A tick with these sums, bridge fault and emergency stop.
    Sums([u16; ADC_CHANNELS_PER_FINGER], bool, bool),
    /// A tick with these conversions, the second ones in the last scan.
    Scans([u16; ADC_CHANNELS_PER_FINGER], [u16; ADC_CHANNELS_PER_FINGER]),
    /// Ticks on the tile in which one channel is stuck at a sum.
    Stuck { channel: u8, sum: u16, ticks: u8 },
    /// Ticks on the tile in which one channel has an offset that grows.
    Offset { channel: u8, start: i16, per_tick: i8, ticks: u8 },
    /// A tick in which the bridge reports a fault.
    BridgeFault,
    /// Force, 1/16 N.
    Press(u8),
    /// Temperatures of sink, skin and room, 0.5 °C.
    Surroundings(u8, u8, u8),
    /// A fault that is detected outside of the station.
    Trip(u8),
    /// Activity of the host.
    HostActivity,
    /// A line from the host.
    Line(Line),
    /// The lines of an upload.
    Upload(Upload),
    /// A heat-flux sensor, or none.
    FluxSensor(Option<[u16; 4]>),
    /// Codes of the heat-flux sensor: as of a force, or two in turn.
    FluxCodes(Option<[u16; 2]>),
    /// What answers the learner's inputs: the learner, nothing, or this.
    Answers(Option<Option<Answer>>),
    /// An answer that nobody has asked for.
    Unasked(Answer),
}

/// Any answer of a learner, whether a learner would give it or not.
#[derive(Arbitrary, Clone, Copy, Debug)]
struct Answer {
    sequence: u16,
    weights: [i32; WEIGHTS],
    air: i32,
    skin: i32,
    resistance: i32,
    trust: u8,
}

impl Answer {
    fn output(&self) -> LearnerOutput {
        let mean = *Learner::new().advance(&LearnerInput {
            sequence: self.sequence,
            restart: None,
            flux_w_m2: None,
            contact: None,
        });
        let trusts = FingerKnowledge::ALL.map(|knowledge| match knowledge {
            FingerKnowledge::Learnt(trust) => trust,
            _ => Trust::Learning,
        });
        LearnerOutput {
            weights: self.weights.map(I2F30::from_bits),
            air_flux_deviation: I4F28::from_bits(self.air),
            skin_offset_k: I10F22::from_bits(self.skin),
            resistance_factor: I4F28::from_bits(self.resistance),
            trust: element(&trusts, self.trust),
            ..mean
        }
    }
}

/// A line of the protocol whose numbers are within their ranges most of the time.
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
    Slab { tenths_mm: u16, back: u8, film: u16 },
}

/// Rows of an upload: one more than are allowed.
const ROWS_MAX: usize = 23;

/// An upload of an object, whole most of the time.
#[derive(Arbitrary, Debug)]
struct Upload {
    direct: u16,
    /// Rate and gain of each row.
    rows: Vec<(u16, u16)>,
    /// Place and value of a byte that is changed on its way.
    damage: Option<(u16, u8)>,
}

impl Upload {
    fn lines(&self) -> Vec<String> {
        // Logarithmic, from those of copper to those of foam and beyond the limit, 1.3e7 mm² K/J.
        let decades = |value: u16| 10f64.powf(f64::from(value) / 65535.0 * 10.2 - 3.0);
        let mut text = format!(
            "upload begin object {} {:.3}\n",
            self.rows.len().min(ROWS_MAX),
            // A little beyond the limit, 27000 mm² K/W.
            0.42 * f64::from(self.direct)
        );
        for (index, (rate, gain)) in self.rows.iter().take(ROWS_MAX).enumerate() {
            let rate = f64::from(*rate) * f64::from(*rate) / 6.2e6;
            text += &format!("upload row {index} {rate:.6} {:.6}\n", decades(*gain));
        }
        let checksum = crc::Crc::<u32>::new(&crc::CRC_32_ISO_HDLC).checksum(text.as_bytes());
        text += &format!("upload commit {checksum:08x}");
        if let Some((place, byte)) = self.damage {
            let place = usize::from(place) % text.len();
            let byte = char::from(b' ' + byte % 95);
            text.replace_range(place..=place, &byte.to_string());
        }
        text.lines().map(String::from).collect()
    }
}

/// Lines without numbers.
const WORDS: [&str; 36] = [
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
    "finger",
    "finger mean",
    "finger thesis",
    "object half-space",
    "pulse 24 42 100 0.1 100 now 100",
    "pulse 36 20 5 0.1 2 landing 3 neutral",
    "play now 2",
    "play landing",
    "skin sensor",
    "skin 33",
    "events on",
    "trigger-out land,lift,start,end",
    "flux",
    "flux zero",
    "flux set 0.1192 2048 5 30",
];

/// The element at an index modulo their number.
fn element<T: Copy>(all: &[T], index: u8) -> T {
    all[usize::from(index) % all.len()]
}

impl Line {
    fn text(&self) -> String {
        let fraction = |value: u16, max: f64| max * f64::from(value) / 65535.0;
        match self {
            Self::Word(index) => element(&WORDS, *index).into(),
            Self::Material(index) => format!("material {}", element(&THESIS_MATERIALS, *index)),
            Self::Custom(values) => {
                let max = [5000.0, 30_000.0, 10_000.0, 1000.0, 1.5];
                let values = values.iter().zip(max).map(|(value, max)| {
                    // Logarithmic, because the properties of materials differ by factors of a thousand.
                    let decades = f64::from(value >> 8) / 256.0 * 5.0;
                    format!(
                        " {:.6}",
                        max * 10f64.powf(-decades) * (1.0 - fraction(value & 0xff, 100.0))
                    )
                });
                format!("material custom{}", values.collect::<String>())
            }
            Self::Object(celsius) => format!("object {celsius}"),
            Self::Hold(half_c) => format!("hold {}", 0.5 * f64::from(*half_c)),
            Self::Stream(ms) => format!("stream {ms}"),
            Self::Steps(border, steps) => {
                let steps =
                    steps.iter().take(7).map(|step| format!(" {}", f64::from(*step) / 32.0));
                format!("set steps {}{}", 10 + border % 13, steps.collect::<String>())
            }
            Self::Correction(sensor, [offset, slope, curvature]) => {
                let fraction = |value: &i16, max: f64| max * f64::from(*value) / 32768.0;
                format!(
                    "set correction {} {:.6} {:.7} {:.8}",
                    element(ThermistorId::WORDS.words, *sensor),
                    fraction(offset, 1.2),
                    fraction(slope, 0.05),
                    fraction(curvature, 0.002)
                )
            }
            Self::Tile(values) => {
                let max = [15.0, 0.5, 5.0, 5.0, 1.0];
                let values = values
                    .iter()
                    .zip(max)
                    .map(|(value, max)| format!(" {:.6}", fraction(*value, max)));
                format!("set tile{}", values.collect::<String>())
            }
            Self::Slab { tenths_mm, back, film } => {
                let film = format!("film {film}");
                let back = element(&["insulated", "held", &film], *back);
                format!("object slab {:.1}mm {back}", f64::from(*tenths_mm) / 10.0)
            }
            Self::Point(sensor, celsius) => {
                format!(
                    "calibrate {} {:.3}",
                    element(ThermistorId::WORDS.words, *sensor),
                    fraction(*celsius, 60.0)
                )
            }
        }
    }
}

/// The line that tells of a heat-flux sensor with these values, over the ranges that are allowed and a little beyond.
fn flux_line(sensor: Option<[u16; 4]>) -> String {
    let Some(values) = sensor else {
        return "flux none".into();
    };
    let ranges = [(0.01, 1.01), (60.0, 4040.0), (0.1, 502.0), (0.0, 1010.0)];
    let values = values.iter().zip(ranges).map(|(value, (low, high))| {
        format!(" {:.4}", low + (high - low) * f64::from(*value) / 65535.0)
    });
    format!("flux set{}", values.collect::<String>())
}

/// The sum of the channel with this index, modulo their number.
fn channel(samples: &mut Samples, index: u8) -> &mut u16 {
    match usize::from(index) % ADC_CHANNELS_PER_FINGER {
        0 => &mut samples.display,
        1 => &mut samples.display_check,
        2 => &mut samples.sink,
        3 => &mut samples.skin,
        4 => &mut samples.room,
        5 => &mut samples.force,
        6 => &mut samples.current,
        _ => &mut samples.supply,
    }
}

/// Applies the events in order.
pub fn run(input: &[u8]) -> bool {
    let Ok(input) = Input::arbitrary_take_rest(Unstructured::new(input)) else {
        return false;
    };
    let mut device = STARTS.get(input.start);
    let mut remaining = TICKS;
    let mut limited = |ticks: u8| {
        let ticks = remaining.min(u32::from(ticks));
        remaining -= ticks;
        ticks
    };
    for event in &input.events {
        match *event {
            Event::Run(ticks) => device.run(limited(ticks)),
            Event::Sums(
                [display, display_check, sink, skin, room, force, current, supply],
                bridge_fault,
                emergency_stop,
            ) => {
                let samples = Samples {
                    display,
                    display_check,
                    sink,
                    skin,
                    room,
                    force,
                    current,
                    supply,
                    bridge_fault,
                    emergency_stop,
                    comparator_side_differs: false,
                    scattering_thermistors: 5,
                };
                device.step(FINGER, &samples);
            }
            Event::Scans(counts, last) => {
                let scan = |counts: [u16; ADC_CHANNELS_PER_FINGER]| -> Scan {
                    counts.map(|count| count & 0x0fff)
                };
                let mut scans = [scan(counts); SCANS_PER_TICK];
                scans[SCANS_PER_TICK - 1] = scan(last);
                let broken = scan(last)[..5].iter().any(|count| matches!(count, 0 | 4095));
                let outputs = device
                    .step(FINGER, &Samples::from_scans(&scans, DigitalInputs::default(), true));
                assert!(
                    !broken || outputs.drive == Drive::Off,
                    "driven in the tick in which a wire broke"
                );
            }
            Event::Stuck { channel: index, sum, ticks } => {
                for _ in 0..limited(ticks) {
                    device.tick_with(FINGER, |samples| *channel(samples, index) = sum);
                }
            }
            Event::Offset { channel: index, start, per_tick, ticks } => {
                for tick in 0..limited(ticks) as i32 {
                    let offset = i32::from(start) + tick * i32::from(per_tick);
                    device.tick_with(FINGER, |samples| {
                        let sum = channel(samples, index);
                        *sum = (i32::from(*sum) + offset).clamp(0, 65_535) as u16;
                    });
                }
            }
            Event::BridgeFault => device.tick_with(FINGER, |samples| samples.bridge_fault = true),
            Event::Press(sixteenths_n) => device.tile(FINGER).press(f64::from(sixteenths_n) / 16.0),
            Event::Surroundings(sink, skin, room) => {
                let [sink, skin, room] =
                    [sink, skin, room].map(|halves_c| 0.5 * f64::from(halves_c));
                device.tile(FINGER).set_surroundings(sink, skin, room);
            }
            Event::Trip(index) => device.trip_all(element(Fault::ALL, index)),
            Event::HostActivity => device.note_host_activity(),
            Event::Line(ref line) => {
                let _ = device.line(&line.text());
            }
            Event::Upload(ref upload) => {
                for line in upload.lines() {
                    let _ = device.line(&line);
                }
            }
            Event::FluxSensor(sensor) => {
                let _ = device.line(&flux_line(sensor));
            }
            Event::FluxCodes(codes) => {
                device.set_flux_codes(codes.map_or(FluxCodes::OfForce, FluxCodes::InTurn));
            }
            Event::Answers(answers) => device.set_answers(match answers {
                None => Answers::Learner,
                Some(None) => Answers::None,
                Some(Some(answer)) => Answers::Always(answer.output()),
            }),
            Event::Unasked(answer) => device.answer_unasked(FINGER, &answer.output()),
        }
    }
    true
}

/// The events, one a line.
pub fn show(input: &[u8]) -> String {
    match Input::arbitrary_take_rest(Unstructured::new(input)) {
        Ok(input) => {
            let events = input.events.iter().map(|event| match event {
                Event::Line(line) => format!("Line({:?})\n", line.text()),
                Event::Upload(upload) => format!("Upload({:?})\n", upload.lines()),
                event => format!("{event:?}\n"),
            });
            format!("start {}\n{}", input.start, events.collect::<String>())
        }
        Err(error) => error.to_string(),
    }
}
