//! Optimal designs from texts: model, levels, candidates and existing runs.

use crate::design::factor::{CODED, DesignFactor, factors_of};
use crate::design::file::read_coding;
use crate::design::model_row::{RowModel, row_at, row_model};
use crate::design::request::{Criterion, OptimalRequest, SplitPlotRequest};
use std::path::Path;
use windfall_design::error::DesignError;
use windfall_design::kind::{Design, Factor, evenly};
use windfall_design::model::DesignModel;
use windfall_design::optimal::{Candidates, OptimalOptions, optimal};
use windfall_design::split_plot::{SplitPlotOptions, split_plot};
use windfall_files::error::{Error, Place};
use windfall_files::option_value::unusable;
use windfall_files::table::data::{Data, read_data};
use windfall_statistics::table::Cells;

/// Steps of a half-range that coded values of settings are rounded to.
const CODED_STEPS: f64 = 1e13;

/// Levels that are tried for a formula, fewest first.
const LEVELS_OF_FORMULAS: std::ops::RangeInclusive<usize> = 2..=5;

/// An optimal design with its model.
///
/// # Errors
/// Texts or tables that cannot be used, a design that cannot be.
pub fn optimal_design(
    (request, criterion): (&OptimalRequest, Criterion),
    factors: &[String],
    seed: u64,
) -> Result<(Design, RowModel), Error> {
    let given = factors_of(factors)?;
    let tables: [Option<(&Path, Data)>; 2] = [
        table_of(request.augment.as_deref())?,
        table_of(request.candidates.as_deref())?,
    ];
    let given = match given.is_empty() {
        true => factors_of_header(tables.iter().flatten())?,
        false => given,
    };
    let factors: Vec<Factor> = given.iter().map(|given| given.factor.clone()).collect();
    let [existing, listed] = tables.map(|table| match table {
        None => Ok(None),
        Some((path, data)) => points_of(path, &data, &factors).map(Some),
    });
    let (existing, listed) = (existing?.unwrap_or_default(), listed?);
    let model = row_model(&request.search.model, &factors)?;
    let row = |coded: &[f64]| row_at(&model, &factors, coded);
    let options = OptimalOptions {
        runs: request.runs,
        criterion,
        starts: request.search.starts,
        seed,
    };
    let make =
        |candidates: Candidates| optimal(factors.clone(), &row, candidates, &existing, &options);
    let design = match &listed {
        Some(points) => make(Candidates::Points(points)).map_err(impossible)?,
        None => with_levels(&model, &given, request.search.points, |levels| {
            make(Candidates::Levels(levels))
        })?,
    };
    Ok((design, model))
}

/// A split-plot design with its model.
///
/// # Errors
/// Texts that cannot be used, a design that cannot be.
pub fn split_plot_design(
    request: &SplitPlotRequest,
    factors: &[String],
    seed: u64,
) -> Result<(Design, RowModel), Error> {
    let given = factors_of(factors)?;
    let factors: Vec<Factor> = given.iter().map(|given| given.factor.clone()).collect();
    let named = |hard: &String| {
        let place = factors.iter().position(|own| own.name == hard.trim());
        place.ok_or_else(|| {
            let names: Vec<&str> = factors.iter().map(|own| own.name.as_str()).collect();
            let problem = format!("this is none of the factors {}", names.join(", "));
            unusable(format!("--hard '{hard}'"), problem)
        })
    };
    let hard: Result<Vec<usize>, Error> = request.hard.iter().map(named).collect();
    let model = row_model(&request.search.model, &factors)?;
    let row = |coded: &[f64]| row_at(&model, &factors, coded);
    let options = SplitPlotOptions {
        hard: hard?,
        whole_plots: request.whole_plots,
        runs: request.runs,
        ratio: request.ratio,
        criterion: request.criterion,
        starts: request.search.starts,
        seed,
    };
    let design = with_levels(&model, &given, request.search.points, |levels| {
        split_plot(factors.clone(), &row, levels, &options)
    })?;
    Ok((design, model))
}

/// A design on as few levels of each range as tell the terms of its model apart.
fn with_levels(
    model: &RowModel,
    given: &[DesignFactor],
    points: Option<usize>,
    make: impl Fn(&[Vec<f64>]) -> Result<Design, DesignError>,
) -> Result<Design, Error> {
    let mut counts = level_counts(model, points)?;
    loop {
        let count = counts.remove(0);
        // More levels may tell more terms apart.
        match make(&levels_of(given, count)) {
            Err(DesignError::ModelSingular { .. }) if !counts.is_empty() => {}
            made => break made.map_err(impossible),
        }
    }
}

/// The error of a design that cannot be.
pub fn impossible(error: DesignError) -> Error {
    unusable("windfall design", error.to_string())
}

