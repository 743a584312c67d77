//! Parameters of a law over what they should not depend on: impact velocity and order.

use windfall_campaign::result::outcome::{ImpactOutcome, TrendOutcome};
use windfall_campaign::result::trend::{Over, Times, value_of};
use windfall_contact::parameter::IMPACT_VELOCITY;
use windfall_draw::files::{NamedFigure, file_name};
use windfall_draw::xy::{Figure, Panel, Series, Style};
use windfall_files::found::robust_spread;
use windfall_files::named::grouped;

/// Standard deviations of a 95 % limit, about; 1.
const REACH: f64 = 2.0;
/// Points of a line.
const POINTS: usize = 40;

/// Each quantity over the velocity, the order and the time of day, with the slope that was found
/// through the medians; `None` where no slope was found.
pub fn figure_of_trends(
    law: &str,
    impacts: &[&ImpactOutcome],
    trends: &[TrendOutcome],
    times: &Times,
) -> Option<NamedFigure> {
    let own = trends.iter().filter(|own| own.law == law);
    let panels: Vec<Panel> = own.filter_map(|own| panel(impacts, own, times)).collect();
    if panels.is_empty() {
        return None;
    }
    Some(NamedFigure {
        name: file_name(&format!("{law}-trends")),
        caption: "What should be constant, over the impact velocity and over order and time of \
                  day, one point per impact. Lines: slope over the campaign (within fruit where \
                  each was struck at several velocities), and this slope ± two standard deviations, through \
                  the medians. Over order and time of day it is the slope at one velocity, while the \
                  points are drawn as measured: they may scatter more than the lines allow."
            .to_owned(),
        figure: Figure::new(format!("{law}: what should be constant"), panels),
    })
}

fn panel(impacts: &[&ImpactOutcome], trend: &TrendOutcome, times: &Times) -> Option<Panel> {
    let place = |impact: &ImpactOutcome| {
        let (order, hours) = *times.of.get(&impact.id)?;
        match trend.over.as_str() {
            own if own == Over::Order.name() => Some(order),
            own if own == Over::TimeOfDay.name() => hours,
            _ => Some(value_of(impact, IMPACT_VELOCITY)?.0),
        }
    };
    let over_velocity = trend.over == Over::Velocity.name();
    let scaled = |x: f64| if over_velocity { x.ln() } else { x };
    let point = |impact: &&ImpactOutcome| {
        let value = value_of(impact, &trend.quantity)?.0;
        Some((impact.group.clone(), (place(impact)?, value)))
    };
    let points: Vec<(Option<String>, (f64, f64))> = impacts.iter().filter_map(point).collect();
    let all =
        |of: fn(&(f64, f64)) -> f64| points.iter().map(|own| of(&own.1)).collect::<Vec<f64>>();
    let (x, y) = (all(|own| own.0), all(|own| own.1));
    let (centre, level) = (robust_spread(&x)?.0, robust_spread(&y)?.0);
    let low = x.iter().copied().fold(f64::INFINITY, f64::min);
    let high = x.iter().copied().fold(f64::NEG_INFINITY, f64::max);
    let line = |slope: f64| {
        let at = |i: usize| {
            let x = low + (high - low) * i as f64 / POINTS as f64;
            (x, level * (slope * (scaled(x) - scaled(centre))).exp())
        };
        (0..=POINTS).map(at).collect::<Vec<(f64, f64)>>()
    };
    let mut series = Vec::new();
    for (index, (group, own)) in grouped(points).into_iter().enumerate() {
        let label = group.unwrap_or_else(|| "impacts".to_owned());
        series.push(Series::new(label, Style::Dots, own).coloured(index));
    }
    let told = if trend.is_clear() {
        "slope"
    } else {
        "slope, not clear"
    };
    series.push(Series::new(told, Style::Line, line(trend.slope)).coloured(6));
    for sign in [-1.0, 1.0] {
        let slope = trend.slope + sign * REACH * trend.sd;
        series.push(Series::new("", Style::Dashed, line(slope)).coloured(6));
    }
    let across = match trend.over.as_str() {
        own if own == Over::Order.name() => ("part of the campaign", ""),
        own if own == Over::TimeOfDay.name() => ("time of day", "h"),
        _ => ("impact velocity", "m/s"),
    };
    let parameter = impacts
        .first()
        .and_then(|own| own.parameters.get(&trend.quantity));
    let unit = parameter.map_or("", |own| own.unit.as_str());
    let name = trend.quantity.replace('_', " ");
    let unit = if unit == "1" { "" } else { unit };
    Some(Panel::new(across, (&name, unit), series))
}
