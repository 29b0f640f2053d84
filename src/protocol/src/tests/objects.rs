//! The lines that describe finger and object: `finger`, `object slab`, and the upload of an object's relaxations.

use std::format;
use std::string::{String, ToString};
use std::vec::Vec;

use contact_model::fixed_point::{Body, BodyError, FAST_MAX, SLOW_MAX};
use contact_model::impedance::{Impedance, Relaxation};
use contact_model::material::{MATERIALS, Material, SKIN, Surface, find};
use contact_model::slab::{Back, Slab};
use proptest::prelude::*;
use thermal_device::command::{self, AssumedFinger, Command, ObjectBody, WithSourceFinger};
use thermal_device::{FingerIndex, TICK_S};
use thermal_settings::Settings;

use super::{command_of, refusal, work};
use crate::station_command::StationWork;
use crate::{ANSWER_MAX_BYTES, CommandHandler, Error, LINE_MAX_BYTES};

/// CRC-32 of ISO-HDLC bit by bit, as zip files, Ethernet and Python's `zlib.crc32` have it.
fn crc32(bytes: &[u8]) -> u32 {
    !bytes.iter().fold(u32::MAX, |crc, byte| {
        (0..8).fold(crc ^ u32::from(*byte), |crc, _| {
            (crc >> 1) ^ (0xedb8_8320 & 0u32.wrapping_sub(crc & 1))
        })
    })
}

#[test]
fn the_checksum_of_the_tests_has_its_published_check_value() {
    assert_eq!(crc32(b"123456789"), 0xcbf4_3926);
}

/// Lines before the commit, and the commit with their checksum.
fn with_commit(lines: &[String]) -> Vec<String> {
    let sent: String = lines.iter().flat_map(|line| [line, "\n"]).collect();
    let commit = format!("upload commit {:08x}", crc32(sent.as_bytes()));
    lines.iter().cloned().chain([commit]).collect()
}

/// The lines of an upload: direct term, mm² K/W, rates, 1/s, and gains, mm² K/J.
fn upload(direct: f64, rows: &[(f64, f64)]) -> Vec<String> {
    let begin = format!("upload begin object {} {direct}", rows.len());
    let rows = rows.iter().enumerate();
    let rows = rows.map(|(index, (rate, gain))| format!("upload row {index} {rate} {gain}"));
    with_commit(&[begin].into_iter().chain(rows).collect::<Vec<_>>())
}

/// The body of such an upload. The numbers of the tests are exact in the fixed point of the lines.
fn body(direct: f64, rows: &[(f64, f64)]) -> Result<Body, BodyError> {
    let row =
        |(rate_1_s, gain): &(f64, f64)| Relaxation { rate_1_s: *rate_1_s, gain_m2k_j: 1e-6 * gain };
    let relaxations: Vec<_> = rows.iter().map(row).collect();
    let impedance = Impedance { direct_m2k_w: 1e-6 * direct, relaxations: &relaxations };
    Body::new(&impedance, SKIN.effusivity(), TICK_S)
}

/// The object of such an upload.
fn uploaded(direct: f64, rows: &[(f64, f64)]) -> ObjectBody {
    ObjectBody::Upload(body(direct, rows).expect("a body"))
}

const ROWS: [(f64, f64); 3] = [(0.0, 87.5), (4.25, 175.0), (17.0, 350.5)];

/// A handler, the material that its stations present, and the bodies that they were given, each with its address.
struct Host<const FINGERS: usize> {
    handler: CommandHandler<FINGERS>,
    materials: [Option<Material>; FINGERS],
    bodies: Vec<(Option<usize>, ObjectBody)>,
}

impl<const FINGERS: usize> Host<FINGERS> {
    fn new(materials: [Option<Material>; FINGERS]) -> Self {
        Self { handler: CommandHandler::new(Settings::default()), materials, bodies: Vec::new() }
    }

