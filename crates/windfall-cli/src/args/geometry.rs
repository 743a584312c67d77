//! `windfall radius` and `windfall card transfer`: arguments.

use crate::args::format::Format;
use clap::{Args, ValueHint};
use std::path::PathBuf;

/// `windfall radius`
#[derive(Debug, Args)]
#[command(after_help = "Examples:
  windfall radius --chord '20 mm' --sagitta '1.3 mm'
  windfall radius --diameters '72 mm, 70 mm, 65 mm' --against '25 mm'

The columns radius_mm, chord_mm and sagitta_mm, or diameter_1_mm to diameter_3_mm of \
specimens.csv do the same for every fruit of a campaign.")]
pub struct RadiusArguments {
    /// Distance between the feet of a chord gauge
    #[arg(long, value_name = "LENGTH")]
    pub chord: Option<String>,
    /// Height of the surface above the chord
    #[arg(long, value_name = "LENGTH")]
    pub sagitta: Option<String>,
    /// Three diameters; the first along the axis that is struck or pressed
    #[arg(long, value_name = "A, B, C")]
    pub diameters: Option<String>,
    /// Radius of the other body, or "plane": gives R*
    #[arg(long, value_name = "LENGTH")]
    pub against: Option<String>,
    /// How the result is shown
    #[arg(long, value_enum, default_value_t)]
    pub format: Format,
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
    /// The law with its parameters, as it was found
    #[arg(long, required_unless_present = "file", conflicts_with = "file")]
    pub law: Option<String>,
    /// The law card of the law as it was found
    #[arg(long, value_name = "FILE", value_hint = ValueHint::FilePath)]
    pub file: Option<PathBuf>,
    /// Where it was found: radius of the fruit, radius of the other body or "plane"
    #[arg(long, value_name = "RADIUS, RADIUS")]
    pub from: String,
    /// Plates that deformed the fruit where it was found: 1 or 2
    #[arg(long, default_value_t = 1, value_name = "N")]
    pub from_plates: usize,
    /// The other body where it was found: rigid, fruit, or its modulus and Poisson's ratio
    #[arg(long, value_name = "BODY")]
    pub from_other: Option<String>,
    /// Where it is wanted: radius of the fruit, radius of the other body or "plane"
    #[arg(long, value_name = "RADIUS, RADIUS")]
    pub to: String,
    /// Plates that deform the fruit where it is wanted: 1 or 2
    #[arg(long, default_value_t = 1, value_name = "N")]
    pub to_plates: usize,
    /// The other body where it is wanted: rigid, fruit, or its modulus and Poisson's ratio
    #[arg(long, value_name = "BODY", conflicts_with = "to_fruit")]
    pub to_other: Option<String>,
    /// Where it is wanted, the other body is a fruit of the same modulus
    #[arg(long)]
    pub to_fruit: bool,
    /// Write the law card of the law where it is wanted
    #[arg(long, value_name = "FILE", value_hint = ValueHint::FilePath, requires = "file")]
    pub card: Option<PathBuf>,
    /// How the result is shown
    #[arg(long, value_enum, default_value_t)]
    pub format: Format,
}
