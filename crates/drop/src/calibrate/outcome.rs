//! What `windfall calibrate` gives; numbers are SI unless a unit stands with them.

use crate::calibrate::waveform_outcome::WaveformOutcome;
use serde::Serialize;
use windfall_files::found::{FailureOutcome, FindingOutcome};
use windfall_files::named::Named;
use windfall_measure::measured::MeasuredValue;
use windfall_statistics::model::anova::AnovaRow;

/// Everything that a calibration gives.
#[derive(Clone, Debug, Serialize, utoipa::ToSchema)]
pub struct CalibrateOutcome {
    /// Version of windfall.
    pub windfall: String,
    /// Title of the campaign.
    pub campaign: String,
    /// Label of simulated recordings.
    pub simulated: Option<String>,
    /// The law, with what is held.
    pub law: String,
    /// Names of the parameters that are estimated.
    pub free: Vec<String>,
    /// The plate: "rigid", or its values.
    pub plate: Named<MeasuredValue>,
    /// What was read off each drop.
    pub drops: Vec<DropOutcome>,
    /// Whose first peak and interval are the target.
    pub target: TargetOutcome,
    /// Where the search starts.
    pub start: StartOutcome,
    /// Least squares of the waveforms of all drops.
    pub waveform: Option<WaveformOutcome>,
    /// Least squares of the features of all drops.
    pub features: Option<FeaturesOutcome>,
    /// All laws that have the target's first peak and interval.
    pub family: Option<FamilyLine>,
    /// What each kind of further knowledge does to the uncertainties.
    pub closing: Vec<ClosingOutcome>,
    /// Design, surfaces, optimum and what became of it.
    pub design: Option<DesignWayOutcome>,
    /// What to measure next.
    pub next: Option<NextOutcome>,
    /// Drops that could not be used.
    pub failed: Vec<FailureOutcome>,
    /// What a reader must know.
    pub findings: Vec<FindingOutcome>,
}

impl CalibrateOutcome {
    /// Units in which the free parameters are written.
    pub fn parameter_units(&self) -> Vec<String> {
        match (&self.features, &self.design) {
            (Some(features), _) => {
                let parameters = features.parameters.iter();
                parameters.map(|p| p.written.unit.clone()).collect()
            }
            (None, Some(design)) => design.factors.iter().map(|f| f.unit.clone()).collect(),
            (None, None) => vec![String::new(); self.free.len()],
        }
    }
}

/// Features of one drop.
#[derive(Clone, Debug, PartialEq, Serialize, utoipa::ToSchema)]
pub struct DropOutcome {
    /// Id in impacts.csv.
    pub id: String,
    /// The fruit.
    pub specimen: String,
    /// Mass of the fruit; kg.
    pub mass: MeasuredValue,
    /// Drop height; m.
    pub height: MeasuredValue,
    /// Features.
    pub features: Named<MeasuredValue>,
}

/// The features that are to be met at one height.
#[derive(Clone, Debug, PartialEq, Serialize, utoipa::ToSchema)]
pub struct TargetOutcome {
    /// Which drops they are of.
    pub of: String,
    /// How many drops.
    pub drops: usize,
    /// Mass of the fruit; kg.
    pub mass: f64,
    /// Drop height; m.
    pub height: f64,
    /// The features: means with standard uncertainty.
    pub features: Named<MeasuredValue>,
}

/// Where the search starts.
#[derive(Clone, Debug, PartialEq, Serialize, utoipa::ToSchema)]
pub struct StartOutcome {
    /// The law with its start values.
    pub law: String,
    /// How they came about.
    pub rule: String,
    /// Hertz's stiffness, where radius and modulus are given; N/m^1.5.
    pub hertz_stiffness: Option<f64>,
}

/// A free parameter as estimated.
#[derive(Clone, Debug, PartialEq, Serialize, utoipa::ToSchema)]
pub struct CalibratedParameter {
    /// Its name.
    pub name: String,
    /// Value; SI.
    pub value: f64,
    /// Standard uncertainty; SI. `None` where it is not determined.
    pub sd: Option<f64>,
    /// SI unit.
    pub unit: String,
    /// The same in the unit of its range.
    pub written: WrittenValue,
    /// Whether it ended at a limit.
    pub at_limit: bool,
}

/// A value in the unit of a campaign's ranges: N/mm^e.
#[derive(Clone, Debug, PartialEq, Serialize, utoipa::ToSchema)]
pub struct WrittenValue {
    /// Value.
    pub value: f64,
    /// Standard uncertainty, where determined.
    pub sd: Option<f64>,
    /// Ends of the profile interval of 95 %; `None` where it is open.
    pub low: Option<f64>,
    /// Its upper end.
    pub high: Option<f64>,
    /// Unit.
    pub unit: String,
}

