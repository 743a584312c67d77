//! Remarks on fits.

use windfall_numerics::written::{p_value, plain, unit_text};

/// Probability below which residuals are called hardly random; 1.
pub const LACK_OF_FIT: f64 = 0.01;

/// A remark on one fit.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum Finding {
    /// The minimiser did not reach a minimum.
    #[error(
        "the fit stopped after {evaluations} evaluations without reaching a minimum; its values are not estimates"
    )]
    NoConvergence {
        /// Evaluations used.
        evaluations: usize,
    },
    /// A parameter ended on its bound.
    #[error(
        "{} ended on its {side} bound {}{}: the data call for a value beyond it, or do not determine it",
        in_a_sentence(parameter), Shown(*bound, unit),
        if *given { ", which was given" } else { "" }
    )]
    AtBound {
        /// Name of the parameter.
        parameter: String,
        /// "lower" or "upper".
        side: &'static str,
        /// The bound; SI.
        bound: f64,
        /// Its unit.
        unit: String,
        /// Whether the user gave it.
        given: bool,
    },
    /// Data and prior contradict each other.
    #[error(
        "the prior of {}, {} ± {}, and the data, which alone say {} ± {}, are {apart:.1} of their deviations apart{}",
        in_a_sentence(parameter), Shown(prior.0, unit), Shown(prior.1, unit), Shown(data.0, unit), Shown(data.1, unit),
        if *pulled {
            ": the estimate lies between two values of which one is wrong"
        } else {
            ": the data outweigh it"
        }
    )]
    PriorContradicted {
        /// Name of the parameter.
        parameter: String,
        /// Its unit.
        unit: String,
        /// Mean and standard deviation of the prior; SI.
        prior: (f64, f64),
        /// What the data say without it, with its standard deviation; SI.
        data: (f64, f64),
        /// Their difference, in its deviations; 1.
        apart: f64,
        /// Whether the prior moves the estimate noticeably.
        pulled: bool,
    },
    /// A prior says more than the data.
    #[error(
        "{:.0} % of what is known of {} is its prior: the impact hardly tells it",
        100.0 * share, in_a_sentence(parameter)
    )]
    MostlyPrior {
        /// Name of the parameter.
        parameter: String,
        /// Variance of the estimate over that of the prior; 1.
        share: f64,
    },
    /// A nuisance was left out of the free parameters.
    #[error("{quantity} was held at {}: {reason}", Shown(*value, unit))]
    Held {
        /// What was held.
        quantity: &'static str,
        /// Its value; SI.
        value: f64,
        /// Its unit.
        unit: &'static str,
        /// Why.
        reason: &'static str,
    },
    /// Nuisances that were estimated.
    #[error("estimated besides the law: {quantities}")]
    Freed {
        /// Their names.
        quantities: String,
    },
    /// Two parameters move together.
    #[error(
        "{} and {} can hardly be separated in this impact (correlation {correlation:.4})",
        in_a_sentence(first),
        in_a_sentence(second)
    )]
    Correlated {
        /// One parameter.
        first: String,
        /// The other.
        second: String,
        /// Their correlation; 1.
        correlation: f64,
    },
    /// The normal matrix is singular.
    #[error("the data cannot separate the free parameters: standard deviations are not available")]
    Singular,
    /// The residuals of a channel are not random.
    #[error(
        "the residuals of {quantity} are not random (runs test z = {z:.1}): the law or the rig misses part of the signal, or the channel's noise is correlated"
    )]
    StructuredResiduals {
        /// The quantity.
        quantity: &'static str,
        /// Standardised number of runs; 1.
        z: f64,
    },
    /// The residuals of a channel are hardly random.
    #[error(
        "the residuals of {quantity} change sign less often than chance explains (runs test, {}); of 500 impacts that a law describes, up to five have this by chance",
        p_value(*p)
    )]
    LackOfFit {
        /// The quantity.
        quantity: &'static str,
        /// Probability of so few runs by chance, in any of the quantities; 1.
        p: f64,
    },
    /// The residuals are much larger than the channel's own noise.
    #[error(
        "the residuals of {quantity} are {ratio:.1} times its own noise ({}): the law does not describe the signal to its accuracy",
        plain(*noise)
    )]
    Misfit {
        /// The quantity.
        quantity: &'static str,
        /// Root mean square residual over noise; 1.
        ratio: f64,
        /// Noise of a sample; SI.
        noise: f64,
    },
    /// The uncertainty of the mass widens the intervals.
    #[error("the intervals include the uncertainty of the mass, {} ± {}", Shown(*mass, ""), Shown(*sd, "kg"))]
    UncertainMass {
        /// Mass; kg.
        mass: f64,
        /// Its standard uncertainty; kg.
        sd: f64,
    },
    /// The uncertainties of the bench widen the intervals.
    #[error("the intervals include the uncertainty of the bench: {}", quantities.join(", "))]
    UncertainBench {
        /// Each quantity with its standard uncertainty.
        quantities: Vec<String>,
    },
    /// The uncertainty of a quantity of the bench could not be carried over.
    #[error("the uncertainty of the bench's {quantity}, {}, is not in the intervals: with another value the fit failed; they are too narrow", Shown(*sd, unit))]
    BenchLeftOut {
        /// Its name.
        quantity: &'static str,
        /// Its standard uncertainty; SI.
        sd: f64,
        /// SI unit.
        unit: &'static str,
    },
    /// A counted displacement was taken at the changes of its count.
    #[error("displacement is counted in steps of {}: it took part with the {edges} instants at which its count changes", Shown(*quantum, "m"))]
    CountedDisplacement {
        /// Changes of the count.
        edges: usize,
        /// Length of a count; m.
        quantum: f64,
    },
    /// The rate was derived from the displacement.
    #[error("velocity was derived from displacement, so it was not fitted separately")]
    ComputedRate,
    /// A parameter is hard to separate from another.
    #[error(
        "{quantities} alone hardly separate {0} from {1}: {0} would be known {factor:.0} times better if {1} were known; the least determined combination is {direction}",
        in_a_sentence(parameter),
        in_a_sentence(partner)
    )]
    WeakDirection {
        /// A parameter of the law.
        parameter: String,
        /// What it trades with.
        partner: String,
        /// Standard deviation over that with the partner known; 1.
        factor: f64,
        /// Quantities in the fit.
        quantities: String,
        /// The weakest direction, in words.
        direction: String,
    },
    /// A profile has no end on one side.
    #[error(
        "the {side} end of the interval of {} is open: the data do not exclude any value tried on that side",
        in_a_sentence(parameter)
    )]
    OpenInterval {
        /// Name of the parameter.
        parameter: String,
        /// "lower" or "upper".
        side: &'static str,
    },
    /// Replicates of a bootstrap could not be fitted.
    #[error(
        "{failed} of {replicates} resampled recordings could not be fitted and are left out: the intervals may be too narrow"
    )]
    FailedReplicates {
        /// How many.
        failed: usize,
        /// Of how many.
        replicates: usize,
    },
    /// The sampler broke down in places.
    #[error(
        "the sampler diverged at {divergences} of {draws} draws: the posterior has corners that it does not reach; do not rely on its intervals, compare with --intervals profile"
    )]
    Divergences {
        /// How often.
        divergences: usize,
        /// Draws of all chains.
        draws: usize,
    },
    /// The chains of a posterior do not agree.
    #[error(
        "the chains for {} do not agree (R-hat {r_hat:.3}, {draws:.0} independent draws; 1.01 and 400 are required): draw more, or the data do not determine it",
        in_a_sentence(parameter)
    )]
    NotMixed {
        /// Name of the parameter.
        parameter: String,
        /// Spread of all chains over that within chains; 1.
        r_hat: f64,
        /// Independent draws.
        draws: f64,
    },
    /// The wanted intervals could not be made.
    #[error(
        "{method} intervals could not be computed (no convergence, or inseparable parameters): those shown are estimate ± t standard deviations"
    )]
    IntervalsAsymptotic {
        /// The method.
        method: &'static str,
    },
    /// A wanted quantity is missing.
    #[error("{quantity} is not in the recording and took no part in the fit")]
    MissingQuantity {
        /// The quantity.
        quantity: &'static str,
    },
    /// The law's restitution is not what it delivers.
    #[error(
        "the law's restitution parameter is {nominal:.4}, but the impact it describes rebounds with {delivered:.4}"
    )]
    NominalRestitution {
        /// The law's parameter; 1.
        nominal: f64,
        /// What the law does; 1.
        delivered: f64,
    },
}

