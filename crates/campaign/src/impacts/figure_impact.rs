//! An impact as a figure: force and displacement over time, the loop of force
//! over displacement, and the fitted laws over all of them.

use crate::result::outcome::ImpactOutcome;
use windfall_contact::law::EndRule;
use windfall_contact::laws::kind::{Law, LawKind};
use windfall_draw::xy::{Figure, Panel, Series, Style};
use windfall_identify::rig::kind::Rig;
use windfall_identify::rig::simulate::{Trajectory, trajectory};
use windfall_signal::impact::{Impact, Series as Samples};
use windfall_signal::kinematics::value_at;

/// Time over which displacements are differenced, as a part of the contact's duration; 1.
const RATE_SPAN: f64 = 0.05;

/// Colour of the contact window, which no law has before the fourth.
pub const WINDOW: usize = 4;

/// Points of a law's line.
const POINTS: usize = 400;

/// The channels of an impact with the laws that were fitted to it.
///
/// * `outcomes`: results of all laws on this impact
/// * `used`: rig, end of contact, and the user's own laws
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
    let over_time = |name, unit, measured: &Samples, pick: fn(&Trajectory) -> &Vec<f64>| {
        over_time(impact, (name, unit), measured, &laws, pick)
    };
    let mut panels = Vec::new();
    if let Some(force) = &impact.force {
        panels.push(over_time("contact force F", ("N", 1.0), force, |m| {
            &m.force
        }));
    }
    if let Some(displacement) = &impact.displacement {
        let unit = ("mm", 1e3);
        panels.push(over_time("displacement x", unit, displacement, |m| {
            &m.displacement
        }));
    }
    if let (Some((label, rate)), true) = (shown_rate(impact), !panels.is_empty()) {
        let mut panel = over_time("displacement rate v", ("m/s", 1.0), &rate, |m| &m.rate);
        panel.series[1].label = label;
        panels.push(panel);
    }
    if let (Some(force), Some(displacement)) = (&impact.force, &impact.displacement) {
        panels.push(force_loop(impact, force, displacement, &laws));
    }
    if panels.is_empty() {
        for (name, unit, series) in [
            ("displacement rate v", "m/s", &impact.rate),
            ("acceleration a", "m/s²", &impact.acceleration),
        ] {
            if let Some(series) = series {
                let quantity = (name, (unit, 1.0));
                panels.push(self::over_time(impact, quantity, series, &[], |m| &m.force));
            }
        }
    }
    Figure::new(title, panels)
}

/// A fitted law ready to be followed.
pub struct FittedImpact<'a> {
    law: Law,
    rig: &'a Rig,
    end: EndRule,
    velocity: f64,
    onset: f64,
    offset: f64,
}

