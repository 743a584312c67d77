//! The real bounce trains of `impact/foam_pads/bounce_train.csv`: a cart on an
//! incline that rebounds from a pad until it rests, five runs side by side.

use std::path::Path;
use windfall_contact::expression::typical;
use windfall_contact::law::EndRule;
use windfall_contact::laws::kind::LawKind;
use windfall_drop_rig::waveform::{
    DropRecord, Knowledge, WaveformFit, WaveformProblem, WaveformRig,
};
use windfall_drop_rig::waveform_fit::calibrate_waveform;
use windfall_files::table::csv::{column_index, read_table};
use windfall_signal::bounce::find::find_bounces;
use windfall_signal::bounce::train::{BounceOptions, BounceTrain, PlateRinging, StaticLevel};
use windfall_signal::recording::{Channel, Quantity, Times};
use windfall_signal::restitution::estimate::{
    Restitution, RestitutionMethod, flight, restitution_from_heights,
};
use windfall_signal::restitution::motion::{
    ContactMotion, MotionOptions, contact_motions, restitution_from_impulse_and_motion,
    restitution_from_motion,
};
use windfall_signal::uncertain::Uncertain;

/// Names of the runs in the file.
pub const RUNS: [&str; 5] = ["Latest", "Run 1", "Run 2", "Run 3", "Run 4"];
/// Mass of the cart, from the impulses of ten other recordings with the same
/// cart (docs/guide/src/compared/foam_pads.md); kg. Its uncertainty is the 3 % stated there.
pub const MASS: Uncertain = Uncertain {
    value: 523.6e-3,
    sd: 0.016,
};
/// Acceleration into the pad during contact. In flight it is 0.11 m/s² down and
/// 0.20 m/s² up the track: friction turns round with the cart, in the contact
/// as well, of which the mean is left; m/s².
pub const DRIVING: Uncertain = Uncertain {
    value: 0.155,
    sd: 0.015,
};
/// The force comes later than the position (docs/guide/src/compared/foam_pads.md); s.
pub const DELAY: f64 = 0.015;
/// The cart stands until it is let go; position glitches before that; s.
pub const RELEASE: f64 = 1.0;
/// Noise of a position; m (docs/guide/src/compared/foam_pads.md).
pub const POSITION_NOISE: f64 = 4e-4;

/// One run with what is found in it.
pub struct Run {
    pub name: &'static str,
    pub train: BounceTrain,
    pub motions: Vec<ContactMotion>,
    pub restitutions: Vec<Restitution>,
}

/// Reads and evaluates all runs.
pub fn evaluate(file: &Path) -> Result<Vec<Run>, String> {
    let text = |e: windfall_files::error::Error| e.to_string();
    let table = read_table(file).map_err(text)?;
    let column = |run: &str, what: &str| -> Result<(Vec<f64>, Vec<f64>), String> {
        let time = column_index(&table, &format!("{run}: Time (s)")).map_err(text)?;
        let value = column_index(&table, &format!("{run}: {what}")).map_err(text)?;
        let cell =
            |row: &windfall_files::table::csv::Row, i: usize| row.cells.get(i)?.parse::<f64>().ok();
        Ok(table
            .rows
            .iter()
            .filter_map(|row| Some((cell(row, time)?, cell(row, value)?)))
            .unzip())
    };
    RUNS.into_iter()
        .map(|name| {
            run(
                name,
                column(name, "Force (N)")?,
                column(name, "Position (m)")?,
            )
        })
        .collect()
}

fn run(
    name: &'static str,
    force: (Vec<f64>, Vec<f64>),
    position: (Vec<f64>, Vec<f64>),
) -> Result<Run, String> {
    let channel = Channel {
        name: format!("{name}: Force (N)"),
        quantity: Quantity::Force,
        times: Times::Listed(force.0),
        samples: force.1,
    };
    // The level steps after impacts; the pad and its mount are no plate.
    let options = BounceOptions {
        static_level: StaticLevel::Follow,
        plate: PlateRinging::Rigid,
        ..BounceOptions::default()
    };
    let train = find_bounces(&channel, &options).map_err(|e| e.to_string())?;
    let (times, positions): (Vec<f64>, Vec<f64>) = position
        .0
        .into_iter()
        .zip(position.1)
        .filter(|(t, _)| *t >= RELEASE)
        .unzip();
    let contacts: Vec<(f64, f64)> = train
        .bounces
        .iter()
        .map(|b| (b.onset.value - DELAY, b.end.value - DELAY))
        .collect();
    let options = MotionOptions {
        longest: 0.8,
        clearance: 0.01,
        least_noise: POSITION_NOISE,
        ..MotionOptions::default()
    };
    let motions = contact_motions(&times, &positions, &contacts, &options);
    let mut restitutions = restitution_from_motion(&motions);
    restitutions.extend(restitution_from_impulse_and_motion(
        &train.bounces,
        &motions,
        MASS,
        DRIVING,
    ));
    let heights = by_heights(&times, &positions, &contacts);
    restitutions.extend(at_measured_speed(heights, &motions));
    restitutions.extend(by_flights(&train, &motions));
    Ok(Run {
        name,
        train,
        motions,
        restitutions,
    })
}

