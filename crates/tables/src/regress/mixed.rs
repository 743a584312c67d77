//! `windfall regress` with random effects: a linear mixed model.

use crate::figures::effects::{EffectModel, effects_painting};
use crate::regress::findings::{
    aliased_findings, code_findings, condition_finding, extrapolated, finding, left_out_finding,
    row_count,
};
use crate::regress::means::outcome::MeansOutcome;
use crate::regress::means::run::{Model, means_of};
use crate::regress::mixed_figures::{MixedShown, mixed_paintings};
pub use crate::regress::mixed_outcome::{
    EffectOutcome, MixedLevelsOutcome, MixedOutcome, MixedPredictionOutcome, MixedTest,
    VarianceOutcome,
};
use crate::regress::mixed_variances::{level_variances, variances};
use crate::regress::outcome::{original_prediction, ranges_of};
use crate::regress::request::{FreedomMethod, RegressRequest};
use crate::regress::variances::run::{asked_levels, residual_levels};
use windfall_draw::files::write_paintings;
use windfall_files::error::Error;
use windfall_files::found::FindingOutcome;
use windfall_files::option_value::unusable;
use windfall_files::table::data::Data;
use windfall_mixed::coefficient::Estimated;
use windfall_mixed::fit::{MixedFit, MixedOptions, fit_mixed_weighted};
use windfall_mixed::fit_levels::fit_mixed_levels;
use windfall_mixed::inference::{
    FTest, VarianceUncertainty, coefficient_tests, estimate, f_test, picking_contrast,
    variance_uncertainty,
};
use windfall_mixed::kenward_roger::{
    KenwardRoger, kenward_roger, kenward_roger_estimate, kenward_roger_f, kenward_roger_tests,
};
use windfall_mixed::predict::{NewRows, predict_mixed};
use windfall_mixed::profile::{Profiles, profile_variances};
use windfall_mixed::summary::variance_shares;
use windfall_mixed::term::RandomTerm;
use windfall_mixed::weights::Weights;
use windfall_statistics::error::Error as StatisticsError;
use windfall_statistics::model::anova::AnovaRow;
use windfall_statistics::model::contrast::Contrast;
use windfall_statistics::model::formula::Formula;
use windfall_statistics::model::formula_syntax::spelling;
use windfall_statistics::model::mean_contrasts::JointTest;
use windfall_statistics::model::model_frame::{chosen_rows, prediction_rows};
use windfall_statistics::model::model_rows::{
    ModelRows, column_weights, complete_rows, model_rows,
};
use windfall_statistics::model::original_scale::OriginalScale;
use windfall_statistics::model::random_terms::{FramedTerm, new_terms, random_terms};
use windfall_statistics::model::reduced::{Aliased, reduce};
use windfall_statistics::runs::Runs;

struct Fitted {
    rows: ModelRows,
    aliased: Vec<Aliased>,
    condition: f64,
    columns: Vec<usize>,
    terms: Vec<FramedTerm>,
    fit: MixedFit,
}

