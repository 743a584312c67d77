//! `windfall compare`: groups of a table against each other.

use crate::compare::compact_letters::compact_letters;
use crate::compare::figures::draw_comparison;
use crate::compare::group_outcome::{missing_findings, row_count, statistics_error, summaries};
use crate::compare::outcome::{CompareOutcome, LetteredGroup, PairOutcome, StatisticTest};
use crate::compare::pairs::{PairMethod, compare_paired, compare_pairs, shared};
use crate::compare::specimens::{specimen_column, specimen_means};
use crate::compare::summary::check_confidence;
#[cfg(feature = "clap")]
use crate::option_words::trimmed;
use crate::reading::ReadingOptions;
use crate::regress::findings::finding;
use crate::rows::RowCount;
use std::path::PathBuf;
use windfall_draw::files::FigureFolder;
use windfall_files::error::Error;
use windfall_files::found::FindingOutcome;
use windfall_files::option_value::unusable;
use windfall_files::table::data::{Data, DataFile, Wanted, open_data};
use windfall_files::text::number::p_value;
use windfall_files::write_file::check_outputs;
use windfall_statistics::accurate_sum::mean;
use windfall_statistics::compare::equal_variance::{bartlett, brown_forsythe, levene};
use windfall_statistics::compare::group_summary::{Group, GroupSummary, Groups, split_groups};
use windfall_statistics::compare::one_way_anova::{FTest, one_way_anova, welch_anova};
use windfall_statistics::residuals::normality::shapiro_wilk;

/// Most groups that are compared: of these there are half a million pairs.
const MOST_GROUPS: usize = 1_000;

/// What `windfall compare` is asked.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "clap", derive(clap::Args))]
pub struct CompareRequest {
    /// Table with a header line (CSV, Parquet or Arrow), or a folder of Parquet files
    #[cfg_attr(feature = "clap", arg(value_hint = clap::ValueHint::FilePath))]
    pub table: PathBuf,
    /// Column of values
    #[cfg_attr(
        feature = "clap",
        arg(
            long,
            value_name = "COLUMN",
            required_unless_present = "measured",
            requires = "by",
            default_value = "",
            hide_default_value = true
        )
    )]
    pub value: String,
    /// Columns that group the rows, separated by commas
    #[cfg_attr(feature = "clap", arg(long, value_name = "COLUMNS", value_delimiter = ',', value_parser = trimmed))]
    pub by: Vec<String>,
    /// Column of specimens that were measured in every group
    #[cfg_attr(feature = "clap", arg(long, value_name = "COLUMN", requires = "value", conflicts_with_all = ["specimen", "pairs"]))]
    pub paired: Option<String>,
    /// Column of specimens measured several times within a group: their means are compared
    #[cfg_attr(feature = "clap", arg(long, value_name = "COLUMN", requires = "value"))]
    pub specimen: Option<String>,
    /// How pairs of groups are compared
    #[cfg_attr(
        feature = "clap",
        arg(long, value_enum, default_value_t, requires = "value")
    )]
    pub pairs: PairMethod,
    /// Level of all intervals; letters say what differs at one less this
    #[cfg_attr(
        feature = "clap",
        arg(long, default_value_t = 0.95, value_name = "LEVEL")
    )]
    pub confidence: f64,
    /// Groups with every point, or predictions over what was measured
    #[cfg_attr(feature = "clap", command(flatten))]
    pub figures: Option<FigureFolder>,
    /// How the table is read
    #[cfg_attr(feature = "clap", command(flatten))]
    pub reading: ReadingOptions,
}

