//! Groups with every point, their means and intervals.

use crate::figures::thinning::{DrawnRows, aside, drawn_rows};
use crate::figures::words::cell;
use windfall_draw::grid::{GridPanel, Scale};
use windfall_draw::xy::{Panel, Series, Style};
use windfall_files::text::column_title::column_title;

/// Most groups that are drawn.
const MOST_GROUPS: usize = 60;

/// Least and greatest width of a panel, of a group, and of a character of its name; px.
const WIDTHS: (f64, f64) = (250.0, 744.0);
const GROUP: (f64, f64) = (62.0, 124.0);
const CHARACTER: f64 = 6.0;

/// Height of a panel; px.
pub(crate) const HEIGHT: f64 = 220.0;

/// Half the width that the points of a group take up, as a part of the distance of groups.
const HALF: f64 = 0.3;

/// A row of a group.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct GroupPoint {
    /// Its line in the file.
    pub line: usize,
    /// Its value.
    pub value: f64,
    /// Its specimen, by its place in [`GroupPlot::specimens`].
    pub specimen: Option<usize>,
}

/// A group.
#[derive(Clone, Debug, PartialEq)]
pub struct PlottedGroup {
    /// Its name.
    pub name: String,
    /// Groups that share a letter do not differ; "" where they are not compared.
    pub letters: String,
    /// Its rows.
    pub points: Vec<GroupPoint>,
    /// Mean of each specimen that is averaged, by its place.
    pub means: Vec<(usize, f64)>,
    /// Mean of the group.
    pub mean: f64,
    /// Lower end of its interval; NaN where it has none.
    pub low: f64,
    /// Upper end.
    pub high: f64,
    /// Quartiles, where a box is drawn.
    pub quartiles: Option<[f64; 3]>,
}

/// What is drawn.
#[derive(Clone, Debug, PartialEq)]
pub struct GroupPlot {
    /// Column of the values.
    pub value: String,
    /// Columns that group the rows.
    pub by: Vec<String>,
    /// The groups.
    pub groups: Vec<PlottedGroup>,
    /// Column of the specimens, and their names.
    pub specimens: Option<(String, Vec<String>)>,
    /// Whether the means of one specimen are joined from group to group.
    pub joined: bool,
    /// The interval in words: "95 % interval".
    pub interval: String,
}

/// Panels with what a reader must know and the numbers that they show.
#[derive(Clone, Debug, PartialEq)]
pub struct DrawnGroups {
    /// So many groups in each as have room, all with one scale.
    pub panels: Vec<GridPanel>,
    /// Width of each; px.
    pub width: f64,
    /// Notes.
    pub notes: Vec<String>,
    /// Rows of the table beside the figure, without their header [`HEADER`].
    pub rows: Vec<Vec<String>>,
}

/// Columns of the table beside a figure of groups.
pub const HEADER: [&str; 8] = [
    "kind", "group", "line", "specimen", "value", "low", "high", "letters",
];

/// Draws groups.
pub fn draw_groups(own: &GroupPlot) -> DrawnGroups {
    let shown = &own.groups[..own.groups.len().min(MOST_GROUPS)];
    let all: Vec<(usize, usize)> = shown
        .iter()
        .enumerate()
        .flat_map(|(place, group)| (0..group.points.len()).map(move |row| (place, row)))
        .collect();
    let away = |row: usize| {
        let (place, row) = all[row];
        (shown[place].points[row].value - shown[place].mean).abs()
    };
    let DrawnRows { rows, note } = drawn_rows(
        all.len(),
        &[("distances from the mean of their group", &away)],
    );
    let mut drawn: Vec<Vec<GroupPoint>> = vec![Vec::new(); shown.len()];
    for row in rows {
        let (place, row) = all[row];
        drawn[place].push(shown[place].points[row]);
    }
    let mut notes: Vec<String> = note.into_iter().collect();
    if own.groups.len() > MOST_GROUPS {
        notes.push(format!(
            "{} of {} groups are drawn.",
            shown.len(),
            own.groups.len()
        ));
    }
    if let Some((column, _)) = &own.specimens {
        notes.extend(match own.joined {
            true => Some(format!("Thin lines join the means of one {column}.")),
            false => drawn
                .iter()
                .any(|points| has_repeats(points))
                .then(|| format!("Points of one {column} stand above each other, on a line.")),
        });
    }
    if shown.iter().any(|group| !group.letters.is_empty()) {
        notes.push("Groups that share a letter were not found to differ.".to_owned());
    }
    let up = range_of(shown, &drawn);
    let longest = shown.iter().map(|group| group.name.chars().count()).max();
    let step = (CHARACTER * longest.unwrap_or(0) as f64 + 8.0).clamp(GROUP.0, GROUP.1);
    let in_panel = ((WIDTHS.1 / step) as usize).max(1);
    let pieces = shown.chunks(in_panel).zip(drawn.chunks(in_panel));
    let panels: Vec<GridPanel> = pieces
        .map(|(groups, drawn)| panel_of(own, groups, drawn, up))
        .collect();
    let widest = shown.len().min(in_panel) as f64 * step;
    DrawnGroups {
        panels,
        width: widest.max(WIDTHS.0),
        notes,
        rows: rows_of(own, shown, &drawn),
    }
}

