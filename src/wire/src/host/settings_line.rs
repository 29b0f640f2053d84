//! Lines of settings as the device reports them.

use std::fmt;
use std::format;
use std::str::FromStr;
use std::string::String;

use super::{Answer, Fields};
use crate::Request;
use crate::request::SessionRequest;
use crate::setting::Setting;

/// A line of settings, `set …`, as the device reports it; sent back, it restores them.
#[derive(Clone, Debug, PartialEq)]
pub struct SettingsLine {
    text: String,
    setting: Setting,
}

impl SettingsLine {
    /// What the line sets.
    pub const fn setting(&self) -> &Setting {
        &self.setting
    }
}

impl Answer for SettingsLine {
    const NONE: Option<(&'static str, &'static str)> = None;

    fn read(fields: &Fields<'_>) -> Option<Self> {
        fields.text().parse().ok()
    }
}

impl FromStr for SettingsLine {
    type Err = String;

    /// Reads a line as the device would.
    fn from_str(line: &str) -> Result<Self, String> {
        match Request::read(line) {
            Ok(Request::Session(SessionRequest::Set { setting })) => {
                Ok(Self { text: line.into(), setting })
            }
            Ok(_) => Err(format!("'{line}'; lines of settings begin with 'set'")),
            Err(error) => Err(format!("'{line}': {error}")),
        }
    }
}

impl fmt::Display for SettingsLine {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.text)
    }
}