impl<'a> FittedImpact<'a> {
    /// `None` where the outcome does not hold all that the motion depends on.
    pub fn of(
        impact: &Impact,
        outcome: &ImpactOutcome,
        (rig, end, user): (&'a Rig, EndRule, &[LawKind]),
    ) -> Option<Self> {
        let kind = LawKind::from_name_among(&outcome.law, user).ok()?;
        let values: Vec<f64> = outcome.parameters.0.iter().map(|(_, e)| e.value).collect();
        let nuisance = |name: &str| outcome.nuisances.get(name).map(|estimate| estimate.value);
        Some(Self {
            law: kind.with_parameters(&values).ok()?,
            rig,
            end,
            velocity: outcome.fitted("impact_velocity")?,
            onset: nuisance("onset").unwrap_or(impact.onset),
            offset: nuisance("displacement_offset").unwrap_or(0.0),
        })
    }
}

/// The motion of a fitted impact at times on the clock of the recording, with the
/// displacement as the recording counts it; `None` where it cannot be followed.
pub fn motion_at(fitted: &FittedImpact, times: &[f64]) -> Option<Trajectory> {
    let since: Vec<f64> = times.iter().map(|t| t - fitted.onset).collect();
    let (law, rig) = (&fitted.law, fitted.rig);
    let mut motion = trajectory(law, rig, fitted.velocity, &since, fitted.end).ok()?;
    motion.times = times.to_vec();
    for displacement in &mut motion.displacement {
        *displacement += fitted.offset;
    }
    Some(motion)
}

/// The motion under a fitted law on the clock of the recording.
struct FittedMotion {
    law: String,
    motion: Trajectory,
}

fn fitted_motion(
    impact: &Impact,
    outcome: &ImpactOutcome,
    used: (&Rig, EndRule, &[LawKind]),
) -> Option<FittedMotion> {
    Some(FittedMotion {
        law: outcome.law.to_string(),
        motion: line_of_law(impact, outcome, used)?,
    })
}

/// The motion under a fitted law over all that is shown of an impact, where it can be followed.
pub fn line_of_law(
    impact: &Impact,
    outcome: &ImpactOutcome,
    used: (&Rig, EndRule, &[LawKind]),
) -> Option<Trajectory> {
    let fitted = FittedImpact::of(impact, outcome, used)?;
    let (from, to) = range(impact)?;
    let step = (to - from) / (POINTS - 1) as f64;
    let times: Vec<f64> = (0..POINTS).map(|i| from + i as f64 * step).collect();
    motion_at(&fitted, &times)
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

/// The displacement rate and how it came about. Without a measured one, differences are taken
/// over several samples: those of neighbouring encoder counts are nothing or a whole count.
pub fn shown_rate(impact: &Impact) -> Option<(String, Samples)> {
    if let Some(rate) = impact.rate.as_ref().filter(|rate| !rate.derived) {
        return Some(("measured".to_owned(), rate.clone()));
    }
    let displacement = impact.displacement.as_ref()?;
    let (times, values) = (&displacement.times, &displacement.values);
    let step = (times.last()? - times.first()?) / (times.len() - 1).max(1) as f64;
    let span = RATE_SPAN * (impact.end - impact.onset);
    let half = (0.5 * span / step).round().max(1.0) as usize;
    let mut rate = Samples::default();
    for i in half..times.len().saturating_sub(half) {
        let (from, to) = (i - half, i + half);
        rate.times.push(times[i]);
        rate.values
            .push((values[to] - values[from]) / (times[to] - times[from]));
    }
    let span = 2e3 * half as f64 * step;
    let label = format!("differences of the displacement over {span:.2} ms");
    (!rate.times.is_empty()).then_some((label, rate))
}

fn over_time(
    impact: &Impact,
    (name, (unit, scale)): (&str, (&str, f64)),
    measured: &Samples,
    laws: &[FittedMotion],
    pick: impl Fn(&Trajectory) -> &Vec<f64>,
) -> Panel {
    let point = |(t, value): (&f64, &f64)| (1e3 * (t - impact.onset), scale * value);
    let window = [impact.onset, impact.end].map(|t| (1e3 * (t - impact.onset), 0.0));
    let dots = measured.times.iter().zip(&measured.values).map(point);
    let mut series = vec![
        Series::new("contact (force threshold)", Style::Shade, window.to_vec()).coloured(WINDOW),
        Series::new("measured", Style::Dots, dots.collect()).coloured(0),
    ];
    series.extend(laws.iter().enumerate().map(|(index, fitted)| {
        let line = fitted
            .motion
            .times
            .iter()
            .zip(pick(&fitted.motion))
            .map(point);
        Series::new(&fitted.law, Style::Line, line.collect()).coloured(1 + index)
    }));
    Panel::new(
        ("time t since the force threshold", "ms"),
        (name, unit),
        series,
    )
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
    let shown = impact.onset - guard..=impact.end + guard;
    let points = times.iter().filter(|t| shown.contains(t)).map(|t| {
        let x = value_at(&displacement.times, &displacement.values, *t);
        (1e3 * x, value_at(&force.times, &force.values, *t))
    });
    let mut series = vec![Series::new("measured", Style::Dots, points.collect())];
    series.extend(laws.iter().enumerate().map(|(index, fitted)| {
        let motion = &fitted.motion;
        let points = motion.displacement.iter().zip(&motion.force);
        let inside = motion
            .times
            .iter()
            .zip(points)
            .filter(|(t, _)| shown.contains(t));
        let line = inside.map(|(_, (x, f))| (1e3 * x, *f)).collect();
        Series::new(&fitted.law, Style::Line, line).coloured(1 + index)
    }));
    Panel::new(("displacement x", "mm"), ("contact force F", "N"), series)
}
