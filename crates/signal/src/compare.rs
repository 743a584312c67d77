//! Force, displacement and acceleration checked against each other.

use crate::accelerometer::{check_force, displacement_error, double_integral, free_acceleration};
use crate::filter::butterworth::Band;
use crate::finding::Finding;
use crate::force_loop::force_loop;
use crate::impact::Measured;
use crate::measure::Surroundings;
use crate::motion_check::check_motion;
use crate::options::ExtractOptions;
use crate::response::Response;
use crate::track::{Signals, Track, mean_interval};
use crate::uncertain::Uncertain;

/// Disagreement of force and acceleration that is told; 1.
const DISAGREES: f64 = 0.05;

/// … and only if it is this many of its standard uncertainties; 1.
const SIGNIFICANT: f64 = 3.0;

/// Delay and gain of the force are told from this many on, as every impact has them; 1.
const CLEAR: f64 = 3.0;

/// Disagreement of energies that is told, as a part of the impact energy; 1.
const MISMATCH: f64 = 0.1;

/// Delay between channels that is told, as a part of the contact's duration; 1.
const LATE: f64 = 1e-3;

/// Departure of the force from mass times acceleration that is told; 1.
const GAIN: f64 = 0.005;

/// Root mean square between two channels of one motion that is told, as a part of the largest
/// displacement; 1.
const MOTION_MISFIT: f64 = 0.004;

/// … and only if it is this many times the noise of the displacement; 1.
const SCATTER: f64 = 5.0;

/// Margin of the force loop on either side of the contact; part of the contact's duration.
const GUARD: f64 = 0.05;

/// Adds what the channels say of one another, and tells where they disagree.
pub(crate) fn compare(
    measured: Measured,
    signals: &Signals,
    place: &Surroundings,
    options: &ExtractOptions,
    findings: &mut Vec<Finding>,
) -> Measured {
    let mut measured = measured;
    let window = (place.onset, place.end);
    // A contact that is cut off has no loop.
    let whole = measured.contact_duration.is_some();
    if let (Some(force), Some(displacement), true) = (&signals.force, &signals.displacement, whole)
        && let Some(found) = {
            let guard = GUARD * place.duration();
            let from = (place.onset - guard).max(place.from);
            let until = (place.end + guard).min(place.until);
            force_loop(pair(force), pair(displacement), from, until)
        }
    {
        measured.loading_energy = Some(found.loading);
        measured.hysteresis_energy = Some(found.area);
        if let (Some(absorbed), Some(impact)) = (measured.absorbed_energy, measured.impact_energy)
            && (found.area - absorbed).abs() > MISMATCH * impact
        {
            findings.push(Finding::EnergyMismatch {
                area: found.area,
                absorbed,
            });
        }
    }
    if whole && let (Some(force), Some(displacement)) = (&signals.force, &signals.displacement) {
        let known = (options.effective_mass, &options.response);
        one_motion(force, displacement, place, known, &mut measured, findings);
    }
    let Some(acceleration) = &signals.acceleration else {
        return measured;
    };
    if let (Some(force), Some(mass)) = (&signals.force, options.effective_mass) {
        let free = free_acceleration(&acceleration.times, &acceleration.values, place);
        let free = free.unwrap_or(Uncertain::new(options.driving_acceleration, 0.0));
        let (force, motion) = (pair(force), pair(acceleration));
        if let Some(check) = check_force(force, motion, window, mass, free.value) {
            let sd = ratio_deviations(&measured, signals, place, free.sd, mass);
            let sd = (sd.0 * check.impulse_ratio, sd.1 * check.peak_ratio);
            measured.acceleration_impulse_ratio = Some(check.impulse_ratio);
            measured.acceleration_peak_ratio = Some(check.peak_ratio);
            measured.acceleration_impulse_ratio_sd = Some(sd.0);
            measured.acceleration_peak_ratio_sd = Some(sd.1);
            let apart = |ratio: f64, sd: f64| (ratio - 1.0).abs() > DISAGREES.max(SIGNIFICANT * sd);
            if apart(check.impulse_ratio, sd.0) || apart(check.peak_ratio, sd.1) {
                findings.push(Finding::AccelerometerDisagrees {
                    impulse_ratio: check.impulse_ratio,
                    impulse_ratio_sd: sd.0,
                    peak_ratio: check.peak_ratio,
                    peak_ratio_sd: sd.1,
                });
            }
        }
    }
    if let (Some(displacement), Some(velocity)) = (&signals.displacement, measured.impact_velocity)
    {
        let all = pair(acceleration);
        let (times, integrated) = match options.conditioning.acceleration.map(|f| f.band) {
            // A high-pass filter against drift needs the whole recording.
            Some(Band::HighPass(cutoff)) => {
                (all.0, double_integral(all.0, all.1, 0.0, Some(cutoff)).ok())
            }
            // From onset on, with the velocity that the displacement shows there.
            _ => {
                let first = all.0.partition_point(|t| *t < place.onset);
                let last = all.0.partition_point(|t| *t <= place.end);
                let times = &all.0[first..last];
                (
                    times,
                    double_integral(times, &all.1[first..last], velocity, None).ok(),
                )
            }
        };
        let error = integrated.and_then(|integrated| {
            displacement_error((times, &integrated), pair(displacement), window)
        });
        measured.integrated_displacement_error = error.map(|error| error.largest);
        measured.integrated_displacement_rms = error.map(|error| error.rms);
        measured.integrated_displacement_drift = error.map(|error| error.drift);
    }
    measured
}

