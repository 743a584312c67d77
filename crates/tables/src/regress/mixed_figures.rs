//! Figures of a mixed model: conditional residuals, effects of groups, profiles of variances.

use crate::figures::diagnostics::{Arrangement, Diagnostics, diagnostics_painting};
use crate::figures::quantiles::{Held, QuantileWords, ordered_values, quantile_panel};
use crate::figures::thinning::{drawn_rows, largest};
use crate::figures::words::{cell, percent};
use windfall_distribution::tail::normal_upper_quantile;
use windfall_draw::files::{Painting, Picture};
use windfall_draw::grid::{Grid, GridPanel, Scale};
use windfall_draw::xy::{Mark, Panel, Series, Side, Style};
use windfall_files::error::Error;
use windfall_files::table::write::csv_text;
use windfall_files::text::column_title::column_title;
use windfall_mixed::constraint::VarianceParameter;
use windfall_mixed::fit::MixedFit;
use windfall_mixed::profile::{ProfileInterval, Profiles, profile_roots};
use windfall_mixed::term::RandomTerm;
use windfall_statistics::residuals::diagnostics::RowInfluence;

/// Sizes of a panel, and of that of a profile, whose name is long; px.
const SIZE: (f64, f64) = (196.0, 176.0);
const PROFILE: (f64, f64) = (290.0, 176.0);

/// Most groups whose names stand at the axis, and height of each; px.
const MOST_NAMED: usize = 60;
const GROUP: f64 = 12.5;

/// Most panels of a figure.
const MOST_PANELS: usize = 12;

/// Points of a profile, and how far it goes beyond its limits as a part of their distance.
const POINTS: usize = 25;
const BEYOND: f64 = 0.25;

/// The random parts of a model with what was measured.
pub(crate) struct MixedShown<'a> {
    /// The response, as it is spelled in the model.
    pub response: &'a str,
    /// What was measured.
    pub observed: &'a [f64],
    /// Lines of the rows in the file.
    pub lines: &'a [usize],
    /// Random terms.
    pub terms: &'a [RandomTerm],
    /// The fit.
    pub fit: &'a MixedFit,
    /// Profile intervals of its variances.
    pub profiles: &'a Profiles,
    /// Level of the intervals.
    pub confidence: f64,
}

/// All figures of the random parts.
///
/// # Errors
/// None in practice: the tables can be written.
pub(crate) fn mixed_paintings(own: &MixedShown) -> Result<Vec<Painting>, Error> {
    Ok(vec![
        residuals(own)?,
        caterpillar(own)?,
        quantiles(own)?,
        profiles(own)?,
    ])
}

/// Conditional residuals: what is left after fixed effects and those of the groups.
fn residuals(own: &MixedShown) -> Result<Painting, Error> {
    let fit = own.fit;
    let scaled = |row: usize| fit.residuals[row] * fit.model.weights().root(row) / fit.residual_sd;
    let rows = fit.fitted.iter().zip(own.observed).enumerate();
    let rows = rows.map(|(row, (fitted, observed))| RowInfluence {
        observed: *observed,
        fitted: *fitted,
        residual: fit.residuals[row],
        leverage: f64::NAN,
        standardised: scaled(row),
        studentised: scaled(row),
        cook: f64::NAN,
        dffits: f64::NAN,
    });
    let shown = Diagnostics {
        response: own.response.to_owned(),
        lines: own.lines.to_vec(),
        rows: rows.collect(),
        df: f64::INFINITY,
        parameters: fit.coefficients.len(),
        confidence: own.confidence,
    };
    let groups = own.terms.first();
    let groups = groups.map(|term| (&term.name, &term.group, &term.group_names));
    let levels = own.fit.model.levels();
    let levels = levels.map(|own| (&own.column, &own.level, &own.names));
    let by_group = groups.into_iter().chain(levels);
    let by_group = by_group.map(|(name, group, names)| by_group_panel(own, (name, group, names)));
    let by_group = by_group.collect();
    diagnostics_painting("diagnostics", &shown, Arrangement::Mixed, by_group)
}

