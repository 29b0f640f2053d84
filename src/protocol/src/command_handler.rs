//! Execution of the host's lines for all fingers of a device.

use core::{array, fmt, iter};

use contact_model::fixed_point::Body;
use contact_model::material::{Material, SKIN};
use contact_model::slab::{Back, Slab};
use thermal_commissioning::{CommissioningSession, SessionReply, StorageOrder};
use thermal_device::command::{
    self, ChosenMaterial, Command, ObjectBody, Refused, WithSourceFinger,
};
use thermal_device::learning::PersonState;
use thermal_device::{FingerIndex, StateName, TICK_S};
use thermal_settings::{
    Person, PersonCode, Persons, Settings, SettingsRecord, StoredDevice, StoredSettings, WordList,
    encode_settings_record,
};
use thermal_wire::answer::{BoardStatus, DeviceIdentity, PersonCodes, PersonReply};
use thermal_wire::request::{DeviceRequest, PersonRequest, SessionRequest};
use thermal_wire::words::{expect_end, read_word};
use thermal_wire::{PersonData, PointOrClear, ReadError, Request};

use crate::finger_address::{legible_address, split_address};
use crate::line_checksum::{ChecksumError, line_checksum, strip_checksum, write_line};
use crate::station_command::{StationWork, station_work};
use crate::upload::{Upload, UploadStep};
use crate::{Error, OutgoingLine, Reply, UploadError};

/// Contacts of 8 s or more from which a finger must have been learnt to be stored by `person enrol`.
pub const ENROL_CONTACTS: u8 = 2;