    fn send(&mut self, line: &str) -> String {
        assert!(line.len() <= LINE_MAX_BYTES, "{line}");
        let (materials, bodies) = (&self.materials, &mut self.bodies);
        let answer = self.handler.answer(line, |finger, command| {
            let address = finger.map(FingerIndex::index_u8);
            let finger = finger.map(FingerIndex::index);
            let content = match command {
                Command::MaterialProperties => {
                    command::Reply::Material(materials[finger.expect("one finger")])
                }
                Command::Body(body) => {
                    bodies.push((finger, body));
                    command::Reply::Done
                }
                other => panic!("{line}: {other:?}"),
            };
            Ok(WithSourceFinger { finger: address, content })
        });
        let answer = answer.map_or_else(|error| error.to_string(), |reply| reply.to_string());
        assert!(answer.len() <= ANSWER_MAX_BYTES, "{answer}");
        answer
    }

    /// Sends lines that must be accepted.
    fn send_ok(&mut self, lines: &[String]) {
        for line in lines {
            assert_eq!(self.send(line), "ok", "{line}");
        }
    }

    /// Sends lines of which only the last one is refused; returns its answer.
    fn refused(&mut self, lines: &[&str]) -> String {
        let (last, before) = lines.split_last().expect("a line");
        self.send_ok(&before.iter().map(ToString::to_string).collect::<Vec<_>>());
        let answer = self.send(last);
        assert!(answer.starts_with("err "), "{last}: {answer}");
        answer
    }
}

fn one_finger() -> Host<1> {
    Host::new([None])
}

#[test]
fn finger_chooses_the_assumed_finger_or_asks_for_it() {
    for (line, finger) in [
        ("finger", None),
        ("finger mean", Some(AssumedFinger::Mean)),
        ("finger mean-on-pad", Some(AssumedFinger::MeanOnPad)),
        ("finger thesis", Some(AssumedFinger::Thesis)),
    ] {
        assert_eq!(command_of(line), Command::Finger(finger), "{line}");
    }
    assert_eq!(
        refusal("finger thumb"),
        "err unknown finger 'thumb'; known: mean mean-on-pad thesis"
    );
    assert_eq!(refusal("finger mean thesis"), "err unexpected 'thesis' after the command");
}

#[test]
fn a_slab_is_a_thickness_and_what_is_behind_it() {
    let slab = |thickness_mm, back| (thickness_mm, back);
    for (line, expected) in [
        ("object slab 3mm insulated", slab(3.0, Back::Insulated)),
        ("object slab 3 mm insulated", slab(3.0, Back::Insulated)),
        ("object slab 3 insulated", slab(3.0, Back::Insulated)),
        (" object  slab  0.5mm  held ", slab(0.5, Back::Held)),
        ("object slab 1000 mm film 12.5", slab(1000.0, Back::Film(12.5))),
        ("object slab 4 film 100000", slab(4.0, Back::Film(1e5))),
    ] {
        let Ok(StationWork::Slab(thickness_mm, back)) = work(line) else { panic!("{line}") };
        assert_eq!((thickness_mm, back), expected, "{line}");
    }
    for (line, answer) in [
        ("object slab", "err thickness missing; 0.1 to 1000 mm"),
        ("object slab mm", "err thickness 'mm' is not a decimal number; 0.1 to 1000 mm"),
        ("object slab 3", "err back missing; known: insulated held film"),
        ("object slab 3mm", "err back missing; known: insulated held film"),
        ("object slab 3 mm", "err back missing; known: insulated held film"),
        ("object slab 3mm film", "err film missing; 0.1 to 100000 W/m2K"),
        ("object slab 3cm held", "err thickness '3cm' is not a decimal number; 0.1 to 1000 mm"),
        (
            "object slab insulated",
            "err thickness 'insulated' is not a decimal number; 0.1 to 1000 mm",
        ),
        ("object slab 0.09mm held", "err thickness '0.09' out of range; 0.1 to 1000 mm"),
        ("object slab 1001 held", "err thickness '1001' out of range; 0.1 to 1000 mm"),
        ("object slab 3mm mm held", "err unknown back 'mm'; known: insulated held film"),
        ("object slab 3mm open", "err unknown back 'open'; known: insulated held film"),
        ("object slab 3mm film 0", "err film '0' out of range; 0.1 to 100000 W/m2K"),
        ("object slab 3mm film -5", "err film '-5' out of range; 0.1 to 100000 W/m2K"),
        ("object slab 3mm held 5", "err unexpected '5' after the command"),
        ("object half-space 3", "err unexpected '3' after the command"),
    ] {
        assert_eq!(refusal(line), answer, "{line}");
    }
}

