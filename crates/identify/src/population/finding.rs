//! Remarks on populations.

/// A remark on a population.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum PopulationFinding {
    /// Few fruit.
    #[error(
        "{fruits} fruit say little about how fruit differ: standard deviations between fruit are uncertain by {percent:.0} % and more"
    )]
    FewFruit {
        /// Fruit.
        fruits: usize,
        /// Relative standard error of a standard deviation from so many; %.
        percent: f64,
    },
    /// No fruit has a second impact.
    #[error(
        "no fruit has a second impact: what varies between impacts of one fruit is counted as variation between fruit"
    )]
    OneImpactEach,
    /// A standard deviation is zero.
    #[error(
        "the variation of {parameter} {level} fruit is estimated as zero: the impacts differ no more than their noise explains"
    )]
    NoVariation {
        /// The parameter.
        parameter: String,
        /// "between" or "within".
        level: &'static str,
    },
    /// A correlation is ±1.
    #[error(
        "the correlation of {first} and {second} {level} fruit ended at {value:.3}: the data cannot separate their variations"
    )]
    CorrelationAtBound {
        /// One parameter.
        first: String,
        /// The other.
        second: String,
        /// "between" or "within".
        level: &'static str,
        /// Correlation; 1.
        value: f64,
    },
    /// A covariate has one value.
    #[error("the covariate {covariate} is {value} for every impact and was left out")]
    ConstantCovariate {
        /// Its name.
        covariate: String,
        /// Its value.
        value: f64,
    },
    /// A covariate follows from others.
    #[error(
        "the covariate {covariate} follows from {others} and was left out: their effects cannot be separated"
    )]
    CollinearCovariate {
        /// Its name.
        covariate: String,
        /// Those before it.
        others: String,
    },
    /// The likelihood of an impact could not be followed to its mode.
    #[error(
        "the likelihood of {impacts} impacts could not be followed away from their fits; they count as normal observations there"
    )]
    NotFollowed {
        /// Impacts.
        impacts: usize,
    },
    /// The iterations did not settle.
    #[error(
        "the estimates still moved by {change:.3} standard errors after {iterations} iterations; they are not final"
    )]
    NoConvergence {
        /// Largest change; standard errors.
        change: f64,
        /// Iterations.
        iterations: usize,
    },
    /// The maximum of the likelihood was not reached.
    #[error(
        "the maximum of the population's likelihood was not reached; its values are not estimates"
    )]
    NoMaximum,
    /// The impacts are far from normal observations.
    #[error(
        "estimates with the true likelihood of the impacts differ from those of their normal approximation by {shift:.2} standard errors"
    )]
    NotNormal {
        /// Largest difference; standard errors.
        shift: f64,
    },
    /// The sampler of the posterior broke down in places.
    #[error(
        "the sampler diverged at {divergences} of {draws} draws of the posterior: it has corners that the draws do not reach"
    )]
    Diverged {
        /// How often.
        divergences: usize,
        /// Draws of all chains.
        draws: usize,
    },
    /// The chains of the posterior do not agree.
    #[error(
        "the chains of the posterior do not agree for {quantities} of its numbers (largest R-hat {r_hat:.3}, fewest independent draws {draws:.0}; 1.01 and 400 are required): raise --draws"
    )]
    NotMixed {
        /// Numbers concerned.
        quantities: usize,
        /// Largest spread of all chains over that within chains; 1.
        r_hat: f64,
        /// Fewest independent draws.
        draws: f64,
    },
}

impl PopulationFinding {
    /// Short name, for machines.
    pub fn code(&self) -> &'static str {
        match self {
            Self::FewFruit { .. } => "few-fruit",
            Self::OneImpactEach => "one-impact-each",
            Self::NoVariation { .. } => "no-variation",
            Self::CorrelationAtBound { .. } => "correlation-at-bound",
            Self::ConstantCovariate { .. } => "constant-covariate",
            Self::CollinearCovariate { .. } => "collinear-covariate",
            Self::NotFollowed { .. } => "not-followed",
            Self::NoConvergence { .. } => "no-convergence",
            Self::NoMaximum => "no-maximum",
            Self::NotNormal { .. } => "not-normal",
            Self::Diverged { .. } => "divergences",
            Self::NotMixed { .. } => "not-mixed",
        }
    }
}
