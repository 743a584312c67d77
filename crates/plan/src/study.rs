//! A table of impacts and its mixed model, as a study that can be made larger or smaller.

use crate::question::Size;
use nalgebra::{DMatrix, DVector};
use std::path::Path;
use windfall_files::error::Error;
use windfall_files::option_value::unusable;
use windfall_files::table::data::Data;
use windfall_mixed::fit::{MixedFit, MixedOptions, fit_mixed};
use windfall_mixed::term::RandomTerm;
use windfall_statistics::error::Error as StatisticsError;
use windfall_statistics::model::contrast::Contrast;
use windfall_statistics::model::formula::{Formula, formula};
use windfall_statistics::model::model_frame::ModelFrame;
use windfall_statistics::model::model_rows::{complete_rows, model_rows};
use windfall_statistics::model::random_terms::random_terms;
use windfall_statistics::model::reduced::reduce;
use windfall_tables::reading::ReadingOptions;

/// Share of a column's size below which it is the same in all rows.
const SAME: f64 = 1e-12;

/// Columns of the fixed effects in one coding.
#[derive(Clone, Debug)]
pub(crate) struct Coded {
    /// Model matrix without columns that follow from others.
    pub x: DMatrix<f64>,
    /// Names of its columns.
    pub names: Vec<String>,
    /// Terms with the places of their columns.
    pub terms: Vec<(String, Vec<usize>)>,
}

/// A study: rows that belong to fruit, and the model that was fitted to them.
#[derive(Clone, Debug)]
pub(crate) struct Study {
    /// Columns in which coefficients are told: categories against their first level.
    pub told: Coded,
    /// Columns in which terms are tested: categories against their mean.
    pub tested: Coded,
    /// Random terms, all of the same fruit.
    pub random: Vec<RandomTerm>,
    /// Column that names the fruit.
    pub by: String,
    /// Rows of each fruit; fruit of equal settings stand beside each other.
    pub fruit: Vec<Vec<usize>>,
    /// The fit.
    pub fit: MixedFit,
}

/// Rows of a study of another size: rows of the table, and the fruit that each is of.
pub(crate) struct Resized {
    pub rows: Vec<usize>,
    pub fruit: Vec<usize>,
}

/// Reads a table and fits its mixed model.
///
/// # Errors
/// The table or the formula cannot be used; the model has no random part, or several groups.
pub(crate) fn read_study(
    table: &Path,
    text: &str,
    reading: &ReadingOptions,
) -> Result<(Study, Data), Error> {
    let mut data = reading.read(table)?;
    let columns: Vec<String> = data.table.columns.iter().map(|c| c.name.clone()).collect();
    let formula = formula(text, &columns).map_err(Error::Statistics)?;
    if formula.response.is_none() {
        let problem = "say what is modelled: 'k ~ V + (1 | fruit)'";
        return Err(unusable("--formula", problem));
    }
    let Some(first) = formula.random.first() else {
        let problem = "the model does not say which rows are of one fruit: add (1 | COLUMN) with \
                       the column that names the fruit";
        return Err(unusable("--formula", problem));
    };
    if let Some(other) = formula
        .random
        .iter()
        .find(|part| part.groups != first.groups)
    {
        let problem = format!(
            "fruit are named by {} and by {}: one kind of group can be planned; leave the other \
             out, or make it a fixed effect",
            first.groups.join(":"),
            other.groups.join(":")
        );
        return Err(unusable("--formula", problem));
    }
    let (kept, _) = complete_rows(&formula, &data.table, &[]).map_err(|error| data.told(error))?;
    data.keep(&kept);
    let study = study_of(&formula, &data)?;
    Ok((study, data))
}

fn study_of(formula: &Formula, data: &Data) -> Result<Study, Error> {
    let (told, y) = coded(formula, data, Contrast::Treatment)?;
    let (tested, _) = coded(formula, data, Contrast::Sum)?;
    let framed = random_terms(formula, &data.table, Contrast::Treatment);
    let framed = framed.map_err(|error| data.told(error))?;
    let random: Vec<RandomTerm> = framed.into_iter().map(|own| own.term).collect();
    let fit = fit_mixed(&y, &told.x, &told.names, &random, &MixedOptions::default());
    let fit = fit.map_err(|error| data.told(StatisticsError::Mixed(error)))?;
    let fruit = fruit_of(&random, &told.x);
    Ok(Study {
        by: random
            .first()
            .map(|own| own.name.clone())
            .unwrap_or_default(),
        told,
        tested,
        random,
        fruit,
        fit,
    })
}

fn coded(formula: &Formula, data: &Data, contrast: Contrast) -> Result<(Coded, Vec<f64>), Error> {
    let rows = model_rows(formula, &data.table, contrast, &[]).map_err(|error| data.told(error))?;
    let every: Vec<usize> = (0..rows.x.ncols()).collect();
    let columns = reduce(&rows.x, &rows.y).solve(&every).columns;
    let coded = Coded {
        x: rows.x.select_columns(&columns),
        names: columns
            .iter()
            .map(|c| rows.frame.names[*c].clone())
            .collect(),
        terms: terms_of(&rows.frame, &columns),
    };
    Ok((coded, rows.y))
}

/// Terms with the places of their columns among those that are kept.
fn terms_of(frame: &ModelFrame, columns: &[usize]) -> Vec<(String, Vec<usize>)> {
    let terms = frame.terms.iter().map(|term| {
        let places = columns.iter().enumerate();
        let places = places.filter(|(_, column)| term.columns.contains(column));
        (
            term.name.clone(),
            places.map(|(place, _)| place).collect::<Vec<_>>(),
        )
    });
    terms.filter(|(_, places)| !places.is_empty()).collect()
}

