//! A finished table and its model → what was achieved.

use crate::achieved::outcome::{AchievedEstimate, AchievedOutcome};
use crate::achieved::request::AchievedRequest;
use crate::parse::part;
use crate::power::t_test::detectable_effect;
use crate::power::{Sides, Test};
use crate::study::read_study;
use windfall_distribution::tail::t_upper_quantile;
use windfall_files::error::Error;
use windfall_files::option_value::unusable;
use windfall_mixed::finding::MixedFinding;
use windfall_tables::regress::means::request::{Adjust, MeansRequest};
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
    let lost = study.fit.findings.iter();
    let lost = lost.filter(|own| matches!(own, MixedFinding::FlatCriterion { .. }));
    if lost.count() > 0 {
        let problem = format!(
            "the variances cannot be told apart: between {0} nothing is left beside the terms of \
             the model, as with one {0} of each level, or one impact on each {0}; a simpler model \
             or more {0} are needed",
            study.by
        );
        return Err(unusable("--formula", problem));
    }
    let outcome = regressed(request)?;
    let campaign = Campaign {
        fruit: study.fruit.len(),
        columns: study.columns_between(),
    };
    let fruit = campaign.fruit;
    let estimates = estimates(&outcome).into_iter();
    let estimates = estimates.map(|known| told(known, &campaign, (test, request.power)));
    Ok(AchievedOutcome {
        formula: outcome.formula.clone(),
        by: study.by.clone(),
        fruit,
        impacts: outcome.count.rows,
        confidence: request.confidence,
        power: request.power,
        estimates: estimates.collect(),
        variances: outcome.variances,
        findings: outcome.findings,
    })
}

fn regressed(request: &AchievedRequest) -> Result<Box<MixedOutcome>, Error> {
    let regression = RegressRequest {
        formula: Some(request.formula.clone()),
        after: MeansRequest {
            means: request.means.clone(),
            adjust: (!request.means.is_empty()).then_some(Adjust::None),
            ..MeansRequest::default()
        },
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

/// What is known of an estimate.
struct Known {
    kind: &'static str,
    name: String,
    estimate: f64,
    se: f64,
    df: f64,
    half_width: f64,
}

/// Size of a campaign.
struct Campaign {
    fruit: usize,
    /// Coefficients of what differs between fruit, and of what differs within them.
    columns: (usize, usize),
}

impl Campaign {
    /// Degrees of freedom with `factor` times as many fruit: without the coefficients of its
    /// stratum they are in proportion to the fruit, as N - p and N/2 - p between fruit.
    fn df(&self, factor: f64, df: f64) -> f64 {
        let (between, within) = self.columns;
        let coefficients = match df <= self.fruit as f64 {
            true => between as f64,
            false => within as f64,
        };
        factor * (df + coefficients) - coefficients
    }
}

/// Estimates with what they could have told.
///
/// What a study tells of its coefficients is a sum over its fruit: with as many fruit again of
/// the same settings squared standard errors are halved.
fn told(known: Known, campaign: &Campaign, (test, power): (Test, f64)) -> AchievedEstimate {
    let Known {
        kind,
        name,
        estimate,
        se,
        df,
        half_width,
    } = known;
    let scaled = |factor: f64| {
        let df = campaign.df(factor, df);
        let width = se / factor.sqrt() * t_upper_quantile(test.tail(), df);
        (width.is_finite() && df >= 1.0 && factor * campaign.fruit as f64 >= 2.0).then_some(width)
    };
    let tested = kind != "mean" && name != "(Intercept)";
    let detectable = se * detectable_effect(power, df, test);
    AchievedEstimate {
        detectable: Some(detectable).filter(|own| tested && own.is_finite()),
        half_width_with_half: scaled(0.5),
        half_width_with_twice: scaled(2.0),
        kind,
        name,
        estimate,
        se,
        df,
        half_width,
    }
}

fn estimates(outcome: &MixedOutcome) -> Vec<Known> {
    let terms = outcome.terms.iter().map(|term| Known {
        kind: "coefficient",
        name: term.name.clone(),
        estimate: term.estimate,
        se: term.se,
        df: term.df,
        half_width: 0.5 * (term.high - term.low),
    });
    let means = outcome.means.iter().flat_map(|means| &means.means);
    let means = means.map(|mean| Known {
        kind: "mean",
        name: mean.levels.join(", "),
        estimate: mean.mean,
        se: mean.se,
        df: mean.df,
        half_width: 0.5 * (mean.high - mean.low),
    });
    let pairs = outcome.means.iter().flat_map(|means| &means.differences);
    let pairs = pairs.map(|pair| Known {
        kind: "difference of means",
        name: pair.contrast.clone(),
        estimate: pair.difference,
        se: pair.se,
        df: pair.df,
        half_width: 0.5 * (pair.high - pair.low),
    });
    terms.chain(means).chain(pairs).collect()
}