/// Whether a specimen has several points.
fn has_repeats(points: &[GroupPoint]) -> bool {
    let mut known: Vec<usize> = points.iter().filter_map(|own| own.specimen).collect();
    known.sort_unstable();
    known.windows(2).any(|pair| pair[0] == pair[1])
}

/// Ends of the values with room for letters above them.
fn range_of(groups: &[PlottedGroup], drawn: &[Vec<GroupPoint>]) -> (f64, f64) {
    let points = drawn.iter().flatten().map(|point| point.value);
    let ends = groups
        .iter()
        .flat_map(|group| [group.low, group.high, group.mean]);
    let finite = points.chain(ends).filter(|value| value.is_finite());
    let (low, high) = finite.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), value| {
        (low.min(value), high.max(value))
    });
    let range = match high - low {
        range if range > 0.0 => range,
        _ => 0.2 * high.abs().max(1e-300),
    };
    let lettered = groups.iter().any(|group| !group.letters.is_empty());
    let above = if lettered { 0.16 } else { 0.06 };
    (low - 0.06 * range, high + above * range)
}

fn panel_of(
    own: &GroupPlot,
    groups: &[PlottedGroup],
    drawn: &[Vec<GroupPoint>],
    (low, high): (f64, f64),
) -> GridPanel {
    let (y, unit) = column_title(&own.value);
    let places: Vec<Vec<f64>> = drawn.iter().map(|points| places_of(own, points)).collect();
    let dots = drawn.iter().zip(&places).enumerate();
    let dots = dots.flat_map(|(group, (points, places))| {
        let points = points.iter().zip(places);
        points.map(move |(point, place)| (group as f64 + place, point.value))
    });
    let mut series = Vec::new();
    if own.joined {
        series.push(Series::new("", Style::Bars, joined(own, groups)).coloured(5));
    } else {
        series.push(Series::new("", Style::Bars, stems(drawn, &places)).coloured(0));
    }
    series.push(Series::new("", Style::Dots, dots.collect()).coloured(0));
    if let Some((column, _)) = &own.specimens {
        let means = groups.iter().enumerate().flat_map(|(group, found)| {
            let means = found.means.iter();
            means.map(move |(specimen, value)| {
                (group as f64 + specimen_place(own, found, *specimen), *value)
            })
        });
        let means: Vec<(f64, f64)> = means.collect();
        if !means.is_empty() {
            let label = format!("mean of each {column}");
            series.push(Series::new(label, Style::Dots, means).coloured(2));
        }
    }
    let boxes = groups.iter().enumerate();
    for (group, quartiles) in boxes.filter_map(|(place, own)| Some((place, own.quartiles?))) {
        let (left, right) = (group as f64 - HALF - 0.06, group as f64 + HALF + 0.06);
        let [first, median, third] = quartiles;
        let around = [(left, first), (right, first), (right, third), (left, third)];
        let closed = around.iter().chain(&around[..1]).copied().collect();
        series.push(Series::new("", Style::Line, closed).coloured(6));
        let label = if group == 0 {
            "quartiles and median"
        } else {
            ""
        };
        let line = vec![(left, median), (right, median)];
        series.push(Series::new(label, Style::Line, line).coloured(6));
    }
    let intervals = groups.iter().enumerate();
    let intervals = intervals.filter(|(_, own)| own.low.is_finite() && own.high.is_finite());
    let intervals =
        intervals.flat_map(|(place, own)| [(place as f64, own.low), (place as f64, own.high)]);
    series.push(Series::new("", Style::ThickBars, intervals.collect()).coloured(1));
    let means = groups.iter().enumerate();
    let means = means.map(|(place, own)| (place as f64, own.mean)).collect();
    let label = format!("mean with {}", own.interval);
    series.push(Series::new(label, Style::Spots, means).coloured(1));
    let x = own.by.iter().map(|column| column_title(column).0);
    let x = x.collect::<Vec<_>>().join(", ");
    let mut panel = GridPanel::new("", Panel::new((&x, ""), (&y, &unit), series));
    panel.across = Scale::Names(groups.iter().map(|group| group.name.clone()).collect());
    if low < high {
        panel.up = Scale::Between(low, high);
    }
    let top = high - 0.05 * (high - low);
    let letters = groups.iter().enumerate();
    let letters = letters.map(|(place, group)| ((place as f64, top), group.letters.clone()));
    panel.texts = letters.filter(|(_, text)| !text.is_empty()).collect();
    panel.empty = "no group has a value".to_owned();
    panel
}

