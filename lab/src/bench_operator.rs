//! The operator at the bench: is told what to do, and asked for what the reference thermometer shows.

use std::io::{self, BufRead, Write};
use std::sync::mpsc::{self, Receiver, RecvTimeoutError, TryRecvError};
use std::thread;
use std::time::Duration;

use thermal_client::client::{Client, ClientError, StationRequest};
use thermal_client::commissioning::{
    CommissioningEvent, PhantomPlace, Surroundings, SurroundingsError,
};
use thermal_client::link::{Link, LinkError};
use thermal_client::text;
use thermal_device::safety::ThermistorId;

/// Range of a reading, °C, and its largest distance from what was asked for, K.
const READING_C: (f64, f64) = (0.0, 60.0);
const DISTANCE_MAX_K: f64 = 3.0;
/// A point that the calibration misses by more than this, mK, is worth a second look at what was entered.
const MISFIT_MK: f64 = 20.0;
/// Distance from what the device reads, K, beyond which a number must be entered twice: as long as its thermistor has fewer
/// than so many points, and from then on.
const FAR_K: f64 = 0.3;
const FEW_POINTS: u32 = 3;
const FAR_CALIBRATED_K: f64 = 0.05;
/// Interval of the telemetry from which the device's reading is taken, ms, and its timeout.
const TELEMETRY_MS: u32 = 20;
const TELEMETRY_TIMEOUT: Duration = Duration::from_millis(500);
/// Interval of the telemetry while a person commissions, ms: a device that streams and is driven trips by `host-silent`
/// when this program or its computer stops.
pub const WATCHED_STREAM_MS: u32 = 500;
/// Time between two looks at the device while the person types.
const POLL_INTERVAL: Duration = Duration::from_millis(100);
/// Time for which such a look waits for the device: what has arrived is read, and the person hardly waits.
const LOOK: Duration = Duration::from_millis(1);

/// What the person enters to end a procedure.
const ABORT: &str = "abort";

/// Lines that the person enters.
pub type Lines = Receiver<io::Result<String>>;

/// The operator at the bench.
pub struct BenchOperator<'a> {
    finger: Option<u8>,
    lines: Lines,
    screen: &'a mut dyn Write,
    /// Temperature that was asked for last, °C.
    asked_c: Option<f64>,
    /// What the person has entered since anything changed, °C; it holds for both thermistors of the display.
    entered_c: Option<f64>,
    /// Points of the thermistor so far.
    points: u32,
}

/// Lines of a reader, such as standard input, which another thread waits for: UTF-8, with or without a byte order mark.
pub fn lines(reader: impl BufRead + Send + 'static) -> Lines {
    let (sender, lines) = mpsc::channel();
    thread::spawn(move || {
        // Ends when nobody listens.
        for line in text::lines(reader) {
            if sender.send(line).is_err() {
                break;
            }
        }
    });
    lines
}

impl<'a> BenchOperator<'a> {
    /// A person at a device, or at one of its fingers, who enters `lines` and reads the screen.
    pub fn new(finger: Option<u8>, lines: Lines, screen: &'a mut dyn Write) -> Self {
        Self { finger, lines, screen, asked_c: None, entered_c: None, points: 0 }
    }

    pub(crate) fn tell(&mut self, text: &str) {
        // What is on the screen changes nothing of the procedure.
        let _ignored = self.screen.write_all(text.as_bytes());
        let _ignored = self.screen.flush();
    }

    /// Asks until the person has entered a line. The link is looked after meanwhile. `abort` ends the procedure.
    pub(crate) fn ask<L: Link>(
        &mut self,
        client: &mut Client<L>,
        question: &str,
    ) -> Result<String, SurroundingsError> {
        self.tell(question);
        loop {
            match self.lines.recv_timeout(POLL_INTERVAL) {
                Ok(line) => return entered(line),
                Err(RecvTimeoutError::Disconnected) => return Err(no_more_lines()),
                Err(RecvTimeoutError::Timeout) => client.wait(LOOK).map_err(ended)?,
            }
        }
    }

    /// The line that the person has entered meanwhile, if any.
    pub(crate) fn typed(&mut self) -> Result<Option<String>, SurroundingsError> {
        match self.lines.try_recv() {
            Ok(line) => entered(line).map(Some),
            Err(TryRecvError::Empty) => Ok(None),
            Err(TryRecvError::Disconnected) => Err(no_more_lines()),
        }
    }

    /// The temperature that a line says; otherwise what is wrong with it and what is allowed.
    fn reading_c(&self, line: &str) -> Result<f64, String> {
        let (mut least_c, mut most_c) = READING_C;
        if let Some(asked_c) = self.asked_c {
            least_c = asked_c - DISTANCE_MAX_K;
            most_c = asked_c + DISTANCE_MAX_K;
        }
        let allowed = format!("{least_c:.1} to {most_c:.1} C");
        // A comma is what many keyboards and thermometers have.
        let Ok(celsius) = line.replace(',', ".").parse::<f64>() else {
            return Err(format!("'{line}' is not a number of C; allowed: {allowed}"));
        };
        if (least_c..=most_c).contains(&celsius) {
            Ok(celsius)
        } else {
            Err(format!("'{line}' cannot be; allowed: {allowed}"))
        }
    }
}

