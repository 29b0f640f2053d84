//! Writes the tables of the fixed-point path as source text: `cargo run --release -p contact-model --example tables`.

#[path = "../tests/fit/mod.rs"]
mod fit;

fn main() -> std::io::Result<()> {
    let folder = concat!(env!("CARGO_MANIFEST_DIR"), "/src/fixed_point");
    for (name, text) in
        [("kernel_table.rs", fit::kernel::table()), ("log_table.rs", fit::log_table())]
    {
        std::fs::write(format!("{folder}/{name}"), text)?;
        println!("wrote model/src/fixed_point/{name}");
    }
    Ok(())
}
