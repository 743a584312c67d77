//! Figures of the bounce trains.

use crate::analysis::{DELAY, DRIVING, LEAST_SPEED, MASS, Run};
use windfall_contact::law::EndRule;
use windfall_draw::xy::{Figure, Panel, Series, Style};
use windfall_drop_rig::rig::DropRig;
use windfall_drop_rig::simulate::{drop_trajectory, simulate_drop};
use windfall_drop_rig::waveform::WaveformFit;
use windfall_signal::restitution::estimate::RestitutionMethod;

type Fits<'a> = [(&'a str, WaveformFit)];

const RIG: DropRig = DropRig {
    mass: MASS.value,
    effective_mass_factor: 1.0,
    gravity: DRIVING.value,
    plate: None,
};

fn series(label: &str, style: Style, points: Vec<(f64, f64)>) -> Series {
    Series {
        label: label.to_owned(),
        style,
        colour: None,
        points,
    }
}

fn panel(x: (&str, &str), y: (&str, &str), series: Vec<Series>) -> Panel {
    Panel {
        x: x.0.to_owned(),
        x_unit: x.1.to_owned(),
        y: y.0.to_owned(),
        y_unit: y.1.to_owned(),
        series,
        marks: Vec::new(),
        equal: false,
    }
}

/// Force over time, and what of it is contact.
pub fn train_figure(runs: &[Run]) -> Figure {
    let one = |run: &Run| {
        let train = &run.train;
        let force = train.times.iter().copied().zip(train.force.iter().copied());
        let contacts = train
            .bounces
            .iter()
            .flat_map(|b| [(b.onset.value, 0.0), (b.end.value, 0.0)])
            .collect();
        panel(
            ("time", "s"),
            ("force", "N"),
            vec![
                series("contact", Style::Shade, contacts),
                series(run.name, Style::Line, force.collect()),
            ],
        )
    };
    Figure {
        title: "Bounces of a cart on an incline".to_owned(),
        panels: runs.iter().map(one).collect(),
    }
}

/// Restitution against impact speed by every estimator, with the laws.
pub fn restitution_figure(runs: &[Run], fits: &Fits) -> Figure {
    let by = |method: RestitutionMethod| {
        let points = runs
            .iter()
            .flat_map(|run| &run.restitutions)
            .filter(|r| r.method == method && r.impact_speed.value > LEAST_SPEED)
            .map(|r| (r.impact_speed.value, r.restitution.value));
        series(&method.to_string(), Style::Dots, points.collect())
    };
    let mut all: Vec<Series> = [
        RestitutionMethod::Velocities,
        RestitutionMethod::Impulse,
        RestitutionMethod::Heights,
        RestitutionMethod::Flights,
    ]
    .map(by)
    .into();
    for (law, fit) in fits {
        let points = (4..=30).filter_map(|i| {
            let speed = 0.02 * f64::from(i);
            let height = speed * speed / (2.0 * RIG.gravity);
            let summary = simulate_drop(&fit.law, &RIG, height, 1, EndRule::default()).ok()?;
            Some((speed, summary.impacts.first()?.restitution))
        });
        all.push(series(law, Style::Line, points.collect()));
    }
    Figure {
        title: "Restitution against impact speed".to_owned(),
        panels: vec![panel(("impact speed", "m/s"), ("restitution", "1"), all)],
    }
}

/// Recorded and fitted force of all bounces of a run, from their onsets.
pub fn waveform_figure(runs: &[Run], fits: &Fits) -> Figure {
    let mut panels = Vec::new();
    for (law, fit) in fits {
        let mut records = fit.records.iter();
        let mut dots = Vec::new();
        let mut lines = Vec::new();
        for run in runs {
            let usable = run
                .motions
                .iter()
                .filter(|m| m.before.value > LEAST_SPEED && run.train.bounces[m.bounce].complete);
            for motion in usable {
                let Some(record) = records.next() else {
                    continue;
                };
                if run.name != "Run 3" {
                    continue;
                }
                let onset = record.onset.value;
                let bounce = &run.train.bounces[motion.bounce];
                let train = &run.train;
                let near = |t: f64| t > onset - 0.06 && t < bounce.end.value + 0.1;
                dots.extend(
                    train
                        .times
                        .iter()
                        .zip(&train.force)
                        .filter(|(t, _)| near(**t))
                        .map(|(t, f)| (*t - onset, *f)),
                );
                let speed = record.velocity.value;
                let height = speed * speed / (2.0 * RIG.gravity);
                let fall = speed / RIG.gravity;
                let times: Vec<f64> = (0..=160).map(|i| fall + 0.002 * f64::from(i)).collect();
                if let Ok(path) =
                    drop_trajectory(&fit.law, &RIG, height, &times, EndRule::default())
                {
                    let points = times.iter().map(|t| t - fall).zip(path.contact_force);
                    lines.push(points.collect::<Vec<_>>());
                }
            }
        }
        let mut all: Vec<Series> = lines
            .into_iter()
            .enumerate()
            .map(|(i, points)| series(if i == 0 { law } else { "" }, Style::Line, points))
            .collect();
        all.push(series("recorded, Run 3", Style::Dots, dots));
        panels.push(panel(("time from onset", "s"), ("force", "N"), all));
    }
    Figure {
        title: format!(
            "All bounces of Run 3; force {} ms after position",
            DELAY * 1e3
        ),
        panels,
    }
}
