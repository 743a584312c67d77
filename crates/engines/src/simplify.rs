//! What of a scene no other engine has.

use crate::program::wrong;
use windfall_files::error::Error;
use windfall_files::found::FindingOutcome;
use windfall_scene_run::file::engine_kind::Engine;
use windfall_scene_run::file::read::ScenePlan;

/// Refuses scenes that repeat.
///
/// # Errors
/// The scene is periodic: contacts are found from the places of fruit, and those that an engine
/// tells jump from one end to the other.
pub(crate) fn check_open(plan: &ScenePlan, engine: Engine) -> Result<(), Error> {
    if !plan.scene.periods().repeat() {
        return Ok(());
    }
    let problem = "it cannot run a scene that repeats ([scene] periodic): run it with --engine \
                   windfall, or leave `periodic` out and draw the whole belt";
    Err(wrong(engine, problem.to_owned()))
}

/// Drops what no other engine has, with findings.
pub(crate) fn simplified(plan: &mut ScenePlan, engine: Engine) -> Vec<FindingOutcome> {
    let mut findings = Vec::new();
    let (mut spread, mut annuli) = (Vec::new(), 1);
    for (&(a, b), interaction) in &mut plan.scene.interactions {
        if interaction.spread.take().is_some() {
            let [a, b] = [a, b].map(|own| plan.scene.materials[own].clone());
            spread.push(format!("{a} and {b}"));
        }
        if interaction.friction > 0.0 {
            annuli = annuli.max(interaction.annuli);
        }
        interaction.annuli = 1;
    }
    if !spread.is_empty() {
        let message = format!(
            "{} has one law for all fruit of a class: the spread of the law between fruit ({}) \
             is left out, all are like the median",
            engine.title(),
            spread.join("; ")
        );
        findings.push(FindingOutcome::new("engine-spread", message));
    }
    if annuli > 1 {
        let message = format!(
            "{} follows friction by one spring for a contact area, not by {annuli} annuli: fruit \
             come off oblique impacts otherwise, normal forces stay",
            engine.title()
        );
        findings.push(FindingOutcome::new("engine-annuli", message));
    }
    findings
}
