//! `windfall simulate drop`

use crate::args::simulate::SimulateDropArguments;
use crate::show::{show, show_motion, show_written};
use std::path::Path;
use windfall_files::error::Error;
use windfall_files::option_value::unusable;
use windfall_simulate::drop::{simulate_drop_motion, simulate_one_drop};
use windfall_simulate::drop_text::{
    csv_of_drop, csv_of_drop_motion, outcome_of_drop_motion, text_of_drop,
};
use windfall_simulate::drops::simulate_drops;
use windfall_simulate::eccentric::{eccentric_motion, simulate_one_eccentric_drop};
use windfall_simulate::eccentric_text::{
    csv_of_eccentric_drop, csv_of_eccentric_motion, outcome_of_eccentric_motion,
    text_of_eccentric_drop,
};
use windfall_simulate::request::drop::{DropPlan, drop_plan};
use windfall_simulate::request::eccentric::eccentric_body;

/// Simulates one drop, or a campaign of recordings.
pub fn run(arguments: &SimulateDropArguments) -> anyhow::Result<()> {
    let plan = drop_plan(&arguments.drop)?;
    if arguments.eccentric.offset.is_some() || arguments.eccentric.semi_axes.is_some() {
        return eccentric(&plan, arguments);
    }
    match (&arguments.directory, &arguments.sampling_rate) {
        (Some(directory), _) => recordings(directory, &plan, arguments),
        (None, Some(rate)) => motion(&plan, arguments, rate),
        (None, None) => one(&plan, arguments),
    }
}

fn one(plan: &DropPlan, arguments: &SimulateDropArguments) -> anyhow::Result<()> {
    let work = || simulate_one_drop(plan);
    show(&arguments.shown, work, text_of_drop, csv_of_drop)?;
    Ok(())
}

fn motion(plan: &DropPlan, arguments: &SimulateDropArguments, rate: &str) -> anyhow::Result<()> {
    let duration = arguments.duration.as_deref();
    let motion = simulate_drop_motion(plan, rate, duration)?;
    show_motion(
        &arguments.shown,
        (text_of_drop(&motion.drop), motion.trajectory.times.len()),
        || outcome_of_drop_motion(&motion),
        || csv_of_drop_motion(&motion),
    )
}

fn recordings(
    directory: &Path,
    plan: &DropPlan,
    arguments: &SimulateDropArguments,
) -> anyhow::Result<()> {
    let mut request = arguments.recordings.clone();
    if let Some(rate) = &arguments.sampling_rate {
        request.sampling_rate.clone_from(rate);
    }
    if let Some(duration) = &arguments.duration {
        request.duration.clone_from(duration);
    }
    let work = || simulate_drops(directory, plan, &request);
    show_written(&arguments.shown, directory, work)
}

/// Simulates one drop of a planar body.
fn eccentric(plan: &DropPlan, arguments: &SimulateDropArguments) -> anyhow::Result<()> {
    if arguments.directory.is_some() {
        let problem = "recordings are made of central impacts; expected without --offset and \
                       --semi-axes, with --effective-mass-factor for what a rotation takes";
        return Err(unusable("DIR", problem).into());
    }
    let body = eccentric_body(&arguments.eccentric, plan.rig.mass)?;
    let drop = simulate_one_eccentric_drop(plan, &body)?;
    let Some(rate) = &arguments.sampling_rate else {
        let (text, csv) = (text_of_eccentric_drop, csv_of_eccentric_drop);
        show(&arguments.shown, || Ok::<_, Error>(drop), text, csv)?;
        return Ok(());
    };
    let motion = eccentric_motion(plan, &body, &drop, rate, arguments.duration.as_deref())?;
    show_motion(
        &arguments.shown,
        (text_of_eccentric_drop(&drop), motion.times.len()),
        || outcome_of_eccentric_motion(&drop, &motion),
        || csv_of_eccentric_motion(&motion),
    )
}
