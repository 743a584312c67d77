//! Marginal means, slopes and comparisons of a fitted model.

use crate::regress::findings::finding;
use crate::regress::means::outcome::{
    DifferenceOutcome, EqualityOutcome, MeanOutcome, MeansOutcome, OnScale,
};
use crate::regress::means::request::{Columns, MeansRequest, Which};
use nalgebra::DMatrix;
use windfall_files::error::Error;
use windfall_files::found::FindingOutcome;
use windfall_files::option_value::unusable;
use windfall_mixed::coefficient::Estimated;
use windfall_statistics::model::formula_syntax::Node;
use windfall_statistics::model::marginal_means::{Asked, MarginalRows, marginal_rows, slope_rows};
use windfall_statistics::model::mean_contrasts::{
    Adjustment, Comparison, JointTest, MeanContrast, compared, interval,
};
use windfall_statistics::model::model_frame::{ModelFrame, chosen_rows};
use windfall_statistics::model::original_scale::{OriginalScale, meaning};
use windfall_statistics::model::reduced::Aliased;
use windfall_statistics::runs::Runs;
use windfall_statistics::table::Table;

/// Most comparisons whose joint distribution is found.
const MOST_JOINT: usize = 500;

/// What means of a model are made from.
pub(crate) struct Model<'a> {
    /// Its columns.
    pub frame: &'a ModelFrame,
    /// Columns without an estimate.
    pub aliased: &'a [Aliased],
    /// Rows that it was fitted to.
    pub table: &'a Table,
    /// Which rows of the table these are.
    pub kept: &'a Runs,
    /// What is modelled.
    pub response: Option<&'a Node>,
    /// Estimate of a sum of all its columns.
    pub estimate: &'a dyn Fn(&[f64]) -> Estimated,
    /// Covariance of such sums, a row each.
    pub covariance: &'a dyn Fn(&DMatrix<f64>) -> DMatrix<f64>,
    /// Test that independent sums are all zero.
    pub test: &'a dyn Fn(&DMatrix<f64>) -> Option<JointTest>,
}

/// Means and slopes that were asked for, with what a reader must know of them.
///
/// # Errors
/// A column is no category of the model, or stands there twice; no mean is determined by the
/// rows; comparisons that the means do not have.
pub(crate) fn means_of(
    model: &Model,
    request: &MeansRequest,
    confidence: f64,
) -> Result<(Vec<MeansOutcome>, Vec<FindingOutcome>), Error> {
    let (columns, at, which) = (request.columns()?, request.held()?, request.which()?);
    let (adjustment, adjusted) = request.adjustment(&which)?;
    let kept: Vec<usize> = model.kept.iter().collect();
    let asking = Asking {
        model,
        table: &chosen_rows(model.table, &kept),
        at: &at,
        which: &which,
        adjustment,
        adjusted,
        confidence,
    };
    let mut findings = Vec::new();
    let means = columns.iter().map(|own| asking.means(own, &mut findings));
    Ok((means.collect::<Result<_, Error>>()?, findings))
}

struct Asking<'a> {
    model: &'a Model<'a>,
    table: &'a Table,
    at: &'a [(String, f64)],
    which: &'a Which,
    adjustment: Adjustment,
    adjusted: &'static str,
    confidence: f64,
}

/// Means that are compared with each other.
struct Family<'a> {
    within: &'a [String],
    names: Vec<String>,
    rows: DMatrix<f64>,
}

