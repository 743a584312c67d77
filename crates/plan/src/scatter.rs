//! How much measurements scatter: as stated, or as a mixed model of earlier impacts tells.

use crate::options::ScatterOptions;
use crate::parse::numbers;
use std::path::Path;
use windfall_files::error::Error;
use windfall_files::found::FindingOutcome;
use windfall_files::option_value::unusable;
use windfall_files::text::statistic::number;
use windfall_tables::reading::ReadingOptions;
use windfall_tables::regress::mixed::{MixedOutcome, VarianceOutcome};
use windfall_tables::regress::request::RegressRequest;
use windfall_tables::regress::run::{AnyRegressOutcome, regress};

/// Scatter of the measurements; unit of what is measured.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum Scatter {
    /// Standard deviation of one value for each fruit; two where two groups differ.
    Fruit(Vec<f64>),
    /// Standard deviations between fruit (two where two groups differ), and between the impacts
    /// of a fruit.
    Nested {
        /// Between fruit.
        between: Vec<f64>,
        /// Between the impacts of a fruit.
        within: f64,
    },
}

/// A scatter and where it comes from.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct KnownScatter {
    pub scatter: Scatter,
    /// "SD between fruit 0.2, between the impacts of a fruit 0.1".
    pub words: String,
    pub findings: Vec<FindingOutcome>,
}

impl Scatter {
    /// Standard deviation of the mean of a fruit's impacts, in a group.
    pub fn of_fruit_mean(&self, group: usize, impacts: usize) -> f64 {
        let own = |sds: &[f64]| sds.get(group).or(sds.first()).copied().unwrap_or(f64::NAN);
        match self {
            Self::Fruit(sds) => own(sds),
            Self::Nested { between, within } => {
                own(between).hypot(within / (impacts as f64).sqrt())
            }
        }
    }

    /// Whether two groups have scatters of their own.
    pub fn differs(&self) -> bool {
        match self {
            Self::Fruit(sds) | Self::Nested { between: sds, .. } => sds.len() > 1,
        }
    }

    /// Standard deviation between the impacts of a fruit, where it is known.
    pub fn within(&self) -> Option<f64> {
        match self {
            Self::Fruit(_) => None,
            Self::Nested { within, .. } => Some(*within),
        }
    }

    /// Several impacts on a fruit need to know how they scatter.
    ///
    /// # Errors
    /// They do not.
    pub fn check_impacts(&self, impacts: usize) -> Result<(), Error> {
        if impacts == 1 || self.within().is_some() {
            return Ok(());
        }
        let problem = format!(
            "{impacts} impacts on each fruit need two standard deviations, --between fruit and \
             --within them, in place of --sd; `windfall regress TABLE --formula 'y ~ (1 | fruit)'` \
             tells both of earlier impacts, and --from TABLE takes them from there"
        );
        Err(unusable("--impacts", problem))
    }
}

/// Reads the scatter.
///
/// * `groups`: most standard deviations that an option may state
/// * `reading`: how the table of earlier impacts is read
///
/// # Errors
/// None is known, or one is not above zero; the table cannot be used.
pub(crate) fn known_scatter(
    options: &ScatterOptions,
    groups: usize,
    reading: &ReadingOptions,
) -> Result<KnownScatter, Error> {
    if let (Some(table), Some(formula)) = (&options.from, &options.formula) {
        return of_table(table, formula, reading);
    }
    let sds = |option: &str, text: &str| sds(option, text, groups);
    match (&options.sd, &options.between, &options.within) {
        (Some(sd), ..) => {
            let sds = sds("--sd", sd)?;
            Ok(KnownScatter {
                words: format!("SD of one value for each fruit {}", list(&sds)),
                scatter: Scatter::Fruit(sds),
                findings: Vec::new(),
            })
        }
        (None, Some(between), Some(within)) => {
            let between = sds("--between", between)?;
            let within = self::sds("--within", within, 1)?
                .first()
                .copied()
                .unwrap_or(f64::NAN);
            Ok(KnownScatter {
                words: nested_words(&list(&between), &number(within)),
                scatter: Scatter::Nested { between, within },
                findings: Vec::new(),
            })
        }
        (None, Some(_), None) => Err(unusable(
            "--within",
            "the standard deviation between the impacts of a fruit is needed beside --between",
        )),
        (None, None, Some(_)) => Err(unusable(
            "--between",
            "the standard deviation between fruit is needed beside --within",
        )),
        (None, None, None) => Err(unusable(
            "--sd",
            "how much the measurements scatter is not known: give --sd (one value for each \
             fruit), --between and --within (several impacts on a fruit), or a table of earlier \
             impacts: --from TABLE --formula 'y ~ (1 | fruit)'",
        )),
    }
}

