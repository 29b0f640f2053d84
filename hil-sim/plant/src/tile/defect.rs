//! What can be broken in the module.

/// What is broken in the legs.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ModuleDefect {
    /// Share of the Seebeck effect that is left, 0 to 1: legs that have aged, or that solder bridges.
    pub seebeck: f64,
}

impl ModuleDefect {
    /// Nothing.
    pub const NONE: Self = Self { seebeck: 1.0 };
}

impl Default for ModuleDefect {
    fn default() -> Self {
        Self::NONE
    }
}