impl Asking<'_> {
    fn means(
        &self,
        columns: &Columns,
        findings: &mut Vec<FindingOutcome>,
    ) -> Result<MeansOutcome, Error> {
        let by: Vec<String> = columns.within.iter().chain(&columns.of).cloned().collect();
        let asked = Asked {
            option: &columns.option,
            by: &by,
            at: self.at,
        };
        let frame = self.model.frame;
        let rows = match &columns.slope {
            Some(number) => slope_rows(frame, self.table, number, asked),
            None => marginal_rows(frame, self.table, asked),
        };
        let rows = rows.map_err(Error::Statistics)?;
        let scale = match columns.slope {
            Some(_) => None,
            None => self.model.response.and_then(|response| {
                let scale = OriginalScale::of(response, self.model.table, self.model.kept)?;
                Some((meaning(&scale, response), scale))
            }),
        };
        let means = self.estimates(columns, &rows, scale.as_ref().map(|own| &own.1), findings)?;
        let (mut differences, mut tests) = (Vec::new(), Vec::new());
        for family in families(columns, &rows) {
            let logarithm = scale.as_ref().map(|own| &own.1);
            let logarithm = logarithm.filter(|own| own.is_logarithm());
            differences.extend(self.differences(columns, &family, logarithm, findings)?);
            tests.extend(self.equality(&family));
        }
        Ok(MeansOutcome {
            slope_on: columns.slope.clone(),
            of: columns.of.clone(),
            within: columns.within.clone(),
            at: rows.held.clone(),
            means,
            original: scale.as_ref().map(|own| own.1.column.clone()),
            meaning: scale.map(|own| own.0),
            compared: match self.which {
                Which::Pairs => "pairs",
                Which::Control(_) => "control",
                Which::Mean => "mean",
                Which::Polynomial => "polynomial",
                Which::Custom(_) => "custom",
            },
            adjusted: self.adjusted,
            differences,
            tests,
        })
    }

    /// Means that the rows determine; others are named.
    fn estimates(
        &self,
        columns: &Columns,
        rows: &MarginalRows,
        scale: Option<&OriginalScale>,
        findings: &mut Vec<FindingOutcome>,
    ) -> Result<Vec<MeanOutcome>, Error> {
        let (mut means, mut without) = (Vec::new(), Vec::new());
        for (levels, row) in rows.groups.iter().zip(rows.rows.row_iter()) {
            let row: Vec<f64> = row.iter().copied().collect();
            if let Some(column) = self.missing(&row) {
                without.push((levels.join(" "), column));
                continue;
            }
            let own = (self.model.estimate)(&row);
            let (low, high) = interval(&own, self.confidence);
            means.push(MeanOutcome {
                levels: levels.clone(),
                mean: own.value,
                se: own.se,
                df: own.df,
                low,
                high,
                original: scale.map(|scale| on_scale(scale, own.value, (low, high))),
            });
        }
        let Some((first, column)) = without.first() else {
            return Ok(means);
        };
        let why = format!(
            "depends on {column}, which has no estimate of its own (no row tells it); ask for \
             fewer categories, or leave out the interaction"
        );
        if means.is_empty() {
            let problem = format!("the mean of {first} cannot be estimated: it {why}");
            return Err(unusable(&columns.option, problem));
        }
        let names: Vec<&str> = without.iter().map(|own| own.0.as_str()).collect();
        findings.push(finding(
            "not-estimable",
            format!(
                "{}: no mean of {}, nor its comparisons: that of {first} {why}",
                columns.option,
                names.join(", ")
            ),
        ));
        Ok(means)
    }

    /// The column without an estimate that a sum rests on otherwise than the columns do on which
    /// that one depends.
    fn missing(&self, row: &[f64]) -> Option<&str> {
        let mut aliased = self.model.aliased.iter();
        let found = aliased.find(|own| !own.agrees(row))?;
        Some(&self.model.frame.names[found.column])
    }

    fn differences(
        &self,
        columns: &Columns,
        family: &Family,
        logarithm: Option<&OriginalScale>,
        findings: &mut Vec<FindingOutcome>,
    ) -> Result<Vec<DifferenceOutcome>, Error> {
        let contrasts = self.contrasts(columns, family)?;
        let mut estimable: Vec<(MeanContrast, Vec<f64>)> = Vec::new();
        for contrast in contrasts {
            let weights = DMatrix::from_row_slice(1, contrast.weights.len(), &contrast.weights);
            let row = (weights * &family.rows).as_slice().to_vec();
            match (self.missing(&row), self.which) {
                (None, _) => estimable.push((contrast, row)),
                // Pairs and controls are named with their means.
                (Some(_), Which::Pairs | Which::Control(_)) => {}
                (Some(column), _) => findings.push(finding(
                    "not-estimable",
                    format!(
                        "{}: {} cannot be estimated: it depends on {column}, which has no \
                         estimate of its own",
                        columns.option, contrast.name
                    ),
                )),
            }
        }
        if estimable.is_empty() {
            return Ok(Vec::new());
        }
        if self.adjustment == Adjustment::MultivariateT && estimable.len() > MOST_JOINT {
            let problem = format!(
                "{} comparisons are more than the {MOST_JOINT} whose joint distribution is \
                 found: give --adjust holm",
                estimable.len()
            );
            return Err(unusable("--adjust", problem));
        }
        let matrix = DMatrix::from_fn(estimable.len(), family.rows.ncols(), |row, column| {
            estimable[row].1[column]
        });
        let estimates: Vec<Estimated> = estimable
            .iter()
            .map(|(_, row)| (self.model.estimate)(row))
            .collect();
        let covariance = match self.adjustment {
            Adjustment::MultivariateT => (self.model.covariance)(&matrix),
            _ => DMatrix::zeros(0, 0),
        };
        let found = compared(
            &estimates,
            family.names.len(),
            &covariance,
            self.adjustment,
            self.confidence,
        );
        let outcomes = found.iter().zip(estimable).map(|(own, (contrast, _))| {
            let ends = (own.low, own.high);
            DifferenceOutcome {
                within: family.within.to_vec(),
                contrast: contrast.name,
                difference: own.difference.value,
                se: own.difference.se,
                df: own.difference.df,
                t: own.t,
                p: own.p,
                low: own.low,
                high: own.high,
                ratio: logarithm.map(|scale| on_scale(scale, own.difference.value, ends)),
            }
        });
        Ok(outcomes.collect())
    }

    fn contrasts(&self, columns: &Columns, family: &Family) -> Result<Vec<MeanContrast>, Error> {
        let names = &family.names;
        let comparison = match self.which {
            Which::Pairs => Comparison::Pairs,
            Which::Mean => Comparison::Mean,
            Which::Control(None) => Comparison::Control(0),
            Which::Control(Some(level)) => {
                let place = names.iter().position(|own| own == level).ok_or_else(|| {
                    let problem = format!(
                        "no row has it in {}: there are {}",
                        columns.of.join(", "),
                        names.join(", ")
                    );
                    unusable(format!("--compare control={level}"), problem)
                })?;
                Comparison::Control(place)
            }
            Which::Polynomial => {
                self.check_order(columns, names)?;
                Comparison::Polynomial
            }
            Which::Custom(sums) => {
                if let Some((name, weights)) = sums.iter().find(|own| own.1.len() != names.len()) {
                    let problem = format!(
                        "{} weights for {} means, in this order: {}",
                        weights.len(),
                        names.len(),
                        names.join(", ")
                    );
                    return Err(unusable(format!("--compare '{name}'"), problem));
                }
                Comparison::Custom(sums.clone())
            }
        };
        Ok(comparison.contrasts(names))
    }

    /// Trends need one category, whose levels have an order.
    fn check_order(&self, columns: &Columns, names: &[String]) -> Result<(), Error> {
        let [category] = &columns.of[..] else {
            let problem = "trends are over the levels of one category: write 'dose | variety'";
            return Err(unusable("--compare polynomial", problem));
        };
        let cells = &self
            .table
            .column(category)
            .map_err(Error::Statistics)?
            .cells;
        match names.len() > 2 && !cells.categories().ordered {
            false => Ok(()),
            true => Err(Error::Statistics(
                windfall_statistics::error::Error::UnorderedLevels {
                    name: category.clone(),
                    levels: names.join(","),
                },
            )),
        }
    }

    /// That all means of a family that can be estimated are equal.
    fn equality(&self, family: &Family) -> Option<EqualityOutcome> {
        let rows = family.rows.row_iter();
        let rows: Vec<Vec<f64>> = rows.map(|row| row.iter().copied().collect()).collect();
        let known = rows.iter().filter(|row| self.missing(row).is_none());
        let known: Vec<&Vec<f64>> = known.collect();
        let (first, others) = known.split_first()?;
        if others.is_empty() {
            return None;
        }
        let less = DMatrix::from_fn(others.len(), first.len(), |row, column| {
            others[row][column] - first[column]
        });
        let test = (self.model.test)(&less)?;
        Some(EqualityOutcome {
            within: family.within.to_vec(),
            f: test.f,
            df: test.df,
            df_denominator: test.df_denominator,
            p: test.p,
        })
    }
}

/// Means that are compared with each other: all that share the levels within which they are.
fn families<'a>(columns: &Columns, rows: &'a MarginalRows) -> Vec<Family<'a>> {
    let outer = columns.within.len();
    let mut found: Vec<Family> = Vec::new();
    let mut first = 0;
    for place in 0..rows.groups.len() {
        let within = &rows.groups[place][..outer];
        let last = rows.groups.get(place + 1).map(|own| &own[..outer]) != Some(within);
        if last {
            let own = first..place + 1;
            found.push(Family {
                within,
                names: own
                    .clone()
                    .map(|own| rows.groups[own][outer..].join(" "))
                    .collect(),
                rows: rows.rows.rows(own.start, own.len()).into_owned(),
            });
            first = place + 1;
        }
    }
    found
}

fn on_scale(scale: &OriginalScale, value: f64, ends: (f64, f64)) -> OnScale {
    let (low, high) = scale.interval(value, ends);
    OnScale {
        value: scale.value(value),
        low,
        high,
    }
}
