//! `windfall design`: from texts to a design, what it can tell, and its file.

use crate::design::factor::{DesignFactor, factors_of};
use crate::design::model_row::{RowModel, row_at, terms_of};
use crate::design::optimal_runs::{impossible, optimal_design, split_plot_design};
use crate::design::request::{DesignKind, DesignRequest, Order};
use windfall_design::box_behnken::{BoxBehnkenOptions, box_behnken};
use windfall_design::catalogue::catalogued;
use windfall_design::composite::{Alpha, CompositeOptions, Ends, central_composite};
use windfall_design::factorial::{FactorialOptions, full_factorial, two_level};
use windfall_design::finding::DesignFinding;
use windfall_design::kind::{Design, Factor, Point, Run, evenly, randomised};
use windfall_design::latin::latin_hypercube;
use windfall_design::model::{DesignModel, extreme_points, region_points};
use windfall_design::plackett_burman::plackett_burman;
use windfall_design::quality::{DesignQuality, design_quality};
use windfall_design::sobol::sobol;
use windfall_design::split_plot::decorrelated;
use windfall_design::word::{Generator, parse_generator};
use windfall_files::error::Error;
use windfall_files::option_value::{chosen, unusable};

/// Most terms of a model that a design is judged by.
const MOST_TERMS: usize = 300;

/// Most numbers in a model matrix that a design is judged by.
const MOST_NUMBERS: usize = 20_000_000;

/// A design with what it can tell.
#[derive(Clone, Debug, PartialEq)]
pub struct DesignOutcome {
    /// The design, in run order.
    pub design: Design,
    /// The model it is judged by.
    pub model: String,
    /// Names of the columns of that model.
    pub terms: Vec<String>,
    /// Figures for that model; `None` where no model can be estimated.
    pub quality: Option<DesignQuality>,
    /// Lines for the header of the file.
    pub about: Vec<String>,
}

/// Makes a design.
///
/// # Errors
/// A text that cannot be used, a design that cannot be.
pub fn make_design(kind: &DesignKind, request: &DesignRequest) -> Result<DesignOutcome, Error> {
    let mut ratio = 0.0;
    let (mut design, asked, about) = match kind {
        DesignKind::SplitPlot(own) => {
            let (design, model) = split_plot_design(own, &request.factors, request.seed)?;
            ratio = own.ratio;
            let about = vec![
                format!("model {}", own.search.model),
                format!(
                    "whole plots {} - hard to change {} - ratio of variances {ratio}",
                    own.whole_plots,
                    own.hard.join(" - ")
                ),
                format!("search of seed {}", request.seed),
            ];
            (design, Some((own.search.model.clone(), model)), about)
        }
        DesignKind::Optimal(criterion, optimal) => {
            let optimal_for = (optimal, *criterion);
            let (design, model) = optimal_design(optimal_for, &request.factors, request.seed)?;
            let about = vec![
                format!("model {}", optimal.search.model),
                format!("search of seed {}", request.seed),
            ];
            (design, Some((optimal.search.model.clone(), model)), about)
        }
        kind => {
            let given = factors_of(&request.factors)?;
            let about = match kind {
                DesignKind::LatinHypercube(_) => {
                    vec![format!("search of seed {}", request.seed)]
                }
                _ => Vec::new(),
            };
            (design_of_kind(kind, given, request.seed)?, None, about)
        }
    };
    set_decimals(&mut design, &request.decimals)?;
    if request.order == Order::Random {
        design = randomised(design, request.seed);
    }
    let (model, terms, quality) = match asked {
        Some((name, model)) => {
            let quality = quality_of(&design, &model, ratio);
            (name, names_of(&design, &model), quality)
        }
        None => largest_model(&design),
    };
    Ok(DesignOutcome {
        design,
        model,
        terms,
        quality,
        about,
    })
}

