//! The worker of `monitor` with a scripted line.

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
}

impl Link for ScriptedLink {
    fn send(&mut self, bytes: &[u8]) -> Result<(), LinkError> {
        for line in std::str::from_utf8(bytes).unwrap().lines().filter(|line| !line.is_empty()) {
            self.sent.push(line.into());
            let answer = match line {
                "id" => "ok thermal-display 0.2.0 fingers=1 tick_hz=1000 scan_hz=16000 protocol=2 capabilities=course".into(),
                "abort" if !self.answers_abort => continue,
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
            return line(format!("T {tick} armed 30 30 27 33 24 0 0 0 - -"), self.now);
        }
        self.now += timeout;
        Ok(None)
    }

    fn now(&self) -> Duration {
        self.now
    }
}

/// An operator with orders, who closes the window after the last.
struct Operator {
    orders: VecDeque<Order>,
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
        self.orders.is_empty()
    }
}

fn watch(link: ScriptedLink, orders: &[Order]) -> (Result<(), ClientError>, Vec<String>, Operator) {
    let mut operator =
        Operator { orders: orders.iter().copied().collect(), lines: 0, notices: Vec::new() };
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
        ["id", "events on", "stream 10", "clear", "arm", "abort", "abort", "stream 0"]
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
fn a_pulled_cable_is_reported() {
    let link = ScriptedLink { ends_after: Some(4), ..ScriptedLink::default() };
    let (done, ..) = watch(link, &[Order::Arm, Order::Arm]);
    assert!(matches!(done, Err(ClientError::Link(LinkError::Gone(_)))), "{done:?}");
}
