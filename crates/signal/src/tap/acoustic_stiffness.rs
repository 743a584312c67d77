//! Stiffness of a fruit from its mass and the frequency of its first spheroidal
//! mode.

use crate::uncertain::Uncertain;

/// 10⁶ Hz² g^(2/3), the unit of most papers, per Hz² kg^(2/3).
pub const MEGAHERTZ_GRAM: f64 = 1e-4;

/// Stiffness factor of a fruit; Hz² kg^(2/3), which is kg^(2/3)/s².
///
/// ```text
/// S = f² m^(2/3)
/// ```
///
/// It does not depend on size for fruit of one shape and density.
///
/// * `frequency`: of the first spheroidal mode; Hz
/// * `mass`: kg
///
/// # Source
/// Cooke and Rand (1973), J. Agric. Eng. Res. 18:141, on the mode and the
/// exponent 2/3. Uncertainties add in squares, relative: 2 u(f)/f and ⅔ u(m)/m.
pub fn acoustic_stiffness(frequency: Uncertain, mass: Uncertain) -> Uncertain {
    let value = frequency.value.powi(2) * mass.value.powf(2.0 / 3.0);
    let of_frequency = 2.0 * frequency.sd / frequency.value;
    let of_mass = 2.0 / 3.0 * mass.sd / mass.value;
    Uncertain::new(value, value * of_frequency.hypot(of_mass))
}

/// Stiffness with the density; Pa.
///
/// ```text
/// S = f² m^(2/3) ρ^(1/3)
/// ```
///
/// It is proportional to the modulus of elasticity; the factor depends on shape
/// and Poisson's ratio.
///
/// * `density`: kg/m³
pub fn acoustic_stiffness_with_density(stiffness: Uncertain, density: Uncertain) -> Uncertain {
    let value = stiffness.value * density.value.cbrt();
    let of_density = density.sd / density.value / 3.0;
    Uncertain::new(
        value,
        value * (stiffness.sd / stiffness.value).hypot(of_density),
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    const fn exact(value: f64) -> Uncertain {
        Uncertain::new(value, 0.0)
    }

    #[test]
    fn reference_of_the_domain_description() {
        // 800 Hz and 0.2 kg: 218876.9 Hz² kg^(2/3), 21.89 · 10⁶ Hz² g^(2/3).
        let s = acoustic_stiffness(exact(800.0), exact(0.2));
        assert!((s.value - 218_876.9).abs() < 0.05);
        // The same in grams by hand: 800² · 200^(2/3).
        let grams = 640_000.0 * 200.0_f64.powf(2.0 / 3.0) / 1e6;
        assert!((s.value * MEGAHERTZ_GRAM - grams).abs() < 1e-10);
        // 850 kg/m³: its cube root is 9.472682.
        let with = acoustic_stiffness_with_density(s, exact(850.0));
        assert!((with.value / s.value - 9.472_682).abs() < 1e-6);
    }

    #[test]
    fn derivative_of_the_stiffness_gives_its_uncertainty() {
        let (f, m) = (Uncertain::new(800.0, 2.0), Uncertain::new(0.2, 0.001));
        let at = |f: f64, m: f64| acoustic_stiffness(exact(f), exact(m)).value;
        let by_f = (at(800.01, 0.2) - at(799.99, 0.2)) / 0.02 * 2.0;
        let by_m = (at(800.0, 0.200_01) - at(800.0, 0.199_99)) / 0.000_02 * 0.001;
        let sd = acoustic_stiffness(f, m).sd;
        assert!((sd / by_f.hypot(by_m) - 1.0).abs() < 1e-6 && by_m > 0.0);
    }
}
