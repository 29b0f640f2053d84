//! All figures of a run.
use std::hint::black_box;

use model_bench::inputs::Input;
use model_bench::job::{Checksum, ON_TARGET};
use model_bench::kernels::{Call, KERNELS, Kernel, Table};
use model_bench::scenes::{Arithmetic, SCENES, Station, TICKS};
use serde::Serialize;
use thermal_display::device::reference::SETPOINT_INTERPOLATION_TOLERANCE;

use super::accuracy::{Accuracy, STEP_K, Truth};
use super::emulated::{Cost, Emulated};
use super::scenes::judge;
use super::timing::{Time, side_by_side};

/// Number of inputs of a timed round.
const TIMED: usize = 4096;
/// Extent of a run.
#[derive(Clone, Copy, Debug)]
pub struct Effort {
    /// Number of inputs whose error is evaluated.
    pub inputs: u32,
    /// Rounds of timing.
    pub rounds: usize,
}

/// A run of the benchmark.
#[derive(Clone, Debug, Serialize)]
pub struct Figures {
    /// Number of inputs whose error was evaluated.
    pub inputs: u32,
    /// Number of inputs on the emulated microcontroller.
    pub inputs_on_target: u32,
    /// Ticks of a scene.
    pub ticks: u32,
    /// Temperature step of errors in mK, K.
    pub step_k: f64,
    /// Tolerance of the firmware's chords, mK.
    pub tolerance_mk: f64,
    /// Machine whose instructions are counted.
    pub target: &'static str,
    /// Compiler of these instructions.
    pub compiler: String,
    /// Machine on which the times were measured.
    pub host: String,
    /// `erfcx` by the firmware and its peers.
    pub kernels: Vec<KernelFigures>,
    /// The model's share of a tick.
    pub scenes: Vec<SceneFigures>,
}

/// One kernel.
#[derive(Clone, Debug, Serialize)]
pub struct KernelFigures {
    /// Short name.
    pub id: &'static str,
    /// Description.
    pub title: &'static str,
    /// Errors.
    #[serde(flatten)]
    pub accuracy: Accuracy,
    /// Bytes of coefficients and tables; null if they are constants in a library's code.
    pub table_bytes: Option<usize>,
    /// Cost on the emulated microcontroller.
    #[serde(flatten)]
    pub cost: Cost,
    /// Time of a call on the host, ns.
    pub host_ns: f64,
    /// Ratio of that time to that of the firmware's kernel.
    pub host_ratio: f64,
    /// Whether host and microcontroller returned the same bits for all of the latter's inputs.
    pub same_on_target: bool,
}

/// One kind of scene in one arithmetic.
#[derive(Clone, Debug, Serialize)]
pub struct SceneFigures {
    /// The kind.
    pub kind: &'static str,
    /// The arithmetic.
    pub arithmetic: &'static str,
    /// Largest error of the set-point at the scene's step of 10 K, mK.
    pub worst_mk: f64,
    /// Time of the first set-point that is not a number, s.
    pub breaks_at_s: Option<f64>,
    /// Cost of a tick on the emulated microcontroller.
    #[serde(flatten)]
    pub cost: Cost,
    /// Time of a tick on the host, ns.
    pub host_ns: f64,
    /// Whether host and microcontroller found the same bits in every tick.
    pub same_on_target: bool,
}