impl Finding {
    /// The quantity that is meant, where it is one.
    pub fn quantity(&self) -> Option<&'static str> {
        match self {
            Self::StructuredResiduals { quantity, .. }
            | Self::LackOfFit { quantity, .. }
            | Self::Misfit { quantity, .. }
            | Self::MissingQuantity { quantity } => Some(quantity),
            _ => None,
        }
    }

    /// Stable name for scripts.
    pub fn code(&self) -> &'static str {
        match self {
            Self::NoConvergence { .. } => "no-convergence",
            Self::AtBound { .. } => "at-bound",
            Self::PriorContradicted { pulled: true, .. } => "prior-contradicted",
            Self::PriorContradicted { .. } => "prior-outweighed",
            Self::MostlyPrior { .. } => "mostly-prior",
            Self::Held { .. } => "held",
            Self::Freed { .. } => "freed",
            Self::Correlated { .. } => "correlated",
            Self::Singular => "singular",
            Self::StructuredResiduals { .. } => "structured-residuals",
            Self::LackOfFit { .. } => "lack-of-fit",
            Self::Misfit { .. } => "misfit",
            Self::UncertainMass { .. } => "uncertain-mass",
            Self::UncertainBench { .. } => "uncertain-bench",
            Self::BenchLeftOut {
                quantity: "mass", ..
            } => "mass-left-out",
            Self::BenchLeftOut { .. } => "bench-left-out",
            Self::CountedDisplacement { .. } => "counted-displacement",
            Self::ComputedRate => "computed-rate",
            Self::WeakDirection { .. } => "weak-direction",
            Self::OpenInterval { .. } => "open-interval",
            Self::FailedReplicates { .. } => "failed-replicates",
            Self::Divergences { .. } => "divergences",
            Self::NotMixed { .. } => "not-mixed",
            Self::IntervalsAsymptotic { .. } => "intervals-asymptotic",
            Self::MissingQuantity { .. } => "missing-quantity",
            Self::NominalRestitution { .. } => "nominal-restitution",
        }
    }
}

