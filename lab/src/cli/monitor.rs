//! `thermal-lab monitor`: a device at a glance.

use std::io::{BufReader, stderr, stdin};

use clap::Args;
use thermal_client::link::{Interruptible, Link};
use thermal_lab::bench_operator::lines;
use thermal_lab::link::PacedLink;
use thermal_lab::terminal_people::TerminalPeople;
use thermal_sim::engine::NativeEngine;
use thermal_sim::simulated_link::SimulatedLink;
use thermal_window::{MonitorPeople, StopFlag, monitor};

use super::target::{attach, stop_on_signals};
use super::{Failure, Target, window};

#[derive(Args)]
pub struct Arguments {
    /// Interval of the telemetry, ms
    #[arg(long, value_name = "MS", default_value_t = 10, value_parser = clap::value_parser!(u32).range(5..=1000))]
    interval: u32,
    /// Without a window: plain lines at a terminal
    #[arg(long)]
    headless: bool,
}

pub fn run(target: &Target, arguments: &Arguments) -> Result<(), Failure> {
    let stop = StopFlag::default();
    stop_on_signals(&stop)?;
    if arguments.headless {
        let mut screen = stderr();
        let input = lines(BufReader::new(stdin()));
        let mut people = TerminalPeople::of_monitor(input, &mut screen, stop.clone());
        return watch(target, arguments, &stop, &mut people);
    }
    window::show("Monitor", None, &stop, |people| watch(target, arguments, &stop, people))
}

fn watch(
    target: &Target,
    arguments: &Arguments,
    stop: &StopFlag,
    people: &mut impl MonitorPeople,
) -> Result<(), Failure> {
    let mut engine;
    let link: Box<dyn Link + '_> = if target.simulated {
        let world = target.simulated_setup()?.in_use().map_err(Failure::input)?;
        engine = NativeEngine::new(world);
        Box::new(PacedLink::new(SimulatedLink::new(&mut engine)))
    } else {
        target.open().map_err(Failure::input)?
    };
    let link = Interruptible::new(link, stop.interrupts_link());
    let mut client = attach(link)?;
    monitor(&mut client, people, arguments.interval).map_err(Failure::run)
}