#[test]
fn a_slab_is_of_the_material_that_its_finger_presents() {
    let [copper, bronze] = ["copper", "bronze"].map(|name| *find(name).expect(name));
    let slab_of = |material: &Material| {
        let slab = Slab {
            thickness_m: 1e-3 * 3.0,
            conductivity_w_mk: material.surface.conductivity_w_mk,
            capacity_j_m3k: material.volumetric_heat_j_m3k(),
            back: Back::Held,
        };
        let (relaxations, tick_s) = (slab.relaxations(), TICK_S);
        let body = Body::new(&relaxations.impedance(), SKIN.effusivity(), tick_s);
        ObjectBody::Slab(body.expect("a body"))
    };
    let line = "object slab 3mm held";
    assert_eq!(one_finger().send(line), "err a slab needs a material first");
    let mut host = Host::new([Some(copper), Some(copper), Some(bronze)]);
    assert_eq!(host.send(&format!("@1 {line}")), "@1 ok");
    assert_eq!(host.send(&format!("@2 {line}")), "@2 ok");
    // Slabs of two materials are two bodies.
    assert_eq!(host.send(line), "err finger (as @0) missing");
    assert_eq!(host.bodies, [(Some(1), slab_of(&copper)), (Some(2), slab_of(&bronze))]);
    host.materials[2] = None;
    assert_eq!(host.send(line), "err a slab needs a material first");
    host.materials[2] = Some(copper);
    assert_eq!(host.send(line), "ok");
    assert_eq!(host.bodies.last(), Some(&(None, slab_of(&copper))));
}

#[test]
fn slabs_of_the_known_and_three_custom_materials_are_accepted() {
    let mut host = one_finger();
    // Heat spreads in them as fast as in the thesis's materials, faster, and more slowly.
    let custom = |(name, k, rho, c)| {
        let surface = Surface { conductivity_w_mk: k, ..SKIN.surface };
        (name, Material { surface, density_kg_m3: rho, specific_heat_j_kgk: c })
    };
    let custom = [
        ("diamond", 2000.0, 3500.0, 500.0),
        ("cork", 0.045, 150.0, 1800.0),
        ("rubber", 0.1, 1500.0, 2500.0),
    ]
    .map(custom);
    for (name, material) in MATERIALS.into_iter().chain(custom) {
        host.materials = [Some(material)];
        for thickness in
            ["0.1", "0.3", "1", "3", "10", "20", "30", "50", "70", "100", "200", "1000"]
        {
            for back in ["insulated", "held", "film 0.1", "film 100", "film 100000"] {
                let line = format!("object slab {thickness} {back}");
                assert_eq!(host.send(&line), "ok", "{name}: {line}");
            }
        }
    }
    // No contact feels the back of a metre of cork or rubber, so it is a half-space.
    assert_eq!(host.bodies.last(), Some(&(None, ObjectBody::HalfSpace)));
}

#[test]
fn an_upload_makes_the_object_what_its_rows_say() {
    let mut host = one_finger();
    host.send_ok(&upload(12.5, &ROWS));
    assert_eq!(host.bodies, [(None, uploaded(12.5, &ROWS))]);
    // The checksum by `zlib.crc32` of Python, and in capital letters.
    host.send_ok(&[
        "upload begin object 1 0.5".into(),
        "upload row 0 2 40".into(),
        "upload commit 21A54DDA".into(),
    ]);
    assert_eq!(host.bodies[1..], [(None, uploaded(0.5, &[(2.0, 40.0)]))]);
    // Without a row the object is a thermal resistance.
    host.send_ok(&upload(5000.0, &[]));
    assert_eq!(host.bodies[2..], [(None, uploaded(5000.0, &[]))]);
    let most: Vec<_> =
        (0..FAST_MAX + SLOW_MAX).map(|i| (if i < FAST_MAX { 690.0 } else { 0.0 }, 1.0)).collect();
    host.send_ok(&upload(0.0, &most));
    assert_eq!(host.bodies[3..], [(None, uploaded(0.0, &most))]);
}

