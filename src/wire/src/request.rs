//! Requests of a host: one row for each form of a line, from which the device's reader and the clients' writers are made.

use core::fmt;
use core::iter;

use contact_model::slab::Back;
use thermal_device::TelemetryFields;
use thermal_device::command::AssumedFinger;
use thermal_device::control::Law;
use thermal_device::events::EventKinds;
use thermal_device::reference::ContactModel;
use thermal_device::safety::ThermistorId;
use thermal_device::stimulus::PlayOrder;
use thermal_settings::{DisplaySurface, FluxSensor, PersonCode};

use crate::ReadError;
#[cfg(feature = "host")]
use crate::answer::*;
use crate::argument::{Argument, PersonData, Switch};
#[cfg(feature = "host")]
use crate::host::{Command, NamedArgument, RequestForm, SettingsLine};
use crate::number::{Number, Whole};
use crate::quantity::*;
use crate::setting::{Setting, SettingNumber};
use crate::special_arguments::{MaterialName, Millimetres, PointOrClear};
use crate::words::{Words, expect_end, read_word, word_or_empty};

/// Words with which a line of a form begins, separated by spaces, and whether arguments follow.
struct Form {
    words: &'static str,
    has_arguments: bool,
}

impl Form {
    /// The first word, and the second one if there are two.
    fn first_two_words(&self) -> (&'static str, Option<&'static str>) {
        let mut words = self.words.split_ascii_whitespace();
        (words.next().unwrap_or_default(), words.next())
    }
}

/// Declares the type of a query, whose answer has values.
#[cfg(feature = "host")]
macro_rules! query {
    ([$($doc:tt)+] [] $requests:ident::$request:ident { $($arguments:tt)* }) => {};
    ([$($doc:tt)+] [$query:ident -> $answer:ty] $requests:ident::$request:ident {}) => {
        $($doc)+
        #[derive(Clone, Copy, Debug, PartialEq)]
        pub struct $query;

        query!(@query $query, $answer, |_query| $requests::$request);
    };
    ([$($doc:tt)+] [$query:ident -> $answer:ty] $requests:ident::$request:ident {
        $($argument:ident: $kind:ty),+
    }) => {
        $($doc)+
        #[derive(Clone, Copy, Debug, PartialEq)]
        #[allow(missing_docs, reason = "name and type say it")]
        pub struct $query { $(pub $argument: $kind),+ }

        query!(@query $query, $answer, |query| $requests::$request {
            $($argument: query.$argument),+
        });
    };
    (@query $query:ident, $answer:ty, |$from:ident| $request:expr) => {
        impl fmt::Display for $query {
            fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
                let $from = self;
                $request.fmt(f)
            }
        }

        impl Command for $query {
            type Answer = $answer;
        }
    };
}

