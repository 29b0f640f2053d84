//! What commissioning finds, against equations and numbers from elsewhere.

mod desk;
mod keep;
mod margins;
mod solve;
mod tune;
