//! Text files as editors and spreadsheets save them.

use std::fs;

use super::{command, temporary};

const SCENE: &str =
    "duration_s = 0.05\nskin_c = 33.0\nroom_c = 24.0\n[object]\nmaterial = \"copper\"\n";
const COURSE: &str = "t_s,celsius\n0,32\n2,31\n";

#[test]
fn a_byte_order_mark_changes_nothing_and_utf_16_is_named_with_its_file() {
    let profile: String = (0..40).map(|n| format!("{n}e-6,{}e-9\n", n % 7)).collect();
    let profile = format!("x_m,z_m\n{profile}");
    let scene = temporary("encoding-scene.toml");
    fs::write(&scene, SCENE).expect("a file");
    let scene = scene.to_str().expect("a path");
    let settings = "set tile 3.113663 0.062379 0.091751 0.324278 0.016475\n";
    let commands: [(&[&str], &str); 4] = [
        (&["run", "--engine", "native"], SCENE),
        (&["play"], COURSE),
        (&["roughness"], &profile),
        (&["commission", "--engine", "native", scene, "--restore"], settings),
    ];
    for (words, text) in commands {
        let path = temporary(&format!("encoding-{}", words[0]));
        let run = |bytes: &[u8]| {
            fs::write(&path, bytes).expect("a file");
            command(&[words, &[path.to_str().expect("a path")]].concat())
        };
        let [plain, marked] = ["", "\u{feff}"].map(|mark| run(format!("{mark}{text}").as_bytes()));
        assert_eq!(plain.0, Some(0), "{words:?}: {}", plain.2);
        // The speed of the simulation is that of the computer.
        let is_result = |line: &&str| !line.starts_with("real-time factor");
        let results =
            |text: &str| text.lines().filter(is_result).map(str::to_owned).collect::<Vec<_>>();
        assert_eq!((marked.0, results(&marked.1)), (plain.0, results(&plain.1)), "{}", marked.2);
        let utf_16: Vec<u8> =
            format!("\u{feff}{text}").encode_utf16().flat_map(u16::to_le_bytes).collect();
        let (status, _, error) = run(&utf_16);
        assert_eq!(status, Some(2), "{words:?}: {error}");
        let name = path.display().to_string();
        assert!(error.contains(&name) && error.contains("this is UTF-16"), "{words:?}: {error}");
    }
}
