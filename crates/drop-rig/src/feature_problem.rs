//! Measured features of many drops as a least-squares problem: the law's free
//! parameters, and what is known of masses, heights and plate with error.

use crate::coordinates::LawCoordinates;
use crate::measured::{DropFeature, FeatureSensitivity, RigQuantity, feature_sensitivity};
use crate::rig::DropRig;
use nalgebra::{DMatrix, DVector};
use windfall_contact::law::EndRule;
use windfall_identify::error::Error;
use windfall_signal::uncertain::Uncertain;

/// A feature as it was measured.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MeasuredFeature {
    /// What.
    pub feature: DropFeature,
    /// Value; SI.
    pub value: f64,
    /// Standard uncertainty; SI.
    pub sd: f64,
}

/// One drop.
#[derive(Clone, Debug, PartialEq)]
pub struct MeasuredDrop {
    /// Which of the problem's masses: drops of one fruit share the error of its
    /// weighing.
    pub fruit: usize,
    /// Which of the problem's heights: drops from one setting share its error.
    pub height: usize,
    /// Its features.
    pub features: Vec<MeasuredFeature>,
}

/// Standard uncertainties of a rig; zero where exact.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct RigUncertainty {
    /// Of the effective mass factor; 1.
    pub effective_mass_factor: f64,
    /// Of the plate's mass; kg.
    pub plate_mass: f64,
    /// Of its stiffness; N/m.
    pub plate_stiffness: f64,
    /// Of its damping; N s/m.
    pub plate_damping: f64,
}

/// What is known of a free parameter besides the drops.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CoordinatePrior {
    /// Place among the free parameters.
    pub place: usize,
    /// Coordinate.
    pub value: f64,
    /// Standard uncertainty of the coordinate: of a logarithm, the relative one.
    pub sd: f64,
}

/// Measured features of drops on one rig.
#[derive(Clone, Debug, PartialEq)]
pub struct FeatureProblem {
    /// The rig; its mass is replaced by that of each fruit.
    pub rig: DropRig,
    /// How well it is known.
    pub rig_sd: RigUncertainty,
    /// Masses of the fruit; kg.
    pub fruits: Vec<Uncertain>,
    /// Drop heights; m.
    pub heights: Vec<Uncertain>,
    /// The drops.
    pub drops: Vec<MeasuredDrop>,
    /// What else is known of the law.
    pub priors: Vec<CoordinatePrior>,
    /// Where contact ends.
    pub end: EndRule,
}

/// A quantity that is known with error, and estimated along.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Nuisance {
    /// What it is.
    pub quantity: RigQuantity,
    /// Which fruit or height; 0 for the rig.
    pub index: usize,
    /// What is known.
    pub known: Uncertain,
}

/// Quantities that are known with error.
pub fn nuisances(problem: &FeatureProblem) -> Vec<Nuisance> {
    let used = |pick: fn(&MeasuredDrop) -> usize, index: usize| {
        problem.drops.iter().any(|drop| pick(drop) == index)
    };
    let mut found = Vec::new();
    for (index, known) in problem.fruits.iter().enumerate() {
        if used(|drop| drop.fruit, index) {
            found.push((RigQuantity::Mass, index, *known));
        }
    }
    for (index, known) in problem.heights.iter().enumerate() {
        if used(|drop| drop.height, index) {
            found.push((RigQuantity::Height, index, *known));
        }
    }
    let (rig, sd) = (&problem.rig, &problem.rig_sd);
    let of_rig = |value, sd| Uncertain { value, sd };
    let factor = of_rig(rig.effective_mass_factor, sd.effective_mass_factor);
    found.push((RigQuantity::EffectiveMassFactor, 0, factor));
    if let Some(plate) = &rig.plate {
        let stiffness = of_rig(plate.stiffness, sd.plate_stiffness);
        let damping = of_rig(plate.damping, sd.plate_damping);
        found.push((RigQuantity::PlateMass, 0, of_rig(plate.mass, sd.plate_mass)));
        found.push((RigQuantity::PlateStiffness, 0, stiffness));
        found.push((RigQuantity::PlateDamping, 0, damping));
    }
    found
        .into_iter()
        .filter(|(_, _, known)| known.sd > 0.0)
        .map(|(quantity, index, known)| Nuisance {
            quantity,
            index,
            known,
        })
        .collect()
}

