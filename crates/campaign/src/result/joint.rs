//! One law for all impacts on a specimen.

use crate::result::outcome::{ImpactOutcome, JointOutcome};
use itertools::Itertools;
use windfall_contact::laws::any_law::LARGEST_PARAMETERS as MOST;
use windfall_distribution::tail::{chi_squared_upper, normal_upper_quantile, t_upper_quantile};
use windfall_files::found::{EstimateOutcome, FindingOutcome};
use windfall_files::name::Name;
use windfall_files::named::{Named, grouped};
use windfall_numerics::cholesky;

/// Probability below which impacts on one specimen are said to differ.
const UNLIKELY: f64 = 0.01;

type Vector = [f64; MOST];
type Matrix = [Vector; MOST];

/// Parameters that all counted impacts on a specimen share, for each specimen and law with two
/// of them: the minimum of the sum of their costs, where each is a parabola about its own
/// minimum (first touch, velocity and offset remain each impact's own).
///
/// What the bench and priors shift is common to the impacts, and is not divided by their number.
/// Where the impacts differ by more than their deviations allow, the deviations are scaled to
/// their scatter (Birge ratio), with the quantile of t.
///
/// # Source
/// Aitken (1935), Proc. R. Soc. Edinburgh 55, 42, for the weights; Birge (1932), Phys. Rev. 40,
/// 207, for the scale.
pub fn joint_fits(impacts: &[ImpactOutcome]) -> Vec<JointOutcome> {
    let counted = impacts.iter().filter(|impact| impact.counts());
    let shared = grouped(counted.map(|own| ((own.law.as_str(), own.specimen.as_str()), own)));
    shared
        .into_iter()
        .filter(|(_, own)| own.len() > 1)
        .filter_map(|((law, specimen), own)| joint_fit(law, specimen, &own))
        .collect()
}

/// What an impact says of the parameters.
struct Own {
    value: Vector,
    /// Inverse of the covariance without what is common to all impacts.
    precision: Matrix,
}

fn joint_fit(law: &str, specimen: &str, impacts: &[&ImpactOutcome]) -> Option<JointOutcome> {
    let parameters = || impacts[0].parameters.0.iter().filter(|(_, own)| !own.held);
    let names: Vec<&str> = parameters().map(|(name, _)| name.as_str()).collect();
    let size = names.len();
    let own: Vec<Own> = impacts
        .iter()
        .map(|impact| own_of(impact, &names))
        .collect::<Option<_>>()?;
    let mut precision = padded(size);
    let mut right = [0.0; MOST];
    for impact in &own {
        for i in 0..size {
            right[i] += dot(&impact.precision[i], &impact.value);
            for j in 0..size {
                precision[i][j] += impact.precision[i][j];
            }
        }
    }
    let covariance = cholesky::inverse(&precision)?;
    let value = covariance.map(|row| dot(&row, &right));
    let chi_square: f64 = own
        .iter()
        .map(|impact| {
            let apart: Vector = std::array::from_fn(|i| impact.value[i] - value[i]);
            let weighed = impact.precision.map(|row| dot(&row, &apart));
            dot(&weighed, &apart)
        })
        .sum();
    let freedom = size * (impacts.len() - 1);
    let p = chi_squared_upper(chi_square, freedom as f64);
    let (scale, quantile) = match p < UNLIKELY {
        true => (
            (chi_square / freedom as f64).sqrt(),
            t_upper_quantile(0.025, freedom as f64),
        ),
        false => (1.0, normal_upper_quantile(0.025)),
    };

    let common = common_shifts(impacts, &names, |impact| {
        // Each impact's error moves the joint estimate by its share.
        let moved = own[impact].precision;
        move |shift: &Vector| {
            let push = moved.map(|row| dot(&row, shift));
            covariance.map(|row| dot(&row, &push))
        }
    });
    let sd = |i: usize| scale * covariance[i][i].sqrt();
    let estimates: Named<EstimateOutcome> = parameters()
        .enumerate()
        .map(|(i, (name, first))| {
            let shifts = common.0.iter().filter_map(|(_, own)| own.get(name));
            let shift = shifts.map(|shift| shift * shift).sum::<f64>().sqrt();
            let reach = (quantile * sd(i)).hypot(normal_upper_quantile(0.025) * shift);
            let alike = impacts.iter().all(|own| {
                own.parameters
                    .get(name)
                    .is_some_and(|own| own.unit == first.unit)
            });
            let estimate = EstimateOutcome {
                value: value[i],
                sd: Some(sd(i).hypot(shift)),
                low: Some(value[i] - reach),
                high: Some(value[i] + reach),
                unit: if alike { first.unit } else { Name::default() },
                held: false,
            };
            (*name, estimate)
        })
        .collect();
    let pairs = (0..size).array_combinations().map(|[i, j]| {
        let correlation = covariance[i][j] / (covariance[i][i] * covariance[j][j]).sqrt();
        (format!("{}, {}", names[i], names[j]), correlation)
    });
    Some(JointOutcome {
        specimen: specimen.to_owned(),
        law: law.to_owned(),
        impacts: impacts.iter().map(|own| own.id.clone()).collect(),
        parameters: estimates,
        correlations: pairs.collect(),
        common,
        chi_square,
        freedom,
        p,
        scale,
    })
}

