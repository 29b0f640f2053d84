//! Files that are no image for the STM32F446RE are refused with the reason.
use stm32_emulator::{EmbeddedTests, Firmware, ImageError};

/// A minimal 32-bit little-endian ARM executable: one segment of `contents` at `address`.
fn elf(machine: u16, address: u32, contents: &[u8]) -> Vec<u8> {
    let mut file = b"\x7fELF\x01\x01\x01\0\0\0\0\0\0\0\0\0".to_vec();
    let half = |v: u16| v.to_le_bytes().to_vec();
    let word = |v: u32| v.to_le_bytes().to_vec();
    file.extend(
        [half(2), half(machine), word(1), word(address), word(52), word(0), word(0x0500_0400)]
            .concat(),
    );
    file.extend([half(52), half(32), half(1), half(40), half(0), half(0)].concat());
    let size = contents.len() as u32;
    file.extend([1, 84, address, address, size, size, 5, 4].map(u32::to_le_bytes).concat());
    file.extend(contents);
    file
}

const ARM: u16 = 40;

fn vectors(sp: u32, reset: u32) -> Vec<u8> {
    [sp, reset].map(u32::to_le_bytes).concat()
}

fn refusal(file: &[u8]) -> ImageError {
    Firmware::from_elf(file).expect_err("refused")
}

#[test]
fn a_minimal_image_is_accepted() {
    let firmware = Firmware::from_elf(&elf(ARM, 0x0800_0000, &vectors(0x2002_0000, 0x0800_0009)))
        .expect("accepted");
    assert_eq!(firmware.initial_sp(), 0x2002_0000);
    assert_eq!((firmware.flash()[3], firmware.flash()[8]), (0x20, 0xff));
}

#[test]
fn other_processors_are_named() {
    let good = vectors(0x2002_0000, 0x0800_0009);
    let risc_v = refusal(&elf(243, 0x0800_0000, &good));
    assert!(matches!(risc_v, ImageError::Machine { found: 243, name: "RISC-V" }), "{risc_v}");
    let host = std::fs::read(std::env::current_exe().expect("this test")).expect("readable");
    assert!(matches!(refusal(&host), ImageError::Machine { .. }));
}

#[test]
fn contents_must_fit_the_flash() {
    let good = vectors(0x2002_0000, 0x0800_0009);
    for address in [0, 0x0807_fffc, 0x0808_0000, 0x1000_0000, 0xffff_fffc] {
        let error = refusal(&elf(ARM, address, &good));
        assert!(matches!(error, ImageError::Segment { address: a, .. } if a == address), "{error}");
    }
    assert!(matches!(refusal(&elf(ARM, 0x0800_0000, &[])), ImageError::Empty));
}

#[test]
fn the_vector_table_must_fit_the_chip() {
    let another_chip = refusal(&elf(ARM, 0x0800_0000, &vectors(0x2004_0000, 0x0800_0009)));
    assert!(matches!(another_chip, ImageError::StackPointer(0x2004_0000)), "{another_chip}");
    let arm_state = refusal(&elf(ARM, 0x0800_0000, &vectors(0x2002_0000, 0x0800_0008)));
    assert!(matches!(arm_state, ImageError::ResetVector(0x0800_0008)), "{arm_state}");
}

#[test]
fn truncated_and_foreign_files_are_refused() {
    let whole = elf(ARM, 0x0800_0000, &vectors(0x2002_0000, 0x0800_0009));
    for length in [0, 3, 16, 40, 60, 84, whole.len() - 1] {
        assert!(matches!(refusal(&whole[..length]), ImageError::NotElf(_)), "{length} bytes");
    }
    assert!(matches!(refusal(b"GIF89a and more than twenty bytes"), ImageError::NotElf(_)));
    let missing = Firmware::from_file(std::path::Path::new("no/such.elf")).expect_err("refused");
    // The caller names the file.
    assert!(missing.to_string().starts_with("cannot be read: "), "{missing}");
}

#[test]
fn an_image_without_tests_has_none_to_run() {
    let folder = std::env::temp_dir().join(format!("image-{}", std::process::id()));
    std::fs::create_dir_all(&folder).expect("a folder");
    let path = folder.join("image.elf");
    let image = elf(ARM, 0x0800_0000, &vectors(0x2002_0000, 0x0800_0009));
    std::fs::write(&path, image).expect("written");
    let refused = EmbeddedTests::from_file(&path).expect_err("refused");
    std::fs::remove_dir_all(&folder).expect("removed");
    assert_eq!(
        refused.to_string(),
        "no tests of embedded-test 0.7: the file has no section .embedded_test"
    );
}
