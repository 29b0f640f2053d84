//! Parsing of lines, error messages and the lengths of answers.

mod checksums;
mod objects;

use proptest::prelude::*;
use std::string::{String, ToString};
use std::vec::Vec;

use contact_model::fixed_point::{Celsius, Force};

use super::station_command::{StationWork, station_work};
use super::{
    ANSWER_MAX_BYTES, BoardStatus, Error, LINE_MAX_BYTES, LineError, LineReader, PersonCodes,
    PersonReply, Reply,
};
use contact_model::contact_law::ContactLaw;
use contact_model::material::MATERIALS;
use thermal_commissioning::IdentificationError;
use thermal_device::command::{self, Command, FluxState, ObjectBody, Status};
use thermal_device::command::{AssumedFinger, ChosenContactLaw};
use thermal_device::control::Law;
use thermal_device::drive::Current;
use thermal_device::learning::{FingerKnowledge, FluxSensorTest};
use thermal_device::reference::ContactModel;
use thermal_device::safety::{
    ComparatorSideReport, Fault, SelfTestReport, SelfTestResult, SideLine,
};
use thermal_device::sense::SupplyVoltage;
use thermal_device::{Flux, StateName, Telemetry};
use thermal_settings::{DisplaySurface, Person, PersonCode, Persons};
use thermal_wire::request::{DeviceRequest, PersonRequest};
use thermal_wire::telemetry::{ALL_FIELDS, DEFAULT_FIELDS, TelemetryLine};
use thermal_wire::{PersonData, Request};

fn read(line: &str) -> Result<Request, Error> {
    Request::read(line).map_err(Error::from)
}

/// What the stations execute for a line.
fn work(line: &str) -> Result<StationWork, Error> {
    match read(line)? {
        Request::Station(request) => station_work(&request, DisplaySurface::NOMINAL.surface()),
        other => panic!("{line}: {other:?}"),
    }
}

fn command_of(line: &str) -> Command<'static> {
    match work(line) {
        Ok(StationWork::Command(command)) => command,
        _ => panic!("{line}"),
    }
}

fn refusal(line: &str) -> String {
    let answer = read(line).expect_err(line).to_string();
    assert!(answer.len() <= ANSWER_MAX_BYTES, "{answer}");
    answer
}

#[test]
fn each_line_about_persons_is_parsed() {
    let code = |word: &str| PersonCode::new(word).expect("a code");
    let finger = core::array::from_fn(|i| [0x01, 0x23, 0x45, 0x67, 0x89, 0xab, 0xcd, 0xef][i % 8]);
    let person = Person { code: code("ABCDEFGH"), finger };
    let chosen = |code| PersonRequest::Person { code, data: None };
    let stored = PersonRequest::Person { code: person.code, data: Some(PersonData(finger)) };
    for (line, request) in [
        ("person", PersonRequest::QueryPerson),
        ("person P07", chosen(code("P07"))),
        ("person none", PersonRequest::ChooseNobody),
        ("person enrol P07", PersonRequest::Enrol { code: code("P07") }),
        ("person ABCDEFGH 0123456789abcdef0123456789ABCDEF01234567", stored),
        ("persons", PersonRequest::List),
        ("forget person 7", PersonRequest::Forget { code: code("7") }),
    ] {
        assert_eq!(read(line), Ok(Request::Person(request)), "{line}");
    }
    assert_eq!(read("forget"), Ok(Request::Device(DeviceRequest::ForgetAll)));
    let reply = PersonReply { person: Some(person), contacts: 255 };
    assert_eq!(
        Reply::Person(reply).to_string(),
        "ok person=ABCDEFGH contacts=255 data=0123456789ABCDEF0123456789ABCDEF01234567"
    );
    let mut persons = Persons::new();
    let listed = |persons: &Persons| Reply::Persons(PersonCodes::new(persons)).to_string();
    assert_eq!(listed(&persons), "ok persons=none");
    for number in 0..16 {
        let code = code(&std::format!("ABCDEF{number:02}"));
        assert!(persons.insert(Person { code, ..person }));
    }
    let list = listed(&persons);
    assert!(list.starts_with("ok persons=ABCDEF00,ABCDEF01,") && list.ends_with(",ABCDEF15"));
    assert!(list.len() <= ANSWER_MAX_BYTES);
}