/// Scaled residuals of groups of rows, in the order of their names.
fn by_group_panel(
    own: &MixedShown,
    (name, group, names): (&str, &[usize], &[String]),
) -> GridPanel {
    let fit = own.fit;
    let size = |row: usize| fit.residuals[row].abs();
    let drawn = drawn_rows(own.lines.len(), &[("", &size)]).rows;
    let few = names.len() <= 6;
    // Names stand at 0, 1, 2 …; groups without names are counted from 1.
    let shift = if few { 0.0 } else { 1.0 };
    let dots = drawn.iter().map(|row| {
        let value = fit.residuals[*row] * fit.model.weights().root(*row) / fit.residual_sd;
        (group[*row] as f64 + shift, value)
    });
    let zero = vec![(0.0, 0.0)];
    let series = vec![
        Series::new("", Style::Level, zero).coloured(6),
        Series::new("", Style::Dots, dots.collect()).coloured(0),
    ];
    let x = match few {
        true => name.to_owned(),
        false => format!("{name}, in the order of names"),
    };
    let panel = Panel::new((&x, ""), ("scaled residual", ""), series);
    let mut panel = GridPanel::new(format!("Residuals by {name}"), panel);
    if few {
        panel.across = Scale::Names(names.to_vec());
    }
    panel
}

/// A column of a random term with the effects of its groups.
struct ColumnEffects<'a> {
    term: &'a RandomTerm,
    column: &'a str,
    values: Vec<f64>,
    sds: Vec<f64>,
    /// Standard deviation of the effects in the model.
    sd: f64,
}

fn columns_of<'a>(own: &MixedShown<'a>) -> Vec<ColumnEffects<'a>> {
    let mut found = Vec::new();
    for (place, term) in own.terms.iter().enumerate() {
        let effects = &own.fit.effects[place];
        for (column, name) in term.column_names.iter().enumerate() {
            found.push(ColumnEffects {
                term,
                column: name,
                values: effects.values.iter().map(|own| own[column]).collect(),
                sds: effects.sds.iter().map(|own| own[column]).collect(),
                sd: own.fit.variances[place].sds[column],
            });
        }
    }
    found
}

/// Unit of an effect: that of the response for means, else unknown.
fn unit_of(own: &MixedShown, column: &str) -> String {
    match column == "(Intercept)" {
        true => column_title(own.response).1,
        false => String::new(),
    }
}

/// Effects of the groups in the order of their size, with intervals.
fn caterpillar(own: &MixedShown) -> Result<Painting, Error> {
    let z = normal_upper_quantile(0.5 * (1.0 - own.confidence));
    let columns = columns_of(own);
    let mut notes = vec![format!(
        "Predicted effect of each group, with {} % intervals (normal, variances taken as known).",
        percent(own.confidence)
    )];
    let (mut panels, mut rows, mut height) = (Vec::new(), Vec::new(), SIZE.1);
    for effects in columns.iter().take(MOST_PANELS) {
        let mut order: Vec<usize> = (0..effects.values.len()).collect();
        order.sort_by(|a, b| effects.values[*a].total_cmp(&effects.values[*b]));
        let size = |rank: usize| effects.values[order[rank]].abs();
        let drawn = drawn_rows(order.len(), &[("effects", &size)]);
        let ends = |group: usize| {
            let (value, reach) = (effects.values[group], z * effects.sds[group]);
            (value - reach, value + reach)
        };
        let (mut bars, mut dots) = (Vec::new(), Vec::new());
        for rank in &drawn.rows {
            let group = order[*rank];
            let (low, high) = ends(group);
            let at = *rank as f64;
            if low.is_finite() && high.is_finite() {
                bars.extend([(low, at), (high, at)]);
            }
            dots.push((effects.values[group], at));
            let names = [
                &effects.term.name,
                effects.column,
                &effects.term.group_names[group],
            ];
            let mut row: Vec<String> = names.map(|own: &str| own.to_owned()).to_vec();
            let numbers = [effects.values[group], effects.sds[group], low, high];
            row.extend(numbers.map(cell));
            rows.push(row);
        }
        let named = order.len() <= MOST_NAMED;
        let (bar, dot) = match named {
            true => (Style::LevelThickBars, Style::Spots),
            false => (Style::LevelBars, Style::Dots),
        };
        let series = vec![
            Series::new("", Style::Upright, vec![(0.0, 0.0)]).coloured(6),
            Series::new("", bar, bars).coloured(1),
            Series::new("", dot, dots).coloured(0),
        ];
        let unit = unit_of(own, effects.column);
        let x = format!("effect on {}", column_title(own.response).0);
        let panel = Panel::new((&x, &unit), (&effects.term.name, ""), series);
        let title = format!("{}: {}", effects.term.name, effects.column);
        let mut panel = GridPanel::new(title, panel);
        let names = order
            .iter()
            .map(|own| effects.term.group_names[*own].clone());
        panel.up = match named {
            true => Scale::Names(names.collect()),
            false => Scale::Data,
        };
        if !named {
            panel.panel.y = format!("{}, in the order of effects", effects.term.name);
        }
        height = height.max(GROUP * order.len().min(MOST_NAMED) as f64 + 10.0);
        notes.extend(drawn.note.map(|note| note.replace("rows", "groups")));
        panels.push(panel);
    }
    notes.extend(left_out(columns.len()));
    let header = ["term", "of", "group", "value", "sd", "low", "high"];
    painting(
        "random-effects",
        format!("Effects of groups on {}", column_title(own.response).0),
        (panels, (SIZE.0, height)),
        notes,
        csv_text(&header.map(str::to_owned), rows)?,
    )
}

