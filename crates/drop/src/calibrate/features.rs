//! Calibration by features: least squares on the simulator, what is open, and the
//! line of laws that one height leaves.

use crate::calibrate::law::{FreeLaw, law_error};
use crate::calibrate::outcome::{
    AlongOutcome, CalibratedParameter, DirectionOutcome, FamilyLine, FamilyMember, FeaturesOutcome,
    FittedFeature, HeightFeatures, WrittenValue,
};
use crate::calibrate::target::{
    CalibrateRig, DropData, INTERVAL, PEAK, TargetCondition, target_problem,
};
use windfall_contact::expression::LawExpression;
use windfall_contact::law::EndRule;
use windfall_contact::laws::kind::Law;
use windfall_drop_rig::family::{FamilyModel, FamilyOptions, family_point, trace_family};
use windfall_drop_rig::feature_fit::{FeatureFit, FeatureFitOptions, fit_features};
use windfall_drop_rig::feature_problem::{
    FeatureProblem, MeasuredDrop, Nuisance, RigUncertainty, linearise,
};
use windfall_drop_rig::information::Direction;
use windfall_drop_rig::measured::{DropFeature, FeatureKind, RigQuantity, feature_values};
use windfall_drop_rig::rig::DropRig;
use windfall_drop_rig::start::coarse_starts;
use windfall_files::error::Error;
use windfall_files::found::FindingOutcome;
use windfall_files::text::number::{plain, unit_text};
use windfall_files::text::statistic::chi_square;
use windfall_measure::measured::value_with_sd;
use windfall_tables::regress::findings::finding;

/// A direction that is known no better than to this, relative, is as good as open.
const OPEN: f64 = 0.5;

/// Members of a line that are shown.
const MEMBERS: usize = 9;

/// Fits the law to features.
///
/// # Errors
/// The law cannot be simulated at any start.
pub fn fit(
    law: &FreeLaw,
    problem: &FeatureProblem,
    target: &TargetCondition,
    profile: bool,
) -> Result<FeatureFit, Error> {
    let rig = problem.rig;
    let speed = rig.impact_velocity(target.height.value);
    let peak = target.features[0].value;
    let mass = target.mass.value * rig.effective_mass_factor;
    let starts = coarse_starts(problem, &law.coordinates, (peak, mass, speed));
    let options = FeatureFitOptions {
        profile,
        ..FeatureFitOptions::default()
    };
    fit_features(problem, &law.coordinates, &starts, &options).map_err(law_error)
}

/// A fit as JSON shows it, and what is to be said of it.
pub fn features_outcome(
    law: &FreeLaw,
    drops: &[DropData],
    problem: &FeatureProblem,
    fit: &FeatureFit,
) -> (FeaturesOutcome, Vec<FindingOutcome>) {
    let information = &fit.information;
    let directions: Vec<DirectionOutcome> = information
        .directions
        .iter()
        .map(|direction| direction_outcome(law, direction, fit.widened))
        .collect();
    let fitted = drops.iter().zip(&problem.drops).zip(&fit.simulated);
    let fitted = fitted.flat_map(|((drop, measured), simulated)| {
        let pairs = measured.features.iter().zip(simulated);
        pairs.map(|(measured, simulated)| FittedFeature {
            drop: drop.id.clone(),
            feature: measured.feature.name(),
            measured: value_with_sd(measured.value, measured.sd, measured.feature.unit()),
            fitted: *simulated,
            standardised: (simulated - measured.value) / measured.sd,
        })
    });
    let along = fit.nuisances.iter().map(|estimate| AlongOutcome {
        quantity: nuisance_name(&estimate.nuisance, drops, problem),
        known: value_with_sd(
            estimate.nuisance.known.value,
            estimate.nuisance.known.sd,
            nuisance_unit(estimate.nuisance.quantity),
        ),
        value: estimate.value,
    });
    let outcome = FeaturesOutcome {
        law: LawExpression::from(fit.law).to_string(),
        parameters: parameters_of(law, fit),
        correlations: information
            .covariance
            .as_ref()
            .map_or_else(Vec::new, |own| {
                correlations(own.ncols(), |i, j| own[(i, j)])
            }),
        rank: information.rank,
        fitted: fitted.collect(),
        along: along.collect(),
        chi_square: fit.chi_square,
        freedom: fit.freedom,
        p: fit.p,
        widened: fit.widened,
        converged: fit.converged,
        evaluations: fit.evaluations,
        directions,
    };
    let findings = findings_of(law, &outcome);
    (outcome, findings)
}

