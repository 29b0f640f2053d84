//! `hil-sim infrared`: the thesis's infrared instrument, as CSV.

use std::io::{self, BufWriter, Write};

use anyhow::{anyhow, ensure};
use clap::{Args, ValueEnum};
use thermal_plant::infrared::{
    Camera, CameraParams, Optic, ParameterError, RANGE_C, Reading, SKIN_EMISSIVITY, SelfReflection,
    Surroundings,
};

use super::Failure;

#[derive(Args)]
pub struct Arguments {
    /// What the camera looks through; with a window comes the germanium beamsplitter
    #[arg(long, value_enum)]
    optic: Glass,
    /// True temperatures of the target, °C; one row each
    #[arg(long, value_delimiter = ',', required = true, allow_hyphen_values = true)]
    target_c: Vec<f64>,
    /// Room, °C
    #[arg(long, allow_negative_numbers = true)]
    ambient_c: f64,
    /// Window, °C; without it the room's
    #[arg(long, allow_negative_numbers = true)]
    window_c: Option<f64>,
    /// Beamsplitter, °C; without it the room's
    #[arg(long, allow_negative_numbers = true)]
    splitter_c: Option<f64>,
    /// Emissivity of the target
    #[arg(long, default_value_t = SKIN_EMISSIVITY, allow_negative_numbers = true)]
    emissivity: f64,
    /// Noise of one pixel at 30 °C, K
    #[arg(long, default_value_t = 0.0, allow_negative_numbers = true)]
    netd_k: f64,
    /// Pixels averaged into a reading
    #[arg(long, default_value_t = 1)]
    pixels: u32,
    /// Seed of the noise
    #[arg(long, default_value_t = 1)]
    seed: u64,
    /// Temperature of the camera's body, °C, reflected in the window; the recovered temperature neglects it
    #[arg(long, allow_negative_numbers = true)]
    camera_c: Option<f64>,
    /// How much of what the window mirrors is the camera, 0 to 1
    #[arg(long, default_value_t = 1.0, requires = "camera_c", allow_negative_numbers = true)]
    camera_share: f64,
}

#[derive(Clone, Copy, ValueEnum)]
enum Glass {
    None,
    Baf2,
    Zns,
}

impl From<Glass> for Optic {
    fn from(glass: Glass) -> Self {
        match glass {
            Glass::None => Self::None,
            Glass::Baf2 => Self::Baf2,
            Glass::Zns => Self::Zns,
        }
    }
}

/// Prints the table.
pub fn run(arguments: &Arguments) -> Result<(), Failure> {
    let mut camera = camera(arguments).map_err(Failure::input)?;
    print(&mut camera, &arguments.target_c).map_err(Failure::run)
}

/// The camera, if everything is in range.
fn camera(arguments: &Arguments) -> anyhow::Result<Camera> {
    let optic = arguments.optic.into();
    if optic == Optic::None {
        for (name, given) in [
            ("--window-c", arguments.window_c),
            ("--splitter-c", arguments.splitter_c),
            ("--camera-c", arguments.camera_c),
        ] {
            ensure!(
                given.is_none(),
                "{name} needs an optic; --optic none has neither window nor beamsplitter"
            );
        }
    }
    let (least, most) = RANGE_C.into_inner();
    for target_c in &arguments.target_c {
        ensure!(RANGE_C.contains(target_c), "--target-c {target_c}; allowed is {least} to {most}");
    }
    let params = CameraParams {
        optic,
        emissivity: arguments.emissivity,
        netd_k: arguments.netd_k,
        pixels: arguments.pixels,
        self_reflection: arguments
            .camera_c
            .map(|camera_c| SelfReflection { camera_c, share: arguments.camera_share }),
    };
    let surroundings = Surroundings {
        ambient_c: arguments.ambient_c,
        window_c: arguments.window_c.unwrap_or(arguments.ambient_c),
        splitter_c: arguments.splitter_c.unwrap_or(arguments.ambient_c),
    };
    Camera::new(&params, &surroundings, arguments.seed).map_err(
        |ParameterError { name, value, allowed }| {
            anyhow!("--{} {value}; allowed is {allowed}", name.replace('_', "-"))
        },
    )
}

fn print(camera: &mut Camera, targets_c: &[f64]) -> io::Result<()> {
    let mut out = BufWriter::new(io::stdout().lock());
    writeln!(out, "u_tot,apparent_c,recovered_c")?;
    for &target_c in targets_c {
        let Reading { u_tot, apparent_c, recovered_c } = camera.read(target_c);
        writeln!(out, "{u_tot},{apparent_c},{recovered_c}")?;
    }
    out.flush()
}