/// A parameter in a sentence: those of a law as they are called, what is estimated besides in words.
pub fn in_a_sentence(name: &str) -> String {
    match name {
        "displacement_offset" | "initial_velocity" => name.replace('_', " "),
        _ => name.to_owned(),
    }
}

/// A number of four significant digits with its unit, if it has one.
pub(crate) struct Shown<'a>(pub f64, pub &'a str);

impl std::fmt::Display for Shown<'_> {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let Self(value, unit) = *self;
        let magnitude = value.abs().log10().floor();
        if value == 0.0 {
            f.write_str("0")?;
        } else if (-4.0..5.0).contains(&magnitude) {
            let decimals = (3.0 - magnitude).max(0.0) as usize;
            let text = format!("{value:.decimals$}");
            match text.contains('.') {
                true => f.write_str(text.trim_end_matches('0').trim_end_matches('.'))?,
                false => f.write_str(&text)?,
            }
        } else {
            f.write_str(&plain(value))?;
        }
        match unit {
            "" | "1" => Ok(()),
            unit => write!(f, " {}", unit_text(unit)),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn closed_form_four_digits_and_no_unit_of_one() {
        let at_bound = Finding::AtBound {
            parameter: "p".to_owned(),
            side: "upper",
            bound: 6.0,
            unit: "1".to_owned(),
            given: false,
        };
        assert_eq!(
            at_bound.to_string(),
            "p ended on its upper bound 6: the data call for a value beyond it, or do not determine it"
        );
        let uncertain = Finding::UncertainMass {
            mass: 0.517_517_338_604_740_6,
            sd: 0.004_415_280_502_853_594,
        };
        assert_eq!(
            uncertain.to_string(),
            "the intervals include the uncertainty of the mass, 0.5175 ± 0.004415 kg"
        );
        let cases = [
            (0.0, "0"),
            (-12.345_678, "-12.35"),
            (394_931.0, "394931"),
            (39_493.1, "39493"),
            (1e-9, "1.000·10⁻⁹"),
            (0.000_123_456, "0.0001235"),
            (100.0, "100"),
        ];
        for (value, text) in cases {
            assert_eq!(Shown(value, "").to_string(), text);
        }
        assert_eq!(Shown(0.388, "m/s").to_string(), "0.388 m/s");
    }
}
