//! What to fit and how: the law with its free parameters, the quantities, the
//! weights and the treatment of nuisances.

use crate::fit::interval::IntervalOptions;
use crate::rig::bench::BenchSd;
use crate::samples::{QUANTITIES, Quantity};
use serde::Serialize;
use windfall_contact::expression::LawExpression;
use windfall_contact::law::EndRule;
use windfall_contact::laws::kind::LawKind;
use windfall_contact::parameter::{IMPACT_VELOCITY, MASS};
use windfall_signal::response::Response;

/// A law whose parameters are given, free, or both (a starting value).
#[derive(Clone, Debug, PartialEq)]
pub struct LawProblem {
    /// Which law.
    pub kind: LawKind,
    /// Given values in the order of the law's description; SI.
    pub values: Vec<Option<f64>>,
    /// Which parameters are estimated.
    pub free: Vec<bool>,
    /// What is known of parameters and nuisances beside the data.
    pub known: Vec<Known>,
}

/// What is known of a parameter before the data: it is normal with this mean and deviation.
///
/// In a fit it is one more residual, (p − mean) / sd, of weight 1.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Prior {
    /// Mean; SI.
    pub mean: f64,
    /// Standard deviation; SI.
    pub sd: f64,
}

/// What is known of one parameter of the law or one nuisance.
///
/// A time of first touch is on the recording's clock.
#[derive(Clone, Debug, PartialEq)]
pub struct Known {
    /// Its name: the law's, or "initial_velocity", "onset", "displacement_offset".
    pub name: String,
    /// What is known of it before the data; flat where `None`.
    pub prior: Option<Prior>,
    /// Values outside of which it is not searched; SI, infinite where there is no bound.
    pub range: (f64, f64),
}

impl LawProblem {
    /// The usual question about a law: parameters that the expression leaves
    /// out are free, those that it gives and those with a default value are
    /// held. An impact velocity and a mass that the expression leaves out are
    /// taken from the impact and the rig.
    pub fn from_expression(expression: &LawExpression) -> Self {
        let description = expression.kind.describe();
        let free: Vec<bool> = description
            .parameters
            .iter()
            .zip(&expression.values)
            .map(|(parameter, value)| {
                let known = value.is_some() || parameter.default.is_some();
                !known && !of_the_event(parameter.name)
            })
            .collect();
        Self {
            kind: expression.kind,
            values: expression.values.clone(),
            known: Vec::new(),
            free,
        }
    }

    /// What is known of a parameter or nuisance.
    pub fn known(&self, name: &str) -> Option<&Known> {
        self.known.iter().find(|known| known.name == name)
    }

    /// Positions of the free parameters.
    pub fn free_positions(&self) -> impl Iterator<Item = usize> + '_ {
        (0..self.free.len()).filter(|&i| self.free[i])
    }
}

/// Whether a law's parameter belongs to the impact and not to the fruit.
pub(crate) fn of_the_event(parameter: &str) -> bool {
    parameter == IMPACT_VELOCITY || parameter == MASS
}

/// Weight of a quantity in the cost.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Weighting {
    /// 1/σ² with the noise of each channel.
    #[default]
    InverseVariance,
    /// 1/⟨|q|⟩ over the contact, as in the 2003 pendulum study. It leaves
    /// squares of different units in one sum; for comparison.
    InverseMean,
}

/// Noise model of each channel when weights are 1/σ².
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum NoiseModel {
    /// What the recording and the residuals show: white or persistent from
    /// sample to sample, a zero that all samples share, a displacement that is
    /// counted and known where its count changes.
    #[default]
    Automatic,
    /// White, sample by sample; for comparison.
    White,
}

/// What is done about a quantity that is not of interest in itself.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Treatment {
    /// Free where the data determine it, else held; a finding names it.
    #[default]
    Auto,
    /// Estimated.
    Free,
    /// Held at the value read off the signals.
    Fixed,
}

/// Quantities that take part in the cost, in the order of
/// [`Quantity::ALL`].
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Quantities(pub [bool; QUANTITIES]);

impl Serialize for Quantities {
    fn serialize<S: serde::Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        self.names().serialize(serializer)
    }
}

impl Default for Quantities {
    fn default() -> Self {
        Self::of(&[Quantity::Displacement, Quantity::Rate, Quantity::Force])
    }
}

impl Quantities {
    /// The quantities listed.
    pub fn of(list: &[Quantity]) -> Self {
        Self(Quantity::ALL.map(|q| list.contains(&q)))
    }

    /// Whether a quantity takes part.
    pub fn holds(&self, quantity: Quantity) -> bool {
        self.0[quantity as usize]
    }

    /// Names of those that take part.
    pub fn names(&self) -> Vec<&'static str> {
        let held = Quantity::ALL.into_iter().filter(|q| self.holds(*q));
        held.map(Quantity::name).collect()
    }
}

/// How an impact is fitted.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct FitOptions {
    /// Quantities in the cost.
    pub quantities: Quantities,
    /// Their weights.
    pub weighting: Weighting,
    /// Their noise.
    pub noise: NoiseModel,
    /// Standard deviation of the noise of a sample of each quantity, in the order of
    /// [`Quantity::ALL`], where it is known: residuals do not change it; SI.
    pub noise_sd: [Option<f64>; QUANTITIES],
    /// Velocity at first touch.
    pub initial_velocity: Treatment,
    /// Velocity at first touch where it is known otherwise, in place of the one
    /// read off the signals; m/s.
    pub known_velocity: Option<f64>,
    /// Time of first touch.
    pub onset: Treatment,
    /// Zero of the displacement.
    pub displacement_offset: Treatment,
    /// End of contact.
    pub end: EndRule,
    /// Relative accuracy of the integration; 1.
    pub accuracy: f64,
    /// Stop when the cost can fall by less than this fraction; 1.
    pub cost_tolerance: f64,
    /// Evaluations of the model before giving up.
    pub max_evaluations: usize,
    /// Coverage of the intervals; 1.
    pub confidence: f64,
    /// How the intervals are made.
    pub intervals: IntervalOptions,
    /// What of the bench is uncertain; enters the deviations.
    pub bench: BenchSd,
    /// What the instruments make of force and displacement.
    pub response: Response,
}

impl Default for FitOptions {
    fn default() -> Self {
        Self {
            quantities: Quantities::default(),
            weighting: Weighting::default(),
            noise: NoiseModel::default(),
            noise_sd: [None; QUANTITIES],
            initial_velocity: Treatment::default(),
            known_velocity: None,
            onset: Treatment::default(),
            displacement_offset: Treatment::default(),
            end: EndRule::default(),
            accuracy: 1e-8,
            cost_tolerance: 1e-10,
            max_evaluations: 200,
            confidence: 0.95,
            intervals: IntervalOptions::default(),
            bench: BenchSd::default(),
            response: Response::default(),
        }
    }
}
