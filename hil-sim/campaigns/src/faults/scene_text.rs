//! Writes faults and host lines as text of a scene.

use std::fmt::Write;

use thermal_sim::processor::MachineFault;
use thermal_sim::scene::FaultKind;

use super::InjectedFault;

/// Duration of a silence of the host, s.
const SILENT_S: f64 = 6.0;

/// The table of a fault at a time, s. The scene's seed draws the noise in the RAM.
pub(super) fn fault_text(fault: &InjectedFault, t_s: f64) -> String {
    let mut text = match fault {
        InjectedFault::HostLine(lines) => {
            return host_lines(lines).map(|line| host_line(line, t_s)).collect();
        }
        _ => format!("[[fault]]\nkind = \"{}\"\nt_s = {t_s:?}\n", fault.kind()),
    };
    // Writing to a String cannot fail.
    let _ = match fault {
        InjectedFault::Hardware(broken) => {
            if broken.kind == FaultKind::HostSilent {
                text += &format!("until_s = {:?}\n", t_s + SILENT_S);
            }
            if broken.kind.has_sensor() {
                text += &format!("sensor = \"{}\"\n", broken.sensor.name());
            }
            if broken.kind.needs_second_sensor() {
                text += &format!("with = \"{}\"\n", broken.with.name());
            }
            match broken.kind.value() {
                Some(_) => writeln!(text, "value = {:?}", broken.value),
                None => Ok(()),
            }
        }
        InjectedFault::Processor(
            MachineFault::RamBit { address, bit } | MachineFault::RegisterBit { address, bit },
        ) => {
            writeln!(text, "address = {address:#x}\nbit = {bit}")
        }
        InjectedFault::Processor(MachineFault::CoreBit { register, bit }) => {
            writeln!(text, "register = \"{register}\"\nbit = {bit}")
        }
        InjectedFault::Processor(MachineFault::DmaStopped { controller, stream }) => {
            writeln!(text, "controller = {controller}\nstream = {stream}")
        }
        InjectedFault::Processor(MachineFault::SelectLineStuck { line, level }) => {
            writeln!(text, "line = {line}\nlevel = {level}")
        }
        InjectedFault::Processor(MachineFault::SelectLineOpen { line }) => {
            writeln!(text, "line = {line}")
        }
        InjectedFault::Processor(_) | InjectedFault::HostLine(_) => Ok(()),
    };
    text
}

/// The lines of a fault, which are sent one after the other.
pub(super) fn host_lines(lines: &str) -> impl Iterator<Item = &str> {
    lines.split("; ")
}

/// A line of the host.
pub(super) fn host_line(line: &str, t_s: f64) -> String {
    format!("[[host]]\nt_s = {t_s:?}\nline = \"{line}\"\n")
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::faults::{DrawnDevice, FaultScene, InjectionPoint, fault_cases};
    use thermal_sim::scene::Scene;

    #[test]
    fn every_fault_of_the_list_is_read_back_from_its_scene() {
        for fault_case in fault_cases() {
            let point = InjectionPoint { scene: FaultScene::Slew, t_s: 1.25 };
            let text = crate::faults::fault_run::scene_text(
                &[(fault_case.fault, 1.25)],
                point,
                fault_case.after_s,
                (&DrawnDevice::nominal(7), &fault_case.touch(7)),
            );
            let scene = Scene::parse(&text, "slew".as_ref())
                .unwrap_or_else(|error| panic!("{error}\n{text}"));
            match fault_case.fault {
                InjectedFault::Hardware(broken) => {
                    let fault = scene.faults.last().expect("a fault");
                    assert_eq!((fault.fault.kind, fault.t_s), (broken.kind, 1.25), "{text}");
                    assert_eq!(fault.fault.value, broken.value, "{text}");
                    if broken.kind.has_sensor() {
                        assert_eq!(fault.fault.sensor, broken.sensor, "{text}");
                    }
                    if broken.kind.needs_second_sensor() {
                        assert_eq!(fault.fault.with, broken.with, "{text}");
                    }
                }
                InjectedFault::Processor(fault) => {
                    let injection = scene.injections.last().expect("an injection");
                    let drawn = MachineFault::PowerCycle { seed: 7 };
                    let same = injection.fault == fault || injection.fault == drawn;
                    assert!(same && injection.t_s == 1.25, "{text}");
                }
                InjectedFault::HostLine(lines) => {
                    let sent = scene.host.iter().filter(|host| host.t_s == 1.25);
                    let sent: Vec<_> = sent.map(|host| host.line.as_str()).collect();
                    assert_eq!(sent, host_lines(lines).collect::<Vec<_>>(), "{text}");
                }
            }
        }
    }
}
