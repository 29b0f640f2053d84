//! Tests of the device as a whole without its hardware: lines and samples in, answers and outputs
//! out.

mod bridge;
mod commissioning;
mod course_refusals;
mod courses;
mod device;
mod flux;
mod line_queue;
mod objects;
mod persons;
mod station;
mod storage;
mod surface;
mod task_liveness;