/// √ of the way back over the way there, along the track, as if nothing rubbed.
fn by_heights(times: &[f64], positions: &[f64], contacts: &[(f64, f64)]) -> Vec<Restitution> {
    let touch = |time: f64| {
        let i = times
            .partition_point(|t| *t < time)
            .clamp(1, times.len() - 1);
        let share = (time - times[i - 1]) / (times[i] - times[i - 1]);
        positions[i - 1] + share * (positions[i] - positions[i - 1])
    };
    let ways: Vec<Uncertain> = contacts
        .iter()
        .enumerate()
        .map(|(k, contact)| {
            let before = k
                .checked_sub(1)
                .map_or(f64::NEG_INFINITY, |k| contacts[k].1);
            let from = times.partition_point(|t| *t < before);
            let to = times.partition_point(|t| *t < contact.0);
            let far = positions[from..to]
                .iter()
                .copied()
                .fold(f64::INFINITY, f64::min);
            Uncertain {
                value: touch(contact.0) - far,
                sd: 2f64.sqrt() * POSITION_NOISE + 0.002,
            }
        })
        .collect();
    restitution_from_heights(&ways, DRIVING)
}

/// Restitutions with the measured speed of approach in place of one that takes
/// the acceleration to be alike up and down.
fn at_measured_speed(found: Vec<Restitution>, motions: &[ContactMotion]) -> Vec<Restitution> {
    let speed = |one: Restitution| {
        let motion = motions.iter().find(|m| m.bounce == one.bounce)?;
        Some(Restitution {
            impact_speed: motion.before,
            ..one
        })
    };
    found.into_iter().filter_map(speed).collect()
}

/// A flight over the one before; the speed is the measured one.
fn by_flights(train: &BounceTrain, motions: &[ContactMotion]) -> Vec<Restitution> {
    (1..train.bounces.len())
        .filter_map(|bounce| {
            let (before, after) = (
                flight(&train.bounces, bounce - 1)?,
                flight(&train.bounces, bounce)?,
            );
            let motion = motions.iter().find(|m| m.bounce == bounce)?;
            let value = after.value / before.value;
            Some(Restitution {
                bounce,
                method: RestitutionMethod::Flights,
                impact_speed: Uncertain {
                    value: motion.before.value.abs(),
                    sd: motion.before.sd,
                },
                restitution: Uncertain {
                    value,
                    sd: value * (before.sd / before.value).hypot(after.sd / after.value),
                },
            })
        })
        .collect()
}

/// Mass by each bounce's impulse and change of velocity, m = J/(v₁ + v₂ + a T).
pub fn masses(run: &Run) -> Vec<(f64, f64)> {
    run.motions
        .iter()
        .map(|motion| {
            let bounce = &run.train.bounces[motion.bounce];
            let duration = bounce.end.value - bounce.onset.value;
            let change = motion.before.value - motion.after.value + DRIVING.value * duration;
            (motion.before.value, bounce.impulse.value / change)
        })
        .collect()
}

/// Bounces softer than this tell more of friction and level than of the pad; m/s.
pub const LEAST_SPEED: f64 = 0.08;

/// One law on all bounces of all runs at once: each bounce a record of its own,
/// with its measured velocity as a prior; the pad stands on rigid ground.
pub fn calibrate(runs: &[&Run], law: &str, least_speed: f64) -> Result<WaveformFit, String> {
    let kind = LawKind::from_name(law).map_err(|e| e.to_string())?;
    let start = typical(kind).complete().map_err(|e| e.to_string())?;
    let mut values = start.parameters();
    let names: Vec<&str> = kind.describe().parameters.iter().map(|p| p.name).collect();
    for (name, value) in names.iter().zip(&mut values) {
        match *name {
            "k" => *value = 75.0,
            "c" | "lambda" => *value = 1.0,
            "n" => *value = 1.0,
            _ => {}
        }
    }
    let law = kind.from_values(&values).ok_or("no such law")?;
    let free = (0..names.len())
        .filter(|i| !matches!(names[*i], "p" | "d"))
        .collect();
    let records: Vec<DropRecord> = runs
        .iter()
        .flat_map(|&run| run.motions.iter().map(move |motion| (run, motion)))
        .filter(|(_, motion)| motion.before.value > least_speed)
        .filter_map(|(run, motion)| record(run, motion))
        .collect();
    let problem = WaveformProblem {
        law,
        free,
        end: EndRule::default(),
        rig: WaveformRig {
            gravity: DRIVING.value,
            effective_mass_factor: Knowledge::Fixed(1.0),
            plate: None,
        },
        records,
    };
    calibrate_waveform(&problem).map_err(|e| e.to_string())
}

/// Before the onset and after the end, in which the level is seen; s.
const MARGIN: f64 = 0.12;

fn record(run: &Run, motion: &ContactMotion) -> Option<DropRecord> {
    let bounce = &run.train.bounces[motion.bounce];
    if !bounce.complete {
        return None;
    }
    // The ring after the contact is the sensor's mount, which the law has not.
    let window = (bounce.onset.value - MARGIN, bounce.end.value);
    let from = run.train.times.partition_point(|t| *t < window.0);
    let to = run.train.times.partition_point(|t| *t <= window.1);
    Some(DropRecord {
        times: run.train.times[from..to].to_vec(),
        force: run.train.force[from..to].to_vec(),
        noise: run.train.noise,
        onsets: vec![bounce.onset.value],
        windows: vec![window],
        velocity: Knowledge::Prior(Uncertain {
            value: motion.before.value,
            sd: motion.before.sd.max(0.005),
        }),
        mass: Knowledge::Fixed(MASS.value),
    })
}
