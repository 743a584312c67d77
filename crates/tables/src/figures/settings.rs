//! What a model is made of, and rows of its columns at chosen settings.

use windfall_distribution::quantile::quantile;
use windfall_files::error::Error;
use windfall_statistics::model::encoding::Encoding;
use windfall_statistics::model::expression::columns_of;
use windfall_statistics::model::model_frame::{ModelFrame, prediction_rows};
use windfall_statistics::table::{Categories, Cells, Column, Table};

/// Most combinations of levels that a mean is taken over; with more, the other categories stay
/// at their most frequent level.
const MOST_COMBINATIONS: usize = 64;

/// Most lines of one panel.
const MOST_LINES: usize = 7;

/// A column that a model is made of.
#[derive(Clone, Debug, PartialEq)]
pub struct Variable {
    /// Its name.
    pub column: String,
    /// Its levels, where the model has it as a category.
    pub levels: Option<Vec<String>>,
    /// Whether it is (also) a number of the model.
    pub number: bool,
    /// Values of the rows: numbers, or places among the levels.
    pub values: Vec<f64>,
    /// Columns that stand in a term with it.
    pub partners: Vec<String>,
}

impl Variable {
    /// Mean of its values.
    fn mean(&self) -> f64 {
        self.values.iter().sum::<f64>() / self.values.len() as f64
    }

    /// Place of the level that most rows have, the first of several.
    fn most_frequent(&self) -> f64 {
        let count = |place: usize| {
            let own = self.values.iter();
            own.filter(|value| **value == place as f64).count()
        };
        let places = 0..self.levels.as_ref().map_or(0, Vec::len);
        places.rev().max_by_key(|place| count(*place)).unwrap_or(0) as f64
    }

    /// Values at which another variable's effect is shown: levels, or the 10, 50 and 90 %
    /// quantiles; and how many levels there are beyond these.
    pub fn lines(&self) -> (Vec<f64>, usize) {
        if let Some(levels) = &self.levels {
            let shown = levels.len().min(MOST_LINES);
            let places = (0..shown).map(|place| place as f64);
            return (places.collect(), levels.len() - shown);
        }
        let mut values: Vec<f64> = [0.1, 0.5, 0.9]
            .iter()
            .map(|part| quantile(&self.values, *part))
            .collect();
        values.dedup();
        (values, 0)
    }

    /// Values that its effect is drawn over.
    pub fn along(&self, points: usize) -> Vec<f64> {
        if let Some(levels) = &self.levels {
            return (0..levels.len()).map(|place| place as f64).collect();
        }
        let low = self.values.iter().copied().fold(f64::INFINITY, f64::min);
        let high = self
            .values
            .iter()
            .copied()
            .fold(f64::NEG_INFINITY, f64::max);
        let part = |i: usize| i as f64 / (points - 1) as f64;
        let mut values: Vec<f64> = (0..points)
            .map(|i| low * (1.0 - part(i)) + high * part(i))
            .collect();
        values.dedup();
        values
    }

    /// A value with all its digits, or its level.
    pub fn word_in_full(&self, value: f64) -> String {
        match &self.levels {
            Some(_) => self.word(value),
            None => value.to_string(),
        }
    }

    /// A value in words.
    pub fn word(&self, value: f64) -> String {
        match &self.levels {
            Some(levels) => levels.get(value as usize).cloned().unwrap_or_default(),
            None => windfall_files::text::number::plain(value),
        }
    }
}

/// Columns that a model is made of, in the order of its terms.
///
/// * `used`: columns that are in the model; terms without any, which a selection took out, are
///   passed over
/// * `table`: rows that the model was fitted to
///
/// # Errors
/// A column of the model is not in the table.
pub fn variables_of(
    frame: &ModelFrame,
    used: &[usize],
    table: &Table,
) -> Result<Vec<Variable>, Error> {
    let mut found: Vec<Variable> = Vec::new();
    for term in &frame.terms {
        if !term.columns.clone().any(|own| used.contains(&own)) {
            continue;
        }
        let atoms = term.atoms.iter().map(|(atom, _)| &frame.atoms[*atom]);
        let mut names: Vec<String> = Vec::new();
        for atom in atoms {
            let (columns, levels) = match atom {
                Encoding::Category { column, levels, .. } => (vec![column.clone()], Some(levels)),
                Encoding::Numbers { node, .. }
                | Encoding::Polynomial { node, .. }
                | Encoding::Scaled { node, .. } => (columns_of(node), None),
            };
            for column in columns {
                let place = found.iter().position(|own| own.column == column);
                let place = place.unwrap_or_else(|| {
                    found.push(Variable {
                        column: column.clone(),
                        levels: None,
                        number: false,
                        values: Vec::new(),
                        partners: Vec::new(),
                    });
                    found.len() - 1
                });
                match levels {
                    Some(levels) => found[place].levels = Some(levels.clone()),
                    None => found[place].number = true,
                }
                names.push(column);
            }
        }
        for own in &mut found {
            if names.contains(&own.column) {
                let others = names.iter().filter(|name| **name != own.column);
                let new = others.filter(|name| !own.partners.contains(name));
                let new: Vec<String> = new.cloned().collect();
                own.partners.extend(new);
                own.partners.dedup();
            }
        }
    }
    for own in &mut found {
        own.values = values_of(own, table)?;
    }
    Ok(found)
}

