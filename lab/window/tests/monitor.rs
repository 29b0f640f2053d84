//! The worker of `monitor` with a scripted line.

use std::cell::Cell;
use std::collections::VecDeque;
use std::time::Duration;

use thermal_client::client::{Client, ClientError};
use thermal_client::link::{Link, LinkError, ReceivedLine};
use thermal_session::{Decision, People, Response, Update};
use thermal_window::{MonitorPeople, Order, monitor};

/// A device that says ok to everything and streams.
#[derive(Default)]
struct ScriptedLink {
    sent: Vec<String>,
    answers: VecDeque<String>,
    now: Duration,
    streams: bool,
    /// Number of lines after which the cable is pulled.
    ends_after: Option<usize>,
    answers_abort: bool,
    /// It accepts `abort` and goes on.
    ignores_abort: bool,
    /// Time, ms, after which it sends telemetry that is not understood.
    is_garbled_after: Option<u128>,
}

impl Link for ScriptedLink {
    fn send(&mut self, bytes: &[u8]) -> Result<(), LinkError> {
        for line in std::str::from_utf8(bytes).unwrap().lines().filter(|line| !line.is_empty()) {
            self.sent.push(line.into());
            let answer = match line {
                "id" => "ok thermal-display 0.2.0 fingers=1 tick_hz=1000 scan_hz=16000 protocol=2 capabilities=course".into(),
                "abort" if !self.answers_abort => continue,
                "state" => {
                    let state = if self.ignores_abort { "armed" } else { "off" };
                    format!(
                        "ok state={state} fault=- material=- object_c=room mode=contact setpoint_c=- body=half-space"
                    )
                }
                line if line.starts_with("synchronize") => format!("err unknown '{line}'"),
                line => {
                    self.streams |= line.starts_with("stream ");
                    "ok".into()
                }
            };
            self.answers.push_back(answer);
        }
        Ok(())
    }

    fn receive(&mut self, timeout: Duration) -> Result<Option<ReceivedLine>, LinkError> {
        if self.ends_after.is_some_and(|lines| self.sent.len() >= lines) {
            return Err(LinkError::Gone("cable".into()));
        }
        let line = |text, at| Ok(Some(ReceivedLine { text, at }));
        if let Some(answer) = self.answers.pop_front() {
            return line(answer, self.now);
        }
        if self.streams && timeout >= Duration::from_millis(10) {
            self.now += Duration::from_millis(10);
            let tick = self.now.as_millis();
            let state = if self.is_garbled_after.is_some_and(|after_ms| tick > after_ms) {
                "unknown"
            } else {
                "armed"
            };
            return line(format!("T {tick} {state} 30 30 27 33 24 0 0 0 - -"), self.now);
        }
        self.now += timeout;
        Ok(None)
    }

    fn now(&self) -> Duration {
        self.now
    }
}

/// An operator with orders, who looks on for some time after the last and then closes the window.
#[derive(Default)]
struct Operator {
    orders: VecDeque<Order>,
    looks: Cell<u32>,
    lines: u32,
    notices: Vec<String>,
}

impl People for Operator {
    fn inform(&mut self, update: &Update) {
        match update {
            Update::Telemetry(_) => self.lines += 1,
            Update::Notice(text) => self.notices.push(text.clone()),
            _ => {}
        }
    }

    fn response(&mut self) -> Option<Response> {
        None
    }

    fn decision(&mut self) -> Option<Decision> {
        None
    }
}

impl MonitorPeople for Operator {
    fn order(&mut self) -> Option<Order> {
        self.orders.pop_front()
    }

    fn is_closing(&self) -> bool {
        let looks = self.looks.get();
        self.looks.set(looks.saturating_sub(1));
        self.orders.is_empty() && looks == 0
    }
}

fn watch(link: ScriptedLink, orders: &[Order]) -> (Result<(), ClientError>, Vec<String>, Operator) {
    // The monitor asks twice for each order whether it is being closed; so it is closed once all are carried out.
    let looks = Cell::new(2 * orders.len() as u32);
    let orders = orders.iter().copied().collect();
    let mut operator = Operator { orders, looks, ..Operator::default() };
    let mut client = Client::new(link);
    let done = monitor(&mut client, &mut operator, 10);
    (done, client.into_link().sent, operator)
}

#[test]
fn orders_are_sent_and_the_bridge_is_off_at_the_end() {
    let link = ScriptedLink { answers_abort: true, ..ScriptedLink::default() };
    let (done, sent, operator) = watch(link, &[Order::Clear, Order::Arm, Order::Off]);
    done.unwrap();
    let orders: Vec<_> = sent.iter().map(String::as_str).collect();
    assert_eq!(
        orders,
        [
            "id",
            "events on",
            "stream 10",
            "clear",
            "arm",
            "abort",
            "id",
            "state",
            "abort",
            "id",
            "state",
            "stream 0"
        ]
    );
    assert!(operator.lines >= 3);
    assert!(operator.notices.contains(&"bridge off".to_owned()));
}

#[test]
fn an_abort_that_is_not_confirmed_is_repeated_and_then_said() {
    let (_, sent, operator) = watch(ScriptedLink::default(), &[Order::Off]);
    assert!(sent.iter().filter(|line| *line == "abort").count() >= 3, "{sent:?}");
    assert!(operator.notices[1].contains("PRESS THE EMERGENCY STOP"), "{:?}", operator.notices);
}

#[test]
fn the_monitor_fails_if_the_device_goes_on_after_an_abort() {
    for link in [
        ScriptedLink::default(),
        ScriptedLink { answers_abort: true, ignores_abort: true, ..ScriptedLink::default() },
    ] {
        let ignores = link.ignores_abort;
        let (done, _, operator) = watch(link, &[Order::Arm]);
        let Err(ClientError::NotOff { why }) = done else {
            panic!("{done:?}");
        };
        assert!(
            why.contains(if ignores { "is in state armed" } else { "does not answer" }),
            "{why}"
        );
        assert!(!operator.notices.contains(&"bridge off".to_owned()), "{:?}", operator.notices);
    }
}

#[test]
fn telemetry_that_stays_out_or_is_not_understood_is_said_once() {
    let link = ScriptedLink {
        answers_abort: true,
        is_garbled_after: Some(100),
        ..ScriptedLink::default()
    };
    let mut operator = Operator { looks: Cell::new(100), ..Operator::default() };
    let mut client = Client::new(link);
    monitor(&mut client, &mut operator, 10).unwrap();
    let said = |text: &str| operator.notices.iter().filter(|notice| notice.contains(text)).count();
    assert_eq!(said("no telemetry for 0.5 s"), 1, "{:?}", operator.notices);
}

/// The device may be driven, and nobody can ask it.
#[test]
fn a_cable_pulled_from_an_armed_device_is_reported_with_its_bridge() {
    let link = ScriptedLink { ends_after: Some(4), ..ScriptedLink::default() };
    let (done, ..) = watch(link, &[Order::Arm, Order::Arm]);
    let Err(ClientError::NotOff { why }) = done else {
        panic!("{done:?}");
    };
    assert!(why.contains("cable"), "{why}");
}
