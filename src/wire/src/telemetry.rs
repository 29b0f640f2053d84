//! Fields of telemetry: one row each, from which every reader and writer of telemetry takes its own.

use core::fmt;

#[cfg(feature = "host")]
use thermal_device::StateName;
use thermal_device::TelemetryFields;
use thermal_device::command::FluxState;

use crate::LineBuffer;
#[cfg(feature = "host")]
use crate::host::{Column, Need};
use crate::kind::{Amperes, Count, Kind, Knowledge, Newtons, Temperature, WattsPerSquareMetre};

/// Word for a value that the device does not know.
pub const UNKNOWN_WORD: &str = "-";
/// Word in `state` for a tile that was identified or set.
pub const TUNED_WORD: &str = "tuned";
/// Word in `state` and telemetry for a tile that was never identified.
pub const UNTUNED_WORD: &str = "untuned";
/// Word in telemetry for a set-point that is limited.
pub const LIMITED_WORD: &str = "limited";

/// One finger's telemetry of a tick; `Display` writes it as a line to the host, without a line ending and in at most
/// 160 bytes: `T tick state`, the chosen ones of the fields, and a remark.
///
/// `tick` counts milliseconds since reset. `state` is the state of the finger's station. `-` stands for a quantity whose sensor
/// has failed, and for the set-point in a state without one. The remark is the fault that tripped the station, else `limited` if
/// the set-point was limited to its range, else `untuned` on a tile that was never identified, else `-`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TelemetryLine {
    /// Readings, set-point and current.
    pub telemetry: thermal_device::Telemetry,
    /// What the heat-flux sensor shows; `None` without one, and if the host has named no field of it.
    pub flux: Option<FluxState>,
}

/// Declares the fields from their rows, in groups by what a device needs to have for them. Those of `every` line are there if the
/// host names no field, the others only if it names them.
macro_rules! fields {
    (|$line:ident|
     every { $($every:tt)+ }
     flux_sensor { $($flux:tt)+ }
     $(since $capability:literal { $($since:tt)+ })*) => {
        /// Number of the fields that a line has if the host names none.
        pub(crate) const FIELDS_OF_EVERY_LINE: usize = fields!(@count $($every)+);
        /// The fields of the heat-flux sensor.
        pub const FLUX_FIELDS: TelemetryFields =
            TelemetryFields::of_first(fields!(@count $($every)+ $($flux)+)).without(DEFAULT_FIELDS);
        /// The capabilities of the groups, each with a comma before it, for the answer to `id`.
        macro_rules! capabilities_of_fields {
            () => { concat!($(",", $capability),*) };
        }
        fields!(@device |$line| $($every)+ $($flux)+ $($($since)+)*);
        #[cfg(feature = "host")]
        fields!(@host
            [Need::Nothing] { $($every)+ }
            [Need::FluxSensor] { $($flux)+ }
            $([Need::Capability($capability)] { $($since)+ })*
        );
    };
    (@count $($name:literal $column:ident: $kind:ty, $unit:literal, $what:literal = $value:expr;)+) => {
        [$($name),+].len()
    };
    (@device |$line:ident|
     $($name:literal $column:ident: $kind:ty, $unit:literal, $what:literal = $value:expr;)+) => {
        #[expect(non_camel_case_types, reason = "the columns' names")]
        enum Index { $($column,)+ }

        /// Names of the fields as `stream` takes them, in the order of a line.
        pub const NAMES: [&str; [$($name),+].len()] = [$($name),+];

        #[inline]
        fn write_fields(line: &mut LineBuffer, $line: &TelemetryLine) {
            $(if $line.telemetry.fields.contains(Index::$column as usize) {
                line.push_str_if_fits(" ");
                match $value {
                    Some(value) => <$kind>::write(line, value),
                    None => line.push_str_if_fits(UNKNOWN_WORD),
                }
            })+
        }
    };
    (@host $([$need:expr] {
        $($name:literal $column:ident: $kind:ty, $unit:literal, $what:literal = $value:expr;)+
    })+) => {
        /// A telemetry line as a host reads it; what the device does not know, or was not asked for, is `None`.
        #[derive(Clone, Copy, Debug, PartialEq)]
        pub struct Telemetry {
            /// Ticks of 1 ms since the device's reset.
            pub tick: u32,
            /// State of the device, with its fault if it is tripped.
            pub state: StateName,
            $($(#[doc = concat!($what, ".")]
            pub $column: Option<<$kind as Kind>::Host>,)+)+
            /// Whether the set-point was limited to its range.
            pub limited: bool,
            /// Whether the line says that the tile was never identified; a line that says `limited` does not tell.
            pub is_untuned: bool,
        }

        impl Telemetry {
            /// A line without fields and remark.
            pub const fn new(tick: u32, state: StateName) -> Self {
                Self { tick, state, $($($column: None,)+)+ limited: false, is_untuned: false }
            }

            /// Takes these fields from the front of `words`; `None` if one is missing or not of its kind.
            pub(crate) fn read_fields<'a>(
                &mut self,
                fields: TelemetryFields,
                words: &mut impl Iterator<Item = &'a str>,
            ) -> Option<()> {
                $($(if fields.contains(Index::$column as usize) {
                    let word = words.next()?;
                    if word != UNKNOWN_WORD {
                        self.$column = Some(<$kind>::read(word)?);
                    }
                })+)+
                Some(())
            }
        }

        /// The fields as columns of tables, in the order of a line.
        pub const COLUMNS: &[Column; NAMES.len()] = &[$($(Column {
            field: $name,
            name: stringify!($column),
            unit: $unit,
            description: $what,
            need: $need,
            form: <$kind as Kind>::FORM,
            value: |line| line.$column.map(<$kind>::value),
        },)+)+];
    };
}

