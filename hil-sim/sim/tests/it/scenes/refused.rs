//! Wrong scenes: file, line, value, what is allowed.

use std::path::Path;

use thermal_sim::scene::Scene;

const HEAD: &str = "duration_s = 1\nskin_c = 34\nroom_c = 24\n[object]\nmaterial = \"copper\"\n";
const COPPER: &str = "[[object.layer]]\nk_w_mk = 398\nrho_kg_m3 = 8954\nc_j_kgk = 384\n";
const LAYER: &str = "[[finger.layer]]\nk_w_mk = 0.37\nrho_kg_m3 = 1000\nc_j_kgk = 3700\n";

#[test]
fn wrong_tables_are_refused_with_line_value_and_what_is_allowed() {
    for (tables, line, expected) in [
        (
            "thickness_m = 0",
            6,
            "object.thickness_m = 0; allowed is 0.00001 to 10",
        ),
        (
            "back = \"held\"",
            6,
            "object.back has no meaning here; allowed is back beside object.thickness_m",
        ),
        (
            "thickness_m = 0.1\nback = \"warm\"",
            7,
            "unknown variant `warm`, expected one of `insulated`, `held`, `film`",
        ),
        (
            "thickness_m = 0.1\nback = \"film\"",
            7,
            "without object.back_film_w_m2k; allowed is 0.1 to 1000000",
        ),
        (
            "thickness_m = 0.1\nback_c = 20",
            7,
            "object.back_c has no meaning here; allowed is back_c beside back = \"held\" or \"film\"",
        ),
        (
            "thickness_m = 0.1\nback = \"held\"\nback_film_w_m2k = 9",
            8,
            "allowed is back_film_w_m2k beside back = \"film\"",
        ),
        (
            "thickness_m = 0.1\nback = \"held\"\nback_c = 99",
            8,
            "object.back_c = 99; allowed is -20 to 60",
        ),
        (
            &format!("thickness_m = 0.1\n{COPPER}"),
            6,
            "object.thickness_m beside object.layer; allowed is either one thickness or layers",
        ),
        (
            &format!("{COPPER}{COPPER}"),
            6,
            "object.layer.0.thickness_m is missing; only the last layer may be endless",
        ),
        (
            &format!("back = \"held\"\n{COPPER}"),
            6,
            "object.back has no meaning here; allowed is back beside thickness_m of the last object.layer",
        ),
        (
            &format!("{COPPER}thickness_m = 1e-6"),
            10,
            "object.layer.0.thickness_m = 0.000001; allowed is 0.00001 to 10",
        ),
        (
            &COPPER.replace("398", "inf"),
            7,
            "object.layer.0.k_w_mk = inf; allowed is 0.001 to 5000",
        ),
        (
            &COPPER.replace("c_j_kgk = 384\n", ""),
            6,
            "missing field `c_j_kgk`",
        ),
        (
            "told = \"slab\"",
            6,
            "unknown variant `slab`, expected `half-space`",
        ),
        (
            "[plant]\ntile.imx_a = 5",
            7,
            "no parameter is called tile.imx_a; similar are tile.imax_a",
        ),
        (
            "[plant.tile]\nimax_a = 500",
            7,
            "tile.imax_a = 500 A; allowed is 0.5 to 30",
        ),
        (
            "[plant]\ntile = 5",
            7,
            "no parameter is called tile; similar are ",
        ),
        (
            "[plant.tile]\nimax_a = \"5\"",
            7,
            "expected a number or a table of them",
        ),
        (
            "[plant]\ntile.imax_a = nan",
            7,
            "tile.imax_a = NaN A; allowed is",
        ),
        (
            "[plant]\nfinger.layer.1.thickness_m = 1e-3",
            7,
            "no parameter is called finger.layer.1.thickness_m",
        ),
        (
            "[[finger.layer]]\nthickness_m = 20\nk_w_mk = 0.4\nrho_kg_m3 = 1100\nc_j_kgk = 3000",
            7,
            "finger.layer.0.thickness_m = 20 m; allowed is 0.00001 to 10",
        ),
        (
            "[plant]\ndraw = -1",
            7,
            "plant.draw is the seed of a draw; allowed is a whole number",
        ),
        ("[plant]\ndraw = 1.5", 7, "plant.draw is the seed of a draw"),
        (
            "[plant]\ncontact.draw = -1",
            7,
            "plant.contact.draw is the seed of a draw; allowed is a whole number",
        ),
        (
            "[plant]\ncontact.gap_w_m2k = -1",
            7,
            "contact.gap_w_m2k = -1 W/(m2 K); allowed is 0 to 100000",
        ),
        (
            "[plant]\ntile.plate_m = 0.016\ntile.patch_m2 = 3e-4",
            6,
            "tile.patch_m2 is 0.0003; allowed is below the plate's area",
        ),
        (
            "[plant]\nbridge.pwm_hz = 1e6\nbridge.dead_time_s = 1e-6",
            6,
            "bridge.dead_time_s is 0.000001; allowed is up to half a period",
        ),
        (
            "[finger]\ndraw = 1.5",
            7,
            "finger.draw is the seed of a draw; allowed is a whole number",
        ),
        (
            "[finger]\ndraw = { a = 1 }",
            7,
            "a table, expected a number",
        ),
        (
            "[finger]\nair_w_m2k = 10",
            6,
            "a finger without blood or core has air_w_m2k 10",
        ),
        (
            "[finger]\ncore_w_m2k = 10",
            6,
            "behind an endless layer is 10; allowed is none",
        ),
        // As 2.9 m of skin lose 10 W/(m2 K) x 10 K, its core is 100 W/m2 x 2.9 m / 0.37 W/(m K) = 784 K above 34 C.
        (
            "[finger]\ncore_w_m2k = inf\nair_w_m2k = 10\n[[finger.layer]]\nthickness_m = 2.9\nk_w_mk = 0.37\nrho_kg_m3 = 1000\nc_j_kgk = 3700",
            6,
            "the finger's core must have for its skin and the room is 817.",
        ),
        (
            "[finger]\ntissue = \"thick\"",
            7,
            "unknown variant `thick`, expected `homogeneous` or `layered`",
        ),
        (
            "[finger]\ntissue = \"layered\"\nvessels = true\n[plant.finger.vessels]\nopen_n = 2",
            9,
            "finger.vessels.open_n is 2; allowed is below finger.vessels.shut_n, 1",
        ),
        (
            &format!("[finger]\ntissue = \"layered\"\n{LAYER}"),
            7,
            "finger.tissue beside finger.layer; allowed is either",
        ),
        (
            &format!("{LAYER}{LAYER}"),
            6,
            "finger.layer.0.thickness_m is missing; only the last layer may be endless",
        ),
        (
            &LAYER.replace("0.37", "0"),
            7,
            "finger.layer.0.conductivity_w_mk = 0 W/(m K); allowed is 0.01 to 500",
        ),
        (
            &LAYER.replace("1000", "-1"),
            8,
            "finger.layer.rho_kg_m3 = -1; allowed is 1 to 30000",
        ),
        (
            &LAYER.replace("c_j_kgk", "c_j_kgc"),
            9,
            "unknown field `c_j_kgc`, expected one of",
        ),
        (
            "[infrared]\noptic = \"glass\"",
            7,
            "unknown variant `glass`, expected one of `none`, `baf2`, `zns`",
        ),
        (
            "[infrared]\noptic = \"zns\"\nemissivity = 0",
            8,
            "infrared.emissivity = 0; allowed is above 0 to 1",
        ),
        (
            "[infrared]\noptic = \"zns\"\nrate_hz = 2000",
            8,
            "infrared.rate_hz = 2000; allowed is 0.001 to 1000",
        ),
        (
            "[infrared]\noptic = \"none\"\nwindow_c = 20",
            8,
            "infrared.window_c beside optic = \"none\"",
        ),
        (
            "[infrared]\noptic = \"zns\"\ncamera_share = 0.5",
            8,
            "infrared.camera_share without infrared.camera_c",
        ),
        (
            "[infrared]\noptic = \"zns\"\ncamera_c = 30\ncamera_share = 2",
            9,
            "infrared.camera_share = 2; allowed is 0 to 1",
        ),
        (
            "[[fault]]\nkind = \"thermistor-opened\"\nt_s = 0.5",
            7,
            "fault.kind = \"thermistor-opened\"; known are thermistor-open, thermistor-short,",
        ),
        (
            "[[fault]]\nkind = \"supply-low\"\nt_s = 0.5\nvalue = 13",
            9,
            "fault.value = 13 V of supply-low; allowed is 4.5 to 12",
        ),
        (
            "[[fault]]\nkind = \"force-offset\"\nt_s = 0.5\nvalue = nan",
            9,
            "fault.value = NaN N of force-offset; allowed is -10 to 10",
        ),
        (
            "[[fault]]\nkind = \"supply-low\"\nt_s = 0.5",
            6,
            "fault.value is missing; supply-low needs one in V, 4.5 to 12",
        ),
        (
            "[[fault]]\nkind = \"thermistor-open\"\nt_s = 0.5\nvalue = 1",
            9,
            "fault.value = 1 of thermistor-open, which takes none; allowed is none, or 0",
        ),
        (
            "[[fault]]\nkind = \"ram-bit\"\nt_s = 0.5\nbit = 1",
            6,
            "fault.address is missing; ram-bit needs it",
        ),
        (
            "[[fault]]\nkind = \"core-bit\"\nt_s = 0.5\nregister = \"r\"\nbit = 1",
            6,
            "`core-bit=r.1` is no fault of the machine; allowed are",
        ),
        (
            "[[fault]]\nkind = \"core-bit\"\nt_s = 0.5\naddress = 0x20000000",
            9,
            "fault.address has no meaning for core-bit; it has for ram-bit, register-bit",
        ),
        (
            "[[fault]]\nkind = \"hung-core\"\nt_s = 0.5\nuntil_s = 0.6",
            9,
            "fault.until_s has no meaning for hung-core; allowed is t_s",
        ),
        (
            "[[fault]]\nkind = \"adc-stuck\"\nt_s = 0.5\nbit = 1",
            9,
            "fault.bit has no meaning for adc-stuck; it has for ram-bit, core-bit, register-bit",
        ),
        (
            "[[fault]]\nkind = \"reset-pin\"\nt_s = 2",
            8,
            "fault.t_s = 2; allowed is 0 to 1",
        ),
        (
            "[[fault]]\nkind = \"thermistor-open\"\nt_s = 2",
            8,
            "fault.t_s = 2; allowed is 0 to 1",
        ),
        (
            "[[fault]]\nkind = \"thermistor-open\"\nt_s = 0.5\nuntil_s = 0.5",
            9,
            "fault.until_s = 0.5; allowed is 0.501 to 1",
        ),
        (
            "[[fault]]\nkind = \"host-garbage\"\nt_s = 0.5\nuntil_s = 0.6",
            9,
            "fault.until_s has no meaning for host-garbage; it has for thermistor-open, ",
        ),
        (
            "[[fault]]\nkind = \"thermistor-open\"\nt_s = 0.5\nsensor = \"nose\"",
            9,
            "unknown variant `nose`, expected one of `display`, `check`, `sink`, `skin`, `room`",
        ),
        (
            "[[fault]]\nkind = \"supply-low\"\nt_s = 0.5\nvalue = 6\nsensor = \"sink\"",
            10,
            "fault.sensor has no meaning for supply-low; it has for thermistor-open, thermistor-short, ",
        ),
        (
            "[[fault]]\nkind = \"thermistor-open\"\nt_s = 0.5\nwith = \"sink\"",
            9,
            "fault.with has no meaning for thermistor-open; it has for sensors-swapped",
        ),
        (
            "[[fault]]\nkind = \"sensors-swapped\"\nt_s = 0.5",
            6,
            "fault.with is missing; sensors-swapped needs one of display, check, sink, skin, room",
        ),
        (
            "[[fault]]\nkind = \"sensors-swapped\"\nt_s = 0.5\nsensor = \"sink\"\nwith = \"sink\"",
            10,
            "fault.with names the same thermistor as fault.sensor",
        ),
        (
            "[[fault]]\nkind = \"sink-hot\"\nt_s = 0.5\nvalue = 60\nuntill_s = 0.6",
            10,
            "unknown field `untill_s`, expected one of",
        ),
    ] {
        let text = format!("{HEAD}{tables}\n");
        let Err(error) = Scene::parse(&text, Path::new("bad.toml")) else {
            panic!("{tables} is accepted");
        };
        let message = error.to_string();
        assert!(
            message.starts_with(&format!("bad.toml:{line}: ")),
            "{tables}: {message}"
        );
        assert!(message.contains(expected), "{tables}: {message}");
    }
}

