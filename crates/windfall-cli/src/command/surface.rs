//! `windfall surface`

use crate::args::surface::SurfaceArguments;
use crate::show::show;
use windfall_files::option_value::unusable;
use windfall_tables::surface::run::{AnovaType, SurfaceRequest, surface};
use windfall_tables::surface::text::{csv_of_surface, text_of_surface};

/// Response surfaces of a table of runs.
pub fn run(arguments: &SurfaceArguments) -> anyhow::Result<()> {
    let (responses, models) = (&arguments.responses, &arguments.models);
    if models.len() != 1 && models.len() != responses.len() {
        let problem = format!(
            "there are {} responses and {} models: give one model for all, or one for each",
            responses.len(),
            models.len()
        );
        return Err(unusable("--model", problem).into());
    }
    let pairs = responses.iter().enumerate().map(|(place, response)| {
        let model = models.get(place).unwrap_or(&models[0]);
        (response.clone(), model.clone())
    });
    let outcome = surface(&SurfaceRequest {
        table: arguments.table.clone(),
        responses: pairs.collect(),
        factors: arguments.factors.clone(),
        ranges: arguments.ranges.clone(),
        anova: match arguments.anova {
            1 => AnovaType::Sequential,
            2 => AnovaType::Hierarchical,
            _ => AnovaType::Partial,
        },
        confidence: arguments.confidence,
        goals: arguments.goals.clone(),
        hold: arguments.hold.clone(),
        along: arguments.along.clone(),
        members: usize::from(arguments.members),
        grid: arguments.grid.clone(),
        grid_points: arguments.grid_points,
        figures: arguments.drawn.folder(),
    })?;
    show(arguments.format, &outcome, text_of_surface, csv_of_surface)
}
