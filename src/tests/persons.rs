//! The lines about persons.

use std::format;
use std::string::String;

use thermal_learner::{Learner, LearnerOutput, PersonPrior, Restart, Trust};

use super::commissioning::Bench;
use super::device::samples;
use crate::commissioning::StorageOrder;
use crate::device::FingerIndex;
use crate::settings::decode_settings_record;

const SENSOR: &str = "flux set 0.1192 2048 5 30";
const DATA: &str = "00080000000400012020202040C0000000000200";

/// Steps two windows of a finger, in which the learner's answers are changed, and the first one is taken over. Returns what the
/// learner was told to begin with.
fn windows<const FINGERS: usize>(
    bench: &mut Bench<FINGERS>,
    finger: FingerIndex<FINGERS>,
    change: impl Fn(LearnerOutput) -> LearnerOutput,
) -> Option<Restart> {
    let mut begun = None;
    for tick in 0..20 {
        bench.device.note_flux_code(finger, Some(2048 + tick % 2));
        bench.device.step_finger(finger, &samples(tick % 2));
        if let Some(input) = bench.device.take_learner_input(finger) {
            begun = input.restart.or(begun);
            let output =
                LearnerOutput { revision: input.sequence, ..*Learner::new().advance(&input) };
            let output = change(output);
            bench.device.put_learner_output(finger, &output);
        }
    }
    begun
}

/// The finger was learnt from so many contacts.
fn learnt(contacts: u8) -> impl Fn(LearnerOutput) -> LearnerOutput {
    move |output| LearnerOutput { trust: Trust::Trusted, person: Some(record(contacts)), ..output }
}

/// A record that was learnt from so many contacts.
fn record(contacts: u8) -> PersonPrior {
    let mut bytes = [0x5a; 20];
    bytes[18] = contacts;
    PersonPrior(bytes)
}

#[test]
fn persons_are_stored_listed_and_forgotten() {
    let mut one = Bench::<1>::new();
    assert_eq!(one.send("persons"), "ok persons=none");
    for number in 0..16 {
        assert_eq!(one.send(&format!("person P{number} {DATA}")), "ok");
    }
    let full = format!("person Q {DATA}");
    assert_eq!(one.send(&full), "err 16 persons are stored; forget person CODE");
    assert_eq!(one.send(&format!("person P3 {DATA}")), "ok", "again");
    for missing in ["person Q", "forget person Q"] {
        let answer = "err no person Q is stored; persons lists those who are";
        assert_eq!(one.send(missing), answer);
    }
    assert_eq!(one.send("forget person P0"), "ok");
    assert_eq!(one.send(&full), "ok");
    let rest: String = (1..16).map(|number| format!("P{number},")).collect();
    assert_eq!(one.send("persons"), format!("ok persons={rest}Q"));
    // Without a heat-flux sensor nobody can be chosen.
    let refused = "err person needs a heat-flux sensor; flux set first";
    for line in ["person", "person Q", "person none", "person enrol Q"] {
        assert_eq!(one.send(line), refused, "{line}");
    }
}

#[test]
fn the_learner_begins_with_the_chosen_person() {
    let mut one = Bench::<1>::new();
    one.send(SENSOR);
    one.send(&format!("person P07 {DATA}"));
    let finger = FingerIndex::FIRST;
    let same = |output| output;
    let begun = windows(&mut one, finger, same).expect("a restart");
    assert_eq!((begun.person, one.send("person").as_str()), (None, "ok person=none contacts=0"));
    assert_eq!(one.send("person P07"), "ok");
    let chosen = format!("ok person=P07 contacts=0 data={DATA}");
    assert_eq!(one.send("person"), chosen);
    let begun = windows(&mut one, finger, same).expect("a restart");
    let bytes = begun.person.expect("a person").0;
    let digits: String = bytes.iter().map(|byte| format!("{byte:02X}")).collect();
    assert_eq!(digits, DATA);
    // A person who is forgotten or stored anew is another one from the next choice on only.
    one.send("forget person P07");
    assert_eq!(one.send("person"), chosen);
    for line in ["finger mean-on-pad", "contact 0.9 2e5 0", SENSOR, "person none"] {
        one.send(&format!("person P07 {DATA}"));
        one.send("person P07");
        assert_eq!(one.send(line), "ok", "{line}");
        assert_eq!(one.send("person"), "ok person=none contacts=0", "{line}");
        let begun = windows(&mut one, finger, same).expect("a restart");
        assert_eq!(begun.person, None, "{line}");
    }
    one.send("finger thesis");
    assert_eq!(
        one.send("person P07"),
        "err person needs another finger than the thesis's; finger mean first"
    );
}