fn values_of(own: &Variable, table: &Table) -> Result<Vec<f64>, Error> {
    let cells = &table.column(&own.column).map_err(Error::Statistics)?.cells;
    match (&own.levels, cells) {
        (None, _) => {
            let numbers = table.numbers(&own.column).map_err(Error::Statistics)?;
            Ok(numbers.values().into_owned())
        }
        (Some(levels), cells) => {
            let own = cells.categories();
            let place = |name: &String| levels.iter().position(|level| level == name);
            let places: Vec<Option<usize>> = own.levels.iter().map(place).collect();
            let value = |code: &Option<usize>| {
                let place = code.and_then(|code| places[code]);
                place.map_or(f64::NAN, |place| place as f64)
            };
            Ok(own.codes.iter().map(value).collect())
        }
    }
}

/// What others are while some variables are set.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Others {
    /// Numbers at their mean, categories over all combinations of their levels with equal weight.
    Averaged,
    /// Numbers at their mean, categories at their most frequent level: the combinations are too
    /// many.
    MostFrequent,
}

/// Rows of a model's columns at settings of some variables, averaged over the others.
///
/// * `set`: places of the variables that are set
/// * `settings`: their values, in the same order
///
/// Returns a row per setting.
///
/// # Errors
/// The model is not defined there.
pub fn rows_at(
    frame: &ModelFrame,
    variables: &[Variable],
    set: &[usize],
    settings: &[Vec<f64>],
) -> Result<(Vec<Vec<f64>>, Others), Error> {
    let free = (0..variables.len()).filter(|place| !set.contains(place));
    let categories: Vec<(usize, usize)> = free
        .filter_map(|place| Some((place, variables[place].levels.as_ref()?.len())))
        .collect();
    let mut combinations = 1_usize;
    for (_, levels) in &categories {
        combinations = combinations.saturating_mul((*levels).max(1));
    }
    let averaged = combinations <= MOST_COMBINATIONS;
    let each = if averaged { combinations } else { 1 };
    let value = |variable: usize, row: usize| -> f64 {
        let (setting, mut combination) = (row / each, row % each);
        if let Some(place) = set.iter().position(|own| *own == variable) {
            return settings[setting][place];
        }
        if variables[variable].levels.is_none() {
            return variables[variable].mean();
        }
        if !averaged {
            return variables[variable].most_frequent();
        }
        for (own, levels) in &categories {
            if *own == variable {
                return (combination % levels) as f64;
            }
            combination /= levels;
        }
        0.0
    };
    let rows = settings.len() * each;
    let column = |(place, own): (usize, &Variable)| {
        let fixed = match (&own.levels, set.contains(&place)) {
            (None, false) => Some(own.mean()),
            (Some(_), false) if !averaged => Some(own.most_frequent()),
            _ => None,
        };
        let values = (0..rows).map(|row| fixed.unwrap_or_else(|| value(place, row)));
        column_of(own, values.collect())
    };
    let table = Table {
        columns: variables.iter().enumerate().map(column).collect(),
    };
    let x = prediction_rows(frame, &table).map_err(Error::Statistics)?;
    let mean = |setting: usize| -> Vec<f64> {
        let columns = 0..x.ncols();
        columns
            .map(|column| x.view((setting * each, column), (each, 1)).sum() / each as f64)
            .collect()
    };
    let others = match averaged {
        true => Others::Averaged,
        false => Others::MostFrequent,
    };
    Ok(((0..settings.len()).map(mean).collect(), others))
}

fn column_of(own: &Variable, values: Vec<f64>) -> Column {
    let cells = match &own.levels {
        None => Cells::Numbers(values.into()),
        // A column that is a number of the model too.
        Some(levels) if own.number => {
            let number = |value: &f64| levels.get(*value as usize)?.parse().ok();
            let numbers = values.iter().map(|value| number(value).unwrap_or(f64::NAN));
            Cells::Numbers(numbers.collect())
        }
        Some(levels) => Cells::Categories(Categories {
            levels: levels.clone(),
            codes: values.iter().map(|value| Some(*value as usize)).collect(),
            ordered: true,
        }),
    };
    Column {
        name: own.column.clone(),
        cells,
    }
}
