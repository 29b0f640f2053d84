//! Some examples log by defmt; the linker keeps the log's texts.
fn main() {
    if std::env::var_os("CARGO_FEATURE_ALL").is_some() {
        println!("cargo::rustc-link-arg-bins=-Tdefmt.x");
    }
}