/// Where the points of a group stand beside its middle.
fn places_of(own: &GroupPlot, points: &[GroupPoint]) -> Vec<f64> {
    let mut known: Vec<usize> = points.iter().filter_map(|own| own.specimen).collect();
    known.sort_unstable();
    known.dedup();
    let place = |(n, point): (usize, &GroupPoint)| match point.specimen {
        Some(specimen) if own.joined => spread(specimen, specimens(own)),
        Some(specimen) => spread(known.binary_search(&specimen).unwrap_or(0), known.len()),
        None => HALF * aside(n),
    };
    points.iter().enumerate().map(place).collect()
}

fn specimens(own: &GroupPlot) -> usize {
    own.specimens.as_ref().map_or(1, |(_, names)| names.len())
}

/// Place of one of several from left to right.
fn spread(place: usize, count: usize) -> f64 {
    HALF * (2.0 * (place as f64 + 0.5) / count.max(1) as f64 - 1.0)
}

/// Where the mean of a specimen stands beside the middle of its group.
fn specimen_place(own: &GroupPlot, group: &PlottedGroup, specimen: usize) -> f64 {
    if own.joined {
        return spread(specimen, specimens(own));
    }
    let place = group.means.binary_search_by(|mean| mean.0.cmp(&specimen));
    spread(place.unwrap_or(0), group.means.len())
}

/// Lines from the lowest to the highest point of each specimen.
fn stems(drawn: &[Vec<GroupPoint>], places: &[Vec<f64>]) -> Vec<(f64, f64)> {
    let mut lines = Vec::new();
    for (group, (points, places)) in drawn.iter().zip(places).enumerate() {
        let mut named: Vec<(usize, f64, f64)> = points
            .iter()
            .zip(places)
            .filter_map(|(point, place)| Some((point.specimen?, *place, point.value)))
            .collect();
        named.sort_by(|a, b| a.0.cmp(&b.0).then(a.2.total_cmp(&b.2)));
        for same in named.chunk_by(|a, b| a.0 == b.0) {
            let (first, last) = (same[0], same[same.len() - 1]);
            let x = group as f64 + first.1;
            lines.extend([(x, first.2), (x, last.2)]);
        }
    }
    lines
}

/// Lines between the means of one specimen in neighbouring groups.
fn joined(own: &GroupPlot, groups: &[PlottedGroup]) -> Vec<(f64, f64)> {
    let mut lines = Vec::new();
    for (place, pair) in groups.windows(2).enumerate() {
        for (specimen, value) in &pair[0].means {
            let other = pair[1].means.binary_search_by(|mean| mean.0.cmp(specimen));
            if let Ok(other) = other {
                let x = place as f64 + spread(*specimen, specimens(own));
                lines.extend([(x, *value), (x + 1.0, pair[1].means[other].1)]);
            }
        }
    }
    lines
}

fn rows_of(
    own: &GroupPlot,
    groups: &[PlottedGroup],
    drawn: &[Vec<GroupPoint>],
) -> Vec<Vec<String>> {
    let name = |specimen: Option<usize>| {
        let names = own.specimens.as_ref().map(|(_, names)| names);
        let found = names.and_then(|names| names.get(specimen?));
        found.cloned().unwrap_or_default()
    };
    let row = |kind: &str, group: &PlottedGroup, line: String, specimen, numbers: [f64; 3]| {
        let mut row = vec![kind.to_owned(), group.name.clone(), line, name(specimen)];
        row.extend(numbers.map(cell));
        row
    };
    let none = f64::NAN;
    let mut rows = Vec::new();
    for (group, points) in groups.iter().zip(drawn) {
        let mut push = |mut cells: Vec<String>, letters: &str| {
            cells.push(letters.to_owned());
            rows.push(cells);
        };
        for point in points {
            let line = point.line.to_string();
            push(
                row(
                    "row",
                    group,
                    line,
                    point.specimen,
                    [point.value, none, none],
                ),
                "",
            );
        }
        for (specimen, value) in &group.means {
            let numbers = [*value, none, none];
            push(
                row("specimen", group, String::new(), Some(*specimen), numbers),
                "",
            );
        }
        if let Some([first, median, third]) = group.quartiles {
            let numbers = [median, first, third];
            push(row("median", group, String::new(), None, numbers), "");
        }
        let numbers = [group.mean, group.low, group.high];
        push(
            row("mean", group, String::new(), None, numbers),
            &group.letters,
        );
    }
    rows
}
