//! Covariates of a population from the columns of impacts.csv and
//! specimens.csv.

use windfall_campaign::settings::model::{ImpactCampaign, ImpactEntry};
use windfall_files::error::{Error, Place};
use windfall_files::name::Name;
use windfall_files::option_value::unusable;
use windfall_files::text::toml_source::suggestion;
use windfall_identify::population::model::Covariate;

/// The velocity at first touch, measured or fitted; m/s.
pub const IMPACT_VELOCITY: &str = "impact_velocity";

/// A column, or its logarithm.
#[derive(Clone, Debug, PartialEq, Eq)]
struct Asked<'a> {
    text: &'a str,
    column: &'a str,
    logarithm: bool,
}

/// What the tables say of one covariate, by impact.
#[derive(Clone, Debug, PartialEq)]
enum Cells {
    /// Numbers; none where the cell is blank.
    Numbers(Vec<Option<f64>>),
    /// Words; none where the cell is blank.
    Words(Vec<Option<String>>),
}

/// Covariates at the impacts that have all of them.
#[derive(Clone, Debug, PartialEq)]
pub struct CovariatesFound {
    /// Covariates, an indicator for each word but the first of a column of words.
    pub covariates: Vec<Covariate>,
    /// Positions of the impacts that have all of them.
    pub kept: Vec<usize>,
    /// Positions of the others, with the missing values.
    pub left_out: Vec<(usize, String)>,
}

/// Reads `asked` (a column, `log(column)`, or either of `impact_velocity`) for
/// the impacts `entries` with velocities at first touch `velocities`. Numbers are
/// centred at their mean over the impacts.
///
/// # Errors
/// A column that neither table has; a cell that is no number in a column of
/// numbers, or not above zero under a logarithm.
pub fn find_covariates(
    campaign: &ImpactCampaign,
    entries: &[&ImpactEntry],
    velocities: &[f64],
    asked: &[String],
) -> Result<CovariatesFound, Error> {
    let wanted: Vec<Asked> = asked.iter().map(|text| parse(text)).collect();
    let cells: Result<Vec<Cells>, Error> = wanted
        .iter()
        .map(|asked| cells(campaign, entries, velocities, asked))
        .collect();
    let cells = cells?;
    let (mut kept, mut left_out) = (Vec::new(), Vec::new());
    for i in 0..entries.len() {
        let blank = |cells: &Cells| match cells {
            Cells::Numbers(values) => values[i].is_none(),
            Cells::Words(words) => words[i].is_none(),
        };
        match wanted.iter().zip(&cells).find(|(_, cells)| blank(cells)) {
            Some((asked, _)) => {
                let line = entries[i].line;
                let column = asked.column;
                left_out.push((
                    i,
                    format!("the covariate {column} has no value (impacts.csv, line {line}, or its specimen's line in specimens.csv)"),
                ));
            }
            None => kept.push(i),
        }
    }
    let mut covariates = Vec::new();
    for (asked, cells) in wanted.iter().zip(&cells) {
        match cells {
            Cells::Numbers(values) => covariates.push(numbers(asked.text, values, &kept)),
            Cells::Words(words) => covariates.extend(indicators(asked.column, words, &kept)),
        }
    }
    Ok(CovariatesFound {
        covariates,
        kept,
        left_out,
    })
}

fn parse(text: &str) -> Asked<'_> {
    let text = text.trim();
    let inner = text
        .strip_prefix("log(")
        .and_then(|rest| rest.strip_suffix(')'));
    Asked {
        text,
        column: inner.map_or(text, str::trim),
        logarithm: inner.is_some(),
    }
}

fn numbers(name: &str, values: &[Option<f64>], kept: &[usize]) -> Covariate {
    let values: Vec<f64> = kept.iter().filter_map(|&i| values[i]).collect();
    Covariate {
        name: name.to_owned(),
        centre: values.iter().sum::<f64>() / values.len().max(1) as f64,
        values,
    }
}

