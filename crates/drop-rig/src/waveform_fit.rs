//! Calibration of a law on the recorded waveforms of many drops at once.

use crate::arrow_system::{Arrow, OWN, RecordEquations, SHARED};
use crate::simulate::simulate_drop;
use crate::waveform::{WaveformFit, WaveformProblem};
use crate::waveform_parameters::{Parameters, Point, own_start, plan};
use crate::waveform_record::{Stage, evaluate};
use crate::waveform_report::{Solution, report};
use windfall_contact::law::EndRule;
use windfall_identify::error::Error;

/// Times between first touches are good to this before the waveforms agree; s.
const TIMING: f64 = 3e-4;
/// Lanes of the motion when little is free, and when much is.
const FEW: usize = 8;
const MANY: usize = 12;
/// Evaluations of all records before the minimiser gives up.
const MOST_EVALUATIONS: usize = 150;
/// The minimum is reached when a step promises less than this part of the
/// cost, or less than this much of a sum of squares.
const COST_TOLERANCE: f64 = 1e-9;
const GAIN_TOLERANCE: f64 = 1e-4;
/// Damping to begin with, and where steps become negligible.
const FIRST_DAMPING: f64 = 1e-3;
const LARGEST_DAMPING: f64 = 1e12;
/// Longest step of a logarithm or an exponent.
const LONGEST_STEP: f64 = 0.5;

/// Estimates the free parameters of a law, of the plate, and of each drop its
/// onset, velocity, mass and level, from the support force of all records.
///
/// # Errors
/// Nothing is free, too few samples, or no start from which the motion can be
/// integrated.
///
/// # Numerics
/// Weighted least squares with priors as further observations; Levenberg-
/// Marquardt on normal equations in the shape of an arrow. Drops with several
/// impacts are approached in three stages: the first impact alone; then with
/// the times between touches, so that later impacts come to lie on their
/// recordings; then all samples.
pub fn calibrate_waveform(problem: &WaveformProblem) -> Result<WaveformFit, Error> {
    check(problem)?;
    let parameters = plan(problem, reference(problem)?)?;
    // Shared, velocity and mass, after the value.
    match parameters.shared.len() + 3 {
        lanes if lanes <= FEW => solve::<FEW>(problem, &parameters),
        lanes if lanes <= MANY => solve::<MANY>(problem, &parameters),
        _ => Err(Error::TooManyFree {
            asked: parameters.shared.len(),
            most: MANY - 3,
        }),
    }
}

fn check(problem: &WaveformProblem) -> Result<(), Error> {
    let samples: usize = problem.records.iter().map(|r| r.times.len()).sum();
    let free = problem.free.len() + OWN * problem.records.len();
    if samples <= free {
        return Err(Error::TooFewSamples {
            samples,
            parameters: free,
        });
    }
    for record in &problem.records {
        for (name, value) in [
            ("velocity", record.velocity.start()),
            ("mass", record.mass.start()),
            ("noise", record.noise),
        ] {
            windfall_identify::error::check_positive(name, value)?;
        }
    }
    Ok(())
}

/// Displacement that the first record's impact reaches with the start values.
fn reference(problem: &WaveformProblem) -> Result<f64, Error> {
    let Some(record) = problem.records.first() else {
        return Err(Error::TooFewSamples {
            samples: 0,
            parameters: problem.free.len(),
        });
    };
    let gravity = problem.rig.gravity;
    let rig = crate::rig::DropRig {
        mass: record.mass.start(),
        effective_mass_factor: problem.rig.effective_mass_factor.start(),
        gravity,
        plate: None,
    };
    let velocity = record.velocity.start();
    let height = velocity * velocity / (2.0 * gravity);
    let drop = simulate_drop(&problem.law, &rig, height, 1, problem.end)?;
    let deepest = drop.impacts.first().map(|impact| impact.max_displacement);
    deepest.ok_or(Error::NoStart {
        law: problem.law.kind().name(),
    })
}

fn solve<const W: usize>(
    problem: &WaveformProblem,
    parameters: &Parameters,
) -> Result<WaveformFit, Error> {
    let mut point = Point {
        shared: parameters.moved(&parameters.start),
        own: problem.records.iter().map(own_start).collect(),
    };
    let impacts = problem.records.iter().map(|r| r.windows.len()).max();
    let impacts = impacts.unwrap_or(1).max(1);
    let mut evaluations = 0;
    let mut arrow = None;
    for stage in stages(impacts, problem.end) {
        let target = Target {
            problem,
            parameters,
            stage,
        };
        let found = descend::<W>(&target, point, &mut evaluations)?;
        point = found.0;
        arrow = Some((found.1, found.2));
    }
    let Some((arrow, converged)) = arrow else {
        return Err(Error::NoStart {
            law: problem.law.kind().name(),
        });
    };
    report(&Solution {
        parameters,
        point: &point,
        arrow: &arrow,
        evaluations,
        converged,
    })
}

