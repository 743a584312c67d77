//! What of a scene no other engine has.

use windfall_files::found::FindingOutcome;
use windfall_scene_run::file::engine_kind::Engine;
use windfall_scene_run::file::read::ScenePlan;

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
