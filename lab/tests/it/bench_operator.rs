//! A person who commissions a device, and mistypes.

use std::cell::RefCell;
use std::io;
use std::rc::Rc;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::{self, Sender};

use thermal_device::StateName;
use thermal_device::safety::ThermistorId;
use thermal_lab::bench_operator::BenchOperator;
use thermal_lab::client::{Client, QueryState, SessionRequest, SettingsLine};
use thermal_lab::commissioning::{
    CommissionError, CommissioningEvent, CommissioningRecord, PhantomPlace, Surroundings,
    SurroundingsError, commission,
};
use thermal_lab::link::{Interruptible, LinkError, SimulatedLink};
use thermal_plant::Params;
use thermal_plant::sensors::FluxParams;
use thermal_settings::FluxSensor;
use thermal_sim::commissioning::{CommissioningSetup, SimulatedSurroundings};
use thermal_sim::engine::NativeEngine;

type Bench<'a> = SimulatedLink<'a, NativeEngine>;

/// A screen in front of a person who reads a simulated thermometer and types what it shows.
struct Screen {
    text: String,
    keys: Sender<io::Result<String>>,
    /// What the thermometer shows, as one with a comma shows it.
    shown: Rc<RefCell<String>>,
    /// What is typed instead at the question for a reading that has this number.
    slips: Vec<(usize, &'static str)>,
    questions: usize,
}

impl io::Write for Screen {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        self.text += std::str::from_utf8(bytes).unwrap();
        if bytes.ends_with(b"press Enter: ") {
            self.keys.send(Ok(String::new())).unwrap();
        } else if bytes.ends_with(b"in C: ") {
            self.questions += 1;
            let slip = self.slips.iter().find(|(at, _)| *at == self.questions);
            let typed =
                slip.map_or_else(|| self.shown.borrow().clone(), |(_, slip)| (*slip).into());
            self.keys.send(Ok(typed)).unwrap();
        }
        Ok(bytes.len())
    }

    fn flush(&mut self) -> io::Result<()> {
        Ok(())
    }
}

/// The person, and the thermometer and baths that are simulated for them.
struct AtTheBench<'a> {
    person: BenchOperator<'a>,
    surroundings: SimulatedSurroundings,
    shown: Rc<RefCell<String>>,
}

impl<'b> Surroundings<Bench<'b>> for AtTheBench<'_> {
    fn reference_c(
        &mut self,
        client: &mut Client<Bench<'b>>,
        thermistor: ThermistorId,
    ) -> Result<f64, SurroundingsError> {
        let world = client.link().world();
        let shown_c = self.surroundings.reference_c(world, thermistor);
        *self.shown.borrow_mut() = format!(" {shown_c:.3} ").replace('.', ",");
        self.person.reference_c(client, thermistor)
    }

    fn put_probe_on_display(
        &mut self,
        client: &mut Client<Bench<'b>>,
        on: bool,
    ) -> Result<(), SurroundingsError> {
        self.person.put_probe_on_display(client, on)
    }

    fn put_into_bath(
        &mut self,
        client: &mut Client<Bench<'b>>,
        thermistor: ThermistorId,
        bath_c: f64,
    ) -> Result<(), SurroundingsError> {
        let world = client.link().world();
        let moved = self.surroundings.put_into_bath(world, thermistor, bath_c);
        moved.unwrap();
        self.person.put_into_bath(client, thermistor, bath_c)
    }

    fn move_phantom(
        &mut self,
        client: &mut Client<Bench<'b>>,
        place: PhantomPlace,
    ) -> Result<(), SurroundingsError> {
        let world = client.link().world();
        self.surroundings.move_phantom(world, place).unwrap();
        self.person.move_phantom(client, place)
    }

    fn reads_again(&mut self, why: &str) -> bool {
        Surroundings::<Bench<'b>>::reads_again(&mut self.person, why)
    }

    fn notice(&mut self, event: &CommissioningEvent) {
        Surroundings::<Bench<'b>>::notice(&mut self.person, event);
    }
}

