//! What keys of a scene come to.

use contact_model::material::find;
use thermal_plant::contact::ContactLaw;
use thermal_plant::finger::{FingerParams, Vessels};
use thermal_plant::object::ObjectConfig;
use thermal_plant::sensors::FluxParams;
use thermal_plant::{Params, parameters};
use thermal_sim::World;
use thermal_sim::engine::NativeEngine;
use thermal_sim::metrics::figures;
use thermal_sim::processor::{ChipState, CoreRegister, FlashTiming, Injection, MachineFault};
use thermal_sim::run::run;
use thermal_sim::scene::AssumedFinger;

use super::scene;

const HEAD: &str = "duration_s = 1\nskin_c = 34\nroom_c = 24\n[object]\nmaterial = \"copper\"\n";

fn params(tables: &str) -> Params {
    scene(&format!("{HEAD}{tables}")).params
}

#[test]
fn scene_without_them_has_the_nominal_plant() {
    assert_eq!(params(""), Params::nominal());
    assert_eq!(params("[plant]\n[finger]\n"), Params::nominal());
}

#[test]
fn keys_of_the_box_may_be_dotted_or_nested() {
    let mut expected = Params::nominal();
    expected.tile.imax_a = 5.0;
    expected.sensors.thermistors[0].lag_s = 0.05;
    for tables in [
        "[plant]\ntile.imax_a = 5\nsensors.display.lag_s = 0.05\n",
        "[plant.tile]\nimax_a = 5\n[plant.sensors.display]\nlag_s = 0.05\n",
        "[plant]\ntile = { imax_a = 5.0 }\nsensors = { display = { lag_s = 0.05 } }\n",
    ] {
        assert_eq!(params(tables), expected, "{tables}");
    }
}

#[test]
fn every_key_of_the_box_can_stand_in_a_scene() {
    let finger = "[finger]\ntissue = \"layered\"\n";
    let mut nominal = Params::nominal();
    nominal.finger = FingerParams::layered();
    let mut tables = format!("{finger}[plant]\n");
    let mut expected = nominal.clone();
    for parameter in parameters::all(&nominal) {
        // An end of its tolerance: another value where it has one.
        let value = parameter.high;
        tables += &format!("{} = {value:?}\n", parameter.key);
        parameters::set(&mut expected, &parameter.key, value).expect("a key");
    }
    assert_ne!(expected, nominal);
    assert_eq!(params(&tables), expected);
}

#[test]
fn own_values_override_a_draw_wherever_they_stand() {
    let before = params("[plant]\ntile.imax_a = 5.0\ndraw = 3\n");
    let after = params("[plant]\ndraw = 3\ntile.imax_a = 5.0\n");
    assert_eq!(before, after);
    assert_eq!(before.tile.imax_a, 5.0);
    assert_ne!(before.tile.vmax_v, Params::nominal().tile.vmax_v);
    let finger =
        params("[finger]\ntissue = \"layered\"\nair_w_m2k = 7\n[plant]\ndraw = 3\n").finger;
    assert_eq!(finger.air_w_m2k, 7.0);
    assert_ne!(finger.layers, FingerParams::layered().layers);
}

#[test]
fn a_heat_flux_sensor_is_fitted_on_request_and_has_its_own_keys() {
    const FITTED: &str = "[device]\nflux_sensor = true\n";
    let nominal = Some(FluxParams::NOMINAL);
    assert_eq!(params(FITTED).flux, nominal);
    let mut slow = FluxParams::NOMINAL;
    slow.lag_s = 0.1;
    let keys = format!("{FITTED}[plant]\nflux.lag_s = 0.1\n");
    assert_eq!(params(&keys).flux, Some(slow));
    // It is drawn with the plant, of which nothing else is drawn otherwise.
    let (with, without) =
        (params(&format!("{FITTED}[plant]\ndraw = 3\n")), params("[plant]\ndraw = 3\n"));
    assert!(with.flux.is_some() && with.flux != nominal);
    assert_eq!(Params { flux: None, ..with }, without);

    let header = |tables: &str| {
        let scene = scene(&format!("{HEAD}{tables}"));
        let mut engine = NativeEngine::new(World::new(&scene).expect("a plant"));
        let outcome = run(&scene, &mut engine, |_| ()).expect("the device takes the scene");
        let mut csv = Vec::new();
        outcome.trace.write_to(&mut csv).expect("memory");
        let text = String::from_utf8(csv).expect("text");
        text.lines().next().expect("a header").to_owned()
    };
    let (with, without) = (header(FITTED), header(""));
    assert_eq!(with, without + ",flux_w_m2,flux_sensor_w_m2");
}

