//! The condition under which the watchdog is fed, and how often the host task is called.

use crate::task_liveness::{HostTaskTimer, Task, TaskLiveness};

#[test]
fn the_watchdog_is_fed_only_after_every_task_has_checked_in_again() {
    for (present, missing) in [(Task::Tick, Task::Host), (Task::Host, Task::Tick)] {
        let liveness = TaskLiveness::new();
        assert!(!liveness.clear_if_all_checked_in(), "no task has checked in");
        liveness.check_in(present);
        liveness.check_in(present);
        assert!(!liveness.clear_if_all_checked_in(), "{missing:?} is missing");
        liveness.check_in(missing);
        assert!(liveness.clear_if_all_checked_in());
        assert!(!liveness.clear_if_all_checked_in(), "all must check in again");
    }
}

#[test]
fn the_host_task_is_called_every_nine_ticks_and_at_once_for_telemetry() {
    let mut poll = HostTaskTimer::new_due_at_first_tick();
    let mut called_at = |telemetry_tick: usize| {
        let mut due = |tick: &usize| {
            let is_due = poll.count_tick_and_check_due_or_telemetry(*tick == telemetry_tick);
            if is_due {
                poll.restart();
            }
            is_due
        };
        (0..30).filter(&mut due).collect::<std::vec::Vec<_>>()
    };
    assert_eq!(called_at(30), [0, 9, 18, 27]);
    assert_eq!(called_at(10), [6, 10, 19, 28]);
}

#[test]
fn a_call_stays_due_until_it_is_made() {
    let mut poll = HostTaskTimer::new_due_at_first_tick();
    assert!((0..30).all(|_| poll.count_tick_and_check_due_or_telemetry(false)));
}
