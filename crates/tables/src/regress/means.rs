//! Marginal means of a model and their differences, as they are shown.

use serde::Serialize;
use std::collections::BTreeSet;
use windfall_files::error::Error;
use windfall_files::option_value::unusable;
use windfall_files::table::write::csv_text;
use windfall_files::text::columns::{Column, text_of_rows};
use windfall_files::text::statistic::{freedom, number, probability};
use windfall_statistics::coefficient::Estimated;
use windfall_statistics::model::marginal_means::{
    Adjustment, MarginalRows, differences, interval, marginal_rows,
};
use windfall_statistics::model::model_frame::{ModelFrame, chosen_rows};
use windfall_statistics::model::reduced::Aliased;
use windfall_statistics::table::Table;

/// How the differences of means allow for their number.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "clap", derive(clap::ValueEnum))]
pub enum Adjust {
    /// Tukey's: by the studentised range of all means
    #[default]
    Tukey,
    /// Holm's probabilities, intervals by Bonferroni
    Holm,
    /// Not at all
    None,
}

impl Adjust {
    fn adjustment(self) -> (Adjustment, &'static str) {
        match self {
            Self::Tukey => (Adjustment::Tukey, "Tukey"),
            Self::Holm => (Adjustment::Holm, "Holm, intervals by Bonferroni"),
            Self::None => (Adjustment::Single, "not adjusted"),
        }
    }
}

/// Means for levels of categories.
#[derive(Clone, Debug, PartialEq, Serialize, utoipa::ToSchema)]
pub struct MeansOutcome {
    /// The categories.
    pub of: Vec<String>,
    /// Columns of numbers with the mean at which they are held.
    pub at: Vec<(String, f64)>,
    /// The means.
    pub means: Vec<MeanOutcome>,
    /// How the differences are adjusted for their number.
    pub adjusted: &'static str,
    /// Differences of all pairs.
    pub differences: Vec<DifferenceOutcome>,
}

/// A marginal mean.
#[derive(Clone, Debug, PartialEq, Serialize, utoipa::ToSchema)]
pub struct MeanOutcome {
    /// Levels, in the order of the categories.
    pub levels: Vec<String>,
    /// The mean on the scale of the model.
    pub mean: f64,
    /// Its standard error.
    pub se: f64,
    /// Degrees of freedom.
    pub df: f64,
    /// Lower end of its interval.
    pub low: f64,
    /// Upper end.
    pub high: f64,
}

/// A difference of two marginal means.
#[derive(Clone, Debug, PartialEq, Serialize, utoipa::ToSchema)]
pub struct DifferenceOutcome {
    /// Levels of the second mean and of the first: "Gala - Fuji".
    pub pair: String,
    /// Second less first.
    pub difference: f64,
    /// Its standard error.
    pub se: f64,
    /// Degrees of freedom.
    pub df: f64,
    /// Difference over its standard error.
    pub t: f64,
    /// Probability, adjusted.
    pub p: f64,
    /// Lower end of the interval, adjusted.
    pub low: f64,
    /// Upper end.
    pub high: f64,
}

/// What means of a model are made from.
pub(crate) struct Model<'a> {
    /// Its columns.
    pub frame: &'a ModelFrame,
    /// Columns without an estimate.
    pub aliased: &'a [Aliased],
    /// Rows that it was fitted to.
    pub table: &'a Table,
    /// Which rows of the table these are.
    pub kept: &'a [usize],
    /// Estimate of a sum of all its columns.
    pub estimate: &'a dyn Fn(&[f64]) -> Estimated,
}

/// Marginal means for each request, "variety" or "variety,dose".
///
/// # Errors
/// A column is no category of the model, or stands there twice; a mean that the rows do not
/// determine.
pub(crate) fn means_of(
    model: &Model,
    asked: &[String],
    adjust: Adjust,
    confidence: f64,
) -> Result<Vec<MeansOutcome>, Error> {
    let table = chosen_rows(model.table, model.kept);
    let (adjustment, adjusted) = adjust.adjustment();
    let of = |text: &String| {
        let by: Vec<String> = text.split(',').map(|own| own.trim().to_owned()).collect();
        if by.iter().any(String::is_empty) {
            let problem = "expected columns separated by commas: variety,dose";
            return Err(unusable(format!("--means '{text}'"), problem));
        }
        if by.iter().collect::<BTreeSet<_>>().len() < by.len() {
            return Err(unusable(
                format!("--means {text}"),
                "a column stands there twice",
            ));
        }
        let rows = marginal_rows(model.frame, &table, &by).map_err(Error::Statistics)?;
        check_estimable(model, text, &rows)?;
        let mut means = Vec::new();
        for (levels, row) in rows.groups.iter().zip(rows.rows.row_iter()) {
            let own = (model.estimate)(&row.iter().copied().collect::<Vec<_>>());
            let (low, high) = interval(&own, confidence);
            means.push(MeanOutcome {
                levels: levels.clone(),
                mean: own.value,
                se: own.se,
                df: own.df,
                low,
                high,
            });
        }
        let found = differences(&rows, adjustment, confidence, model.estimate);
        let name = |place: usize| rows.groups[place].join(" ");
        let pairs = found.iter().map(|own| DifferenceOutcome {
            pair: format!("{} - {}", name(own.second), name(own.first)),
            difference: own.difference.value,
            se: own.difference.se,
            df: own.difference.df,
            t: own.t,
            p: own.p,
            low: own.low,
            high: own.high,
        });
        Ok(MeansOutcome {
            of: by,
            at: rows.held.clone(),
            means,
            adjusted,
            differences: pairs.collect(),
        })
    };
    asked.iter().map(of).collect()
}

