//! What the user of an own law should know, though the law can be used.

/// A remark on a user's law.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum UserLawFinding {
    /// Pieces whose meeting point is not known beforehand.
    #[error(
        "the formula changes its piece at {places} place(s) that cannot be located beforehand; the integrator finds them by shorter steps. A change at one displacement, as in max(x - d, 0), is located"
    )]
    KinkNotLocated {
        /// How many.
        places: usize,
    },
    /// A force at first touch and at rest.
    #[error("the force at first touch is {force:.4e} N even at rest: it does not begin at zero")]
    ForceAtTouch {
        /// The force; N.
        force: f64,
    },
    /// A force at rest that does not rise with the displacement.
    #[error(
        "at rest the force does not rise with the displacement from x = {displacement:.3e} m on (with {values})"
    )]
    DoesNotRise {
        /// From where; m.
        displacement: f64,
        /// Values of the parameters, as text.
        values: String,
    },
    /// No value beyond some displacement.
    #[error("the force has no finite value beyond x = {displacement:.3e} m (with {values})")]
    UndefinedBeyond {
        /// From where; m.
        displacement: f64,
        /// Values of the parameters, as text.
        values: String,
    },
    /// A force that pulls at large displacements.
    #[error("while loading the force pulls from x = {displacement:.3e} m on (with {values})")]
    PullsBeyond {
        /// From where; m.
        displacement: f64,
        /// Values of the parameters, as text.
        values: String,
    },
    /// A rate-dependent force that differs on both sides of the largest displacement.
    #[error(
        "where a reloading passes x_max = {peak:.3e} m at v = {rate} m/s, the force jumps from {unloading:.4e} N to {loading:.4e} N: derivatives are not exact for impacts that load twice; write the same damping in force and unloading"
    )]
    JumpsOnReloading {
        /// Largest displacement; m.
        peak: f64,
        /// Rate; m/s.
        rate: f64,
        /// Force by the formula of unloading; N.
        unloading: f64,
        /// Force by the formula of loading; N.
        loading: f64,
    },
    /// Unloading that gives back more than loading took.
    #[error(
        "at rest, unloading from x_max = {peak:.3e} m pushes more than loading did (at x = {displacement:.3e} m, with {values}): the contact gives back more energy than it took"
    )]
    GainsEnergy {
        /// Largest displacement; m.
        peak: f64,
        /// Displacement; m.
        displacement: f64,
        /// Values of the parameters, as text.
        values: String,
    },
    /// A unit that holds for one value of an exponent only.
    #[error(
        "the units hold only where {exponent} = {value}: write the exponent's name in them, as in N/m^{exponent}, so that they hold for every value"
    )]
    UnitOfOneExponent {
        /// The exponent.
        exponent: String,
        /// Its value; 1.
        value: f64,
    },
}

impl UserLawFinding {
    /// Stable name for scripts.
    pub fn code(&self) -> &'static str {
        match self {
            Self::KinkNotLocated { .. } => "kink-not-located",
            Self::ForceAtTouch { .. } => "force-at-touch",
            Self::DoesNotRise { .. } => "does-not-rise",
            Self::UndefinedBeyond { .. } => "undefined-beyond",
            Self::PullsBeyond { .. } => "pulls-beyond",
            Self::JumpsOnReloading { .. } => "jumps-on-reloading",
            Self::GainsEnergy { .. } => "gains-energy",
            Self::UnitOfOneExponent { .. } => "unit-of-one-exponent",
        }
    }
}
