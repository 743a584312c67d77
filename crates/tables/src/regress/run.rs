//! `windfall regress`: a table and a formula → a linear model.

use crate::regress::after::{means, predictions};
use crate::regress::figures::draw_linear;
use crate::regress::findings::{
    aliased_findings, code_findings, extrapolated, finding, fit_findings, lack_finding,
    left_out_finding, row_count,
};
use crate::regress::means::outcome::MeansOutcome;
use crate::regress::mixed::{MixedOutcome, regress_mixed};
use crate::regress::outcome::{
    PredictionOutcome, RangeOutcome, RowOutcome, RowOutcomes, StepOutcome, ranges_of,
};
use crate::regress::request::{AnovaType, Contrast, Criterion, Direction, RegressRequest};
use crate::regress::residuals::{ResidualOutcome, residual_findings, residual_tests};
use crate::regress::variances::outcome::VariancesOutcome;
use crate::regress::variances::run::{ByLevel, Tested, check_variance, weigh_levels};
use crate::rows::RowCount;
use serde::Serialize;
use windfall_files::error::Error;
use windfall_files::found::FindingOutcome;
use windfall_files::option_value::unusable;
use windfall_files::table::data::{Data, Wanted, open_data};
use windfall_files::write_file::check_outputs;
use windfall_mixed::coefficient::Coefficient;
use windfall_statistics::error::Error as StatisticsError;
use windfall_statistics::model::anova::{AnovaRow, LackOfFit, SumOfSquares, anova, lack_of_fit};
use windfall_statistics::model::formula::{Formula, formula};
use windfall_statistics::model::formula_syntax::spelling;
use windfall_statistics::model::linear_model::{LinearFit, Quality, WholeModel, fit_weighted};
use windfall_statistics::model::model_rows::{FormulaRows, column_weights, formula_rows, names_of};
use windfall_statistics::model::original_scale::OriginalScale;
use windfall_statistics::model::reduced::Reduced;
use windfall_statistics::model::selection::{Selection, select};
use windfall_statistics::model::variance_groups::LevelInference;
use windfall_statistics::residuals::cross_validation::{CrossValidation, Parts, cross_validate};
use windfall_statistics::residuals::diagnostics::{
    Inflation, Influence, inflation, influence, robust_coefficients, robust_covariance,
};

/// A fitted linear model.
#[derive(Clone, Debug, PartialEq, Serialize, utoipa::ToSchema)]
pub struct RegressOutcome {
    /// The formula in one spelling.
    pub formula: String,
    /// What is modelled.
    pub response: String,
    /// Rows that were used and left out, by the levels of the model's first category.
    #[serde(flatten)]
    pub count: RowCount,
    /// Column of the weights of rows.
    pub weights: Option<String>,
    /// Residual variances by level, where they differ.
    pub level_variances: Option<VariancesOutcome>,
    /// Estimates.
    pub terms: Vec<Coefficient>,
    /// Whether their standard errors are HC3.
    pub robust: bool,
    /// Covariance of the estimates, in the order of `terms`.
    #[schema(value_type = Vec<Vec<Option<f64>>>)]
    pub covariance: Vec<Vec<f64>>,
    /// In which ranges the columns of the model were.
    pub ranges: Vec<RangeOutcome>,
    /// How good the model is.
    #[serde(flatten)]
    pub quality: Quality,
    /// The model against none.
    pub model: WholeModel,
    /// Residuals.
    pub residual: SumOfSquares,
    /// The response.
    pub total: SumOfSquares,
    /// "I", "II" or "III".
    pub anova_type: &'static str,
    /// Analysis of variance.
    pub anova: Vec<AnovaRow>,
    /// Lack of fit, where rows are repeated.
    pub lack_of_fit: Option<LackOfFit>,
    /// Variance inflation.
    pub vif: Vec<Inflation>,
    /// Terms that were removed, in order.
    pub removed: Vec<StepOutcome>,
    /// Every step of the selection.
    pub steps: Vec<StepOutcome>,
    /// How the model predicts rows it was not fitted to.
    pub cross_validation: Option<CrossValidation>,
    /// Column of units whose rows stay together there.
    pub fold_by: Option<String>,
    /// Tests of the residuals.
    pub residuals: ResidualOutcome,
    /// Rows with their influence.
    #[schema(value_type = Vec<RowOutcome>)]
    pub influence: RowOutcomes,
    /// Predictions.
    pub predictions: Vec<PredictionOutcome>,
    /// Marginal means.
    pub means: Vec<MeansOutcome>,
    /// What a reader must know.
    pub findings: Vec<FindingOutcome>,
}

