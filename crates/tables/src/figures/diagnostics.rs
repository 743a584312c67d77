//! Residuals of a linear model: panels that show where it fails, and which rows decide.

use crate::figures::quantiles::{
    Held, OrderedValue, QuantileWords, ordered_values, quantile_panel,
};
use crate::figures::smooth::lowess;
use crate::figures::thinning::{drawn_rows, largest};
use crate::figures::words::{cell, percent};
use windfall_draw::files::{Painting, Picture, file_name};
use windfall_draw::grid::{Grid, GridPanel, Scale};
use windfall_draw::xy::{Mark, Panel, Series, Side, Style};
use windfall_files::error::Error;
use windfall_files::table::write::csv_text;
use windfall_files::text::column_title::column_title;
use windfall_statistics::residuals::diagnostics::RowInfluence;

/// Size of a panel; px.
const SIZE: (f64, f64) = (196.0, 176.0);

/// Rows that are named in each panel.
const NAMED: usize = 3;

/// A row with a leverage above this has no residual of its own: it decides alone.
const ALONE: f64 = 1.0 - 1e-10;

/// Residuals of this part of the response are what rounding leaves.
const EXACT: f64 = 1e-12;

/// What the panels show.
#[derive(Clone, Debug, PartialEq)]
pub struct Diagnostics {
    /// The response.
    pub response: String,
    /// Line of each row in the file.
    pub lines: Vec<usize>,
    /// Rows with their residuals and influence.
    pub rows: Vec<RowInfluence>,
    /// Degrees of freedom of the residuals.
    pub df: f64,
    /// Coefficients of the model.
    pub parameters: usize,
    /// Confidence of bands and limits.
    pub confidence: f64,
}

/// What stands in the first place of the grid, and what it has besides.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Arrangement {
    /// Residuals against fitted, quantiles, scale-location, Cook, leverage, order.
    Regression,
    /// Fitted against measured instead of scale-location.
    Surface,
    /// Conditional residuals of a mixed model over their standard deviation: no leverage, and
    /// fitted against measured.
    Mixed,
}

impl Arrangement {
    /// The residuals that are held against each other.
    fn scaled(self) -> &'static str {
        match self {
            Self::Mixed => "scaled residual",
            _ => "studentised residual",
        }
    }
}

/// The panels of a model as one figure, with the numbers of every row that is drawn.
///
/// * `name`: of the files
/// * `more`: panels of the caller, which come last
///
/// # Errors
/// None in practice: the table can be written.
pub fn diagnostics_painting(
    name: &str,
    own: &Diagnostics,
    arrangement: Arrangement,
    more: Vec<GridPanel>,
) -> Result<Painting, Error> {
    let found = Found::of(own, arrangement);
    let (response, _) = column_title(&own.response);
    let mut panels = match arrangement {
        Arrangement::Regression => vec![
            against_fitted(own, &found),
            quantiles(own, &found),
            scale_location(own, &found),
            cook(own, &found),
            leverage(own, &found),
            order(own, &found),
        ],
        Arrangement::Surface => vec![
            fitted_against_measured(own, &found),
            against_fitted(own, &found),
            quantiles(own, &found),
            cook(own, &found),
            leverage(own, &found),
            order(own, &found),
        ],
        Arrangement::Mixed => vec![
            against_fitted(own, &found),
            quantiles(own, &found),
            scale_location(own, &found),
            fitted_against_measured(own, &found),
            order(own, &found),
        ],
    };
    panels.extend(more);
    let notes = notes(own, &found);
    let title = match arrangement {
        Arrangement::Mixed => format!("{response}: conditional residuals"),
        _ => format!("{response}: diagnostics of the model"),
    };
    let grid = Grid {
        title,
        panels,
        columns: 3,
        size: SIZE,
        notes: notes.clone(),
    };
    Ok(Painting {
        name: file_name(name),
        caption: notes.join(" "),
        picture: Picture::Grid(grid),
        csv: csv_of(own, &found)?,
    })
}

/// What several panels need.
struct Found {
    arrangement: Arrangement,
    /// What residuals are held against.
    held: Held,
    drawn: Vec<usize>,
    note: Option<String>,
    /// Residuals over their standard error, and with the variance of the other rows; NaN of rows
    /// that have none.
    standardised: Vec<f64>,
    studentised: Vec<f64>,
    cook: Vec<f64>,
    ordered: Vec<OrderedValue>,
    /// Smooth lines of residuals and of their roots over the fitted values.
    level: Vec<(f64, f64)>,
    spread: Vec<(f64, f64)>,
}

