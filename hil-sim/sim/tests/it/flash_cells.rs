//! Programming, erasing and power failures of flash cells.

use thermal_sim::FlashCells;

#[test]
fn programming_clears_bits_and_erasing_sets_them() {
    let mut cells = FlashCells::new(vec![0xff; 64]);
    cells.program(8, &[0xf0, 0x0f, 0, 0xff]);
    cells.program(8, &[0x3c; 4]);
    assert_eq!(cells.bytes()[7..13], [0xff, 0x30, 0x0c, 0, 0x3c, 0xff]);
    cells.erase(0..10);
    assert_eq!(cells.bytes()[7..13], [0xff, 0xff, 0xff, 0, 0x3c, 0xff]);
    assert_eq!(cells.operations(), 3);
}

#[test]
fn a_power_failure_interrupts_its_operation_and_prevents_the_next() {
    let mut programmed = Vec::new();
    let mut erased = Vec::new();
    for seed in 0..50 {
        let mut cells = FlashCells::new(vec![0xff; 64]);
        cells.cut_power_at(2, seed);
        cells.program(0, &[0x55; 4]);
        cells.program(4, &[0x55; 4]);
        assert!(!cells.is_powered());
        cells.program(8, &[0; 4]);
        cells.erase(0..64);
        assert_eq!(cells.bytes()[..4], [0x55; 4]);
        assert_eq!(cells.bytes()[8..], [0xff; 56], "without power");
        assert!(cells.bytes()[4..8].iter().all(|byte| byte & 0x55 == 0x55), "these bits stay");
        programmed.push(cells.bytes()[4..8].to_vec());
        cells.power_up();
        cells.cut_power_at(1, seed);
        cells.erase(0..64);
        erased.push(cells.bytes().to_vec());
    }
    for mut outcomes in [programmed, erased] {
        outcomes.sort();
        outcomes.dedup();
        assert!(outcomes.len() > 40, "{}", outcomes.len());
    }
}
