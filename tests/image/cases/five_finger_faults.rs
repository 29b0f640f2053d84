//! Faults on the image for five fingers: some of the matrix, whose other runs take minutes.

use documented_figures::one_case_in;
use stm32_emulator::Firmware;
use thermal_campaigns::faults::{FiveFingerRun, Reference, five_finger_cases};
use thermal_campaigns::parallel_map;
use thermal_sim::five_fingers::FINGERS;

/// Kinds of faults of one finger's sensors, driver and mirror, and of what the fingers share: host, processor, select lines.
const KINDS: [&str; 7] = [
    "thermistor-open",
    "bridge-shorted",
    "mirror-stuck",
    "emergency-stop",
    "hung-core",
    "select-line-stuck",
    "select-line-open",
];
/// Of each kind with more than one row, the suite takes one in so many.
const ONE_IN: usize = 6;

/// A fault of one finger stops that finger only, a fault of what they share stops all, each with a right reason.
#[test]
fn faults_stop_the_fingers_that_have_them_and_no_others() {
    let elf = stm32_emulator::build(FINGERS).expect("the image builds");
    let image = Firmware::from_file(&elf).expect("an image for this chip");
    let cases = five_finger_cases();
    let of_kinds = KINDS.iter().flat_map(|kind| {
        let cases = cases.iter().filter(|case| case.fault.kind() == **kind);
        cases.step_by(one_case_in(ONE_IN)).copied()
    });
    let runs = FiveFingerRun::all(of_kinds.collect(), 1);
    let threads = std::thread::available_parallelism().map_or(1, usize::from);
    let needed = Reference::needed(&runs);
    let references = parallel_map(&needed, threads, |run| Reference::run(&image, *run), || ());
    let references = references.expect("the image runs without a fault");
    let trials = parallel_map(&runs, threads, |run| run.run(&image, &references), || ());
    for (run, trials) in runs.iter().zip(trials.expect("the image runs with faults")) {
        let summary = run.summary(trials);
        assert!(!summary.trials.is_empty(), "{}", summary.fault);
        for trial in &summary.trials {
            let assessment = &trial.assessment;
            assert!(summary.holds, "{}: {assessment:?}", summary.fault);
            // A device that trips at once ends what would have become the sign of the fault.
            let shown = assessment.took_ms.or(assessment.detected_ms);
            assert!(shown.is_some(), "{}: no sign", summary.fault);
        }
    }
}