fn nested_words(between: &str, within: &str) -> String {
    format!("SD between fruit {between}, between the impacts of a fruit {within}")
}

fn list(sds: &[f64]) -> String {
    let words: Vec<String> = sds.iter().map(|sd| number(*sd)).collect();
    words.join(" and ")
}

/// Standard deviations above zero.
fn sds(option: &str, text: &str, most: usize) -> Result<Vec<f64>, Error> {
    let sds = numbers(option, text)?;
    if sds.len() > most {
        let problem = format!(
            "\"{text}\" holds {} numbers; at most {most} are used",
            sds.len()
        );
        return Err(unusable(option, problem));
    }
    match sds.iter().find(|sd| **sd <= 0.0) {
        None => Ok(sds),
        Some(sd) => Err(unusable(
            option,
            format!(
                "{sd} must be above zero: without scatter any number of fruit would find \
                 anything; take it from earlier impacts (--from TABLE --formula 'y ~ (1 | fruit)') \
                 or from published values"
            ),
        )),
    }
}

/// The standard deviations of a mixed model's intercept and residual.
fn of_table(table: &Path, formula: &str, reading: &ReadingOptions) -> Result<KnownScatter, Error> {
    let request = RegressRequest {
        formula: Some(formula.to_owned()),
        reading: reading.clone(),
        ..RegressRequest::usual(table.to_path_buf(), String::new(), String::new())
    };
    let outcome = match regress(&request)? {
        AnyRegressOutcome::Mixed(outcome) => outcome,
        AnyRegressOutcome::Linear(_) => {
            let problem = "the model does not say which rows are of one fruit: add (1 | COLUMN) \
                           with the column that names the fruit";
            return Err(unusable("--formula", problem));
        }
    };
    let (between, residual) = sds_of(&outcome)?;
    let range = |own: &VarianceOutcome| {
        format!(
            "{} ({} to {})",
            number(own.value),
            number(own.low),
            number(own.high)
        )
    };
    let mut findings = outcome.findings.clone();
    if between.value == 0.0 {
        findings.push(FindingOutcome::new(
            "no-variance-between",
            format!(
                "the table shows no variance between {}: the plan takes impacts on one fruit for \
                 as good as impacts on as many fruit; state --between at the upper end of its \
                 interval, {}, to be safe",
                between.group,
                number(between.high)
            ),
        ));
    }
    Ok(KnownScatter {
        words: format!(
            "{}, of {} by {formula}",
            nested_words(&range(between), &range(residual)),
            table.display()
        ),
        scatter: Scatter::Nested {
            between: vec![between.value],
            within: residual.value,
        },
        findings,
    })
}

/// The standard deviation of the mean between fruit, and of the residual.
fn sds_of(outcome: &MixedOutcome) -> Result<(&VarianceOutcome, &VarianceOutcome), Error> {
    let sds = outcome.variances.iter().filter(|own| own.kind == "sd");
    let (residual, random): (Vec<_>, Vec<_>) = sds.partition(|own| own.group == "residual");
    match (&random[..], &residual[..]) {
        ([between], [residual]) if between.of == "(Intercept)" => Ok((between, residual)),
        _ => Err(unusable(
            "--formula",
            "one random part with the mean of each fruit is expected, (1 | fruit); models with \
             slopes that vary or several groups are planned by `windfall plan model`",
        )),
    }
}