fn design_of_kind(kind: &DesignKind, given: Vec<DesignFactor>, seed: u64) -> Result<Design, Error> {
    if !matches!(kind, DesignKind::Factorial(_)) {
        check_ranges(&given)?;
    }
    let factors: Vec<Factor> = given.iter().map(|given| given.factor.clone()).collect();
    let made = match kind {
        DesignKind::Factorial(asked) => {
            let options = FactorialOptions {
                replicates: asked.replicates,
                centre: asked.centre,
                blocks: asked.blocks,
            };
            let points = asked.points;
            if asked.fraction.is_some() || asked.runs.is_some() {
                check_ranges(&given)?;
                let generators = generators_of(asked.fraction.as_deref(), asked.runs, &factors)?;
                two_level(factors, &generators, &options)
            } else if points < 2 {
                return Err(unusable("--points", "expected at least 2 levels"));
            } else {
                let levels = given.into_iter();
                let levels = levels.map(|given| given.levels.unwrap_or_else(|| evenly(points)));
                full_factorial(factors, &levels.collect::<Vec<_>>(), &options)
            }
        }
        DesignKind::Composite(asked) => {
            let ends = [("factorial", Ends::Factorial), ("axial", Ends::Axial)];
            let blocks = asked.blocks;
            let (centre, centre_axial) = centres_of(asked.centre.as_deref(), blocks)?;
            let options = CompositeOptions {
                alpha: alpha_of(asked.alpha.as_deref(), blocks)?,
                ends: chosen("--levels", &asked.levels, &ends)?,
                generators: generators_of(asked.fraction.as_deref(), None, &factors)?,
                blocks,
                centre,
                centre_axial,
            };
            central_composite(factors, &options)
        }
        DesignKind::PlackettBurman(asked) => plackett_burman(factors, asked.runs, asked.centre),
        DesignKind::BoxBehnken(asked) => {
            let blocks = asked.blocks;
            let centre = asked.centre.unwrap_or(if blocks > 1 { 2 } else { 5 });
            box_behnken(factors, &BoxBehnkenOptions { centre, blocks })
        }
        DesignKind::LatinHypercube(asked) => latin_hypercube(factors, asked.runs, seed),
        DesignKind::Sobol(asked) => sobol(factors, asked.runs),
        DesignKind::Optimal(..) | DesignKind::SplitPlot(_) => {
            let problem = "this design is made by exchange";
            return Err(unusable("windfall design", problem));
        }
    };
    made.map_err(impossible)
}

/// Levels of numbers are listed for factorial and optimal designs alone.
fn check_ranges(given: &[DesignFactor]) -> Result<(), Error> {
    let inner = |given: &&DesignFactor| {
        given.factor.categories.is_empty() && given.levels.as_ref().is_some_and(|l| l.len() > 2)
    };
    match given.iter().find(inner) {
        Some(found) => Err(unusable(
            format!("--factor '{}=…'", found.factor.name),
            "this kind of design sets its own levels: give the range, LOW..HIGH",
        )),
        None => Ok(()),
    }
}

/// Generators from "D=AB, E=AC", from "1/2", or from the number of runs.
fn generators_of(
    fraction: Option<&str>,
    runs: Option<usize>,
    factors: &[Factor],
) -> Result<Vec<Generator>, Error> {
    let runs = match (fraction, runs) {
        (Some(_), Some(_)) => {
            return Err(unusable(
                "--runs",
                "a fraction is given already; leave one of them out",
            ));
        }
        (None, None) => return Ok(Vec::new()),
        (None, Some(runs)) => runs,
        (Some(text), None) if text.contains('=') => {
            let names: Vec<&str> = factors.iter().map(|factor| &factor.name[..]).collect();
            let texts = text
                .split([',', ';'])
                .filter(|text| !text.trim().is_empty());
            let read = |text: &str| parse_generator(text, &names).map_err(impossible);
            return texts.map(read).collect();
        }
        (Some(text), None) => {
            let part = text
                .trim()
                .strip_prefix("1/")
                .and_then(|part| part.parse::<usize>().ok());
            let exponent = part
                .filter(|part| part.is_power_of_two())
                .map(usize::trailing_zeros);
            let exponent = exponent.filter(|e| (*e as usize) < factors.len() && factors.len() < 60);
            let exponent = exponent.ok_or_else(|| {
                let problem = "expected generators such as 'D=AB, E=AC', or a fraction such as 1/2";
                unusable(format!("--fraction '{text}'"), problem)
            })?;
            1 << (factors.len() - exponent as usize)
        }
    };
    catalogued(factors.len(), runs).map_err(impossible)
}

fn alpha_of(text: Option<&str>, blocks: usize) -> Result<Alpha, Error> {
    let words = [
        ("rotatable", Alpha::Rotatable),
        ("face", Alpha::Face),
        ("spherical", Alpha::Spherical),
        ("orthogonal", Alpha::Orthogonal),
        ("blocks", Alpha::Blocks),
    ];
    match text {
        None if blocks > 1 => Ok(Alpha::Blocks),
        None => Ok(Alpha::Rotatable),
        Some(text) => match text.parse() {
            Ok(number) => Ok(Alpha::Given(number)),
            Err(_) => chosen("--alpha (or a number)", text, &words),
        },
    }
}

/// Centre points with each part of the cube, and with the axial points.
fn centres_of(text: Option<&str>, blocks: usize) -> Result<(usize, usize), Error> {
    let Some(text) = text else {
        return Ok(if blocks > 1 { (2, 2) } else { (5, 0) });
    };
    let numbers: Option<Vec<usize>> = text.split(',').map(|n| n.trim().parse().ok()).collect();
    match numbers.as_deref() {
        Some([one]) => Ok((*one, *one)),
        Some([cube, axial]) if blocks > 1 => Ok((*cube, *axial)),
        _ => Err(unusable(
            format!("--centre {text}"),
            "expected a number, or with blocks two: in each part of the cube, and in the axial \
             block",
        )),
    }
}

