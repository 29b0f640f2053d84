//! The worker of `monitor`: telemetry of a device, and the few orders that are safe at any time.

use std::time::Duration;

use thermal_client::client::{
    AvailableFields, Client, ClientError, QueryIdentity, ReceivedEvent, StationRequest,
};
use thermal_client::link::{Link, LinkError};
use thermal_session::{People, Update};

use crate::silence::Silence;

/// Longest wait for telemetry, after which orders are looked at.
const POLL_INTERVAL: Duration = Duration::from_millis(20);
/// What is said when the device has confirmed that.
const BRIDGE_OFF: &str = "bridge off";

/// What the operator of a monitored device can order.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Order {
    /// Bridge off.
    Off,
    /// Self-test if it has not been passed, then the display at the temperature of the skin.
    Arm,
    /// Clear a fault that is no longer present.
    Clear,
}

impl Order {
    /// Those with a key of their own; the stop has another.
    pub const ALL: [Self; 2] = [Self::Arm, Self::Clear];

    /// Its key, a letter in lower case.
    pub const fn key(self) -> char {
        match self {
            Self::Off => 'o',
            Self::Arm => 'a',
            Self::Clear => 'c',
        }
    }

    /// Its word on the line and on its button.
    pub const fn word(self) -> &'static str {
        match self {
            Self::Off => "abort",
            Self::Arm => "arm",
            Self::Clear => "clear",
        }
    }
}

/// Whoever watches a device.
pub trait MonitorPeople: People {
    /// The order since the last call, if there is one.
    fn order(&mut self) -> Option<Order>;

    /// Whether the monitor is to end.
    fn is_closing(&self) -> bool;
}

/// Streams telemetry and carries out orders until the operator ends it; then the bridge is off. The link's signs of life are
/// those of the client.
///
/// # Errors
/// The link is gone, the device does not answer at the start, or it has not confirmed at the end that its bridge is off.
pub fn monitor<L: Link>(
    client: &mut Client<L>,
    people: &mut impl MonitorPeople,
    interval_ms: u32,
) -> Result<(), ClientError> {
    let watched = watch(client, people, interval_ms);
    // Also after a failure: the bridge may be driven.
    let off = client.switch_off();
    if off.is_ok() {
        people.inform(&Update::Notice(BRIDGE_OFF.into()));
    }
    match (watched, off) {
        // Whoever closes the window interrupts the wait, too.
        (Ok(()) | Err(ClientError::Link(LinkError::Interrupted)), off) => {
            // Only after a confirmed `abort`: a device that streams to nobody switches its bridge off by itself.
            off?;
            client.ask(&StationRequest::stream(0))
        }
        // Nothing is more important than a bridge that may be on.
        (_, Err(not_off @ ClientError::NotOff { .. })) => Err(not_off),
        (_, Err(gone)) if client.may_be_driven() => Err(gone.not_off()),
        (failed, _) => failed,
    }
}

fn watch<L: Link>(
    client: &mut Client<L>,
    people: &mut impl MonitorPeople,
    interval_ms: u32,
) -> Result<(), ClientError> {
    let identity = client.ask(&QueryIdentity)?;
    people.inform(&Update::Notice(format!(
        "connected: {} {}, {} finger(s)",
        identity.name, identity.version, identity.fingers
    )));
    match client.ask(&StationRequest::events(true)) {
        Ok(()) => {}
        // Firmware from before there were events.
        Err(error) if error.refusal().is_some() => {}
        Err(error) => return Err(error),
    }
    let fields = AvailableFields::of(&identity, false);
    client.ask(&fields.stream(interval_ms))?;
    let mut silence = Silence::new(interval_ms, client);
    while !people.is_closing() {
        let notice = match client.next_telemetry(POLL_INTERVAL) {
            Ok(Some(line)) => {
                people.inform(&Update::Telemetry(line));
                silence.ends(client)
            }
            // Whoever interrupts the wait has an order.
            Ok(None) | Err(LinkError::Interrupted) => silence.lasts(client),
            Err(error) => return Err(error.into()),
        };
        if let Some(notice) = notice {
            people.inform(&Update::Notice(notice));
        }
        while let Some(event) = client.take_event() {
            people.inform(&Update::Event(event));
            people.inform(&Update::Notice(event_text(&event)));
        }
        // Whoever closes the monitor gets the bridge switched off at its end.
        if let Some(order) = people.order().filter(|_| !people.is_closing()) {
            let text = carry_out(client, order)?;
            people.inform(&Update::Notice(text));
        }
    }
    Ok(())
}

fn event_text(received: &ReceivedEvent) -> String {
    let finger = received.finger.map_or(String::new(), |finger| format!("finger {finger}: "));
    format!("{finger}{} at tick {}", received.event.kind.name(), received.event.tick)
}

/// Carries an order out, and says what the device answered. A refusal is no error.
fn carry_out<L: Link>(client: &mut Client<L>, order: Order) -> Result<String, ClientError> {
    let (done, text) = match order {
        Order::Off => (client.switch_off(), BRIDGE_OFF.into()),
        Order::Arm => (client.ask(&StationRequest::Arm), format!("`{}`: ok", order.word())),
        Order::Clear => (client.ask(&StationRequest::Clear), format!("`{}`: ok", order.word())),
    };
    match done {
        Ok(()) => Ok(text),
        Err(ClientError::Link(error @ LinkError::Gone(_))) => Err(error.into()),
        Err(error) => Ok(error.to_string()),
    }
}
