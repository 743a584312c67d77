//! Figures of groups, of columns, and of predictions over what was measured.

use crate::compare::outcome::CompareOutcome;
use crate::compare::specimens::{specimen_column, specimen_means, specimen_names};
use crate::figures::distribution::{bins, histogram_panel};
use crate::figures::groups::{
    DrawnGroups, GroupPlot, GroupPoint, HEADER, HEIGHT, PlottedGroup, draw_groups,
};
use crate::figures::words::percent;
use windfall_draw::files::{FigureFolder, Painting, Picture, file_name, write_paintings};
use windfall_draw::grid::Grid;
use windfall_files::error::Error;
use windfall_files::table::data::Data;
use windfall_files::table::write::csv_text;
use windfall_files::text::column_title::column_title;
use windfall_statistics::compare::group_summary::{Group, GroupSummary, Groups};

/// Draws a comparison of groups.
///
/// * `specimen`: column of specimens that are averaged or paired; one that is only called so is
///   found, and its points stand together
///
/// # Errors
/// A figure cannot be written.
pub(crate) fn draw_comparison(
    folder: &FigureFolder,
    data: &Data,
    groups: &Groups,
    specimen: Option<&str>,
    outcome: &CompareOutcome,
) -> Result<(), Error> {
    let names = data.names();
    let column = specimen.or_else(|| specimen_column(&names));
    let specimens = column.map(|column| Specimens::of(data, groups, column));
    let specimens = specimens.transpose()?;
    let plotted = groups.groups.iter().zip(&outcome.groups).enumerate();
    let plotted = plotted.map(|(place, (group, found))| {
        let mut own = plotted_group(data, group, &found.group, specimens.as_ref());
        own.letters.clone_from(&found.letters);
        if let (Some(specimens), true) = (&specimens, specimen.is_some()) {
            own.means.clone_from(&specimens.means[place]);
        }
        own
    });
    let drawn = draw_groups(&GroupPlot {
        value: outcome.value.clone(),
        by: outcome.by.clone(),
        groups: plotted.collect(),
        specimens: specimens.map(|own| (own.column, own.names)),
        joined: outcome.paired.is_some(),
        interval: format!("{} % interval", percent(outcome.confidence)),
    });
    let title = format!(
        "{} by {}",
        column_title(&outcome.value).0,
        outcome.by.join(", ")
    );
    let painting = painting_of("groups", title, Vec::new(), drawn)?;
    write_paintings(folder, &[painting]).map(|_| ())
}

/// Draws a column: its histogram, and its groups with their quartiles.
///
/// # Errors
/// None in practice: the table can be written.
pub(crate) fn summary_painting(
    data: &Data,
    groups: &Groups,
    (value, by): (&str, &[String]),
    described: &[GroupSummary],
    confidence: f64,
) -> Result<Painting, Error> {
    let plotted = groups.groups.iter().zip(described).map(|(group, found)| {
        let mut own = plotted_group(data, group, found, None);
        own.quartiles = Some([found.q1, found.median, found.q3]);
        own
    });
    let mut drawn = draw_groups(&GroupPlot {
        value: value.to_owned(),
        by: by.to_vec(),
        groups: plotted.collect(),
        specimens: None,
        joined: false,
        interval: format!("{} % interval", percent(confidence)),
    });
    let values = groups.groups.iter().flat_map(|group| &group.values);
    let found = bins(&values.copied().collect::<Vec<f64>>());
    let histogram = histogram_panel(value, &found);
    drawn.rows.extend(found.iter().map(|bin| {
        let mut row = vec!["bin".to_owned()];
        row.extend([String::new(), String::new(), String::new()]);
        row.extend([
            bin.count.to_string(),
            bin.low.to_string(),
            bin.high.to_string(),
        ]);
        row.push(String::new());
        row
    }));
    let title = match by {
        [] => column_title(value).0,
        by => format!("{} by {}", column_title(value).0, by.join(", ")),
    };
    painting_of(&format!("summary-{value}"), title, vec![histogram], drawn)
}

fn painting_of(
    name: &str,
    title: String,
    before: Vec<windfall_draw::grid::GridPanel>,
    drawn: DrawnGroups,
) -> Result<Painting, Error> {
    let mut panels = before;
    panels.extend(drawn.panels);
    let beside = panels.len() == 2 && drawn.width <= 330.0;
    let picture = Picture::Grid(Grid {
        title,
        columns: if beside { 2 } else { 1 },
        panels,
        size: (drawn.width, HEIGHT),
        notes: drawn.notes.clone(),
    });
    Ok(Painting {
        name: file_name(name),
        caption: drawn.notes.join(" "),
        picture,
        csv: csv_text(&HEADER.map(str::to_owned), drawn.rows)?,
    })
}

fn plotted_group(
    data: &Data,
    group: &Group,
    found: &GroupSummary,
    specimens: Option<&Specimens>,
) -> PlottedGroup {
    let points = group.rows.iter().zip(&group.values);
    let points = points.map(|(row, value)| GroupPoint {
        line: data.line(*row),
        value: *value,
        specimen: specimens.and_then(|own| own.of_row[*row]),
    });
    PlottedGroup {
        name: found.group.clone(),
        letters: String::new(),
        points: points.collect(),
        means: Vec::new(),
        mean: found.mean,
        low: found.low,
        high: found.high,
        quartiles: None,
    }
}

/// Specimens of a table.
struct Specimens {
    column: String,
    names: Vec<String>,
    /// Place of each row's specimen among the names.
    of_row: Vec<Option<usize>>,
    /// Means of the specimens of each group, by their places.
    means: Vec<Vec<(usize, f64)>>,
}

impl Specimens {
    fn of(data: &Data, groups: &Groups, column: &str) -> Result<Self, Error> {
        let of_row = specimen_names(data, column)?;
        let means = specimen_means(data, groups, column)?;
        let mut names: Vec<String> = means.iter().flatten().map(|own| own.0.clone()).collect();
        names.sort_unstable();
        names.dedup();
        let place = |name: &String| names.binary_search(name).ok();
        let of_group = |means: &Vec<(String, f64)>| {
            let means = means.iter();
            means
                .filter_map(|(name, value)| Some((place(name)?, *value)))
                .collect()
        };
        Ok(Self {
            column: column.to_owned(),
            of_row: of_row.iter().map(|name| place(name.as_ref()?)).collect(),
            means: means.iter().map(of_group).collect(),
            names,
        })
    }
}