#[test]
fn contact_is_drawn_only_by_its_own_seed() {
    let mut expected = Params::nominal();
    parameters::draw(&mut expected, 3);
    assert_eq!(expected.contact, ContactLaw::NOMINAL);
    assert_eq!(params("[plant]\ndraw = 3\n"), expected);
    parameters::draw_contact(&mut expected, 4);
    assert_eq!(params("[plant]\ncontact.draw = 4\ndraw = 3\n"), expected);
    expected.contact.exponent = 0.9;
    let nested = "[plant]\ndraw = 3\n[plant.contact]\nexponent = 0.9\ndraw = 4\n";
    assert_eq!(params(nested), expected);
}

#[test]
fn drawn_finger_keeps_what_the_scene_gives_and_is_reported() {
    let of = |mut finger: FingerParams, layered| {
        parameters::draw_finger(&mut finger, 5, layered);
        finger
    };
    let plain = params("[finger]\ndraw = 5\n");
    assert_eq!(plain.finger, of(FingerParams::homogeneous(), false));
    let layered = "[finger]\ndraw = 5\ntissue = \"layered\"\n";
    let expected = of(FingerParams::layered(), true);
    assert_eq!(params(layered).finger, expected);
    // The plant's draw has the surface; nothing of the tissue is drawn twice.
    let both = params(&format!("{layered}[plant]\ndraw = 3\n"));
    let plant_only = params("[finger]\ntissue = \"layered\"\n[plant]\ndraw = 3\n");
    assert_eq!(both.finger.layers, expected.layers);
    assert_eq!(both.finger.surface, plant_only.finger.surface);
    assert_eq!(both.tile, plant_only.tile);
    let own = params(&format!("{layered}air_w_m2k = 7\nvessels = true\n")).finger;
    assert_eq!((own.air_w_m2k, own.vessels), (7.0, Some(Vessels::THESIS)));
    assert_eq!(own.layers, expected.layers);
    // Of own layers effusivity and resistance are drawn.
    let skin = "[[finger.layer]]\nk_w_mk = 0.37\nrho_kg_m3 = 1000\nc_j_kgk = 3700\n";
    assert_eq!(params(&format!("[finger]\ndraw = 5\n{skin}")), plain);

    let drawn = scene(&format!("{HEAD}{layered}[plant]\ncontact.draw = 4\n"));
    let mut engine = NativeEngine::new(World::new(&drawn).expect("a plant"));
    let outcome = run(&drawn, &mut engine, |_| ()).expect("the device takes the scene");
    let draws = figures(&drawn, &outcome).draws.expect("draws");
    assert_eq!((draws.contact, draws.finger), (Some(4), drawn.draws.finger));
    let tissue = draws.finger.and_then(|finger| finger.tissue);
    assert!(tissue.is_some());
    for parameter in parameters::all(&drawn.params) {
        let reported = draws.parameters.get(&parameter.key);
        let part = parameter.key.split('.').next();
        let expected = matches!(part, Some("contact" | "finger")).then_some(&parameter.value);
        assert_eq!(reported, expected, "{}", parameter.key);
    }
}

