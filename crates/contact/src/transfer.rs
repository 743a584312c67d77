//! A law found in one geometry, taken to another.

use crate::apparent_modulus::{PressedContact, stiffness_per_modulus};
use crate::laws::kind::Law;
use crate::parameter::Elastic;

/// Contacts that the law was found in, or is wanted for.
#[derive(Clone, Debug, PartialEq)]
pub struct Geometry {
    /// Contacts in series: one on an impactor or a plate, two between plates.
    pub contacts: Vec<PressedContact>,
    /// E* of each contact relative to that of the fruit on a rigid body; 1.
    /// 0.5 for a fruit on an equal fruit.
    pub relative_modulus: f64,
}

/// Why a law cannot be taken to another geometry.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error(
    "the parameters of {law} do not follow from radii and moduli; only laws of Hertz's contact, \
     with k in N/m^1.5, can be taken to another geometry: hertz, kuwabara-kono"
)]
pub struct NotTransferable {
    /// Name of the law.
    pub law: &'static str,
}

/// A law in another geometry.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Transferred {
    /// The law there.
    pub law: Law,
    /// k there over k here; 1.
    pub stiffness_ratio: f64,
    /// c there over c here; 1.
    pub damping_ratio: f64,
}

/// The same material in another geometry.
///
/// k goes as E*√R*; with two contacts in series each deforms by half, so that
/// k is 2^1.5 times smaller than of one. In Kuwabara-Kono's law the ratio c/k
/// is a property of the material, so that c goes with k. Both contacts of
/// a fruit between plates share the deformation and its rate alike, so that the
/// ratio holds for them too.
///
/// # Errors
/// [`NotTransferable`] for any law but Hertz's and Kuwabara-Kono's.
///
/// # Example
/// The pendulum study of 2003: impactor 25 mm, apple 41.5 mm, against a plate.
/// ```
/// use windfall_contact::apparent_modulus::{PressedContact, PrincipalRadii};
/// use windfall_contact::expression::parse_law;
/// use windfall_contact::transfer::{Geometry, transfer};
/// let on = |indenter| Geometry {
///     contacts: vec![PressedContact { fruit: PrincipalRadii::sphere(0.0415), indenter }],
///     relative_modulus: 1.0,
/// };
/// let law = parse_law("hertz(k=733196)").unwrap().complete().unwrap();
/// let plate = on(PrincipalRadii::PLANE);
/// let impactor = on(PrincipalRadii::sphere(0.025));
/// let there = transfer(law, &plate, &impactor).unwrap();
/// assert!((there.stiffness_ratio - 0.6131393).abs() < 1e-7);
/// ```
pub fn transfer(law: Law, from: &Geometry, to: &Geometry) -> Result<Transferred, NotTransferable> {
    let refused = NotTransferable {
        law: law.kind().name(),
    };
    if law.kind().describe().elastic != Elastic::Hertzian {
        return Err(refused);
    }
    let per_modulus = |g: &Geometry| g.relative_modulus * stiffness_per_modulus(&g.contacts);
    let ratio = per_modulus(to) / per_modulus(from);
    let values: Vec<f64> = law.parameters().iter().map(|value| value * ratio).collect();
    let law = law.kind().from_values(&values).ok_or(refused)?;
    Ok(Transferred {
        law,
        stiffness_ratio: ratio,
        damping_ratio: ratio,
    })
}
