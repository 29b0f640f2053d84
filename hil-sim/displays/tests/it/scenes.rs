//! The scenes for which a display is computed.

use std::path::Path;

use earlier_displays::{NoSingleContact, SingleContact};
use thermal_sim::scene::Scene;

fn touch(forces: &str) -> Result<SingleContact, NoSingleContact> {
    let text = format!(
        "duration_s = 9.0\nskin_c = 33.0\nroom_c = 22.0\n[object]\nmaterial = \"abs\"\n{forces}"
    );
    SingleContact::of(&Scene::parse(&text, Path::new("test")).expect("a scene"))
}

#[test]
fn a_scene_of_one_contact_is_a_touch() {
    let touch = touch("[[force]]\nt_s = 2.0\nforce_n = 0.5\n[[force]]\nt_s = 7.0\nforce_n = 0.0\n")
        .expect("a touch");
    assert_eq!((touch.landing_s, touch.contact_s, touch.force_n), (2.0, 5.0, 0.5));
    assert_eq!((touch.skin_c, touch.object_c), (33.0, 22.0));
}

#[test]
fn a_scene_of_no_or_several_contacts_is_refused() {
    let landing = "[[force]]\nt_s = 2.0\nforce_n = 0.5\n";
    for forces in [
        "",
        "[[force]]\nt_s = 2.0\nforce_n = 0.0\n",
        "[[force]]\nt_s = 2.0\nforce_n = 0.5\nramp_s = 0.5\n",
        &format!("{landing}[[force]]\nt_s = 4.0\nforce_n = 1.0\n"),
        &format!(
            "{landing}[[force]]\nt_s = 4.0\nforce_n = 0.0\n[[force]]\nt_s = 6.0\nforce_n = 1.0\n"
        ),
    ] {
        assert_eq!(touch(forces).err(), Some(NoSingleContact), "{forces}");
    }
}