impl Found {
    fn of(own: &Diagnostics, arrangement: Arrangement) -> Self {
        let of = |pick: fn(&RowInfluence) -> f64, least: f64| -> Vec<f64> {
            let rows = own.rows.iter();
            rows.map(|row| match own.df < least || row.leverage >= ALONE {
                true => f64::NAN,
                false => pick(row),
            })
            .collect()
        };
        let standardised = of(|row| row.standardised, 1.0);
        let studentised = of(|row| row.studentised, 2.0);
        let cook = of(|row| row.cook, 1.0);
        let size = |row: usize| own.rows[row].residual.abs();
        let drawn = drawn_rows(
            own.rows.len(),
            &[
                ("residuals", &size),
                ("leverages", &|row| own.rows[row].leverage),
                ("Cook's distances", &|row| cook[row]),
            ],
        );
        let is_drawn = |row: usize| drawn.rows.binary_search(&row).is_ok();
        // A residual is held against the others without it: one degree of freedom less.
        let held = match arrangement {
            Arrangement::Mixed => Held::Normal,
            _ => Held::Student(own.df - 1.0),
        };
        let ordered = ordered_values(&studentised, &is_drawn, held, own.confidence);
        let over = |value: &dyn Fn(usize) -> f64| {
            let rows = 0..own.rows.len();
            let points = rows.map(|row| (own.rows[row].fitted, value(row)));
            let points = points.filter(|(x, y)| x.is_finite() && y.is_finite());
            lowess(&points.collect::<Vec<_>>())
        };
        Self {
            level: over(&|row| own.rows[row].residual),
            arrangement,
            held,
            spread: over(&|row| standardised[row].abs().sqrt()),
            drawn: drawn.rows,
            note: drawn.note,
            standardised,
            studentised,
            cook,
            ordered,
        }
    }

    fn dots(&self, place: &dyn Fn(usize) -> (f64, f64)) -> Series {
        let points = self.drawn.iter().map(|row| place(*row));
        Series::new("", Style::Dots, points.collect()).coloured(0)
    }
}

fn notes(own: &Diagnostics, found: &Found) -> Vec<String> {
    let mut notes = vec!["Numbers at points are lines of the table.".to_owned()];
    let level = percent(own.confidence);
    notes.extend(match found.held {
        Held::Normal => Some(format!(
            "Scaled residual: over the residual standard deviation of its row. Band: {level} % for all rows \
             together, as if independent and normal (equal local levels)."
        )),
        Held::Student(df) if df >= 1.0 => Some(format!(
            "Band: {level} % for all rows together, as if independent with Student's t of {df} \
             degrees of freedom (equal local levels)."
        )),
        Held::Student(_) => None,
    });
    notes.extend(found.note.clone());
    let rows = own.rows.iter();
    let alone = rows.filter(|row| row.leverage >= ALONE).count();
    if alone > 0 && own.df >= 1.0 {
        let rows = if alone == 1 { "row has" } else { "rows have" };
        notes.push(format!(
            "{alone} {rows} leverage 1: the model passes through it, and it has no standardised \
             residual."
        ));
    }
    let largest = |pick: fn(&RowInfluence) -> f64| {
        let sizes = own.rows.iter().map(|row| pick(row).abs());
        sizes.fold(0.0, f64::max)
    };
    if largest(|row| row.residual) <= EXACT * largest(|row| row.observed) {
        notes.push("The model fits exactly: the residuals are what rounding leaves.".to_owned());
    }
    notes
}

/// Why residuals are not there.
fn missing_words(own: &Diagnostics, least: f64) -> String {
    match own.df {
        df if df < 1.0 => "no degrees of freedom are left for residuals",
        df if df < least => "one degree of freedom: no row can be held against the others",
        _ => "no residual has a standard error above zero",
    }
    .to_owned()
}

/// Names of the rows with the largest values, at their places.
fn marks(
    own: &Diagnostics,
    size: &dyn Fn(usize) -> f64,
    place: &dyn Fn(usize) -> (f64, f64),
    middle: f64,
) -> Vec<Mark> {
    let rows = largest(own.rows.len(), NAMED, size);
    let mark = |row: usize| {
        let at = place(row);
        Mark {
            label: own.lines[row].to_string(),
            at,
            side: match at.1 < middle {
                true => Side::BelowRight,
                false => Side::AboveLeft,
            },
        }
    };
    rows.into_iter().map(mark).collect()
}