fn table_of(path: Option<&Path>) -> Result<Option<(&Path, Data)>, Error> {
    path.map(|path| Ok((path, read_data(path)?))).transpose()
}

/// Numbers of levels to try.
fn level_counts(model: &RowModel, points: Option<usize>) -> Result<Vec<usize>, Error> {
    match (points, model) {
        (Some(points), _) if points < 2 => Err(unusable("--points", "expected at least 2 levels")),
        (Some(points), _) => Ok(vec![points]),
        (None, RowModel::Named(DesignModel::Quadratic)) => Ok(vec![3]),
        (None, RowModel::Named(_)) => Ok(vec![2]),
        (None, RowModel::Formula(_)) => Ok(LEVELS_OF_FORMULAS.collect()),
    }
}

fn levels_of(given: &[DesignFactor], count: usize) -> Vec<Vec<f64>> {
    let levels = |given: &DesignFactor| given.levels.clone().unwrap_or_else(|| evenly(count));
    given.iter().map(levels).collect()
}

/// Factors from the header of the first table that is a design.
fn factors_of_header<'a>(
    tables: impl Iterator<Item = &'a (&'a Path, Data)>,
) -> Result<Vec<DesignFactor>, Error> {
    for (_, data) in tables {
        if let Some(factors) = read_coding(&data.comments)? {
            let given = factors.into_iter().map(|factor| DesignFactor {
                levels: (!factor.categories.is_empty()).then(|| factor.ends()),
                factor,
            });
            return Ok(given.collect());
        }
    }
    let problem = "no factor is given, and no table with the header of a design; add --factor \
                   'k=0.3..1 N/mm'";
    Err(unusable("--factor", problem))
}

/// Coded points of a table: exact columns if its header has the same coding, else settings.
fn points_of(path: &Path, data: &Data, factors: &[Factor]) -> Result<Vec<Vec<f64>>, Error> {
    let header = read_coding(&data.comments)?.unwrap_or_default();
    let mut columns = Vec::new();
    for factor in factors {
        let coded_name = format!("{}{CODED}", factor.name);
        let same = header.iter().any(|other| {
            (&other.name, other.centre, other.half) == (&factor.name, factor.centre, factor.half)
        });
        let exact = same
            && data
                .table
                .columns
                .iter()
                .any(|column| column.name == coded_name);
        let name = if exact { &coded_name } else { &factor.name };
        let column = data
            .table
            .column(name)
            .map_err(|error| unusable(path.display().to_string(), error.to_string()))?;
        columns.push(match &column.cells {
            Cells::Numbers(values) if factor.categories.is_empty() => match exact {
                true => values.values().into_owned(),
                false => values.iter().map(|value| recoded(factor, value)).collect(),
            },
            cells => categories_of(path, data, factor, cells)?,
        });
    }
    let rows = data.table.rows();
    let points: Vec<Vec<f64>> = (0..rows)
        .map(|row| columns.iter().map(|column| column[row]).collect())
        .collect();
    match points
        .iter()
        .position(|point| point.iter().any(|value| value.is_nan()))
    {
        Some(row) => Err(blank(path, data, row)),
        None => Ok(points),
    }
}

/// A coded value without rounding, so that the ends of a range are −1 and 1.
fn recoded(factor: &Factor, setting: f64) -> f64 {
    (factor.coded(setting) * CODED_STEPS).round() / CODED_STEPS
}

/// Coded values of a column of categories.
fn categories_of(
    path: &Path,
    data: &Data,
    factor: &Factor,
    cells: &Cells,
) -> Result<Vec<f64>, Error> {
    let ends = factor.ends();
    let place = |row: usize, text: &str| {
        let found = factor
            .categories
            .iter()
            .position(|category| category == text);
        found
            .map(|place| ends[place])
            .ok_or_else(|| Error::ValueInvalid {
                place: Place {
                    file: path.to_path_buf(),
                    line: data.line(row),
                },
                key: factor.name.clone(),
                text: text.to_owned(),
                problem: match factor.categories.is_empty() {
                    true => "expected a number".to_owned(),
                    false => format!("expected {}", factor.categories.join(" or ")),
                },
            })
    };
    (0..cells.len())
        .map(|row| match cells {
            Cells::Numbers(values) => place(row, &values.at(row).to_string()),
            Cells::Categories(categories) => match categories.codes[row] {
                Some(code) => place(row, &categories.levels[code]),
                None => Err(blank(path, data, row)),
            },
        })
        .collect()
}

fn blank(path: &Path, data: &Data, row: usize) -> Error {
    Error::CellBlank {
        place: Place {
            file: path.to_path_buf(),
            line: data.line(row),
        },
        column: "of a factor".to_owned(),
    }
}