/// Decimals of printed settings: "k=2".
fn set_decimals(design: &mut Design, texts: &[String]) -> Result<(), Error> {
    for text in texts {
        let option = || format!("--decimals {text}");
        let parts = text.split_once('=');
        let parsed = parts.and_then(|(name, n)| Some((name.trim(), n.trim().parse().ok()?)));
        let (name, decimals) = parsed
            .filter(|(_, decimals): &(&str, usize)| *decimals <= 15)
            .ok_or_else(|| unusable(option(), "expected NAME=DECIMALS, such as k=2, 0 to 15"))?;
        let names: Vec<(&str, usize)> = design
            .factors
            .iter()
            .enumerate()
            .map(|(place, factor)| (&factor.name[..], place))
            .collect();
        let place = chosen("--decimals", name, &names)?;
        let factor = &mut design.factors[place];
        if !factor.categories.is_empty() {
            return Err(unusable(
                option(),
                "the factor has categories, and no decimals",
            ));
        }
        factor.decimals = Some(decimals);
        let findings = rounding_findings(design, place, decimals);
        design.findings.extend(findings);
    }
    Ok(())
}

fn rounding_findings(design: &Design, place: usize, decimals: usize) -> Vec<DesignFinding> {
    let factor = &design.factors[place];
    let mut levels: Vec<f64> = design.runs.iter().map(|run| run.coded[place]).collect();
    levels.sort_by(f64::total_cmp);
    levels.dedup();
    let name = || factor.name.clone();
    let settings: Vec<f64> = levels.iter().map(|level| factor.setting(*level)).collect();
    let mut findings = Vec::new();
    if settings.windows(2).any(|pair| pair[0] == pair[1]) {
        findings.push(DesignFinding::SettingsMerged {
            factor: name(),
            decimals,
        });
    }
    let differences = settings.iter().zip(&levels);
    let coded = differences.map(|(setting, level)| (factor.coded(*setting) - level).abs());
    let coded = coded.fold(0.0, f64::max);
    if coded > 1e-12 {
        findings.push(DesignFinding::SettingsRounded {
            factor: name(),
            coded,
        });
    }
    findings
}

/// The largest of the named models that the design can estimate.
fn largest_model(design: &Design) -> (String, Vec<String>, Option<DesignQuality>) {
    let models = [
        DesignModel::Quadratic,
        DesignModel::Interactions,
        DesignModel::Linear,
    ];
    let found = models.into_iter().find_map(|model| {
        let quality = quality_of(design, &RowModel::Named(model), 0.0)?;
        Some((model, quality))
    });
    match found {
        Some((model, quality)) => {
            let terms = names_of(design, &RowModel::Named(model));
            (model.name().to_owned(), terms, Some(quality))
        }
        None => ("none".to_owned(), Vec::new(), None),
    }
}

/// Figures for a model with block effects; existing runs count as one block with new ones.
///
/// * `ratio`: variance between whole plots over that of a run within, which is the unit
fn quality_of(design: &Design, model: &RowModel, ratio: f64) -> Option<DesignQuality> {
    let blocks = block_effects(design);
    let terms = terms_of(model, &design.factors).len() + blocks;
    if terms > MOST_TERMS || design.runs.len() < terms || design.runs.len() * terms > MOST_NUMBERS {
        return None;
    }
    let row = |coded: &[f64]| row_at(model, &design.factors, coded);
    let in_block = |run: &Run| {
        let mut row = row(&run.coded);
        let effect = |block: usize| match run.block {
            own if own == block => 1.0,
            own if own == blocks + 1 => -1.0,
            _ => 0.0,
        };
        row.extend((1..=blocks).map(effect));
        row
    };
    let rows: Vec<Vec<f64>> = design.runs.iter().map(in_block).collect();
    let rows = decorrelated(&rows, design, ratio);
    // Extreme points have no weight in the mean, but may be the largest.
    let extreme = extreme_points(&design.factors)
        .into_iter()
        .map(|x| (0.0, x));
    let region = region_points(&design.factors).into_iter().chain(extreme);
    let region: Vec<(f64, Vec<f64>)> = region
        .map(|(weight, x)| {
            let mut row = row(&x);
            row.resize(terms, 0.0);
            (weight, row)
        })
        .collect();
    design_quality(&rows, &region)
}

/// Columns for differences between blocks.
fn block_effects(design: &Design) -> usize {
    let augmented = design.runs.iter().any(|run| run.point == Point::Existing);
    if augmented {
        0
    } else {
        design.blocks().saturating_sub(1)
    }
}

/// Names of the columns of a model, with those of the blocks.
fn names_of(design: &Design, model: &RowModel) -> Vec<String> {
    let mut names = terms_of(model, &design.factors);
    names.extend((1..=block_effects(design)).map(|block| format!("block {block}")));
    names
}
