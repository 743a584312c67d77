//! `windfall surface`: arguments.

use crate::args::format::Shown;
use clap::Args;
use windfall_tables::surface::request::SurfaceRequest;

/// `windfall surface`
#[derive(Debug, Args)]
#[command(after_help = "Examples:
  windfall surface runs.csv --response force_N --factor k --factor e --factor C --model linear
  windfall surface runs.csv --factor k --factor e --factor C \\
      --response force_N --model 'A + B + C' \\
      --response interval_ms --model 'A + B + C + AB + AC + BC + B^2' \\
      --goal 'force_N = target 11.3' --goal 'interval_ms = target 299' --hold k=0.868
  windfall surface runs.csv --response force_N --factor k --factor e --model quadratic \\
      --grid k,e --grid-points 41 --format csv > surface.csv
  windfall surface runs.csv --response force_N --factor k --factor e --figures figures

Models: linear, 2fi, quadratic, cubic, or terms: A, B, C … stand for the factors in the order
given, AB for a product, B^2 for a square; names work too (k + e + k:e + e^2). Terms are
estimated and tested in coded units; a design's file tells its coding, a central composite
design is recognised by its points, else the ends of each range are coded -1 and 1.

Goals: RESPONSE = target X | maximum | minimum | range, then low X, high X, weight X,
importance X, separated by commas; low and high are the observed ends unless given.")]
pub struct SurfaceArguments {
    #[command(flatten)]
    pub request: SurfaceRequest,
    #[command(flatten)]
    pub shown: Shown,
}