/// Fits a mixed model.
///
/// * `formula`: with its random parts; `text`: as it was written
///
/// # Errors
/// The table or the formula cannot be used; the model cannot be fitted.
pub fn regress_mixed(
    request: &RegressRequest,
    data: &Data,
    formula: &Formula,
    text: &str,
) -> Result<MixedOutcome, Error> {
    check(request)?;
    let (kept, left_out) =
        complete_rows(formula, &data.table, &request.also()).map_err(|error| data.told(error))?;
    let table = chosen_rows(&data.table, &kept).into_owned();
    let chosen = Data {
        path: data.path.clone(),
        table,
        comments: Vec::new(),
        lines: kept.iter().map(|row| data.line(*row)).collect(),
        left_out: data.left_out,
    };
    let runs: Runs = kept.iter().copied().collect();
    let inference = infer(request, &chosen, formula, request.contrasts)?;
    let summed = match inference.fitted.rows.frame.has_categories() {
        true => Some(infer(request, &chosen, formula, Contrast::Sum)?),
        false => None,
    };
    let anova = term_tests(summed.as_ref().unwrap_or(&inference))?;
    let Inference {
        fitted,
        uncertainty,
        adjusted,
    } = inference;
    let terms = match &adjusted {
        None => coefficient_tests(&fitted.fit, &uncertainty, request.confidence),
        Some(adjusted) => kenward_roger_tests(&fitted.fit, adjusted, request.confidence),
    };
    let profiles =
        profile_variances(&fitted.fit, fitted.fit.method, request.confidence).map_err(mixed)?;
    let (variances, profile_findings) = variances(&fitted.fit, &profiles);
    let response = formula.response.as_ref().map(spelling).unwrap_or_default();
    let inferred = (&fitted, &uncertainty, adjusted.as_ref());
    let mut findings = left_out_finding(&left_out, &data.lines);
    findings.extend(fit_findings(
        data,
        (&fitted, &uncertainty),
        profile_findings,
    ));
    let (means, not_estimable) = means(request, data, (formula, &runs), inferred)?;
    findings.extend(not_estimable);
    let (asked, ranges) = (request.asked()?, ranges_of(formula, &data.table, &runs));
    findings.extend(extrapolated(
        &ranges,
        &request.after.held()?,
        asked.as_ref(),
    ));
    let scale = formula.response.as_ref();
    let scale = scale.and_then(|response| OriginalScale::of(response, &data.table, &runs));
    let predictions = predictions(
        (request, asked.as_ref()),
        scale.as_ref(),
        &fitted,
        &uncertainty,
    )?;
    draw(request, (&chosen, &response), inferred, &profiles)?;
    let shares = variance_shares(&fitted.fit);
    let fit = &fitted.fit;
    Ok(MixedOutcome {
        formula: text.to_owned(),
        response,
        method: fit.method.name(),
        df_method: adjusted.map_or("Satterthwaite", |_| "Kenward-Roger"),
        count: row_count(&fitted.rows.frame, &data.table, &left_out),
        groups: fitted
            .terms
            .iter()
            .map(|t| (t.term.name.clone(), t.term.groups))
            .collect(),
        weights: request.weights.clone(),
        level_variances: level_variances(fit),
        terms,
        covariance: fit.covariance_rows(),
        ranges,
        anova,
        variances,
        r2: shares.r2_marginal,
        r2_adjusted: None,
        r2_conditional: shares.r2_conditional,
        intraclass: shares.intraclass,
        log_likelihood: fit.log_likelihood,
        criterion: fit.criterion,
        aic: fit.aic,
        aicc: fit.aicc,
        bic: fit.bic,
        removed: Vec::new(),
        effects: effects(&fitted),
        predictions,
        means,
        findings,
    })
}

/// What is said of a fit; that which search, inference and profiles all say, once.
fn fit_findings(
    data: &Data,
    (fitted, uncertainty): (&Fitted, &VarianceUncertainty),
    profile_findings: Vec<FindingOutcome>,
) -> Vec<FindingOutcome> {
    let mut findings: Vec<FindingOutcome> = data.left_out_finding().into_iter().collect();
    findings.extend(code_findings(&fitted.rows.frame, &data.table));
    findings.extend(aliased_findings(&fitted.rows.frame, &fitted.aliased));
    findings.extend(condition_finding(fitted.condition));
    let own = fitted.fit.findings.iter().chain(&uncertainty.findings);
    let own = own.map(|f| finding(f.code(), f.to_string()));
    for own in own.chain(profile_findings) {
        if !findings.contains(&own) {
            findings.push(own);
        }
    }
    findings
}

/// What linear models have, and mixed ones do not.
fn check(request: &RegressRequest) -> Result<(), Error> {
    if request.select.is_some() {
        let problem = "terms of mixed models are not selected here: compare models fitted by \
                       --likelihood ml by their criteria";
        return Err(unusable("--select", problem));
    }
    if request.robust {
        let problem = "there are no HC3 errors of mixed models: the random effects are what makes \
                       their errors right";
        return Err(unusable("--robust", problem));
    }
    Ok(())
}

