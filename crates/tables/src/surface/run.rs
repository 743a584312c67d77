//! `windfall surface`: a table of runs → response surfaces and the best settings.

use crate::design::coding::number_factors;
use crate::regress::findings::{
    aliased_findings, finding, fit_findings, lack_finding, left_out_finding,
};
use crate::regress::outcome::RowOutcomes;
use crate::regress::run::check_part;
use crate::surface::blocks::{block_column, block_outcome, blocks_finding, blocks_of};
use crate::surface::factors::{coded_factors, coding_findings, coding_text};
use crate::surface::figure_contour::contour_paintings;
use crate::surface::figure_effects::effects_painting;
use crate::surface::figure_lines::{
    figure_of_desirability, figure_of_perturbation, paintings_of_models,
};
use crate::surface::figure_view::view_paintings;
use crate::surface::fitted::{FittedSurfaces, ResponseSurface};
use crate::surface::goal::goal;
use crate::surface::outcome::{
    ActualTerm, CanonicalOutcome, FactorOutcome, RidgeOutcome, SurfaceModel, SurfaceOutcome,
    SurfaceTerm,
};
use crate::surface::request::SurfaceRequest;
use crate::surface::settings::{SettingsRequest, grid_of, settings};
use windfall_draw::files::{FigureFolder, NamedFigure, write_figures, write_paintings};
use windfall_files::error::Error;
use windfall_files::found::FindingOutcome;
use windfall_files::option_value::unusable;
use windfall_files::table::data::Data;
use windfall_files::write_file::check_outputs;
use windfall_statistics::model::anova::{Anova, anova_within};
use windfall_statistics::model::expression::values;
use windfall_statistics::model::formula_syntax::parse;
use windfall_statistics::model::model_rows::rows_with_all;
use windfall_statistics::residuals::diagnostics::{Influence, inflation, influence};
use windfall_statistics::surface::analysis::{
    Shape, Surface, canonical, fit_surface_in_blocks, ridge, surface_lack_of_fit,
};
use windfall_statistics::surface::coding::CodedFactors;
use windfall_statistics::surface::desirability::Goal;
use windfall_statistics::surface::terms::{
    contains, is_hierarchical, letter, monomial_name, surface_terms,
};

/// Fits response surfaces, and draws them where figures are asked for.
///
/// # Errors
/// The table, a model or an option cannot be used, or a figure cannot be written.
pub fn surface(request: &SurfaceRequest) -> Result<SurfaceOutcome, Error> {
    let figures = request.figures.as_ref().map(|own| own.directory.as_path());
    check_outputs([figures])?;
    let (outcome, fitted) = fitted_surfaces(request)?;
    if let Some(folder) = &request.figures {
        draw(folder, request.confidence, &outcome, &fitted)?;
    }
    Ok(outcome)
}