#[test]
fn an_upload_is_for_the_address_that_began_it() {
    let mut host = Host::<3>::new([None; 3]);
    let lines = upload(12.5, &ROWS);
    for address in ["@1 ", ""] {
        for line in &lines {
            let answer = host.send(&format!("{address}{line}"));
            assert_eq!(answer, format!("{address}ok"));
        }
    }
    let object = uploaded(12.5, &ROWS);
    assert_eq!(host.bodies, [(Some(1), object), (None, object)]);
    // The only finger may be named or not.
    let mut host = one_finger();
    for (line, address) in lines.iter().zip(["@0 ", "", "@0 ", "@0 ", ""]) {
        let answer = host.send(&format!("{address}{line}"));
        assert_eq!(answer, format!("{address}ok"));
    }
    assert_eq!(host.bodies.len(), 1);
}

#[test]
fn rows_and_commits_of_other_addresses_do_not_reach_an_upload() {
    let lines = upload(12.5, &ROWS);
    for (address, others, whose) in
        [("@1 ", ["@0 ", "@2 ", ""], "@1"), ("", ["@0 ", "@1 ", "@2 "], "all fingers")]
    {
        let mut host = Host::<3>::new([None; 3]);
        for line in &lines {
            for other in others.iter().filter(|_| !line.contains("begin")) {
                let refused = format!(
                    "{other}err the open upload is that of {whose}; upload begin starts another"
                );
                assert_eq!(host.send(&format!("{other}{line}")), refused);
            }
            assert_eq!(host.send(&format!("{address}{line}")), format!("{address}ok"));
        }
        assert_eq!(host.bodies.len(), 1);
        // No address can keep the others from uploading.
        host.send(&format!("{address}{}", lines[0]));
        for line in &lines {
            assert_eq!(host.send(&format!("{}{line}", others[0])), format!("{}ok", others[0]));
        }
        assert_eq!(host.bodies[1..], [(Some(0), uploaded(12.5, &ROWS))]);
    }
}

#[test]
fn an_error_before_the_commit_leaves_the_upload_as_it_was() {
    let mut host = one_finger();
    let lines = upload(12.5, &ROWS);
    let (commit, rows) = lines.split_last().expect("a commit");
    for (line, answers) in rows.iter().zip([
        &[
            ("upload", "err begin, row or commit missing"),
            ("upload end", "err unknown upload 'end'; known: begin row commit"),
            ("upload row 1 2 3", "err not the next row, which is 0"),
        ][..],
        &[
            ("upload row", "err row missing; 0 to 21"),
            ("upload row 1", "err rate missing; 0 to 690 1/s"),
            ("upload row 1 1", "err gain missing; 0.000001 to 13000000 mm2K/J"),
            ("upload row 1 1 1 1", "err unexpected '1' after the command"),
            ("upload row 0 1 1", "err not the next row, which is 1"),
            ("upload row 2 1 1", "err not the next row, which is 1"),
            ("upload row 1.5 1 1", "err row '1.5' out of range; 0 to 21"),
            ("upload row 22 1 1", "err row '22' out of range; 0 to 21"),
            ("upload row 1 -1 1", "err rate '-1' out of range; 0 to 690 1/s"),
            ("upload row 1 690.1 1", "err rate '690.1' out of range; 0 to 690 1/s"),
            ("upload row 1 1 0", "err gain '0' out of range; 0.000001 to 13000000 mm2K/J"),
            ("upload row 1 x 1", "err rate 'x' is not a decimal number; 0 to 690 1/s"),
            ("uplaod row 1 1 1", "err unknown command 'uplaod'; known: "),
        ],
        &[
            ("upload commit", "err checksum missing"),
            ("upload commit 12345678 9", "err unexpected '9' after the command"),
        ],
        &[("upload row 3 1 1", "err not the next row, which is 3")],
    ]) {
        assert_eq!(host.send(line), "ok", "{line}");
        for (wrong, answer) in answers {
            let refused = host.send(wrong);
            assert!(refused.starts_with(answer.trim_end()), "{wrong}: {refused}");
        }
    }
    assert_eq!(host.bodies, []);
    assert_eq!(host.send(commit), "ok");
    assert_eq!(host.bodies, [(None, uploaded(12.5, &ROWS))]);
}

