//! A bring-up that is ended on the way: the bridge is off, and it goes on where it was, on the same device alone.

use thermal_client::client::Client;
use thermal_device::StateName;
use thermal_lab::bring_up::{EmulatedBench, Report, STAGES, SimulatedBoard, Stage, bring_up};
use thermal_sim::board::{Board, SOUND};

use super::typist::{End, Typed, typed};
use super::{brought_up, on_the_bench};

fn stage(name: &str) -> &'static Stage {
    let mut stages = STAGES.iter();
    stages.find(|stage| stage.name == name).expect("a stage")
}

/// In the stage `run` the thermometer is read while the display is held.
#[test]
fn ending_while_the_display_is_driven_switches_the_bridge_off() {
    let Typed { report, state, .. } = typed(Some(End::Thermometer("run")));
    assert_eq!(state, StateName::Ready);
    assert!(!report.passed());
    let resume = report.resume.expect("where to resume");
    assert_eq!(resume.stage, "run");
    assert_eq!(resume.reason, "ended by the person");
}

#[test]
fn an_ended_bring_up_goes_on_at_its_stage_and_can_pass() {
    let mut report = typed(Some(End::Task("load"))).report;
    assert_eq!(report.resume.as_ref().map(|resume| resume.stage.as_str()), Some("load"));
    assert!(!report.passed());
    let from = stage("load");
    report.keep_before(from, None).expect("the same image");
    let before = report.records.len();
    let board = Board::named(SOUND, None).expect("a board");
    let report = brought_up(board, report, Some(from));
    assert!(report.passed(), "{:#?}", report.findings());
    assert!(report.records.len() > before);
}

#[test]
fn stages_that_were_left_out_do_not_pass() {
    let from = stage("load");
    let board = Board::named(SOUND, None).expect("a board");
    let report = brought_up(board, Report::default(), Some(from));
    assert_eq!(report.findings(), Vec::<&str>::new());
    assert!(!report.passed());
}

const IMAGE: Option<&str> = Some("0badcafe");

/// A sound board that is brought up to the stage `load` with an image.
fn ended_at_load() -> Report {
    let mut report = typed(Some(End::Task("load"))).report;
    report.image = IMAGE.map(Into::into);
    report
}

#[test]
fn results_of_another_image_are_not_continued() {
    let ended = ended_at_load();
    for now in [Some("deadbeef"), None] {
        for from in ["line", "load", "run"] {
            let refusal = ended.clone().keep_before(stage(from), now.map(Into::into));
            let refusal = refusal.expect_err(from).to_string();
            let now = now.unwrap_or("not known");
            for part in [&format!("--from {from}:"), "0badcafe", now, "--from chip"] {
                assert!(refusal.contains(part), "{part}: {refusal}");
            }
        }
        // What was measured before the microcontroller had power is the same with any image.
        for from in ["bare-board", "rails", "chip"] {
            let mut report = ended.clone();
            let kept = report.keep_before(stage(from), now.map(Into::into));
            assert_eq!(kept, Ok(()), "{from}");
            assert_eq!(report.image.as_deref(), now);
        }
    }
    let mut same = ended;
    let kept = same.keep_before(stage("load"), IMAGE.map(Into::into));
    assert_eq!(kept, Ok(()));
}

/// Goes on with the results of a sound board on a board that is drawn with a seed.
fn gone_on_with(seed: u64, mut report: Report, from: &str) -> Result<Report, String> {
    let from = stage(from);
    let image = report.image.clone();
    report.keep_before(from, image).expect("the same image");
    let board = Board::named(SOUND, Some(seed)).expect("a board");
    let (mut engine, bench) = on_the_bench(board);
    let mut client = Client::new(SimulatedBoard::new(&mut engine, bench));
    let mut hands = EmulatedBench { watch: &mut |_| () };
    let mut saved = 0;
    let ended = bring_up(&mut client, &mut hands, report, Some(from), &mut |_| saved += 1);
    assert_eq!(ended.is_err(), saved == 0, "the earlier results are kept");
    ended.map_err(|refusal| refusal.to_string())
}

#[test]
fn results_of_another_microcontroller_are_not_continued() {
    let ended = ended_at_load();
    for from in ["chip", "line", "load", "run"] {
        let refusal = gone_on_with(5, ended.clone(), from).expect_err(from);
        for part in [
            "microcontroller 53494D550046001400460018,",
            "microcontroller 53494D550000000000000005,",
            "without --from",
        ] {
            assert!(refusal.contains(part), "{part}: {refusal}");
        }
    }
    // A board from its beginning has no earlier results.
    let report = gone_on_with(5, ended, "bare-board").expect("a new bring-up");
    assert!(report.passed(), "{:#?}", report.findings());
    assert_eq!(report.chip.as_deref(), Some("53494D550000000000000005"));
}

/// Results of firmware that does not report the identifier may be those of any board.
#[test]
fn results_of_an_unknown_microcontroller_are_not_continued() {
    let unknown = Report { chip: None, ..ended_at_load() };
    let refusal = gone_on_with(5, unknown, "load").expect_err("another one");
    assert!(refusal.contains("microcontroller not known,"), "{refusal}");
}
