//! `windfall plan`

use crate::args::format::Shown;
use crate::args::plan::{PlanArguments, PlanCommand};
use crate::show::show;
use windfall_files::error::Error;
use windfall_plan::achieved::run::achieved;
use windfall_plan::achieved::text::{csv_of_achieved, text_of_achieved};
use windfall_plan::closed::run::{plan_difference, plan_groups, plan_mean, plan_slope};
use windfall_plan::critical::run::plan_critical;
use windfall_plan::model::run::plan_model;
use windfall_plan::outcome::PlanOutcome;
use windfall_plan::population::run::plan_population;
use windfall_plan::surface::run::plan_surface;
use windfall_plan::text::{csv_of_plan, text_of_plan};

/// How many fruit.
pub fn run(arguments: &PlanArguments) -> anyhow::Result<()> {
    match &arguments.question {
        PlanCommand::Mean(own) => plan(&own.shown, || plan_mean(&own.request)),
        PlanCommand::Difference(own) => plan(&own.shown, || plan_difference(&own.request)),
        PlanCommand::Groups(own) => plan(&own.shown, || plan_groups(&own.request)),
        PlanCommand::Slope(own) => plan(&own.shown, || plan_slope(&own.request)),
        PlanCommand::Model(own) => plan(&own.shown, || plan_model(&own.request)),
        PlanCommand::Surface(own) => plan(&own.shown, || plan_surface(&own.request)),
        PlanCommand::Population(own) => plan(&own.shown, || plan_population(&own.request)),
        PlanCommand::CriticalEnergy(own) => plan(&own.shown, || plan_critical(&own.request)),
        PlanCommand::Achieved(own) => {
            let work = || achieved(&own.request);
            show(&own.shown, work, text_of_achieved, csv_of_achieved)?;
            Ok(())
        }
    }
}

fn plan(shown: &Shown, work: impl FnOnce() -> Result<PlanOutcome, Error>) -> anyhow::Result<()> {
    show(shown, work, text_of_plan, csv_of_plan)?;
    Ok(())
}
