//! The release image on a board that is brought up: sound, and with errors of assembly.

use documented_figures::one_case_in;
use image_tests::image;
use stm32_emulator::{Firmware, OneFingerBoard};
use thermal_client::client::Client;
use thermal_lab::bring_up::{EmulatedBench, Report, SimulatedBoard, Verdict, bring_up};
use thermal_sim::World;
use thermal_sim::board::{BROKEN_BOARDS, Board, BoardBench, LossyLine, SOUND};
use thermal_sim::engine::{Engine, NativeEngine};

fn brought_up<E: Engine>(name: &str, start: impl FnOnce(World) -> E) -> Report {
    let board = Board::named(name, None).expect("a board");
    let interval = board.lost_bytes_interval;
    let bench = BoardBench::new(board);
    let engine = start(bench.world().expect("a world"));
    let mut engine = LossyLine::new(engine, interval);
    let mut client = Client::new(SimulatedBoard::new(&mut engine, bench));
    let mut hands = EmulatedBench { watch: &mut |_| () };
    bring_up(&mut client, &mut hands, Report::default(), None, &mut |_| ())
        .expect("the same device")
}

fn on_the_image(name: &str) -> Report {
    let firmware = Firmware::from_file(image()).expect("an image for this chip");
    brought_up(name, |world| OneFingerBoard::new(&firmware, world).expect("a chip"))
}

/// Names of the checks that failed.
fn failed(report: &Report) -> Vec<&str> {
    let failed = report.records.iter();
    failed
        .filter(|record| record.verdict == Verdict::Failed)
        .map(|record| record.check.as_str())
        .collect()
}

/// What is found, and in which words, is asserted with the native device; the checks that fail first are the same ones.
#[test]
fn the_image_is_brought_up_as_the_native_device_is() {
    let step = one_case_in(9);
    for board in BROKEN_BOARDS.iter().step_by(step) {
        let (image, native) = (on_the_image(board.name), brought_up(board.name, NativeEngine::new));
        assert!(!image.passed(), "{}", board.name);
        let (image, native) = (failed(&image), failed(&native));
        assert_eq!(image.first(), native.first(), "{}", board.name);
    }
    if step == 1 {
        let report = on_the_image(SOUND);
        assert!(report.passed(), "{:#?}", report.findings());
    }
}