#[test]
fn an_unknown_law_is_refused_with_line_and_the_known_ones() {
    let error = Scene::parse(&format!("law = \"pid\"\n{HEAD}"), Path::new("bad.toml"))
        .expect_err("no such law");
    let message = error.to_string();
    assert!(
        message.starts_with("bad.toml:1: law = \"pid\"; known are pi-10hz, pi"),
        "{message}"
    );
}

/// The file reader would take stack for each level: 80 brackets times 80 words are more than a thread has.
#[test]
fn what_nests_too_deeply_is_refused_with_its_line() {
    let words = |count: usize| vec!["a"; count].join(".");
    let nested = |count: usize, key: &str| {
        format!(
            "x = {}1{}",
            format!("{{{key} = ").repeat(count),
            "}".repeat(count)
        )
    };
    let key = |words: &str| format!("{words} begins a key of more than 8 words; allowed is 1 to 8");
    let brackets = "9 brackets in each other; allowed is 0 to 8".to_owned();
    for (rest, line, expected) in [
        (
            format!("[plant]\n{} = 1", words(9)),
            7,
            key("a.a.a.a.a.a.a.a."),
        ),
        (
            format!("[plant]\n'b' . {} = 1", words(82)),
            7,
            key("'b' . a.a.a.a.a.a.a."),
        ),
        (
            format!("[{}]\nx = 1", words(100)),
            6,
            key("a.a.a.a.a.a.a.a."),
        ),
        (
            format!("[plant]\nx = [1,\n{}", nested(80, &words(79))),
            8,
            key("a.a.a.a.a.a.a.a."),
        ),
        (format!("[plant]\n{}", nested(80, "a")), 7, brackets.clone()),
        (format!("x = [{}", "\n[".repeat(80)), 14, brackets),
        // As deep as may be, and no parameter.
        (
            format!("[plant]\n{}", nested(8, &words(8))),
            7,
            format!("no parameter is called x.{}", words(64)),
        ),
    ] {
        let text = format!("{HEAD}{rest}\n");
        let error = Scene::parse(&text, Path::new("bad.toml")).expect_err(&rest);
        let message = error.to_string();
        assert!(
            message.starts_with(&format!("bad.toml:{line}: {expected}")),
            "{rest}: {message}"
        );
    }
}

#[test]
fn dots_and_brackets_in_text_and_comments_do_not_nest() {
    let text = format!(
        "# a.b.c.d.e.f.g.h.i.j [[[[[[[[[\n{HEAD}[[host]]\nt_s = 0.5 # {{{{{{{{{{{{{{{{{{\nline = \"a.b.c.d.e.f.g.h.i.j [[[[[[[[[\"\n"
    );
    let scene = Scene::parse(&text, Path::new("good.toml")).expect("a good scene");
    assert_eq!(scene.host[0].line, "a.b.c.d.e.f.g.h.i.j [[[[[[[[[");
}
