//! `windfall surface`: a table of runs → response surfaces and the best settings.

use crate::design::coding::number_factors;
use crate::regress::findings::left_out_finding;
use crate::regress::run::check_part;
use crate::surface::blocks::{block_column, blocks_finding, blocks_of};
use crate::surface::factors::{coded_factors, coding_findings, coding_text};
use crate::surface::figure_contour::contour_paintings;
use crate::surface::figure_effects::effects_painting;
use crate::surface::figure_lines::{
    figure_of_desirability, figure_of_perturbation, paintings_of_models,
};
use crate::surface::figure_view::view_paintings;
use crate::surface::fitted::{FittedSurfaces, ResponseSurface};
use crate::surface::goal::goal;
use crate::surface::model_outcome::{Modelled, model_of};
use crate::surface::outcome::{FactorOutcome, SurfaceOutcome};
use crate::surface::random::{
    group_columns, plots_finding, random_finding, random_paintings, random_parts, terms_of_parts,
};
use crate::surface::request::SurfaceRequest;
use crate::surface::settings::{SettingsRequest, grid_of, settings};
use windfall_draw::files::{FigureFolder, NamedFigure, write_figures, write_paintings};
use windfall_files::error::Error;
use windfall_files::found::FindingOutcome;
use windfall_files::option_value::unusable;
use windfall_files::table::data::Data;
use windfall_files::write_file::check_outputs;
use windfall_statistics::model::expression::values;
use windfall_statistics::model::formula_syntax::parse;
use windfall_statistics::model::model_rows::rows_with_all;
use windfall_statistics::surface::analysis::fit_surface_in_blocks;
use windfall_statistics::surface::coding::CodedFactors;
use windfall_statistics::surface::desirability::Goal;
use windfall_statistics::surface::terms::{letter, surface_terms};

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
    let random = random_parts(request, &factors, &data)?;
    let grouped = group_columns(random.as_ref());
    let plots = plots_finding(request, &factors, &grouped, &data);
    let block = block_column(request, &factors, &data)?.filter(|own| !grouped.contains(own));
    let used = factors.iter().chain(&block).chain(&grouped);
    let mut findings = keep_complete(request, used.cloned().collect(), &mut data)?;
    let blocks = block
        .as_ref()
        .map(|name| blocks_of(name, &data))
        .transpose()?;
    findings.extend(block.as_ref().zip(blocks.as_ref()).map(blocks_finding));
    let random = random
        .map(|parts| terms_of_parts(&parts, &data))
        .transpose()?;
    findings.extend(random.as_deref().map(random_finding));
    findings.extend(plots);
    let coded = coded_factors(&data, &factors, &request.ranges)?;
    findings.extend(data.left_out_finding());
    findings.extend(coding_findings(&coded));
    let mut surfaces = Vec::new();
    let mut models = Vec::new();
    let mut observed: Vec<Vec<f64>> = Vec::new();
    for (response, model) in modelled {
        let y = response_values(response, &data)?;
        let terms = surface_terms(model, &factors).map_err(Error::Statistics)?;
        let told = |error| data.told(error);
        let runs = (&coded.values[..], blocks.as_ref());
        let mut fitted =
            fit_surface_in_blocks(&coded.factors, &terms, runs, &y, request.confidence)
                .map_err(told)?;
        if let Some(groups) = &random {
            fitted = fitted.in_random_groups(&y, groups.clone()).map_err(told)?;
        }
        let (outcome, found) = model_of(&Modelled {
            response,
            surface: &fitted,
            coded: &coded,
            y: &y,
            data: &data,
            anova: request.anova,
            confidence: request.confidence,
        })?;
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
        lines: data.lines.iter().collect(),
    };
    Ok((outcome, fitted))
}

fn draw(
    folder: &FigureFolder,
    confidence: f64,
    outcome: &SurfaceOutcome,
    fitted: &FittedSurfaces,
) -> Result<(), Error> {
    let mut paintings = contour_paintings(fitted, outcome, folder.width)?;
    paintings.extend(view_paintings(fitted, outcome, folder.width)?);
    for (model, response) in outcome.responses.iter().zip(&fitted.responses) {
        paintings.extend(effects_painting(model, confidence, folder.width)?);
        paintings.extend(random_paintings(
            response,
            model,
            &fitted.lines,
            confidence,
        )?);
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
///
/// * `names`: columns that are used beside the responses
fn keep_complete(
    request: &SurfaceRequest,
    mut names: Vec<String>,
    data: &mut Data,
) -> Result<Vec<FindingOutcome>, Error> {
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
