//! What commissioning finds, against equations and numbers from elsewhere.

mod margins;
mod solve;
mod tune;
