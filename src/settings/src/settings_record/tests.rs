use std::string::ToString;

use proptest::prelude::*;

use super::*;

/// Any settings within their ranges, in units of their last decimals.
fn stored_settings() -> impl Strategy<Value = StoredSettings> {
    let correction = (-1_200_000..=1_200_000, -500_000..=500_000, -200_000..=200_000);
    let tile = (100_000..=15_000_000, 0..=500_000, 0..=5_000_000, 1000..=5_000_000, 0..=1_000_000);
    let flux_sensor = proptest::option::of((
        10_000..=1_000_000,
        64_000..=4_031_000,
        100..=500_000,
        0..=1_000_000,
    ));
    let display = proptest::option::of((100..=500_000, 100..=300_000, 100..=150_000));
    let steps = proptest::array::uniform13(-4000..=4000);
    let all = (steps, proptest::array::uniform5(correction), tile, flux_sensor, display);
    all.prop_map(|(steps, corrections, tile, flux_sensor, display)| {
        let scaled = |units: i32, per: f64| f64::from(units) / per;
        StoredSettings {
            calibration: Calibration {
                steps_counts: steps.map(|step| scaled(step, 1e3)),
                corrections: corrections.map(|(offset, slope, curvature)| Correction {
                    offset_k: scaled(offset, 1e6),
                    slope: scaled(slope, 1e7),
                    curvature_1_k: scaled(curvature, 1e8),
                }),
            },
            tile: Tile::from_array_rounded(
                [tile.0, tile.1, tile.2, tile.3, tile.4].map(|value| scaled(value, 1e6)),
            ),
            flux_sensor: flux_sensor.map(|(gain, zero, lag, resistance)| FluxSensor {
                counts_per_w_m2: scaled(gain, 1e6),
                zero_counts: scaled(zero, 1e3),
                lag_ms: scaled(lag, 1e3),
                resistance_mm2k_w: scaled(resistance, 1e3),
            }),
            display: display.map_or(DisplaySurface::NOMINAL, |(conductivity, roughness, slope)| {
                DisplaySurface::from_array_rounded([
                    scaled(conductivity, 1e3),
                    scaled(roughness, 1e4),
                    scaled(slope, 1e5),
                ])
            }),
        }
    })
}

/// Up to 16 persons.
fn persons() -> impl Strategy<Value = Persons> {
    let person = ("[A-Z0-9]{1,8}", any::<[u8; 20]>());
    proptest::collection::vec(person, 0..=16).prop_map(|all| {
        let mut persons = Persons::new();
        for (code, finger) in all {
            let code = PersonCode::new(&code).expect("a code");
            assert!(persons.insert(Person { code, finger }));
        }
        persons
    })
}

/// Appends the checksum.
fn with_checksum(content: &[u8]) -> std::vec::Vec<u8> {
    // Bit by bit, as the polynomial 0xedb88320 is defined.
    let crc = content.iter().fold(u32::MAX, |crc, byte| {
        (0..8).fold(crc ^ u32::from(*byte), |crc, _| {
            (crc >> 1) ^ (0xedb8_8320 & (crc & 1).wrapping_neg())
        })
    });
    [content, &(!crc).to_le_bytes()].concat()
}

