//! What is wrong with restitutions that do not agree.

use crate::restitution::estimate::RestitutionMethod;
use crate::uncertain::Uncertain;

/// Something about the restitutions of a drop that a reader must know.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[allow(missing_docs, reason = "each message names its fields")]
pub enum RestitutionFinding {
    #[error(
        "one bounce: no flight follows it, so its restitution cannot be had from time; what is given comes from its impulse, or from nothing"
    )]
    NoSecondImpact,
    #[error(
        "restitution of bounce {bounce} by {method} is {value:.3} ± {sd:.3}, which no rebound has: {}",
        remedy(*method)
    )]
    OutOfRange {
        bounce: usize,
        method: RestitutionMethod,
        value: f64,
        sd: f64,
    },
    #[error(
        "restitution of bounce {bounce} is {first_value:.3} by {first} and {second_value:.3} by {second}, {deviations:.1} standard uncertainties apart: {}",
        meaning(*first, *second)
    )]
    MethodsDisagree {
        bounce: usize,
        first: RestitutionMethod,
        first_value: f64,
        second: RestitutionMethod,
        second_value: f64,
        deviations: f64,
    },
    #[error(
        "the impulse of {impacts} impact(s) does not fit m v (1 + e): forces times {:.4} ± {:.4} would. Check the volts per newton (times {:.4}), then the mass and the drop height",
        factor.value,
        factor.sd,
        1.0 / factor.value
    )]
    ForceScale { factor: Uncertain, impacts: usize },
    #[error(
        "the impulse of bounce {bounce} fits no restitution from 0 to 1: the forces would have to be multiplied by a factor from {least:.3} to {most:.3}. Check volts per newton, mass and drop height"
    )]
    ForceScaleRange {
        bounce: usize,
        least: f64,
        most: f64,
    },
    #[error(
        "restitution of bounce {bounce} is {value:.3} after {before:.3} of the harder impact before: more than any usual law loses from one bounce to the next, so this rebound was probably slanted or took up spin, and its values by time and impulse are those of the vertical velocity only"
    )]
    WeakRebound {
        bounce: usize,
        value: f64,
        before: f64,
    },
}

impl RestitutionFinding {
    /// Stable short name, for tables and JSON.
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
