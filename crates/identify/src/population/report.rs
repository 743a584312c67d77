//! From the end of the iterations to estimates with intervals and findings.

use crate::population::finding::PopulationFinding;
use crate::population::linear::LinearProblem;
use crate::population::model::{
    FixedEffect, PopulationData, PopulationFit, PopulationOptions, Spread, Variation,
};
use crate::population::profile::{Quantity, interval};
use crate::population::state::{State, iteration_findings};
use crate::population::variance::{Level, Structure};
use nalgebra::{SMatrix, SVector};
use windfall_distribution::tail::{chi_squared_upper_quantile, t_two_sided, t_upper_quantile};

/// Fewer fruit than this are remarked on.
const FEW_FRUIT: usize = 10;
/// Standard deviations below this share of the overall one are zero.
const ZERO: f64 = 1e-4;
/// Correlations beyond this are ±1.
const BOUND: f64 = 0.9995;
/// Shift, in standard errors, that is remarked on.
const SHIFT: f64 = 0.2;

/// The estimates; `first_order`: the problem without the second-order shifts, whose
/// likelihood is reported.
pub(crate) fn report<const Q: usize>(
    data: &PopulationData,
    state: &State<Q>,
    first_order: &LinearProblem<Q>,
    options: &PopulationOptions,
) -> PopulationFit {
    let optimum = &state.optimum;
    let effects = &optimum.value;
    let deviance = first_order
        .evaluate(&optimum.root, &optimum.within)
        .map_or(f64::NAN, |value| value.deviance);
    let findings = findings(data, state);
    PopulationFit {
        parameters: data.parameters.clone(),
        covariates: state.design.covariates.clone(),
        effects: fixed_effects(data, state, options),
        effects_covariance: (0..effects.effects.len())
            .map(|i| effects.covariance.row(i).iter().copied().collect())
            .collect(),
        between: variation(state, &optimum.between, Level::Between, options),
        within: variation(state, &optimum.within, Level::Within, options),
        fruit: fruit_modes(data, state),
        impacts: in_order(state, |i| state.modes[i].value),
        log_likelihood: -0.5 * deviance + state.not_quadratic,
        not_quadratic: state.not_quadratic,
        shift_from_fits: state.shift_from_fits,
        shift_from_first_order: state.shift_from_first_order,
        iterations: state.iterations,
        converged: findings.iter().all(|f| {
            !matches!(
                f,
                PopulationFinding::NoMaximum | PopulationFinding::NoConvergence { .. }
            )
        }),
        findings,
    }
}

/// Values of the impacts in the order of the data.
fn in_order<const Q: usize>(
    state: &State<Q>,
    value: impl Fn(usize) -> SVector<f64, Q>,
) -> Vec<Vec<f64>> {
    let mut out = vec![Vec::new(); state.order.len()];
    for (own, &i) in state.order.iter().enumerate() {
        out[i] = value(own).as_slice().to_vec();
    }
    out
}

fn fruit_modes<const Q: usize>(data: &PopulationData, state: &State<Q>) -> Vec<Vec<f64>> {
    let effects = &state.optimum.value.effects;
    let centre = SVector::<f64, Q>::from_fn(|a, _| effects[a * state.design.columns]);
    let ranges = state.problem.fruit.iter();
    debug_assert_eq!(ranges.len(), data.fruit.iter().max().map_or(0, |m| m + 1));
    ranges
        .map(|range| {
            let first = range.start;
            let own = state.modes[first].fruit - state.problem.mean(first, effects);
            (centre + own).as_slice().to_vec()
        })
        .collect()
}