proptest! {
    #[test]
    fn decode_restores_what_encode_wrote_bit_for_bit(
        stored in proptest::array::uniform5(stored_settings()),
        persons in persons(),
    ) {
        let stored = StoredDevice { fingers: stored, persons };
        prop_assert_eq!(decode_settings_record::<5>(&encode_settings_record(Some(&stored))), Ok(Some(stored)));
    }

    #[test]
    fn decode_accepts_any_bytes_without_panicking_and_checks_ranges(bytes in proptest::collection::vec(any::<u8>(), 0..400)) {
        prop_assert!(decode_settings_record::<1>(&bytes).is_err());
        // Bytes with a valid checksum, then with a valid header too.
        let _any_content = decode_settings_record::<1>(&with_checksum(&bytes));
        for (version, length) in [(1, 132), (2, 160), (2, 160 + 1 + 28), (2, 160 + 1 + 16 * 28)] {
            let mut content = std::vec![version, 0, 1, 1];
            content.extend(bytes.iter().cycle().take(if bytes.is_empty() { 0 } else { length }));
            if let Some(number) = content.get_mut(4 + 160) {
                *number = ((length - 161) / 28) as u8;
            }
            if let Ok(Some(StoredDevice { fingers: [stored], persons })) = decode_settings_record::<1>(&with_checksum(&content)) {
                prop_assert_eq!(stored.first_value_out_of_range(), None);
                for person in persons.as_slice() {
                    prop_assert_eq!(PersonCode::new(&person.code.to_string()), Some(person.code));
                }
            }
        }
    }

    #[test]
    fn the_checksum_detects_any_flipped_bit(stored in stored_settings(), bit in any::<proptest::sample::Index>()) {
        let mut bytes = encode_settings_record(Some(&[stored].into()));
        let bit = bit.index(8 * bytes.len());
        bytes[bit / 8] ^= 1 << (bit % 8);
        prop_assert_eq!(decode_settings_record::<1>(&bytes), Err(RecordError::Checksum));
    }
}

#[test]
fn the_record_has_the_documented_layout() {
    let stored = StoredSettings::from_settings(&Settings::default());
    let bytes = encode_settings_record(Some(&[stored].into()));
    assert_eq!(bytes.len(), 140);
    assert_eq!(bytes[..4], [1, 0, 1, 1]);
    // 28 zeros, then the nominal tile in millionths.
    let tile = [2_957_000, 58_500, 103_000, 100_000, 16_000].map(i32::to_le_bytes).concat();
    assert_eq!((&bytes[4..116], &bytes[116..136]), (&[0; 112][..], &tile[..]));
    assert_eq!(with_checksum(&bytes[..136]), bytes[..]);
    assert_eq!(encode_settings_record::<1>(None)[..], with_checksum(&[1, 0, 0, 0])[..]);
    for version in [1, 2] {
        let defaults = with_checksum(&[version, 0, 0, 0]);
        assert_eq!(decode_settings_record::<1>(&defaults), Ok(None));
    }
}

#[test]
fn the_record_of_a_device_with_a_heat_flux_sensor_has_the_documented_layout() {
    let without = StoredSettings::from_settings(&Settings::default());
    let with = StoredSettings { flux_sensor: Some(FluxSensor::DESIGNED), ..without };
    let tile = [2_957_000, 58_500, 103_000, 100_000, 16_000].map(i32::to_le_bytes);
    let finger = [&[0; 112][..], &tile.concat()].concat();
    let sensor = [119_200, 2_048_000, 5000, 30_000].map(i32::to_le_bytes);
    let content =
        [&[2, 0, 1, 2], &finger[..], &sensor.concat(), &[0; 12], &finger, &[0; 28]].concat();
    let bytes = encode_settings_record(Some(&[with, without].into()));
    assert_eq!(bytes[..], with_checksum(&content)[..]);
    assert_eq!(bytes.len(), 4 + 2 * 160 + 4);
    let decoded = decode_settings_record::<2>(&bytes);
    assert_eq!(decoded, Ok(Some([with, without].into())));
    // Each version has its length.
    let long = [&[1, 0, 1, 1], &finger[..], &[0; 28]].concat();
    let short = [&[2, 0, 1, 1], &finger[..]].concat();
    for content in [long, short] {
        let bytes = with_checksum(&content);
        let wrong = Err(RecordError::Length(bytes.len()));
        assert_eq!(decode_settings_record::<1>(&bytes), wrong);
    }
}

#[test]
fn the_record_of_a_display_with_another_surface_has_the_documented_layout() {
    let stored = StoredSettings {
        display: DisplaySurface::from_array_rounded([1.2, 0.45, 0.061]),
        ..StoredSettings::from_settings(&Settings::default())
    };
    let tile = [2_957_000, 58_500, 103_000, 100_000, 16_000].map(i32::to_le_bytes);
    let surface = [1200, 4500, 6100].map(i32::to_le_bytes);
    let content =
        [&[2, 0, 1, 1, 0, 0, 0, 0][..], &[0; 108], &tile.concat(), &[0; 16], &surface.concat()]
            .concat();
    let bytes = encode_settings_record(Some(&[stored].into()));
    assert_eq!(bytes[..], with_checksum(&content)[..]);
    assert_eq!(decode_settings_record(&bytes), Ok(Some([stored].into())));
}

