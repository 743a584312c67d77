//! Blocks of runs: which column tells them, and what they take up.

use crate::regress::findings::finding;
use crate::surface::outcome::{BlockEffect, BlockOutcome};
use crate::surface::request::SurfaceRequest;
use windfall_files::error::Error;
use windfall_files::found::FindingOutcome;
use windfall_files::option_value::unusable;
use windfall_files::table::data::Data;
use windfall_statistics::surface::analysis::Surface;
use windfall_statistics::table::Categories;

/// The column of blocks that a design is written with.
const BLOCK: &str = "block";

/// The word for no blocks.
const NONE: &str = "none";

/// The column of blocks: the one that was asked for, else `block` where it tells more than one.
///
/// # Errors
/// It is not there, or holds a factor.
pub fn block_column(
    request: &SurfaceRequest,
    factors: &[String],
    data: &Data,
) -> Result<Option<String>, Error> {
    let used = |name: &String| factors.contains(name) || request.responses.contains(name);
    match &request.block {
        Some(name) if name == NONE && data.table.column(name).is_err() => Ok(None),
        Some(name) => {
            data.table.column(name).map_err(|error| data.told(error))?;
            match used(name) {
                true => Err(unusable(
                    "--block",
                    format!("{name} is a factor or a response"),
                )),
                false => Ok(Some(name.clone())),
            }
        }
        None => {
            let name = BLOCK.to_owned();
            let column = data.table.column(&name).ok().filter(|_| !used(&name));
            let several = column.is_some_and(|own| own.cells.categories().levels.len() > 1);
            Ok(several.then_some(name))
        }
    }
}

/// The block of each run.
///
/// # Errors
/// All runs are in one block, or each is in a block of its own.
pub fn blocks_of(name: &str, data: &Data) -> Result<Categories, Error> {
    let column = data.table.column(name).map_err(|error| data.told(error))?;
    let found = column.cells.categories();
    let wrong = |problem: String| Err(unusable(format!("--block {name}"), problem));
    // Blocks of which all runs were left out are none.
    let occurs = |place: usize| found.codes.contains(&Some(place));
    let kept: Vec<String> = found
        .levels
        .iter()
        .enumerate()
        .filter(|(place, _)| occurs(*place))
        .map(|(_, level)| level.clone())
        .collect();
    let (blocks, runs) = (kept.len(), found.codes.len());
    if blocks < 2 {
        return wrong(
            "all runs are in one block; leave the option out, or give --block none".into(),
        );
    }
    if blocks == runs {
        return wrong(format!(
            "each of the {runs} runs is in a block of its own: nothing is left to compare within \
             blocks; is it the column of runs?"
        ));
    }
    found.declared(&kept).or_else(|(row, text)| {
        wrong(format!(
            "line {}: there is no block \"{text}\"",
            data.line(row - 1)
        ))
    })
}

/// Says that the runs are compared within blocks.
pub(crate) fn blocks_finding((name, blocks): (&String, &Categories)) -> FindingOutcome {
    finding(
        "blocks",
        format!(
            "runs are compared within the {} blocks of the column {name}; surfaces, optimum and \
             figures are at the mean of the blocks (--block none leaves them out)",
            blocks.levels.len()
        ),
    )
}

/// What the blocks of a surface take up.
pub(crate) fn block_outcome(surface: &Surface) -> Option<BlockOutcome> {
    surface.blocks.as_ref()?;
    let effects = surface.block_effects().into_iter();
    Some(BlockOutcome {
        sum: surface.fit.blocks,
        effects: effects
            .map(|(block, effect)| BlockEffect { block, effect })
            .collect(),
    })
}