fn left_out(count: usize) -> Option<String> {
    let left = count.checked_sub(MOST_PANELS + 1)? + 1;
    Some(format!("{left} more have no panel."))
}

fn painting(
    name: &str,
    title: String,
    (panels, size): (Vec<GridPanel>, (f64, f64)),
    notes: Vec<String>,
    csv: String,
) -> Result<Painting, Error> {
    Ok(Painting {
        name: name.to_owned(),
        caption: notes.join(" "),
        picture: Picture::Grid(Grid {
            title,
            columns: if size.0 > SIZE.0 { 2 } else { 3 },
            panels,
            size,
            notes,
        }),
        csv,
    })
}

/// Groups that are named beside their points.
const NAMED: usize = 3;

/// Effects over the standard deviations that they have in the model, against normal scores.
///
/// # Source
/// Lange, N. and Ryan, L. (1989), Assessing normality in random effects models, Ann. Stat. 17,
/// 624-642: the variance of a predicted effect is that of the effect less its conditional one.
fn quantiles(own: &MixedShown) -> Result<Painting, Error> {
    let columns = columns_of(own);
    let (mut panels, mut rows) = (Vec::new(), Vec::new());
    for effects in columns.iter().take(MOST_PANELS) {
        let scaled = effects.values.iter().zip(&effects.sds);
        let scaled = scaled.map(|(value, sd)| {
            let variance = effects.sd.powi(2) - sd.powi(2);
            match variance > 1e-9 * effects.sd.powi(2) {
                true => value / variance.sqrt(),
                false => f64::NAN,
            }
        });
        let scaled: Vec<f64> = scaled.collect();
        let size = |group: usize| scaled[group].abs();
        let drawn = drawn_rows(scaled.len(), &[("effects", &size)]).rows;
        let is_drawn = |group: usize| drawn.binary_search(&group).is_ok();
        let ordered = ordered_values(&scaled, &is_drawn, Held::Normal, own.confidence);
        let named = largest(scaled.len(), NAMED, &size);
        let label = |group: usize| match named.contains(&group) {
            true => effects.term.group_names[group].clone(),
            false => String::new(),
        };
        let words = QuantileWords {
            title: &format!("{}: {}", effects.term.name, effects.column),
            values: "effect over its standard deviation",
            unit: "",
            empty: "the groups do not differ: the standard deviation of their effects is zero",
        };
        panels.push(quantile_panel(words, &ordered, own.confidence, &label));
        rows.extend(ordered.iter().map(|found| {
            let group = &effects.term.group_names[found.row];
            let mut row = vec![effects.term.name.clone(), effects.column.to_owned()];
            row.push(group.clone());
            row.extend([found.value, found.score, found.low, found.high].map(cell));
            row
        }));
    }
    let mut notes = vec![format!(
        "Band: {} % for all groups together, as if their effects were independent and normal. \
         Few groups tell little.",
        percent(own.confidence)
    )];
    notes.extend(left_out(columns.len()));
    let header = [
        "term",
        "of",
        "group",
        "scaled",
        "normal_score",
        "band_low",
        "band_high",
    ];
    painting(
        "random-effects-quantiles",
        format!("Quantiles of effects on {}", column_title(own.response).0),
        (panels, SIZE),
        notes,
        csv_text(&header.map(str::to_owned), rows)?,
    )
}