/// Correlations from a covariance.
pub(crate) fn correlations(size: usize, covariance: impl Fn(usize, usize) -> f64) -> Vec<Vec<f64>> {
    let sd = |place: usize| covariance(place, place).sqrt();
    let correlation = |i, j| covariance(i, j) / (sd(i) * sd(j));
    let row = |i| (0..size).map(|j| correlation(i, j)).collect();
    (0..size).map(row).collect()
}

/// The free parameters with their uncertainties, in SI and in the units of ranges.
fn parameters_of(law: &FreeLaw, fit: &FeatureFit) -> Vec<CalibratedParameter> {
    let levels = law.levels(&fit.at);
    let values = fit.law.parameters();
    let free = law.coordinates.free.iter().zip(&fit.parameters).enumerate();
    free.map(|(place, (free, estimate))| {
        let level = levels[place];
        // Of the written value; a factor between units changes both alike.
        let times = level / estimate.value;
        let shown = |value: f64| (value.is_finite()).then_some(value * times);
        // Of what is not determined an end of the profile is one of the law's bounds.
        let profile = estimate.profile.filter(|_| estimate.sd.is_finite());
        let profile = profile.unwrap_or((
            estimate.value - 1.96 * estimate.sd,
            estimate.value + 1.96 * estimate.sd,
        ));
        let open_below = free.logarithmic && profile.0 <= 0.0;
        CalibratedParameter {
            name: estimate.name.to_owned(),
            value: values[free.position],
            sd: sd_in_si(law, fit, place, values[free.position]),
            unit: fit.law.unit_of(free.position),
            written: WrittenValue {
                value: level,
                sd: shown(estimate.sd),
                low: shown(profile.0).filter(|_| !open_below),
                high: shown(profile.1),
                unit: law.level_unit(place),
            },
            at_limit: estimate.at_bound != 0,
        }
    })
    .collect()
}

/// Uncertainty of a value in SI: that of a stiffness in N/m^e has a part of e.
fn sd_in_si(law: &FreeLaw, fit: &FeatureFit, place: usize, value: f64) -> Option<f64> {
    let covariance = fit.information.covariance.as_ref()?;
    let coordinates = &law.coordinates;
    let free = &coordinates.free[place];
    let mut slopes = vec![0.0; coordinates.free.len()];
    slopes[place] = 1.0;
    if free.logarithmic {
        for (other, slope) in coordinates.free.iter().zip(&mut slopes) {
            let named = free.exponents.iter().filter(|e| **e == other.position);
            *slope -= named.count() as f64 * coordinates.length.ln();
        }
    }
    let mut variance = 0.0;
    for (i, a) in slopes.iter().enumerate() {
        for (j, b) in slopes.iter().enumerate() {
            variance += a * b * covariance[(i, j)];
        }
    }
    let sd = fit.widened * variance.max(0.0).sqrt();
    Some(if free.logarithmic { value * sd } else { sd })
}

/// A direction as people read it: "k +10 %, e −0.06, c +1.7 %".
fn direction_outcome(law: &FreeLaw, direction: &Direction, widened: f64) -> DirectionOutcome {
    let names = law.names();
    let parts = names.iter().cloned().zip(direction.vector.iter().copied());
    let sd = direction.sd.is_finite().then_some(widened * direction.sd);
    DirectionOutcome {
        parts: parts.collect(),
        words: match (
            sd,
            direction_words(law, &direction.vector, sd.unwrap_or(0.1)),
        ) {
            (None, words) => format!("{words}: nothing tells"),
            (Some(_), words) => format!("± {words}"),
        },
        sd,
    }
}

/// Logarithm of a change that is given by its order of magnitude; 1.
const MANY: f64 = 10.0;

/// Changes along a direction of a length.
pub fn direction_words(law: &FreeLaw, vector: &[f64], length: f64) -> String {
    let free = law.coordinates.free.iter().zip(law.names()).zip(vector);
    let words = free.map(|((free, name), part)| {
        let change = length * part;
        match free.logarithmic {
            // By orders of magnitude: nothing determines it.
            true if change > MANY => format!("{name} × 1e{:.0}", change / std::f64::consts::LN_10),
            true => format!("{name} {:+.2} %", 100.0 * change.exp_m1()),
            false => format!("{name} {change:+.4}"),
        }
    });
    words.collect::<Vec<_>>().join(", ")
}