/// Runs the benchmark and reports each step to `progress`.
///
/// # Errors
/// The image cannot be built or run.
pub fn measure(effort: Effort, progress: impl Fn(&str)) -> anyhow::Result<Figures> {
    progress("building the image");
    let emulated = Emulated::new()?;
    progress("exact values");
    let truth = Truth::new(effort.inputs);
    progress("timing on the host");
    let times = kernel_times(&truth.inputs(), effort.rounds);
    let scene_times = scene_times(effort.rounds)?;
    let mut kernels = Vec::new();
    for (index, (kernel, time)) in KERNELS.iter().zip(times).enumerate() {
        progress(kernel.title);
        kernels.push(of_kernel(kernel, &truth, emulated.kernel(index)?, time, &emulated));
    }
    let mut scenes = Vec::new();
    for (index, (scene, time)) in SCENES.iter().zip(scene_times).enumerate() {
        let arithmetic = name(scene.arithmetic);
        progress(&format!("{}, {arithmetic}", scene.kind));
        let judgement = judge(scene)?;
        let (cost, checksum) = emulated.scene(index)?;
        scenes.push(SceneFigures {
            kind: scene.kind,
            arithmetic,
            worst_mk: judgement.worst_mk,
            breaks_at_s: judgement.breaks_at_s,
            cost,
            host_ns: time.ns,
            same_on_target: checksum == judgement.checksum,
        });
    }
    Ok(Figures {
        inputs: effort.inputs,
        inputs_on_target: ON_TARGET,
        ticks: TICKS,
        step_k: STEP_K,
        tolerance_mk: 1e3 * SETPOINT_INTERPOLATION_TOLERANCE.to_num::<f64>(),
        target: "emulated STM32F446: instructions exact, cycles estimated, no wait states",
        compiler: emulated.compiler().into(),
        host: host(),
        kernels,
        scenes,
    })
}

fn of_kernel(
    kernel: &Kernel,
    truth: &Truth,
    (cost, on_target): (Cost, Checksum),
    time: Time,
    emulated: &Emulated,
) -> KernelFigures {
    let mut here = Checksum::default();
    for input in (0..ON_TARGET).filter_map(Input::nth) {
        here.add(kernel.call.on(&input).to_bits());
    }
    KernelFigures {
        id: kernel.id,
        title: kernel.title,
        accuracy: truth.judge(kernel.call),
        table_bytes: match kernel.table {
            Table::Bytes(bytes) => Some(bytes),
            Table::Firmware => Some(emulated.kernel_table_bytes()),
            Table::Library => None,
        },
        cost,
        host_ns: time.ns,
        host_ratio: time.ratio,
        same_on_target: here == on_target,
    }
}

fn kernel_times(inputs: &[Input], rounds: usize) -> Vec<Time> {
    let inputs = &inputs[..inputs.len().min(TIMED)];
    let mut candidates: Vec<Box<dyn FnMut()>> = KERNELS
        .iter()
        .map(|kernel| {
            // The type is matched once a round, not in every call.
            let run: Box<dyn FnMut()> = match black_box(kernel.call) {
                Call::Fixed(f) => Box::new(move || each(inputs, |i| f(i.elapsed, i.rate))),
                Call::Single(f) => Box::new(move || each(inputs, |i| f(i.elapsed.get(), i.single))),
                Call::Double(f) => Box::new(move || each(inputs, |i| f(i.elapsed.get(), i.double))),
            };
            run
        })
        .collect();
    side_by_side(&mut candidates, 0, inputs.len(), rounds)
}

fn each<T>(inputs: &[Input], call: impl Fn(&Input) -> T) {
    for input in inputs {
        black_box(call(input));
    }
}

fn scene_times(rounds: usize) -> anyhow::Result<Vec<Time>> {
    let start = Station::new()?;
    let mut candidates: Vec<Box<dyn FnMut()>> = Vec::new();
    for scene in &SCENES {
        let step = black_box(scene.step);
        let start = &start;
        candidates.push(Box::new(move || {
            let mut station = start.clone();
            for tick in 1..=TICKS {
                black_box(step(black_box(&mut station), tick));
            }
        }));
    }
    Ok(side_by_side(&mut candidates, 0, TICKS as usize, rounds))
}

/// Name of the arithmetic.
fn name(arithmetic: Arithmetic) -> &'static str {
    match arithmetic {
        Arithmetic::Integers => "integers",
        Arithmetic::Firmware => "firmware",
        Arithmetic::Shepherd => "f32, Shepherd-Laframboise",
        Arithmetic::LibmF32 => "f32, libm",
        Arithmetic::LibmF64 => "f64, libm",
    }
}

/// Description of this machine.
pub(super) fn host() -> String {
    let cores = std::thread::available_parallelism().map_or(1, usize::from);
    format!("one of {cores} cores, {}", std::env::consts::ARCH)
}
