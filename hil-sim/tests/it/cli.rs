//! Golden values out, clear refusals of bad input.

use std::path::{Path, PathBuf};

use thermal_sim::scene::Scene;

use super::{Row, good, hil_sim, number, refused, rows};

/// The golden tables of the contact model's own tests.
fn golden(name: &str) -> Vec<Row> {
    rows(&format!("../model/tests/data/{name}.csv"))
}

#[test]
fn the_readmes_example_prints_what_it_shows() {
    let readme = include_str!("../../README.md");
    let (_, example) = readme.split_once("$ cargo hil-sim ").expect("an example with a prompt");
    let (line, shown) = example.split_once('\n').expect("its output");
    let (shown, _) = shown.split_once("```").expect("an end");
    let arguments: Vec<&str> = line.split(' ').collect();
    assert_eq!(good(&arguments, ""), shown);
}

#[test]
fn version_is_that_of_the_package() {
    let expected = format!("hil-sim {}\n", env!("CARGO_PKG_VERSION"));
    assert_eq!(good(&["--version"], ""), expected);
}

#[test]
fn model_meets_golden_values_in_f64_and_fixed_point() {
    let mut checked = 0;
    for row in golden("contact") {
        let own = |name: &str, column: &str| [name.to_owned(), row[column].clone()];
        let common = [
            own("--material", "material"),
            own("--pressure-pa", "P_Pa"),
            own("--skin-c", "T_skin_i_C"),
            own("--object-c", "T_object_i_C"),
            own("--times", "t_s"),
        ]
        .concat();
        let step_k = (number(&row, "T_skin_i_C") - number(&row, "T_object_i_C")).abs();
        let flux_scale = step_k / number(&row, "R_skin_object_m2K_W");
        // The last row of each condition is enough: the table is exercised in the model's own tests.
        if number(&row, "t_s") != 10.0 {
            continue;
        }
        for (arithmetic, bound) in [("f64", 1e-12), ("fixed", 5e-9)] {
            let mut arguments: Vec<&str> = vec!["model", "--arith", arithmetic];
            arguments.extend(common.iter().map(String::as_str));
            let text = good(&arguments, "");
            let mut lines = text.lines();
            assert_eq!(
                lines.next(),
                Some("t_s,z,erfcx,t_skin_c,t_object_c,q_w_m2,t_display_c,r_m2k_w,ratio")
            );
            let line = lines.next().expect("a row");
            let values: Vec<f64> =
                line.split(',').map(|cell| cell.parse().expect("a number")).collect();
            let kelvin =
                bound * step_k.max(1.0) + 1e-6 * f64::from(u8::from(arithmetic == "fixed")) + 1e-11;
            for (index, column, allowed) in [
                (2, "erfcx_z", bound),
                (3, "T_skin_s_C", kelvin),
                (4, "T_object_s_C", kelvin),
                (5, "q_W_m2", bound * flux_scale + 1e-6),
                (6, "T_display_C", kelvin),
                (7, "R_skin_object_m2K_W", bound * number(&row, "R_skin_object_m2K_W") + 1e-18),
                (8, "ratio_Rdisp_Robj", bound),
            ] {
                let error = (values[index] - number(&row, column)).abs();
                assert!(
                    error <= allowed,
                    "{arithmetic} {column}: {error:e} > {allowed:e} in {row:?}"
                );
            }
            checked += 1;
        }
    }
    assert!(checked >= 60, "{checked}");
}

#[test]
fn skin_at_depth_meets_golden_values() {
    // Copper under the pressure of section 6.3 only: R is not an option of the command.
    let rows = golden("contact_interior");
    let rows: Vec<_> = rows
        .iter()
        .filter(|row| row["material"] == "copper" && row["condition"] == "sim_2N_135mm2")
        .collect();
    assert!(rows.len() > 5);
    for row in rows {
        let arguments = [
            "model",
            "--material",
            "copper",
            "--pressure-pa",
            "14814.814814814815",
            "--arith",
            "f64",
        ];
        let own = ["--depth-m", &row["x_m"], "--times", &row["t_s"]];
        let text = good(&[&arguments[..], &own[..]].concat(), "");
        let skin_c: f64 =
            text.lines().nth(1).and_then(|line| line.split(',').nth(3)).unwrap().parse().unwrap();
        assert!((skin_c - number(row, "T_skin_x_t_C")).abs() < 1e-9, "{row:?}");
    }
}

