//! Materials, the skin and the display surface (Tables 3-1, 3-4, 4-1, 5-1 and 6-1).

/// What contact resistance sees of a solid (Eq. 6-9 to 6-11).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Surface {
    /// Thermal conductivity, W/(m K).
    pub conductivity_w_mk: f64,
    /// Root mean square roughness `R_q`, micrometres.
    pub roughness_um: f64,
    /// Absolute average asperity slope, rad.
    pub slope_rad: f64,
}

/// Absolute average slope `da` from the RMS slope `R dq` of a profile, both in rad (Eq. 6-13).
///
/// The 1.25 is `sqrt(pi / 2)`, that of Gaussian surfaces; a sinusoid would have 1.11. Average the slope of a
/// profile that is at hand.
#[must_use]
pub fn average_slope_rad(rms_slope_rad: f64) -> f64 {
    rms_slope_rad / 1.25
}

/// A homogeneous solid, seen as a half-space.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Material {
    /// Conductivity and finish.
    pub surface: Surface,
    /// Density, kg/m³.
    pub density_kg_m3: f64,
    /// Specific heat, J/(kg K).
    pub specific_heat_j_kgk: f64,
}

impl Material {
    /// Thermal effusivity `sqrt(k rho c)`, J/(m² s^½ K); the thesis's "contact coefficient".
    #[must_use]
    pub fn effusivity(&self) -> f64 {
        libm::sqrt(self.surface.conductivity_w_mk * self.volumetric_heat_j_m3k())
    }

    /// Thermal diffusivity `k / (rho c)`, m²/s.
    #[must_use]
    pub fn diffusivity_m2_s(&self) -> f64 {
        self.surface.conductivity_w_mk / self.volumetric_heat_j_m3k()
    }

    /// Heat capacity per volume `rho c`, J/(m³ K).
    #[must_use]
    pub fn volumetric_heat_j_m3k(&self) -> f64 {
        self.density_kg_m3 * self.specific_heat_j_kgk
    }
}

/// The fingertip: a half-space with `k` 0.37 W/(m K) and diffusivity 1e-7 m²/s (section 2.1); finish is the
/// mean over both sexes (Table 6-1).
pub const SKIN: Material = Material {
    surface: Surface {
        conductivity_w_mk: 0.37,
        roughness_um: 21.69,
        slope_rad: 0.30,
    },
    density_kg_m3: 1000.0,
    specific_heat_j_kgk: 3700.0,
};

/// Microhardness of the skin, Pa (section 6.1).
pub const SKIN_MICROHARDNESS_PA: f64 = 0.1225e6;

/// The display surface that reproduces the ratios `R_display / R_object` of section 6.3.
pub const REFERENCE_DISPLAY: Surface = Surface {
    conductivity_w_mk: 36.0,
    roughness_um: 1.0,
    slope_rad: 0.138,
};

const fn solid(k: f64, rho: f64, c: f64, roughness_um: f64, slope_rad: f64) -> Material {
    Material {
        surface: Surface {
            conductivity_w_mk: k,
            roughness_um,
            slope_rad,
        },
        density_kg_m3: rho,
        specific_heat_j_kgk: c,
    }
}

/// The materials of the thesis by name. The slopes of bronze and G10 are assumed: the thesis gives none.
pub const MATERIALS: [(&str, Material); 9] = [
    ("copper", solid(398.0, 8954.0, 384.0, 0.31, 0.045)),
    ("bronze", solid(54.0, 8780.0, 355.0, 0.32, 0.053)),
    ("stainless-steel", solid(13.5, 8000.0, 460.0, 0.19, 0.031)),
    ("granite", solid(2.79, 2630.0, 775.0, 0.46, 0.048)),
    ("g10", solid(0.29, 1800.0, 1600.0, 1.50, 0.168)),
    ("abs", solid(0.18, 1010.0, 1386.0, 0.45, 0.046)),
    ("foam", solid(0.029, 24.0, 1210.0, 8.03, 0.157)),
    ("baf2", solid(11.7, 4890.0, 410.0, 0.008, 0.009)),
    ("zns", solid(27.2, 4090.0, 515.0, 0.006, 0.006)),
];

/// The material of that name, as [`MATERIALS`] spells it.
#[must_use]
pub fn find(name: &str) -> Option<&'static Material> {
    MATERIALS
        .iter()
        .find(|(known, _)| *known == name)
        .map(|(_, material)| material)
}
