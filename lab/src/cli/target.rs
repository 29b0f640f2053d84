//! The device that a command is for.

use std::path::PathBuf;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::Duration;

use anyhow::{Context, anyhow};
use clap::Args;
use thermal_client::client::{Client, ClientError, StationRequest};
use thermal_client::link::{Interruptible, Link, LinkError};
use thermal_lab::link::{self, LazyLink, ServedLink, SimulatedLink};
use thermal_plant::Params;
use thermal_sim::World;
use thermal_sim::commissioning::{CommissioningSetup, settings_for_scene};
use thermal_sim::engine::NativeEngine;
use thermal_sim::scene::Scene;
use thermal_window::StopFlag;

use super::{Failure, notice};

/// Room of the simulated device, C, and the seed of its noise, unless a scene says them.
const ROOM_C: f64 = 24.0;
const SEED: u64 = 0;
/// Time after power-up before the first line to the device of a scene.
const START: Duration = Duration::from_millis(10);

// The device: exactly one of the three, for all commands but `ports`.
#[derive(Args)]
#[command(next_help_heading = "Device, one of three")]
pub struct Target {
    /// Serial port of the device; `thermal-lab ports` lists them
    #[arg(long, value_name = "NAME", global = true, conflicts_with_all = ["tcp", "simulated"])]
    pub port: Option<PathBuf>,
    /// Address of a device that is reached by TCP, as `127.0.0.1:4000`
    #[arg(long, value_name = "ADDR", global = true, conflicts_with = "simulated")]
    pub tcp: Option<String>,
    /// A device that is simulated in this program, in virtual time
    #[arg(long, global = true)]
    pub simulated: bool,
    /// Scene whose device is simulated, instead of the nominal one
    #[arg(long, value_name = "FILE", global = true, requires = "simulated")]
    pub scene: Option<PathBuf>,
}

/// A client of whatever device the user chose; Ctrl-C interrupts its waits.
pub type AnyClient<'a> = Client<Interruptible<Box<dyn Link + 'a>>>;

impl Target {
    /// Does something with a client of the device. Ctrl-C interrupts it. The bridge is switched off then, and if the work fails
    /// after it has armed the device, whatever has failed: a refusal, the line, or a full disk.
    pub fn with_client<T>(
        &self,
        work: impl FnOnce(&mut AnyClient<'_>) -> Result<T, Failure>,
    ) -> Result<T, Failure> {
        let mut engine;
        let link: Box<dyn Link + '_> = if self.simulated {
            let world = self.simulated_setup()?.in_use().map_err(Failure::input)?;
            engine = NativeEngine::new(world);
            Box::new(SimulatedLink::new(&mut engine))
        } else {
            self.open().map_err(Failure::input)?
        };
        with_link(link, Client::discard_earlier, work)
    }

    /// As [`with_client`](Self::with_client), with the device that another program serves at `--tcp` with its surroundings at this
    /// address.
    pub fn with_served_client<T>(
        &self,
        surroundings: &str,
        work: impl FnOnce(&mut Client<Interruptible<ServedLink>>) -> Result<T, Failure>,
    ) -> Result<T, Failure> {
        let Some(device) = &self.tcp else {
            return Err(Failure::input(anyhow!(
                "--surroundings is for a device that is served at --tcp ADDR"
            )));
        };
        let link = ServedLink::connect(device, surroundings)
            .with_context(|| format!("--tcp {device} --surroundings {surroundings}"))
            .map_err(Failure::input)?;
        with_link(link, |_| Ok(()), work)
    }