fn nuisance_name(nuisance: &Nuisance, drops: &[DropData], problem: &FeatureProblem) -> String {
    let drop = |pick: fn(&MeasuredDrop) -> usize| {
        let place = problem.drops.iter().position(|d| pick(d) == nuisance.index);
        place.and_then(|place| drops.get(place))
    };
    match nuisance.quantity {
        RigQuantity::Mass => match drop(|d| d.fruit) {
            Some(drop) => format!("mass of {}", drop.specimen),
            None => "mass".to_owned(),
        },
        RigQuantity::Height => format!("height {} m", plain(nuisance.known.value)),
        RigQuantity::EffectiveMassFactor => "effective mass factor".to_owned(),
        RigQuantity::PlateMass => "mass of the plate".to_owned(),
        RigQuantity::PlateStiffness => "stiffness of the plate".to_owned(),
        RigQuantity::PlateDamping => "damping of the plate".to_owned(),
    }
}

fn nuisance_unit(quantity: RigQuantity) -> &'static str {
    match quantity {
        RigQuantity::Mass | RigQuantity::PlateMass => "kg",
        RigQuantity::Height => "m",
        RigQuantity::EffectiveMassFactor => "1",
        RigQuantity::PlateStiffness => "N/m",
        RigQuantity::PlateDamping => "N s/m",
    }
}

fn findings_of(law: &FreeLaw, outcome: &FeaturesOutcome) -> Vec<FindingOutcome> {
    let mut findings = Vec::new();
    let count = law.count();
    if !outcome.converged {
        let message = "the fit of the features stopped before it reached a minimum; its values \
                       are no estimates";
        findings.push(finding("no-convergence", message.to_owned()));
    }
    if outcome.rank < count {
        let message = format!(
            "the features determine {} of {count} directions in ({}): the law above is one of a \
             family that fits as well, and not the answer",
            outcome.rank,
            law.names().join(", ")
        );
        findings.push(finding("one-of-a-family", message));
    }
    let directions = outcome.directions.iter();
    for direction in directions.filter(|d| d.sd.is_some_and(|sd| sd > OPEN)) {
        let words = &direction.words;
        let message = format!("hardly determined, {words}: other laws fit nearly as well");
        findings.push(finding("weakly-determined", message));
    }
    if let (Some(p), true) = (outcome.p, outcome.widened > 1.0) {
        let message = format!(
            "the features scatter more than their uncertainties say ({}): \
             fruit differ, or the law misses something; the standard uncertainties were widened \
             {} times",
            chi_square(outcome.chi_square, outcome.freedom as f64, Some(p)),
            plain(outcome.widened)
        );
        findings.push(finding("scatter", message));
    }
    for parameter in outcome.parameters.iter().filter(|p| p.at_limit) {
        let message = format!("{} ended at a limit of the law", parameter.name);
        findings.push(finding("at-bound", message));
    }
    for (place, parameter) in outcome.parameters.iter().enumerate() {
        let range = law.ranges[place].as_ref();
        let value = parameter.written.value;
        if let Some(range) = range.filter(|range| value < range.low || value > range.high) {
            let message = format!(
                "{} = {} lies outside its range, {} to {} {}",
                parameter.name,
                plain(value),
                plain(range.low),
                plain(range.high),
                parameter.written.unit
            );
            findings.push(finding("outside-range", message));
        }
    }
    findings
}

/// Heights that tell the members of a line apart: the campaign's, or multiples of its only one.
pub fn telling_heights(heights: &[f64], target: f64) -> Vec<f64> {
    match heights.len() {
        0 | 1 => vec![0.2 * target, 0.5 * target, target, 2.0 * target],
        _ => heights.to_vec(),
    }
}

/// The line of laws with the target's first peak and interval, if there is one.
///
/// # Errors
/// The law cannot be simulated at the target.
pub fn family_line(
    law: &FreeLaw,
    rig: &CalibrateRig,
    target: &TargetCondition,
    heights: &[f64],
    end: EndRule,
) -> Result<Option<FamilyLine>, Error> {
    if law.count() <= target.features.len() {
        return Ok(None);
    }
    // Masses and heights have no part in the line: their errors only move it.
    let mut problem = target_problem(rig, target, end);
    problem.rig.mass = target.mass.value;
    problem.fruits[0].sd = 0.0;
    problem.heights[0].sd = 0.0;
    problem.rig_sd = RigUncertainty::default();
    let start = fit(law, &problem, target, false)?;
    let dimension = law.count() - start.information.rank;
    let (low, high) = law.limits(&start.at);
    let inside = within(&start.at, &low, &high);
    let options = FamilyOptions {
        low,
        high,
        step: 0.04,
        points: 200,
    };
    let mut model = |at: &[f64]| {
        let found = linearise(&problem, &law.coordinates, &[], (at, &[]))?;
        Ok((found.residuals, found.by_law))
    };
    // Where the fit ended outside the ranges, the line is entered at their nearest.
    let entry = match inside {
        true => Some(start.at.clone()),
        false => enter(&mut model, &start.at, &options),
    };
    let Some(entry) = entry.filter(|_| dimension == 1 && start.chi_square < 1e-6) else {
        let words = match dimension {
            1 => "no law within the ranges has both features of the target".to_owned(),
            n => format!("{n} directions are open: more than a line"),
        };
        let members = Vec::new();
        return Ok(Some(FamilyLine {
            dimension,
            words,
            members,
        }));
    };
    let line = trace_family(&mut model, &entry, &options).map_err(law_error)?;
    let chosen = chosen_points(&line, &mut model, &options).into_iter();
    let members = chosen.filter_map(|at| member(law, &problem.rig, &at, heights, end).ok());
    let members: Vec<FamilyMember> = members.collect();
    let words = line_words(law, &members);
    Ok(Some(FamilyLine {
        dimension,
        words,
        members,
    }))
}