#[test]
fn layers_of_a_scene_are_those_of_the_nominal_fingers() {
    let skin = "[[finger.layer]]\nk_w_mk = 0.37\nrho_kg_m3 = 1000\nc_j_kgk = 3700\n";
    assert_eq!(params(skin).finger, FingerParams::homogeneous());
    let layered = "[finger]\ncore_w_m2k = inf\nair_w_m2k = 10\nvessels = true\n\
        [[finger.layer]]\nthickness_m = 0.65e-3\nk_w_mk = 0.21\nrho_kg_m3 = 1110\nc_j_kgk = 3600\n\
        [[finger.layer]]\nthickness_m = 1.2e-3\nk_w_mk = 0.37\nrho_kg_m3 = 1116\nc_j_kgk = 3224\n\
        perfusion_1_s = 5e-3\nmetabolism_w_m3 = 370\n\
        [[finger.layer]]\nthickness_m = 4e-3\nk_w_mk = 0.16\nrho_kg_m3 = 970\nc_j_kgk = 2303\n\
        perfusion_1_s = 1e-3\nmetabolism_w_m3 = 370\n";
    assert_eq!(params(layered).finger, FingerParams::layered());
    // Given layers are not drawn; what else the finger has is.
    let drawn = params(&format!("{layered}[plant]\ndraw = 1\n")).finger;
    assert_eq!(drawn.layers, FingerParams::layered().layers);
    assert_ne!(drawn.vessels, Some(Vessels::THESIS));
}

/// The device's mean finger is the plant's nominal one, without blood; its pad is the middle of the drawn ones.
#[test]
fn mean_finger_of_the_device_is_the_nominal_layered_finger() {
    let FingerParams { layers, core_w_m2k, air_w_m2k, .. } = FingerParams::layered();
    let tissue: Vec<_> = (layers.iter())
        .map(|layer| relaxation_fit::Layer {
            thickness_m: layer.thickness_m,
            conductivity_w_mk: layer.medium.conductivity_w_mk,
            capacity_j_m3k: layer.medium.capacity_j_m3k,
            perfusion_w_m3k: 0.0,
        })
        .collect();
    assert_eq!(tissue, relaxation_fit::fingers::MEAN_LAYERS);
    assert_eq!(core_w_m2k, Some(f64::INFINITY));
    assert_eq!(air_w_m2k, contact_model::finger::MEAN.air_w_m2k);
    let pads: Vec<_> = (0..200)
        .map(|seed| scene(&format!("{HEAD}[finger]\ntissue = \"layered\"\ndraw = {seed}\n")))
        .filter(|scene| scene.assumed_finger == AssumedFinger::MeanOnPad)
        .map(|scene| scene.params.finger.air_w_m2k)
        .collect();
    let mean = pads.iter().sum::<f64>() / pads.len() as f64;
    // Uniform from 0.5 to 3: three standard errors of the mean of about 100.
    assert!((mean - contact_model::finger::MEAN_ON_PAD.air_w_m2k).abs() < 0.22, "{mean}");
    assert!((70..130).contains(&pads.len()), "{}", pads.len());
}

/// The operator sees where a drawn finger rests before its contact; what the scene says goes first.
#[test]
fn a_finger_drawn_on_a_pad_is_told_to_the_device() {
    for seed in 0..20 {
        let layered = format!("[finger]\ntissue = \"layered\"\ndraw = {seed}\n");
        let drawn = scene(&format!("{HEAD}{layered}"));
        let on_pad = drawn.params.finger.air_w_m2k <= 3.0;
        let expected = if on_pad { AssumedFinger::MeanOnPad } else { AssumedFinger::Mean };
        assert_eq!(drawn.assumed_finger, expected, "{seed}");
        let in_air = scene(&format!("{HEAD}{layered}air_w_m2k = 10\n"));
        assert_eq!(in_air.assumed_finger, AssumedFinger::Mean);
        for (word, told) in [
            ("mean", AssumedFinger::Mean),
            ("mean-on-pad", AssumedFinger::MeanOnPad),
            ("thesis", AssumedFinger::Thesis),
        ] {
            let told_scene = scene(&format!("{HEAD}{layered}[device]\nfinger = \"{word}\"\n"));
            assert_eq!(told_scene.assumed_finger, told);
        }
    }
}

