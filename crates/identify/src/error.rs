//! What can go wrong in a simulation or a fit.

use windfall_numerics::ode::step::StepError;

/// Why an impact cannot be a member of a population.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
pub enum Unusable {
    /// The fit did not converge.
    #[error("its fit did not converge")]
    NoConvergence,
    /// A parameter ended on its bound.
    #[error("a parameter of its fit ended on a bound")]
    AtBound,
    /// The covariance is singular.
    #[error("its fit cannot separate the free parameters")]
    Singular,
}

/// Errors of this crate.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum Error {
    /// No two laws could be fitted to the same impacts.
    #[error(
        "no impact could be fitted by two of the {laws} laws, out of {impacts} impacts: there is nothing to compare"
    )]
    NothingToCompare {
        /// Laws.
        laws: usize,
        /// Impacts.
        impacts: usize,
    },
    /// A quantity of the rig, the body or the impact has no physical value.
    #[error("{name} is {value}, but it must be {range}")]
    BadInput {
        /// Which quantity.
        name: &'static str,
        /// Its value; SI.
        value: f64,
        /// The values that it may have.
        range: &'static str,
    },
    /// The centre of mass lies outside the disc.
    #[error(
        "the centre of mass is {offset} m from the centre of a disc of radius {radius} m: the offset must be smaller than the radius"
    )]
    OffsetOutsideDisc {
        /// Distance; m.
        offset: f64,
        /// Radius; m.
        radius: f64,
    },
    /// A solid sphere cannot have its centre of mass so far out.
    #[error(
        "a solid sphere of radius {radius} m has no moment of inertia left (2/5 m R² − m ε²) when its centre of mass is {offset} m from its centre; give the moment of inertia, or an offset below 0.63 R"
    )]
    NoMomentOfInertia {
        /// Distance; m.
        offset: f64,
        /// Radius; m.
        radius: f64,
    },
    /// Sampling times must ascend.
    #[error("time {time} s at index {index} comes after {before} s: times must ascend")]
    UnorderedTimes {
        /// Position of the offending time.
        index: usize,
        /// That time; s.
        time: f64,
        /// The time before it; s.
        before: f64,
    },
    /// A simulated drop does not show a feature.
    #[error(
        "the drop from {height} m does not show {feature}: the fruit lies on the plate after {impacts} impacts. With less damping it would bounce on; leave the feature out if the real fruit rests there too"
    )]
    FeatureMissing {
        /// The feature.
        feature: String,
        /// Drop height; m.
        height: f64,
        /// Impacts until rest.
        impacts: usize,
    },
    /// The bodies stay together.
    #[error(
        "the bodies are still in contact after {duration} s: the damping or the driving acceleration holds them together; check the law's parameters"
    )]
    EndlessContact {
        /// How long the contact was followed; s.
        duration: f64,
    },
    /// The motion cannot be integrated.
    #[error(transparent)]
    Integration(#[from] StepError),
    /// None of the quantities that the fit should use was recorded.
    #[error(
        "the impact has none of the quantities to fit ({wanted}); it has {present}. Choose others with `quantities` in [fit]"
    )]
    NoQuantities {
        /// Wanted quantities.
        wanted: String,
        /// Quantities of the impact.
        present: String,
    },
    /// Too few samples for the free parameters.
    #[error(
        "{samples} samples in the fit window cannot determine {parameters} free parameters; widen the margins or fix parameters"
    )]
    TooFewSamples {
        /// Samples of all quantities.
        samples: usize,
        /// Free parameters.
        parameters: usize,
    },
    /// No parameter of the law is free.
    #[error("no parameter of {law} is free: there is nothing to fit")]
    NothingToFit {
        /// Name of the law.
        law: &'static str,
    },
    /// More free quantities than are carried at once.
    #[error("{asked} quantities are free, but at most {most} can be: hold some of them")]
    TooManyFree {
        /// Wanted quantities.
        asked: usize,
        /// Most that can be free.
        most: usize,
    },
    /// Parameters that the recordings cannot separate.
    #[error(
        "the recordings cannot separate the free parameters of {law} (and of the rig): hold one of them, give the plate's mass, or add drops from another height"
    )]
    Unidentified {
        /// Name of the law.
        law: &'static str,
    },
    /// A velocity that was never measured cannot be held.
    #[error(
        "the velocity at first touch is to be held, but the recording does not show the motion before contact; give the velocity, or let it be estimated"
    )]
    UnknownVelocity,
    /// Instruments that would change what they measure beyond recognition.
    #[error(
        "the {channel} would be recorded {:.0} % off by what [response] says of filter, sensor or arm: such instruments cannot have made this recording, or not measure the contact; check the frequencies and the compliance",
        100.0 * part
    )]
    ResponseTooLarge {
        /// The channel.
        channel: &'static str,
        /// Largest error, as a part of the largest value; 1.
        part: f64,
    },
    /// Repeated fits that do not come to rest.
    #[error(
        "with what [response] says of filter, sensor or arm {fits} fits in a row did not come to rest; check the frequencies and the compliance"
    )]
    ResponseUnsettled {
        /// How many.
        fits: usize,
    },
    /// No starting point lets the model be evaluated.
    #[error(
        "no starting point for {law} gives an impact that can be integrated; give starting values in the law expression"
    )]
    NoStart {
        /// Name of the law.
        law: &'static str,
    },
    /// Too few fruit or impacts for a population.
    #[error(
        "{impacts} impacts of {fruits} fruit are no population: it takes at least 2 fruit (numbered from 0 without gaps) and {needed} impacts for so many covariates"
    )]
    FewMembers {
        /// Fruit with impacts.
        fruits: usize,
        /// Impacts.
        impacts: usize,
        /// Impacts needed.
        needed: usize,
    },
    /// A covariate is no number.
    #[error(
        "the covariate {covariate} is {value} at impact {impact} (from 0), which is no finite number; leave the impact out"
    )]
    BadCovariate {
        /// Its name.
        covariate: String,
        /// Position of the impact.
        impact: usize,
        /// Its value there.
        value: f64,
    },
    /// More parameters than a population can have.
    #[error(
        "a population can have 1 to {most} free parameters of the law, not {asked}: hold some of them"
    )]
    ManyParameters {
        /// Free parameters of the law.
        asked: usize,
        /// Most that can vary.
        most: usize,
    },
    /// An impact cannot be a member of a population.
    #[error("the impact cannot be a member of a population: {0}")]
    NotAMember(Unusable),
    /// The likelihood of a population is nowhere defined.
    #[error(
        "the likelihood of the population cannot be computed: an impact's likelihood does not determine all parameters of the law; leave out the impacts whose fit found parameters inseparable, or hold a parameter"
    )]
    NoPopulation,
    /// Posteriors are not part of this build.
    #[error(
        "this build of windfall draws no posteriors (its cargo feature `sampler` is off): choose \
         other intervals, or build it with the feature"
    )]
    NoSampler,
    /// The law refuses the values.
    #[error(transparent)]
    Law(#[from] windfall_contact::error::Error),
}

fn check(name: &'static str, value: f64, range: &'static str, inside: bool) -> Result<(), Error> {
    match value.is_finite() && inside {
        true => Ok(()),
        false => Err(Error::BadInput { name, value, range }),
    }
}

/// # Errors
/// [`Error::BadInput`] where the value is not a finite number above zero.
pub fn check_positive(name: &'static str, value: f64) -> Result<(), Error> {
    check(name, value, "a positive number", value > 0.0)
}

/// # Errors
/// [`Error::BadInput`] where the value is not a finite number at or above zero.
pub fn check_not_negative(name: &'static str, value: f64) -> Result<(), Error> {
    check(name, value, "zero or a positive number", value >= 0.0)
}

/// # Errors
/// [`Error::BadInput`] where the value is not a finite number.
pub fn check_finite(name: &'static str, value: f64) -> Result<(), Error> {
    check(name, value, "a finite number", true)
}
