//! Telemetry lines of the device.

/// The fields of a telemetry line that a run uses; see `docs/protocol.md` for all of them.
#[derive(Clone, Debug, PartialEq)]
pub struct Telemetry {
    /// Ticks since the device's reset.
    pub tick: u64,
    /// State of the device.
    pub state: String,
    /// Set-point, °C.
    pub setpoint_c: Option<f64>,
    /// Display thermistor, °C.
    pub sensor_c: Option<f64>,
    /// Demanded current, A.
    pub demand_a: Option<f64>,
    /// Evaluations of `erfcx` since reset.
    pub evaluations: u64,
    /// Name of a fault, or `limited`.
    pub remark: Option<String>,
}

impl Telemetry {
    /// Reads a line; `None` if it is not telemetry.
    #[must_use]
    pub fn parse(line: &str) -> Option<Self> {
        let words: Vec<_> = line.split(' ').collect();
        let &[
            "T",
            tick,
            state,
            setpoint,
            display,
            _sink,
            _skin,
            _room,
            _force,
            demand,
            _current,
            evaluations,
            remark,
        ] = words.as_slice()
        else {
            return None;
        };
        let number = |word: &str| {
            if word == "-" {
                Some(None)
            } else {
                word.parse().ok().map(Some)
            }
        };
        Some(Self {
            tick: tick.parse().ok()?,
            state: state.into(),
            setpoint_c: number(setpoint)?,
            sensor_c: number(display)?,
            demand_a: number(demand)?,
            evaluations: evaluations.parse().ok()?,
            remark: (remark != "-").then(|| remark.into()),
        })
    }
}
