//! Waveforms as recorded and as the calibrated law has them.

use crate::calibrate::waveform::RecordedDrop;
use crate::calibrate::waveform_outcome::{WaveformDropOutcome, WaveformOutcome};
use windfall_cards::law_use::complete_law_among;
use windfall_contact::law::EndRule;
use windfall_contact::laws::kind::{Law, LawKind};
use windfall_draw::files::{FigureFolder, write_figure};
use windfall_draw::xy::{Figure, Panel, Series, Style};
use windfall_drop_rig::rig::DropRig;
use windfall_drop_rig::simulate::drop_trajectory;
use windfall_files::error::Error;
use windfall_files::text::number::plain;

/// Shown before the first visible force and after the end of a contact; s.
const BEFORE: f64 = 2e-3;
const AFTER: f64 = 25e-3;

/// Writes a figure for each drop of a calibration on waveforms.
///
/// * `rig`: with the plate where the calibration has not estimated it
/// * `user`: the user's own laws
///
/// # Errors
/// A drop cannot be simulated with the law, or a file cannot be written.
pub fn write_waveform_figures(
    folder: &FigureFolder,
    outcome: &WaveformOutcome,
    (rig, end, impacts): (&DropRig, EndRule, usize),
    drops: &[RecordedDrop],
    user: &[LawKind],
) -> Result<(), Error> {
    let law = complete_law_among(&outcome.law, user)?;
    let mut rig = *rig;
    if let Some(plate) = &mut rig.plate {
        for parameter in &outcome.parameters {
            let value = parameter.value.value;
            match parameter.name.as_str() {
                "plate_stiffness" => plate.stiffness = value,
                "plate_damping" => plate.damping = value,
                "plate_mass" => plate.mass = value,
                _ => {}
            }
        }
    }
    for fitted in &outcome.drops {
        if let Some(drop) = drops.iter().find(|drop| drop.id == fitted.id) {
            let figure = figure(&law, (rig, end, impacts), fitted, drop)?;
            write_figure(folder, &format!("waveform-{}", fitted.id), &figure)?;
        }
    }
    Ok(())
}

fn figure(
    law: &Law,
    (mut rig, end, impacts): (DropRig, EndRule, usize),
    fitted: &WaveformDropOutcome,
    drop: &RecordedDrop,
) -> Result<Figure, Error> {
    let train = &drop.train;
    rig.mass = fitted.mass.value;
    let velocity = fitted.velocity.value;
    let height = velocity * velocity / (2.0 * rig.gravity);
    let fall = velocity / rig.gravity;
    let mut panels = Vec::new();
    for (number, bounce) in train.bounces.iter().take(impacts).enumerate() {
        let shown = (bounce.onset.value - BEFORE)..=(bounce.end.value + AFTER);
        let samples = train.times.iter().copied().zip(train.force.iter().copied());
        let samples = samples.filter(|(time, _)| shown.contains(time));
        let (times, force): (Vec<f64>, Vec<f64>) = samples.unzip();
        let onset = fitted.onset.value;
        let since: Vec<f64> = times.iter().map(|time| time - onset + fall).collect();
        let model = drop_trajectory(law, &rig, height, &since, end)
            .map_err(|source| Error::identify(&fitted.id, source))?;
        let (level, zero) = (fitted.level.value, bounce.onset.value);
        let series = |label, style, value: &dyn Fn(usize) -> f64| {
            let points = times.iter().enumerate();
            let points = points.map(|(i, time)| (1e3 * (time - zero), value(i)));
            Series::new(label, style, points.collect())
        };
        let support = |i: usize| level + model.support_force[i];
        let time = format!("time from bounce {}", number + 1);
        let forces = vec![
            series("support force, recorded", Style::Dots, &|i| force[i]),
            series("support force, fitted", Style::Line, &support),
            series("contact force, fitted", Style::Dashed, &|i| {
                model.contact_force[i]
            }),
        ];
        panels.push(Panel::new((&time, "ms"), ("force", "N"), forces));
        let residual = vec![series("residual", Style::Dots, &|i| force[i] - support(i))];
        panels.push(Panel::new(
            (&time, "ms"),
            ("recorded less fitted", "N"),
            residual,
        ));
    }
    let misfit = plain(fitted.misfit);
    Ok(Figure {
        title: format!("{}: waveform, χ² {misfit} per sample", fitted.id),
        panels,
    })
}
