//! Sessions of experiments with a simulated participant: the program as a user starts it, and the executor on lines that break.

mod analyse;
mod folder;
mod interruptions;
mod lines;
mod participants;
mod program;