#[test]
fn erfcx_meets_golden_values_in_decimal_and_hexadecimal() {
    let rows = golden("erfcx");
    let words: Vec<&str> =
        rows.iter().flat_map(|row| [row["x"].as_str(), row["x_hex"].as_str()]).collect();
    let text = good(&["erfcx"], &(words.join("\n") + "\n"));
    let mut lines = text.lines();
    assert_eq!(lines.next(), Some("z,E_bits"));
    for row in &rows {
        let exact = (number(row, "erfcx") * 4_294_967_296.0).min(4_294_967_295.0);
        for column in ["x", "x_hex"] {
            let (z, bits) = lines.next().and_then(|line| line.split_once(',')).expect("z,E_bits");
            assert_eq!(z, row[column]);
            let error = bits.parse::<f64>().expect("an integer") - exact;
            assert!(error.abs() <= 0.51 + 0.07, "z = {z}: {error} units of 2^-32");
        }
    }
}

/// A scene file that is removed at the end.
struct File(PathBuf);

impl File {
    fn new(name: &str, text: &str) -> Self {
        let path = std::env::temp_dir().join(format!("hil-sim-{}-{name}", std::process::id()));
        std::fs::write(&path, text).expect("a file");
        Self(path)
    }
    fn path(&self) -> &str {
        self.0.to_str().expect("text")
    }
}

impl Drop for File {
    fn drop(&mut self) {
        // Left behind in the temporary folder at worst.
        let _ = std::fs::remove_file(&self.0);
    }
}

const SCENE: &str = "duration_s = 1\nskin_c = 34\nroom_c = 24\n[object]\nmaterial = \"copper\"\n\
                     [[force]]\nt_s = 0.5\nforce_n = 2\n";

#[test]
fn bad_scenes_are_refused_with_file_line_and_what_is_allowed() {
    Scene::parse(SCENE, Path::new("scene")).expect("the scene that is spoiled is good");
    for (from, to, line, expected) in [
        ("copper", "gold", 5, "object.material = \"gold\"; known are copper, bronze"),
        ("skin_c", "skinn_c", 2, "unknown field `skinn_c`, expected one of"),
        ("force_n = 2", "force_n = -1", 8, "force.force_n = -1; allowed is 0 to 10"),
        ("duration_s = 1", "duration_s = 0", 1, "duration_s = 0; allowed is"),
        ("duration_s = 1", "duration_s = nan", 1, "duration_s = NaN; allowed is"),
        ("[object]", "[object", 4, "unclosed table"),
        (
            "material = \"copper\"",
            "material = \"copper\"\nstart_c = 60",
            6,
            "allowed is 15 to 42 C",
        ),
        ("material = \"copper\"", "k_w_mk = 1", 4, "object.rho_kg_m3 is missing"),
        ("t_s = 0.5", "t_s = 5", 7, "force.t_s = 5; allowed is 0 to 1"),
    ] {
        let file = File::new("scene.toml", &SCENE.replacen(from, to, 1));
        let message = refused(&["run", file.path(), "--engine", "native"]);
        assert!(message.contains(&format!("{}:{line}: ", file.path())), "{to}: {message}");
        assert!(message.contains(expected), "{to}: {message}");
    }
}

/// The scene runs, and standard error says what the skin error contains.
#[test]
fn a_back_that_the_device_is_not_told_of_is_noticed() {
    const SLAB: &str = "material = \"copper\"\nthickness_m = 0.01\nback = \"held\"\nback_c = 20";
    let notice =
        "the back of the object is at 20 C; the device cannot be told that, and takes it for 24 C";
    for (object, noticed) in [
        (SLAB.to_owned(), true),
        (SLAB.replace("back_c = 20", "back_c = 24"), false),
        (format!("{SLAB}\ntold = \"half-space\""), false),
        ("material = \"copper\"".into(), false),
    ] {
        let text = SCENE.replacen("material = \"copper\"", &object, 1);
        let file = File::new("back.toml", &text);
        for arguments in [&["run", file.path(), "--engine", "native"][..], &["object", file.path()]]
        {
            let output = hil_sim(arguments, "");
            assert!(output.status.success(), "{object}: {output:?}");
            let message = String::from_utf8(output.stderr).expect("text");
            assert_eq!(message.contains(notice), noticed, "{object}: {message}");
        }
    }
}

