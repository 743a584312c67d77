//! Checks the time step of a scene's file before the run.

use crate::file::key::short;
use crate::file::read::ScenePlan;
use crate::run_error::SceneRunError;
use windfall_files::error::Error;
use windfall_scene::motion::time_step::{Impact, StepError};

/// Error of peak force or absorbed energy above which a step is refused; 1.
const TOO_LARGE: f64 = 0.1;

/// What the time step of the file does to an impact.
///
/// * `between`: numbers of the materials
///
/// # Errors
/// It is so long that contacts mean nothing; the message says which would do. The law cannot
/// be used.
pub fn checked_step(
    plan: &ScenePlan,
    impact: &Impact,
    step: f64,
    between: [usize; 2],
) -> Result<StepError, Error> {
    let found = impact.error_of(step);
    if let Ok(own) = found
        && own.peak.max(own.energy) <= TOO_LARGE
    {
        return Ok(own);
    }
    let stopped = |problem| Error::from(SceneRunError::Failed(problem));
    // Where no step will do, it is not the step's fault.
    let (fits, fine) = impact.step_for(plan.time_step_error).map_err(stopped)?;
    let Some((place, text)) = plan.given_step.clone() else {
        return found.map_err(stopped);
    };
    let [a, b] = between.map(|own| plan.scene.materials[own].as_str());
    let what = match found {
        Ok(own) => format!(
            "such steps err by {} % in its peak force and by {} % of the impact energy",
            short(100.0 * own.peak),
            short(100.0 * own.energy)
        ),
        Err(problem) => format!("with such steps {problem}"),
    };
    Err(Error::ValueInvalid {
        place,
        key: "[scene] time_step".to_owned(),
        text,
        problem: format!(
            "a contact of {a} and {b} at {} m/s lasts {} ms, and {what}; a shorter time step is \
             needed: \"auto\" would take {} µs or less",
            short(impact.speed),
            short(1e3 * fine.duration),
            short(1e6 * fits)
        ),
    })
}
