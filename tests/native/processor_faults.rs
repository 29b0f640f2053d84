//! Processor faults in the native engine, which has no registers and no clocks: each is either modelled or refused by name.

use system_tests::{between, copper_contact};
use thermal_sim::World;
use thermal_sim::engine::NativeEngine;
use thermal_sim::processor::Injection;
use thermal_sim::processor::ResetCause;
use thermal_sim::processor::{MachineFault, NotInjected};
use thermal_sim::run::{RunError, run, run_with};

#[test]
fn the_native_engine_refuses_or_models_each_processor_fault() {
    let scene = copper_contact();
    let native = || NativeEngine::new(World::new(&scene).expect("a plant for the scene"));
    let with = |fault, t_s| run_with(&scene, &[Injection { t_s, fault }], &mut native(), |_| ());
    assert!(matches!(
        with(MachineFault::HseStopped, 1.0),
        Err(RunError::NotInjected(NotInjected::NotApplicable {
            fault: MachineFault::HseStopped,
            engine: "native"
        }))
    ));
    assert!(matches!(with(MachineFault::ResetPin, 2.5), Err(RunError::InjectionTime { .. })));
    // No tick: the last duty stays until the window watchdog expires.
    for fault in [MachineFault::HungCore, MachineFault::AdcStopped] {
        let hung = with(fault, 1.0).expect("runs");
        let causes: Vec<_> = hung.resets.iter().map(|reset| reset.cause).collect();
        assert_eq!(causes, [ResetCause::WindowWatchdog]);
        let at = |t_s: f64| between(&hung, t_s, 2.0).next().map(|row| row.current_a);
        assert!(at(1.04).is_some_and(|a| a.abs() > 0.3));
        assert_eq!(at(1.05), Some(0.0));
    }
    let whole = run(&scene, &mut native(), |_| ()).expect("runs");
    assert!(whole.resets.is_empty());
}
