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
        let samples: Vec<(f64, f64)> = train
            .times
            .iter()
            .copied()
            .zip(train.force.iter().copied())
            .filter(|(time, _)| shown.contains(time))
            .collect();
        let onset = fitted.onset.value;
        let times: Vec<f64> = samples
            .iter()
            .map(|(time, _)| time - onset + fall)
            .collect();
        let model =
            drop_trajectory(law, &rig, height, &times, end).map_err(|source| Error::Identify {
                subject: fitted.id.clone(),
                source: Box::new(source),
            })?;
        let level = fitted.level.value;
        let zero = bounce.onset.value;
        let at = |i: usize, value: f64| (1e3 * (samples[i].0 - zero), value);
        let all = 0..samples.len();
        let line = |label: &str, style, points: Vec<(f64, f64)>| Series {
            label: label.to_owned(),
            style,
            colour: None,
            points,
        };
        let support = |i: usize| level + model.support_force[i];
        panels.push(Panel {
            x: format!("time from bounce {}", number + 1),
            x_unit: "ms".to_owned(),
            y: "force".to_owned(),
            y_unit: "N".to_owned(),
            series: vec![
                line(
                    "support force, recorded",
                    Style::Dots,
                    all.clone().map(|i| at(i, samples[i].1)).collect(),
                ),
                line(
                    "support force, fitted",
                    Style::Line,
                    all.clone().map(|i| at(i, support(i))).collect(),
                ),
                line(
                    "contact force, fitted",
                    Style::Dashed,
                    all.clone().map(|i| at(i, model.contact_force[i])).collect(),
                ),
            ],
            marks: Vec::new(),
        });
        panels.push(Panel {
            x: format!("time from bounce {}", number + 1),
            x_unit: "ms".to_owned(),
            y: "recorded less fitted".to_owned(),
            y_unit: "N".to_owned(),
            series: vec![line(
                "residual",
                Style::Dots,
                all.map(|i| at(i, samples[i].1 - support(i))).collect(),
            )],
            marks: Vec::new(),
        });
    }
    Ok(Figure {
        title: format!(
            "{}: waveform, χ² {} per sample",
            fitted.id,
            plain(fitted.misfit)
        ),
        panels,
    })
}
