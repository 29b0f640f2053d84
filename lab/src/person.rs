//! The person at the bench: is told what to do, and asked for what the reference thermometer shows.

use std::io::{self, BufRead, Write};
use std::sync::mpsc::{self, Receiver, RecvTimeoutError};
use std::thread;
use std::time::Duration;

use thermal_client::client::{Client, thermistor_word};
use thermal_client::commissioning::{CommissioningEvent, Surroundings, SurroundingsError};
use thermal_client::link::{Link, LinkError};
use thermal_device::safety::ThermistorId;

/// Range of a reading, °C, and its largest distance from what was asked for, K.
const READING_C: (f64, f64) = (0.0, 60.0);
const DISTANCE_MAX_K: f64 = 3.0;
/// A point that the calibration misses by more than this, mK, is worth a second look at what was entered.
const MISFIT_MK: f64 = 20.0;
/// Time between two looks at the device while the person types.
const LOOK: Duration = Duration::from_millis(100);

/// Lines that the person enters.
pub type Lines = Receiver<io::Result<String>>;

/// A person at the bench.
pub struct Person<'a> {
    lines: Lines,
    screen: &'a mut dyn Write,
    /// Temperature that was asked for last, °C.
    asked_c: Option<f64>,
    /// What the person has entered since anything changed, °C; it holds for both thermistors of the display.
    entered_c: Option<f64>,
}

/// Lines of a reader, such as standard input, which another thread waits for.
pub fn lines(reader: impl BufRead + Send + 'static) -> Lines {
    let (sender, lines) = mpsc::channel();
    thread::spawn(move || {
        // Ends when nobody listens.
        reader.lines().all(|line| sender.send(line).is_ok())
    });
    lines
}

impl<'a> Person<'a> {
    /// A person who enters `lines` and reads the screen.
    pub fn new(lines: Lines, screen: &'a mut dyn Write) -> Self {
        Self {
            lines,
            screen,
            asked_c: None,
            entered_c: None,
        }
    }

    fn tell(&mut self, text: &str) {
        // What is on the screen changes nothing of the procedure.
        let _ignored = self.screen.write_all(text.as_bytes());
        let _ignored = self.screen.flush();
    }

    /// Asks until the person has entered a line. The link is looked after meanwhile.
    fn ask<L: Link>(
        &mut self,
        client: &mut Client<L>,
        question: &str,
    ) -> Result<String, SurroundingsError> {
        self.tell(question);
        loop {
            match self.lines.recv_timeout(LOOK) {
                Ok(Ok(line)) => return Ok(line.trim().to_owned()),
                Ok(Err(error)) => return Err(SurroundingsError::Failed(error.to_string())),
                Err(RecvTimeoutError::Disconnected) => {
                    let why = "standard input has ended before the procedure";
                    return Err(SurroundingsError::Failed(why.into()));
                }
                Err(RecvTimeoutError::Timeout) => client.wait(LOOK / 100).map_err(ended)?,
            }
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

fn ended(error: LinkError) -> SurroundingsError {
    match error {
        LinkError::Interrupted => SurroundingsError::Interrupted,
        LinkError::Gone(_) => SurroundingsError::Failed(error.to_string()),
    }
}

impl<L: Link> Surroundings<L> for Person<'_> {
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
        loop {
            let line = self.ask(client, &question)?;
            match self.reading_c(&line) {
                Ok(celsius) => {
                    self.entered_c = Some(celsius);
                    return Ok(celsius);
                }
                Err(why) => self.tell(&format!("  {why}\n")),
            }
        }
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
                let word = thermistor_word(other);
                format!(
                    "Put the {word} thermistor and the reference thermometer into a bath of about {{}} C"
                )
            }
        };
        let what = what.replace("{}", &format!("{bath_c:.1}"));
        self.ask(client, &format!("  {what}, then press Enter: "))
            .map(drop)
    }

    fn reads_again(&mut self, why: &str) -> bool {
        !why.starts_with("tripped")
    }

    fn notice(&mut self, event: &CommissioningEvent) {
        let mut text = format!("{event}\n");
        match event {
            CommissioningEvent::StepStarted(_) => self.asked_c = None,
            CommissioningEvent::HoldStarted(hold_c) => {
                (self.asked_c, self.entered_c) = (Some(*hold_c), None);
            }
            CommissioningEvent::PointRefused { .. } => self.entered_c = None,
            CommissioningEvent::PointAccepted(point) if point.worst_mk > MISFIT_MK => {
                text += "  If a number was wrong, press Ctrl-C and begin again.\n";
            }
            _ => {}
        }
        self.tell(&text);
    }
}