#[test]
fn every_command_is_parsed() {
    assert_eq!(read("id"), Ok(Request::Device(DeviceRequest::Identify)));
    assert_eq!(read("board"), Ok(Request::Device(DeviceRequest::Board)));
    for (line, expected) in [
        ("state", Command::Status),
        ("stream 0", Command::Stream { interval_ms: 0, fields: DEFAULT_FIELDS }),
        (" stream  60000 ", Command::Stream { interval_ms: 60_000, fields: DEFAULT_FIELDS }),
        ("object room", Command::Object(None)),
        ("object half-space", Command::Body(ObjectBody::HalfSpace)),
        ("finger", Command::Finger(None)),
        ("finger thesis", Command::Finger(Some(AssumedFinger::Thesis))),
        ("contact", Command::ContactLaw(None)),
        ("contact nominal", Command::ContactLaw(Some(ChosenContactLaw::NOMINAL))),
        (
            "contact 0.875 61250 1000",
            Command::ContactLaw(Some(ChosenContactLaw::new(ContactLaw {
                exponent: 0.875,
                hardness_pa: 61_250.0,
                gap_w_m2k: 1000.0,
            }))),
        ),
        ("object -20", Command::Object(Some(Celsius::lit("-20")))),
        ("object 23.25", Command::Object(Some(Celsius::lit("23.25")))),
        ("law", Command::Law(None)),
        ("law pi-10hz", Command::Law(Some(Law::Pi10Hz))),
        ("law pi", Command::Law(Some(Law::Pi))),
        ("mode contact", Command::Mode(ContactModel::ContactResistance)),
        ("mode semi-infinite", Command::Mode(ContactModel::SemiInfinite)),
        ("arm", Command::Arm),
        ("start", Command::Start),
        ("abort", Command::Abort),
        ("clear", Command::Clear),
    ] {
        assert_eq!(command_of(line), expected, "{line}");
    }
    // Copper by its name and by its properties.
    let pair_of = |line| match command_of(line) {
        Command::Material(material) => material.pair,
        other => panic!("{line}: {other:?}"),
    };
    let (named, custom) =
        (pair_of("material copper"), pair_of("material custom 398 8954 384 0.31 0.045"));
    assert!((named.ratio().to_num::<f64>() - custom.ratio().to_num::<f64>()).abs() < 1e-5);
}

#[test]
fn both_ends_of_a_range_are_allowed() {
    for line in [
        "object 60",
        "material custom 0.001 1 10 0.001 0.0001",
        "material custom 5000 30000 10000 1000 1.5",
    ] {
        assert!(work(line).is_ok(), "{line}");
    }
}

/// The values of Eq. 6-8 themselves are the law that costs nothing.
#[test]
fn a_contact_law_of_nominal_values_is_the_nominal_one() {
    let Command::ContactLaw(Some(law)) = command_of("contact 0.95 122500 0") else {
        panic!("a contact law");
    };
    assert_eq!(law.own, None);
}