#[test]
fn the_page_about_objects_shows_the_lines_of_its_example() {
    let page = include_str!("../../../docs/objects.md");
    let lines = good(&["object", "../scenes/copper-on-foam.toml"], "");
    assert!(page.contains(&format!("```text\n{lines}```")), "{lines}");
}

/// Where the line `object slab` cannot say what the object is, its relaxations are uploaded.
#[test]
fn a_slab_of_the_named_material_is_printed_as_one_line() {
    let layers =
        "[[object.layer]]\nthickness_m = 0.003\nk_w_mk = 398\nrho_kg_m3 = 8954\nc_j_kgk = ";
    for (object, line) in [
        ("thickness_m = 0.003", "object slab 3mm insulated"),
        ("thickness_m = 0.0015\nback = \"held\"", "object slab 1.5mm held"),
        (
            "thickness_m = 0.0001\nback = \"film\"\nback_film_w_m2k = 12.5",
            "object slab 0.1mm film 12.5",
        ),
        (&format!("{layers}384"), "object slab 3mm insulated"),
        // Another material below the face, and too thin for a slab.
        (&format!("{layers}385"), "upload begin object "),
        ("thickness_m = 0.00005", "upload begin object "),
    ] {
        let text = SCENE.replacen("[[force]]", &format!("{object}\n[[force]]"), 1);
        let file = File::new("slab.toml", &text);
        let lines = good(&["object", file.path()], "");
        let lines: Vec<_> = lines.lines().collect();
        assert_eq!(lines[..2], ["material copper", "object room"], "{object}");
        assert!(lines[2].starts_with(line), "{object}: {lines:?}");
        assert_eq!(lines.len() == 3, line.contains("slab"), "{object}: {lines:?}");
    }
}

#[test]
fn files_that_are_none_are_refused() {
    let message = refused(&["run", "no-such-scene.toml"]);
    assert!(message.contains("no-such-scene.toml"), "{message}");
    let scene = File::new("good.toml", SCENE);
    let message = refused(&["run", scene.path(), "--elf", "no-such-image"]);
    assert!(message.contains("no-such-image"), "{message}");
    // The test program itself: an ELF, but for another machine.
    let own = std::env::current_exe().expect("a path");
    let message = refused(&["run", scene.path(), "--elf", own.to_str().expect("text")]);
    assert!(message.contains("ELF"), "{message}");
}

#[test]
fn bad_arguments_are_refused_by_name() {
    let is_case = |line: &&str| !line.is_empty() && !line.starts_with('#');
    for case in include_str!("refused.txt").lines().filter(is_case) {
        let (line, expected) = case.split_once(" -> ").expect("an arrow");
        let message = refused(&line.split(' ').collect::<Vec<_>>());
        assert!(message.contains(expected), "{line}: {message}");
    }
}

#[test]
fn erfcx_refuses_a_line_that_is_no_number() {
    let output = hil_sim(&["erfcx"], "1.0\nabc\n");
    assert_eq!(output.status.code(), Some(2));
    assert!(String::from_utf8_lossy(&output.stderr).contains("standard input:2: z = \"abc\""));
}