#[test]
fn begin_says_what_is_uploaded() {
    for (line, answer) in [
        ("upload begin", "err kind of upload missing"),
        ("upload begin finger 1 0", "err unknown kind of upload 'finger'; known: object course"),
        ("upload begin object", "err number of rows missing; 0 to 22"),
        ("upload begin object 1", "err direct missing; 0 to 27000 mm2K/W"),
        ("upload begin object 23 0", "err number of rows '23' out of range; 0 to 22"),
        ("upload begin object -1 0", "err number of rows '-1' out of range; 0 to 22"),
        ("upload begin object 1 -1", "err direct '-1' out of range; 0 to 27000 mm2K/W"),
        ("upload begin object 1 27001", "err direct '27001' out of range; 0 to 27000 mm2K/W"),
        ("upload begin object 1 1 1", "err unexpected '1' after the command"),
    ] {
        let mut host = one_finger();
        assert_eq!(host.send(line).trim_end(), answer.trim_end());
        let none = "err no upload has begun; upload begin object COUNT DIRECT first";
        assert_eq!(host.send("upload row 0 1 1"), none);
        assert_eq!(host.send("upload commit 00000000"), none);
        // An upload that was under way is given up, too.
        let mut host = one_finger();
        host.refused(&["upload begin object 1 0", line]);
        assert_eq!(host.send("upload row 0 1 1"), none);
    }
}

#[test]
fn a_second_begin_starts_again() {
    let mut host = one_finger();
    let (first, second) = (upload(1.0, &ROWS), upload(12.5, &ROWS[..2]));
    host.send_ok(&first[..3]);
    host.send_ok(&second);
    assert_eq!(host.bodies, [(None, uploaded(12.5, &ROWS[..2]))]);
}

#[test]
fn a_refused_commit_changes_nothing_and_ends_the_upload() {
    let lines = upload(12.5, &ROWS);
    let (commit, rows) = lines.split_last().expect("a commit");
    let digits = commit.rsplit(' ').next().expect("a checksum");
    let wrong = "00000000";
    let not_a_checksum =
        "err checksum must have 8 hexadecimal digits; nothing is changed, upload again";
    for (sent, commit, answer) in [
        (
            4,
            format!("upload commit {wrong}"),
            format!("err checksum is {digits}; nothing is changed, upload again"),
        ),
        (3, commit.clone(), "err 2 of 3 rows; nothing is changed, upload again".into()),
        (4, format!("upload commit 0{digits}"), not_a_checksum.into()),
        (4, format!("upload commit {}", &digits[1..]), not_a_checksum.into()),
        (4, "upload commit 0x123456".into(), not_a_checksum.into()),
        (4, "upload commit +1234567".into(), not_a_checksum.into()),
        (4, "upload commit -1234567".into(), not_a_checksum.into()),
    ] {
        let mut host = one_finger();
        host.send_ok(&rows[..sent]);
        assert_eq!(host.send(&commit), answer);
        assert_eq!(host.bodies, []);
        let again = host.send(&commit);
        assert!(again.starts_with("err no upload has begun"), "{again}");
        host.send_ok(&lines);
        assert_eq!(host.bodies, [(None, uploaded(12.5, &ROWS))]);
    }
}

#[test]
fn an_object_that_cannot_be_followed_is_refused_at_the_commit() {
    for (direct, rows, reason) in [
        (
            0.0,
            &[(100.0, 1.0); FAST_MAX + 1][..],
            "9 rates of 12.5 1/s or more; at most 8 are allowed",
        ),
        (0.0, &[(1.0, 1.0); SLOW_MAX + 1], "15 rates below 12.5 1/s; at most 14 are allowed"),
        (
            0.0,
            &[(1.0, 6.5e6), (0.0, 8_000_000.25)],
            "gain 8000000.25 mm2K/J of relaxation 1; above 0 to 7341086 is allowed at its rate beside those before it",
        ),
        (
            0.0,
            &[(13.0, 9_000_000.5)],
            "gain 9000000.5 mm2K/J of relaxation 0; above 0 to 5621621 is allowed at its rate beside those before it",
        ),
    ] {
        let mut host = one_finger();
        let lines = upload(direct, rows);
        let lines: Vec<_> = lines.iter().map(String::as_str).collect();
        assert_eq!(host.refused(&lines), format!("err {reason}"));
        assert_eq!(host.bodies, []);
        let error = body(direct, rows).expect_err(reason);
        assert_eq!(Error::Body(error).to_string(), format!("err {reason}"));
    }
}