/// Compares groups of a table.
///
/// # Errors
/// The table cannot be read, a column is not there or holds text, fewer than two
/// groups, too few values, or no specimen that two groups share.
pub fn compare_groups(request: &CompareRequest) -> Result<CompareOutcome, Error> {
    check_confidence(request.confidence)?;
    check_outputs([request.figures.as_ref().map(|own| own.directory.as_path())])?;
    let file = open_data(&request.table)?;
    let wanted = wanted(request, &file);
    let data = request.reading.read_some(file, wanted)?;
    let by: Vec<&str> = request.by.iter().map(String::as_str).collect();
    let mut groups =
        split_groups(&data.table, &by, &request.value).map_err(|error| data.told(error))?;
    let count = row_count(&groups);
    let mut findings = missing_findings(&groups, &request.value, &request.by, &data.lines);
    findings.extend(data.left_out_finding());
    findings.extend(drop_empty(&mut groups));
    if groups.groups.len() < 2 {
        let found = groups.groups.first().map(|group| group.levels.join(", "));
        return Err(unusable(
            "--by",
            format!(
                "{} has one group with values ({}); a comparison needs at least two",
                request.by.join(", "),
                found.unwrap_or_else(|| "none".to_owned())
            ),
        ));
    }
    if groups.groups.len() > MOST_GROUPS {
        return Err(unusable(
            "--by",
            format!(
                "{} makes {} groups, and at most {MOST_GROUPS} are compared in pairs: is it a \
                 number of fruit? Name what they belong to, and the fruit with --specimen",
                request.by.join(", "),
                groups.groups.len()
            ),
        ));
    }
    let mut outcome = match (&request.paired, &request.specimen) {
        (Some(column), _) => paired_outcome(request, &data, &groups, column, findings),
        (None, Some(column)) => {
            let means = specimen_means(&data, &groups, column)?;
            findings.extend(averaged_finding(&groups, &means, column));
            let groups: Vec<Group> = groups
                .groups
                .iter()
                .zip(&means)
                .map(|(group, means)| Group {
                    values: means.iter().map(|(_, value)| *value).collect(),
                    ..group.clone()
                })
                .collect();
            unpaired_outcome(request, &groups, findings)
        }
        (None, None) => {
            findings.extend(repeated_finding(&data, &groups)?);
            unpaired_outcome(request, &groups.groups, findings)
        }
    }?;
    outcome.count = count;
    if let Some(folder) = &request.figures {
        let specimen = request.paired.as_deref().or(request.specimen.as_deref());
        draw_comparison(folder, &data, &groups, specimen, &outcome)?;
    }
    Ok(outcome)
}

/// Columns that a comparison needs.
fn wanted(request: &CompareRequest, file: &DataFile) -> Wanted {
    let specimens = request.paired.iter().chain(&request.specimen);
    let told = specimen_column(&file.names()).map(str::to_owned);
    let value = std::iter::once(&request.value);
    Wanted {
        named: value
            .chain(&request.by)
            .chain(specimens)
            .cloned()
            .chain(told)
            .collect(),
        all: request.figures.is_some(),
        ..Wanted::default()
    }
}

fn drop_empty(groups: &mut Groups) -> Option<FindingOutcome> {
    let empty = groups.groups.iter().filter(|group| group.values.is_empty());
    let empty: Vec<String> = empty.map(|group| group.levels.join(", ")).collect();
    groups.groups.retain(|group| !group.values.is_empty());
    (!empty.is_empty()).then(|| {
        finding(
            "empty",
            format!("no value in {}, left out", empty.join("; ")),
        )
    })
}

