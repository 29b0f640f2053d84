//! Faults of the processor as text.

use thermal_sim::processor::MachineFault;

#[test]
fn every_fault_is_parsed_from_its_own_text() {
    for text in [
        "ram-bit=0x20000010.3",
        "core-bit=r4.7",
        "core-bit=s31.31",
        "core-bit=psr.30",
        "register-bit=0x40010044.15",
        "hung-core",
        "debugger-halt",
        "hse-stopped",
        "hse-started",
        "adc-stopped",
        "adc2-stopped",
        "dma-stopped=2.0",
        "brown-out",
        "power-cycle=18446744073709551615",
        "reset-pin",
        "software-reset",
        "stack-overflow",
        "select-line-stuck=2.1",
        "select-line-open=0",
    ] {
        let fault: MachineFault = text.parse().expect("a fault");
        assert_eq!(fault.to_string(), text);
    }
}

#[test]
fn other_texts_are_refused_with_a_list_of_what_is_allowed() {
    for text in [
        "",
        "hung-core=1",
        "ram-bit=3",
        "core-bit=x1.2",
        "dma-stopped=2",
        "power-cycle",
        "select-line-stuck=3.0",
        "select-line-stuck=0.2",
        "select-line-open=3",
    ] {
        let error = text.parse::<MachineFault>().expect_err("no fault");
        assert!(error.to_string().contains(&format!("`{text}`")), "{error}");
        assert!(error.to_string().contains("reset-pin"), "{error}");
    }
}