fn panel_of(
    title: &str,
    x: (&str, &str),
    y: (&str, &str),
    series: Vec<Series>,
    marks: Vec<Mark>,
) -> GridPanel {
    let mut panel = Panel::new(x, y, series);
    panel.marks = marks;
    GridPanel::new(title, panel)
}

fn fitted_against_measured(own: &Diagnostics, found: &Found) -> GridPanel {
    let (name, unit) = column_title(&own.response);
    let place = |row: usize| (own.rows[row].observed, own.rows[row].fitted);
    let ends = own.rows.iter().flat_map(|row| [row.observed, row.fitted]);
    let (low, high) = ends.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), v| {
        (low.min(v), high.max(v))
    });
    let line = vec![(low, low), (high, high)];
    panel_of(
        "Fitted against measured",
        (&format!("measured {name}"), &unit),
        (&format!("fitted {name}"), &unit),
        vec![
            Series::new("", Style::Dashed, line).coloured(6),
            found.dots(&place),
        ],
        marks(own, &|row| found.studentised[row].abs(), &place, f64::NAN),
    )
    .with_equal_axes()
}

fn against_fitted(own: &Diagnostics, found: &Found) -> GridPanel {
    let (name, unit) = column_title(&own.response);
    let place = |row: usize| (own.rows[row].fitted, own.rows[row].residual);
    let mut panel = panel_of(
        "Residuals against fitted",
        (&format!("fitted {name}"), &unit),
        ("residual", &unit),
        vec![
            zero_line(&found.drawn, &place),
            found.dots(&place),
            Series::new("smooth (lowess)", Style::Line, found.level.clone()).coloured(1),
        ],
        marks(own, &|row| own.rows[row].residual.abs(), &place, 0.0),
    );
    panel.empty = missing_words(own, 1.0);
    panel
}

/// A broken line at zero over the places of the rows.
fn zero_line(drawn: &[usize], place: &dyn Fn(usize) -> (f64, f64)) -> Series {
    let x = drawn.iter().map(|row| place(*row).0);
    let first = x.take(1).map(|x| (x, 0.0)).collect();
    Series::new("", Style::Level, first).coloured(6)
}

fn quantiles(own: &Diagnostics, found: &Found) -> GridPanel {
    let size = |row: usize| found.studentised[row].abs();
    let named = largest(own.rows.len(), NAMED, &size);
    let label = |row: usize| match named.contains(&row) {
        true => own.lines[row].to_string(),
        false => String::new(),
    };
    let words = QuantileWords {
        title: "Normal quantiles",
        values: found.arrangement.scaled(),
        unit: "",
        empty: &missing_words(own, 2.0),
    };
    quantile_panel(words, &found.ordered, own.confidence, &label)
}

fn scale_location(own: &Diagnostics, found: &Found) -> GridPanel {
    let (name, unit) = column_title(&own.response);
    let place = |row: usize| (own.rows[row].fitted, found.standardised[row].abs().sqrt());
    let root = match found.arrangement {
        Arrangement::Mixed => "√ |scaled residual|",
        _ => "√ |standardised residual|",
    };
    let mut panel = panel_of(
        "Scale and location",
        (&format!("fitted {name}"), &unit),
        (root, ""),
        vec![
            found.dots(&place),
            Series::new("smooth (lowess)", Style::Line, found.spread.clone()).coloured(1),
        ],
        marks(own, &|row| place(row).1, &place, f64::NEG_INFINITY),
    );
    panel.up = Scale::Reaching(0.0, 0.0);
    panel.empty = missing_words(own, 1.0);
    panel
}

fn cook(own: &Diagnostics, found: &Found) -> GridPanel {
    let place = |row: usize| (own.lines[row] as f64, found.cook[row]);
    let bars = found
        .drawn
        .iter()
        .filter(|row| found.cook[**row].is_finite());
    let bars = bars.flat_map(|row| [(place(*row).0, 0.0), place(*row)]);
    let mut panel = panel_of(
        "Cook's distance",
        ("line of the table", ""),
        ("Cook's distance", ""),
        vec![Series::new("", Style::Bars, bars.collect()).coloured(0)],
        marks(own, &|row| found.cook[row], &place, f64::NEG_INFINITY),
    );
    panel.up = Scale::Reaching(0.0, 0.0);
    panel.empty = missing_words(own, 1.0);
    panel
}

/// Distances of Cook whose lines are drawn over leverage.
const DISTANCES: [f64; 2] = [0.5, 1.0];