/// A model without random effects, or with them.
#[derive(Clone, Debug, PartialEq, Serialize, utoipa::ToSchema)]
#[serde(untagged)]
pub enum AnyRegressOutcome {
    /// Without.
    Linear(Box<RegressOutcome>),
    /// With.
    Mixed(Box<MixedOutcome>),
}

/// What a random part adds to a formula.
///
/// * `columns`: of the table; the name of one is taken as it is
pub(crate) fn random_text(random: &str, columns: &[String]) -> String {
    match random.contains('|') {
        true => format!(" + ({random})"),
        false if columns.iter().any(|own| own == random) => format!(" + (1 | `{random}`)"),
        false => format!(" + (1 | {random})"),
    }
}

/// Fits a linear model to a table, with random effects where there are any.
///
/// # Errors
/// The table or the formula cannot be read; too few rows; a response of one value.
pub fn regress(request: &RegressRequest) -> Result<AnyRegressOutcome, Error> {
    let request = &request.with_plain_names();
    check(request)?;
    check_outputs([request.figures.as_ref().map(|own| own.directory.as_path())])?;
    let file = open_data(&request.table)?;
    let names = file.names();
    let mut text = request.formula(&names);
    for random in &request.random {
        text += &random_text(random, &names);
    }
    let formula = formula(&text, &names).map_err(Error::Statistics)?;
    if formula.response.is_none() {
        let problem = "the response is missing: write 'response ~ terms'";
        return Err(unusable("--formula", problem));
    }
    let data = request.reading.read_some(file, wanted(request, &formula))?;
    match formula.random.is_empty() {
        true => {
            let outcome = regress_linear(request, &data, &formula)?;
            Ok(AnyRegressOutcome::Linear(Box::new(outcome)))
        }
        false => {
            let outcome = regress_mixed(request, &data, &formula, &text)?;
            Ok(AnyRegressOutcome::Mixed(Box::new(outcome)))
        }
    }
}

/// Columns that a model needs.
fn wanted(request: &RegressRequest, formula: &Formula) -> Wanted {
    let also = request.also();
    Wanted {
        named: names_of(formula, &also),
        // Questions after the model may name others.
        all: !request.after.is_empty(),
        ..Wanted::default()
    }
}