fn within(at: &[f64], low: &[f64], high: &[f64]) -> bool {
    let mut places = 0..at.len();
    places.all(|place| at[place] >= low[place] && at[place] <= high[place])
}

/// A point of the line within the limits, from one beyond.
fn enter(model: &mut FamilyModel, from: &[f64], options: &FamilyOptions) -> Option<Vec<f64>> {
    let parts = [0.5, 0.25, 0.75, 0.05, 0.95];
    for place in 0..from.len() {
        for part in parts {
            let value = options.low[place] + part * (options.high[place] - options.low[place]);
            if let Ok(Some(at)) = family_point(model, from, (place, value), options)
                && within(&at, &options.low, &options.high)
            {
                return Some(at);
            }
        }
    }
    None
}

/// Points evenly over the first coordinate that changes much, exact on the line.
fn chosen_points(
    line: &[Vec<f64>],
    model: &mut FamilyModel,
    options: &FamilyOptions,
) -> Vec<Vec<f64>> {
    let (first, last) = (&line[0], &line[line.len() - 1]);
    let (from, to) = (first[0], last[0]);
    let count = MEMBERS.min(line.len().max(2));
    (0..count)
        .filter_map(|step| match step {
            0 => Some(first.clone()),
            step if step + 1 == count => Some(last.clone()),
            step => {
                let value = from + (to - from) * step as f64 / (count - 1) as f64;
                let near = line
                    .iter()
                    .min_by(|a, b| (a[0] - value).abs().total_cmp(&(b[0] - value).abs()))?;
                family_point(model, near, (0, value), options)
                    .ok()
                    .flatten()
            }
        })
        .collect()
}

fn member(
    law: &FreeLaw,
    rig: &DropRig,
    at: &[f64],
    heights: &[f64],
    end: EndRule,
) -> Result<FamilyMember, Error> {
    let own = law.coordinates.law_at(at).map_err(law_error)?;
    let heights = heights.iter();
    Ok(FamilyMember {
        parameters: law.levels(at),
        law: LawExpression::from(own).to_string(),
        heights: heights
            .map(|height| height_features(&own, rig, *height, end))
            .collect(),
    })
}

/// First peak, interval, second peak and first contact at a height.
pub fn height_features(law: &Law, rig: &DropRig, height: f64, end: EndRule) -> HeightFeatures {
    let shown = [
        PEAK,
        INTERVAL,
        DropFeature { impact: 1, ..PEAK },
        DropFeature {
            kind: FeatureKind::ContactDuration,
            impact: 0,
        },
    ];
    let values = feature_values(law, rig, height, &shown, end).unwrap_or_default();
    let named = shown.iter().map(DropFeature::name).zip(values);
    HeightFeatures {
        height,
        features: named.collect(),
    }
}

fn line_words(law: &FreeLaw, members: &[FamilyMember]) -> String {
    let (Some(first), Some(last)) = (members.first(), members.last()) else {
        return "no law within the ranges has both features of the target".to_owned();
    };
    let text = |member: &FamilyMember| {
        let pairs = law.names().into_iter().zip(&member.parameters);
        let words = pairs.enumerate().map(|(place, (name, value))| {
            let value = plain(*value);
            match law.level_unit(place).as_str() {
                "1" => format!("{name} = {value}"),
                unit => format!("{name} = {value} {}", unit_text(unit)),
            }
        });
        words.collect::<Vec<_>>().join(", ")
    };
    format!(
        "every law from ({}) to ({}) has the same first peak and interval at this height: one \
         height with these two features gives one of a family, not the answer",
        text(first),
        text(last)
    )
}