#[test]
fn the_nominal_surface_is_a_rounded_one_within_its_ranges() {
    let nominal = DisplaySurface::NOMINAL;
    assert_eq!(DisplaySurface::from_array_rounded(nominal.to_array()), nominal);
    assert_eq!(nominal.first_value_out_of_range(), None);
}

#[test]
fn the_record_of_a_device_with_persons_has_the_documented_layout() {
    let finger = StoredSettings::from_settings(&Settings::default());
    let mut stored = StoredDevice::from([finger]);
    let without = encode_settings_record(Some(&stored));
    for (word, byte) in [("P07", 7), ("ABCDEFGH", 8)] {
        let code = PersonCode::new(word).expect("a code");
        let finger = [byte; 20];
        assert!(stored.persons.insert(Person { code, finger }));
    }
    let bytes = encode_settings_record(Some(&stored));
    let content = [
        &[2, 0, 1, 1],
        // The finger as in version 1, no heat-flux sensor, and the nominal surface.
        &without[4..136],
        &[0; 28],
        &[2],
        b"P07\0\0\0\0\0",
        &[7; 20],
        b"ABCDEFGH",
        &[8; 20],
    ]
    .concat();
    assert_eq!(bytes[..], with_checksum(&content)[..]);
    assert_eq!(decode_settings_record::<1>(&bytes), Ok(Some(stored)));
    // The same without persons, as it is stored for a finger with a sensor.
    let bytes = with_checksum(&content[..4 + 160]);
    assert_eq!(decode_settings_record::<1>(&bytes), Ok(Some([finger].into())));

    let changed = |at: usize, value: u8| {
        let mut content = content.clone();
        content[at] = value;
        decode_settings_record::<1>(&with_checksum(&content)).expect_err("changed")
    };
    for number in [0, 17, 255] {
        assert_eq!(changed(164, number), RecordError::Persons(number));
    }
    for number in [1, 3, 16] {
        assert_eq!(changed(164, number), RecordError::Length(4 + 160 + 57 + 4));
    }
    // Lower case, a gap, and nothing.
    for (at, value) in [(165 + 29, b'b'), (165 + 30, 0), (165 + 28, 0)] {
        let error = changed(at, value);
        assert_eq!(error, RecordError::PersonCode(1));
        assert_eq!(error.to_string(), "stored person 1 has no code of 1 to 8 of A-Z, 0-9");
    }
    assert_eq!(changed(164, 17).to_string(), "stored settings are of 17 persons; 1 to 16");
    // Version 1 and factory defaults have none.
    for content in [
        [&[1, 0, 1, 1], &without[4..136], &content[164..]].concat(),
        [&[2, 0, 0, 0], &content[164..]].concat(),
    ] {
        let bytes = with_checksum(&content);
        let wrong = Err(RecordError::Length(bytes.len()));
        assert_eq!(decode_settings_record::<1>(&bytes), wrong);
    }
}

#[test]
fn the_longest_record_fits_twice_into_a_sector() {
    let finger = StoredSettings {
        flux_sensor: Some(FluxSensor::DESIGNED),
        ..StoredSettings::from_settings(&Settings::default())
    };
    let mut stored = StoredDevice::from([finger; FINGERS_MAX]);
    let code = |number: usize| PersonCode::new(&std::format!("P{number}")).expect("a code");
    for number in 0..16 {
        assert!(stored.persons.insert(Person { code: code(number), finger: [1; 20] }));
    }
    // One more has no room, but may replace another one.
    assert!(!stored.persons.insert(Person { code: code(16), finger: [2; 20] }));
    assert!(stored.persons.insert(Person { code: code(15), finger: [2; 20] }));
    let length = encode_settings_record(Some(&stored)).len();
    assert!((RECORD_MAX_BYTES - 3..=RECORD_MAX_BYTES).contains(&length), "{length}");
    // A third of 16 KiB, less the seal.
    const { assert!(2 * RECORD_MAX_BYTES < 16 * 1024 / 3 - 8 - 100) };
    assert!(stored.persons.remove(code(3)) && !stored.persons.remove(code(3)));
    assert_eq!(stored.persons.get(code(3)), None);
    assert_eq!(stored.persons.get(code(15)).map(|person| person.finger), Some([2; 20]));
}

