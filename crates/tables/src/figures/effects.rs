//! Effects of a model: what it predicts over each of its variables, everything else being equal,
//! with intervals and partial residuals.

use crate::figures::settings::{Others, Variable, rows_at, variables_of};
use crate::figures::thinning::{aside, drawn_rows};
use crate::figures::words::{cell, percent};
use windfall_draw::files::{Painting, Picture, file_name};
use windfall_draw::grid::{Grid, GridPanel, Scale};
use windfall_draw::xy::{Panel, Series, Style};
use windfall_files::error::Error;
use windfall_files::table::write::csv_text;
use windfall_files::text::column_title::column_title;
use windfall_mixed::coefficient::Estimated;
use windfall_statistics::model::mean_contrasts::interval;
use windfall_statistics::model::model_frame::ModelFrame;
use windfall_statistics::model::reduced::Aliased;
use windfall_statistics::table::Table;

/// Size of a panel; px.
const SIZE: (f64, f64) = (196.0, 176.0);

/// Points along a line.
const POINTS: usize = 41;

/// Most variables that have a panel, and most levels that are named in one.
const MOST_PANELS: usize = 12;
const MOST_NAMED: usize = 12;

/// What effects are drawn of.
pub struct EffectModel<'a> {
    /// The response, as it is spelled in the model.
    pub response: &'a str,
    /// Columns of the model.
    pub frame: &'a ModelFrame,
    /// Those with an estimate.
    pub estimated: &'a [usize],
    /// Those without.
    pub aliased: &'a [Aliased],
    /// Rows that the model was fitted to.
    pub table: &'a Table,
    /// Their lines in the file.
    pub lines: &'a [usize],
    /// Their residuals.
    pub residuals: &'a [f64],
    /// Estimate of a sum of all columns.
    pub estimate: &'a dyn Fn(&[f64]) -> Estimated,
    /// Level of the intervals.
    pub confidence: f64,
}

/// A prediction of the model at a value of a variable.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Effect {
    at: f64,
    value: f64,
    low: f64,
    high: f64,
}

/// The effect of a variable, one line for each value of its partner.
struct VariableEffect<'a> {
    variable: &'a Variable,
    partner: Option<&'a Variable>,
    lines: Vec<(f64, Vec<Effect>)>,
    /// Row, its line of the effect, partial residual.
    points: Vec<(usize, usize, f64)>,
}

/// Effects of all variables of a model; `None` where it has none.
///
/// A variable that stands in a term with another is shown at the levels of that one, or at its
/// 10, 50 and 90 % quantiles. A point is what the model predicts with the row's own values of
/// both, plus the row's residual (Fox and Weisberg 2018, J. Stat. Softw. 87(9), partial
/// residuals).
///
/// # Errors
/// A column of the model is not in the table.
pub fn effects_painting(model: &EffectModel) -> Result<Option<Painting>, Error> {
    // A column without an estimate of its own still says what its term is made of.
    let aliased = model.aliased.iter().map(|own| own.column);
    let used: Vec<usize> = model.estimated.iter().copied().chain(aliased).collect();
    let variables = variables_of(model.frame, &used, model.table)?;
    if variables.is_empty() {
        return Ok(None);
    }
    let size = |row: usize| model.residuals[row].abs();
    let drawn = drawn_rows(model.lines.len(), &[("residuals", &size)]);
    let level = percent(model.confidence);
    let mut notes = vec![format!(
        "Predictions with {level} % intervals of the mean; other numbers at their mean, other \
         categories over their levels in equal parts. Points: partial residuals."
    )];
    let (mut panels, mut rows) = (Vec::new(), Vec::new());
    for place in 0..variables.len().min(MOST_PANELS) {
        let (panel, note) = match effect_of(model, &variables, place, &drawn.rows) {
            Ok((own, note)) => {
                rows.extend(rows_of(model, &own));
                (panel_of(model, &own), note)
            }
            Err(error) => (undefined(model, &variables[place], &error), None),
        };
        panels.push(panel);
        notes.extend(note);
    }
    if panels
        .iter()
        .any(|own| own.panel.series.iter().any(has_gap))
    {
        notes.push("Where no row tells what the model predicts, nothing is drawn.".to_owned());
    }
    let many = |own: &Variable| {
        own.levels
            .as_ref()
            .is_some_and(|own| own.len() > MOST_NAMED)
    };
    if variables.iter().any(many) {
        notes.push(format!(
            "Partial residuals of more than {MOST_NAMED} levels are in the table alone."
        ));
    }
    notes.extend(drawn.note);
    if variables.len() > MOST_PANELS {
        let left: Vec<&str> = variables[MOST_PANELS..]
            .iter()
            .map(|own| own.column.as_str())
            .collect();
        notes.push(format!("Without a panel: {}.", left.join(", ")));
    }
    notes.dedup();
    let header = [
        "kind",
        "variable",
        "at",
        "partner",
        "partner_at",
        "line",
        "value",
        "low",
        "high",
    ];
    Ok(Some(Painting {
        name: file_name("effects"),
        caption: notes.join(" "),
        picture: Picture::Grid(Grid {
            title: format!("Effects on {}", column_title(model.response).0),
            columns: panels.len().min(3),
            panels,
            size: SIZE,
            notes,
        }),
        csv: csv_text(&header.map(str::to_owned), rows)?,
    }))
}

