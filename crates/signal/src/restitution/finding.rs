//! What is wrong with restitutions that do not agree.

use crate::restitution::estimate::RestitutionMethod;
use crate::uncertain::Uncertain;
use std::fmt;

/// Something about the restitutions of a drop that a reader must know.
#[derive(Clone, Debug, PartialEq)]
pub enum RestitutionFinding {
    /// One bounce only: nothing can be had from time.
    NoSecondImpact,
    /// A restitution below 0 or above 1, beyond its uncertainty.
    OutOfRange {
        /// Number of the bounce, from 1.
        bounce: usize,
        /// How it was found.
        method: RestitutionMethod,
        /// Its value; 1.
        value: f64,
        /// Its standard uncertainty; 1.
        sd: f64,
    },
    /// Two methods differ on one impact.
    MethodsDisagree {
        /// Number of the bounce, from 1.
        bounce: usize,
        /// One method.
        first: RestitutionMethod,
        /// Its value; 1.
        first_value: f64,
        /// The other.
        second: RestitutionMethod,
        /// Its value; 1.
        second_value: f64,
        /// Difference over its standard uncertainty; 1.
        deviations: f64,
    },
    /// Impulses ask for another scale of the force, or another mass.
    ForceScale {
        /// What the forces would have to be multiplied by; 1.
        factor: Uncertain,
        /// Impacts it comes from.
        impacts: usize,
    },
    /// An impulse that no restitution explains, and no time to compare with.
    ForceScaleRange {
        /// Number of the bounce, from 1.
        bounce: usize,
        /// The factor for e = 0; 1.
        least: f64,
        /// The factor for e = 1; 1.
        most: f64,
    },
    /// A rebound much weaker than that of a harder impact before.
    WeakRebound {
        /// Number of the bounce, from 1.
        bounce: usize,
        /// Its restitution; 1.
        value: f64,
        /// That of the bounce before; 1.
        before: f64,
    },
}

impl RestitutionFinding {
    /// Stable short name, for tables and JSON.
    #[must_use]
    pub fn code(&self) -> &'static str {
        match self {
            Self::NoSecondImpact => "no_second_impact",
            Self::OutOfRange { .. } => "restitution_out_of_range",
            Self::MethodsDisagree { .. } => "restitutions_disagree",
            Self::ForceScale { .. } | Self::ForceScaleRange { .. } => "force_scale",
            Self::WeakRebound { .. } => "weak_rebound",
        }
    }
}

impl fmt::Display for RestitutionFinding {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::NoSecondImpact => write!(
                f,
                "one bounce: no flight follows it, so its restitution cannot be had from time; what is given comes from its impulse, or from nothing"
            ),
            Self::OutOfRange {
                bounce,
                method,
                value,
                sd,
            } => write!(
                f,
                "restitution of bounce {bounce} by {method} is {value:.3} ± {sd:.3}, which no rebound has: {}",
                remedy(*method)
            ),
            Self::MethodsDisagree {
                bounce,
                first,
                first_value,
                second,
                second_value,
                deviations,
            } => write!(
                f,
                "restitution of bounce {bounce} is {first_value:.3} by {first} and {second_value:.3} by {second}, {deviations:.1} standard uncertainties apart: {}",
                meaning(*first, *second)
            ),
            Self::ForceScale { factor, impacts } => write!(
                f,
                "the impulse of {impacts} impact(s) does not fit m v (1 + e): forces times {:.4} ± {:.4} would. Check the volts per newton (times {:.4}), then the mass and the drop height",
                factor.value,
                factor.sd,
                1.0 / factor.value
            ),
            Self::ForceScaleRange {
                bounce,
                least,
                most,
            } => write!(
                f,
                "the impulse of bounce {bounce} fits no restitution from 0 to 1: the forces would have to be multiplied by a factor from {least:.3} to {most:.3}. Check volts per newton, mass and drop height"
            ),
            Self::WeakRebound {
                bounce,
                value,
                before,
            } => write!(
                f,
                "restitution of bounce {bounce} is {value:.3} after {before:.3} of the harder impact before: more than any usual law loses from one bounce to the next, so this rebound was probably slanted or took up spin, and its values by time and impulse are those of the vertical velocity only"
            ),
        }
    }
}

fn remedy(method: RestitutionMethod) -> &'static str {
    match method {
        RestitutionMethod::DropHeight => {
            "check the drop height, and whether a bounce beside the plate was missed"
        }
        RestitutionMethod::Flights => {
            "a bounce beside the plate was missed, or noise was taken for one"
        }
        RestitutionMethod::Heights => "check the heights and where they are measured from",
        RestitutionMethod::Impulse => "check volts per newton, mass and drop height",
        RestitutionMethod::Velocities => {
            "check the positions near the contact, and their clock against that of the force"
        }
    }
}

fn meaning(first: RestitutionMethod, second: RestitutionMethod) -> &'static str {
    use RestitutionMethod::{Heights, Impulse, Velocities};
    let either = |method| first == method || second == method;
    if either(Impulse) {
        "spin and slant change both alike, so the scale of the force, the mass or the speed of approach is off"
    } else if either(Velocities) {
        "the acceleration in flight differs on the way up and down (friction), or the clocks of position and force do"
    } else if either(Heights) {
        "the heights are not measured from where contact begins, or the acceleration in flight is not the one given"
    } else {
        "the drop height or the time of an impact is off"
    }
}