/// Rows of each fruit, those with equal settings beside each other, so that every so many of
/// them are a fair part of all.
fn fruit_of(random: &[RandomTerm], x: &DMatrix<f64>) -> Vec<Vec<usize>> {
    let Some(first) = random.first() else {
        return Vec::new();
    };
    let mut fruit = vec![Vec::new(); first.groups];
    for (row, group) in first.group.iter().enumerate() {
        fruit[*group].push(row);
    }
    fruit.retain(|rows| !rows.is_empty());
    let mean = |rows: &[usize], column: usize| {
        rows.iter().map(|row| x[(*row, column)]).sum::<f64>() / rows.len() as f64
    };
    let setting = |rows: &Vec<usize>| -> Vec<f64> {
        (0..x.ncols()).map(|column| mean(rows, column)).collect()
    };
    let mut keyed: Vec<(Vec<f64>, Vec<usize>)> = fruit
        .into_iter()
        .map(|rows| (setting(&rows), rows))
        .collect();
    keyed.sort_by(|(a, _), (b, _)| {
        let pairs = a.iter().zip(b).map(|(a, b)| a.total_cmp(b));
        pairs.fold(std::cmp::Ordering::Equal, std::cmp::Ordering::then)
    });
    keyed.into_iter().map(|(_, rows)| rows).collect()
}

impl Study {
    /// Number of independent columns that are the same in all rows of every fruit, and of the
    /// others.
    pub fn columns_between(&self) -> (usize, usize) {
        let x = &self.told.x;
        let same = |column: &usize| {
            self.fruit.iter().all(|rows| {
                let first = rows.first().map_or(0.0, |row| x[(*row, *column)]);
                let close = |row: &usize| {
                    let own = x[(*row, *column)];
                    (own - first).abs() <= SAME * own.abs().max(first.abs())
                };
                rows.iter().all(close)
            })
        };
        let between = (0..x.ncols()).filter(same).count();
        (between, x.ncols() - between)
    }

    /// Rows of each fruit on average.
    pub fn usual_impacts(&self) -> usize {
        let rows: usize = self.fruit.iter().map(Vec::len).sum();
        (rows as f64 / self.fruit.len().max(1) as f64)
            .round()
            .max(1.0) as usize
    }

    /// Errors where a number of impacts on each fruit cannot be made of the table's rows.
    pub fn check_impacts(&self, impacts: usize) -> Result<(), Error> {
        let even =
            |rows: &Vec<usize>| impacts.is_multiple_of(rows.len()) || self.has_one_setting(rows);
        match self.fruit.iter().find(|rows| !even(rows)) {
            None => Ok(()),
            Some(rows) => Err(unusable(
                "--impacts",
                format!(
                    "{impacts}: a fruit of the table has {} impacts with settings of their own, \
                     which can be repeated but not divided: give a multiple, or leave it out to \
                     take the rows as they are",
                    rows.len()
                ),
            )),
        }
    }

    /// Whether all rows of a fruit have the same columns.
    fn has_one_setting(&self, rows: &[usize]) -> bool {
        let Some((first, rest)) = rows.split_first() else {
            return true;
        };
        let same = |a: f64, b: f64| (a - b).abs() <= SAME * a.abs().max(b.abs());
        let fixed = rest.iter().all(|row| {
            (0..self.told.x.ncols())
                .all(|column| same(self.told.x[(*row, column)], self.told.x[(*first, column)]))
        });
        fixed
            && self.random.iter().all(|term| {
                let mut columns = term.columns.iter();
                columns.all(|column| rest.iter().all(|row| same(column[*row], column[*first])))
            })
    }

    /// The rows of a study of another size.
    ///
    /// Fruit are taken evenly from those of the table, each with its rows, or with its rows
    /// repeated to a number of impacts.
    ///
    /// * `own_rows`: each fruit keeps the rows that it has
    pub fn resized(&self, size: Size, own_rows: bool) -> Resized {
        let (mut rows, mut fruit) = (Vec::new(), Vec::new());
        let all = self.fruit.len();
        for place in 0..size.fruit {
            let own = &self.fruit[place * all / size.fruit];
            match own_rows {
                true => rows.extend(own),
                false => rows.extend((0..size.impacts).map(|k| own[k % own.len()])),
            }
            fruit.resize(rows.len(), place);
        }
        Resized { rows, fruit }
    }

    /// Random terms of a study of another size.
    pub fn random_of(&self, resized: &Resized) -> Vec<RandomTerm> {
        let groups = resized.fruit.last().map_or(0, |last| last + 1);
        let terms = self.random.iter().map(|term| RandomTerm {
            columns: term
                .columns
                .iter()
                .map(|column| resized.rows.iter().map(|row| column[*row]).collect())
                .collect(),
            group: resized.fruit.clone(),
            groups,
            group_names: (0..groups).map(|group| group.to_string()).collect(),
            ..term.clone()
        });
        terms.collect()
    }

    /// How a coefficient of `told` is made of those of `tested`: the weights.
    pub fn weights_of(&self, coefficient: usize) -> Option<Vec<f64>> {
        // X_told = X_tested M, so that β_tested = M β_told
        let (tested, told) = (&self.tested.x, &self.told.x);
        let square = tested.tr_mul(tested).cholesky()?;
        let change = square.solve(&tested.tr_mul(told)).lu();
        let unit = DVector::from_fn(told.ncols(), |i, _| f64::from(u8::from(i == coefficient)));
        // β_told = M⁻¹ β_tested: a row of M⁻¹
        let inverse = change.try_inverse()?;
        Some((unit.transpose() * inverse).iter().copied().collect())
    }
}
