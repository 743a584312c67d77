//! Radius of curvature of a fruit from what can be measured on it.

use crate::apparent_modulus::PrincipalRadii;

/// Radius of curvature from a chord and its sagitta, as a gauge with a dial
/// between two feet shows them:
///
/// ```text
/// R = AC²/(8 BD) + BD/2
/// ```
///
/// * `chord`: AC, distance of the feet; m
/// * `sagitta`: BD, height of the surface above the chord; m
///
/// # Source
/// ASAE S368 (radius of curvature gauge).
///
/// # Example
/// ```
/// // A circle of 5 mm, chord 8 mm: sagitta 5 − 3 = 2 mm.
/// let r = windfall_contact::curvature::radius_from_chord(8e-3, 2e-3);
/// assert!((r - 5e-3).abs() < 1e-15);
/// ```
pub fn radius_from_chord(chord: f64, sagitta: f64) -> f64 {
    chord * chord / (8.0 * sagitta) + 0.5 * sagitta
}

/// Principal radii of an ellipsoid where its first axis meets the surface:
///
/// ```text
/// R = b²/a,   R' = c²/a
/// ```
///
/// * `pressed`: diameter 2a along the axis on which the fruit is pressed or
///   struck; m
/// * `second`, `third`: diameters 2b and 2c at right angles to it; m
///
/// # Example
/// ```
/// let radii = windfall_contact::curvature::radii_of_ellipsoid(0.08, 0.08, 0.06);
/// assert!((radii.first - 0.04).abs() < 1e-15 && (radii.second - 0.0225).abs() < 1e-15);
/// ```
pub fn radii_of_ellipsoid(pressed: f64, second: f64, third: f64) -> PrincipalRadii {
    PrincipalRadii {
        first: second * second / (2.0 * pressed),
        second: third * third / (2.0 * pressed),
    }
}

/// Radius of a sphere of the same mean curvature, 2/(1/R + 1/R'); m.
///
/// Where radii differ little it stands for both: the stiffness of Hertz's
/// contact differs in second order only.
pub fn mean_radius(radii: PrincipalRadii) -> f64 {
    2.0 / (1.0 / radii.first + 1.0 / radii.second)
}