/// A mean that rests on a column without an estimate must do so as the columns do on which that
/// one depends.
fn check_estimable(model: &Model, text: &str, rows: &MarginalRows) -> Result<(), Error> {
    for (levels, row) in rows.groups.iter().zip(rows.rows.row_iter()) {
        let row: Vec<f64> = row.iter().copied().collect();
        for aliased in model.aliased {
            if !aliased.agrees(&row) {
                let problem = format!(
                    "the mean of {} cannot be estimated: it depends on {}, which has no estimate \
                     of its own (no row tells it); ask for fewer categories, or leave out the \
                     interaction",
                    levels.join(" "),
                    model.frame.names[aliased.column]
                );
                return Err(unusable(format!("--means {text}"), problem));
            }
        }
    }
    Ok(())
}

const MEANS: [Column<MeanOutcome>; 6] = [
    ("", |own| own.levels.join(" ")),
    ("mean", |own| number(own.mean)),
    ("se", |own| number(own.se)),
    ("df", |own| freedom(own.df)),
    ("from", |own| number(own.low)),
    ("to", |own| number(own.high)),
];

const DIFFERENCES: [Column<DifferenceOutcome>; 8] = [
    ("pair", |own| own.pair.clone()),
    ("difference", |own| number(own.difference)),
    ("se", |own| number(own.se)),
    ("df", |own| freedom(own.df)),
    ("t", |own| number(own.t)),
    ("p", |own| probability(own.p)),
    ("from", |own| number(own.low)),
    ("to", |own| number(own.high)),
];

/// Means and differences as CSV, a row each.
pub(crate) fn csv_of_means(outcomes: &[MeansOutcome]) -> Result<String, Error> {
    let header = [
        "of", "what", "estimate", "se", "df", "t", "p", "low", "high",
    ];
    let header = header.map(str::to_owned);
    let row = |of: &MeansOutcome, what: &str, numbers: [f64; 7]| {
        let names = [of.of.join(","), what.to_owned()];
        let cell = |own: f64| match own.is_nan() {
            true => String::new(),
            false => own.to_string(),
        };
        names
            .into_iter()
            .chain(numbers.map(cell))
            .collect::<Vec<_>>()
    };
    let none = f64::NAN;
    let rows = outcomes.iter().flat_map(|of| {
        let means = of.means.iter().map(move |own| {
            let numbers = [own.mean, own.se, own.df, none, none, own.low, own.high];
            row(of, &own.levels.join(" "), numbers)
        });
        let differences = of.differences.iter().map(move |own| {
            let numbers = [
                own.difference,
                own.se,
                own.df,
                own.t,
                own.p,
                own.low,
                own.high,
            ];
            row(of, &own.pair, numbers)
        });
        means.chain(differences)
    });
    csv_text(&header, rows)
}

/// Means and differences as text.
pub(crate) fn means_text(outcomes: &[MeansOutcome]) -> String {
    let text = outcomes.iter().map(|own| {
        let at = own.at.iter();
        let at: Vec<String> = at
            .map(|(name, mean)| format!("{name} {}", number(*mean)))
            .collect();
        let at = match at.is_empty() {
            true => String::new(),
            false => format!(" at {}", at.join(", ")),
        };
        let of = own.of.join(", ");
        let means = text_of_rows(&own.means, &MEANS, &[0]);
        let pairs = match own.differences.is_empty() {
            true => String::new(),
            false => format!(
                "\n\nDifferences ({}):\n{}",
                own.adjusted,
                text_of_rows(&own.differences, &DIFFERENCES, &[0])
            ),
        };
        format!("\nMarginal means of {of}{at}:\n{means}{pairs}\n")
    });
    text.collect()
}
