//! The whole device by its lines, without the board: lines and samples in, answers and outputs out.

mod bridge;
mod commissioning;
mod device;
mod mailbox;
mod station;
mod storage;
mod task_liveness;