/// Declares requests from their rows: the words of the line, the name of the request, its arguments, and if it is answered with
/// values, the name of the query and what answers it. Who executes a request is its group.
macro_rules! requests {
    ($(
        $(#[$group_doc:meta])+
        $group:ident($requests:ident) {$(
            $(#[doc = $doc:literal])+
            $($word:literal)+ => $request:ident $({ $($argument:ident: $kind:ty),+ $(,)? })?
                $([$query:ident -> $answer:ty])?;
        )+}
    )+) => {
        $(
            $(#[$group_doc])+
            #[derive(Clone, Debug, PartialEq)]
            pub enum $requests {$(
                $(#[doc = $doc])+
                #[allow(missing_docs, reason = "name and type say it")]
                $request $({ $($argument: $kind),+ })?,
            )+}

            /// Writes the line without the address of a finger.
            impl fmt::Display for $requests {
                fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
                    match self {$(
                        Self::$request $({ $($argument),+ })? => {
                            write_words(f, &[$($word),+])?;
                            $($($argument.write(f)?;)+)?
                            Ok(())
                        }
                    )+}
                }
            }
        )+

        $(
            #[cfg(feature = "host")]
            impl Command for $requests {
                type Answer = ();
            }
        )+

        /// A line from the host: its words and arguments, which are within their ranges.
        #[derive(Clone, Debug, PartialEq)]
        pub enum Request {
            $($(#[$group_doc])+ $group($requests),)+
            /// A line `upload`, whose arguments depend on the upload so far.
            Upload,
        }

        enum Place { $($($request,)+)+ }

        const FORMS: &[Form] = &[$($(Form {
            words: concat!($($word, " "),+),
            has_arguments: [$($(has_argument(stringify!($argument)),)+)? false][0],
        },)+)+];

        /// All forms of a line but those of an upload, in the order of the table.
        #[cfg(feature = "host")]
        pub const TABLE: &[RequestForm] = &[$($(RequestForm {
            words: concat!($($word, " "),+),
            effect: &[$($doc),+],
            answer: [$(Some(stringify!($answer)),)? None][0],
            arguments: &[$($(NamedArgument {
                name: stringify!($argument),
                form: <$kind as Argument>::form,
            }),+)?],
        },)+)+];

        $($(
            #[cfg(feature = "host")]
            query! {
                [$(#[doc = $doc])+] [$($query -> $answer)?]
                $requests::$request { $($($argument: $kind),+)? }
            }
        )+)+

        fn read_arguments(place: usize, words: &mut Words<'_>) -> Result<Request, ReadError> {
            $($(if place == Place::$request as usize {
                return Ok(Request::$group($requests::$request $({
                    $($argument: <$kind>::read(words)?),+
                })?));
            })+)+
            Ok(Request::Upload)
        }
    };
}

const fn has_argument(_name: &str) -> bool {
    true
}

fn write_words(f: &mut fmt::Formatter<'_>, words: &[&str]) -> fmt::Result {
    let mut separator = "";
    words.iter().try_for_each(|word| {
        f.write_str(separator)?;
        separator = " ";
        f.write_str(word)
    })
}

requests! {
    /// Requests that the device as a whole answers.
    Device(DeviceRequest) {
        /// Name and version of the firmware, number of fingers, rates, version and capabilities of the protocol.
        "id" => Identify [QueryIdentity -> Identity];
        /// State of microcontroller and serial line.
        "board" => Board [QueryBoard -> BoardReport];
        /// Whether lines end with a checksum from now on.
        "checksum" => Checksum { switch: Switch };
        /// Restart, and store the present settings of all fingers.
        "save" => Save;
        /// Restart, and store the factory defaults.
        "forget" => ForgetAll;
    }
    /// Requests that the stations (the control) of the addressed fingers execute.
    Station(StationRequest) {
        /// State, object and set-point.
        "state" => State [QueryState -> Status];
        /// Telemetry at this interval, with these fields; an interval of 0 ends it.
        "stream" => Stream { interval_ms: Number<StreamInterval>, fields: TelemetryFields };
        /// Report events, or none.
        "events" => Events { switch: Switch };
        /// Length of a pulse at the trigger output.
        "trigger-out" "pulse" => QueryTriggerPulse [QueryTriggerPulse -> TriggerPulseReport];
        /// Length of each pulse at the trigger output from now on.
        "trigger-out" "pulse" => TriggerPulse { pulse_ms: Whole<PulseLength> };
        /// Mark these events at the trigger output.
        "trigger-out" => TriggerOutput { kinds: EventKinds };

        /// The object's material by its properties.
        "material" "custom" => CustomMaterial {
            conductivity_w_mk: Number<Conductivity>,
            density_kg_m3: Number<Density>,
            specific_heat_j_kgk: Number<SpecificHeat>,
            roughness_um: Number<Roughness>,
            slope_rad: Number<Slope>,
        };
        /// The object's material by its name.
        "material" => Material { name: MaterialName };
        /// The object has the room's temperature before contact.
        "object" "room" => ObjectAtRoomTemperature;
        /// The object is an endless block of its material.
        "object" "half-space" => HalfSpace;
        /// The object is a slab of its material.
        "object" "slab" => Slab { thickness_mm: Millimetres, back: Back };
        /// Temperature of the object before contact.
        "object" => ObjectAtTemperature { celsius: Number<ObjectTemperature> };
        /// The finger that is assumed for the one that touches.
        "finger" => QueryFinger [QueryAssumedFinger -> FingerReport];
        /// Assume this finger for the one that touches.
        "finger" => Finger { finger: AssumedFinger };
        /// The contact law in use.
        "contact" => QueryContactLaw [QueryContactLaw -> ContactLawReport];
        /// Take Eq. 6-8 for the finger's contact law.
        "contact" "nominal" => NominalContactLaw;
        /// Take this for the finger's contact law.
        "contact" => ContactLaw {
            exponent: Number<Exponent>,
            hardness_pa: Number<Microhardness>,
            gap_w_m2k: Number<Gap>,
        };
        /// Contact model of the set-point: with contact resistance, or for perfect contact.
        "mode" => Mode { model: ContactModel };
        /// The control law in use.
        "law" => QueryLaw [QueryLaw -> LawReport];
        /// Choose the control law.
        "law" => Law { law: Law };

        /// Run the self-test if it has not been passed, then drive the display to skin temperature.
        "arm" => Arm;
        /// Move the set-point to this temperature, at this rate or at 1 K/s, and hold it.
        "hold" => Hold { celsius: Number<Temperature>, rate_k_s: Option<Number<Rate>> };
        /// Play the loaded course.
        "play" => Play { order: PlayOrder };
        /// Load and play a course of four points: base, target, target, base.
        "pulse" => Pulse {
            base_c: Number<Temperature>,
            target_c: Number<Temperature>,
            rise_k_s: Number<Rate>,
            hold_s: Number<Seconds>,
            return_k_s: Number<Rate>,
            order: Option<PlayOrder>,
        };
        /// Set-points assume the skin of the sensor.
        "skin" "sensor" => SkinOfSensor;
        /// Set-points assume this temperature of the skin before contact.
        "skin" => AssumedSkin { celsius: Number<Skin> };
        /// Present the object.
        "start" => Start;
        /// Switch the bridge off.
        "abort" => Abort;
        /// Clear a fault that is no longer present.
        "clear" => Clear;

        /// Why the device tripped, now or the last time.
        "cause" => Cause [QueryCause -> Option<Cause>];
        /// What the last self-test measured.
        "self-test" => SelfTest [QuerySelfTest -> SelfTestReport];
        /// The converter's counts and the fault inputs in the last tick.
        "raw" => Raw [QueryRaw -> RawReadings];
        /// Begin to identify the tile.
        "tune" => Tune;
    }
    /// Requests that the commissioning sessions of the addressed fingers execute: a session is a finger's settings and calibration
    /// points.
    Session(SessionRequest) {
        /// Add a calibration point: the mean of the thermistor's converter sums over half a second, and the temperature that the
        /// reference thermometer shows at it. The calibration that fits all points is used from then on. Or clear the
        /// thermistor's points and correction; if the corrections of both display thermistors are zero then, the converter's
        /// steps are set to zero, too.
        "calibrate" => Calibrate { thermistor: ThermistorId, point: PointOrClear } [Calibrate -> CalibrationFit];
        /// Compute the tile's parameters from the response that the station has recorded during a complete `tune`, and use them
        /// in place of the present ones.
        "tune" "result" => TuneResult [TuneResult -> IdentifiedTile];
        /// The tile in use, and the stability margins of the loop that the law `pi` closes.
        "margins" => Margins [QueryMargins -> IdentifiedTile];
        /// Number of lines that hold the settings.
        "settings" => CountSettings [CountSettings -> SettingsCount];
        /// One line of the settings, by its number.
        "settings" => QuerySetting { number: Whole<SettingNumber> } [QuerySetting -> SettingsLine];
        /// Replace the part of the settings that the line holds, from the next tick on. A line with a correction also removes
        /// the calibration points of its thermistor; a line with steps those of both display thermistors.
        "set" => Set { setting: Setting };
        /// The heat-flux sensor, its flux, and what is known of the finger by it.
        "flux" => QueryFlux [QueryFlux -> Option<FluxReport>];
        /// Use this heat-flux sensor.
        "flux" "set" => SetFluxSensor { sensor: FluxSensor };
        /// Use no heat-flux sensor.
        "flux" "none" => NoFluxSensor;
        /// Take the mean of the heat-flux sensor's code over the last half second as its zero.
        "flux" "zero" => FluxZero;
        /// The surface of the display.
        "surface" => QueryDisplaySurface [QueryDisplaySurface -> SurfaceReport];
        /// The display has this surface.
        "surface" "set" => SetDisplaySurface { surface: DisplaySurface };
        /// The display has the surface of the reference design.
        "surface" "nominal" => NominalDisplaySurface;
    }
    /// Requests about persons, who are those of the whole device; who is chosen, and what was learnt, is a finger's.
    Person(PersonRequest) {
        /// The chosen person, and from how many contacts the finger is learnt.
        "person" => QueryPerson [QueryPerson -> PersonReport];
        /// Begin to learn with an unknown person.
        "person" "none" => ChooseNobody;
        /// Store what was learnt as that of a person.
        "person" "enrol" => Enrol { code: PersonCode } [EnrolPerson -> PersonReport];
        /// Begin to learn with a stored person; with data, store the person.
        "person" => Person { code: PersonCode, data: Option<PersonData> };
        /// Codes of all stored persons.
        "persons" => List [QueryPersons -> StoredPersons];
        /// Forget a stored person.
        "forget" "person" => Forget { code: PersonCode };
    }
}

/// First word of the lines of an upload.
pub const UPLOAD_WORD: &str = "upload";

/// First words of all requests, each once.
pub fn command_words() -> impl Iterator<Item = &'static str> {
    let first = |form: &Form| form.first_two_words().0;
    let words = FORMS.iter().enumerate().filter_map(move |(place, form)| {
        let word = first(form);
        let is_new = !FORMS.iter().take(place).any(|other| first(other) == word);
        is_new.then_some(word)
    });
    words.chain(iter::once(UPLOAD_WORD))
}

/// Words that may follow this command.
pub fn second_words(command: &str) -> impl Iterator<Item = &'static str> {
    FORMS.iter().filter_map(move |form| match form.first_two_words() {
        (first, second) if first == command => second,
        _ => None,
    })
}

impl Request {
    /// Reads a line from the host without its address.
    ///
    /// # Errors
    /// The line is no valid request; the error says what is wrong with it and what is allowed.
    #[inline(never)]
    pub fn read(line: &str) -> Result<Self, ReadError> {
        let mut words = line.split_ascii_whitespace();
        let command = read_word(&mut words, "command")?;
        if command == UPLOAD_WORD {
            return Ok(Self::Upload);
        }
        let place = place_of_form(command, &mut words)?;
        let arguments = words.clone();
        let request = read_arguments(place, &mut words)
            .map_err(|error| with_second_words(place, &arguments, error))?;
        expect_end(&mut words)?;
        Ok(request)
    }
}

/// Finds the form of a line, and skips the form's words. A form without arguments, as a query, is that of a line that ends there;
/// in the table it stands before the one with arguments.
#[inline(never)]
fn place_of_form(command: &str, words: &mut Words<'_>) -> Result<usize, ReadError> {
    let (mut known, mut too_long, mut has_second_words) = (None, None, false);
    for (place, form) in FORMS.iter().enumerate() {
        // Most forms differ in their first letter, which is compared faster than a text.
        if form.words.as_bytes().first() != command.as_bytes().first() {
            continue;
        }
        let others = form.words.strip_prefix(command).filter(|others| others.starts_with([' ']));
        let Some(others) = others else { continue };
        let mut others = others.split_ascii_whitespace();
        known = form.words.get(..command.len());
        let mut rest = words.clone();
        let has_second_word = others.clone().next().is_some();
        // Of forms with the same second word the one without arguments comes first.
        if !has_second_word && matches!(too_long, Some((_, _, true))) {
            continue;
        }
        if others.all(|word| rest.next() == Some(word)) {
            if form.has_arguments || rest.clone().next().is_none() {
                *words = rest;
                return Ok(place);
            }
            if has_second_word || too_long.is_none() {
                too_long = Some((place, rest, has_second_word));
            }
        } else {
            has_second_words = true;
        }
    }
    match (known, too_long) {
        (None, _) => Err(ReadError::UnknownCommand(command.into())),
        // What is too much is reported after the arguments.
        (Some(_), Some((place, rest, has_second_word))) if has_second_word || !has_second_words => {
            *words = rest;
            Ok(place)
        }
        (Some(known), _) => Err(ReadError::UnknownSecondWord(known, word_or_empty(words).into())),
    }
}

/// An error in the word after a command, where other words may stand, too.
fn with_second_words(place: usize, words: &Words<'_>, error: ReadError) -> ReadError {
    let command = match FORMS.get(place).map(Form::first_two_words) {
        Some((command, None)) if second_words(command).next().is_some() => command,
        _ => return error,
    };
    match error {
        ReadError::NotANumber(range, word)
            if word == words.clone().next().unwrap_or_default().into() =>
        {
            ReadError::NotANumberOrWord(range, command, word)
        }
        error => error,
    }
}