/// What the device reads at a thermistor now, °C, by its telemetry.
fn device_reads_c<L: Link>(
    client: &mut Client<L>,
    finger: Option<u8>,
    thermistor: ThermistorId,
) -> Result<Option<f64>, ClientError> {
    while client.next_telemetry(Duration::ZERO)?.is_some() {}
    client.ask_finger(finger, &StationRequest::stream(TELEMETRY_MS))?;
    let line = client.next_telemetry_of(finger, TELEMETRY_TIMEOUT)?;
    client.ask_finger(finger, &StationRequest::stream(WATCHED_STREAM_MS))?;
    Ok(line.and_then(|line| match thermistor {
        ThermistorId::Display | ThermistorId::Check => line.telemetry.display_c,
        ThermistorId::Sink => line.telemetry.sink_c,
        ThermistorId::Skin => line.telemetry.skin_c,
        ThermistorId::Room => line.telemetry.room_c,
    }))
}

fn entered(line: io::Result<String>) -> Result<String, SurroundingsError> {
    let line = line.map_err(|error| SurroundingsError::Failed(error.to_string()))?;
    let line = line.trim();
    if line.eq_ignore_ascii_case(ABORT) {
        return Err(SurroundingsError::Interrupted);
    }
    Ok(line.to_owned())
}

fn no_more_lines() -> SurroundingsError {
    SurroundingsError::Failed("standard input has ended before the procedure".into())
}

fn ended(error: LinkError) -> SurroundingsError {
    match error {
        LinkError::Interrupted => SurroundingsError::Interrupted,
        LinkError::Gone(_) => SurroundingsError::Failed(error.to_string()),
    }
}

impl<L: Link> Surroundings<L> for BenchOperator<'_> {
    fn reference_c(
        &mut self,
        client: &mut Client<L>,
        thermistor: ThermistorId,
    ) -> Result<f64, SurroundingsError> {
        if let Some(entered_c) = self.entered_c {
            return Ok(entered_c);
        }
        let place = match thermistor {
            ThermistorId::Display | ThermistorId::Check => "on the display",
            ThermistorId::Sink => "on the sink",
            ThermistorId::Skin => "beside the skin's thermistor",
            ThermistorId::Room => "beside the room's thermistor",
        };
        let question =
            format!("  Wait until the reference thermometer {place} is steady. It shows, in C: ");
        let mut entered_before_c = None;
        loop {
            let line = self.ask(client, &question)?;
            let celsius = match self.reading_c(&line) {
                Ok(celsius) => celsius,
                Err(why) => {
                    self.tell(&format!("  {why}\n"));
                    continue;
                }
            };
            let device_c = device_reads_c(client, self.finger, thermistor);
            let device_c = device_c.map_err(|error| match error {
                ClientError::Link(error) => ended(error),
                error => SurroundingsError::Failed(error.to_string()),
            })?;
            let far_k = if self.points < FEW_POINTS { FAR_K } else { FAR_CALIBRATED_K };
            match device_c.filter(|device_c| (celsius - device_c).abs() > far_k) {
                Some(device_c) if entered_before_c != Some(celsius) => {
                    entered_before_c = Some(celsius);
                    self.tell(&format!(
                        "  The device reads {device_c:.3} C. If {celsius:.3} C is right, enter it again.\n"
                    ));
                }
                _ => {
                    self.entered_c = Some(celsius);
                    return Ok(celsius);
                }
            }
        }
    }

    fn put_probe_on_display(
        &mut self,
        client: &mut Client<L>,
        on: bool,
    ) -> Result<(), SurroundingsError> {
        let what = if on {
            "Put the probe of the reference thermometer on the display"
        } else {
            "Take the probe off the display, and touch nothing"
        };
        self.ask(client, &format!("  {what}, then press Enter: ")).map(drop)
    }

    fn put_into_bath(
        &mut self,
        client: &mut Client<L>,
        thermistor: ThermistorId,
        bath_c: f64,
    ) -> Result<(), SurroundingsError> {
        (self.asked_c, self.entered_c) = (Some(bath_c), None);
        let what = match thermistor {
            ThermistorId::Sink => {
                "Bring the sink to about {} C, with the reference thermometer on it".to_owned()
            }
            other => {
                let word = other.name();
                format!(
                    "Put the {word} thermistor and the reference thermometer into a bath of about {{}} C"
                )
            }
        };
        let what = what.replace("{}", &format!("{bath_c:.1}"));
        self.ask(client, &format!("  {what}, then press Enter: ")).map(drop)
    }

    fn move_phantom(
        &mut self,
        client: &mut Client<L>,
        place: PhantomPlace,
    ) -> Result<(), SurroundingsError> {
        let what = match place {
            PhantomPlace::Beside => {
                "Have the phantom beside the display, a gel of 1 % agar that has the room's temperature; nothing touches the display"
            }
            PhantomPlace::OnDisplay => {
                "Put the phantom on the display and 200 g on it; do not touch it from then on"
            }
            PhantomPlace::Away => "Take the phantom away and dry the display",
        };
        self.ask(client, &format!("  {what}, then press Enter: ")).map(drop)
    }

    fn reads_again(&mut self, why: &str) -> bool {
        // The bath stays as it is: its point is left out, as the others suffice.
        !why.starts_with("tripped") && !why.starts_with("at a step")
    }

    fn notice(&mut self, event: &CommissioningEvent) {
        let mut text = format!("{event}\n");
        match event {
            CommissioningEvent::StepStarted(_) => {
                (self.asked_c, self.entered_c, self.points) = (None, None, 0);
            }
            CommissioningEvent::HoldStarted(hold_c) => {
                (self.asked_c, self.entered_c) = (Some(*hold_c), None);
            }
            CommissioningEvent::PointRefused { .. } => self.entered_c = None,
            CommissioningEvent::PointAccepted(point) => {
                self.points = point.points;
                if point.worst_mk > MISFIT_MK {
                    text += "  If a number was wrong, press Ctrl-C and begin again.\n";
                }
            }
            CommissioningEvent::TileIdentified(_) | CommissioningEvent::FluxCalibrated(_) => {}
        }
        self.tell(&text);
    }
}