fn means(
    request: &RegressRequest,
    data: &Data,
    (formula, kept): (&Formula, &Runs),
    (fitted, uncertainty, adjusted): (&Fitted, &VarianceUncertainty, Option<&KenwardRoger>),
) -> Result<(Vec<MeansOutcome>, Vec<FindingOutcome>), Error> {
    let fit = &fitted.fit;
    let model = Model {
        frame: &fitted.rows.frame,
        aliased: &fitted.aliased,
        table: &data.table,
        kept,
        response: formula.response.as_ref(),
        estimate: &|weights| estimated(weights, (fitted, uncertainty, adjusted)),
        covariance: &|sums| {
            let own = sums.select_columns(&fitted.columns);
            let covariance = adjusted.map_or(&fit.covariance, |own| &own.covariance);
            &own * covariance * own.transpose()
        },
        test: &|sums| {
            let own = sums.select_columns(&fitted.columns);
            let test = match adjusted {
                None => f_test(fit, uncertainty, &own),
                Some(adjusted) => kenward_roger_f(fit, adjusted, &own),
            };
            let test = test.ok()?;
            Some(JointTest {
                f: test.f,
                df: test.numerator,
                df_denominator: test.denominator,
                p: test.p,
            })
        },
    };
    means_of(&model, &request.after, request.confidence)
}

/// A sum of fixed coefficients, with weights of all columns of the model.
fn estimated(
    weights: &[f64],
    (fitted, uncertainty, adjusted): (&Fitted, &VarianceUncertainty, Option<&KenwardRoger>),
) -> Estimated {
    let own: Vec<f64> = fitted.columns.iter().map(|own| weights[*own]).collect();
    match adjusted {
        None => estimate(&fitted.fit, uncertainty, &own),
        Some(adjusted) => kenward_roger_estimate(&fitted.fit, adjusted, &own),
    }
}

/// Draws the model where figures are asked for.
fn draw(
    request: &RegressRequest,
    (data, response): (&Data, &str),
    inferred: (&Fitted, &VarianceUncertainty, Option<&KenwardRoger>),
    profiles: &Profiles,
) -> Result<(), Error> {
    let Some(folder) = &request.figures else {
        return Ok(());
    };
    let fitted = inferred.0;
    let lines: Vec<usize> = data.lines.iter().collect();
    let terms: Vec<RandomTerm> = fitted.terms.iter().map(|own| own.term.clone()).collect();
    let mut paintings = mixed_paintings(&MixedShown {
        response,
        observed: &fitted.rows.y,
        lines: &lines,
        terms: &terms,
        fit: &fitted.fit,
        profiles,
        confidence: request.confidence,
    })?;
    paintings.extend(effects_painting(&EffectModel {
        response,
        frame: &fitted.rows.frame,
        estimated: &fitted.columns,
        aliased: &fitted.aliased,
        table: &data.table,
        lines: &lines,
        residuals: &fitted.fit.residuals,
        estimate: &|weights| estimated(weights, inferred),
        confidence: request.confidence,
    })?);
    write_paintings(folder, &paintings).map(|_| ())
}

fn mixed(error: windfall_mixed::error::MixedError) -> Error {
    Error::Statistics(StatisticsError::Mixed(error))
}

fn fit(
    request: &RegressRequest,
    data: &Data,
    formula: &Formula,
    contrast: Contrast,
) -> Result<Fitted, Error> {
    let told = |error| data.told(error);
    let rows = model_rows(formula, &data.table, contrast, &[]).map_err(told)?;
    let terms = random_terms(formula, &data.table, contrast).map_err(told)?;
    let every: Vec<usize> = (0..rows.x.ncols()).collect();
    let solved = reduce(&rows.x, &rows.y).solve(&every);
    let (columns, aliased, condition) = (solved.columns, solved.aliased, solved.condition);
    let names: Vec<String> = columns
        .iter()
        .map(|c| rows.frame.names[*c].clone())
        .collect();
    let numbers: Vec<_> = terms.iter().map(|framed| framed.term.clone()).collect();
    let options = MixedOptions {
        method: request.likelihood,
    };
    let x = rows.x.select_columns(&columns);
    let weights = match &request.weights {
        Some(name) => column_weights(&data.table, name, 0..rows.y.len()).map_err(told)?,
        None => Weights::default(),
    };
    let fit = match &request.variance {
        None => fit_mixed_weighted((&rows.y, &weights), &x, &names, &numbers, &options),
        Some(column) => {
            let levels = residual_levels(column, data, 0..rows.y.len())?;
            fit_mixed_levels((&rows.y, &levels), &x, &names, &numbers, &options)
        }
    };
    let fit = fit.map_err(|error| told(StatisticsError::Mixed(error)))?;
    Ok(Fitted {
        rows,
        aliased,
        condition,
        columns,
        terms,
        fit,
    })
}