/// [`surface`] without figures, with the surfaces themselves.
///
/// # Errors
/// The table, a model or an option cannot be used.
pub fn fitted_surfaces(
    request: &SurfaceRequest,
) -> Result<(SurfaceOutcome, FittedSurfaces), Error> {
    let modelled = request.modelled()?;
    check_part("--confidence", request.confidence)?;
    let mut data = request.reading.read(&request.table)?;
    let factors = factor_names(request, &data)?;
    let block = block_column(request, &factors, &data)?;
    let mut findings = keep_complete(request, (&factors, block.as_ref()), &mut data)?;
    let blocks = block
        .as_ref()
        .map(|name| blocks_of(name, &data))
        .transpose()?;
    findings.extend(block.as_ref().zip(blocks.as_ref()).map(blocks_finding));
    let coded = coded_factors(&data, &factors, &request.ranges)?;
    findings.extend(data.left_out_finding());
    findings.extend(coding_findings(&coded));
    let mut surfaces = Vec::new();
    let mut models = Vec::new();
    let mut observed: Vec<Vec<f64>> = Vec::new();
    for (response, model) in modelled {
        let y = response_values(response, &data)?;
        let terms = surface_terms(model, &factors).map_err(Error::Statistics)?;
        let fitted = fit_surface_in_blocks(
            &coded.factors,
            &terms,
            (&coded.values, blocks.as_ref()),
            &y,
            request.confidence,
        )
        .map_err(|error| data.told(error))?;
        let (outcome, found) = model_of(request, response, &fitted, &coded, &y, &data);
        findings.extend(found);
        models.push(outcome);
        surfaces.push(fitted);
        observed.push(y);
    }
    let goals = goals_of(request, &observed)?;
    let asked = SettingsRequest {
        names: &request.responses,
        goals,
        hold: &request.hold,
        along: request.along.as_deref(),
        members: request.members,
    };
    let (optimum, family, found) = settings(&asked, &surfaces, &coded)?;
    findings.extend(found);
    let points = request.grid_points;
    let grid = request.grid.as_ref();
    let grid = grid.map(|pair| grid_of(&asked, pair, points, &surfaces, &coded));
    let grid = grid.transpose()?;
    let outcome = SurfaceOutcome {
        factors: factor_outcomes(&factors, &coded, &data)?,
        coding: coding_text(&coded),
        first: models[0].clone(),
        responses: models,
        optimum,
        family,
        findings,
        grid,
    };
    let best = outcome.optimum.as_ref().filter(|o| o.desirability > 0.0);
    let at_optimum = best.is_some();
    let reference = match best {
        Some(best) => best.coded.clone(),
        None => asked.centre(&coded)?,
    };
    let named = request.responses.iter().zip(surfaces).zip(&asked.goals);
    let responses = named.map(|((name, surface), goal)| ResponseSurface {
        name: name.clone(),
        surface,
        goal: *goal,
    });
    let fitted = FittedSurfaces {
        responses: responses.collect(),
        coded,
        reference,
        at_optimum,
    };
    Ok((outcome, fitted))
}

fn draw(
    folder: &FigureFolder,
    confidence: f64,
    outcome: &SurfaceOutcome,
    fitted: &FittedSurfaces,
) -> Result<(), Error> {
    let mut paintings = contour_paintings(fitted, outcome)?;
    paintings.extend(view_paintings(fitted, outcome)?);
    for model in &outcome.responses {
        paintings.extend(effects_painting(model, confidence)?);
    }
    paintings.extend(paintings_of_models(outcome, confidence)?);
    write_paintings(folder, &paintings)?;
    let mut figures = vec![figure_of_perturbation(fitted)];
    figures.extend(figure_of_desirability(fitted));
    let figures: Vec<&NamedFigure> = figures.iter().collect();
    write_figures(folder, &figures).map(|_| ())
}

fn factor_names(request: &SurfaceRequest, data: &Data) -> Result<Vec<String>, Error> {
    if request.responses.is_empty() {
        return Err(unusable("--response", "give at least one response"));
    }
    let mut factors = request.factors.clone();
    if factors.is_empty() {
        factors = number_factors(data);
    }
    if factors.is_empty() {
        let problem =
            "give the factors, in the order of the letters A, B, C …: --factor k --factor e";
        return Err(unusable("--factor", problem));
    }
    let repeated = (1..factors.len()).find(|place| factors[..*place].contains(&factors[*place]));
    if let Some(place) = repeated {
        return Err(unusable(
            format!("--factor {}", factors[place]),
            "this factor is given twice",
        ));
    }
    Ok(factors)
}

/// Leaves out runs with missing cells, and says so.
fn keep_complete(
    request: &SurfaceRequest,
    (factors, block): (&[String], Option<&String>),
    data: &mut Data,
) -> Result<Vec<FindingOutcome>, Error> {
    let mut names = factors.to_vec();
    names.extend(block.cloned());
    for response in &request.responses {
        if has_column(data, response) {
            names.push(response.clone());
        }
    }
    let (kept, left_out) = rows_with_all(&data.table, &names).map_err(|error| data.told(error))?;
    let findings = left_out_finding(&left_out, &data.lines);
    data.keep(&kept);
    match kept.is_empty() {
        true => Err(Error::TableWithoutRows {
            path: request.table.clone(),
            row_is: "run with all its cells",
        }),
        false => Ok(findings),
    }
}

