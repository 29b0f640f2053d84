use std::string::String;
use std::{format, vec};

use contact_model::fixed_point::Celsius;

use super::*;
use crate::stimulus::Hold;

/// The table in the documentation is the one that the code has.
#[test]
fn the_documented_transitions_are_those_of_the_code() {
    let fault = Fault::Dose;
    let hold = Hold::at(Celsius::lit("30"));
    let states = [
        State::Off,
        State::SelfTest(SelfTest::default()),
        State::Ready,
        State::Armed(ArmedTask::Neutral),
        State::Preset,
        State::Contact,
        State::Stimulus(Stimulus::Hold(hold)),
        State::Tripped(fault),
    ];
    let events = [
        ("`arm`", Event::Arm),
        ("self-test passes", Event::Pass),
        ("`start`", Event::Start),
        ("`hold`, `play`", Event::Stimulate(&Stimulus::Hold(hold))),
        ("course ends on neutral", Event::EndNeutral),
        ("finger lands", Event::Land),
        ("finger lifts", Event::Lift),
        ("`abort`", Event::Abort),
        ("`clear`", Event::Clear),
        ("fault", Event::Trip(fault)),
    ];
    let mut table = String::from("| state |");
    for (event, _) in events {
        table += &format!(" {event} |");
    }
    table += &format!("\n|{}\n", vec!["---|"; 1 + events.len()].concat());
    for state in states {
        table += &format!("| `{}` |", state.state_name().name());
        for (_, event) in events {
            match state.state_after(event) {
                Some(next) => table += &format!(" `{}` |", next.state_name().name()),
                None => table += " |",
            }
        }
        table += "\n";
    }
    let documentation = include_str!("../../../../../docs/safety.md");
    assert!(documentation.contains(&table), "docs/safety.md lacks\n{table}");
}
