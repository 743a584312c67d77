//! `windfall radius` and `windfall card transfer`

use crate::args::format::Format;
use crate::args::geometry::{RadiusArguments, TransferArguments};
use crate::show::{write_json, write_result};
use windfall_cards::geometry::{radius, text_of_radius};
use windfall_cards::transfer::{text_of_transfer, transfer_law};

/// Radii of curvature.
pub fn run_radius(arguments: &RadiusArguments) -> anyhow::Result<()> {
    let outcome = radius(&arguments.request)?;
    match arguments.format {
        Format::Json => write_json(&outcome),
        Format::Csv => {
            let effective = outcome
                .effective_radius
                .map_or_else(String::new, |r| r.to_string());
            write_result(&format!(
                "radius_m,radius_2_m,mean_radius_m,effective_radius_m\n{},{},{},{effective}\n",
                outcome.radius, outcome.radius_2, outcome.mean_radius
            ))
        }
        Format::Text => write_result(&text_of_radius(&outcome)),
    }
}

/// A law in another geometry.
pub fn run_transfer(arguments: &TransferArguments) -> anyhow::Result<()> {
    let outcome = transfer_law(&arguments.request)?;
    match arguments.format {
        Format::Json => write_json(&outcome),
        Format::Csv => write_result(&format!(
            "law,stiffness_ratio\n\"{}\",{}\n",
            outcome.law, outcome.stiffness_ratio
        )),
        Format::Text => write_result(&text_of_transfer(&outcome)),
    }
}