#[test]
fn every_error_message_names_the_mistake_and_what_is_allowed() {
    let materials = MATERIALS.map(|(name, _)| name).join(" ");
    assert!(materials.starts_with("copper bronze stainless-steel granite g10 abs foam baf2 zns"));
    for (line, answer) in [
        (
            "fly",
            "err unknown command 'fly'; known: id board checksum save forget state stream events trigger-out material object \
             finger contact mode law arm hold play pulse skin start abort clear cause self-test raw tune calibrate margins \
             settings set flux surface person persons upload",
        ),
        (
            "material unobtainium-of-the-first-kind",
            "err unknown material 'unobtainium-of-the-f'; known: {materials} custom",
        ),
        ("mode x", "err unknown mode 'x'; known: contact semi-infinite"),
        ("law x", "err unknown law 'x'; known: pi-10hz pi model"),
        (" ", "err command missing"),
        ("stream", "err interval missing; 0 to 60000 ms"),
        ("object", "err object temperature missing; -20 to 60 C; or room half-space slab"),
        ("material", "err material missing; known: {materials} custom"),
        ("material custom 1 1", "err specific heat missing; 10 to 10000 J/kgK"),
        ("material custom 1 1 10 1", "err slope missing; 0.0001 to 1.5 rad"),
        ("mode", "err mode missing; known: contact semi-infinite"),
        ("contact soft", "err exponent 'soft' is not a decimal number; 0.3 to 1.5; or nominal"),
        ("contact 0.9 122500", "err gap missing; 0 to 100000 W/(m2 K)"),
        ("contact 0.9 999 0", "err microhardness '999' out of range; 1000 to 100000000 Pa"),
        ("calibrate", "err sensor missing; known: display check sink skin room"),
        ("set", "err setting missing; known: steps correction tile flux surface"),
        ("flux fit", "err unknown flux 'fit'; known: set none zero"),
        ("flux set", "err gain missing; 0.01 to 1 counts per W/m2"),
        ("flux set 1.1 2048 5 30", "err gain '1.1' out of range; 0.01 to 1 counts per W/m2"),
        ("set flux 0.1 63 5 30", "err zero '63' out of range; 64 to 4031 counts"),
        ("flux set 0.1 2048 0 30", "err lag '0' out of range; 0.1 to 500 ms"),
        ("flux set 0.1 2048 5 3e3", "err resistance '3e3' out of range; 0 to 1000 mm2 K/W"),
        ("flux none 1", "err unexpected '1' after the command"),
        ("surface rough", "err unknown surface 'rough'; known: set nominal"),
        ("surface set", "err conductivity missing; 0.1 to 500 W/mK"),
        ("surface set 0.09 1 0.1", "err conductivity '0.09' out of range; 0.1 to 500 W/mK"),
        ("set surface 36 31 0.1", "err roughness '31' out of range; 0.01 to 30 um"),
        ("surface set 36 1 1.6", "err slope '1.6' out of range; 0.001 to 1.5 rad"),
        ("surface nominal 1", "err unexpected '1' after the command"),
        ("person p07", "err person 'p07': a code is 1 to 8 of A-Z, 0-9"),
        ("person enrol ABCDEFGHI", "err person 'ABCDEFGHI': a code is 1 to 8 of A-Z, 0-9"),
        ("person enrol", "err person missing; a code of 1 to 8 of A-Z, 0-9"),
        ("forget person", "err person missing; a code of 1 to 8 of A-Z, 0-9"),
        (
            "person P07 0123456789abcdef0123456789abcdef0123456",
            "err data '0123456789abcdef0123' is not 40 hexadecimal digits",
        ),
        (
            "person P07 0123456789abcdef0123456789abcdef0123456+",
            "err data '0123456789abcdef0123' is not 40 hexadecimal digits",
        ),
        ("person none P07", "err unexpected 'P07' after the command"),
        ("persons P07", "err unexpected 'P07' after the command"),
        ("forget persons", "err unknown forget 'persons'; known: person"),
        ("arm now", "err unexpected 'now' after the command"),
        ("object room 3", "err unexpected '3' after the command"),
        (
            "object warm",
            "err object temperature 'warm' is not a decimal number; -20 to 60 C; or room half-space slab",
        ),
        (
            "object slap 3mm held",
            "err object temperature 'slap' is not a decimal number; -20 to 60 C; or room half-space slab",
        ),
        (
            "object half space",
            "err object temperature 'half' is not a decimal number; -20 to 60 C; or room half-space slab",
        ),
        (
            "object nan",
            "err object temperature 'nan' is not a decimal number; -20 to 60 C; or room half-space slab",
        ),
        (
            "object inf",
            "err object temperature 'inf' is not a decimal number; -20 to 60 C; or room half-space slab",
        ),
        ("object 60.001", "err object temperature '60.001' out of range; -20 to 60 C"),
        ("stream -1", "err interval '-1' out of range; 0 to 60000 ms"),
        (
            "stream 99999999999999999999999",
            "err interval '99999999999999999999' out of range; 0 to 60000 ms",
        ),
        ("material custom 0 1 10 1 0.1", "err conductivity '0' out of range; 0.001 to 5000 W/mK"),
    ] {
        assert_eq!(refusal(line), answer.replace("{materials}", &materials));
    }
}

/// The lines and errors that a reader returns for bytes.
fn read_lines(bytes: impl IntoIterator<Item = u8>) -> Vec<Result<String, LineError>> {
    let mut reader = LineReader::new();
    let lines = bytes.into_iter().filter_map(|byte| reader.push(byte));
    lines.map(|line| line.map(|line| line.to_string())).collect()
}

#[test]
fn an_invalid_byte_rejects_only_its_line() {
    let line = |text: &str| Ok(text.to_string());
    assert_eq!(read_lines(*b"arm\r\n\n\rid\n"), [line("arm"), line("id")]);
    assert_eq!(read_lines(*b"a\xffrm\nid\n"), [Err(LineError::NotText(0xff)), line("id")]);
    let full = "x".repeat(LINE_MAX_BYTES);
    let bytes = [full.as_str(), "\n", &full, "x\nid\n"].concat();
    assert_eq!(read_lines(bytes.bytes()), [line(&full), Err(LineError::TooLong), line("id")]);
    assert_eq!(Error::from(LineError::TooLong).to_string(), "err line too long; at most 96 bytes");
}

proptest! {
    #[test]
    fn a_valid_line_is_parsed_after_any_bytes(garbage in prop::collection::vec(any::<u8>(), 0..300)) {
        let lines = read_lines(garbage.into_iter().chain(*b"\nobject 25\n"));
        prop_assert_eq!(lines.last(), Some(&Ok("object 25".to_string())));
        for line in lines.into_iter().flatten() {
            if let Err(error) = read(&line) {
                prop_assert!(error.to_string().len() <= ANSWER_MAX_BYTES);
            }
        }
    }
}

