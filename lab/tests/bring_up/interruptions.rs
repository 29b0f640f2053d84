//! A bring-up that is ended on the way: the bridge is off, and it goes on where it was.

use thermal_client::client::{Client, QueryState};
use thermal_client::commissioning::{CommissioningEvent, Surroundings, SurroundingsError};
use thermal_device::StateName;
use thermal_device::safety::ThermistorId;
use thermal_lab::bring_up::{
    AskSurroundings, Bench, BenchError, EmulatedBench, ManualStep, Measurement, Record, Report,
    STAGES, SimulatedBoard, Stage, bring_up,
};
use thermal_lab::link::Link;
use thermal_sim::board::{Board, SOUND};

use super::{brought_up, on_the_bench};

/// A person who does everything that is asked, and ends the procedure in a stage: at its first task, or when the reference
/// thermometer is to be read there.
struct EndsIn<'a> {
    hands: EmulatedBench<'a>,
    stage: &'static str,
    at_the_thermometer: bool,
    is_there: bool,
}

impl<L: AskSurroundings + Link> Bench<L> for EndsIn<'_> {
    fn begin(&mut self, stage: &Stage) {
        self.is_there = stage.name == self.stage;
        Bench::<L>::begin(&mut self.hands, stage);
    }

    fn act(&mut self, client: &mut Client<L>, manual: &ManualStep) -> Result<(), BenchError> {
        if self.is_there && !self.at_the_thermometer {
            return Err(BenchError::Aborted);
        }
        self.hands.act(client, manual)
    }

    fn read(
        &mut self,
        client: &mut Client<L>,
        measurement: &Measurement,
    ) -> Result<f64, BenchError> {
        self.hands.read(client, measurement)
    }

    fn turn(
        &mut self,
        client: &mut Client<L>,
        ohm: (f64, f64),
        tripped: &mut dyn FnMut(&mut Client<L>) -> Result<bool, BenchError>,
    ) -> Result<Option<f64>, BenchError> {
        self.hands.turn(client, ohm, tripped)
    }

    fn record(&mut self, record: &Record) {
        Bench::<L>::record(&mut self.hands, record);
    }
}

impl<L: AskSurroundings + Link> Surroundings<L> for EndsIn<'_> {
    fn reference_c(
        &mut self,
        client: &mut Client<L>,
        thermistor: ThermistorId,
    ) -> Result<f64, SurroundingsError> {
        if self.is_there {
            return Err(SurroundingsError::Interrupted);
        }
        self.hands.reference_c(client, thermistor)
    }

    fn put_into_bath(
        &mut self,
        client: &mut Client<L>,
        thermistor: ThermistorId,
        bath_c: f64,
    ) -> Result<(), SurroundingsError> {
        self.hands.put_into_bath(client, thermistor, bath_c)
    }

    fn reads_again(&mut self, _why: &str) -> bool {
        false
    }

    fn notice(&mut self, event: &CommissioningEvent) {
        Surroundings::<L>::notice(&mut self.hands, event);
    }
}

/// The report of a bring-up that the person ends in a stage, and the state of the device then.
fn ended_in(stage: &'static str, at_the_thermometer: bool) -> (Report, StateName) {
    let board = Board::named(SOUND, None).expect("a board");
    let (mut engine, bench) = on_the_bench(board);
    let mut client = Client::new(SimulatedBoard::new(&mut engine, bench));
    let mut person = EndsIn {
        hands: EmulatedBench { watch: &mut |_| () },
        stage,
        at_the_thermometer,
        is_there: false,
    };
    let report = bring_up(
        &mut client,
        &mut person,
        Report::default(),
        None,
        &mut |_| (),
    );
    let state = client.ask(&QueryState).expect("a state").state;
    (report, state)
}

/// In the stage `run` the thermometer is read while the display is held.
#[test]
fn ending_while_the_display_is_driven_switches_the_bridge_off() {
    let (report, state) = ended_in("run", true);
    assert_eq!(state, StateName::Ready);
    assert!(!report.passed());
    let resume = report.resume.expect("where to resume");
    assert_eq!(resume.stage, "run");
    assert_eq!(resume.reason, "ended by the person");
}

#[test]
fn an_ended_bring_up_goes_on_at_its_stage_and_can_pass() {
    let (mut report, _) = ended_in("load", false);
    assert_eq!(
        report.resume.as_ref().map(|resume| resume.stage.as_str()),
        Some("load")
    );
    assert!(!report.passed());
    let from = STAGES
        .iter()
        .find(|stage| stage.name == "load")
        .expect("a stage");
    report.keep_before(from);
    let before = report.records.len();
    let board = Board::named(SOUND, None).expect("a board");
    let report = brought_up(board, report, Some(from));
    assert!(report.passed(), "{:#?}", report.findings());
    assert!(report.records.len() > before);
}

#[test]
fn stages_that_were_left_out_do_not_pass() {
    let from = STAGES
        .iter()
        .find(|stage| stage.name == "load")
        .expect("a stage");
    let board = Board::named(SOUND, None).expect("a board");
    let report = brought_up(board, Report::default(), Some(from));
    assert_eq!(report.findings(), Vec::<&str>::new());
    assert!(!report.passed());
}
