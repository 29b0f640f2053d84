//! Parameters of the tile.

/// Zero of the Celsius scale, K.
pub const ZERO_C_K: f64 = 273.15;

/// A thermoelectric module, described by its data sheet, between two ceramic plates on a sink.
///
/// No data sheet of the thesis's module (Marlow DT 6-6) was found: the values are typical of its class, and none was
/// measured.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TileParams {
    /// Current at the largest temperature difference, A.
    pub imax_a: f64,
    /// Voltage at that current and difference, V.
    pub vmax_v: f64,
    /// Largest temperature difference, at zero heat load, K.
    pub dtmax_k: f64,
    /// Largest heat pumped, at zero temperature difference, W.
    pub qmax_w: f64,
    /// Hot-side temperature to which the data sheet refers, deg C.
    pub sheet_hot_c: f64,
    /// Temperature dependence of Seebeck coefficient, resistivity and conductivity: 1 that of bismuth telluride, 0 none.
    pub variation: f64,
    /// Heat capacity of the legs, J/K.
    pub legs_j_k: f64,
    /// Heat capacity of the copper tabs of one side, J/K.
    pub tabs_j_k: f64,
    /// Edge of the square ceramic plates, m.
    pub plate_m: f64,
    /// Thickness of one plate, m.
    pub ceramic_m: f64,
    /// Conductivity of the ceramic, W/(m K).
    pub ceramic_w_mk: f64,
    /// Volumetric heat capacity of the ceramic, J/(m3 K).
    pub ceramic_j_m3k: f64,
    /// Area of the display plate that a finger can touch, m2; the finger's heat is distributed uniformly over it.
    pub patch_m2: f64,
    /// Film coefficient of air on the display plate, radiation included, W/(m2 K).
    pub film_w_m2k: f64,
    /// Conductance of the thermal paste from the hot plate to the sink, W/K.
    pub paste_w_k: f64,
    /// Heat capacity of the sink, J/K.
    pub sink_j_k: f64,
    /// Thermal resistance from the sink to the coolant, K/W.
    pub sink_k_w: f64,
    /// Temperature of the coolant minus that of the room, K: 0 for a fan, negative for a chiller.
    pub coolant_k: f64,
}

impl TileParams {
    /// Typical module of 71 couples, 30 mm x 30 mm with 0.8 mm alumina plates, rated 6 A, 8.2 V and 67 K,
    /// on a fan-cooled sink.
    pub const NOMINAL: Self = Self {
        imax_a: 6.0,
        vmax_v: 8.2,
        dtmax_k: 67.0,
        qmax_w: 28.7,
        sheet_hot_c: 27.0,
        variation: 1.0,
        legs_j_k: 0.51,
        tabs_j_k: 0.52,
        plate_m: 0.030,
        ceramic_m: 0.8e-3,
        ceramic_w_mk: 24.0,
        ceramic_j_m3k: 3.05e6,
        patch_m2: 182.1e-6,
        film_w_m2k: 10.0,
        paste_w_k: 100.0,
        sink_j_k: 200.0,
        sink_k_w: 0.15,
        coolant_k: 0.0,
    };

    fn sheet_hot_k(&self) -> f64 {
        self.sheet_hot_c + ZERO_C_K
    }

    /// Seebeck coefficient of all couples at the data sheet's temperature, V/K.
    pub fn seebeck_v_k(&self) -> f64 {
        self.vmax_v / self.sheet_hot_k()
    }

    /// Resistance of all legs at the data sheet's temperature, ohm.
    pub fn resistance_ohm(&self) -> f64 {
        let hot_k = self.sheet_hot_k();
        self.vmax_v * (hot_k - self.dtmax_k) / (self.imax_a * hot_k)
    }

    /// Thermal conductance of all legs at the data sheet's temperature, W/K.
    pub fn conductance_w_k(&self) -> f64 {
        let hot_k = self.sheet_hot_k();
        self.imax_a * self.vmax_v * (hot_k - self.dtmax_k) / (2.0 * hot_k * self.dtmax_k)
    }

    /// Largest heat pumped that the other three data imply, W; a consistency check on the data sheet's own value.
    pub fn implied_qmax_w(&self) -> f64 {
        let hot_k = self.sheet_hot_k();
        self.imax_a * self.vmax_v * (hot_k + self.dtmax_k) / (2.0 * hot_k)
    }

    /// Area of a plate, m2.
    pub fn plate_m2(&self) -> f64 {
        self.plate_m * self.plate_m
    }
}
