//! `windfall simulate drop` of a body whose contact is not below its centre of
//! mass.

use crate::args::format::Format;
use crate::args::simulate_drop::SimulateDropArguments;
use crate::args::simulate_eccentric::EccentricArguments;
use crate::show::{write_json, write_result};
use windfall_files::option_value::unusable;
use windfall_simulate::eccentric::{eccentric_motion, simulate_one_eccentric_drop};
use windfall_simulate::eccentric_text::{
    csv_of_eccentric_drop, csv_of_eccentric_motion, json_of_eccentric_motion,
    text_of_eccentric_drop,
};
use windfall_simulate::request::drop::DropPlan;
use windfall_simulate::request::eccentric::{EccentricRequest, eccentric_body};

/// Whether a planar body is asked for.
pub fn is_asked(arguments: &EccentricArguments) -> bool {
    arguments.offset.is_some() || arguments.semi_axes.is_some()
}

/// Simulates one drop of a planar body.
pub fn run(plan: &DropPlan, arguments: &SimulateDropArguments) -> anyhow::Result<()> {
    if arguments.directory.is_some() {
        let problem = "recordings are made of central impacts; expected without --offset and \
                       --semi-axes, with --effective-mass-factor for what a rotation takes";
        return Err(unusable("DIR", problem).into());
    }
    let asked = &arguments.eccentric;
    let request = EccentricRequest {
        offset: asked.offset.clone(),
        radius: asked.radius.clone(),
        offset_angle: asked.offset_angle.clone(),
        semi_axes: asked.semi_axes.clone(),
        tilt: asked.tilt.clone(),
        inertia: asked.inertia.clone(),
        friction: asked.friction,
        angular_velocity: asked.spin.clone(),
        tangential_velocity: asked.tangential_velocity.clone(),
    };
    let body = eccentric_body(&request, plan.rig.mass)?;
    let drop = simulate_one_eccentric_drop(plan, &body, arguments.impacts)?;
    let Some(rate) = &arguments.sampling_rate else {
        return match arguments.format {
            Format::Json => write_json(&drop),
            Format::Csv => write_result(&csv_of_eccentric_drop(&drop)?),
            Format::Text => write_result(&text_of_eccentric_drop(&drop)),
        };
    };
    let motion = eccentric_motion(plan, &body, &drop, rate, arguments.duration.as_deref())?;
    match arguments.format {
        Format::Json => write_json(&json_of_eccentric_motion(&drop, &motion)),
        Format::Csv => write_result(&csv_of_eccentric_motion(&motion)?),
        Format::Text => write_result(&format!(
            "{}\nThe motion, {} samples: --format csv or json.\n",
            text_of_eccentric_drop(&drop),
            motion.times.len()
        )),
    }
}
