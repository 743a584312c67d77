//! An impact as a figure: force and displacement over time, the loop of force
//! over displacement, and the fitted laws over all of them.

use crate::figure_xy::{Figure, Panel, Series, Style};
use crate::outcome::ImpactOutcome;
use windfall_contact::law::EndRule;
use windfall_contact::law_kind::{Law, LawKind};
use windfall_identify::rig::Rig;
use windfall_identify::simulate::trajectory;
use windfall_signal::impact::{Impact, Series as Samples};
use windfall_signal::kinematics::value_at;

/// Points of a law's line.
const POINTS: usize = 400;

/// The channels of an impact with the laws that were fitted to it.
///
/// * `outcomes`: results of all laws on this impact
/// * `used`: rig, end of contact, and the user's own laws
#[must_use]
pub fn figure_of_impact(
    title: &str,
    impact: &Impact,
    outcomes: &[&ImpactOutcome],
    used: (&Rig, EndRule, &[LawKind]),
) -> Figure {
    let laws: Vec<FittedMotion> = outcomes
        .iter()
        .filter_map(|outcome| fitted_motion(impact, outcome, used))
        .collect();
    let mut panels = Vec::new();
    if let Some(force) = &impact.force {
        panels.push(over_time(impact, "force", ("N", 1.0), force, &laws, |m| {
            &m.force
        }));
    }
    if let Some(displacement) = &impact.displacement {
        let unit = ("mm", 1e3);
        panels.push(over_time(
            impact,
            "displacement",
            unit,
            displacement,
            &laws,
            |m| &m.displacement,
        ));
    }
    if let (Some(force), Some(displacement)) = (&impact.force, &impact.displacement) {
        panels.push(force_loop(impact, force, displacement, &laws));
    }
    if panels.is_empty() {
        for (name, unit, series) in [
            ("displacement rate", "m/s", &impact.rate),
            ("acceleration", "m/s²", &impact.acceleration),
        ] {
            if let Some(series) = series {
                panels.push(over_time(impact, name, (unit, 1.0), series, &[], |m| {
                    &m.force
                }));
            }
        }
    }
    Figure {
        title: title.to_owned(),
        panels,
    }
}

/// The motion under a fitted law on the clock of the recording.
struct FittedMotion {
    law: String,
    times: Vec<f64>,
    force: Vec<f64>,
    displacement: Vec<f64>,
}

fn fitted_motion(
    impact: &Impact,
    outcome: &ImpactOutcome,
    (rig, end, user): (&Rig, EndRule, &[LawKind]),
) -> Option<FittedMotion> {
    let kind = LawKind::from_name_among(&outcome.law, user).ok()?;
    let values: Vec<f64> = outcome.parameters.0.iter().map(|(_, e)| e.value).collect();
    let law: Law = kind.with_parameters(&values).ok()?;
    let nuisance = |name: &str| outcome.nuisances.get(name).map(|estimate| estimate.value);
    let velocity = outcome.fitted.get("impact_velocity").copied().flatten()?;
    let onset = nuisance("onset").unwrap_or(impact.onset);
    let offset = nuisance("displacement_offset").unwrap_or(0.0);
    let (from, to) = range(impact)?;
    let step = (to - from) / (POINTS - 1) as f64;
    let times: Vec<f64> = (0..POINTS)
        .map(|i| from - onset + i as f64 * step)
        .collect();
    let motion = trajectory(&law, rig, velocity, &times, end).ok()?;
    Some(FittedMotion {
        law: outcome.law.clone(),
        times: times.iter().map(|t| t + onset).collect(),
        force: motion.force,
        displacement: motion.displacement.iter().map(|x| x + offset).collect(),
    })
}

fn range(impact: &Impact) -> Option<(f64, f64)> {
    let all = [
        &impact.force,
        &impact.displacement,
        &impact.rate,
        &impact.acceleration,
    ];
    let ends = all
        .into_iter()
        .flatten()
        .filter_map(|series| Some((*series.times.first()?, *series.times.last()?)));
    ends.reduce(|a, b| (a.0.min(b.0), a.1.max(b.1)))
}

fn over_time(
    impact: &Impact,
    name: &str,
    (unit, scale): (&str, f64),
    measured: &Samples,
    laws: &[FittedMotion],
    pick: impl Fn(&FittedMotion) -> &Vec<f64>,
) -> Panel {
    let point = |(t, value): (&f64, &f64)| (1e3 * (t - impact.onset), scale * value);
    let mut series = vec![Series {
        label: "measured".to_owned(),
        style: Style::Dots,
        points: measured
            .times
            .iter()
            .zip(&measured.values)
            .map(point)
            .collect(),
    }];
    series.extend(laws.iter().map(|motion| Series {
        label: motion.law.clone(),
        style: Style::Line,
        points: motion.times.iter().zip(pick(motion)).map(point).collect(),
    }));
    Panel {
        x: "time since the force threshold".to_owned(),
        x_unit: "ms".to_owned(),
        y: name.to_owned(),
        y_unit: unit.to_owned(),
        series,
        marks: Vec::new(),
    }
}

fn force_loop(
    impact: &Impact,
    force: &Samples,
    displacement: &Samples,
    laws: &[FittedMotion],
) -> Panel {
    // At the times of the channel with more samples.
    let times = match force.times.len() >= displacement.times.len() {
        true => &force.times,
        false => &displacement.times,
    };
    let guard = 0.05 * (impact.end - impact.onset);
    let inside = times
        .iter()
        .filter(|t| (impact.onset - guard..=impact.end + guard).contains(t));
    let points = inside.map(|t| {
        let x = value_at(&displacement.times, &displacement.values, *t);
        (1e3 * x, value_at(&force.times, &force.values, *t))
    });
    let mut series = vec![Series {
        label: "measured".to_owned(),
        style: Style::Dots,
        points: points.collect(),
    }];
    series.extend(laws.iter().map(|motion| {
        let pairs = motion.displacement.iter().zip(&motion.force);
        let inside = motion.times.iter().zip(pairs);
        let inside =
            inside.filter(|(t, _)| (impact.onset - guard..=impact.end + guard).contains(t));
        Series {
            label: motion.law.clone(),
            style: Style::Line,
            points: inside.map(|(_, (x, f))| (1e3 * x, *f)).collect(),
        }
    }));
    Panel {
        x: "displacement".to_owned(),
        x_unit: "mm".to_owned(),
        y: "force".to_owned(),
        y_unit: "N".to_owned(),
        series,
        marks: Vec::new(),
    }
}