/// Groups of independent values.
fn unpaired_outcome(
    request: &CompareRequest,
    groups: &[Group],
    mut findings: Vec<FindingOutcome>,
) -> Result<CompareOutcome, Error> {
    let described = summaries(groups, request.confidence)?;
    let names: Vec<String> = described.iter().map(|group| group.group.clone()).collect();
    let values: Vec<Vec<f64>> = groups.iter().map(|group| group.values.clone()).collect();
    let anova = one_way_anova(&values).map_err(statistics_error)?;
    let (pairs, method) = compare_pairs(&names, &values, request.pairs, request.confidence)?;
    let residuals: Vec<f64> = values
        .iter()
        .flat_map(|group| {
            let centre = mean(group).value();
            group.iter().map(move |value| value - centre)
        })
        .collect();
    // Of a single value there is no variance: it stops no test of the others.
    let several = values.iter().filter(|group| group.len() > 1);
    let several: Vec<Vec<f64>> = several.cloned().collect();
    let brown_forsythe = brown_forsythe(&values).ok();
    let shapiro_wilk = shapiro_of(&residuals);
    findings.extend(variance_finding(brown_forsythe, request));
    findings.extend(normality_finding(
        shapiro_wilk,
        "values about their group means",
    ));
    findings.extend(single_finding(&names, &values));
    let letters = letters_of(&names, groups, &pairs, request.confidence);
    Ok(CompareOutcome {
        value: request.value.clone(),
        by: request.by.clone(),
        paired: None,
        count: RowCount::default(),
        confidence: request.confidence,
        groups: lettered(described, letters),
        anova: Some(anova),
        welch: welch_anova(&several).ok(),
        levene: levene(&values).ok(),
        brown_forsythe,
        bartlett: bartlett(&values).ok().map(|test| StatisticTest {
            statistic: test.statistic,
            df: Some(test.df),
            p: test.p,
        }),
        shapiro_wilk,
        method,
        pairs,
        findings,
    })
}

/// The same specimens in every group.
fn paired_outcome(
    request: &CompareRequest,
    data: &Data,
    groups: &Groups,
    column: &str,
    mut findings: Vec<FindingOutcome>,
) -> Result<CompareOutcome, Error> {
    let described = summaries(&groups.groups, request.confidence)?;
    let names: Vec<String> = described.iter().map(|group| group.group.clone()).collect();
    let means = specimen_means(data, groups, column)?;
    findings.extend(averaged_finding(groups, &means, column));
    findings.extend(partner_finding(&means, column));
    let pairs = compare_paired(&names, &means, request.confidence)?;
    let differences: Vec<f64> = match means.as_slice() {
        [first, second] => {
            let (a, b) = shared(first, second);
            a.iter().zip(&b).map(|(a, b)| b - a).collect()
        }
        _ => Vec::new(),
    };
    let shapiro_wilk = shapiro_of(&differences);
    findings.extend(normality_finding(shapiro_wilk, "differences of pairs"));
    if names.len() > 2 {
        findings.push(finding(
            "mixed-model",
            format!(
                "{} groups of the same specimens: a mixed model uses all of them at once \
                 (windfall regress --random {column})",
                names.len()
            ),
        ));
    }
    let letters = letters_of(&names, &groups.groups, &pairs, request.confidence);
    Ok(CompareOutcome {
        value: request.value.clone(),
        by: request.by.clone(),
        paired: Some(column.to_owned()),
        count: RowCount::default(),
        confidence: request.confidence,
        groups: lettered(described, letters),
        anova: None,
        welch: None,
        levene: None,
        brown_forsythe: None,
        bartlett: None,
        shapiro_wilk,
        method: match names.len() {
            2 => "paired t test",
            _ => "paired t tests, p by Holm, intervals by Bonferroni",
        },
        pairs,
        findings,
    })
}

fn averaged_finding(
    groups: &Groups,
    means: &[Vec<(String, f64)>],
    column: &str,
) -> Option<FindingOutcome> {
    let rows: usize = groups.groups.iter().map(|group| group.values.len()).sum();
    let kept: usize = means.iter().map(Vec::len).sum();
    (kept < rows).then(|| {
        finding(
            "averaged",
            format!("{rows} values were averaged to {kept}, one per {column} and group"),
        )
    })
}

/// Specimens that are not in every group.
fn partner_finding(means: &[Vec<(String, f64)>], column: &str) -> Option<FindingOutcome> {
    let mut all: Vec<&String> = means.iter().flatten().map(|(name, _)| name).collect();
    all.sort_unstable();
    let alone: Vec<&str> = all
        .chunk_by(|a, b| a == b)
        .filter(|same| same.len() < means.len())
        .map(|same| same[0].as_str())
        .collect();
    (!alone.is_empty()).then(|| {
        let shown: Vec<&str> = alone.iter().take(8).copied().collect();
        let more = if alone.len() > 8 { ", …" } else { "" };
        finding(
            "unpaired",
            format!(
                "{} of {column} are not in every group and are left out of pairs without them: {}{more}",
                alone.len(),
                shown.join(", ")
            ),
        )
    })
}