#[test]
fn the_longest_answers_fit_their_limit() {
    let tripped = StateName::Tripped(Fault::DisplayShort);
    let status = Status {
        state: tripped,
        material: Some("stainless-steel"),
        object: Some(Celsius::MIN),
        mode: ContactModel::SemiInfinite,
        setpoint: Some(Celsius::MIN),
        limited: true,
        is_tuned: false,
        body: ObjectBody::HalfSpace.name(),
    };
    let answer = Reply::Station(command::Reply::Status(status)).to_string();
    assert!(
        answer.len() <= ANSWER_MAX_BYTES
            && answer.ends_with(" limited body=half-space tile=untuned"),
        "{answer}"
    );
    let unknown = refusal(&"x".repeat(LINE_MAX_BYTES));
    assert!(unknown.len() == ANSWER_MAX_BYTES && unknown.ends_with(" upload"), "{unknown}");
    let documentation = include_str!("../../../docs/protocol.md");
    let limit = std::format!("at most {ANSWER_MAX_BYTES} bytes without address and checksum");
    assert!(documentation.contains(&limit), "docs/protocol.md: {limit}");
    let side = ComparatorSideReport {
        cut_ms: Some(19),
        cut_supply: Some(SupplyVoltage::from_sum(u16::MAX)),
        release_ms: Some(19),
    };
    let report = SelfTestReport {
        side_line: Some(SideLine::StuckHigh),
        hot: side,
        cold: side,
        supply: Some(SupplyVoltage::from_sum(u16::MAX)),
        cooling_current: Some(Current::from_num(10.24)),
        warming_current: Some(Current::from_num(10.24)),
        responses: [Some(Celsius::from_num(-99)); 2],
        result: SelfTestResult::Failed(Fault::SettingsCorrupt),
        flux_sensor: Some(FluxSensorTest::Range),
    };
    let answer = Reply::Station(command::Reply::SelfTest(report)).to_string();
    assert_eq!(
        answer,
        "ok hot_cut_ms=19 hot_supply_v=14.2 hot_release_ms=19 cold_cut_ms=19 cold_supply_v=14.2 cold_release_ms=19 \
         side=high supply_v=14.2 cool_a=10.24 warm_a=10.24 display_k=-99.00 check_k=-99.00 result=settings-corrupt \
         flux=sensor-range"
    );
    assert!(answer.len() <= ANSWER_MAX_BYTES);

    let longest = Telemetry {
        tick: u32::MAX,
        state: tripped,
        setpoint: Some(Celsius::MIN),
        limited: true,
        is_tuned: true,
        display: Some(Celsius::MIN),
        check: Some(Celsius::MIN),
        sink: Some(Celsius::MIN),
        skin: Some(Celsius::MIN),
        room: Some(Celsius::MIN),
        force: Some(Force::MAX),
        demand: Current::MIN,
        current: Current::MIN,
        evaluations: u32::MAX,
        fields: DEFAULT_FIELDS,
    };
    let flux = Some(FluxState {
        flux: Some(Flux::MIN),
        surface: Some(Celsius::MIN),
        knowledge: FingerKnowledge::SensorFault,
    });
    let write = |telemetry| TelemetryLine { telemetry, flux }.to_string();
    let line = write(longest);
    assert!(
        line.len() <= ANSWER_MAX_BYTES && line.ends_with(" 4294967295 display-short"),
        "{line}"
    );
    let all = Telemetry { fields: ALL_FIELDS, ..longest };
    assert_eq!(
        write(all),
        line.replace(" display-short", " -524288.0 -512.0000 sensor-range -512.0000 display-short")
    );
}

#[test]
fn the_longest_status_of_a_board_fits_an_answer() {
    let status = BoardStatus {
        reset: "independent-watchdog",
        receive_overruns: u32::MAX,
        receive_framing_errors: u32::MAX,
        receive_noise: u32::MAX,
        telemetry_dropped: u32::MAX,
        unique_id: [0x0023_0041, 0x5132_5013, 0x2032_364e],
        program_digest: Some(0x0123_abcd),
        ..BoardStatus::default()
    };
    let answer = Reply::Board(status).to_string();
    assert!(answer.len() <= ANSWER_MAX_BYTES, "{answer}");
    assert!(answer.ends_with(" uid=00230041513250132032364E program=0123abcd"), "{answer}");
}

#[test]
fn every_identification_error_fits_an_answer() {
    let number = -123_456.789;
    for error in [
        IdentificationError::CurrentRatio(number),
        IdentificationError::NoResponse,
        IdentificationError::ModelMismatch(number),
        IdentificationError::OutOfRange(&thermal_settings::TILE_RANGES[1], number),
    ] {
        let answer = Error::Identification(error).to_string();
        assert!(answer.len() <= ANSWER_MAX_BYTES, "{answer}");
    }
}
