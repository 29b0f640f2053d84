//! The watchdog is fed only if every task has checked in since it was last fed.

#[path = "../../src/board/vigil.rs"]
mod vigil;

use vigil::{Task, Vigil};

#[test]
fn the_watchdog_is_not_fed_while_one_task_is_missing() {
    for (present, missing) in [(Task::Tick, Task::Host), (Task::Host, Task::Tick)] {
        let vigil = Vigil::new();
        assert!(!vigil.all_checked_in(), "no task has checked in yet");
        vigil.check_in(present);
        vigil.check_in(present);
        assert!(!vigil.all_checked_in(), "{missing:?} is missing");
        vigil.check_in(missing);
        assert!(vigil.all_checked_in());
        assert!(!vigil.all_checked_in(), "every task must check in again");
    }
}