    /// Does something with the simulated device of the scene, which has the scene's settings. `command` is the subcommand that
    /// needs it.
    pub fn with_device_of_scene<T>(
        &self,
        command: &str,
        work: impl FnOnce(&mut Client<SimulatedLink<'_, NativeEngine>>) -> Result<T, Failure>,
    ) -> Result<T, Failure> {
        let path = self.scene.as_ref().ok_or_else(|| {
            Failure::input(anyhow!(
                "{command} --simulated needs --scene FILE, of a device with flux_sensor = true"
            ))
        })?;
        let scene = Scene::read(path).map_err(Failure::input)?;
        let settings = settings_for_scene(&scene).map_err(Failure::run)?;
        let mut engine = NativeEngine::new(World::new(&scene).map_err(Failure::input)?);
        let mut client = Client::new(SimulatedLink::new(&mut engine));
        client.wait(START).map_err(Failure::run)?;
        for line in &settings {
            client.command(line).map_err(Failure::run)?;
        }
        work(&mut client)
    }

    /// Does something with a client of a device that may not be there yet: the line is opened when the first command is
    /// sent. Ctrl-C interrupts it.
    pub fn with_late_client<T>(
        &self,
        work: impl FnOnce(&mut AnyClient<'_>) -> T,
    ) -> Result<T, Failure> {
        if self.port.is_none() && self.tcp.is_none() {
            return Err(Failure::input(which_device()));
        }
        let (requested, _) = interruptions()?;
        let link = LazyLink::new(|| self.open().map_err(|error| format!("{error:#}")));
        let link: Box<dyn Link + '_> = Box::new(link);
        Ok(work(&mut Client::new(Interruptible::new(link, requested))))
    }

    /// Opens the line of `--port` or `--tcp`.
    pub fn open(&self) -> anyhow::Result<Box<dyn Link>> {
        match (&self.port, &self.tcp) {
            (Some(port), _) => {
                let link = link::serial(port);
                let hint = || format!("--port {}: `thermal-lab ports` lists them", port.display());
                Ok(Box::new(link.with_context(hint)?))
            }
            (_, Some(address)) => {
                let link = link::tcp(address.as_str());
                let what = || format!("--tcp {address}");
                Ok(Box::new(link.with_context(what)?))
            }
            (None, None) => Err(which_device()),
        }
    }

    /// Device and surroundings of `--simulated`.
    pub fn simulated_setup(&self) -> Result<CommissioningSetup, Failure> {
        let Some(path) = &self.scene else {
            return Ok(CommissioningSetup::new(&Params::nominal(), ROOM_C, SEED));
        };
        let scene = Scene::read(path).map_err(Failure::input)?;
        Ok(CommissioningSetup::new(&scene.params, scene.room_c, scene.seed))
    }
}

/// Does something with a client of the device at the other end of a link, after its `begin`. Ctrl-C interrupts it. The bridge is switched
/// off then, and if the work fails after it has armed the device.
fn with_link<L: Link, T>(
    link: L,
    begin: impl FnOnce(&mut Client<Interruptible<L>>) -> Result<(), ClientError>,
    work: impl FnOnce(&mut Client<Interruptible<L>>) -> Result<T, Failure>,
) -> Result<T, Failure> {
    let (requested, interrupted) = interruptions()?;
    let mut client = Client::new(Interruptible::new(link, requested));
    let done = begin(&mut client).map_err(Failure::run).and_then(|()| work(&mut client));
    let was_driven = done.is_err() && client.may_be_driven();
    if was_driven || interrupted.load(Ordering::Relaxed) {
        match client.switch_off() {
            Ok(()) => {
                if was_driven {
                    eprintln!("thermal-lab: the bridge is off");
                }
                if client.is_streaming() {
                    // Not before: a device that streams to nobody switches its bridge off by itself. That telemetry goes on harms nobody.
                    let _ignored = client.ask(&StationRequest::stream(0));
                }
            }
            Err(error) if was_driven => notice(&error.not_off().to_string()),
            // The failure of the work is reported, and that of the link with it.
            Err(ClientError::Link(_)) if done.is_err() => {}
            Err(error) if done.is_err() => notice(&error.to_string()),
            Err(error) => return Err(Failure::run(error)),
        }
    }
    done
}

/// Attaches to a device that may be running. Whoever interrupts this wants its bridge off.
pub fn attach<L: Link>(link: L) -> Result<Client<L>, Failure> {
    let mut client = Client::new(link);
    let attached = client.discard_earlier();
    if attached == Err(ClientError::Link(LinkError::Interrupted)) {
        client.switch_off().map_err(Failure::run)?;
    }
    attached.map_err(Failure::run)?;
    Ok(client)
}

fn which_device() -> anyhow::Error {
    anyhow!("which device? --port NAME (`thermal-lab ports` lists them), --tcp ADDR or --simulated")
}

/// Lets Ctrl-C and the signals that end a program press a stop, and close the windows.
pub fn stop_on_signals(stop: &StopFlag) -> Result<(), Failure> {
    let stop = stop.clone();
    ctrlc::set_handler(move || stop.press_and_close())
        .context("Ctrl-C cannot be caught")
        .map_err(Failure::run)
}

/// Two flags that Ctrl-C and the signals that end a program set: one that the link takes back when it ends a wait, and one
/// that stays.
fn interruptions() -> Result<(Arc<AtomicBool>, Arc<AtomicBool>), Failure> {
    let flags = <(Arc<AtomicBool>, Arc<AtomicBool>)>::default();
    let set = flags.clone();
    ctrlc::set_handler(move || {
        set.0.store(true, Ordering::Relaxed);
        set.1.store(true, Ordering::Relaxed);
    })
    .context("Ctrl-C cannot be caught")
    .map_err(Failure::run)?;
    Ok(flags)
}