/// Signed root of what -2 log likelihood rises by, over each standard deviation and correlation.
fn profiles(own: &MixedShown) -> Result<Painting, Error> {
    let z = normal_upper_quantile(0.5 * (1.0 - own.confidence));
    let (mut panels, mut rows) = (Vec::new(), Vec::new());
    for interval in own.profiles.intervals.iter().take(MOST_PANELS) {
        let values = profile_values(interval);
        let roots = profile_roots(own.fit, interval, &values);
        let points: Vec<(f64, f64)> = values.into_iter().zip(roots).collect();
        rows.extend(points.iter().map(|(value, root)| {
            let numbers = [
                *value,
                *root,
                interval.estimate,
                interval.low,
                interval.high,
            ];
            let mut row = vec![interval.name.clone()];
            row.extend(numbers.map(cell));
            row
        }));
        panels.push(profile_panel(own, interval, points, z));
    }
    let mut notes = vec![format!(
        "A straight line means a normal likelihood. Broken lines: ± {z:.2}, where the {} % \
         interval ends.",
        percent(own.confidence)
    )];
    notes.extend(left_out(own.profiles.intervals.len()));
    let header = [
        "parameter",
        "value",
        "signed_root",
        "estimate",
        "low",
        "high",
    ];
    painting(
        "profiles",
        "Profiles of standard deviations and correlations".to_owned(),
        (panels, PROFILE),
        notes,
        csv_text(&header.map(str::to_owned), rows)?,
    )
}

/// Values from a little below the lower limit to a little above the upper one.
fn profile_values(own: &ProfileInterval) -> Vec<f64> {
    let correlation = matches!(own.parameter, VarianceParameter::Correlation { .. });
    let (least, most) = match correlation {
        true => (-1.0, 1.0),
        false => (0.0, f64::INFINITY),
    };
    if !own.estimate.is_finite() {
        return Vec::new();
    }
    let high = match own.high.is_finite() {
        true => own.high,
        false => 3.0 * own.estimate,
    };
    let low = (own.low - BEYOND * (own.estimate - own.low)).max(least);
    let high = (high + BEYOND * (high - own.estimate)).min(most);
    let part = |place: usize| place as f64 / (POINTS - 1) as f64;
    let values = (0..POINTS).map(|place| low + part(place) * (high - low));
    let mut values: Vec<f64> = values.chain([own.low, own.estimate, own.high]).collect();
    values.retain(|own| own.is_finite());
    values.sort_by(f64::total_cmp);
    values.dedup();
    values
}

fn profile_panel(
    own: &MixedShown,
    interval: &ProfileInterval,
    points: Vec<(f64, f64)>,
    z: f64,
) -> GridPanel {
    let unit = match interval.parameter {
        VarianceParameter::Sd { term, column } => {
            unit_of(own, &own.fit.variances[term].columns[column])
        }
        VarianceParameter::Correlation { .. } => String::new(),
        VarianceParameter::ResidualSd { .. } => column_title(own.response).1,
    };
    let mut series = Vec::new();
    if points.iter().any(|(_, root)| root.is_finite()) {
        let at = interval.estimate;
        series.push(Series::new("", Style::Level, vec![(at, z), (at, -z)]).coloured(1));
        let ends = [interval.low, interval.high].into_iter();
        let ends = ends.filter(|end| end.is_finite()).map(|end| (end, 0.0));
        series.push(Series::new("", Style::Upright, ends.collect()).coloured(1));
    }
    series.push(Series::new("", Style::Line, points).coloured(0));
    let x = match interval.parameter {
        VarianceParameter::Correlation { .. } => "correlation",
        _ => "standard deviation",
    };
    let mut panel = Panel::new((x, &unit), ("signed root deviance", ""), series);
    if interval.estimate.is_finite() {
        panel.marks.push(Mark {
            label: String::new(),
            at: (interval.estimate, 0.0),
            side: Side::AboveLeft,
        });
    }
    let mut panel = GridPanel::new(&interval.name, panel);
    panel.empty = "the likelihood tells nothing about it".to_owned();
    panel
}
