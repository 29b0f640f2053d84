//! What commissioning finds, against equations and numbers from elsewhere.

mod desk;
mod margins;
mod solve;
mod tune;
