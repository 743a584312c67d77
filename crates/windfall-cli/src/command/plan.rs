//! `windfall plan`

use crate::args::plan::{PlanArguments, PlanCommand};
use crate::show::show;
use windfall_plan::achieved::run::achieved;
use windfall_plan::achieved::text::{csv_of_achieved, text_of_achieved};
use windfall_plan::closed::run::{plan_difference, plan_groups, plan_mean, plan_slope};
use windfall_plan::critical::run::plan_critical;
use windfall_plan::model::run::plan_model;
use windfall_plan::population::run::plan_population;
use windfall_plan::surface::run::plan_surface;
use windfall_plan::text::{csv_of_plan, text_of_plan};

/// How many fruit.
pub fn run(arguments: &PlanArguments) -> anyhow::Result<()> {
    let (outcome, format) = match &arguments.question {
        PlanCommand::Mean(own) => (plan_mean(&own.request)?, own.format),
        PlanCommand::Difference(own) => (plan_difference(&own.request)?, own.format),
        PlanCommand::Groups(own) => (plan_groups(&own.request)?, own.format),
        PlanCommand::Slope(own) => (plan_slope(&own.request)?, own.format),
        PlanCommand::Model(own) => (plan_model(&own.request)?, own.format),
        PlanCommand::Surface(own) => (plan_surface(&own.request)?, own.format),
        PlanCommand::Population(own) => (plan_population(&own.request)?, own.format),
        PlanCommand::CriticalEnergy(own) => (plan_critical(&own.request)?, own.format),
        PlanCommand::Achieved(own) => {
            let outcome = achieved(&own.request)?;
            return show(own.format, &outcome, text_of_achieved, csv_of_achieved);
        }
    };
    show(format, &outcome, text_of_plan, csv_of_plan)
}