fn regress_linear(
    request: &RegressRequest,
    data: &Data,
    formula: &Formula,
) -> Result<RegressOutcome, Error> {
    let told = |error| data.told(error);
    let rows = formula_rows(formula, &data.table, request.contrasts, &request.also());
    let mut rows = rows.map_err(told)?;
    if let Some(name) = &request.weights {
        rows.weights = column_weights(&data.table, name, rows.kept.iter()).map_err(told)?;
    }
    let levels = weigh_levels(request, data, &mut rows)?;
    let reduced = rows.reduced().map_err(told)?;
    let every: Vec<usize> = (0..rows.frame.terms.len()).collect();
    let selection = match &request.selection() {
        Some(options) => select(&rows.frame, &reduced, options).weighted(&rows.weights),
        None => Selection {
            terms: every,
            steps: Vec::new(),
        },
    };
    let wanted = columns_of(&rows, &selection.terms);
    let (x, frame) = (rows.x(), &rows.frame);
    let weighted = (x, &rows.y[..], &rows.weights);
    let fit = fit_weighted(frame, weighted, &reduced, &wanted, request.confidence);
    let fit = fit.map_err(told)?;
    let inference = levels.as_ref().map(|own| own.inference(&rows, &fit));
    let inference = inference.transpose().map_err(told)?;
    let inferred = (&fit, inference.as_ref());
    let mut outcome = outcome(
        request, data, formula, &rows, &reduced, &selection, inferred,
    )?;
    if let (Some(levels), Some(inference)) = (&levels, &inference) {
        let own = (&rows, &reduced, &fit);
        infer_levels(
            request,
            data,
            formula,
            own,
            (levels, inference),
            &mut outcome,
        )?;
    }
    let lines = data.lines.at(&rows.kept);
    if let Some(folder) = &request.figures {
        let shown = (outcome.response.as_str(), &lines, &outcome.covariance[..]);
        draw_linear(
            folder,
            request,
            data,
            (&rows, &fit, inference.as_ref()),
            shown,
        )?;
    }
    outcome.influence = RowOutcomes::new(Influence::of(fit, rows.y), lines);
    Ok(outcome)
}

/// What follows from the variances of levels, in the place of what holds for known ones.
fn infer_levels(
    request: &RegressRequest,
    data: &Data,
    formula: &Formula,
    own: Tested,
    (levels, inference): (&ByLevel, &LevelInference),
    outcome: &mut RegressOutcome,
) -> Result<(), Error> {
    let told = |error| data.told(error);
    let (rows, _, fit) = own;
    outcome.terms = inference.coefficients(fit);
    let summed = match request.anova == AnovaType::Partial && rows.frame.has_categories() {
        true => Some(summed_rows(request, data, formula, rows)?),
        false => None,
    };
    let summed = summed.map(|rows| {
        let reduced = rows.reduced()?;
        let every: Vec<usize> = (0..rows.frame.terms.len()).collect();
        let wanted = columns_of(&rows, &every);
        let weighted = (rows.x(), &rows.y[..], &rows.weights);
        let fit = fit_weighted(&rows.frame, weighted, &reduced, &wanted, request.confidence)?;
        Ok((rows, reduced, fit))
    });
    let summed = summed.transpose().map_err(told)?;
    let tested = summed
        .as_ref()
        .map_or(own, |(rows, reduced, fit)| (rows, reduced, fit));
    let tests = (&mut outcome.anova[..], &mut outcome.model);
    let found = levels.tests(request, tested, tests).map_err(told)?;
    levels.qualify(&mut outcome.quality, fit);
    outcome.level_variances = Some(found);
    if let Some(asked) = request.asked()? {
        let scale = formula.response.as_ref();
        let scale = scale.and_then(|own| OriginalScale::of(own, &data.table, &rows.kept));
        let inference = (inference, request.confidence);
        outcome.predictions = levels.predictions(&asked, scale.as_ref(), rows, inference)?;
    }
    Ok(())
}

fn check(request: &RegressRequest) -> Result<(), Error> {
    check_part("--confidence", request.confidence)?;
    check_variance(request)?;
    let Some(selection) = request.selection() else {
        return Ok(());
    };
    if let Criterion::Probability { enter, remove } = selection.criterion {
        check_part("--p-enter", enter)?;
        check_part("--p-remove", remove)?;
        if selection.direction == Direction::Stepwise && enter > remove {
            let problem = "terms must not enter at a probability at which they leave: give \
                           --p-enter no larger than --p-remove";
            return Err(unusable("--p-enter", problem));
        }
    }
    Ok(())
}

/// Checks that an option's value lies between 0 and 1.
pub(crate) fn check_part(option: &str, value: f64) -> Result<(), Error> {
    match value > 0.0 && value < 1.0 {
        true => Ok(()),
        false => Err(unusable(option, format!("{value} is not between 0 and 1"))),
    }
}