/// What happens to one line of an upload on its way.
#[derive(Clone, Debug)]
enum Damage {
    Lost,
    Twice,
    CutAfter(usize),
    Byte(usize, u8),
}

fn damage() -> impl Strategy<Value = Damage> {
    prop_oneof![
        Just(Damage::Lost),
        Just(Damage::Twice),
        any::<usize>().prop_map(Damage::CutAfter),
        (any::<usize>(), b' '..=b'~').prop_map(|(place, byte)| Damage::Byte(place, byte)),
    ]
}

proptest! {
    /// The object changes if and only if all lines arrived as they were sent, and the commit with all of its digits.
    #[test]
    fn a_damaged_upload_leaves_the_object_as_it_was(
        rows in prop::collection::vec((0u16..690, 1u16..1000), 0..6),
        damages in prop::collection::vec((any::<prop::sample::Index>(), damage()), 0..3),
        sent in any::<prop::sample::Index>(),
        ends_early in any::<bool>(),
    ) {
        let rows: Vec<_> = rows.iter().map(|(rate, gain)| (f64::from(*rate), f64::from(*gain))).collect();
        let lines = upload(12.5, &rows);
        let mut arrived = lines.clone();
        for (index, damage) in damages {
            if arrived.is_empty() {
                break;
            }
            let index = index.index(arrived.len());
            let line = &mut arrived[index];
            match damage {
                Damage::Lost => { arrived.remove(index); }
                Damage::Twice => {
                    let line = line.clone();
                    arrived.insert(index, line);
                }
                Damage::CutAfter(bytes) => line.truncate(bytes % (line.len() + 1)),
                Damage::Byte(..) if line.is_empty() => {}
                Damage::Byte(place, byte) => {
                    let place = place % line.len();
                    line.replace_range(place..=place, &char::from(byte).to_string());
                }
            }
        }
        if ends_early {
            arrived.truncate(sent.index(lines.len()));
        }
        let mut host = one_finger();
        let taken: Vec<_> = arrived.iter().filter(|line| host.send(line) == "ok").collect();
        if host.bodies.is_empty() {
            prop_assert!(ends_early || arrived != lines || body(12.5, &rows).is_err());
        } else {
            prop_assert_eq!(&host.bodies, &[(None, uploaded(12.5, &rows))]);
            let (commit, before) = taken.split_last().expect("a commit");
            // Lines before the last `upload begin` belong to an upload that was given up.
            let begin = before.iter().rposition(|line| line.contains("begin")).expect("a beginning");
            // A row that comes twice is accepted twice, and counts once.
            let mut counted = before[begin..].to_vec();
            counted.dedup_by_key(|line| line.split_ascii_whitespace().nth(2).map(String::from));
            prop_assert_eq!(counted, lines[..lines.len() - 1].iter().collect::<Vec<_>>());
            let words = |line: &String| line.to_ascii_lowercase().split_ascii_whitespace().map(String::from).collect::<Vec<_>>();
            prop_assert_eq!(words(commit), words(&lines[lines.len() - 1]));
        }
    }

    #[test]
    fn no_line_of_an_upload_panics(lines in prop::collection::vec(
        prop_oneof![
            (any::<i8>(), any::<i32>()).prop_map(|(count, direct)| format!("upload begin object {count} {direct}")),
            (0..24, any::<u16>(), any::<u32>()).prop_map(|(i, rate, gain)| format!("upload row {i} {} {gain}", f64::from(rate) / 90.0)),
            any::<u32>().prop_map(|crc| format!("upload commit {crc:x}")),
            "upload (begin|row|commit|object|[0-9a-f .-]){0,5}",
            "object slab [0-9.-]{0,5}(mm| mm)? (insulated|held|film) ?[0-9.-]{0,4}",
        ],
        1..20,
    )) {
        let mut host = Host::new([find("copper").copied()]);
        for line in lines {
            host.send(&line);
        }
    }
}
