//! Some examples log by defmt; the linker keeps the log's texts.
fn main() {
    println!("cargo::rustc-link-arg-bins=-Tdefmt.x");
}