fn has_column(data: &Data, name: &str) -> bool {
    data.table.columns.iter().any(|column| column.name == name)
}

fn response_values(response: &str, data: &Data) -> Result<Vec<f64>, Error> {
    if has_column(data, response) {
        let numbers = data
            .table
            .numbers(response)
            .map_err(|error| data.told(error))?;
        return Ok(numbers.values().into_owned());
    }
    let node = parse(response).map_err(Error::Statistics)?;
    values(&node, &data.table).map_err(|error| data.told(error))
}

fn goals_of(request: &SurfaceRequest, observed: &[Vec<f64>]) -> Result<Vec<Option<Goal>>, Error> {
    let mut goals: Vec<Option<Goal>> = vec![None; observed.len()];
    let place_of = |name: &str| request.responses.iter().position(|own| own == name);
    let range = |name: &str| {
        let values = &observed[place_of(name)?];
        let low = values.iter().copied().fold(f64::INFINITY, f64::min);
        let high = values.iter().copied().fold(f64::NEG_INFINITY, f64::max);
        Some((low, high))
    };
    for text in &request.goals {
        let (name, goal) = goal(text, &range)?;
        if let Some(place) = place_of(&name) {
            goals[place] = Some(goal);
        }
    }
    Ok(goals)
}

fn factor_outcomes(
    names: &[String],
    coded: &CodedFactors,
    data: &Data,
) -> Result<Vec<FactorOutcome>, Error> {
    let factors = names.iter().zip(&coded.factors).enumerate();
    factors
        .map(|(place, (name, coding))| {
            let values = data.table.numbers(name).map_err(|error| data.told(error))?;
            Ok(FactorOutcome {
                letter: letter(place),
                name: name.clone(),
                centre: coding.centre,
                half_range: coding.half,
                lowest: values.iter().fold(f64::INFINITY, f64::min),
                highest: values.iter().fold(f64::NEG_INFINITY, f64::max),
            })
        })
        .collect()
}

fn model_of(
    request: &SurfaceRequest,
    response: &str,
    surface: &Surface,
    coded: &CodedFactors,
    y: &[f64],
    data: &Data,
) -> (SurfaceModel, Vec<FindingOutcome>) {
    let fit = &surface.fit;
    let every: Vec<usize> = (0..surface.terms.monomials.len()).collect();
    let whole = (&surface.frame, &surface.reduced);
    let monomials = &surface.terms.monomials;
    let variance = anova_within(
        whole,
        &surface.block_columns(),
        &every,
        request.anova,
        &|outer, inner| contains(&monomials[outer], &monomials[inner]),
    );
    let influence = influence(fit, y);
    let vif = inflation(&surface.frame, fit);
    let mean = y.iter().sum::<f64>() / y.len() as f64;
    let quality = fit.quality(y);
    let names: Vec<String> = surface.factors.iter().map(|f| f.name.clone()).collect();
    let mut findings = aliased_findings(&surface.frame, &fit.aliased);
    findings.extend(fit_findings(fit, &influence, &vif, &data.lines, &[]));
    let lack_of_fit = surface_lack_of_fit(surface, &coded.values, y);
    findings.extend(lack_finding(lack_of_fit.as_ref()));
    if !is_hierarchical(&surface.terms.monomials) {
        findings.push(finding(
            "not-hierarchical",
            "the model has a term without the terms that it is made of: what it says depends on \
             the coding, and the equation in actual units has terms beside the model's"
                .to_owned(),
        ));
    }
    findings.iter_mut().for_each(|finding| {
        finding.message = format!("{response}: {}", finding.message);
    });
    let outcome = SurfaceModel {
        response: response.to_owned(),
        terms: terms_of(surface, &variance, &vif),
        actual_terms: surface
            .actual
            .iter()
            .map(|(powers, coefficient)| ActualTerm {
                name: monomial_name(powers, &names, false),
                coefficient: *coefficient,
            })
            .collect(),
        blocks: block_outcome(surface),
        model: fit.whole(),
        residual: fit.residual(),
        total: fit.total(),
        cv_percent: 100.0 * quality.sigma / mean,
        quality,
        anova_type: request.anova.roman(),
        lack_of_fit,
        canonical: canonical_of(surface, coded),
        ridge: ridge_of(surface, coded),
        influence: RowOutcomes::new(Influence::of(fit.clone(), y.to_vec()), data.lines.clone()),
    };
    (outcome, findings)
}

