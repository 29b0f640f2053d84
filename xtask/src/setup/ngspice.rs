//! Installs ngspice, which simulates the circuits of `hardware/`.
use super::{Missing, Permission, apt};
use crate::process::on_path;

const NGSPICE: Missing = Missing {
    what: "ngspice",
    apt: &["ngspice"],
    elsewhere: &["dnf install ngspice", "pacman -S ngspice", "brew install ngspice"],
};

/// Installs ngspice if it is missing. Where that fails, as without a network, says so: the benches are then skipped.
pub fn install_ngspice(permission: Permission) {
    if on_path("ngspice").is_some() {
        return;
    }
    if let Err(error) = apt::install(&[NGSPICE], permission.yes) {
        eprintln!("warning: the circuits are not simulated\n{error:#}");
    }
}