/// `None` where the deviation of a parameter is not known.
fn own_of(impact: &ImpactOutcome, names: &[&str]) -> Option<Own> {
    let estimates: Vec<&EstimateOutcome> = names
        .iter()
        .map(|name| impact.parameters.get(name))
        .collect::<Option<_>>()?;
    let shifts = |of_prior: bool, name: &str| {
        let causes = impact.common.0.iter();
        let causes = causes.filter(|(cause, _)| cause.starts_with("prior.") == of_prior);
        let own: Vec<f64> = causes
            .map(|(_, own)| own.get(name).copied().unwrap_or(0.0))
            .collect();
        own
    };
    // Correlations are those of the fit: with priors, without the bench.
    let deviations: Vec<f64> = names
        .iter()
        .zip(&estimates)
        .map(|(name, own)| {
            let bench: f64 = shifts(false, name).iter().map(|shift| shift * shift).sum();
            Some((own.sd?.powi(2) - bench).sqrt())
        })
        .collect::<Option<_>>()?;
    let mut covariance = padded(names.len());
    for i in 0..names.len() {
        for j in 0..names.len() {
            let priors = shifts(true, names[i])
                .into_iter()
                .zip(shifts(true, names[j]));
            let of_priors: f64 = priors.map(|(a, b)| a * b).sum();
            let pair = format!("{}, {}", names[i.min(j)], names[i.max(j)]);
            let correlation = match i == j {
                true => 1.0,
                false => *impact.correlations.get(&pair)?,
            };
            covariance[i][j] = correlation * deviations[i] * deviations[j] - of_priors;
        }
    }
    let mut value = [0.0; MOST];
    for (value, own) in value.iter_mut().zip(&estimates) {
        *value = own.value;
    }
    let mut precision = cholesky::inverse(&covariance)?;
    (names.len()..MOST).for_each(|i| precision[i][i] = 0.0);
    Some(Own { value, precision })
}

/// What one standard uncertainty of each common cause moves in the joint estimate.
///
/// * `moved`: of an impact, what a shift of its estimates moves
fn common_shifts<F: Fn(&Vector) -> Vector>(
    impacts: &[&ImpactOutcome],
    names: &[&str],
    moved: impl Fn(usize) -> F,
) -> Named<Named<f64>> {
    let causes = impacts.iter().flat_map(|impact| impact.common.names());
    let of = |cause: &str| {
        let mut sum = [0.0; MOST];
        for (index, impact) in impacts.iter().enumerate() {
            let mut shift = [0.0; MOST];
            for (shift, name) in shift.iter_mut().zip(names) {
                let own = impact.common.get(cause).and_then(|own| own.get(name));
                *shift = own.copied().unwrap_or(0.0);
            }
            for (sum, own) in sum.iter_mut().zip(moved(index)(&shift)) {
                *sum += own;
            }
        }
        let sums = names.iter().zip(sum);
        sums.map(|(name, sum)| (Name::from(*name), sum)).collect()
    };
    let causes: Vec<&str> = causes.unique().collect();
    causes
        .iter()
        .map(|cause| (Name::from(*cause), of(cause)))
        .collect()
}

/// Zeros, with ones on the diagonal below the first `size` rows.
fn padded(size: usize) -> Matrix {
    let mut matrix = [[0.0; MOST]; MOST];
    (size..MOST).for_each(|i| matrix[i][i] = 1.0);
    matrix
}

fn dot(left: &Vector, right: &Vector) -> f64 {
    left.iter().zip(right).map(|(a, b)| a * b).sum()
}

/// Whether the impacts on single specimens agree with one law each, or no specimen has two.
pub fn joint_findings(joint: &[JointOutcome]) -> Vec<FindingOutcome> {
    if joint.is_empty() {
        let told = "no specimen has two impacts that count and whose deviations are known: there is \
                    nothing to fit jointly. Impacts on one specimen have its id in the column \
                    `specimen` of impacts.csv";
        return vec![FindingOutcome::new("joint-without-repeats", told)];
    }
    let laws = grouped(joint.iter().map(|own| (own.law.as_str(), own)));
    let findings = laws.into_iter().filter_map(|(law, own)| {
        let chi_square: f64 = own.iter().map(|own| own.chi_square).sum();
        let freedom: usize = own.iter().map(|own| own.freedom).sum();
        if chi_squared_upper(chi_square, freedom as f64) >= UNLIKELY {
            return None;
        }
        let apart = own.iter().filter(|own| own.p < UNLIKELY).count();
        let told = format!(
            "{law}: impacts on one specimen differ by {:.1} times what their deviations allow, over \
             {} specimens: spots differ, blows change the fruit, or the law does not hold at all \
             velocities. Where impacts differ clearly ({apart} of {}), the deviations of the joint \
             parameters are scaled to the scatter; `windfall population` separates what differs \
             within a specimen from what differs between specimens",
            (chi_square / freedom as f64).sqrt(),
            own.len(),
            own.len(),
        );
        Some(FindingOutcome::new("joint-scatter", told))
    });
    findings.collect()
}