fn leverage(own: &Diagnostics, found: &Found) -> GridPanel {
    let place = |row: usize| (own.rows[row].leverage, found.standardised[row]);
    let shown = || (0..own.rows.len()).filter(|row| found.standardised[*row].is_finite());
    let farthest = shown().map(|row| place(row).0).fold(0.0, f64::max);
    let low = shown().map(|row| place(row).1).fold(0.0, f64::min);
    let high = shown().map(|row| place(row).1).fold(0.0, f64::max);
    let room = 0.08 * (high - low);
    let (low, high) = (low - room, high + room);
    let right = (1.08 * farthest).min(1.0);
    let mut series = vec![zero_line(&found.drawn, &place), found.dots(&place)];
    let mut label = "Cook's distance 0.5 and 1";
    for (distance, side) in DISTANCES.iter().flat_map(|own| [(own, 1.0), (own, -1.0)]) {
        let steps = (1..200).map(|step| right * f64::from(step) / 200.0);
        let height = |h: f64| side * (distance * own.parameters as f64 * (1.0 - h) / h).sqrt();
        let line = steps.map(|h| (h, height(h)));
        let line: Vec<(f64, f64)> = line.filter(|(_, r)| *r >= low && *r <= high).collect();
        if line.len() > 1 {
            series.push(Series::new(label, Style::Dashed, line).coloured(1));
            label = "";
        }
    }
    let mut panel = panel_of(
        "Residuals against leverage",
        ("leverage", ""),
        ("standardised residual", ""),
        series,
        marks(own, &|row| found.cook[row], &place, 0.0),
    );
    if low < high && right > 0.0 {
        panel.across = Scale::Between(0.0, right);
        panel.up = Scale::Between(low, high);
    }
    panel.empty = missing_words(own, 1.0);
    if farthest == 0.0 || !found.standardised.iter().any(|own| own.is_finite()) {
        panel.panel.series.clear();
    }
    panel
}

fn order(own: &Diagnostics, found: &Found) -> GridPanel {
    let place = |row: usize| (own.lines[row] as f64, found.studentised[row]);
    let mut series = vec![found.dots(&place)];
    if own.df >= 2.0 && found.studentised.iter().any(|own| own.is_finite()) {
        let limit = found.held.upper(0.5 * (1.0 - own.confidence));
        let at = own.lines.first().map_or(0.0, |line| *line as f64);
        let label = format!("{} % limits of one row", percent(own.confidence));
        let ends = vec![(at, limit), (at, -limit)];
        series.push(Series::new(label, Style::Level, ends).coloured(1));
    }
    let mut panel = panel_of(
        "Residuals in the order of the rows",
        ("line of the table", ""),
        (found.arrangement.scaled(), ""),
        series,
        marks(own, &|row| found.studentised[row].abs(), &place, 0.0),
    );
    panel.empty = missing_words(own, 2.0);
    panel
}

/// A row for each row of the table that is drawn.
fn csv_of(own: &Diagnostics, found: &Found) -> Result<String, Error> {
    let header = [
        "line",
        "observed",
        "fitted",
        "residual",
        "leverage",
        "standardised",
        "studentised",
        "cook",
        "normal_score",
        "expected",
        "band_low",
        "band_high",
        "smooth_residual",
        "smooth_root",
    ];
    let mut by_row: Vec<Option<&OrderedValue>> = vec![None; own.rows.len()];
    for ordered in &found.ordered {
        by_row[ordered.row] = Some(ordered);
    }
    let smooth = |line: &[(f64, f64)], at: f64| {
        let place = line.binary_search_by(|point| point.0.total_cmp(&at));
        place.map_or(f64::NAN, |place| line[place].1)
    };
    let rows = found.drawn.iter().map(|row| {
        let (values, ordered) = (&own.rows[*row], by_row[*row]);
        let of = |pick: fn(&OrderedValue) -> f64| ordered.map_or(f64::NAN, pick);
        let numbers = [
            values.observed,
            values.fitted,
            values.residual,
            values.leverage,
            found.standardised[*row],
            found.studentised[*row],
            found.cook[*row],
            of(|own| own.score),
            of(|own| own.expected),
            of(|own| own.low),
            of(|own| own.high),
            smooth(&found.level, values.fitted),
            smooth(&found.spread, values.fitted),
        ];
        let cells = numbers.map(cell);
        std::iter::once(own.lines[*row].to_string())
            .chain(cells)
            .collect()
    });
    csv_text(&header.map(str::to_owned), rows)
}