/// Least squares of features.
#[derive(Clone, Debug, PartialEq, Serialize, utoipa::ToSchema)]
pub struct FeaturesOutcome {
    /// The law.
    pub law: String,
    /// The free parameters.
    pub parameters: Vec<CalibratedParameter>,
    /// Correlations of the coordinates, where all are determined.
    pub correlations: Vec<Vec<f64>>,
    /// Directions in the parameters that the features determine.
    pub rank: usize,
    /// Directions, best determined first.
    pub directions: Vec<DirectionOutcome>,
    /// Sum of squared residuals over their uncertainties.
    pub chi_square: f64,
    /// Its degrees of freedom.
    pub freedom: usize,
    /// Probability of as much by chance.
    pub p: Option<f64>,
    /// Factor by which uncertainties were widened for the scatter.
    pub widened: f64,
    /// Measured and fitted features.
    pub fitted: Vec<FittedFeature>,
    /// Masses, heights and plate as estimated along.
    pub along: Vec<AlongOutcome>,
    /// Whether a minimum was reached.
    pub converged: bool,
    /// Evaluations of all features with derivatives.
    pub evaluations: usize,
}

/// A direction in the free parameters.
#[derive(Clone, Debug, PartialEq, Serialize, utoipa::ToSchema)]
pub struct DirectionOutcome {
    /// Parts: relative changes of what has a unit, changes of exponents.
    pub parts: Named<f64>,
    /// Standard uncertainty along it; `None` where nothing tells.
    pub sd: Option<f64>,
    /// In words.
    pub words: String,
}

/// A feature as measured and as the law has it.
#[derive(Clone, Debug, PartialEq, Serialize, utoipa::ToSchema)]
pub struct FittedFeature {
    /// The drop.
    pub drop: String,
    /// The feature.
    pub feature: String,
    /// As measured.
    pub measured: MeasuredValue,
    /// As the law has it.
    pub fitted: f64,
    /// Their difference over its uncertainty.
    pub standardised: f64,
}

/// A quantity of the rig that was estimated along.
#[derive(Clone, Debug, PartialEq, Serialize, utoipa::ToSchema)]
pub struct AlongOutcome {
    /// What.
    pub quantity: String,
    /// As known before.
    pub known: MeasuredValue,
    /// As estimated.
    pub value: f64,
}

/// The line of laws that have the same features at one height.
#[derive(Clone, Debug, PartialEq, Serialize, utoipa::ToSchema)]
pub struct FamilyLine {
    /// Directions that are open.
    pub dimension: usize,
    /// In words.
    pub words: String,
    /// Points along it.
    pub members: Vec<FamilyMember>,
}

/// A law of the line.
#[derive(Clone, Debug, PartialEq, Serialize, utoipa::ToSchema)]
pub struct FamilyMember {
    /// Values of the free parameters, in the units of their ranges.
    pub parameters: Vec<f64>,
    /// The law; SI.
    pub law: String,
    /// What it has at some heights.
    pub heights: Vec<HeightFeatures>,
}

/// Features at a height.
#[derive(Clone, Debug, PartialEq, Serialize, utoipa::ToSchema)]
pub struct HeightFeatures {
    /// Drop height; m.
    pub height: f64,
    /// Features; SI. Empty where the drop does not show them.
    pub features: Named<f64>,
}

/// Uncertainties with some knowledge.
#[derive(Clone, Debug, PartialEq, Serialize, utoipa::ToSchema)]
pub struct ClosingOutcome {
    /// What is known.
    pub with: String,
    /// Directions determined.
    pub rank: usize,
    /// Standard uncertainty of each free parameter: relative for what has a unit;
    /// `None` where open.
    pub sds: Vec<Option<f64>>,
}

/// Calibration by design and surface.
#[derive(Clone, Debug, PartialEq, Serialize, utoipa::ToSchema)]
pub struct DesignWayOutcome {
    /// Kind of the design.
    pub kind: String,
    /// Distance of its axial points.
    pub alpha: f64,
    /// The factors.
    pub factors: Vec<DesignFactorOutcome>,
    /// The runs.
    pub runs: Vec<DesignRunOutcome>,
    /// The surfaces, force first.
    pub surfaces: Vec<DesignSurfaceOutcome>,
    /// The optimum.
    pub optimum: DesignOptimum,
    /// All that are as good on the surfaces.
    pub family: Vec<DesignMember>,
    /// The optimum at all heights.
    pub heights: Vec<DesignHeight>,
    /// What the depth of full damping does, where the law has one.
    pub depth: Option<DepthOutcome>,
}

/// A factor of the design.
#[derive(Clone, Debug, PartialEq, Serialize, utoipa::ToSchema)]
pub struct DesignFactorOutcome {
    /// A, B, C …
    pub letter: String,
    /// The parameter.
    pub name: String,
    /// Unit of its levels.
    pub unit: String,
    /// Lowest level.
    pub low: f64,
    /// Highest level.
    pub high: f64,
    /// Level of coded 0.
    pub centre: f64,
    /// Step of coded 1.
    pub half: f64,
}