/// Residuals over their standard uncertainties with derivatives, at one point.
#[derive(Clone, Debug, PartialEq)]
pub struct Linearised {
    /// Simulated less measured features, then priors of the law, then of nuisances.
    pub residuals: DVector<f64>,
    /// Derivatives by the law's coordinates.
    pub by_law: DMatrix<f64>,
    /// Derivatives by the nuisances, in units of their uncertainty.
    pub by_nuisance: DMatrix<f64>,
    /// Simulated features, drop by drop.
    pub simulated: Vec<Vec<f64>>,
    /// How many rows are features.
    pub features: usize,
}

/// The rig and height of a drop, with nuisances at `shifts` of their uncertainty.
fn setting(
    problem: &FeatureProblem,
    drop: &MeasuredDrop,
    nuisances: &[Nuisance],
    shifts: &[f64],
) -> (DropRig, f64) {
    let mut rig = problem.rig;
    rig.mass = problem.fruits[drop.fruit].value;
    let mut height = problem.heights[drop.height].value;
    for (nuisance, shift) in nuisances.iter().zip(shifts) {
        if concerns(nuisance, drop) {
            let known = nuisance.known;
            // A mass, height or stiffness stays above zero.
            let value = (known.value + known.sd * shift).max(1e-3 * known.value);
            nuisance.quantity.put(&mut rig, &mut height, value);
        }
    }
    (rig, height)
}

fn concerns(nuisance: &Nuisance, drop: &MeasuredDrop) -> bool {
    match nuisance.quantity {
        RigQuantity::Mass => nuisance.index == drop.fruit,
        RigQuantity::Height => nuisance.index == drop.height,
        _ => true,
    }
}

/// Residuals and derivatives at a point.
///
/// * `at`: coordinates of the law
/// * `shifts`: nuisances, in units of their uncertainty
///
/// # Errors
/// A drop cannot be simulated there, or does not show a feature.
pub fn linearise(
    problem: &FeatureProblem,
    coordinates: &LawCoordinates,
    nuisances: &[Nuisance],
    (at, shifts): (&[f64], &[f64]),
) -> Result<Linearised, Error> {
    let law = coordinates.law_at(at)?;
    let values = law.parameters();
    let wanted: Vec<usize> = coordinates.free.iter().map(|free| free.position).collect();
    let features: usize = problem.drops.iter().map(|drop| drop.features.len()).sum();
    let rows = features + problem.priors.len() + nuisances.len();
    let mut found = Linearised {
        residuals: DVector::zeros(rows),
        by_law: DMatrix::zeros(rows, wanted.len()),
        by_nuisance: DMatrix::zeros(rows, nuisances.len()),
        simulated: Vec::with_capacity(problem.drops.len()),
        features,
    };
    let mut row = 0;
    for drop in &problem.drops {
        let (rig, height) = setting(problem, drop, nuisances, shifts);
        let asked: Vec<DropFeature> = drop.features.iter().map(|f| f.feature).collect();
        let own = nuisances.iter().filter(|n| concerns(n, drop));
        let quantities: Vec<RigQuantity> = own.map(|n| n.quantity).collect();
        let sensitivity = feature_sensitivity(
            &law,
            &rig,
            height,
            &asked,
            problem.end,
            (&wanted, &quantities),
        )?;
        add_drop(
            &mut found,
            row,
            drop,
            &sensitivity,
            (coordinates, &values),
            nuisances,
        );
        row += asked.len();
        found.simulated.push(sensitivity.values);
    }
    for prior in &problem.priors {
        found.residuals[row] = (at[prior.place] - prior.value) / prior.sd;
        found.by_law[(row, prior.place)] = 1.0 / prior.sd;
        row += 1;
    }
    for (place, shift) in shifts.iter().enumerate() {
        found.residuals[row + place] = *shift;
        found.by_nuisance[(row + place, place)] = 1.0;
    }
    Ok(found)
}

fn add_drop(
    found: &mut Linearised,
    row: usize,
    drop: &MeasuredDrop,
    sensitivity: &FeatureSensitivity,
    (coordinates, values): (&LawCoordinates, &[f64]),
    nuisances: &[Nuisance],
) {
    for (index, measured) in drop.features.iter().enumerate() {
        let simulated = sensitivity.values[index];
        found.residuals[row + index] = (simulated - measured.value) / measured.sd;
        let slopes = coordinates.chain(&sensitivity.by_parameter[index], values);
        for (place, slope) in slopes.into_iter().enumerate() {
            found.by_law[(row + index, place)] = slope / measured.sd;
        }
        for (place, nuisance) in nuisances.iter().enumerate() {
            if concerns(nuisance, drop) {
                let slope = sensitivity.by_rig[index][nuisance.quantity as usize];
                found.by_nuisance[(row + index, place)] = slope * nuisance.known.sd / measured.sd;
            }
        }
    }
}