/// Whether a value of a series is not known.
fn has_gap(series: &Series) -> bool {
    series.points.iter().any(|(_, value)| value.is_nan())
}

fn effect_of<'a>(
    model: &EffectModel,
    variables: &'a [Variable],
    place: usize,
    drawn: &[usize],
) -> Result<(VariableEffect<'a>, Option<String>), Error> {
    let variable = &variables[place];
    let other = |name: &String| variables.iter().position(|own| own.column == *name);
    let partner = variable.partners.first().and_then(other);
    let set: Vec<usize> = std::iter::once(place).chain(partner).collect();
    let (at, left) = partner.map_or((vec![f64::NAN], 0), |own| variables[own].lines());
    let setting = |value: f64, line: f64| match partner {
        Some(_) => vec![value, line],
        None => vec![value],
    };
    let along = variable.along(POINTS);
    let mut settings: Vec<Vec<f64>> = Vec::new();
    for line in &at {
        settings.extend(along.iter().map(|value| setting(*value, *line)));
    }
    let own = |row: &usize| {
        let partner = partner.map_or(f64::NAN, |own| variables[own].values[*row]);
        (variable.values[*row], partner)
    };
    settings.extend(drawn.iter().map(|row| {
        let (value, line) = own(row);
        setting(value, line)
    }));
    let (x, others) = rows_at(model.frame, variables, &set, &settings)?;
    let effect = |(weights, setting): (&Vec<f64>, &Vec<f64>)| {
        let estimable = model.aliased.iter().all(|own| own.agrees(weights));
        let own = (model.estimate)(weights);
        let (low, high) = interval(&own, model.confidence);
        match estimable {
            true => (setting[0], own.value, low, high),
            false => (setting[0], f64::NAN, f64::NAN, f64::NAN),
        }
    };
    let predicted: Vec<Effect> = x
        .iter()
        .zip(&settings)
        .take(along.len() * at.len())
        .map(effect)
        .map(|(at, value, low, high)| Effect {
            at,
            value,
            low,
            high,
        })
        .collect();
    let lines = at.iter().copied();
    let lines: Vec<(f64, Vec<Effect>)> = lines
        .zip(predicted.chunks(along.len()).map(<[Effect]>::to_vec))
        .collect();
    let own_rows = x[along.len() * at.len()..].iter().zip(drawn);
    let points = own_rows.filter_map(|(weights, row)| {
        let line = nearest(&at, own(row).1)?;
        let fitted = (model.estimate)(weights).value;
        let estimable = model.aliased.iter().all(|own| own.agrees(weights));
        estimable.then(|| (*row, line, fitted + model.residuals[*row]))
    });
    let points = points.collect();
    let mut note = None;
    if others == Others::MostFrequent {
        note = Some(format!(
            "{}: the other categories have too many combinations and stay at their most frequent \
             level.",
            variable.column
        ));
    }
    if let (true, Some(partner)) = (left > 0, partner) {
        let name = &variables[partner].column;
        note = Some(format!("{left} more levels of {name} have no line."));
    }
    if let Some(others) = variable
        .partners
        .get(1..)
        .filter(|others| !others.is_empty())
    {
        let told = format!(
            "The effect of {} depends on {} too, and is averaged over it.",
            variable.column,
            others.join(", ")
        );
        note = Some(note.map_or(told.clone(), |note| format!("{note} {told}")));
    }
    let found = VariableEffect {
        variable,
        partner: partner.map(|own| &variables[own]),
        lines,
        points,
    };
    Ok((found, note))
}

/// Line whose value is nearest; a category's own line, if it has one.
fn nearest(at: &[f64], value: f64) -> Option<usize> {
    if value.is_nan() {
        return Some(0);
    }
    let distance = |line: &usize| (at[*line] - value).abs();
    (0..at.len()).min_by(|a, b| distance(a).total_cmp(&distance(b)))
}

