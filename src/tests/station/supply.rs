//! The comparator's tests, the bridge's supply, and what the commands `self-test` and `raw` report.

use super::TestBench;
use crate::device::StateName;
use crate::device::drive::{ComparatorTest, Drive};

/// What of the circuit is broken.
#[derive(Clone, Copy, PartialEq)]
enum Broken {
    Nothing,
    HotSide,
    ColdSide,
    /// The line that selects the side stays low, or high.
    SideLow,
    SideHigh,
    /// The latch does not release the fault line.
    Release,
    SwitchShorted,
    SwitchOpen,
    SenseOpen,
}

/// Arms a bench, and steps until the self-test has ended; the ticks that it took.
fn self_test(bench: &mut TestBench, broken: Broken) -> u32 {
    assert_eq!(bench.send("arm"), "ok");
    let mut ticks = 0;
    while bench.state() == StateName::SelfTest {
        bench.step_self_test_with(|bench, test| {
            bench.comparator_side_differs = match test {
                ComparatorTest::None => false,
                ComparatorTest::Hot => broken == Broken::SideHigh,
                ComparatorTest::Cold => broken == Broken::SideLow,
            };
            bench.bridge_fault = match test {
                ComparatorTest::None => broken == Broken::Release,
                ComparatorTest::Hot => broken != Broken::HotSide,
                ComparatorTest::Cold => broken != Broken::ColdSide,
            };
            let cut = bench.bridge_fault || broken == Broken::SwitchOpen;
            bench.supply_v = match broken {
                Broken::SenseOpen => 0.0,
                Broken::SwitchShorted => 12.0,
                _ if cut => 4.1,
                _ => 12.0,
            };
        });
        ticks += 1;
    }
    ticks
}

#[test]
fn a_sound_circuit_passes_and_the_report_has_all_that_was_measured() {
    let mut bench = TestBench::new();
    assert_eq!(
        bench.send("self-test"),
        "ok hot_cut_ms=- hot_supply_v=- hot_release_ms=- cold_cut_ms=- cold_supply_v=- cold_release_ms=- side=- supply_v=- \
         cool_a=- warm_a=- display_k=- check_k=- result=none"
    );
    self_test(&mut bench, Broken::Nothing);
    assert_eq!(bench.state(), StateName::Armed);
    // 2.7 K/s for 0.2 s.
    assert_eq!(
        bench.send("self-test"),
        "ok hot_cut_ms=1 hot_supply_v=4.1 hot_release_ms=1 cold_cut_ms=1 cold_supply_v=4.1 cold_release_ms=1 \
         side=ok supply_v=12.0 cool_a=1.00 warm_a=1.00 display_k=0.54 check_k=0.54 result=passed"
    );
}

#[test]
fn each_broken_part_has_its_fault_and_its_place_in_the_report() {
    for (broken, fault, report) in [
        (
            Broken::HotSide,
            "comparator",
            "hot_cut_ms=- hot_supply_v=- hot_release_ms=- cold_cut_ms=-",
        ),
        (Broken::ColdSide, "comparator", "hot_release_ms=1 cold_cut_ms=- cold_supply_v=-"),
        // The other side would answer in its place.
        (
            Broken::SideLow,
            "comparator",
            "hot_release_ms=1 cold_cut_ms=- cold_supply_v=- cold_release_ms=- side=low",
        ),
        (
            Broken::SideHigh,
            "comparator",
            "hot_cut_ms=- hot_supply_v=- hot_release_ms=- cold_cut_ms=- cold_supply_v=- cold_release_ms=- side=high",
        ),
        (
            Broken::Release,
            "comparator",
            "hot_cut_ms=1 hot_supply_v=4.1 hot_release_ms=- cold_cut_ms=-",
        ),
        (Broken::SwitchShorted, "supply-switch", "hot_cut_ms=1 hot_supply_v=12.0 hot_release_ms=-"),
        (
            Broken::SwitchOpen,
            "supply",
            "hot_release_ms=1 cold_cut_ms=- cold_supply_v=- cold_release_ms=- side=ok \
             supply_v=4.1",
        ),
        (Broken::SenseOpen, "supply", "hot_supply_v=0.0"),
    ] {
        let mut bench = TestBench::new();
        self_test(&mut bench, broken);
        assert_eq!(bench.state().fault().map(|fault| fault.name()), Some(fault));
        let answer = bench.send("self-test");
        assert!(answer.contains(report), "{answer}");
        assert!(answer.ends_with(&["result=", fault].concat()), "{answer}");
    }
}

