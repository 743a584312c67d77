//! What channels say of one another: the loop of force over displacement beside
//! the velocities, an accelerometer beside force and displacement.

use crate::accelerometer::{check_force, displacement_error, double_integral};
use crate::filter_butterworth::Band;
use crate::finding::Finding;
use crate::force_loop::force_loop;
use crate::impact::Measured;
use crate::measure::Surroundings;
use crate::options::ExtractOptions;
use crate::track::{Signals, Track};

/// Disagreement of force and acceleration that is told; 1.
const DISAGREES: f64 = 0.05;

/// Disagreement of energies that is told, as a part of the impact energy; 1.
const MISMATCH: f64 = 0.1;

/// Part of the contact's duration on either side of it that belongs to the loop,
/// where the force is below the threshold; 1.
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
    let Some(acceleration) = &signals.acceleration else {
        return measured;
    };
    if let (Some(force), Some(mass)) = (&signals.force, options.effective_mass) {
        let driving = options.driving_acceleration;
        let check = check_force(pair(force), pair(acceleration), window, mass, driving);
        measured.acceleration_impulse_ratio = check.map(|check| check.impulse_ratio);
        measured.acceleration_peak_ratio = check.map(|check| check.peak_ratio);
        if let Some(check) = check
            && [check.impulse_ratio, check.peak_ratio]
                .iter()
                .any(|ratio| (ratio - 1.0).abs() > DISAGREES)
        {
            findings.push(Finding::AccelerometerDisagrees {
                impulse_ratio: check.impulse_ratio,
                peak_ratio: check.peak_ratio,
            });
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
    }
    measured
}

fn pair(track: &Track) -> (&[f64], &[f64]) {
    (&track.times, &track.values)
}
