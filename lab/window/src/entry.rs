//! Entry of a number for each station, by keys alone.

use thermal_session::Response;

use crate::Key;

/// Most characters of a number.
const LENGTH_MAX: usize = 8;
/// Steps of the range for an arrow key.
const STEPS: f64 = 100.0;

/// Numbers that the participant enters, one for each station.
#[derive(Clone, Debug, PartialEq)]
pub struct NumberEntry {
    least: f64,
    most: f64,
    texts: Vec<String>,
    at: usize,
}

impl NumberEntry {
    /// Nothing is entered yet.
    pub fn new((least, most): (f64, f64), stations: usize) -> Self {
        Self { least, most, texts: vec![String::new(); stations], at: 0 }
    }

    /// The range.
    pub const fn range(&self) -> (f64, f64) {
        (self.least, self.most)
    }

    /// What is entered for each station.
    pub fn texts(&self) -> &[String] {
        &self.texts
    }

    /// The station that the keys are for.
    pub const fn station(&self) -> usize {
        self.at
    }

    /// Chooses the station that the keys are for.
    pub fn choose(&mut self, station: usize) {
        if station < self.texts.len() {
            self.at = station;
        }
    }

    /// The number of a station, if it is one of the range. A comma is what many keyboards have.
    pub fn value(&self, station: usize) -> Option<f64> {
        let text = self.texts.get(station)?.replace(',', ".");
        let value = text.parse::<f64>().ok()?;
        (self.least..=self.most).contains(&value).then_some(value)
    }

    /// Enters a number for a station, as with a slider.
    pub fn set(&mut self, station: usize, value: f64) {
        let digits = if self.most - self.least > 20.0 { 0 } else { 2 };
        if let Some(text) = self.texts.get_mut(station) {
            *text = format!("{:.digits$}", value.clamp(self.least, self.most));
        }
    }

    /// All numbers, if each is entered.
    pub fn response(&self) -> Option<Response> {
        let values = (0..self.texts.len()).map(|station| self.value(station));
        values.collect::<Option<_>>().map(Response::Numbers)
    }

    /// Takes a key; returns the response when the last number is confirmed and all are of the range.
    pub fn press(&mut self, key: Key) -> Option<Response> {
        let count = self.texts.len();
        let text = self.texts.get_mut(self.at)?;
        let full = text.len() >= LENGTH_MAX;
        match key {
            Key::Digit(digit) if !full => text.push(char::from(b'0' + digit.min(9))),
            Key::Point if !full && !text.contains('.') => text.push('.'),
            Key::Minus if text.is_empty() && self.least < 0.0 => text.push('-'),
            Key::Backspace => drop(text.pop()),
            Key::Up | Key::Down => {
                self.at = (self.at + if key == Key::Down { 1 } else { count - 1 }) % count;
            }
            Key::Tab => self.at = (self.at + 1) % count,
            Key::Left | Key::Right => {
                let step = (self.most - self.least) / STEPS;
                let middle = (self.least + self.most) / 2.0;
                let value = self.value(self.at).unwrap_or(middle);
                let value = value + if key == Key::Right { step } else { -step };
                self.set(self.at, value);
            }
            Key::Enter if self.value(self.at).is_some() => {
                if let Some(response) = self.response() {
                    return Some(response);
                }
                let missing = (0..count).find(|station| self.value(*station).is_none());
                self.at = missing.unwrap_or(self.at);
            }
            _ => {}
        }
        None
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn press(entry: &mut NumberEntry, keys: &[Key]) -> Option<Response> {
        keys.iter().filter_map(|key| entry.press(*key)).last()
    }

    #[test]
    fn numbers_are_entered_by_keys_one_for_each_station() {
        let mut entry = NumberEntry::new((0.0, 100.0), 2);
        assert_eq!(press(&mut entry, &[Key::Enter]), None);
        let keys = [Key::Digit(4), Key::Digit(2), Key::Enter];
        assert_eq!(press(&mut entry, &keys), None);
        assert_eq!(entry.station(), 1);
        let keys = [Key::Digit(7), Key::Point, Key::Digit(5), Key::Enter];
        assert_eq!(press(&mut entry, &keys), Some(Response::Numbers(vec![42.0, 7.5])));
    }

    #[test]
    fn a_number_out_of_the_range_is_not_taken() {
        let mut entry = NumberEntry::new((0.0, 10.0), 1);
        let keys = [Key::Digit(9), Key::Digit(9), Key::Enter];
        assert_eq!(press(&mut entry, &keys), None);
        let keys = [Key::Backspace, Key::Enter];
        assert_eq!(press(&mut entry, &keys), Some(Response::Numbers(vec![9.0])));
    }

    #[test]
    fn arrows_change_the_number_within_its_range() {
        let mut entry = NumberEntry::new((0.0, 100.0), 1);
        press(&mut entry, &[Key::Right; 60]);
        assert_eq!(entry.value(0), Some(100.0));
        press(&mut entry, &[Key::Left]);
        assert_eq!(entry.value(0), Some(99.0));
    }
}