#[test]
fn an_aborted_self_test_has_no_result_and_a_running_one_says_so() {
    let mut bench = TestBench::new();
    assert_eq!(bench.send("arm"), "ok");
    bench.step_self_test();
    assert!(bench.send("self-test").ends_with("result=running"));
    bench.send_ok(&["abort"]);
    assert!(bench.send("self-test").ends_with("result=none"));
}

/// Begins in a tick whose number is a multiple of 64, so that at most 63 ticks are added to the 744 of the test and the
/// one that ends it.
#[test]
fn tests_of_stations_that_are_armed_at_any_tick_never_need_different_sides_at_once() {
    let mut sides = [(false, false); 64];
    for late in 0..64 {
        let mut bench = TestBench::new();
        bench.steps(100 + late);
        assert_eq!(bench.send("arm"), "ok");
        let mut ticks = 0;
        while bench.state() == StateName::SelfTest {
            bench.step_self_test_with(|bench, test| {
                let phase = &mut sides[bench.tick as usize % 64];
                phase.0 |= test == ComparatorTest::Hot;
                phase.1 |= test == ComparatorTest::Cold;
                bench.apply_comparator_test(test);
            });
            ticks += 1;
        }
        assert!((745..=808).contains(&ticks), "{ticks}");
    }
    assert_eq!(sides.iter().filter(|(hot, _)| *hot).count(), 20);
    assert_eq!(sides.iter().filter(|(_, cold)| *cold).count(), 20);
    assert!(!sides.contains(&(true, true)));
}

#[test]
fn a_supply_outside_of_its_limits_trips_after_10_ms_in_every_state_in_which_it_should_be_on() {
    for (supply_v, trips) in [(10.7, true), (10.9, false), (13.1, false), (13.3, true)] {
        for healthy in super::faults::bench_in_each_state() {
            let should_be_on = healthy.state() != StateName::Off;
            let mut bench = healthy.clone();
            bench.supply_v = supply_v;
            bench.steps(9);
            assert_eq!(bench.state(), healthy.state(), "{supply_v} V");
            bench.steps(1);
            let fault = bench.state().fault().map(|fault| fault.name());
            let expected = (trips && should_be_on).then_some("supply");
            assert_eq!(fault, expected, "{supply_v} V in {:?}", healthy.state());
        }
    }
}

/// Off by the comparator is no fault of the supply before a self-test, so it does not prevent `arm`.
#[test]
fn a_supply_that_is_off_before_the_self_test_does_not_matter() {
    let mut bench = TestBench::new();
    (bench.supply_v, bench.bridge_fault) = (0.0, true);
    bench.steps(1000);
    assert_eq!(bench.state(), StateName::Off);
    self_test(&mut bench, Broken::Nothing);
    assert_eq!(bench.state(), StateName::Armed);
}

#[test]
fn a_pressed_emergency_stop_refuses_arm_until_it_is_released_and_cleared() {
    let mut bench = TestBench::new();
    bench.emergency_stop = true;
    bench.step();
    assert_eq!(bench.send("arm"), "err tripped by emergency-stop; clear it first");
    assert_eq!(bench.send("clear"), "err fault emergency-stop is still present");
    bench.emergency_stop = false;
    bench.steps(1000);
    assert_eq!(bench.step().0, Drive::Off);
    bench.send_ok(&["clear", "arm"]);
    assert!(matches!(bench.step().0, Drive::On(_)));
}

/// 30.03 °C of a 10 kΩ thermistor of 3950 K at 10 kΩ are 0.44525 of 4096 counts; 12 V behind 33 and 10 kΩ are 0.84567.
#[test]
fn raw_samples_are_means_of_conversions() {
    let mut bench = TestBench::new();
    (bench.emergency_stop, bench.bridge_fault) = (true, true);
    bench.measured_a = Some(1.5);
    bench.step();
    let answer = bench.send("raw");
    let numbers: std::vec::Vec<f64> = answer
        .split(' ')
        .skip(1)
        .map(|word| word.split_once('=').expect("a pair").1.parse().expect("a number"))
        .collect();
    assert!((numbers[0] - 1823.7).abs() < 0.2, "{answer}");
    assert_eq!(numbers[5..], [410.0, 600.0, 3463.88, 1.0, 1.0], "{answer}");
}