/// Columns of some terms, with the intercept.
fn columns_of(rows: &FormulaRows, terms: &[usize]) -> Vec<usize> {
    let base = rows.frame.intercept.then_some(0);
    let columns = terms
        .iter()
        .flat_map(|t| rows.frame.terms[*t].columns.clone());
    base.into_iter().chain(columns).collect()
}

fn outcome(
    request: &RegressRequest,
    data: &Data,
    formula: &Formula,
    rows: &FormulaRows,
    reduced: &Reduced,
    selection: &Selection,
    (fit, inference): (&LinearFit, Option<&LevelInference>),
) -> Result<RegressOutcome, Error> {
    let told = |error| data.told(error);
    let lines = data.lines.at(&rows.kept);
    let influence = influence(fit, &rows.y);
    let vif = inflation(&rows.frame, fit);
    let steps = steps_of(rows, selection);
    let covariance = covariance_of(request, rows, fit).map_err(told)?;
    let terms = match request.robust {
        true => robust_coefficients(fit, &covariance),
        false => fit.coefficients.clone(),
    };
    let validation = validated(request, data, rows, selection)?;
    let mut findings = left_out_finding(&rows.left_out, &data.lines);
    findings.extend(data.left_out_finding());
    findings.extend(code_findings(&rows.frame, &data.table));
    findings.extend(aliased_findings(&rows.frame, &fit.aliased));
    findings.extend(fit_findings(fit, &influence, &vif, &lines, &steps));
    if request.folds > 0 && validation.is_none() && request.variance.is_none() {
        findings.push(finding(
            "no-cross-validation",
            "a part without some rows leaves a coefficient without an estimate: rows cannot be \
             predicted from the others"
                .to_owned(),
        ));
    }
    let left = (fit.residual_ss, fit.residual_df);
    let lack_of_fit =
        lack_of_fit(rows.x(), &fit.columns, (&rows.y, &rows.weights), left).map_err(told)?;
    findings.extend(lack_finding(lack_of_fit.as_ref()));
    let (means, not_estimable) =
        means(request, data, formula, rows, (fit, &covariance), inference)?;
    findings.extend(not_estimable);
    let (asked, ranges) = (
        request.asked()?,
        ranges_of(formula, &data.table, &rows.kept),
    );
    findings.extend(extrapolated(
        &ranges,
        &request.after.held()?,
        asked.as_ref(),
    ));
    let scale = formula
        .response
        .as_ref()
        .and_then(|response| OriginalScale::of(response, &data.table, &rows.kept));
    let residuals = residual_tests(rows, fit);
    findings.extend(residual_findings(&residuals));
    Ok(RegressOutcome {
        formula: formula_of(formula, rows, selection),
        response: formula.response.as_ref().map(spelling).unwrap_or_default(),
        count: row_count(&rows.frame, &data.table, &rows.left_out),
        weights: request.weights.clone(),
        level_variances: None,
        terms,
        robust: request.robust,
        covariance,
        ranges,
        quality: fit.quality(&rows.y),
        model: fit.whole(),
        residual: fit.residual(),
        total: fit.total(),
        anova_type: request.anova.roman(),
        anova: variance_of(request, data, formula, rows, reduced, selection)?,
        lack_of_fit,
        vif,
        removed: steps
            .iter()
            .filter(|s| s.action == "removed")
            .cloned()
            .collect(),
        steps,
        cross_validation: validation,
        fold_by: request.fold_by.clone(),
        residuals,
        influence: RowOutcomes::default(),
        predictions: predictions(asked.as_ref(), scale.as_ref(), rows, fit)?,
        means,
        findings,
    })
}

