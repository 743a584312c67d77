//! `windfall radius` and `windfall card transfer`

use crate::args::geometry::{RadiusArguments, TransferArguments};
use crate::show::show;
use windfall_cards::geometry::{RadiusOutcome, radius, text_of_radius};
use windfall_cards::transfer::{TransferOutcome, text_of_transfer, transfer_law};
use windfall_files::table::write::{csv_text, number_cell};

/// Radii of curvature.
pub fn run_radius(arguments: &RadiusArguments) -> anyhow::Result<()> {
    let csv = |outcome: &RadiusOutcome| {
        let header = [
            "radius_m",
            "radius_2_m",
            "mean_radius_m",
            "effective_radius_m",
        ];
        let radii = [outcome.radius, outcome.radius_2, outcome.mean_radius].map(Some);
        let cells = radii.into_iter().chain([outcome.effective_radius]);
        csv_text(&header, [cells.map(number_cell).collect()])
    };
    let work = || radius(&arguments.request);
    show(&arguments.shown, work, text_of_radius, csv)?;
    Ok(())
}

/// A law in another geometry.
pub fn run_transfer(arguments: &TransferArguments) -> anyhow::Result<()> {
    let csv = |outcome: &TransferOutcome| {
        let cells = vec![outcome.law.clone(), outcome.stiffness_ratio.to_string()];
        csv_text(&["law", "stiffness_ratio"], [cells])
    };
    let work = || transfer_law(&arguments.request);
    show(&arguments.shown, work, text_of_transfer, csv)?;
    Ok(())
}