/// A function that executes a command in the station (the control) of the given finger, or in the stations of all
/// fingers for `None`, and returns the reply or the refusal, in bounded and short time. [`CommandHandler::answer`]
/// calls it.
pub trait ExecuteOnStations<const FINGERS: usize>:
    FnMut(Option<FingerIndex<FINGERS>>, Command<'_>) -> ExecutionResult
{
}

impl<const FINGERS: usize, F> ExecuteOnStations<FINGERS> for F where
    F: FnMut(Option<FingerIndex<FINGERS>>, Command<'_>) -> ExecutionResult
{
}

/// Result of a command in the station (the control) of one finger or in the stations of all fingers: a station's reply,
/// or the reason why a station refuses the command. For the answer to the host, the result contains the index of that
/// station's finger, or no index if the result is for all fingers or the device has only one.
pub type ExecutionResult = Result<WithSourceFinger<command::Reply>, WithSourceFinger<Refused>>;

/// Executes the host's lines on a device with one to ten fingers, and returns the answers. It holds the commissioning
/// session of each finger, which is its settings and calibration points; lines that command the control of a finger are
/// passed on to the finger's station.
#[derive(Clone, Debug)]
pub struct CommandHandler<const FINGERS: usize> {
    sessions: [CommissioningSession; FINGERS],
    persons: Persons,
    upload: Upload,
    /// The finger whose address the lines of the upload have.
    upload_owner: Option<FingerIndex<FINGERS>>,
    /// Whether lines to the host end with a checksum.
    checksums: bool,
    /// State of the board, for the answer to `board`. Whoever has a board keeps it up to date.
    pub board: BoardStatus,
}

impl<const FINGERS: usize> CommandHandler<FINGERS> {
    /// A handler for a device whose fingers all have the same `settings`, such as the factory defaults.
    pub fn new(settings: Settings) -> Self {
        Self {
            sessions: array::from_fn(|_| CommissioningSession::new(settings)),
            persons: Persons::new(),
            upload: Upload::new(),
            upload_owner: None,
            checksums: false,
            board: BoardStatus::default(),
        }
    }

    /// A handler for a device with the persons, and whose fingers have the calibration, tile, heat-flux sensor and display, that
    /// were loaded from flash; all other settings have factory defaults.
    pub fn from_stored(stored: &StoredDevice<FINGERS>) -> Self {
        let session = |stored: &StoredSettings| {
            CommissioningSession::new(stored.to_settings_with_factory_defaults())
        };
        Self {
            sessions: stored.fingers.each_ref().map(session),
            persons: stored.persons.clone(),
            upload: Upload::new(),
            upload_owner: None,
            checksums: false,
            board: BoardStatus::default(),
        }
    }

    /// The bytes to be written to flash for the command `save` (the present settings of all fingers, and the persons) or `forget`
    /// (factory defaults).
    pub fn record_to_save_or_forget(&self, order: StorageOrder) -> SettingsRecord {
        match order {
            StorageOrder::Save => {
                let sessions = self.sessions.each_ref();
                encode_settings_record(Some(&StoredDevice {
                    fingers: sessions.map(|one| StoredSettings::from_settings(one.settings())),
                    persons: self.persons.clone(),
                }))
            }
            StorageOrder::Forget => encode_settings_record::<FINGERS>(None),
        }
    }

    /// Replaces `line` by an answer or telemetry, as it is sent to the host. Lines are written in the order in which they are
    /// sent, so that the answer to `checksum on` is the first one with a checksum.
    pub fn write_line(&self, line: &mut OutgoingLine, content: &dyn fmt::Display) {
        write_line(line, content, self.checksums);
    }

    /// Parses a line from the host, executes it, and returns the answer. A line with an address is for one finger. A
    /// line without an address is for all fingers: a query is answered by the first finger that does not refuse it, a
    /// change is made by each finger. For `save` and `forget` the caller must do the rest ([`Reply::Restart`]).
    ///
    /// Time-consuming computations are done here, outside of `execute`, which runs with the control tick locked out.
    ///
    /// # Errors
    /// No finger executes a line that is not valid, a line whose checksum is wrong, a line whose command requires or forbids an address, or a rejected
    /// `save` or `forget`. Otherwise the error is that of the first finger that rejects the line, and the other fingers
    /// have executed the line if their state permits it. For `clear` without an address, a finger that is not tripped
    /// gives an error only if no finger is tripped.
    // Not inlined, so that telemetry, which the caller prints, does not need this function's stack.
    #[inline(never)]
    pub fn answer(
        &mut self,
        line: &str,
        mut execute: impl ExecuteOnStations<FINGERS>,
    ) -> Result<WithSourceFinger<Reply>, WithSourceFinger<Error>> {
        const { assert!(FINGERS > 0 && FINGERS <= 10) };
        let stripped = match strip_checksum(line) {
            Ok(content)
                if self.checksums && content.len() == line.len() && !is_abort::<FINGERS>(line) =>
            {
                Err(ChecksumError::Missing(line_checksum(line.as_bytes())))
            }
            stripped => stripped,
        };
        let line = stripped.map_err(|error| WithSourceFinger {
            finger: legible_address::<FINGERS>(line),
            content: Error::Checksum(error),
        })?;
        let (finger, line) = split_address(line)?;
        let number = finger.map(FingerIndex::index_u8);
        let addressed = |content| WithSourceFinger { finger: number, content };
        let rejected = |content| WithSourceFinger { finger: number, content };
        let owner = finger.map_or(0, FingerIndex::index);
        let request = Request::read(line).map_err(|error| rejected(error.into()))?;
        match request {
            Request::Device(request) => self.answer_of_device(&request, finger, execute),
            Request::Station(request) => {
                let display = self.sessions[owner].settings().display;
                match station_work(&request, display.surface()).map_err(rejected)? {
                    StationWork::Command(Command::Material(chosen))
                        if finger.is_none() && self.displays_differ() =>
                    {
                        self.choose_material_on_each_display(&chosen, execute)
                    }
                    StationWork::Command(command) => {
                        Self::execute_in_stations(command, finger, execute)
                    }
                    StationWork::Slab(thickness_mm, back) => {
                        let material = Self::chosen_material(finger, &mut execute);
                        let body =
                            material.and_then(|material| slab_body(&material, thickness_mm, back));
                        let command = Command::Body(body.map_err(rejected)?);
                        Self::execute_in_stations(command, finger, execute)
                    }
                    StationWork::Pulse(pulse, order) => {
                        (pulse.replace_course(self.upload.course_to_replace()))
                            .map_err(|error| rejected(Error::Course(error)))?;
                        let (_, loaded) = self.load_course(finger, &mut execute);
                        let played =
                            Self::execute_in_stations(Command::Play(order), finger, execute);
                        loaded.and(played)
                    }
                }
            }
            Request::Upload => match self.continue_upload(finger, line).map_err(rejected)? {
                UploadStep::Row => Ok(addressed(Reply::DONE)),
                UploadStep::BeginCourse => {
                    let (permitted, answer) = self.load_course(finger, &mut execute);
                    if !permitted {
                        self.upload.end();
                    }
                    answer
                }
                UploadStep::Course => self.load_course(finger, &mut execute).1,
                UploadStep::Object(body) => {
                    let command = Command::Body(ObjectBody::Upload(body));
                    Self::execute_in_stations(command, finger, execute)
                }
            },
            Request::Session(request) => {
                self.execute_in_commissioning_sessions(request, finger, execute)
            }
            Request::Person(request) => self.answer_about_persons(request, finger, execute),
        }
    }

    /// Executes a request that the device as a whole answers.
    #[inline(never)]
    fn answer_of_device(
        &mut self,
        request: &DeviceRequest,
        finger: Option<FingerIndex<FINGERS>>,
        execute: impl ExecuteOnStations<FINGERS>,
    ) -> Result<WithSourceFinger<Reply>, WithSourceFinger<Error>> {
        let number = finger.map(FingerIndex::index_u8);
        let content = match request {
            DeviceRequest::Identify => Reply::Identity(DeviceIdentity { fingers: FINGERS as u8 }),
            DeviceRequest::Board => Reply::Board(self.board),
            DeviceRequest::Checksum { .. } if finger.is_some() && FINGERS > 1 => {
                let content = Error::WholeDevice("checksum");
                return Err(WithSourceFinger { finger: number, content });
            }
            DeviceRequest::Checksum { switch } => {
                self.checksums = switch.is_on();
                Reply::DONE
            }
            DeviceRequest::Save => {
                return Self::save_or_forget(StorageOrder::Save, finger, execute);
            }
            DeviceRequest::ForgetAll => {
                return Self::save_or_forget(StorageOrder::Forget, finger, execute);
            }
        };
        Ok(WithSourceFinger { finger: number, content })
    }

    /// Executes a command in the station of `finger`, or in all stations for `None`.
    #[inline(never)]
    fn execute_in_stations(
        command: Command<'_>,
        finger: Option<FingerIndex<FINGERS>>,
        mut execute: impl ExecuteOnStations<FINGERS>,
    ) -> Result<WithSourceFinger<Reply>, WithSourceFinger<Error>> {
        match execute(finger, command) {
            Ok(reply) => Ok(reply.map_content(Reply::Station)),
            Err(refused) => Err(refused.map_content(Error::from)),
        }
    }

    /// Whether the displays of the fingers have different surfaces.
    fn displays_differ(&self) -> bool {
        let [first, others @ ..] = &self.sessions[..] else {
            return false;
        };
        let first = first.settings().display;
        others.iter().any(|one| one.settings().display != first)
    }

    /// Chooses a material in the stations of all fingers, with the contact constants of each one's display.
    #[inline(never)]
    fn choose_material_on_each_display(
        &self,
        chosen: &ChosenMaterial,
        mut execute: impl ExecuteOnStations<FINGERS>,
    ) -> Result<WithSourceFinger<Reply>, WithSourceFinger<Error>> {
        let mut first_error = None;
        for (one, session) in FingerIndex::all().zip(&self.sessions) {
            let display = session.settings().display.surface();
            let done = ChosenMaterial::new(chosen.name, &chosen.properties, display)
                .map_err(Error::ContactPair)
                .and_then(|chosen| {
                    let done = execute(Some(one), Command::Material(chosen));
                    done.map_err(|refused| Error::Refused(refused.content))
                });
            if let Err(content) = done {
                first_error.get_or_insert(WithSourceFinger {
                    finger: one.index_unless_single_finger(),
                    content,
                });
            }
        }
        let done = WithSourceFinger::from_whole_device(Reply::DONE);
        first_error.map_or(Ok(done), Err)
    }

    /// Executes an order about persons. They are those of the whole device; who is chosen, and what was learnt, is a finger's.
    #[inline(never)]
    fn answer_about_persons(
        &mut self,
        request: PersonRequest,
        finger: Option<FingerIndex<FINGERS>>,
        execute: impl ExecuteOnStations<FINGERS>,
    ) -> Result<WithSourceFinger<Reply>, WithSourceFinger<Error>> {
        let is_one = finger.is_some() || FINGERS == 1;
        let finger = match request {
            PersonRequest::QueryPerson if FINGERS > 1 => finger.or(Some(FingerIndex::FIRST)),
            _ => finger,
        };
        let answer = match request {
            PersonRequest::ChooseNobody => {
                return Self::execute_in_stations(Command::ChoosePerson(None), finger, execute);
            }
            PersonRequest::Person { code, data: None } => match self.persons.get(code) {
                None => Err(Error::UnknownPerson(code)),
                Some(person) => {
                    let command = Command::ChoosePerson(Some(*person));
                    return Self::execute_in_stations(command, finger, execute);
                }
            },
            PersonRequest::Person { code, data: Some(PersonData(finger)) } => {
                self.store_person(Person { code, finger })
            }
            PersonRequest::List => Ok(Reply::Persons(PersonCodes::new(&self.persons))),
            PersonRequest::Forget { code } if self.persons.remove(code) => Ok(Reply::DONE),
            PersonRequest::Forget { code } => Err(Error::UnknownPerson(code)),
            PersonRequest::Enrol { .. } if !is_one => Err(Error::NeedsFinger),
            PersonRequest::QueryPerson => {
                Self::person_state(Command::Person, finger, execute).map(|state| {
                    Reply::Person(PersonReply { person: state.chosen, contacts: state.contacts() })
                })
            }
            PersonRequest::Enrol { code } => {
                Self::person_state(Command::LearntPerson, finger, execute)
                    .and_then(|state| self.enrol(code, &state))
            }
        };
        let finger = finger.map(FingerIndex::index_u8);
        match answer {
            Ok(content) => Ok(WithSourceFinger { finger, content }),
            Err(content) => Err(WithSourceFinger { finger, content }),
        }
    }

    /// The chosen person of a finger, of the first one for `None`, and what was learnt of it, by one of the two commands for that.
    fn person_state(
        command: Command<'_>,
        finger: Option<FingerIndex<FINGERS>>,
        mut execute: impl ExecuteOnStations<FINGERS>,
    ) -> Result<PersonState, Error> {
        match execute(Some(finger.unwrap_or(FingerIndex::FIRST)), command) {
            Ok(WithSourceFinger { content: command::Reply::Person(state), .. }) => Ok(state),
            Ok(_) => Ok(PersonState::new(None)),
            Err(refused) => Err(Error::Refused(refused.content)),
        }
    }

    /// Stores what was learnt of a finger as that of this person.
    fn enrol(&mut self, code: PersonCode, state: &PersonState) -> Result<Reply, Error> {
        let contacts = state.contacts();
        let learnt = state.learnt.filter(|_| contacts >= ENROL_CONTACTS);
        let finger = learnt.ok_or(Error::NotEnrolled(contacts))?.0;
        let person = Person { code, finger };
        self.store_person(person)?;
        Ok(Reply::Person(PersonReply { person: Some(person), contacts }))
    }

    fn store_person(&mut self, person: Person) -> Result<Reply, Error> {
        let is_stored = self.persons.insert(person);
        is_stored.then_some(Reply::DONE).ok_or(Error::NoRoomForPerson)
    }

    /// Loads the course of the upload in the station of `finger`, or in all stations for `None`. A course that has only begun
    /// has no points, and changes nothing. Returns whether a station permits it, and the answer, which is the refusal of the
    /// first station that does not.
    #[inline(never)]
    fn load_course(
        &self,
        finger: Option<FingerIndex<FINGERS>>,
        execute: &mut impl ExecuteOnStations<FINGERS>,
    ) -> (bool, Result<WithSourceFinger<Reply>, WithSourceFinger<Error>>) {
        let number = finger.map(FingerIndex::index_u8);
        let (mut permitted, mut first_refusal) = (false, None);
        for one in FingerIndex::all().filter(|one| finger.is_none_or(|finger| finger == *one)) {
            let chunks = self.upload.course().chunks().map(Some);
            let refusal = iter::once(None)
                .chain(chunks)
                .find_map(|chunk| execute(Some(one), Command::LoadCourse(chunk)).err());
            match refusal {
                None => permitted = true,
                Some(refused) => {
                    first_refusal.get_or_insert(WithSourceFinger {
                        finger: number.or(one.index_unless_single_finger()),
                        content: Error::Refused(refused.content),
                    });
                }
            }
        }
        let done = WithSourceFinger { finger: number, content: Reply::DONE };
        (permitted, first_refusal.map_or(Ok(done), Err))
    }

    /// Properties of the material that is chosen in the station of `finger` or, for `None`, in all stations.
    ///
    /// # Errors
    /// A station has no material, or the stations have different ones: the slab would have to be computed for each, which
    /// takes milliseconds of `f64`.
    fn chosen_material(
        finger: Option<FingerIndex<FINGERS>>,
        execute: &mut impl ExecuteOnStations<FINGERS>,
    ) -> Result<Material, Error> {
        let mut material_of = |one| match execute(Some(one), Command::MaterialProperties) {
            Ok(WithSourceFinger { content: command::Reply::Material(Some(material)), .. }) => {
                Ok(material)
            }
            _ => Err(Error::SlabNeedsMaterial),
        };
        let material = material_of(finger.unwrap_or(FingerIndex::FIRST))?;
        for one in FingerIndex::all() {
            if finger.is_none() && material_of(one)? != material {
                return Err(Error::NeedsFinger);
            }
        }
        Ok(material)
    }

    /// Executes one line of an upload, and returns what the line has completed. A commit with one argument
    /// ends the upload even if it is refused, and so does a `begin` that is refused. There is one upload for all fingers,
    /// which saves the RAM of the others: it belongs to the address that began it last, so that hosts of several fingers
    /// that upload at the same time get an error and not each other's rows.
    #[inline(never)]
    fn continue_upload(
        &mut self,
        finger: Option<FingerIndex<FINGERS>>,
        line: &str,
    ) -> Result<UploadStep, Error> {
        // The only finger is all fingers.
        let owner = finger.filter(|_| FINGERS > 1);
        let mut words = line.split_ascii_whitespace();
        words.next();
        let step = read_word(&mut words, "begin, row or commit")?;
        match step {
            "begin" => {
                self.upload_owner = owner;
                return self.upload.begin(line, &mut words);
            }
            "row" | "commit" if self.upload.has_begun() && self.upload_owner != owner => {
                let other = self.upload_owner.map(FingerIndex::index_u8);
                return Err(Error::Upload(UploadError::OfAnother(other)));
            }
            "row" => self.upload.add_row(line, &mut words)?,
            "commit" => {
                let checksum = read_word(&mut words, "checksum")?;
                expect_end(&mut words)?;
                return self.upload.commit(checksum);
            }
            unknown => {
                const LINES: &WordList =
                    &WordList { kind: "upload", words: &["begin", "row", "commit"] };
                return Err(ReadError::UnknownWord(LINES, unknown.into()).into());
            }
        }
        Ok(UploadStep::Row)
    }

    /// Executes a commissioning request in the session of `finger`, or in the sessions of all fingers for `None`. With
    /// `None` on a device with several fingers, the queries `settings`, `margins`, `flux` and `surface` are answered by the first finger;
    /// a new calibration point and `tune result`, which are computed for milliseconds, are rejected.
    #[inline(never)]
    fn execute_in_commissioning_sessions(
        &mut self,
        request: SessionRequest,
        finger: Option<FingerIndex<FINGERS>>,
        mut execute: impl ExecuteOnStations<FINGERS>,
    ) -> Result<WithSourceFinger<Reply>, WithSourceFinger<Error>> {
        let finger = match request {
            SessionRequest::CountSettings
            | SessionRequest::QuerySetting { .. }
            | SessionRequest::Margins
            | SessionRequest::QueryFlux
            | SessionRequest::QueryDisplaySurface
                if FINGERS > 1 =>
            {
                finger.or(Some(FingerIndex::FIRST))
            }
            // Each of these requests takes milliseconds of `f64`; for all fingers this would exceed the watchdog's
            // period.
            SessionRequest::Calibrate { point: PointOrClear::Point(_), .. }
            | SessionRequest::TuneResult
                if finger.is_none() && FINGERS > 1 =>
            {
                return Err(WithSourceFinger::from_whole_device(Error::NeedsFinger));
            }
            _ => finger,
        };
        let (mut reply, mut first_error) = (SessionReply::Done, None);
        for (one, session) in FingerIndex::all().zip(&mut self.sessions) {
            if finger.is_some_and(|finger| finger != one) {
                continue;
            }
            let answer =
                session.answer(request.clone(), |command| match execute(Some(one), command) {
                    Ok(reply) => Ok(reply.content),
                    Err(refused) => Err(refused.content),
                });
            match answer {
                // A request to several fingers has no other reply than `Done`.
                Ok(answer) => reply = answer,
                Err(error) => {
                    first_error.get_or_insert(WithSourceFinger {
                        finger: finger
                            .map(FingerIndex::index_u8)
                            .or(one.index_unless_single_finger()),
                        content: Error::from(error),
                    });
                }
            }
        }
        let content = Reply::Commissioning(reply);
        let finger = finger.map(FingerIndex::index_u8);
        first_error.map_or(Ok(WithSourceFinger { finger, content }), Err)
    }

    /// Answers `save` or `forget`: the caller restarts the device, unless the order is rejected.
    #[inline(never)]
    fn save_or_forget(
        order: StorageOrder,
        finger: Option<FingerIndex<FINGERS>>,
        execute: impl ExecuteOnStations<FINGERS>,
    ) -> Result<WithSourceFinger<Reply>, WithSourceFinger<Error>> {
        let number = finger.map(FingerIndex::index_u8);
        let restart = WithSourceFinger { finger: number, content: Reply::Restart(order) };
        Self::save_or_forget_rejection(order, finger, execute).map_or(Ok(restart), Err)
    }

    /// The error that rejects `save` or `forget`, or `None` if the command may be executed. Rejected are a line that
    /// addresses one of several fingers, and any line while a bridge is on or a self-test runs: the device restarts to
    /// store settings, and would switch off a display that a finger may feel.
    #[inline(never)]
    fn save_or_forget_rejection(
        order: StorageOrder,
        finger: Option<FingerIndex<FINGERS>>,
        mut execute: impl ExecuteOnStations<FINGERS>,
    ) -> Option<WithSourceFinger<Error>> {
        if finger.is_some() && FINGERS > 1 {
            let content = Error::WholeDevice(order.name());
            let finger = finger.map(FingerIndex::index_u8);
            return Some(WithSourceFinger { finger, content });
        }
        for one in FingerIndex::all() {
            match execute(Some(one), Command::Status) {
                Err(refused) => return Some(refused.map_content(Error::from)),
                Ok(WithSourceFinger { content: command::Reply::Status(status), .. })
                    if matches!(
                        status.state,
                        StateName::Off | StateName::Ready | StateName::Tripped(_)
                    ) => {}
                Ok(_) => {
                    return Some(WithSourceFinger {
                        finger: one
                            .index_unless_single_finger()
                            .or(finger.map(FingerIndex::index_u8)),
                        content: Error::NeedsOff(order.name()),
                    });
                }
            }
        }
        None
    }
}

/// Whether a line is `abort`, with or without the address of a finger. It is executed also without the checksum that other
/// lines must have: it only switches bridges off, and an operator must be able to type it.
fn is_abort<const FINGERS: usize>(line: &str) -> bool {
    split_address::<FINGERS>(line).is_ok_and(|(_, command)| command.trim_ascii() == "abort")
}

/// Diffusion time of a slab, `thickness² / diffusivity`, s, above which it counts as a half-space: its back then changes the
/// temperature of its face by less than a thousandth in an hour under a constant flux. From 1.2e5 s on, a slab would
/// also have more slow relaxations than a body may.
const SLAB_DIFFUSION_MAX_S: f64 = 2e4;

/// The body of a slab of a material, which may count as a half-space.
#[inline(never)]
fn slab_body(material: &Material, thickness_mm: f64, back: Back) -> Result<ObjectBody, Error> {
    let slab = Slab {
        thickness_m: 1e-3 * thickness_mm,
        conductivity_w_mk: material.surface.conductivity_w_mk,
        capacity_j_m3k: material.volumetric_heat_j_m3k(),
        back,
    };
    let diffusion_s = slab.thickness_m * slab.thickness_m / material.diffusivity_m2_s();
    if diffusion_s > SLAB_DIFFUSION_MAX_S {
        return Ok(ObjectBody::HalfSpace);
    }
    let relaxations = slab.relaxations();
    let body = Body::new(&relaxations.impedance(), SKIN.effusivity(), TICK_S);
    body.map(ObjectBody::Slab).map_err(Error::Body)
}
