//! Defect of the thermoelectric module.

/// Defect of the legs.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ModuleDefect {
    /// Remaining fraction of the Seebeck coefficient, 0 to 1: aged legs, or legs shorted by solder.
    pub seebeck: f64,
}

impl ModuleDefect {
    /// No defect.
    pub const NONE: Self = Self { seebeck: 1.0 };
}

impl Default for ModuleDefect {
    fn default() -> Self {
        Self::NONE
    }
}
