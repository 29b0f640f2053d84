//! Parameters of the contact. They are drawn apart from the others ([`draw_contact`](super::draw_contact)).

use super::Source::Estimate;
use super::entry::{Entry, entry, prefixed};
use super::tolerance::{between, factor, relative};
use crate::contact::ContactLaw;

/// Name of the part.
pub const PART: &str = "contact";

/// The thesis has one value of each and no spread; it finds that Eq. 6-8 underestimates the fall of the skin's temperature
/// below 3 kPa.
pub fn entries(contact: &mut ContactLaw) -> impl Iterator<Item = Entry<'_>> {
    let ContactLaw { gap_w_m2k, hardness_pa, exponent, area_factor } = contact;
    let all = [
        entry!(
            gap_w_m2k,
            "W/(m2 K)",
            "conductance of air and sweat in the gap, parallel to Eq. 6-8",
            between(0.0, 1000.0),
            (0.0, 1e5),
            Estimate(
                "none in thesis 6.1; 26 um of air, or sweat in part of the 60 um of a ridge's depth, have 1000"
            ),
        ),
        entry!(
            hardness_pa,
            "Pa",
            "microhardness of the skin in Eq. 6-8",
            factor(2.0),
            (1e3, 1e8),
            Estimate(
                "value of thesis 6.1; skin softens with moisture, and a factor of 2 is that of the resistance between people"
            ),
        ),
        entry!(
            exponent,
            "1",
            "exponent of pressure over microhardness in Eq. 6-8",
            between(0.85, 1.0),
            (0.3, 1.5),
            Estimate(
                "value of thesis 6.1, for metals that yield; 0.94 for elastic spots, and other correlations from 0.85 to 1, recalled"
            ),
        ),
        entry!(
            area_factor,
            "1",
            "factor on the contact area of section 6.4.2, on which the pressure acts",
            relative(0.2),
            (0.2, 5.0),
            Estimate(
                "area of thesis 6.4.2; size of fingertips between people, and where the edge of a contact is drawn"
            ),
        ),
    ];
    prefixed(PART, all)
}
