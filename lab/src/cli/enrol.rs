//! `thermal-lab enrol`: a person's finger is learnt and stored by a code.

use std::fs;
use std::io::stderr;
use std::path::{Path, PathBuf};
use std::time::{SystemTime, UNIX_EPOCH};

use anyhow::{Context, anyhow};
use clap::Args;
use serde::{Deserialize, Serialize};
use thermal_client::client::{Client, PersonData, PersonRequest, QueryBoard, QueryDisplaySurface};
use thermal_client::link::Link;
use thermal_client::text;
use thermal_lab::enrolment::{EnrolmentOptions, Step, enrol};
use thermal_lab::step_screen::StepScreen;
use thermal_settings::{Person, PersonCode};

use super::{Failure, KeptFiles, Target, print_text};

/// Force of a simulated finger, N.
const SIMULATED_N: f64 = 2.0;

#[derive(Args)]
pub struct Arguments {
    /// Code of the person, 1 to 8 of A to Z and 0 to 9; no name
    #[arg(value_parser = code)]
    code: PersonCode,
    /// Materials to touch, two or more, the one that takes the least heat first
    #[arg(long, value_name = "NAME,NAME", value_delimiter = ',', default_values = ["abs", "copper"])]
    objects: Vec<String>,
    /// Take the zero of the heat-flux sensor before, with the display at the room's temperature
    #[arg(long)]
    zero: bool,
    /// File to write [default: person-CODE.toml]
    #[arg(long, value_name = "FILE")]
    out: Option<PathBuf>,
    /// Store the person of such a file in the device and choose it, in place of an enrolment
    #[arg(long, value_name = "FILE", conflicts_with_all = ["objects", "zero", "out"])]
    restore: Option<PathBuf>,
    /// Forget the person, in place of an enrolment; the file stays
    #[arg(long, conflicts_with_all = ["objects", "zero", "out", "restore"])]
    forget: bool,
    /// Finger of a device with several
    #[arg(long, value_name = "N")]
    finger: Option<u8>,
    #[command(flatten)]
    kept: KeptFiles,
}

impl Arguments {
    /// The file that is written.
    fn file(&self) -> PathBuf {
        self.out.clone().unwrap_or_else(|| format!("person-{}.toml", self.code).into())
    }
}

pub fn code(text: &str) -> Result<PersonCode, String> {
    PersonCode::new(text).ok_or_else(|| "allowed are 1 to 8 of A to Z and 0 to 9".into())
}

/// What is kept on the host.
#[derive(Serialize, Deserialize)]
struct PersonFile {
    code: String,
    /// What was learnt of the finger, as on the line `person CODE DATA`.
    data: String,
    /// When, s since 1970.
    enrolled_unix_s: u64,
    /// Identifier of the device's microcontroller, if it reports one.
    #[serde(default)]
    device: Option<String>,
    #[serde(default)]
    objects: Vec<String>,
    /// Surface of the display that was set, as on the line `surface set`: the factor on the contact resistance was
    /// learnt with it.
    #[serde(default)]
    display_surface: Option<String>,
}

pub fn run(target: &Target, arguments: &Arguments) -> Result<(), Failure> {
    if !arguments.forget && arguments.restore.is_none() {
        if arguments.objects.len() < 2 {
            let problem =
                anyhow!("--objects has {}; two or more are needed", arguments.objects.len());
            return Err(Failure::input(problem));
        }
        arguments.kept.check(&arguments.file())?;
    }
    let mut out = stderr();
    let mut screen = StepScreen::new(&mut out);
    if target.simulated {
        // The simulated finger does what is asked.
        return target.with_device_of_scene("enrol", |client| {
            at_device(client, arguments, &mut |client, step| {
                screen.show(step);
                let force_n = match step {
                    Step::Rest(_) => 0.0,
                    Step::Touch(_) | Step::Press(..) => SIMULATED_N,
                };
                let world = client.link().world();
                world.set_force_and_faults(force_n, std::iter::empty());
            })
        });
    }
    target.with_client(|client| at_device(client, arguments, &mut |_, step| screen.show(step)))
}

fn at_device<L: Link>(
    client: &mut Client<L>,
    arguments: &Arguments,
    guide: &mut dyn FnMut(&mut Client<L>, &Step),
) -> Result<(), Failure> {
    let (code, finger) = (arguments.code, arguments.finger);
    if arguments.forget {
        let forget = PersonRequest::Forget { code };
        return client.ask(&forget).map_err(Failure::run);
    }
    if let Some(file) = &arguments.restore {
        let person = read(file, code).map_err(Failure::input)?;
        let commands = [
            (None, PersonRequest::store(&person)),
            (finger, PersonRequest::Person { code, data: None }),
        ];
        for (finger, command) in commands {
            client.ask_finger(finger, &command).map_err(Failure::run)?;
        }
        return Ok(());
    }
    let options = EnrolmentOptions {
        code,
        finger,
        takes_zero: arguments.zero,
        objects: arguments.objects.clone(),
    };
    let report = enrol(client, &options, guide).map_err(Failure::run)?;
    let person = report.person().filter(|person| person.code == code);
    let person =
        person.ok_or_else(|| Failure::run(anyhow!("the device has enrolled somebody else")))?;
    let since_1970 = SystemTime::now().duration_since(UNIX_EPOCH);
    let board = client.ask(&QueryBoard).ok();
    let surface = client.ask_finger(finger, &QueryDisplaySurface);
    let surface = *surface.map_err(Failure::run)?.surface.surface();
    let file = PersonFile {
        code: code.to_string(),
        data: PersonData(person.finger).to_string(),
        enrolled_unix_s: since_1970.map_or(0, |time| time.as_secs()),
        device: board.and_then(|board| board.uid),
        objects: options.objects,
        display_surface: Some(format!(
            "{} {} {}",
            surface.conductivity_w_mk, surface.roughness_um, surface.slope_rad
        )),
    };
    let path = arguments.file();
    let text = toml::to_string(&file).map_err(Failure::run)?;
    fs::write(&path, text)
        .with_context(|| format!("--out {}", path.display()))
        .map_err(Failure::run)?;
    print_text(&format!(
        "{code} is enrolled from {} contacts, in {}; `save` keeps it in the device, `person {code}` chooses it\n",
        report.contacts,
        path.display()
    ))
}

/// The person of a file, which must be this one.
fn read(path: &Path, code: PersonCode) -> anyhow::Result<Person> {
    let context = || format!("--restore {}", path.display());
    let text = text::read(path, text::DOCUMENT_BYTES_MAX).with_context(context)?;
    let file: PersonFile = toml::from_str(&text).with_context(context)?;
    if file.code != code.to_string() {
        anyhow::bail!("--restore {}: it is of {:?}, not of {code}", path.display(), file.code);
    }
    let finger = Person::read_finger(&file.data).with_context(|| {
        format!("--restore {}: data {:?} is not 40 hexadecimal digits", path.display(), file.data)
    })?;
    Ok(Person { code, finger })
}
