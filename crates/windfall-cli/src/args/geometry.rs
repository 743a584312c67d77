//! `windfall radius` and `windfall card transfer`: arguments.

use crate::args::format::Shown;
use clap::Args;
use windfall_cards::geometry::RadiusRequest;
use windfall_cards::transfer::TransferRequest;

/// `windfall radius`
#[derive(Debug, Args)]
#[command(after_help = "Examples:
  windfall radius --chord '20 mm' --sagitta '1.3 mm'
  windfall radius --diameters '72 mm, 70 mm, 65 mm' --against '25 mm'

The columns radius_mm, chord_mm and sagitta_mm, or diameter_1_mm to diameter_3_mm of \
specimens.csv do the same for every fruit of a campaign.")]
pub struct RadiusArguments {
    #[command(flatten)]
    pub request: RadiusRequest,
    #[command(flatten)]
    pub shown: Shown,
}

/// `windfall card transfer`
#[derive(Debug, Args)]
#[command(after_help = "Examples:
  from a compression between two plates to an impactor of 25 mm:
  windfall card transfer --law 'kuwabara-kono(k=260000, c=500)' \\
      --from '41.5 mm, plane' --from-plates 2 --to '41.5 mm, 25 mm'
  from an impactor to fruit on fruit:
  windfall card transfer --law 'hertz(k=753599)' --from '38 mm, 25 mm' --to '38 mm, 38 mm' --to-fruit
  a card from a steel impactor to a wall of polyethylene:
  windfall card transfer --file law.toml --from '38 mm, 25 mm' --from-other '200 GPa, 0.3' \\
      --to '38 mm, plane' --to-other '0.8 GPa, 0.45' --card wall.toml")]
pub struct TransferArguments {
    #[command(flatten)]
    pub request: TransferRequest,
    #[command(flatten)]
    pub shown: Shown,
}
