//! Prints the relaxations of the fingers that the device may assume, as in `contact_model::finger`.

use relaxation_fit::{Fit, fingers};

fn print(name: &str, fit: &Fit) {
    println!(
        "{name}: direct {:.5e} m2 K/W, relative error {:.1e}",
        fit.direct_m2k_w, fit.weighted_error
    );
    for one in &fit.relaxations {
        println!("    relaxation({:.5e}, {:.5e}),", one.rate_1_s, one.gain_m2k_j);
    }
}

fn main() {
    print("THESIS", &fingers::thesis());
    print("MEAN", &fingers::mean());
}
