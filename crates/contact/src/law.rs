//! The one trait to extend: a normal contact-force law.

use serde::Serialize;
use windfall_numerics::real::Real;

/// A force law evaluated at one state, with its exact first derivatives.
///
/// `N` is the number of the law's parameters, in the order of its
/// [`LawDescription`](crate::parameter::LawDescription).
#[derive(Clone, Copy, Debug)]
pub struct ContactForce<R, const N: usize> {
    /// F, the force of the law before it is clamped to be repulsive; N.
    pub force: R,
    /// ∂F/∂d at constant rate; N/m.
    pub by_displacement: R,
    /// ∂F/∂v at constant displacement; N s/m.
    pub by_rate: R,
    /// ∂F/∂p for each parameter; N per unit of the parameter.
    pub by_parameter: [R; N],
    /// ∂F/∂d_peak for laws that remember their largest displacement; N/m.
    pub by_peak: R,
}

impl<R: Real, const N: usize> ContactForce<R, N> {
    /// Force and derivatives times `factor`.
    #[inline(always)]
    #[must_use]
    pub fn scaled(mut self, factor: R) -> Self {
        for by in &mut self.by_parameter {
            *by = *by * factor;
        }
        Self {
            force: self.force * factor,
            by_displacement: self.by_displacement * factor,
            by_rate: self.by_rate * factor,
            by_peak: self.by_peak * factor,
            ..self
        }
    }

    /// The same as numbers like `like`.
    #[inline(always)]
    pub fn with_plain<S: Real<Plain = R>>(self, like: S) -> ContactForce<S, N> {
        ContactForce {
            force: like.with_plain(self.force),
            by_displacement: like.with_plain(self.by_displacement),
            by_rate: like.with_plain(self.by_rate),
            by_parameter: like.with_each_plain(self.by_parameter),
            by_peak: like.with_plain(self.by_peak),
        }
    }
}

/// A normal contact-force law F(d, v; p).
///
/// * `displacement`: d, indentation, positive in contact; m
/// * `rate`: v = dd/dt, positive while loading; m/s
/// * `peak`: largest displacement reached before the present unloading; m.
///   It is 0 until the first maximum. Only laws with
///   [`HISTORY`](ContactLaw::HISTORY) use it.
///
/// The force is positive when it pushes the bodies apart. The caller clamps it
/// to be non-negative and ends the contact; the law returns its raw value, so
/// that the end can be located as a change of sign.
///
/// `evaluate` is called with displacements at or above
/// [`SMALLEST_DISPLACEMENT`], where every law and its derivatives are finite.
pub trait ContactLaw<const N: usize>: Copy + Send + Sync {
    /// Whether the force depends on the largest displacement so far.
    const HISTORY: bool = false;

    /// Power q of the substitution t = s^q that makes the start of contact
    /// smooth: 2 for a law that starts like √d, 4 for d^¼, 1 for a smooth one.
    const START_POWER: u32 = 2;

    /// [`HISTORY`](Self::HISTORY) of this value.
    #[inline(always)]
    fn history(&self) -> bool {
        Self::HISTORY
    }

    /// [`START_POWER`](Self::START_POWER) of this value.
    #[inline(always)]
    fn start_power(&self) -> u32 {
        Self::START_POWER
    }

    /// Force and its derivatives.
    fn evaluate<R: Real>(&self, displacement: R, rate: R, peak: R) -> ContactForce<R, N>;

    /// Displacement at which the law changes its formula while loading, if
    /// there is one; m. The integrator ends a step there.
    fn kink(&self) -> f64 {
        f64::INFINITY
    }
}

/// Declares the conversions of a law from and into the values of its parameters, in the
/// order of its description.
macro_rules! from_values {
    ($law:ident [$($field:ident),*]) => {
        impl From<[f64; [$(stringify!($field)),*].len()]> for $law {
            fn from([$($field),*]: [f64; [$(stringify!($field)),*].len()]) -> Self {
                Self { $($field),* }
            }
        }

        impl From<$law> for [f64; [$(stringify!($field)),*].len()] {
            fn from(law: $law) -> Self {
                [$(law.$field),*]
            }
        }
    };
}
pub(crate) use from_values;

/// Displacements below this are evaluated here: fractional powers keep finite
/// derivatives, and the force is indistinguishable from that at touch; m.
pub const SMALLEST_DISPLACEMENT: f64 = 1e-30;

/// When a contact is over.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum EndRule {
    /// At the first return of the law's force to zero: no adhesion.
    #[default]
    ForceZero,
    /// When the gap opens again (displacement back to zero); the force may be
    /// attractive before. For comparison with studies that use it.
    GapZero,
}