fn terms_of(
    surface: &Surface,
    variance: &Anova,
    vif: &[windfall_statistics::residuals::diagnostics::Inflation],
) -> Vec<SurfaceTerm> {
    let names: Vec<String> = surface.factors.iter().map(|f| f.name.clone()).collect();
    let none = vec![0; names.len()];
    let monomials = std::iter::once(&none).chain(&surface.terms.monomials);
    monomials
        .enumerate()
        .map(|(column, monomial)| {
            let place = surface.fit.columns.iter().position(|own| *own == column);
            let own = place.map(|place| &surface.fit.coefficients[place]);
            let row = column.checked_sub(1).map(|term| &variance.rows[term]);
            let term = &surface.frame.names[column];
            let actual = surface.actual.iter().find(|(powers, _)| powers == monomial);
            SurfaceTerm {
                term: term.clone(),
                name: monomial_name(monomial, &names, false),
                coded: own.map_or(f64::NAN, |c| c.estimate),
                se: own.map_or(f64::NAN, |c| c.se),
                low: own.map_or(f64::NAN, |c| c.low),
                high: own.map_or(f64::NAN, |c| c.high),
                actual: actual.map_or(f64::NAN, |(_, value)| *value),
                ss: row.map(|row| row.ss),
                df: row.map(|row| row.df),
                f: row.map(|row| row.f),
                p: row.map(|row| row.p),
                vif: vif.iter().find(|v| v.term == *term).map(|v| v.factor),
            }
        })
        .collect()
}

fn canonical_of(surface: &Surface, coded: &CodedFactors) -> Option<CanonicalOutcome> {
    let found = canonical(surface)?;
    let inside = (0..coded.factors.len()).all(|factor| {
        let (low, high) = coded.range(factor);
        (low..=high).contains(&found.stationary[factor])
    });
    Some(CanonicalOutcome {
        shape: match found.shape {
            Shape::Maximum => "maximum",
            Shape::Minimum => "minimum",
            Shape::Saddle => "saddle",
            Shape::Ridge => "ridge",
        },
        actual: coded.actual(&found.stationary),
        coded: found.stationary,
        distance: found.distance,
        inside,
        value: found.value,
        eigenvalues: found.eigenvalues,
        directions: found.directions,
    })
}

/// Steps from the centre to the farthest run.
const RIDGE_STEPS: usize = 5;

fn ridge_of(surface: &Surface, coded: &CodedFactors) -> Vec<RidgeOutcome> {
    let runs = 0..coded.values[0].len();
    let distance = |run: usize| {
        let parts = coded.values.iter().map(|factor| factor[run].powi(2));
        parts.sum::<f64>().sqrt()
    };
    let farthest = runs.map(distance).fold(0.0, f64::max);
    let radii: Vec<f64> = (0..=RIDGE_STEPS)
        .map(|step| farthest * step as f64 / RIDGE_STEPS as f64)
        .collect();
    [("maximum", true), ("minimum", false)]
        .into_iter()
        .flat_map(|(of, maximum)| {
            let points = ridge(surface, &radii, maximum).into_iter();
            points.map(move |point| (of, point))
        })
        .map(|(of, point)| RidgeOutcome {
            of,
            radius: point.radius,
            actual: coded.actual(&point.point),
            value: point.value,
        })
        .collect()
}