fn fixed_effects<const Q: usize>(
    data: &PopulationData,
    state: &State<Q>,
    options: &PopulationOptions,
) -> Vec<FixedEffect> {
    let value = &state.optimum.value;
    let freedom = state.optimum.degrees_of_freedom(&state.problem);
    let columns = state.design.columns;
    let effect = |k: usize| {
        let (estimate, se) = (value.effects[k], value.covariance[(k, k)].sqrt());
        let df = freedom
            .as_ref()
            .map_or(f64::INFINITY, |f| f[k])
            .clamp(1.0, 1e6);
        let quantile = t_upper_quantile(0.5 * (1.0 - options.confidence), df);
        FixedEffect {
            parameter: data.parameters[k / columns].clone(),
            covariate: (k % columns)
                .checked_sub(1)
                .map(|c| state.design.covariates[c].0.clone()),
            value: estimate,
            se,
            df,
            low: estimate - quantile * se,
            high: estimate + quantile * se,
            p: t_two_sided(estimate / se, df),
        }
    };
    (0..value.effects.len()).map(effect).collect()
}

fn pairs<const Q: usize>() -> impl Iterator<Item = (usize, usize)> {
    (0..Q).flat_map(|k| (k + 1..Q).map(move |l| (k, l)))
}

fn variation<const Q: usize>(
    state: &State<Q>,
    covariance: &SMatrix<f64, Q, Q>,
    level: Level,
    options: &PopulationOptions,
) -> Variation {
    let threshold = chi_squared_upper_quantile(1.0 - options.confidence, 1.0);
    let structure = state.optimum.variances.of(level).structure;
    let of = |quantity| match structure {
        Structure::Zero => None,
        _ => interval(&state.problem, &state.optimum, (level, quantity), threshold),
    };
    let sd = |k: usize| covariance[(k, k)].max(0.0).sqrt();
    let sds = (0..Q).map(|k| Spread {
        value: sd(k),
        interval: of(Quantity::Sd(k)),
    });
    let correlations = pairs::<Q>().map(|(k, l)| Spread {
        value: covariance[(k, l)] / (sd(k) * sd(l)).max(f64::MIN_POSITIVE),
        interval: match structure {
            Structure::Full => of(Quantity::Correlation(k, l)),
            _ => None,
        },
    });
    Variation {
        covariance: (0..Q)
            .map(|k| covariance.row(k).iter().copied().collect())
            .collect(),
        sds: sds.collect(),
        correlations: correlations.collect(),
    }
}

fn findings<const Q: usize>(data: &PopulationData, state: &State<Q>) -> Vec<PopulationFinding> {
    let mut out = state.design.findings.clone();
    let fruits = state.problem.fruit.len();
    if fruits < FEW_FRUIT {
        out.push(PopulationFinding::FewFruit {
            fruits,
            percent: 100.0 / (2.0 * (fruits - 1) as f64).sqrt(),
        });
    }
    out.extend(iteration_findings(state));
    let optimum = &state.optimum;
    for (level, covariance) in [
        (Level::Between, &optimum.between),
        (Level::Within, &optimum.within),
    ] {
        if optimum.variances.of(level).structure == Structure::Zero {
            continue;
        }
        let scale = optimum.variances.between.scale;
        let varies = |k: usize| covariance[(k, k)].max(0.0).sqrt() > ZERO * scale[k];
        for k in (0..Q).filter(|k| !varies(*k)) {
            out.push(PopulationFinding::NoVariation {
                parameter: data.parameters[k].clone(),
                level: level.name(),
            });
        }
        for (k, l) in pairs::<Q>().filter(|(k, l)| varies(*k) && varies(*l)) {
            let value = covariance[(k, l)] / (covariance[(k, k)] * covariance[(l, l)]).sqrt();
            if value.abs() > BOUND {
                out.push(PopulationFinding::CorrelationAtBound {
                    first: data.parameters[k].clone(),
                    second: data.parameters[l].clone(),
                    level: level.name(),
                    value,
                });
            }
        }
    }
    if state.shift_from_first_order > SHIFT {
        out.push(PopulationFinding::NotNormal {
            shift: state.shift_from_first_order,
        });
    }
    out
}