fn stages(impacts: usize, end: EndRule) -> Vec<Stage> {
    let one = Stage {
        impacts: 1,
        waveforms: 1,
        timing: f64::INFINITY,
        end,
    };
    if impacts == 1 {
        return vec![one];
    }
    let timed = Stage {
        impacts,
        timing: TIMING,
        ..one
    };
    let all = Stage {
        impacts,
        waveforms: impacts,
        ..one
    };
    vec![one, timed, all]
}

struct Target<'a> {
    problem: &'a WaveformProblem,
    parameters: &'a Parameters,
    stage: Stage,
}

/// Normal equations of all records at a point.
fn equations<const W: usize>(target: &Target, point: &Point) -> Result<Arrow, Error> {
    let values = target.parameters.values(&point.shared);
    let records = target.problem.records.iter().zip(&point.own);
    let records = records
        .map(|(record, own)| {
            let found = evaluate::<W>(target.parameters, record, &target.stage, &values, own)?;
            match found.cost.is_finite() {
                true => Ok(found),
                false => Err(Error::NoStart {
                    law: target.problem.law.kind().name(),
                }),
            }
        })
        .collect::<Result<Vec<RecordEquations>, Error>>()?;
    let mut arrow = Arrow {
        records,
        prior_cost: 0.0,
        prior_gradient: [0.0; SHARED],
        prior_weight: [0.0; SHARED],
    };
    for parameter in &target.parameters.shared {
        if let Some((value, sd)) = parameter.prior {
            let (place, weight) = (parameter.place, 1.0 / (sd * sd));
            let off = point.shared[place] - value;
            arrow.prior_cost += weight * off * off;
            arrow.prior_gradient[place] = weight * off;
            arrow.prior_weight[place] = weight;
        }
    }
    Ok(arrow)
}

/// Moves to the minimum of a stage: the point, its equations, and whether it
/// was reached.
fn descend<const W: usize>(
    target: &Target,
    start: Point,
    evaluations: &mut usize,
) -> Result<(Point, Arrow, bool), Error> {
    let mut point = start;
    let mut arrow = equations::<W>(target, &point)?;
    *evaluations += 1;
    let mut damping = FIRST_DAMPING;
    let mut growth = 2.0;
    let budget = *evaluations + MOST_EVALUATIONS;
    while *evaluations < budget {
        let Some(step) = arrow.step(damping) else {
            damping *= 10.0;
            if damping > LARGEST_DAMPING {
                return Ok((point, arrow, false));
            }
            continue;
        };
        let cost = arrow.cost();
        let small = step.gain <= COST_TOLERANCE * cost || step.gain <= GAIN_TOLERANCE;
        let next = moved(target.parameters, &point, &step.shared, &step.own);
        let tried = equations::<W>(target, &next);
        *evaluations += 1;
        match tried {
            Ok(found) if found.cost() <= cost => {
                let ratio = (cost - found.cost()) / step.gain.max(f64::MIN_POSITIVE);
                damping *= (1.0 - (2.0 * ratio - 1.0).powi(3)).clamp(1.0 / 3.0, 2.0);
                growth = 2.0;
                point = next;
                arrow = found;
                if small && damping < 1.0 {
                    return Ok((point, arrow, true));
                }
            }
            _ => {
                // Nothing more can be had where the model is rough.
                if small {
                    return Ok((point, arrow, true));
                }
                damping *= growth;
                growth *= 2.0;
                if damping > LARGEST_DAMPING {
                    return Ok((point, arrow, false));
                }
            }
        }
    }
    Ok((point, arrow, false))
}

/// A step from a point, shortened to what is sensible.
fn moved(
    parameters: &Parameters,
    point: &Point,
    shared: &[f64; SHARED],
    own: &[[f64; OWN]],
) -> Point {
    let longest = parameters
        .shared
        .iter()
        .map(|parameter| {
            let step = shared[parameter.place].abs();
            match parameter.logarithmic || parameter.bounds.1 < 10.0 {
                true => step,
                // A plain parameter without scale: at most itself.
                false => step / point.shared[parameter.place].abs().max(f64::MIN_POSITIVE),
            }
        })
        .fold(0.0, f64::max);
    let part = (LONGEST_STEP / longest).min(1.0);
    let mut next = point.clone();
    for (value, step) in next.shared.iter_mut().zip(shared) {
        *value += part * step;
    }
    for parameter in parameters.shared.iter().filter(|p| !p.logarithmic) {
        let (lower, upper) = parameter.bounds;
        let value = &mut next.shared[parameter.place];
        *value = value.clamp(lower, upper);
    }
    for (values, steps) in next.own.iter_mut().zip(own) {
        for (value, step) in values.iter_mut().zip(steps) {
            *value += part * step;
        }
    }
    next
}