#[test]
fn layers_of_an_object_conduct_and_its_material_is_the_touched_surface() {
    let text = |rest: &str| format!("{HEAD}{rest}");
    let copper = "[[object.layer]]\nk_w_mk = 398\nrho_kg_m3 = 8954\nc_j_kgk = 384\n";
    let plain = scene(&text(""));
    assert!(!plain.object_as_half_space);
    assert_eq!(scene(&text(copper)).plant_config(), plain.plant_config());
    let thin = scene(&text("thickness_m = 3e-3\nback = \"held\"\n"));
    let layer = format!("back = \"held\"\n{copper}thickness_m = 3e-3\n");
    assert_eq!(scene(&text(&layer)).plant_config(), thin.plant_config());
    let foam = "[[object.layer]]\nk_w_mk = 0.029\nrho_kg_m3 = 24\nc_j_kgk = 1210\n";
    let on_foam = text(&format!("told = \"half-space\"\n{copper}thickness_m = 1e-3\n{foam}"));
    let on_foam = scene(&on_foam);
    assert!(on_foam.object_as_half_space);
    assert_eq!(on_foam.object.material, plain.object.material);
    let layers = &on_foam.plant_config().object.layers;
    let foam = ObjectConfig::half_space(*find("foam").expect("known"), 24.0);
    assert_eq!(layers[1..], foam.layers);
    assert_eq!(layers[0].thickness_m, 1e-3);
    assert_eq!(layers[0].medium, plain.object.layers[0].medium);
}

/// By their kinds: the sampler's stream unless another is named, and noise of the scene's seed.
#[test]
fn faults_of_the_processor_are_injected_at_their_times() {
    let fault =
        |kind: &str, keys: &str| format!("[[fault]]\nkind = \"{kind}\"\nt_s = 0.5\n{keys}\n");
    for (tables, expected) in [
        (fault("hung-core", ""), MachineFault::HungCore),
        (fault("software-reset", ""), MachineFault::SoftwareReset),
        (fault("hse-started", ""), MachineFault::HseStarted),
        (fault("power-cycle", ""), MachineFault::PowerCycle { seed: 7 }),
        (fault("dma-stopped", ""), MachineFault::DmaStopped { controller: 2, stream: 0 }),
        (
            fault("dma-stopped", "controller = 1\nstream = 6"),
            MachineFault::DmaStopped { controller: 1, stream: 6 },
        ),
        (
            fault("ram-bit", "address = 0x2000_0010\nbit = 3"),
            MachineFault::RamBit { address: 0x2000_0010, bit: 3 },
        ),
        (
            fault("core-bit", "register = \"s31\"\nbit = 4"),
            MachineFault::CoreBit { register: CoreRegister::S(31), bit: 4 },
        ),
    ] {
        let scene = scene(&format!("seed = 7\n{HEAD}{tables}"));
        assert_eq!(scene.injections, [Injection { t_s: 0.5, fault: expected }]);
        assert!(scene.faults.is_empty());
    }
}

#[test]
fn the_chip_is_that_of_a_prepared_board_unless_the_scene_says_otherwise() {
    assert_eq!(scene(HEAD).chip, ChipState::default());
    let keys = "[device]\nbrown_out_level = 0\nlsi_hz = 17000\nexternal_clock = false\nexternal_clock_start_us = 15000\nslow_flash = true\n\
                flash = \"off\"\nstrict = true\n";
    let expected = ChipState {
        brown_out_code: 3,
        lsi_hz: 17_000,
        external_clock: false,
        external_clock_start_us: 15_000,
        slow_flash: true,
        flash: FlashTiming::Unaccelerated,
        strict: true,
        ..ChipState::default()
    };
    assert_eq!(scene(&format!("{HEAD}{keys}")).chip, expected);
}
