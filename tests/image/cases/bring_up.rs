//! The release image on a board that is brought up: sound, and with errors of assembly.

use std::thread;

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
    bring_up(
        &mut client,
        &mut hands,
        Report::default(),
        None,
        &mut |_| (),
    )
    .expect("the same device")
}

fn on_the_image(name: &str) -> Report {
    let firmware = Firmware::from_file(image()).expect("an image for this chip");
    brought_up(name, |world| {
        OneFingerBoard::new(&firmware, world).expect("a chip")
    })
}

/// Names of the checks that failed.
fn failed(report: &Report) -> Vec<&str> {
    let failed = report.records.iter();
    failed
        .filter(|record| record.verdict == Verdict::Failed)
        .map(|record| record.check.as_str())
        .collect()
}

#[test]
fn a_sound_board_passes_with_the_release_image() {
    let report = on_the_image(SOUND);
    assert!(report.passed(), "{:#?}", report.findings());
}

/// What is found, and in which words, is asserted with the native device; the checks that fail first are the same ones.
#[test]
fn the_image_on_a_broken_board_fails_at_the_same_check_as_the_native_device() {
    thread::scope(|scope| {
        for half in BROKEN_BOARDS.chunks(BROKEN_BOARDS.len().div_ceil(2)) {
            scope.spawn(move || {
                for board in half {
                    let (image, native) = (
                        on_the_image(board.name),
                        brought_up(board.name, NativeEngine::new),
                    );
                    assert!(!image.passed(), "{}", board.name);
                    let (image, native) = (failed(&image), failed(&native));
                    assert_eq!(image.first(), native.first(), "{}", board.name);
                }
            });
        }
    });
}
