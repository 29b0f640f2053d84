//! Window and beamsplitter between finger and camera (Table 5-3).

/// Properties of an optical element averaged over the camera's band; the part that is neither transmitted nor reflected
/// is absorbed.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Bandpass {
    /// Transmissivity, 0 to 1 (Eq. 5-1).
    pub transmissivity: f64,
    /// Reflectivity, 0 to 1 (Eq. 5-2).
    pub reflectivity: f64,
}

impl Bandpass {
    /// Emissivity, 0 to 1, which equals the absorptivity (section 5.2.2).
    pub fn emissivity(&self) -> f64 {
        1.0 - self.transmissivity - self.reflectivity
    }
}

/// The beamsplitter: germanium with an anti-reflection coating, at 45° (Table 5-3).
pub const BEAMSPLITTER: Bandpass = Bandpass { transmissivity: 0.54, reflectivity: 0.42 };

/// Optics between finger and camera.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Optic {
    /// Neither window nor beamsplitter: the thesis's emissivity check (Eq. 5-4).
    None,
    /// Barium fluoride window and beamsplitter.
    Baf2,
    /// Zinc sulphide window and beamsplitter.
    Zns,
}

impl Optic {
    /// The window that the finger touches (Table 5-3), if there is one.
    pub fn window(self) -> Option<Bandpass> {
        let (transmissivity, reflectivity) = match self {
            Self::None => return None,
            Self::Baf2 => (0.77, 0.04),
            Self::Zns => (0.65, 0.22),
        };
        Some(Bandpass { transmissivity, reflectivity })
    }
}
