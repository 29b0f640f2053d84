//! The bring-up procedure on simulated boards, and with persons who mistype.

mod boards;
mod interruptions;
mod procedure_data;
mod program;
mod typed_values;
mod typist;

use thermal_client::client::Client;
use thermal_lab::bring_up::{EmulatedBench, Report, SimulatedBoard, Stage, bring_up};
use thermal_sim::board::{Board, BoardBench, LossyLine};
use thermal_sim::engine::NativeEngine;

/// An engine on a board, and the board on its bench.
fn on_the_bench(board: Board) -> (LossyLine<NativeEngine>, BoardBench) {
    let interval = board.lost_bytes_interval;
    let bench = BoardBench::new(board);
    let world = bench.world().expect("a world");
    (LossyLine::new(NativeEngine::new(world), interval), bench)
}

/// A bring-up of a board, unattended.
fn brought_up(board: Board, report: Report, from: Option<&Stage>) -> Report {
    let (mut engine, bench) = on_the_bench(board);
    let mut client = Client::new(SimulatedBoard::new(&mut engine, bench));
    let mut hands = EmulatedBench { watch: &mut |_| () };
    let report = bring_up(&mut client, &mut hands, report, from, &mut |_| ());
    report.expect("the same device")
}
