use std::string::ToString;

use proptest::prelude::*;

use super::*;

/// Values of settings: multiples of their decimals, within what `set` takes.
fn kept() -> impl Strategy<Value = Kept> {
    let correction = (
        -1_200_000..=1_200_000,
        -500_000..=500_000,
        -200_000..=200_000,
    );
    let tile = (
        100_000..=15_000_000,
        0..=500_000,
        0..=5_000_000,
        1000..=5_000_000,
        0..=1_000_000,
    );
    let steps = proptest::array::uniform13(-4000..=4000);
    (steps, proptest::array::uniform5(correction), tile).prop_map(|(steps, corrections, tile)| {
        let of = |units: i32, per: f64| f64::from(units) / per;
        Kept {
            calibration: Calibration {
                steps_counts: steps.map(|step| of(step, 1e3)),
                corrections: corrections.map(|(offset, slope, curvature)| Correction {
                    offset_k: of(offset, 1e6),
                    slope: of(slope, 1e7),
                    curvature_1_k: of(curvature, 1e8),
                }),
            },
            tile: Tile::from_array(
                [tile.0, tile.1, tile.2, tile.3, tile.4].map(|value| of(value, 1e6)),
            ),
        }
    })
}

/// With the checksum that belongs to it.
fn sealed(content: &[u8]) -> std::vec::Vec<u8> {
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
    fn all_settings_come_back_bit_for_bit(kept in proptest::array::uniform5(kept())) {
        prop_assert_eq!(decode::<5>(&encode(Some(&kept))), Ok(Some(kept)));
    }

    #[test]
    fn no_bytes_are_too_strange(bytes in proptest::collection::vec(any::<u8>(), 0..400)) {
        prop_assert!(decode::<1>(&bytes).is_err());
        // Bytes that get past the checksum, and past the head.
        let _any_content = decode::<1>(&sealed(&bytes));
        let mut content = std::vec![1, 0, 1, 1];
        content.extend(bytes.iter().cycle().take(if bytes.is_empty() { 0 } else { FINGER }));
        if let Ok(Some([kept])) = decode::<1>(&sealed(&content)) {
            prop_assert_eq!(kept.beyond(), None);
        }
    }

    #[test]
    fn any_bit_that_changes_is_noticed(kept in kept(), bit in 0..8 * (HEAD + FINGER + TAIL)) {
        let mut bytes = encode(Some(&[kept]));
        bytes[bit / 8] ^= 1 << (bit % 8);
        prop_assert_eq!(decode::<1>(&bytes), Err(StoredError::Checksum));
    }
}

#[test]
fn the_layout_is_the_one_described() {
    let kept = Kept::of(&Settings::default());
    let bytes = encode(Some(&[kept]));
    assert_eq!(bytes.len(), 140);
    assert_eq!(bytes[..4], [1, 0, 1, 1]);
    // 28 zeros, then the class's tile in millionths.
    let tile = [2_910_000, 58_500, 103_000, 100_000, 16_000]
        .map(i32::to_le_bytes)
        .concat();
    assert_eq!(
        (&bytes[4..116], &bytes[116..136]),
        (&[0; 112][..], &tile[..])
    );
    assert_eq!(sealed(&bytes[..136]), bytes[..]);
    assert_eq!(encode::<1>(None)[..], sealed(&[1, 0, 0, 0])[..]);
    assert_eq!(decode::<1>(&sealed(&[1, 0, 0, 0])), Ok(None));
}

#[test]
fn what_is_wrong_is_named() {
    let good = encode(Some(&[Kept::of(&Settings::default())]));
    let content = &good[..good.len() - TAIL];
    let changed = |at: usize, value: &[u8]| {
        let mut content = content.to_vec();
        content[at..at + value.len()].copy_from_slice(value);
        decode::<1>(&sealed(&content))
            .expect_err("changed")
            .to_string()
    };
    assert_eq!(
        changed(0, &[2]),
        "stored settings have the unknown version 2; known: 1"
    );
    assert_eq!(
        changed(2, &[9]),
        "stored settings have the unknown kind 9; known: 0 1"
    );
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
    assert_eq!(
        decode::<1>(&sealed(&content[..100])),
        Err(StoredError::Length(104))
    );
    assert_eq!(decode::<1>(&[]), Err(StoredError::Length(0)));
    assert_eq!(decode::<5>(&good), Err(StoredError::Fingers(1)));
}

#[test]
fn kept_settings_tune_the_loop() {
    let mut tile = Tile::CLASS;
    tile.gain_k_s_a = 5.0;
    let kept = Kept {
        calibration: Calibration::default(),
        tile,
    };
    let settings = kept.settings();
    assert_eq!(Kept::of(&settings), kept);
    assert_eq!(
        [settings.gains, settings.gains_10hz],
        super::super::Gains::of_tile(&tile)
    );
}
