//! A person who types everything: the whole procedure at a terminal.

use std::cell::RefCell;
use std::io::{self, Write};
use std::rc::Rc;
use std::sync::mpsc::{self, Sender};

use thermal_client::client::{Client, QueryState};
use thermal_client::commissioning::{CommissioningEvent, Surroundings, SurroundingsError};
use thermal_device::StateName;
use thermal_device::safety::ThermistorId;
use thermal_lab::bench_operator::BenchOperator;
use thermal_lab::bring_up::{
    Bench, BenchError, EmulatedBench, ManualStep, Measurement, Record, Report, SimulatedBoard,
    Stage, Terminal, bring_up,
};
use thermal_lab::link::{AskSurroundings, Link};
use thermal_sim::board::{Board, SOUND};

use super::on_the_bench;

/// A screen whose reader types an answer to each question, which ends with a colon.
struct Screen {
    answer: Rc<RefCell<String>>,
    keys: Sender<io::Result<String>>,
    shown: Rc<RefCell<String>>,
}

impl Write for Screen {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        let text = String::from_utf8_lossy(bytes);
        self.shown.borrow_mut().push_str(&text);
        if text.ends_with(": ") {
            let answer = self.answer.borrow().clone();
            self.shown.borrow_mut().push_str(&format!("{answer}\n"));
            self.keys.send(Ok(answer)).map_err(io::Error::other)?;
        }
        Ok(bytes.len())
    }

    fn flush(&mut self) -> io::Result<()> {
        Ok(())
    }
}

/// Where a person ends a bring-up.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum End {
    /// At the first task of this stage.
    Task(&'static str),
    /// When the reference thermometer is to be read in this stage.
    Thermometer(&'static str),
}

/// Hands that do what the terminal says, and type what the instruments show.
struct Typist<'a> {
    terminal: Terminal<'a>,
    hands: EmulatedBench<'a>,
    answer: Rc<RefCell<String>>,
    stage: &'static str,
    end: Option<End>,
}

impl Typist<'_> {
    fn type_next(&self, text: impl ToString) {
        *self.answer.borrow_mut() = text.to_string();
    }

    /// Types this, or ends the bring-up if it shall end here.
    fn type_or_end(&self, here: End, text: impl ToString) {
        if self.end == Some(here) {
            self.type_next("abort");
        } else {
            self.type_next(text);
        }
    }
}

impl<L: AskSurroundings + Link> Bench<L> for Typist<'_> {
    fn begin(&mut self, stage: &Stage) {
        self.stage = stage.name;
        Bench::<L>::begin(&mut self.terminal, stage);
    }

    fn act(&mut self, client: &mut Client<L>, manual: &ManualStep) -> Result<(), BenchError> {
        self.hands.act(client, manual)?;
        self.type_or_end(End::Task(self.stage), "");
        self.terminal.act(client, manual)
    }

    fn read(
        &mut self,
        client: &mut Client<L>,
        measurement: &Measurement,
    ) -> Result<f64, BenchError> {
        let value = self.hands.read(client, measurement)?;
        self.type_next(value);
        self.terminal.read(client, measurement)
    }

    fn turn(
        &mut self,
        client: &mut Client<L>,
        ohm: (f64, f64),
        tripped: &mut dyn FnMut(&mut Client<L>) -> Result<bool, BenchError>,
    ) -> Result<Option<f64>, BenchError> {
        let at_ohm = self.hands.turn(client, ohm, tripped)?;
        let typed = at_ohm.map_or_else(String::new, |ohm| ohm.to_string());
        // The first question is whether the resistor is set, the second one what it is.
        self.type_next("");
        let answer = Rc::clone(&self.answer);
        self.terminal.turn(client, ohm, &mut |client| {
            answer.borrow_mut().clone_from(&typed);
            tripped(client)
        })
    }

    fn record(&mut self, record: &Record) {
        Bench::<L>::record(&mut self.terminal, record);
    }
}

impl<L: AskSurroundings + Link> Surroundings<L> for Typist<'_> {
    fn reference_c(
        &mut self,
        client: &mut Client<L>,
        thermistor: ThermistorId,
    ) -> Result<f64, SurroundingsError> {
        let shown_c = self.hands.reference_c(client, thermistor)?;
        self.type_or_end(End::Thermometer(self.stage), format!("{shown_c:.3}"));
        self.terminal.reference_c(client, thermistor)
    }

    fn put_into_bath(
        &mut self,
        client: &mut Client<L>,
        thermistor: ThermistorId,
        bath_c: f64,
    ) -> Result<(), SurroundingsError> {
        self.hands.put_into_bath(client, thermistor, bath_c)?;
        self.type_next("");
        self.terminal.put_into_bath(client, thermistor, bath_c)
    }

    fn reads_again(&mut self, why: &str) -> bool {
        Surroundings::<L>::reads_again(&mut self.terminal, why)
    }

    fn notice(&mut self, event: &CommissioningEvent) {
        Surroundings::<L>::notice(&mut self.terminal, event);
    }
}

/// What a bring-up by a typing person has left.
pub struct Typed {
    pub report: Report,
    pub state: StateName,
    /// What the terminal has shown.
    shown: String,
}

/// A bring-up of a sound board by a person who types everything, to its end or where the person ends it.
pub fn typed(end: Option<End>) -> Typed {
    let (keys, lines) = mpsc::channel();
    let (answer, shown) = <(Rc<RefCell<String>>, Rc<RefCell<String>>)>::default();
    let mut screen = Screen { answer: Rc::clone(&answer), keys, shown: Rc::clone(&shown) };
    let mut typist = Typist {
        terminal: Terminal::new(BenchOperator::new(None, lines, &mut screen)),
        hands: EmulatedBench { watch: &mut |_| () },
        answer,
        stage: "",
        end,
    };
    let board = Board::named(SOUND, None).expect("a board");
    let (mut engine, bench) = on_the_bench(board);
    let mut client = Client::new(SimulatedBoard::new(&mut engine, bench));
    let report = Report::default();
    let report = bring_up(&mut client, &mut typist, report, None, &mut |_| ());
    let shown = shown.borrow().clone();
    Typed {
        report: report.expect("the same device"),
        state: client.ask(&QueryState).expect("a state").state,
        shown,
    }
}

#[test]
fn a_person_who_types_every_value_comes_to_a_pass() {
    let Typed { report, shown, .. } = typed(None);
    assert!(report.passed(), "{:#?}\n{shown}", report.findings());
    for part in [
        "== Bare board: continuity, pull-downs, short circuits (bare-board) ==",
        "bridge enable, PB10 (D6): ohm meter from the point to analog ground",
        "Stop: the comparator has tripped.",
        "Press the emergency stop now, while the display is driven.",
    ] {
        assert!(shown.contains(part), "{part}");
    }
}
