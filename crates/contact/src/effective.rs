//! Effective mass, radius and modulus of two bodies, and the stiffness of Hertz.

/// 1/m = 1/m1 + 1/m2; kg. A wall has an infinite mass.
///
/// # Source
/// Johnson (1985), Contact Mechanics, section 11.4.
pub fn effective_mass(first: f64, second: f64) -> f64 {
    1.0 / (1.0 / first + 1.0 / second)
}

/// 1/R* = 1/R1 + 1/R2; m. A plane has an infinite radius.
///
/// # Source
/// Johnson (1985), Contact Mechanics, eq. (4.19).
pub fn effective_radius(first: f64, second: f64) -> f64 {
    1.0 / (1.0 / first + 1.0 / second)
}

/// Young's modulus and Poisson's ratio of an isotropic elastic body.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Elastic {
    /// Young's modulus, E; Pa. Infinite for a rigid body.
    pub modulus: f64,
    /// Poisson's ratio, ν; 1.
    pub poisson: f64,
}

/// 1/E* = (1 − ν1²)/E1 + (1 − ν2²)/E2; Pa.
///
/// # Source
/// Johnson (1985), Contact Mechanics, eq. (4.20).
pub fn effective_modulus(first: Elastic, second: Elastic) -> f64 {
    let compliance = |body: Elastic| (1.0 - body.poisson * body.poisson) / body.modulus;
    1.0 / (compliance(first) + compliance(second))
}

/// k = (4/3) E* √R*, the stiffness of Hertz; N/m^1.5.
///
/// * `modulus`: E*; Pa
/// * `radius`: R*; m
///
/// # Source
/// Hertz (1881); Johnson (1985), Contact Mechanics, eq. (4.23).
///
/// # Example
/// ```
/// use windfall_contact::effective::hertz_stiffness;
/// assert_eq!(hertz_stiffness(3e6, 0.04), 4e6 * 0.2);
/// ```
pub fn hertz_stiffness(modulus: f64, radius: f64) -> f64 {
    4.0 / 3.0 * modulus * radius.sqrt()
}
