//! The model of an optimal design: by its name or as a formula.

use windfall_design::kind::{Factor, evenly};
use windfall_design::model::{DesignModel, model_row, model_terms};
use windfall_design::word::letter;
use windfall_files::error::Error;
use windfall_files::option_value::unusable;
use windfall_statistics::error::Error as StatisticsError;
use windfall_statistics::model::contrast::Contrast;
use windfall_statistics::model::formula::formula;
use windfall_statistics::model::model_frame::{ModelFrame, prediction_rows};
use windfall_statistics::model::model_rows::model_rows;
use windfall_statistics::table::{Categories, Cells, Column, Table};

/// Levels of each factor in the table that a formula is set up with.
const SETUP_LEVELS: usize = 5;

/// A model that gives its row at coded values.
#[derive(Clone, Debug, PartialEq)]
pub enum RowModel {
    /// One of those with a name.
    Named(DesignModel),
    /// A formula.
    Formula(Box<ModelFrame>),
}

/// The model of a text: linear, 2fi, quadratic, or a formula such as
/// `k + e + k:e + I(e^2)` or `A*B + C`, in coded factors by name or by letter.
///
/// # Errors
/// A formula that cannot be read or names something else.
pub fn row_model(text: &str, factors: &[Factor]) -> Result<RowModel, Error> {
    match text.trim() {
        "linear" => return Ok(RowModel::Named(DesignModel::Linear)),
        "2fi" => return Ok(RowModel::Named(DesignModel::Interactions)),
        "quadratic" => return Ok(RowModel::Named(DesignModel::Quadratic)),
        _ => {}
    }
    let option = || format!("--model '{text}'");
    let wrong = |error: StatisticsError| match error {
        StatisticsError::NotFinite { .. } => unusable(
            option(),
            format!(
                "{error}; factors of a design's model are coded, −1 to 1: for the logarithm of a \
                 factor give its range as that of the logarithm"
            ),
        ),
        error => unusable(option(), error.to_string()),
    };
    let names: Vec<String> = factors.iter().map(|factor| factor.name.clone()).collect();
    let parsed = formula(text, &names).map_err(wrong)?;
    if parsed.response.is_some() || !parsed.random.is_empty() {
        let problem = "a design has no response and no random parts yet: give the right side of \
                       the formula, or linear, 2fi or quadratic";
        return Err(unusable(option(), problem));
    }
    // Levels side by side, each factor shifted against the one before.
    let rows = factors
        .iter()
        .map(|f| f.categories.len())
        .max()
        .unwrap_or(0)
        .max(SETUP_LEVELS);
    let points: Vec<Vec<f64>> = (0..rows * factors.len().max(1))
        .map(|row| {
            let level = |(place, factor): (usize, &Factor)| {
                let levels = match factor.categories.is_empty() {
                    true => evenly(SETUP_LEVELS),
                    false => factor.ends(),
                };
                levels[(row + row / rows * place) % levels.len()]
            };
            factors.iter().enumerate().map(level).collect()
        })
        .collect();
    let table = coded_table(factors, &points);
    let setup = model_rows(&parsed, &table, Contrast::Sum, &[]).map_err(wrong)?;
    Ok(RowModel::Formula(Box::new(setup.frame)))
}

/// The row of a model at coded values; not a number where it has no value.
pub fn row_at(model: &RowModel, factors: &[Factor], coded: &[f64]) -> Vec<f64> {
    match model {
        RowModel::Named(named) => model_row(factors, *named, coded),
        RowModel::Formula(frame) => {
            let table = coded_table(factors, &[coded.to_vec()]);
            match prediction_rows(frame, &table) {
                Ok(matrix) => matrix.row(0).iter().copied().collect(),
                Err(_) => vec![f64::NAN; frame.names.len()],
            }
        }
    }
}

/// Names of the columns of a model.
pub fn terms_of(model: &RowModel, factors: &[Factor]) -> Vec<String> {
    match model {
        RowModel::Named(named) => model_terms(factors, *named),
        RowModel::Formula(frame) => frame.names.clone(),
    }
}

/// A table of coded values under names and letters of the factors; names win.
fn coded_table(factors: &[Factor], points: &[Vec<f64>]) -> Table {
    let column = |name: String, place: usize| {
        let factor = &factors[place];
        let values = points.iter().map(|point| point[place]);
        let cells = match factor.categories.is_empty() {
            true => Cells::Numbers(values.collect()),
            false => Cells::Categories(Categories {
                levels: factor.categories.clone(),
                codes: values.map(|value| factor.category_place(value)).collect(),
                ordered: true,
            }),
        };
        Column { name, cells }
    };
    let named = |name: &str| factors.iter().any(|factor| factor.name == name);
    let mut columns: Vec<Column> = (0..factors.len())
        .map(|place| column(factors[place].name.clone(), place))
        .collect();
    let letters = (0..factors.len()).map(|place| (letter(place).to_string(), place));
    let letters = letters.filter(|(letter, _)| letter != "?" && !named(letter));
    columns.extend(letters.map(|(letter, place)| column(letter, place)));
    Table { columns }
}