/// Commissions a drawn device; returns the result and what was on the screen.
fn commissioned(
    setup: &CommissioningSetup,
    slips: Vec<(usize, &'static str)>,
) -> (Result<CommissioningRecord, CommissionError>, String) {
    let mut engine = NativeEngine::new(setup.in_use().unwrap());
    let mut client = Client::new(SimulatedLink::new(&mut engine));
    if setup.params().flux.is_some() {
        let sensor = SessionRequest::flux_sensor(Some(FluxSensor::DESIGNED));
        client.ask(&sensor).unwrap();
    }
    let (keys, lines) = mpsc::channel();
    let shown = Rc::new(RefCell::new(String::new()));
    let mut screen =
        Screen { text: String::new(), keys, shown: Rc::clone(&shown), slips, questions: 0 };
    let mut bench = AtTheBench {
        person: BenchOperator::new(None, lines, &mut screen),
        surroundings: SimulatedSurroundings::new(setup),
        shown,
    };
    let done = commission(&mut client, None, &mut bench);
    (done, screen.text)
}

/// A simulated operator who holds the thermometer into another bath than the skin's thermistor, and gives up after one try
/// in each bath.
struct WrongBath {
    surroundings: SimulatedSurroundings,
    tries: u32,
}

impl<'b> Surroundings<Bench<'b>> for WrongBath {
    fn reference_c(
        &mut self,
        client: &mut Client<Bench<'b>>,
        thermistor: ThermistorId,
    ) -> Result<f64, SurroundingsError> {
        let world = client.link().world();
        let shown_c = self.surroundings.reference_c(world, thermistor);
        let is_skin = thermistor == ThermistorId::Skin;
        Ok(if is_skin { shown_c + 8.0 } else { shown_c })
    }

    fn put_into_bath(
        &mut self,
        client: &mut Client<Bench<'b>>,
        thermistor: ThermistorId,
        bath_c: f64,
    ) -> Result<(), SurroundingsError> {
        let world = client.link().world();
        (self.surroundings.put_into_bath(world, thermistor, bath_c)).unwrap();
        Ok(())
    }

    fn reads_again(&mut self, _why: &str) -> bool {
        self.tries += 1;
        self.tries % 2 == 1
    }

    fn notice(&mut self, _event: &CommissioningEvent) {}
}

#[test]
fn a_thermistor_whose_points_are_all_refused_is_named() {
    let setup = CommissioningSetup::new(&Params::nominal(), 24.0, 1);
    let mut engine = NativeEngine::new(setup.in_use().unwrap());
    let mut client = Client::new(SimulatedLink::new(&mut engine));
    let mut bath = WrongBath { surroundings: SimulatedSurroundings::new(&setup), tries: 0 };
    let error = commission(&mut client, None, &mut bath).unwrap_err();
    let CommissionError::FewPoints { sensor, points, .. } = &error else {
        panic!("{error}");
    };
    assert_eq!((*sensor, *points), ("skin", 0), "{error}");
}

/// The numbers of a line of settings.
fn numbers(line: &str) -> Vec<f64> {
    line.parse::<SettingsLine>().expect("a line of settings");
    line.split(' ').filter_map(|word| word.parse().ok()).collect()
}

#[test]
fn a_person_who_mistypes_is_asked_again_and_gets_the_operators_result() {
    let mut params = Params::nominal();
    thermal_plant::parameters::draw(&mut params, 4);
    let setup = CommissioningSetup::new(&params, 24.0, 4);
    let slips = vec![
        (3, "4o.1"),
        (4, "401"),
        (5, ""),
        // A digit twice, and two digits in the wrong order, when the display is at 33.26 and at 30.26 C.
        (10, "33.5"),
        (13, "30.62"),
    ];
    let (done, screen) = commissioned(&setup, slips);
    let done = done.unwrap();
    for text in [
        "'4o.1' is not a number of C; allowed: 36.7 to 42.7 C",
        "'401' cannot be; allowed: 36.7 to 42.7 C",
        "'' is not a number of C; allowed: ",
        "If 33.500 C is right, enter it again.",
        "If 30.620 C is right, enter it again.",
        "Put the skin thermistor and the reference thermometer into a bath of about 26.7 C",
        "Bring the sink to about 40.7 C",
        "Put the probe of the reference thermometer on the display, then press Enter",
        "Take the probe off the display, and touch nothing, then press Enter",
        "tune again, with calibrated sensors",
    ] {
        assert!(screen.contains(text), "{text}:\n{screen}");
    }
    let operators = thermal_sim::commissioning::settings_for_device(&params, 24.0, 4).unwrap();
    assert_eq!(done.settings.len(), operators.len());
    for (one, other) in done.settings.iter().zip(&operators) {
        // Offsets, slopes and curvatures in K, K/K and 1/K; steps in counts; the tile in its units.
        let bound = if one.starts_with("set correction") { 0.01 } else { 0.3 };
        for (a, b) in numbers(one).into_iter().zip(numbers(other)) {
            assert!((a - b).abs() < bound, "{one}\n{other}");
        }
    }
    assert!(done.points.iter().all(|point| point.worst_mk < 10.0), "{:?}", done.points);
}

#[test]
fn a_heat_flux_sensor_is_calibrated_by_a_person_with_a_phantom() {
    let mut params = Params {
        flux: Some(FluxParams { gain_error: 0.08, ..FluxParams::NOMINAL }),
        ..Params::nominal()
    };
    let setup = CommissioningSetup::new(&params, 24.0, 1);
    let (done, screen) = commissioned(&setup, Vec::new());
    let done = done.unwrap();
    let found = done.flux.unwrap();
    // Three standard deviations of the phantom.
    let gain = found.counts_per_w_m2 / (1.08 * 0.1192);
    assert!((gain - 1.0).abs() < 0.018, "{found}");
    let line = format!("set flux {:.6}", found.counts_per_w_m2);
    let is_set = |set: &String| set.starts_with(&line);
    assert!(done.settings.iter().any(is_set), "{:?}", done.settings);
    for text in [
        "calibrate the heat-flux sensor with a phantom",
        "that has the room's temperature; nothing touches the display, then press Enter",
        "and 200 g on it; do not touch it from then on, then press Enter",
        "Take the phantom away and dry the display, then press Enter",
        "within 0.5",
    ] {
        assert!(screen.contains(text), "{text}:\n{screen}");
    }
    // A sensor that is broken leaves the rest commissioned and stored.
    if let Some(flux) = &mut params.flux {
        flux.gain_error = -0.5;
    }
    let setup = CommissioningSetup::new(&params, 24.0, 1);
    let (failed, screen) = commissioned(&setup, Vec::new());
    let error = failed.unwrap_err().to_string();
    assert!(error.contains("the gain is 0.50 of the designed one"), "{error}");
    let saved = screen.find("save what was found").unwrap();
    assert!(saved < screen.find("with a phantom").unwrap(), "{screen}");
}

/// A reading that the device refuses is asked for again, after a second look at what differs.
#[test]
fn a_number_that_is_insisted_on_is_refused_by_the_device_and_asked_for_again() {
    let setup = CommissioningSetup::new(&Params::nominal(), 24.0, 1);
    let (done, screen) = commissioned(&setup, vec![(2, "38.5"), (3, "38.5")]);
    assert!(screen.contains("If 38.500 C is right"), "{screen}");
    assert!(screen.contains("display  not taken: the device reads 40."), "{screen}");
    assert!(done.is_ok());
}

#[test]
fn without_anybody_at_the_keys_the_procedure_ends_and_the_bridge_is_off() {
    let setup = CommissioningSetup::new(&Params::nominal(), 24.0, 1);
    let mut engine = NativeEngine::new(setup.in_use().unwrap());
    let mut client = Client::new(SimulatedLink::new(&mut engine));
    let (keys, lines) = mpsc::channel();
    drop(keys);
    let mut screen = Vec::new();
    let mut person = BenchOperator::new(None, lines, &mut screen);
    let error = commission(&mut client, None, &mut person).unwrap_err();
    assert!(error.to_string().contains("standard input has ended"), "{error}");
    assert_eq!(client.ask(&QueryState).unwrap().state, StateName::Ready);
}

#[test]
fn an_interruption_at_any_moment_ends_the_procedure_with_the_bridge_off() {
    for readings in [0, 1, 2, 5] {
        let setup = CommissioningSetup::new(&Params::nominal(), 24.0, 1);
        let mut engine = NativeEngine::new(setup.in_use().unwrap());
        let requested = Arc::new(AtomicBool::new(readings == 0));
        let link = SimulatedLink::new(&mut engine);
        let mut client = Client::new(Interruptible::new(link, Arc::clone(&requested)));
        let (keys, lines) = mpsc::channel();
        // Asked for a reading more than there are, the person presses Ctrl-C.
        for _ in 0..readings {
            keys.send(Ok("40.0".to_owned())).unwrap();
        }
        let mut screen = InterruptingScreen { requested, questions: 0, allowed: readings };
        let mut person = BenchOperator::new(None, lines, &mut screen);
        let error = commission(&mut client, None, &mut person).unwrap_err();
        let interrupted = matches!(
            error,
            CommissionError::Surroundings(SurroundingsError::Interrupted)
                | CommissionError::Client(thermal_lab::client::ClientError::Link(
                    LinkError::Interrupted
                ))
        );
        assert!(interrupted, "{readings}: {error}");
        let state = client.ask(&QueryState).unwrap().state;
        assert!(matches!(state, StateName::Ready | StateName::Off), "{readings}: {state:?}");
    }
}

/// A screen in front of a person who presses Ctrl-C instead of answering a question.
struct InterruptingScreen {
    requested: Arc<AtomicBool>,
    questions: usize,
    allowed: usize,
}

impl io::Write for InterruptingScreen {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        self.questions += usize::from(bytes.ends_with(b": "));
        if self.questions > self.allowed {
            self.requested.store(true, Ordering::Relaxed);
        }
        Ok(bytes.len())
    }

    fn flush(&mut self) -> io::Result<()> {
        Ok(())
    }
}
