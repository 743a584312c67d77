//! How a model with random effects is fitted.

/// How degrees of freedom are found.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum FreedomMethod {
    /// Satterthwaite's.
    #[default]
    Satterthwaite,
    /// Kenward and Roger's, with their standard errors.
    KenwardRoger,
}

/// What is asked of a mixed model.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct MixedChoice {
    /// Whether plain maximum likelihood is wanted, not restricted.
    pub maximum_likelihood: bool,
    /// How degrees of freedom are found.
    pub freedom: FreedomMethod,
}
