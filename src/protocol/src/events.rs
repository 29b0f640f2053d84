//! Arguments of the commands that choose what the device reports without being asked: `events`, `trigger-out`, and the fields
//! of `stream`.

use thermal_device::TelemetryFields;
use thermal_device::events::{DeviceEventKind, EventKinds};

use crate::Error;
use crate::arguments::{Words, table_entry_for_word_or_none, word_or_empty};
use crate::request::SWITCH_WORDS;

/// Argument of `trigger-out` that switches the output off.
pub const NO_EVENTS_WORD: &str = "none";

/// Reads `on` or `off`, the argument of this command.
#[inline(never)]
pub fn parse_switch(words: &mut Words<'_>, command: &'static str) -> Result<bool, Error> {
    let word = word_or_empty(words);
    let (_, on) = table_entry_for_word_or_none(&SWITCH_WORDS, word)
        .ok_or(Error::UnknownSwitch(command, word.into()))?;
    Ok(on)
}

/// Reads `none`, or kinds of events that are joined by commas. An edge at the trigger input is none of them.
pub fn parse_trigger_output(words: &mut Words<'_>) -> Result<EventKinds, Error> {
    let list = word_or_empty(words);
    let mut kinds = EventKinds::NONE;
    if list == NO_EVENTS_WORD {
        return Ok(kinds);
    }
    for word in list.split([',']) {
        let kind = table_entry_for_word_or_none(&DeviceEventKind::PROTOCOL_WORDS, word);
        match kind {
            Some((_, kind)) if kind != DeviceEventKind::Trigger => kinds = kinds.with(kind),
            _ => return Err(Error::UnknownEventKind(word.into())),
        }
    }
    Ok(kinds)
}

/// Reads the names of the chosen fields; the default ones if there is none.
pub fn parse_telemetry_fields(words: &mut Words<'_>) -> Result<TelemetryFields, Error> {
    let mut fields = TelemetryFields::NONE;
    for word in words {
        let index = TelemetryFields::NAMES.iter().position(|name| *name == word);
        fields = fields.with(index.ok_or(Error::UnknownTelemetryField(word.into()))?);
    }
    Ok(if fields == TelemetryFields::NONE { TelemetryFields::DEFAULT } else { fields })
}
