use std::path::Path;

#[test]
fn tmp_all() {
    for e in std::fs::read_dir(concat!(env!("CARGO_MANIFEST_DIR"), "/../sessions")).unwrap() {
        let p = e.unwrap().path();
        match crate::Session::read(&p) {
            Ok(s) => {
                let plan = crate::Plan::new(&s, "P01", 1).unwrap();
                println!("{} {}", p.file_name().unwrap().display(), plan.trials.len());
                for l in plan.csv().lines().take(5) { println!("   {l}"); }
            }
            Err(e) => println!("{e}"),
        }
    }
    let _ = Path::new("");
}
