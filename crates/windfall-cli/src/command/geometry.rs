//! `windfall radius` and `windfall card transfer`

use crate::args::format::Format;
use crate::args::geometry::{RadiusArguments, TransferArguments};
use crate::show::{write_json, write_result};
use windfall_cards::geometry::{radius, text_of_radius};
use windfall_cards::transfer::{text_of_transfer, transfer_law};
use windfall_files::table::write::{csv_text, number_cell};

/// Radii of curvature.
pub fn run_radius(arguments: &RadiusArguments) -> anyhow::Result<()> {
    let outcome = radius(&arguments.request)?;
    match arguments.format {
        Format::Json => write_json(&outcome),
        Format::Csv => {
            let header = [
                "radius_m",
                "radius_2_m",
                "mean_radius_m",
                "effective_radius_m",
            ];
            let radii = [outcome.radius, outcome.radius_2, outcome.mean_radius].map(Some);
            let cells = radii.into_iter().chain([outcome.effective_radius]);
            write_result(&csv_text(&header, [cells.map(number_cell).collect()])?)
        }
        Format::Text => write_result(&text_of_radius(&outcome)),
    }
}

/// A law in another geometry.
pub fn run_transfer(arguments: &TransferArguments) -> anyhow::Result<()> {
    let outcome = transfer_law(&arguments.request)?;
    match arguments.format {
        Format::Json => write_json(&outcome),
        Format::Csv => {
            let cells = vec![outcome.law.clone(), outcome.stiffness_ratio.to_string()];
            write_result(&csv_text(&["law", "stiffness_ratio"], [cells])?)
        }
        Format::Text => write_result(&text_of_transfer(&outcome)),
    }
}