/// Rows that look like repeats of one specimen.
fn repeated_finding(data: &Data, groups: &Groups) -> Result<Option<FindingOutcome>, Error> {
    let names = data.names();
    let Some(name) = specimen_column(&names) else {
        return Ok(None);
    };
    let means = specimen_means(data, groups, name)?;
    let rows: usize = groups.groups.iter().map(|group| group.values.len()).sum();
    let within: usize = means.iter().map(Vec::len).sum();
    let mut names: Vec<&String> = means.iter().flatten().map(|(name, _)| name).collect();
    names.sort_unstable();
    names.dedup();
    if names.is_empty() {
        return Ok(None);
    }
    if within < rows {
        return Ok(Some(finding(
            "repeated-specimens",
            format!(
                "{rows} values are of {within} {name} within groups: they are not independent, and \
                 p-values and intervals here are too small; compare their means with --specimen \
                 {name}, or use a mixed model: windfall regress --random {name}"
            ),
        )));
    }
    Ok((names.len() < within).then(|| {
        finding(
            "shared-specimens",
            format!(
                "the same names of {name} stand in several groups: if they are the same {name}, \
                 compare with --paired {name}"
            ),
        )
    }))
}

/// p below which a test of an assumption is worth a word.
const NOTABLE: f64 = 0.05;

fn variance_finding(test: Option<FTest>, request: &CompareRequest) -> Option<FindingOutcome> {
    let p = test.map(|test| test.p).filter(|p| *p < NOTABLE)?;
    let advice = match request.pairs {
        PairMethod::Tukey => "read Welch's test and --pairs games-howell",
        _ => "read Welch's test rather than the analysis of variance",
    };
    Some(finding(
        "unequal-variances",
        format!(
            "the groups' variances differ (Brown-Forsythe, {}): {advice}",
            p_value(p)
        ),
    ))
}

fn normality_finding(test: Option<StatisticTest>, what: &str) -> Option<FindingOutcome> {
    let p = test.map(|test| test.p).filter(|p| *p < NOTABLE)?;
    Some(finding(
        "not-normal",
        format!(
            "the {what} are not normal (Shapiro-Wilk, {}); look for outliers or skew",
            p_value(p)
        ),
    ))
}

fn single_finding(names: &[String], groups: &[Vec<f64>]) -> Option<FindingOutcome> {
    let single: Vec<&str> = names
        .iter()
        .zip(groups)
        .filter(|(_, group)| group.len() < 2)
        .map(|(name, _)| name.as_str())
        .collect();
    (!single.is_empty()).then(|| {
        finding(
            "single",
            format!(
                "one value only in {}: without a variance of its own it is left out of Welch's \
                 test and of pairs that need one",
                single.join("; ")
            ),
        )
    })
}

fn shapiro_of(values: &[f64]) -> Option<StatisticTest> {
    shapiro_wilk(values).ok().map(|test| StatisticTest {
        statistic: test.statistic,
        df: None,
        p: test.p,
    })
}

fn letters_of(
    names: &[String],
    groups: &[Group],
    pairs: &[PairOutcome],
    confidence: f64,
) -> Vec<String> {
    let means: Vec<f64> = groups.iter().map(|g| mean(&g.values).value()).collect();
    let place = |name: &String| names.iter().position(|other| other == name);
    let differ: Vec<(usize, usize)> = pairs
        .iter()
        .filter(|pair| pair.p < 1.0 - confidence)
        .filter_map(|pair| Some((place(&pair.first)?, place(&pair.second)?)))
        .collect();
    compact_letters(&means, &differ)
}

fn lettered(groups: Vec<GroupSummary>, letters: Vec<String>) -> Vec<LetteredGroup> {
    let both = groups.into_iter().zip(letters);
    both.map(|(group, letters)| LetteredGroup { group, letters })
        .collect()
}
