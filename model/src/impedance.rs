//! Surface impedance of a body as a sum of relaxations.

/// One relaxation `gain / (s + rate)` of a surface impedance.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Relaxation {
    /// Rate, 1/s; 0 for an integrator.
    pub rate_1_s: f64,
    /// Gain, m² K/J: rise of the surface, K, per J/m² that has just flowed in.
    pub gain_m2k_j: f64,
}

/// Surface impedance `Z(s) = direct + sum of gain / (s + rate)` of a body, m² K/W: by how many kelvin a heat flux into
/// its surface moves that surface.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Impedance<'a> {
    /// Direct term, m² K/W: the rise that follows the flux without delay.
    pub direct_m2k_w: f64,
    /// Relaxations, in any order.
    pub relaxations: &'a [Relaxation],
}

impl Impedance<'_> {
    /// Impedance, m² K/W, at the real Laplace variable `s_1_s`, 1/s, which must be above 0.
    pub fn at(&self, s_1_s: f64) -> f64 {
        let terms = self.relaxations.iter();
        self.direct_m2k_w + terms.map(|one| one.gain_m2k_j / (s_1_s + one.rate_1_s)).sum::<f64>()
    }

    /// Rise of the surface per flux, m² K/W, `t_s` seconds after a constant flux has begun.
    pub fn step_response(&self, t_s: f64) -> f64 {
        let term = |one: &Relaxation| {
            let x = one.rate_1_s * t_s;
            one.gain_m2k_j * if x > 0.0 { -libm::expm1(-x) / one.rate_1_s } else { t_s }
        };
        self.direct_m2k_w + self.relaxations.iter().map(term).sum::<f64>()
    }
}
