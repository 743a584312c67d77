//! Apparent modulus of a fruit between plates.

use crate::hertz_elliptic::approach_length;

/// Principal radii of curvature where a body is touched; m. A plane has
/// infinite ones.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PrincipalRadii {
    /// One principal radius; m.
    pub first: f64,
    /// The other; m.
    pub second: f64,
}

impl PrincipalRadii {
    /// A sphere.
    pub fn sphere(radius: f64) -> Self {
        Self {
            first: radius,
            second: radius,
        }
    }

    /// A plate.
    pub const PLANE: Self = Self {
        first: f64::INFINITY,
        second: f64::INFINITY,
    };
}

/// One contact of a fruit: its own radii there and those of what presses.
///
/// The principal directions of both are taken as parallel.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PressedContact {
    /// Radii of the fruit.
    pub fruit: PrincipalRadii,
    /// Radii of the plate or indenter.
    pub indenter: PrincipalRadii,
}

fn length(contact: &PressedContact) -> f64 {
    let (fruit, indenter) = (contact.fruit, contact.indenter);
    approach_length(
        1.0 / fruit.first + 1.0 / indenter.first,
        1.0 / fruit.second + 1.0 / indenter.second,
    )
}

/// Stiffness per effective modulus, k/E*, of all contacts in series:
///
/// ```text
/// F = k D^1.5,   k = E* / (C₁ + C₂)^1.5,   dᵢ = Cᵢ (F/E*)^(2/3)
/// ```
///
/// One sphere on a plate gives (4/3)√R, between two plates 2^(−1.5) of it.
/// Unit: m^0.5.
pub fn stiffness_per_modulus(contacts: &[PressedContact]) -> f64 {
    contacts.iter().map(length).sum::<f64>().powf(-1.5)
}

/// Apparent modulus of elasticity from the stiffness k in F = k D^1.5; Pa.
///
/// ```text
/// E = (1 − ν²) k / (k/E*)
/// ```
///
/// The plates count as rigid. In the words of ASAE S368 with its K from Hertz's
/// integrals in place of a table; equal, for one sphere and one plate, to
/// E = 0.75 F (1 − ν²)/(√R D^1.5). The standard treats it as an apparent value,
/// for comparison at equal deformation and rate.
///
/// * `stiffness`: k; N/m^1.5
/// * `poisson`: ν of the fruit; 1
///
/// # Source
/// ASAE S368; Hertz (1881).
///
/// # Example
/// ```
/// use windfall_contact::apparent_modulus::{PressedContact, PrincipalRadii, apparent_modulus};
/// let contact = PressedContact {
///     fruit: PrincipalRadii::sphere(0.04),
///     indenter: PrincipalRadii::PLANE,
/// };
/// let one = apparent_modulus(1e6, 0.3, &[contact]);
/// assert!((one / (0.75 * 1e6 * 0.91 / 0.2) - 1.0).abs() < 1e-12);
/// let two = apparent_modulus(1e6, 0.3, &[contact, contact]);
/// assert!((two / one - 8.0_f64.sqrt()).abs() < 1e-12);
/// ```
pub fn apparent_modulus(stiffness: f64, poisson: f64, contacts: &[PressedContact]) -> f64 {
    (1.0 - poisson * poisson) * stiffness / stiffness_per_modulus(contacts)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// ASAE S368 with its printed constants: 0.338 and K = 1.351 for a sphere.
    #[test]
    fn reference_asae_s368_for_spheres() {
        let (force, deformation, poisson): (f64, f64, f64) = (20.0, 1.2e-3, 0.3);
        let (radius, k): (f64, f64) = (0.036, 1.351);
        let term = k * (2.0 / radius).cbrt();
        for plates in [1, 2] {
            let sum = f64::from(plates) * term;
            let standard =
                0.338 * force * (1.0 - poisson * poisson) / deformation.powf(1.5) * sum.powf(1.5);
            let contact = PressedContact {
                fruit: PrincipalRadii::sphere(radius),
                indenter: PrincipalRadii::PLANE,
            };
            let contacts = vec![contact; plates as usize];
            let found = apparent_modulus(force / deformation.powf(1.5), poisson, &contacts);
            assert!(
                (found / standard - 1.0).abs() < 2e-3,
                "{plates}: {found} {standard}"
            );
        }
    }

    #[test]
    fn closed_form_sphere_on_sphere() {
        // R* = 15.6015 mm of 41.5 and 25 mm: k/E* = (4/3)√R*.
        let contact = PressedContact {
            fruit: PrincipalRadii::sphere(0.0415),
            indenter: PrincipalRadii::sphere(0.025),
        };
        let effective: f64 = 1.0 / (1.0 / 0.0415 + 1.0 / 0.025);
        let found = stiffness_per_modulus(&[contact]);
        assert!((found / (4.0 / 3.0 * effective.sqrt()) - 1.0).abs() < 1e-12);
    }
}
