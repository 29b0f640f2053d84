//! What ends tuning early, and what is refused.

use thermal_client::commissioning::arm;
use thermal_sim::World;
use thermal_sim::engine::NativeEngine;
use thermal_sim::scene::FaultKind;

use super::{Bench, bench, device, wait};

const STATE_OFF: &str = "state=ready";

/// A device that has just begun to tune in a world.
fn tuning(world: World, then: impl FnOnce(&mut Bench<'_>)) {
    let mut engine = NativeEngine::new(world);
    let mut bench = bench(&mut engine, &[]);
    wait(&mut bench, 5);
    arm(&mut bench, None).expect("armed");
    bench.command("tune").expect("tuning");
    then(&mut bench);
}

fn in_use() -> World {
    device(None, 1).in_use().expect("a plant")
}

fn ask(bench: &mut Bench<'_>, line: &str) -> String {
    bench.query(line).expect("an answer")
}

/// Ten times, from settling to the last pulse.
#[test]
fn finger_that_lands_ends_tuning_at_any_time_and_the_device_stays_armed() {
    for after_ms in (500..9500).step_by(1000) {
        tuning(in_use(), |bench| {
            wait(bench, after_ms);
            assert_eq!(
                ask(bench, "tune result"),
                "err tuning goes on; ask again in a second",
                "after {after_ms} ms"
            );
            bench.link().world().set_force_and_faults(0.5, std::iter::empty());
            wait(bench, 50);
            assert_eq!(
                ask(bench, "tune result"),
                "err tune was ended: a finger touches the display"
            );
            assert!(ask(bench, "state").starts_with("ok state=armed fault=-"));
            assert_eq!(ask(bench, "tune"), "err tune needs a display without a finger on it");
            // Neutral again, under the finger, at 1 K/s.
            wait(bench, 12_000);
            let display_c = bench.link().world().plant().display_c();
            assert!((display_c - 33.0).abs() < 0.5, "{display_c}");
        });
    }
}

#[test]
fn thermistor_that_breaks_while_tuning_trips_and_is_named() {
    tuning(in_use(), |bench| {
        wait(bench, 4000);
        bench
            .link()
            .world()
            .set_force_and_faults(0.0, std::iter::once(FaultKind::ThermistorOpen.into()));
        wait(bench, 5);
        assert_eq!(bench.link().world().plant().current_a(), 0.0);
        assert_eq!(ask(bench, "tune result"), "err tripped by display-open; clear it first");
        // Even when the fault is gone, nothing of the experiment is used.
        bench.link().world().set_force_and_faults(0.0, std::iter::empty());
        wait(bench, 50);
        bench.command("clear").expect("cleared");
        assert_eq!(
            ask(bench, "tune result"),
            "err tune was ended: another command or a fault ended it"
        );
    });
}

#[test]
fn hot_sink_ends_tuning_before_it_trips() {
    let hot = device(None, 1).sink_on_coolant(41.7).expect("a plant");
    tuning(hot, |bench| {
        wait(bench, 50);
        assert_eq!(ask(bench, "tune result"), "err tune was ended: the sink is above 41.5 C");
    });
}

#[test]
fn other_commands_end_tuning() {
    for (line, state) in [
        ("abort", STATE_OFF),
        ("hold 30", "state=stimulus"),
        // A reading that jumps would be taken for the tile's.
        ("set correction display 0.1 0 0", "state=armed"),
        ("set tile 2.9 0.06 0.1 0.1 0.01", "state=armed"),
    ] {
        tuning(in_use(), |bench| {
            wait(bench, 3000);
            bench.command(line).expect("obeyed");
            wait(bench, 5);
            let answer = ask(bench, "tune result");
            assert!(
                answer.starts_with("err tune was ended")
                    || answer.starts_with("err nothing was tuned"),
                "{answer}"
            );
            assert!(ask(bench, "state").contains(state));
            assert_eq!(bench.link().world().plant().current_a() == 0.0, state == STATE_OFF);
        });
    }
}

/// A lost answer can be requested again; the first request already releases the display.
#[test]
fn what_tuning_has_found_can_be_asked_for_again() {
    tuning(in_use(), |bench| {
        let mut first = String::new();
        for _ in 0..70 {
            wait(bench, 1000);
            first = ask(bench, "tune result");
            if first.starts_with("ok") {
                break;
            }
        }
        assert!(first.starts_with("ok gain="), "{first}");
        let display_c = bench.link().world().plant().display_c();
        assert!(display_c < 28.0, "held at the sink's temperature: {display_c}");
        wait(bench, 3000);
        assert_eq!(ask(bench, "tune result"), first);
        assert_eq!(ask(bench, "margins"), first);
        let display_c = bench.link().world().plant().display_c();
        assert!((display_c - 33.0).abs() < 0.5, "{display_c}");
        arm(bench, None).expect("armed");
        assert!(ask(bench, "tune result").starts_with("err nothing was tuned"));
    });
}

#[test]
fn what_does_not_fit_the_state_is_refused() {
    let mut engine = NativeEngine::new(in_use());
    let mut bench = bench(&mut engine, &[]);
    wait(&mut bench, 5);
    for (line, answer) in [
        ("tune", "err tune needs the state armed"),
        ("hold 30", "err hold needs a driven display: arm first"),
        ("tune result", "err nothing was tuned since arm; tune first"),
        ("calibrate display 24", "err not watched for long enough; wait half a second"),
    ] {
        assert_eq!(ask(&mut bench, line), answer, "{line}");
    }
    wait(&mut bench, 600);
    arm(&mut bench, None).expect("armed");
    wait(&mut bench, 600);
    assert_eq!(
        ask(&mut bench, "calibrate display 33"),
        "err the reading moves; wait until it is steady to 3 mK in a quarter of a second"
    );
    assert!(ask(&mut bench, "calibrate room 27").starts_with("err the device reads 2"));
    // Nothing of it has changed the settings.
    assert_eq!(
        ask(&mut bench, "settings 6"),
        "ok set correction skin 0.000000 0.0000000 0.00000000"
    );
}

/// A result that nobody has requested does not hold the display when an object is presented.
#[test]
fn object_that_is_presented_after_tuning_is_what_the_display_shows() {
    tuning(in_use(), |bench| {
        wait(bench, 40_000);
        for line in ["material copper", "object 24", "start"] {
            bench.command(line).expect("obeyed");
        }
        wait(bench, 3000);
        let reply = ask(bench, "state");
        let mut words = reply.split(' ');
        let setpoint = words.find_map(|word| word.strip_prefix("setpoint_c="));
        let setpoint_c: f64 = setpoint.expect("a set-point").parse().expect("degrees");
        let display_c = bench.link().world().plant().display_c();
        assert!(setpoint_c < 26.0 && (display_c - setpoint_c).abs() < 0.3, "{reply}: {display_c}");
    });
}

/// No line makes the device read a display so cold that the guard lets it burn.
#[test]
fn corrections_cannot_hide_a_hot_display() {
    let mut engine = NativeEngine::new(in_use());
    let mut bench = bench(&mut engine, &[]);
    wait(&mut bench, 5);
    for sensor in ["display", "check"] {
        let worst = format!("set correction {sensor} -1.2 -0.05 -0.002");
        bench.command(&worst).expect("within limits");
        assert!(
            ask(&mut bench, &format!("set correction {sensor} -1.3 0 0")).starts_with("err offset")
        );
    }
    // Else 42 °C is refused.
    bench.command("set tile 2.957 0.0585 0.104 0.1 0.016").expect("within limits");
    arm(&mut bench, None).expect("armed");
    bench.command("hold 42").expect("held");
    wait(&mut bench, 30_000);
    assert!(ask(&mut bench, "state").starts_with("ok state=stimulus"));
    let display_c = bench.link().world().plant().display_c();
    assert!((43.0..45.0).contains(&display_c), "{display_c}");
}
