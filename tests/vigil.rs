//! The watchdog is fed only if everybody is there.

#[path = "../src/board/vigil.rs"]
mod vigil;

use vigil::{Task, Vigil};

#[test]
fn one_missing_task_is_enough_to_starve_the_watchdog() {
    for (present, missing) in [(Task::Tick, Task::Host), (Task::Host, Task::Tick)] {
        let vigil = Vigil::new();
        assert!(!vigil.all_checked_in(), "nobody yet");
        vigil.check_in(present);
        vigil.check_in(present);
        assert!(!vigil.all_checked_in(), "{missing:?} is missing");
        vigil.check_in(missing);
        assert!(vigil.all_checked_in());
        assert!(!vigil.all_checked_in(), "everybody has to come again");
    }
}
