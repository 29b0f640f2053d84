//! `thermal-lab ports`: the serial ports of this computer.

use anyhow::Context;
use clap::Args;
use serde_json::json;
use thermal_lab::link::{PortInfo, ports};

use super::{Failure, print};

#[derive(Args)]
pub struct Arguments {
    /// Print one JSON array of objects: name, usb with vendor and product, st_link
    #[arg(long)]
    json: bool,
}

pub fn run(arguments: &Arguments) -> Result<(), Failure> {
    let ports = ports().context("serial ports").map_err(Failure::run)?;
    let is_probe = |port: &PortInfo| port.usb.is_some_and(|usb| usb.is_st_link());
    if arguments.json {
        let all: Vec<_> = (ports.iter())
            .map(|port| json!({ "name": port.name, "usb": port.usb, "st_link": is_probe(port) }))
            .collect();
        return print(&serde_json::Value::from(all).to_string());
    }
    if ports.is_empty() {
        return print("no serial ports; is the board's USB cable plugged in?");
    }
    for port in &ports {
        let usb = port
            .usb
            .map_or(String::new(), |usb| format!("  USB {:04x}:{:04x}", usb.vendor, usb.product));
        let probe = if is_probe(port) { "  ST-LINK: probably the device" } else { "" };
        print(&format!("{}{usb}{probe}", port.name.display()))?;
    }
    Ok(())
}