#[test]
fn codes_are_one_to_eight_capitals_and_digits() {
    for word in ["A", "7", "P07", "ABCDEFGH", "01234567"] {
        let code = PersonCode::new(word).expect("a code");
        assert_eq!(code.to_string(), word);
    }
    for word in ["", "ABCDEFGHI", "p07", "P 7", "P-7", "\0", "A\0B", "P\u{e9}"] {
        assert_eq!(PersonCode::new(word), None, "{word:?}");
    }
}

#[test]
fn each_invalid_record_has_its_error_message() {
    let stored = StoredSettings {
        flux_sensor: Some(FluxSensor::DESIGNED),
        ..StoredSettings::from_settings(&Settings::default())
    };
    let good = encode_settings_record(Some(&[stored].into()));
    let content = &good[..good.len() - CHECKSUM_BYTES];
    let changed = |at: usize, value: &[u8]| {
        let mut content = content.to_vec();
        content[at..at + value.len()].copy_from_slice(value);
        decode_settings_record::<1>(&with_checksum(&content)).expect_err("changed").to_string()
    };
    assert_eq!(changed(0, &[3]), "stored settings have the unknown version 3; known: 1 2");
    assert_eq!(changed(2, &[9]), "stored settings have the unknown kind 9; known: 0 1");
    assert_eq!(changed(3, &[5]), "stored settings are those of 5 fingers");
    // The first step, counts; the third value of the first correction, 1/K; the tile's gain, K/s/A.
    assert_eq!(
        changed(4, &4001i32.to_le_bytes()),
        "stored step 4.001 of finger 0 out of range; -4 to 4 counts"
    );
    assert_eq!(
        changed(4 + 4 * 15, &(-200_001i32).to_le_bytes()),
        "stored curvature -0.00200001 of finger 0 out of range; -0.002 to 0.002 1/K"
    );
    assert_eq!(
        changed(4 + 4 * 28, &99_999i32.to_le_bytes()),
        "stored gain 0.099999 of finger 0 out of range; 0.1 to 15 K/s/A"
    );
    // The gain of the heat-flux sensor, counts per W/m2, also of one that has the other values.
    assert_eq!(
        changed(4 + 4 * 33, &9_999i32.to_le_bytes()),
        "stored gain 0.009999 of finger 0 out of range; 0.01 to 1 counts per W/m2"
    );
    assert_eq!(
        changed(4 + 4 * 33, &[0; 4]),
        "stored gain 0 of finger 0 out of range; 0.01 to 1 counts per W/m2"
    );
    // The slope of the display, rad, with no conductivity and roughness.
    assert_eq!(
        changed(4 + 4 * 39, &13_800i32.to_le_bytes()),
        "stored conductivity 0 of finger 0 out of range; 0.1 to 500 W/mK"
    );
    assert_eq!(
        decode_settings_record::<1>(&with_checksum(&content[..100])),
        Err(RecordError::Length(104))
    );
    assert_eq!(decode_settings_record::<1>(&[]), Err(RecordError::Length(0)));
    assert_eq!(decode_settings_record::<5>(&good), Err(RecordError::Fingers(1)));
}

#[test]
fn stored_settings_determine_the_gains() {
    let mut tile = Tile::FACTORY_DEFAULT;
    tile.gain_k_s_a = 5.0;
    let stored = StoredSettings {
        calibration: Calibration::default(),
        tile,
        flux_sensor: Some(FluxSensor::DESIGNED),
        display: DisplaySurface::from_array_rounded([30.0, 1.1, 0.12]),
    };
    let settings = stored.to_settings_with_factory_defaults();
    assert_eq!(StoredSettings::from_settings(&settings), stored);
    assert_eq!(
        [settings.gains, settings.gains_10hz],
        super::super::PiGains::for_1khz_and_10hz_laws(&tile)
    );
}