/// Adds what force and displacement say of one another by Newton's law.
fn one_motion(
    force: &Track,
    displacement: &Track,
    place: &Surroundings,
    (mass, response): (Option<f64>, &Response),
    measured: &mut Measured,
    findings: &mut Vec<Finding>,
) {
    let Some(found) = check_motion((force, displacement), place, mass.unwrap_or(1.0), response)
    else {
        return;
    };
    let (delay, sd) = (found.delay.value, found.delay.sd);
    if mass.is_some() {
        measured.force_gain = Some(found.gain.value);
        measured.force_gain_sd = Some(found.gain.sd);
    }
    measured.force_delay = Some(delay);
    measured.force_delay_sd = Some(sd);
    if found.sparse {
        return;
    }
    measured.motion_misfit = Some(found.misfit);
    measured.motion_noise = Some(found.noise);
    if delay.abs() > (CLEAR * sd).max(LATE * place.duration()) {
        findings.push(Finding::LateChannel {
            force: force.name.clone(),
            displacement: displacement.name.clone(),
            delay,
            sd,
        });
    }
    let apart = (found.gain.value - 1.0).abs();
    if mass.is_some() && apart > (CLEAR * found.gain.sd).max(GAIN) {
        findings.push(Finding::ImpulseMismatch {
            force: force.name.clone(),
            displacement: displacement.name.clone(),
            gain: found.gain.value,
            sd: found.gain.sd,
        });
    }
    let largest = measured.max_displacement.unwrap_or(f64::INFINITY);
    if found.misfit > (MOTION_MISFIT * largest).max(SCATTER * found.noise) {
        findings.push(Finding::MotionMismatch {
            force: force.name.clone(),
            displacement: displacement.name.clone(),
            misfit: found.misfit,
            share: found.misfit / largest,
        });
    }
}

/// Relative standard uncertainties of the ratios of impulses and of peaks, from the
/// noise of both sensors and their zeros; 1. Not from the calibrations.
///
/// White noise σ leaves σ √(h T) in an impulse, a zero that is off by u leaves u T.
fn ratio_deviations(
    measured: &Measured,
    signals: &Signals,
    place: &Surroundings,
    free_sd: f64,
    mass: f64,
) -> (f64, f64) {
    let (Some(force), Some(acceleration)) = (&signals.force, &signals.acceleration) else {
        return (0.0, 0.0);
    };
    let duration = place.duration();
    let interval = mean_interval(&acceleration.times);
    let inertial = mass * acceleration.noise;
    let impulse = (inertial * (interval * duration).sqrt()).hypot(mass * free_sd * duration);
    let of_impulse = measured.impulse_sd.unwrap_or(0.0).hypot(impulse);
    let of_peak = force.noise.hypot(inertial).hypot(mass * free_sd);
    let relative = |sd: f64, value: Option<f64>| value.map_or(0.0, |value| (sd / value).abs());
    (
        relative(of_impulse, measured.impulse),
        relative(of_peak, measured.peak_force),
    )
}

fn pair(track: &Track) -> (&[f64], &[f64]) {
    (&track.times, &track.values)
}
