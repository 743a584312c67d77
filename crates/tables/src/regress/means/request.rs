//! Which means of a model are asked for, and how they are compared.

use std::collections::BTreeSet;
use windfall_files::error::Error;
use windfall_files::option_value::{parts, plain_name, unusable};
use windfall_statistics::model::mean_contrasts::Adjustment;

/// Which means of a model are asked for, and how they are compared.
#[derive(Clone, Debug, Default, PartialEq)]
#[cfg_attr(feature = "clap", derive(clap::Args))]
pub struct MeansRequest {
    /// Marginal means of a category, or of several ('variety,dose'), with their differences: over
    /// the levels of the other categories in equal parts, at the mean of each column of numbers;
    /// 'dose | variety' compares doses within each variety; names with a comma or a bar stand in
    /// backticks; may be repeated
    #[cfg_attr(feature = "clap", arg(long = "means", value_name = "COLUMNS"))]
    pub means: Vec<String>,
    /// Slopes on a column of numbers ('V'), at levels ('V,variety'), within others
    /// ('V,dose | variety'); may be repeated
    #[cfg_attr(feature = "clap", arg(long = "slopes", value_name = "COLUMNS"))]
    pub slopes: Vec<String>,
    /// Where a column of numbers is held for means and slopes: 'V=0.5'; may be repeated
    #[cfg_attr(feature = "clap", arg(long = "at", value_name = "COLUMN=VALUE"))]
    pub at: Vec<String>,
    /// Which means are compared: pairs, control (with the first level), control=LEVEL, mean (of
    /// all), polynomial, or a sum of your own with a weight for each mean: 'treated - control =
    /// -1, 0.5, 0.5'; may be repeated
    #[cfg_attr(
        feature = "clap",
        arg(long = "compare", value_name = "WHICH", allow_hyphen_values = true)
    )]
    pub compare: Vec<String>,
    /// How comparisons of means allow for their number: Tukey's for pairs, multivariate t for
    /// others, not at all for polynomials and sums of your own, unless this says otherwise
    #[cfg_attr(feature = "clap", arg(long, value_enum))]
    pub adjust: Option<Adjust>,
}

/// How the comparisons of means allow for their number.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "clap", derive(clap::ValueEnum))]
pub enum Adjust {
    /// Tukey's: by the studentised range of all means
    Tukey,
    /// Multivariate t: by the correlation of the comparisons; with a control Dunnett's
    T,
    /// Holm's probabilities, intervals by Bonferroni
    Holm,
    /// Not at all
    None,
}

/// Columns of means: `V,dose | variety`.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Columns {
    /// The column of numbers of a slope.
    pub slope: Option<String>,
    /// Categories whose levels are compared.
    pub of: Vec<String>,
    /// Categories within whose levels they are.
    pub within: Vec<String>,
    /// The option as it was written.
    pub option: String,
}

/// Which means are compared, before their names are known.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum Which {
    /// Each with every other.
    Pairs,
    /// Each with the first, or with that of this name.
    Control(Option<String>),
    /// Each with the mean of all.
    Mean,
    /// Trends over the levels.
    Polynomial,
    /// Sums with their weights.
    Custom(Vec<(String, Vec<f64>)>),
}

impl MeansRequest {
    /// Whether nothing is asked.
    pub(crate) fn is_empty(&self) -> bool {
        *self == Self::default()
    }

    /// Columns of all means and slopes, in the order in which they were asked for.
    ///
    /// # Errors
    /// A name is missing or stands there twice; comparisons without means.
    pub(crate) fn columns(&self) -> Result<Vec<Columns>, Error> {
        let means = self.means.iter().map(|text| columns(text, false));
        let slopes = self.slopes.iter().map(|text| columns(text, true));
        let found: Vec<Columns> = means.chain(slopes).collect::<Result<_, Error>>()?;
        let others = [
            ("--compare", !self.compare.is_empty()),
            ("--adjust", self.adjust.is_some()),
            ("--at", !self.at.is_empty()),
        ];
        match others.iter().find(|(_, given)| *given) {
            Some((option, _)) if found.is_empty() => {
                let problem =
                    "there is nothing to compare or hold: say --means or --slopes of what";
                Err(unusable(*option, problem))
            }
            _ => Ok(found),
        }
    }

    /// Where columns of numbers are held.
    ///
    /// # Errors
    /// A value is missing, or no number.
    pub(crate) fn held(&self) -> Result<Vec<(String, f64)>, Error> {
        let one = |text: &String| {
            let (column, value) = text.split_once('=')?;
            let value: f64 = value.trim().parse().ok()?;
            value.is_finite().then(|| (column.trim().to_owned(), value))
        };
        let mut held: Vec<(String, f64)> = Vec::new();
        for text in &self.at {
            let wrong = |problem: &str| unusable(format!("--at '{text}'"), problem);
            let expected = "expected a column of numbers and its value: V=0.5";
            let own = one(text).ok_or_else(|| wrong(expected))?;
            if held.iter().any(|(column, _)| *column == own.0) {
                return Err(wrong("the column is held at another value, too"));
            }
            held.push(own);
        }
        Ok(held)
    }