fn indicators(column: &str, words: &[Option<String>], kept: &[usize]) -> Vec<Covariate> {
    let own: Vec<&str> = kept.iter().filter_map(|&i| words[i].as_deref()).collect();
    let mut levels: Vec<&str> = own.clone();
    levels.sort_unstable();
    levels.dedup();
    let indicator = |level: &&str| Covariate {
        name: format!("{column}={level}"),
        centre: 0.0,
        values: own
            .iter()
            .map(|word| f64::from(u8::from(word == level)))
            .collect(),
    };
    levels.iter().skip(1).map(indicator).collect()
}

fn cells(
    campaign: &ImpactCampaign,
    entries: &[&ImpactEntry],
    velocities: &[f64],
    asked: &Asked,
) -> Result<Cells, Error> {
    let logarithm = |value: f64| match asked.logarithm {
        true => value.ln(),
        false => value,
    };
    let texts: Vec<Option<(&str, Place)>> = entries
        .iter()
        .map(|entry| cell(campaign, entry, asked.column))
        .collect();
    let known = texts.iter().any(Option::is_some);
    if !known && asked.column == IMPACT_VELOCITY {
        let values = velocities.iter().map(|v| logarithm(*v));
        let values = values.map(|value| value.is_finite().then_some(value));
        return Ok(Cells::Numbers(values.collect()));
    }
    if !known {
        return Err(no_column(campaign, entries, asked));
    }
    let filled = |text: &Option<(&str, Place)>| matches!(text, Some((cell, _)) if !cell.is_empty());
    let any_number = texts
        .iter()
        .flatten()
        .any(|(cell, _)| cell.parse::<f64>().is_ok());
    if !any_number && !asked.logarithm {
        let words = texts.into_iter().map(|text| match filled(&text) {
            true => text.map(|(cell, _)| cell.to_owned()),
            false => None,
        });
        return Ok(Cells::Words(words.collect()));
    }
    let number = |text: Option<(&str, Place)>| match text {
        Some((cell, place)) if !cell.is_empty() => match cell.parse::<f64>() {
            Ok(value) if value.is_finite() && (value > 0.0 || !asked.logarithm) => {
                Ok(Some(logarithm(value)))
            }
            _ => Err(Error::CellNotNumber {
                place,
                column: asked.column.to_owned(),
                text: cell.to_owned(),
                hint: match asked.logarithm {
                    true => " (a logarithm needs a number above zero)",
                    false => "",
                },
            }),
        },
        _ => Ok(None),
    };
    let values: Result<Vec<Option<f64>>, Error> = texts.into_iter().map(number).collect();
    Ok(Cells::Numbers(values?))
}

/// The cell of an impact, or of its specimen, with where it stands.
fn cell<'a>(
    campaign: &'a ImpactCampaign,
    entry: &'a ImpactEntry,
    column: &str,
) -> Option<(&'a str, Place)> {
    let find = |cells: &'a [(Name, String)]| {
        let found = cells.iter().find(|(name, _)| *name == *column);
        found.map(|(_, cell)| cell.trim())
    };
    let place = |file: &str, line| Place::at(&campaign.shared.directory.join(file), line);
    if let Some(found) = find(&entry.cells) {
        return Some((found, place("impacts.csv", entry.line)));
    }
    let specimen = campaign
        .shared
        .specimens
        .iter()
        .find(|s| s.id == entry.specimen)?;
    find(&specimen.cells).map(|found| (found, place("specimens.csv", specimen.line)))
}

fn no_column(campaign: &ImpactCampaign, entries: &[&ImpactEntry], asked: &Asked) -> Error {
    let specimen = campaign
        .shared
        .specimens
        .first()
        .map_or(&[][..], |s| &s.cells);
    let entry = entries.first().map_or(&[][..], |entry| &entry.cells);
    let mut names: Vec<&str> = vec![IMPACT_VELOCITY];
    names.extend(specimen.iter().chain(entry).map(|(name, _)| name.as_str()));
    unusable(
        format!("covariate {}", asked.text),
        format!(
            "neither specimens.csv nor impacts.csv has the column \"{}\"{}; there are: {}",
            asked.column,
            suggestion(asked.column, names.iter().copied()),
            names.join(", ")
        ),
    )
}