/// A fit with what its tests need.
struct Inference {
    fitted: Fitted,
    uncertainty: VarianceUncertainty,
    adjusted: Option<KenwardRoger>,
}

fn infer(
    request: &RegressRequest,
    data: &Data,
    formula: &Formula,
    contrast: Contrast,
) -> Result<Inference, Error> {
    let fitted = fit(request, data, formula, contrast)?;
    Ok(Inference {
        uncertainty: variance_uncertainty(&fitted.fit).map_err(mixed)?,
        adjusted: match request.df {
            FreedomMethod::Satterthwaite => None,
            FreedomMethod::KenwardRoger => Some(kenward_roger(&fitted.fit).map_err(mixed)?),
        },
        fitted,
    })
}

/// F tests of the terms after all others, from a fit with sum contrasts.
fn term_tests(inference: &Inference) -> Result<Vec<MixedTest>, Error> {
    let Inference {
        fitted,
        uncertainty,
        adjusted,
    } = inference;
    let count = fitted.columns.len();
    let mut tests = Vec::new();
    for term in &fitted.rows.frame.terms {
        let places = fitted.columns.iter().enumerate();
        let picked = places.filter(|(_, column)| term.columns.contains(column));
        let picked: Vec<usize> = picked.map(|(place, _)| place).collect();
        if picked.is_empty() {
            continue;
        }
        let contrast = picking_contrast(count, &picked);
        let test: FTest = match adjusted {
            None => f_test(&fitted.fit, uncertainty, &contrast).map_err(mixed)?,
            Some(adjusted) => kenward_roger_f(&fitted.fit, adjusted, &contrast).map_err(mixed)?,
        };
        tests.push(MixedTest {
            test: AnovaRow {
                term: term.name.clone(),
                ss: f64::NAN,
                df: test.numerator as f64,
                f: test.f,
                p: test.p,
            },
            df_denominator: test.denominator,
        });
    }
    Ok(tests)
}

fn effects(fitted: &Fitted) -> Vec<EffectOutcome> {
    let mut found = Vec::new();
    for (framed, effects) in fitted.terms.iter().zip(&fitted.fit.effects) {
        let term = &framed.term;
        for (group, name) in term.group_names.iter().enumerate() {
            for (column, of) in term.column_names.iter().enumerate() {
                found.push(EffectOutcome {
                    by: term.name.clone(),
                    group: name.clone(),
                    of: of.clone(),
                    value: effects.values[group][column],
                    sd: effects.sds[group][column],
                });
            }
        }
    }
    found
}

fn predictions(
    (request, asked): (&RegressRequest, Option<&Data>),
    scale: Option<&OriginalScale>,
    fitted: &Fitted,
    uncertainty: &VarianceUncertainty,
) -> Result<Vec<MixedPredictionOutcome>, Error> {
    let Some(asked) = asked else {
        return Ok(Vec::new());
    };
    let x = prediction_rows(&fitted.rows.frame, &asked.table).map_err(|error| asked.told(error))?;
    let rows = NewRows {
        x: x.select_columns(&fitted.columns),
        terms: new_terms(&fitted.terms, &asked.table).map_err(|error| asked.told(error))?,
        level: match fitted.fit.model.levels() {
            None => Vec::new(),
            Some(levels) => asked_levels(levels, asked)?,
        },
    };
    let found = predict_mixed(&fitted.fit, uncertainty, &rows, request.confidence);
    let found = found.map_err(mixed)?;
    let shown = found.iter().zip(asked.lines.iter());
    Ok(shown
        .map(|(&prediction, line)| MixedPredictionOutcome {
            line,
            prediction,
            original: original_prediction(
                scale,
                prediction.predicted,
                (prediction.mean_low, prediction.mean_high),
                (prediction.low, prediction.high),
            ),
        })
        .collect())
}