    /// Which means are compared.
    ///
    /// # Errors
    /// An unknown word, weights that are no numbers or do not sum to zero, several words.
    pub(crate) fn which(&self) -> Result<Which, Error> {
        let mut custom = Vec::new();
        for text in &self.compare {
            let wrong = |problem: &str| unusable(format!("--compare '{text}'"), problem);
            let only = |which: Which| match self.compare.len() {
                1 => Ok(which),
                _ => Err(wrong(
                    "only sums of your own may stand beside others; compare in other ways one \
                     after another",
                )),
            };
            match text.trim() {
                "pairs" => return only(Which::Pairs),
                "control" => return only(Which::Control(None)),
                "mean" => return only(Which::Mean),
                "polynomial" => return only(Which::Polynomial),
                _ => {}
            }
            let (name, weights) = text.split_once('=').ok_or_else(|| {
                wrong(
                    "expected pairs, control, control=LEVEL, mean, polynomial, or a name and a \
                     weight for each mean: 'treated - control = -1, 0.5, 0.5'",
                )
            })?;
            if name.trim() == "control" {
                return only(Which::Control(Some(weights.trim().to_owned())));
            }
            let numbers = weights.split(',').map(|own| weight(own.trim()));
            let numbers: Option<Vec<f64>> = numbers.collect();
            let numbers =
                numbers.ok_or_else(|| wrong("expected numbers or fractions between commas"))?;
            let largest = numbers
                .iter()
                .fold(0.0, |most: f64, own| most.max(own.abs()));
            if largest == 0.0 {
                return Err(wrong("all weights are zero: nothing is compared"));
            }
            let sum: f64 = numbers.iter().sum();
            if sum.abs() > 1e-9 * largest {
                return Err(wrong(&format!(
                    "weights of a comparison sum to 0, these to {sum}"
                )));
            }
            let name = name.trim();
            if name.is_empty() || custom.iter().any(|(own, _)| own == name) {
                return Err(wrong("a sum needs a name of its own before the ="));
            }
            custom.push((name.to_owned(), numbers));
        }
        Ok(match custom.is_empty() {
            true => Which::Pairs,
            false => Which::Custom(custom),
        })
    }

    /// How the comparisons are adjusted, and the words for it.
    ///
    /// # Errors
    /// Tukey's for others than pairs.
    pub(crate) fn adjustment(&self, which: &Which) -> Result<(Adjustment, &'static str), Error> {
        let usual = match which {
            Which::Pairs => Adjust::Tukey,
            Which::Control(_) | Which::Mean => Adjust::T,
            Which::Polynomial | Which::Custom(_) => Adjust::None,
        };
        Ok(match (self.adjust.unwrap_or(usual), which) {
            (Adjust::Tukey, Which::Pairs) => (Adjustment::Tukey, "Tukey"),
            (Adjust::Tukey, _) => {
                let problem = "Tukey's is for all pairs: give --adjust t for other comparisons";
                return Err(unusable("--adjust tukey", problem));
            }
            (Adjust::T, Which::Control(_)) => (Adjustment::MultivariateT, "Dunnett"),
            (Adjust::T, _) => (Adjustment::MultivariateT, "multivariate t"),
            (Adjust::Holm, _) => (Adjustment::Holm, "Holm, intervals by Bonferroni"),
            (Adjust::None, _) => (Adjustment::Single, "not adjusted"),
        })
    }
}

/// A number, or a fraction: "-1/3".
fn weight(text: &str) -> Option<f64> {
    let value = match text.split_once('/') {
        Some((above, below)) => {
            above.trim().parse::<f64>().ok()? / below.trim().parse::<f64>().ok()?
        }
        None => text.parse().ok()?,
    };
    value.is_finite().then_some(value)
}

/// `V,dose | variety`.
fn columns(text: &str, slope: bool) -> Result<Columns, Error> {
    let option = match slope {
        true => format!("--slopes '{text}'"),
        false => format!("--means '{text}'"),
    };
    let mut sides = parts(text, '|').map(|side| parts(side, ',').map(plain_name).collect());
    let of: Vec<String> = sides.next().unwrap_or_default();
    let within: Vec<String> = sides.next().unwrap_or_default();
    let every: Vec<&String> = of.iter().chain(&within).collect();
    if every.iter().any(|own| own.is_empty()) || sides.next().is_some() {
        let problem = match slope {
            true => "expected a column of numbers and categories: V,dose | variety",
            false => "expected columns separated by commas: variety,dose",
        };
        return Err(unusable(option, problem));
    }
    if every.iter().collect::<BTreeSet<_>>().len() < every.len() {
        return Err(unusable(option, "a column stands there twice"));
    }
    let (slope, of) = match slope {
        true => (Some(of[0].clone()), of[1..].to_vec()),
        false => (None, of),
    };
    Ok(Columns {
        slope,
        of,
        within,
        option,
    })
}