fn undefined(model: &EffectModel, variable: &Variable, error: &Error) -> GridPanel {
    let ((x, x_unit), (y, y_unit)) = (column_title(&variable.column), column_title(model.response));
    let panel = Panel::new((&x, &x_unit), (&y, &y_unit), Vec::new());
    let mut own = GridPanel::new(x, panel);
    own.empty = format!("the model is not defined with the others at their mean: {error}");
    own
}

/// Distance of the lines' points beside the place of a level.
const BESIDE: f64 = 0.6;

fn panel_of(model: &EffectModel, own: &VariableEffect) -> GridPanel {
    let ((x, x_unit), (y, y_unit)) = (
        column_title(&own.variable.column),
        column_title(model.response),
    );
    let category = own.variable.levels.is_some();
    let named = own.variable.levels.as_ref();
    let named = named.is_some_and(|levels| levels.len() <= MOST_NAMED);
    let (bar, mean) = match named {
        true => (Style::ThickBars, Style::Spots),
        false => (Style::Bars, Style::Dots),
    };
    let count = own.lines.len();
    // Points of several lines stand beside each other.
    let shift = |line: usize| match category {
        true => BESIDE * ((line as f64 + 0.5) / count as f64 - 0.5),
        false => 0.0,
    };
    let width = if category {
        0.35 * BESIDE / count as f64
    } else {
        0.0
    };
    let mut series = Vec::new();
    for line in 0..count {
        let dots = own.points.iter().filter(|(_, of, _)| *of == line);
        let dots = dots.enumerate().map(|(n, (row, _, value))| {
            let at = own.variable.values[*row] + shift(line) + width * aside(n);
            (at, *value)
        });
        // Points would hide the means of many levels.
        if named || !category {
            series.push(Series::new("", Style::Dots, dots.collect()).coloured(line));
        }
    }
    for (line, (at, effects)) in own.lines.iter().enumerate() {
        let label = own.partner.map_or_else(String::new, |partner| {
            let (name, unit) = column_title(&partner.column);
            format!("{name} {} {unit}", partner.word(*at))
        });
        let place = |own: &Effect| own.at + shift(line);
        let values = effects.iter().map(|own| (place(own), own.value));
        let whole = effects
            .iter()
            .all(|own| own.low.is_finite() && own.high.is_finite());
        if category {
            let bars = effects.iter().filter(|own| own.low.is_finite());
            let bars = bars.flat_map(|own| [(place(own), own.low), (place(own), own.high)]);
            series.push(Series::new("", bar, bars.collect()).coloured(line));
            series.push(Series::new(label, mean, values.collect()).coloured(line));
            continue;
        }
        if whole {
            let low = effects.iter().map(|own| (own.at, own.low));
            let high = effects.iter().rev().map(|own| (own.at, own.high));
            let band = low.chain(high).collect();
            series.push(Series::new("", Style::Band, band).coloured(line));
        }
        series.push(Series::new(label, Style::Line, values.collect()).coloured(line));
    }
    let across = match named || !category {
        true => x.clone(),
        false => format!("{x}, levels in their order from 0"),
    };
    let panel = Panel::new((&across, &x_unit), (&y, &y_unit), series);
    let mut panel = GridPanel::new(x, panel);
    if let (Some(levels), true) = (&own.variable.levels, named) {
        panel.across = Scale::Names(levels.clone());
    }
    panel.empty = "no row tells what the model predicts here".to_owned();
    panel
}

fn rows_of(model: &EffectModel, own: &VariableEffect) -> Vec<Vec<String>> {
    let partner = |value: f64| match own.partner {
        Some(partner) => [partner.column.clone(), partner.word_in_full(value)],
        None => [String::new(), String::new()],
    };
    let mut rows = Vec::new();
    for (at, effects) in &own.lines {
        for effect in effects {
            let mut row = vec!["effect".to_owned(), own.variable.column.clone()];
            row.push(own.variable.word_in_full(effect.at));
            row.extend(partner(*at));
            row.push(String::new());
            row.extend([effect.value, effect.low, effect.high].map(cell));
            rows.push(row);
        }
    }
    for (row, _, value) in &own.points {
        let mut cells = vec!["partial residual".to_owned(), own.variable.column.clone()];
        cells.push(own.variable.word_in_full(own.variable.values[*row]));
        cells.extend(partner(
            own.partner.map_or(f64::NAN, |partner| partner.values[*row]),
        ));
        cells.extend([model.lines[*row].to_string(), cell(*value)]);
        cells.extend([String::new(), String::new()]);
        rows.push(cells);
    }
    rows
}