#[test]
fn parameters_are_printed_with_limits_and_drawn_alike_by_one_seed() {
    let read = |arguments: &[&str]| -> Vec<Row> {
        let text = good(&[&["parameters"], arguments].concat(), "");
        let header = "key,value,unit,low,high,distribution,least,most,source,meaning";
        assert_eq!(text.lines().next(), Some(header));
        let rows = csv::Reader::from_reader(text.as_bytes()).into_deserialize();
        rows.collect::<Result<_, _>>().expect("rows")
    };
    let nominal = read(&[]);
    let supply = (nominal.iter().find(|row| row["key"] == "bridge.supply_v")).expect("a parameter");
    assert_eq!(
        ["value", "unit", "low", "high", "source"].map(|column| supply[column].as_str()),
        ["12.0", "V", "11.4", "12.6", "design"]
    );
    let layered = read(&["--tissue", "layered"]);
    assert!(layered.len() > nominal.len());
    let fitted = read(&["--flux-sensor"]);
    let flux = fitted.iter().filter(|row| row["key"].starts_with("flux."));
    assert_eq!(flux.count(), 6);
    assert_eq!(fitted.len(), nominal.len() + 6);
    let drawn = read(&["--draw", "4"]);
    assert_eq!(drawn, read(&["--draw", "4"]));
    assert_ne!(drawn, read(&["--draw", "5"]));
    for (nominal, drawn) in nominal.iter().zip(&drawn) {
        assert_eq!(nominal["low"], drawn["low"], "limits are those of the nominal value");
        let value = number(drawn, "value");
        assert!(number(drawn, "low") <= value && value <= number(drawn, "high"), "{drawn:?}");
    }
    let json = good(&["parameters", "--json"], "");
    let json: Vec<serde_json::Value> = serde_json::from_str(&json).expect("an array");
    assert_eq!(json.len(), nominal.len());
    refused(&["parameters", "--draw", "x"]);
}

/// A reset of the native engine is a restart of the logic, and nothing else.
#[test]
fn run_reports_resets_and_refuses_other_faults_of_the_processor() {
    let scene = File::new(
        "resets.toml",
        "duration_s = 0.02\nskin_c = 34\nroom_c = 24\n[object]\nmaterial = \"abs\"\n",
    );
    let line =
        |more: &[&'static str]| [&["run", scene.path(), "--engine", "native"], more].concat();
    let run = |more: &[&'static str]| good(&line(more), "");
    assert!(run(&[]).contains("resets               none\n"));
    let table = run(&["--inject", "0.005:brown-out", "--inject", "0.01:reset-pin"]);
    let row = "resets               brown-out at 0.005 s, reset-pin at 0.010 s\n";
    assert!(table.contains(row), "{table}");
    let figures: serde_json::Value =
        serde_json::from_str(&run(&["--inject", "0.01:reset-pin", "--json"])).expect("JSON");
    assert_eq!(figures["resets"][0]["cause"], "reset-pin");
    let t_s = figures["resets"][0]["t_s"].as_f64().expect("a time");
    assert!((t_s - 0.01).abs() < 1e-9, "{t_s}");
    for (fault, expected) in [
        ("0.01:bit-rot", "`bit-rot` is no fault of the machine; allowed are ram-bit="),
        ("hung-core", "a time in seconds, a colon and a fault"),
        ("soon:hung-core", "`soon` is no time in seconds"),
    ] {
        let message = refused(&line(&["--inject", fault]));
        assert!(message.contains(expected), "{fault}: {message}");
    }
}

/// The thesis's rate leaves more than a thousand updates a second do; every row has its figures.
#[test]
fn fidelity_compares_laws_and_is_reproducible_by_seed() {
    let line = [
        "fidelity",
        "--engine",
        "native",
        "--json",
        "--material",
        "copper",
        "--force",
        "2",
        "--law",
        "pi-10hz",
        "pi",
    ];
    let text = good(&line, "");
    let report: serde_json::Value = serde_json::from_str(&text).expect("JSON");
    let rows = report["rows"].as_array().expect("rows");
    let value = |i: usize| rows[i]["judged"]["value"].as_f64().expect("a value");
    assert_eq!(
        (rows.len(), rows[0]["law"].as_str(), rows[1]["law"].as_str()),
        (2, Some("pi-10hz"), Some("pi"))
    );
    assert!(value(0) > value(1) && value(1) > 0.0, "{text}");
    for row in rows {
        assert_eq!(row["judged"]["value"], row["skin_error_mk"]["max_after_50ms"]);
        let (max, rms) = (&row["current_a"]["max_abs"], &row["current_a"]["rms"]);
        assert!(max.as_f64() > rms.as_f64() && rms.as_f64() > Some(0.0), "{row}");
        assert!(row["energy_j"].as_f64() > Some(0.0), "{row}");
    }
    let drawn = || {
        let mut report: serde_json::Value =
            serde_json::from_str(&good(&["fidelity", "--box", "2", "--seed", "9", "--json"], ""))
                .expect("JSON");
        report["box"].take()
    };
    let first = drawn();
    assert_eq!(first["draws"], 2);
    assert_eq!(first, drawn());
}