// A row: name on the line, column of tables, kind, unit as BIDS writes it, what it is, and its value. A new field is
// appended after all others: to the last group, or as a group of its own, `since` the capability by which hosts know that firmware
// has it; the answer to `id` takes the word from there.
fields! {
    |line|
    every {
        "setpoint" setpoint_c: Temperature<5>, "degC", "Set-point of the display's surface" = line.telemetry.setpoint;
        "display" display_c: Temperature<4>, "degC", "Thermistor of the display" = line.telemetry.display;
        "sink" sink_c: Temperature<2>, "degC", "Thermistor of the heat sink" = line.telemetry.sink;
        "skin" skin_c: Temperature<2>, "degC", "Thermistor on the skin at the edge of the contact" = line.telemetry.skin;
        "room" room_c: Temperature<2>, "degC", "Thermistor of the room" = line.telemetry.room;
        "force" force_n: Newtons, "N", "Force of the finger" = line.telemetry.force;
        "demand" demand_a: Amperes<3>, "A", "Demanded current of the Peltier module; positive cools" = Some(line.telemetry.demand);
        "current" current_a: Amperes<3>, "A", "Magnitude of the measured current" = Some(line.telemetry.current);
        "evaluations" evaluations: Count, "", "Evaluations of erfcx since the device's reset" = Some(line.telemetry.evaluations);
    }
    flux_sensor {
        "flux" flux_w_m2: WattsPerSquareMetre, "W/m^2", "Heat flux out of the skin by the heat-flux sensor" = line.flux.and_then(|state| state.flux);
        "surface" surface_c: Temperature<4>, "degC", "Estimate of the display's surface under the finger" = line.flux.and_then(|state| state.surface);
        "finger" known: Knowledge, "", "What is known of the finger by its flux" = line.flux.map(|state| state.knowledge);
    }
    since "check" {
        "check" check_c: Temperature<4>, "degC", "Second thermistor of the display, which checks the first one" = line.telemetry.check;
    }
}

pub(crate) use capabilities_of_fields;

/// No field beside tick, state and remark.
pub const NO_FIELDS: TelemetryFields = TelemetryFields::NONE;
/// The fields of a line if the host names none.
pub const DEFAULT_FIELDS: TelemetryFields = TelemetryFields::of_first(FIELDS_OF_EVERY_LINE);
/// All fields.
pub const ALL_FIELDS: TelemetryFields = TelemetryFields::of_first(NAMES.len());

/// The chosen fields, or the default ones if there is none.
pub fn chosen_or_default(chosen: TelemetryFields) -> TelemetryFields {
    if chosen == NO_FIELDS { DEFAULT_FIELDS } else { chosen }
}

/// Place in a line of the field with this name.
pub fn place_of_field(name: &str) -> Option<usize> {
    NAMES.iter().position(|known| *known == name)
}

impl fmt::Display for TelemetryLine {
    #[inline]
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let mut line = LineBuffer::new();
        let telemetry = &self.telemetry;
        line.push_str_if_fits("T ");
        line.push_integer(telemetry.tick);
        line.push_str_if_fits(" ");
        line.push_str_if_fits(telemetry.state.name());
        write_fields(&mut line, self);
        line.push_str_if_fits(" ");
        line.push_str_if_fits(match telemetry.state.fault() {
            Some(fault) => fault.name(),
            None if telemetry.limited => LIMITED_WORD,
            None if !telemetry.is_tuned => UNTUNED_WORD,
            None => UNKNOWN_WORD,
        });
        line.fmt(f)
    }
}