/// A run of the design.
#[derive(Clone, Debug, PartialEq, Serialize, utoipa::ToSchema)]
pub struct DesignRunOutcome {
    /// Coded levels.
    pub coded: Vec<f64>,
    /// Levels in the units of the factors.
    pub levels: Vec<f64>,
    /// Responses; SI.
    pub responses: Vec<f64>,
}

/// The surface of a response.
#[derive(Clone, Debug, PartialEq, Serialize, utoipa::ToSchema)]
pub struct DesignSurfaceOutcome {
    /// The response.
    pub response: String,
    /// Its SI unit.
    pub unit: String,
    /// Its model.
    pub model: String,
    /// Terms with their coefficients in coded units and levels.
    pub terms: Vec<DesignTerm>,
    /// The whole model.
    pub whole: AnovaRow,
    /// Its terms.
    pub anova: Vec<AnovaRow>,
    /// Residual sum of squares.
    pub residual_ss: f64,
    /// Its degrees of freedom.
    pub residual_df: f64,
    /// Total sum of squares.
    pub total_ss: f64,
    /// R².
    pub r2: f64,
    /// Adjusted.
    pub r2_adjusted: f64,
    /// Predicted.
    pub r2_predicted: f64,
    /// Residual standard deviation.
    pub sigma: f64,
}

/// A term of a surface.
#[derive(Clone, Debug, PartialEq, Serialize, utoipa::ToSchema)]
pub struct DesignTerm {
    /// Its letters.
    pub term: String,
    /// Coefficient in coded units.
    pub coded: f64,
    /// Coefficient in levels.
    pub actual: f64,
}

/// Settings of a surface with the response there and in the simulator.
#[derive(Clone, Debug, PartialEq, Serialize, utoipa::ToSchema)]
pub struct DesignOptimum {
    /// Levels.
    pub levels: Vec<f64>,
    /// The law; SI.
    pub law: String,
    /// Desirability on the surfaces.
    pub desirability: f64,
    /// Measured, predicted by the surface, simulated.
    pub responses: Vec<VerifiedResponse>,
}

/// A response at the optimum: Table 6 of the study.
#[derive(Clone, Debug, PartialEq, Serialize, utoipa::ToSchema)]
pub struct VerifiedResponse {
    /// The response.
    pub response: String,
    /// Its SI unit.
    pub unit: String,
    /// As measured.
    pub measured: Option<f64>,
    /// As the surface has it.
    #[schema(value_type = Option<f64>)]
    pub predicted: f64,
    /// As the simulator has it.
    pub simulated: Option<f64>,
    /// Simulated less measured over measured.
    pub difference: Option<f64>,
}

/// A member of the family on the surfaces.
#[derive(Clone, Debug, PartialEq, Serialize, utoipa::ToSchema)]
pub struct DesignMember {
    /// Levels.
    pub levels: Vec<f64>,
    /// Desirability.
    pub desirability: f64,
    /// What the simulator has, at each height.
    pub heights: Vec<HeightFeatures>,
}

/// The optimum at another height.
#[derive(Clone, Debug, PartialEq, Serialize, utoipa::ToSchema)]
pub struct DesignHeight {
    /// Drop height; m.
    pub height: f64,
    /// Drops measured there.
    pub drops: usize,
    /// Responses.
    pub responses: Vec<VerifiedResponse>,
}

/// Table 2 of the study: responses over the depth of full damping.
#[derive(Clone, Debug, PartialEq, Serialize, utoipa::ToSchema)]
pub struct DepthOutcome {
    /// The law at which it was varied.
    pub law: String,
    /// Depth and responses; SI.
    pub rows: Vec<(f64, Vec<f64>)>,
    /// Means of the responses.
    pub mean: Vec<f64>,
    /// Standard deviations of all values, divided by their number as the study does.
    pub sd: Vec<f64>,
    /// These over the means.
    pub cv: Vec<f64>,
}

/// What to measure next.
#[derive(Clone, Debug, PartialEq, Serialize, utoipa::ToSchema)]
pub struct NextOutcome {
    /// Whose gain decides beside the determinant.
    pub interest: String,
    /// Uncertainties as they are.
    pub now: Vec<Option<f64>>,
    /// Candidates, best first.
    pub candidates: Vec<CandidateOutcome>,
}

/// A further drop.
#[derive(Clone, Debug, PartialEq, Serialize, utoipa::ToSchema)]
pub struct CandidateOutcome {
    /// Drop height; m.
    pub height: f64,
    /// Mass of the fruit; kg.
    pub mass: f64,
    /// Whether a fruit of that mass is in the campaign.
    pub fruit: String,
    /// Impacts recorded of each drop.
    pub impacts: usize,
    /// Drops.
    pub drops: usize,
    /// Expected uncertainties of the free parameters.
    pub sds: Vec<Option<f64>>,
    /// Gain in the logarithm of the determinant; `None` where infinite or open.
    pub gain: Option<f64>,
    /// Directions determined afterwards.
    pub rank: usize,
    /// Gain for the parameter of interest: logarithm of its ratio of variances.
    pub gain_of_interest: Option<f64>,
}