#[test]
fn a_finger_is_enrolled_when_it_was_learnt_from_two_long_contacts() {
    let mut one = Bench::<1>::new();
    one.send(SENSOR);
    let finger = FingerIndex::FIRST;
    windows(&mut one, finger, |output| output);
    let refused = |contacts| {
        format!(
            "err enrol needs 2 contacts of 8 s, trusted, since the last choice of finger or person; there are {contacts}"
        )
    };
    assert_eq!(one.send("person enrol P07"), refused(0));
    windows(&mut one, finger, learnt(1));
    assert_eq!(one.send("person"), "ok person=none contacts=1");
    assert_eq!(one.send("person enrol P07"), refused(1));
    windows(&mut one, finger, learnt(2));
    assert_eq!(one.send("person"), "ok person=none contacts=2");
    let stored = format!("ok person=P07 contacts=2 data={}025A", "5A".repeat(18));
    assert_eq!(one.send("person enrol P07"), stored);
    assert_eq!(one.send("persons"), "ok persons=P07");
    // After a distrust nothing is known any more, and neither after another choice.
    let distrusted =
        |output| LearnerOutput { trust: Trust::Mean(thermal_learner::Distrust::Between), ..output };
    windows(&mut one, finger, distrusted);
    assert_eq!(one.send("person enrol P08"), refused(0));
    windows(&mut one, finger, learnt(2));
    assert_eq!(one.send("person"), "ok person=none contacts=2");
    assert_eq!(one.send("person P07"), "ok");
    assert_eq!(one.send("person enrol P08"), refused(0));
    assert_eq!(one.send("persons"), "ok persons=P07");
}

#[test]
fn each_finger_has_a_person_of_the_same_store() {
    let mut two = Bench::<2>::new();
    two.send(SENSOR);
    assert_eq!(two.send(&format!("@1 person P07 {DATA}")), "@1 ok");
    assert_eq!(two.send("@0 persons"), "@0 ok persons=P07");
    assert_eq!(two.send("@1 person P07"), "@1 ok");
    assert_eq!(two.send("@0 person"), "@0 ok person=none contacts=0");
    assert_eq!(two.send("@1 person"), format!("@1 ok person=P07 contacts=0 data={DATA}"));
    assert_eq!(two.send("person enrol P08"), "err finger (as @0) missing");
    assert_eq!(two.send("person P07"), "ok");
    // A question without a finger is answered by finger 0.
    let first = format!("@0 ok person=P07 contacts=0 data={DATA}");
    for question in ["person", "@0 person"] {
        assert_eq!(two.send(question), first, "{question}");
    }
}

#[test]
fn persons_are_chosen_and_enrolled_with_the_nominal_contact_law_only() {
    let mut one = Bench::<1>::new();
    one.send(SENSOR);
    one.send(&format!("person P07 {DATA}"));
    assert_eq!(one.send("contact 0.9 100000 20"), "ok");
    windows(&mut one, FingerIndex::FIRST, learnt(2));
    assert_eq!(one.send("person"), "ok person=none contacts=2");
    let refused = "err person needs contact nominal first; told is exponent=0.9000 hardness_pa=100000 gap_w_m2k=20.0";
    for line in ["person enrol P08", "person P07"] {
        assert_eq!(one.send(line), refused, "{line}");
    }
    assert_eq!(one.send("person none"), "ok");
    assert_eq!(one.send("contact nominal"), "ok");
    assert_eq!(one.send("person P07"), "ok");
    windows(&mut one, FingerIndex::FIRST, learnt(2));
    let enrolled = one.send("person enrol P08");
    assert!(enrolled.starts_with("ok person=P08 "), "{enrolled}");
}

#[test]
fn stored_persons_are_there_after_a_restart_and_gone_after_a_forget() {
    let mut two = Bench::<2>::new();
    two.send(&format!("person P07 {DATA}"));
    two.send(&format!("person P08 {DATA}"));
    assert_eq!(two.restarted().send("persons"), "ok persons=P07,P08");
    let record = two.handler.record_to_save_or_forget(StorageOrder::Forget);
    assert_eq!(decode_settings_record::<2>(&record), Ok(None));
}
