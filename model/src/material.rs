//! Thermal and surface properties of materials, the skin and the display (Tables 3-1, 3-4, 4-1, 5-1 and 6-1).

/// Properties of a solid that determine contact resistance (Eq. 6-9 to 6-11).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Surface {
    /// Thermal conductivity, W/(m K).
    pub conductivity_w_mk: f64,
    /// RMS roughness `R_q`, µm.
    pub roughness_um: f64,
    /// Mean absolute asperity slope, rad.
    pub slope_rad: f64,
}

/// Mean absolute slope `da` from the RMS slope `R dq` of a profile, both in rad (Eq. 6-13).
///
/// The factor 1.25 is `sqrt(pi / 2)`, for Gaussian surfaces; for a sinusoid it is 1.11. Where the profile itself is
/// known, average its absolute slope instead.
pub fn average_slope_rad(rms_slope_rad: f64) -> f64 {
    rms_slope_rad / 1.25
}

/// A homogeneous solid.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Material {
    /// Conductivity and surface finish.
    pub surface: Surface,
    /// Density, kg/m³.
    pub density_kg_m3: f64,
    /// Specific heat, J/(kg K).
    pub specific_heat_j_kgk: f64,
}

impl Material {
    /// Thermal effusivity `sqrt(k rho c)`, J/(m² s^½ K); the thesis's "contact coefficient".
    pub fn effusivity(&self) -> f64 {
        libm::sqrt(self.surface.conductivity_w_mk * self.volumetric_heat_j_m3k())
    }

    /// Thermal diffusivity `k / (rho c)`, m²/s.
    pub fn diffusivity_m2_s(&self) -> f64 {
        self.surface.conductivity_w_mk / self.volumetric_heat_j_m3k()
    }

    /// Heat capacity per volume `rho c`, J/(m³ K).
    pub fn volumetric_heat_j_m3k(&self) -> f64 {
        self.density_kg_m3 * self.specific_heat_j_kgk
    }
}

/// Skin of the fingertip: conductivity 0.37 W/(m K), diffusivity 1e-7 m²/s (section 2.1); surface finish averaged
/// over women and men (Table 6-1).
pub const SKIN: Material = Material {
    surface: Surface { conductivity_w_mk: 0.37, roughness_um: 21.69, slope_rad: 0.30 },
    density_kg_m3: 1000.0,
    specific_heat_j_kgk: 3700.0,
};

/// Microhardness of the skin, Pa (section 6.1).
pub const SKIN_MICROHARDNESS_PA: f64 = 0.1225e6;

/// Display surface with which the ratios `R_display / R_object` of section 6.3 result.
pub const REFERENCE_DISPLAY: Surface =
    Surface { conductivity_w_mk: 36.0, roughness_um: 1.0, slope_rad: 0.138 };

const fn solid(k: f64, rho: f64, c: f64, roughness_um: f64, slope_rad: f64) -> Material {
    Material {
        surface: Surface { conductivity_w_mk: k, roughness_um, slope_rad },
        density_kg_m3: rho,
        specific_heat_j_kgk: c,
    }
}

/// Makes tables of rows: name; conductivity, density, specific heat, RMS roughness, mean slope; what it is and the source.
///
/// Descriptions are a table of their own, so that the image does not contain them.
macro_rules! materials {
    ($($name:literal [$($property:literal),*] $description:literal;)*) => {
        /// All materials by name.
        pub const MATERIALS: [(&str, Material); DESCRIPTIONS.len()] =
            [$(($name, solid($($property),*))),*];
        /// What each of [`MATERIALS`] is, and the source of its properties.
        pub const DESCRIPTIONS: [&str; [$($name),*].len()] = [$($description),*];
    };
}

materials! {
    // name           W/(m K)  kg/m³ J/(kg K)   µm    rad
    "copper"          [398.0, 8954.0,  384.0,  0.31, 0.045] "metal; Ho 2006";
    "bronze"          [ 54.0, 8780.0,  355.0,  0.32, 0.053] "metal; Ho 2006, slope assumed";
    "stainless-steel" [ 13.5, 8000.0,  460.0,  0.19, 0.031] "metal; Ho 2006";
    "granite"         [ 2.79, 2630.0,  775.0,  0.46, 0.048] "stone; Ho 2006";
    "g10"             [ 0.29, 1800.0, 1600.0,  1.50, 0.168] "glass-fibre board; Ho 2006, slope assumed";
    "abs"             [ 0.18, 1010.0, 1386.0,  0.45, 0.046] "plastic; Ho 2006";
    "foam"            [0.029,   24.0, 1210.0,  8.03, 0.157] "insulator; Ho 2006";
    "baf2"            [ 11.7, 4890.0,  410.0, 0.008, 0.009] "barium fluoride, an infrared window; Ho 2006";
    "zns"             [ 27.2, 4090.0,  515.0, 0.006, 0.006] "zinc sulphide, an infrared window; Ho 2006";
    // Data sheet MA6061T6 of Aerospace Specification Metals (asm.matweb.com); the surface is a typical one and not measured.
    "aluminium-6061"  [167.0, 2700.0,  896.0,  0.40, 0.050] "alloy, temper T6; ASM data sheet MA6061T6, surface assumed";
}

/// Names of the thesis's materials, in an order that stays. What is drawn by seed, or is a figure of these nine, chooses from
/// them, so that a material added to [`MATERIALS`] changes neither.
pub const THESIS_MATERIALS: [&str; 9] =
    ["copper", "bronze", "stainless-steel", "granite", "g10", "abs", "foam", "baf2", "zns"];

/// Looks up a material by its name in [`MATERIALS`].
pub fn find(name: &str) -> Option<&'static Material> {
    position(name).map(|position| &MATERIALS[position].1)
}

/// Position of a name in [`MATERIALS`], also in a constant.
pub const fn position(name: &str) -> Option<usize> {
    let mut position = 0;
    while position < MATERIALS.len() {
        if equal(MATERIALS[position].0.as_bytes(), name.as_bytes()) {
            return Some(position);
        }
        position += 1;
    }
    None
}

/// Comparison with `==` is not possible in a constant.
const fn equal(mut a: &[u8], mut b: &[u8]) -> bool {
    while let ([first, a_rest @ ..], [second, b_rest @ ..]) = (a, b) {
        if *first != *second {
            return false;
        }
        (a, b) = (a_rest, b_rest);
    }
    a.is_empty() && b.is_empty()
}