/// How the model predicts rows that it was not fitted to, where that is asked.
fn validated(
    request: &RegressRequest,
    data: &Data,
    rows: &FormulaRows,
    selection: &Selection,
) -> Result<Option<CrossValidation>, Error> {
    let units = units_of(request, data, rows)?;
    if request.folds == 0 || request.variance.is_some() {
        return Ok(None);
    }
    let parts = Parts {
        folds: request.folds,
        seed: request.seed,
        units: units.as_deref(),
        weights: Some(&rows.weights),
    };
    let (x, terms, options) = (rows.x(), &selection.terms, request.selection());
    let found = cross_validate(&rows.frame, x, &rows.y, terms, options.as_ref(), parts);
    found.map_err(|error| data.told(error))
}

/// Unit of each row for cross-validation, from 0 without gaps.
fn units_of(
    request: &RegressRequest,
    data: &Data,
    rows: &FormulaRows,
) -> Result<Option<Vec<usize>>, Error> {
    let Some(name) = &request.fold_by else {
        return Ok(None);
    };
    let column = data.table.column(name).map_err(|error| data.told(error))?;
    let codes = column.cells.categories().codes;
    let codes: Vec<usize> = rows.kept.iter().filter_map(|row| codes[row]).collect();
    let mut known = codes.clone();
    known.sort_unstable();
    known.dedup();
    if known.len() < 2 {
        let problem = format!("all rows are of one {name}: there is no other to predict");
        return Err(unusable("--fold-by", problem));
    }
    let place = |code: &usize| known.binary_search(code).unwrap_or_default();
    Ok(Some(codes.iter().map(place).collect()))
}

/// Partial tests of categories mean something only with contrasts that sum to zero.
fn variance_of(
    request: &RegressRequest,
    data: &Data,
    formula: &Formula,
    rows: &FormulaRows,
    reduced: &Reduced,
    selection: &Selection,
) -> Result<Vec<AnovaRow>, Error> {
    let (terms, kind) = (&selection.terms, request.anova);
    if kind == AnovaType::Partial && rows.frame.has_categories() {
        let summed = summed_rows(request, data, formula, rows)?;
        let reduced = summed.reduced().map_err(|error| data.told(error))?;
        return Ok(anova(&summed.frame, &reduced, terms, kind).rows);
    }
    Ok(anova(&rows.frame, reduced, terms, kind).rows)
}

/// Rows of a model with categories by sum contrasts.
fn summed_rows<'a>(
    request: &RegressRequest,
    data: &'a Data,
    formula: &Formula,
    rows: &FormulaRows,
) -> Result<FormulaRows<'a>, Error> {
    let summed = formula_rows(formula, &data.table, Contrast::Sum, &request.also());
    let mut summed = summed.map_err(|error| data.told(error))?;
    summed.weights = rows.weights.clone();
    Ok(summed)
}

/// Covariance of the estimates, in rows.
fn covariance_of(
    request: &RegressRequest,
    rows: &FormulaRows,
    fit: &LinearFit,
) -> Result<Vec<Vec<f64>>, StatisticsError> {
    match request.robust {
        true => robust_covariance(fit, &rows.x()),
        false => Ok(fit.covariance_rows()),
    }
}

fn steps_of(rows: &FormulaRows, selection: &Selection) -> Vec<StepOutcome> {
    let steps = selection.steps.iter().map(|step| StepOutcome {
        term: rows.frame.terms[step.term].name.clone(),
        action: if step.entered { "entered" } else { "removed" },
        f: step.f,
        p: step.p,
        criterion: step.criterion,
        r2: step.r2,
    });
    steps.collect()
}

fn formula_of(formula: &Formula, rows: &FormulaRows, selection: &Selection) -> String {
    let response = formula.response.as_ref().map(spelling).unwrap_or_default();
    let intercept = if formula.intercept { "1" } else { "0" };
    let terms = selection
        .terms
        .iter()
        .map(|t| rows.frame.terms[*t].name.clone());
    let terms: Vec<String> = std::iter::once(intercept.to_owned()).chain(terms).collect();
    format!("{response} ~ {}", terms.join(" + "))
}
