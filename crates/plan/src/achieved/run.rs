//! A finished table and its model → what was achieved.

use crate::achieved::outcome::{AchievedEstimate, AchievedOutcome};
use crate::achieved::request::AchievedRequest;
use crate::parse::part;
use crate::question::Size;
use crate::study::{Study, read_study};
use windfall_files::error::Error;
use windfall_files::option_value::unusable;
use windfall_statistics::distribution::tail::t_upper_quantile;
use windfall_statistics::power::t_test::detectable_effect;
use windfall_statistics::power::{Sides, Test};
use windfall_tables::regress::means::{Adjust, MeansOutcome};
use windfall_tables::regress::mixed::MixedOutcome;
use windfall_tables::regress::request::RegressRequest;
use windfall_tables::regress::run::{AnyRegressOutcome, regress};

/// Looks back on a campaign: half-widths, detectable effects, variances, and about what half
/// and twice as many fruit would have given.
///
/// There is no power for the effect that was found: it says nothing beyond the p-value.
///
/// # Errors
/// The table, the model or an option cannot be used.
///
/// # Source
/// Hoenig and Heisey (2001), The abuse of power, Am. Stat. 55, 19.
pub fn achieved(request: &AchievedRequest) -> Result<AchievedOutcome, Error> {
    part("--confidence", request.confidence)?;
    let test = Test {
        alpha: 1.0 - request.confidence,
        sides: Sides::Two,
    };
    if part("--power", request.power)? <= test.alpha {
        let problem = format!("{} is no more than the level of the test", request.power);
        return Err(unusable("--power", problem));
    }
    let (study, _) = read_study(&request.table, &request.formula, &request.reading)?;
    let outcome = regressed(request)?;
    let mut estimates = coefficients(&study, &outcome, (test, request.power));
    for means in &outcome.means {
        estimates.extend(estimates_of_means(means, (test, request.power)));
    }
    Ok(AchievedOutcome {
        formula: outcome.formula.clone(),
        by: study.by.clone(),
        fruit: study.fruit.len(),
        impacts: outcome.count.rows,
        confidence: request.confidence,
        power: request.power,
        estimates,
        variances: outcome.variances,
        findings: outcome.findings,
    })
}

fn regressed(request: &AchievedRequest) -> Result<Box<MixedOutcome>, Error> {
    let regression = RegressRequest {
        formula: Some(request.formula.clone()),
        means: request.means.clone(),
        adjust: Adjust::None,
        confidence: request.confidence,
        reading: request.reading.clone(),
        ..RegressRequest::usual(request.table.clone(), String::new(), String::new())
    };
    match regress(&regression)? {
        AnyRegressOutcome::Mixed(outcome) => Ok(outcome),
        AnyRegressOutcome::Linear(_) => Err(unusable(
            "--formula",
            "the model does not say which rows are of one fruit: add (1 | COLUMN)",
        )),
    }
}

/// Coefficients; standard errors of other numbers of fruit with the variances of the fit, their
/// degrees of freedom in proportion to the fruit.
fn coefficients(
    study: &Study,
    outcome: &MixedOutcome,
    (test, power): (Test, f64),
) -> Vec<AchievedEstimate> {
    let all = study.fruit.len();
    let half = other_errors(study, all / 2);
    let twice = other_errors(study, 2 * all);
    let scaled = |errors: &[f64], place: usize, df: f64| {
        let half_width = errors.get(place)? * t_upper_quantile(test.tail(), df);
        half_width.is_finite().then_some(half_width)
    };
    let terms = outcome.terms.iter().enumerate();
    terms
        .map(|(place, term)| AchievedEstimate {
            kind: "coefficient",
            name: term.name.clone(),
            estimate: term.estimate,
            se: term.se,
            df: term.df,
            half_width: 0.5 * (term.high - term.low),
            detectable: (term.name != "(Intercept)")
                .then(|| term.se * detectable_effect(power, term.df, test))
                .filter(|value| value.is_finite()),
            half_width_with_half: scaled(&half, place, 0.5 * term.df),
            half_width_with_twice: scaled(&twice, place, 2.0 * term.df),
        })
        .collect()
}

fn other_errors(study: &Study, fruit: usize) -> Vec<f64> {
    let size = Size { fruit, impacts: 1 };
    match fruit {
        0 | 1 => Vec::new(),
        _ => study.standard_errors(&study.resized(size, true)),
    }
}

fn estimates_of_means(means: &MeansOutcome, (test, power): (Test, f64)) -> Vec<AchievedEstimate> {
    let of = |kind, name: String, estimate, (se, df): (f64, f64), (low, high): (f64, f64)| {
        AchievedEstimate {
            kind,
            name,
            estimate,
            se,
            df,
            half_width: 0.5 * (high - low),
            detectable: (kind != "mean").then(|| se * detectable_effect(power, df, test)),
            half_width_with_half: None,
            half_width_with_twice: None,
        }
    };
    let own = means.means.iter().map(|mean| {
        let name = mean.levels.join(", ");
        of(
            "mean",
            name,
            mean.mean,
            (mean.se, mean.df),
            (mean.low, mean.high),
        )
    });
    let pairs = means.differences.iter().map(|pair| {
        let ends = (pair.low, pair.high);
        let error = (pair.se, pair.df);
        of(
            "difference of means",
            pair.pair.clone(),
            pair.difference,
            error,
            ends,
        )
    });
    own.chain(pairs).collect()
}
