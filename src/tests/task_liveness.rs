//! The watchdog is fed only if everybody is there.

use crate::task_liveness::{Task, TaskLiveness};

#[test]
fn one_missing_task_is_enough_to_starve_the_watchdog() {
    for (present, missing) in [(Task::Tick, Task::Host), (Task::Host, Task::Tick)] {
        let liveness = TaskLiveness::new();
        assert!(!liveness.all_checked_in(), "nobody yet");
        liveness.check_in(present);
        liveness.check_in(present);
        assert!(!liveness.all_checked_in(), "{missing:?} is missing");
        liveness.check_in(missing);
        assert!(liveness.all_checked_in());
        assert!(!liveness.all_checked_in(), "everybody has to come again");
    }
}
