//! Numbers that pages state and that are no results though they look like it: `docs/constants.toml`.

use std::collections::{BTreeMap, BTreeSet};

use crate::prose::{ResultInProse, results};

/// The word for each number of a page, and the beginning of an entry for those under a heading.
const ALL: &str = "all";
const SECTION: &str = "section: ";
/// The key of constants that any page may state.
const ANY_PAGE: &str = "any page";

/// Numbers, such as `20 mK`, by page and by the reason why they are constants.
#[derive(Debug, serde::Deserialize)]
#[serde(transparent)]
pub struct Constants(BTreeMap<String, BTreeMap<String, Vec<String>>>);

impl Constants {
    /// Reads the text of `docs/constants.toml`.
    ///
    /// # Errors
    /// The text is not a table of tables of lists.
    pub fn parse(text: &str) -> Result<Self, String> {
        toml::from_str(text).map_err(|error| error.to_string())
    }

    /// The results in the prose of pages, given by name and text, that are not listed; and the entries of the list that no page
    /// needs, as `page: reason: number`.
    pub fn unlisted(
        &self,
        pages: &[(String, String)],
    ) -> (Vec<(String, ResultInProse)>, Vec<String>) {
        let mut unlisted = Vec::new();
        let mut used = BTreeSet::new();
        for (page, text) in pages {
            for result in results(text) {
                match self.entry(page, &result) {
                    Some(entry) => _ = used.insert(entry),
                    None => unlisted.push((page.clone(), result)),
                }
            }
        }
        let unused = self.entries().filter(|entry| !used.contains(entry));
        let unused = unused.map(|(page, why, number)| format!("{page}: {why}: {number}"));
        (unlisted, unused.collect())
    }

    fn entries(&self) -> impl Iterator<Item = (&str, &str, &str)> {
        self.0.iter().flat_map(|(page, reasons)| {
            reasons.iter().flat_map(move |(why, numbers)| {
                numbers.iter().map(move |number| (page.as_str(), why.as_str(), number.as_str()))
            })
        })
    }

    /// The entry that allows a page to state a number.
    fn entry(&self, page: &str, result: &ResultInProse) -> Option<(&str, &str, &str)> {
        let is_listed = |listed: &str| {
            let section = listed.strip_prefix(SECTION);
            listed == result.number || listed == ALL || section == Some(result.section.as_str())
        };
        let of =
            |name: &str| self.entries().find(|(of, _, listed)| *of == name && is_listed(listed));
        of(page).or_else(|| of(ANY_PAGE))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn unlisted(list: &str) -> (usize, usize) {
        let list = Constants::parse(list).expect("a list");
        let pages = [
            ("a.md".to_owned(), "It is 3 mK.".to_owned()),
            ("b.md".to_owned(), "4 mK\n# B\n5 mK".to_owned()),
        ];
        let (unlisted, unused) = list.unlisted(&pages);
        (unlisted.len(), unused.len())
    }

    #[test]
    fn a_listed_number_is_a_constant_on_its_page_only() {
        assert_eq!(unlisted(""), (3, 0));
        assert_eq!(unlisted("[\"a.md\"]\nlimit = [\"3 mK\"]"), (2, 0));
        assert_eq!(unlisted("[\"a.md\"]\nlimit = [\"4 mK\"]"), (3, 1));
        assert_eq!(unlisted("[\"b.md\"]\ndesign = [\"all\"]"), (1, 0));
        assert_eq!(unlisted("[\"b.md\"]\ndesign = [\"section: B\"]"), (2, 0));
        assert_eq!(unlisted("[\"any page\"]\nlimit = [\"4 mK\"]"), (2, 0));
    }

    #[test]
    fn an_entry_that_no_page_needs_is_reported() {
        assert_eq!(unlisted("[\"c.md\"]\nlimit = [\"all\"]"), (3, 1));
        assert_eq!(unlisted("[\"any page\"]\nlimit = [\"6 mK\"]"), (3, 1));
    }
}
