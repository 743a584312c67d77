//! A design and a surface → a plan for its optimum.

use crate::outcome::PlanOutcome;
use crate::parse::{finite, simulations};
use crate::run::plan;
use crate::scatter::{KnownScatter, Scatter, known_scatter};
use crate::surface::question::SurfaceQuestion;
use crate::surface::request::SurfacePlanRequest;
use nalgebra::{DMatrix, DVector};
use windfall_files::error::Error;
use windfall_files::found::FindingOutcome;
use windfall_files::known_names::known_names;
use windfall_files::on_threads::on_threads;
use windfall_files::option_value::unusable;
use windfall_files::table::data::Data;
use windfall_files::text::number::plain;
use windfall_files::text::statistic::number;
use windfall_statistics::model::model_rows::rows_with_all;
use windfall_statistics::surface::analysis::{Surface, block_rows, fit_surface_in_blocks};
use windfall_statistics::surface::canonical::{Canonical, Shape, canonical};
use windfall_statistics::surface::coding::CodedFactors;
use windfall_statistics::surface::terms::{
    SurfaceTerms, monomial_name, monomial_value, surface_terms,
};
use windfall_statistics::table::Categories;
use windfall_tables::design::coding::number_factors;
use windfall_tables::surface::blocks::{block_column, blocks_of};
use windfall_tables::surface::factors::coded_factors;
use windfall_tables::surface::random::plots;
use windfall_tables::surface::request::SurfaceRequest;

/// Plans how well the optimum of a response surface is known: the response there, and where it
/// lies.
///
/// # Errors
/// The table, the model or an option cannot be used; no study tells what is wanted.
pub fn plan_surface(request: &SurfacePlanRequest) -> Result<PlanOutcome, Error> {
    simulations(request.simulation.simulations)?;
    if request.plan.power.is_some() || request.plan.one_sided {
        let problem = "an optimum has intervals and no test: give --half-width, or --fruit";
        return Err(unusable("--power", problem));
    }
    let Runs {
        data,
        coded,
        names,
        blocks,
        findings: mut found,
    } = read_runs(request)?;
    let terms = surface_terms(&request.model, &names).map_err(Error::Statistics)?;
    let surface = true_surface(request, &data, (&coded, blocks.as_ref()), &terms)?;
    let scatter = scatter_of(request, &surface)?;
    let x = model_matrix(&coded, &terms, blocks.as_ref());
    let Some(inverse) = x.tr_mul(&x).cholesky().map(|root| root.inverse()) else {
        let problem = "the runs of the design cannot tell all of these terms apart: take a \
                       simpler model, or a design made for this one (`windfall design`)";
        return Err(unusable("--model", problem));
    };
    let optimum = canonical(&surface);
    let (at, findings) = place(&coded, optimum.as_ref());
    // told is the centre, where there is no optimum among the runs
    let optimum = optimum.filter(|_| findings.is_empty());
    found.extend(findings);
    // the mean of the blocks
    let wanted = terms_at(&terms, &at).resize_vertically(x.ncols(), 0.0);
    let question = SurfaceQuestion {
        about: about(request, &coded, &at, optimum.as_ref(), &scatter, &surface),
        at: wanted,
        shape: optimum.map(|own| own.shape),
        surface,
        x,
        inverse,
        scatter,
        simulation: request.simulation,
        findings: found,
    };
    on_threads(request.simulation.threads, || {
        plan(&question, &request.plan)
    })
}

/// The runs of a design.
struct Runs {
    data: Data,
    /// Factors in coded units.
    coded: CodedFactors,
    names: Vec<String>,
    /// The block of each run.
    blocks: Option<Categories>,
    findings: Vec<FindingOutcome>,
}

/// Reads the runs, as `windfall surface` will.
fn read_runs(request: &SurfacePlanRequest) -> Result<Runs, Error> {
    let mut data = request.reading.read(&request.table)?;
    let names = match request.factors.is_empty() {
        true => number_factors(&data),
        false => request.factors.clone(),
    };
    if names.is_empty() {
        let problem =
            "give the factors, in the order of the letters A, B, C …: --factor k --factor e";
        return Err(unusable("--factor", problem));
    }
    let asked = SurfaceRequest::usual(
        request.table.clone(),
        request.response.iter().cloned().collect(),
        vec![request.model.clone()],
    );
    let block = block_column(&asked, &names, &data)?;
    let mut needed = names.clone();
    needed.extend(request.response.iter().chain(&block).cloned());
    let (kept, _) = rows_with_all(&data.table, &needed).map_err(|error| data.told(error))?;
    if kept.is_empty() {
        let problem = format!(
            "{}: no run has all of {}",
            request.table.display(),
            needed.join(", ")
        );
        return Err(unusable("TABLE", problem));
    }
    data.keep(&kept);
    let blocks = block.as_ref().map(|name| blocks_of(name, &data));
    let blocks = blocks.transpose()?;
    let mut findings: Vec<FindingOutcome> = Vec::new();
    if let (Some(name), Some(blocks)) = (&block, &blocks) {
        let message = format!(
            "runs are compared within the {} blocks of the column {name}, as `windfall surface` \
             will do",
            blocks.levels.len()
        );
        findings.push(FindingOutcome::new("blocks", message));
    }
    if let Some(plots) = plots(&asked, &names, &data).first() {
        let message = format!(
            "the column {plots} says that runs are made in whole plots, and the plan takes them \
             for independent: what depends on factors that are set once for each plot will be \
             known less well than stated here"
        );
        findings.push(FindingOutcome::new("whole-plots-left-out", message));
    }
    Ok(Runs {
        coded: coded_factors(&data, &names, &request.ranges)?,
        data,
        names,
        blocks,
        findings,
    })
}

/// The surface of an earlier response, or the one that is stated.
fn true_surface(
    request: &SurfacePlanRequest,
    data: &Data,
    (coded, blocks): (&CodedFactors, Option<&Categories>),
    terms: &SurfaceTerms,
) -> Result<Surface, Error> {
    let fitted = |y: &[f64]| {
        let fitted = fit_surface_in_blocks(
            &coded.factors,
            terms,
            (&coded.values, blocks),
            y,
            request.plan.confidence,
        );
        fitted.map_err(|error| data.told(error))
    };
    match (&request.response, &request.coefficients) {
        (Some(response), _) => {
            let values = data
                .table
                .numbers(response)
                .map_err(|error| data.told(error))?;
            fitted(&values.values())
        }
        (None, Some(text)) => {
            let own = stated(text, coded, terms)?;
            let y = model_matrix(coded, terms, None) * &own;
            // exactly as stated, without the rounding of a fit
            let coded = own.iter().copied().collect();
            Ok(Surface {
                coded,
                ..fitted(y.as_slice())?
            })
        }
        (None, None) => {
            let problem = "where the optimum lies depends on the surface: give an earlier \
                           response, --response COLUMN, or the surface that is expected, \
                           --coefficients 'A=1, A^2=-2'";
            Err(unusable("--coefficients", problem))
        }
    }
}

/// Coefficients of the intercept and the terms.
fn stated(text: &str, coded: &CodedFactors, terms: &SurfaceTerms) -> Result<DVector<f64>, Error> {
    let names: Vec<String> = coded.factors.iter().map(|own| own.name.clone()).collect();
    let mut own = DVector::zeros(terms.monomials.len() + 1);
    for part in text.split(',') {
        let wrong = |problem: &str| unusable(format!("--coefficients {}", part.trim()), problem);
        let expected = "expected TERM=VALUE, as A^2=-2";
        let (term, value) = part.rsplit_once('=').ok_or_else(|| wrong(expected))?;
        let value: f64 = value.trim().parse().map_err(|_| wrong(expected))?;
        let value = finite("--coefficients", value)?;
        if term.trim() == "1" {
            own[0] = value;
            continue;
        }
        let asked = surface_terms(term, &names).map_err(Error::Statistics)?;
        let place = match &asked.monomials[..] {
            [monomial] => terms.monomials.iter().position(|known| known == monomial),
            _ => None,
        };
        let place = place.ok_or_else(|| {
            let known = terms
                .monomials
                .iter()
                .map(|m| monomial_name(m, &names, true));
            let known: Vec<String> = known.collect();
            let known = known_names(term.trim(), known.iter().map(String::as_str));
            wrong(&format!("this is no term of the model{known}"))
        })?;
        own[place + 1] = value;
    }
    match own.iter().skip(1).all(|value| *value == 0.0) {
        true => Err(unusable(
            "--coefficients",
            "the surface is level: it has no optimum",
        )),
        false => Ok(own),
    }
}

/// The stated scatter, or that of the runs around the fitted surface.
fn scatter_of(request: &SurfacePlanRequest, surface: &Surface) -> Result<KnownScatter, Error> {
    let own = &request.scatter;
    let stated = own.sd.is_some() || own.between.is_some() || own.within.is_some();
    if stated || own.from.is_some() || request.response.is_none() {
        return known_scatter(own, 1, &request.reading);
    }
    let sd = surface.fit.variance().sqrt();
    if !(sd.is_finite() && sd > 0.0) {
        let problem = "the earlier responses leave nothing to tell their scatter: state it";
        return Err(unusable("--sd", problem));
    }
    Ok(KnownScatter {
        words: format!(
            "SD of one value {}, that of the runs around the fitted surface ({} degrees of freedom)",
            number(sd),
            surface.fit.residual_df
        ),
        scatter: Scatter::Fruit(vec![sd]),
        findings: Vec::new(),
    })
}

/// The terms of the model, then contrasts of the blocks against their mean.
fn model_matrix(
    coded: &CodedFactors,
    terms: &SurfaceTerms,
    blocks: Option<&Categories>,
) -> DMatrix<f64> {
    let runs = coded.values.first().map_or(0, Vec::len);
    let rows: Vec<DVector<f64>> = (0..runs)
        .map(|run| {
            let point: Vec<f64> = coded.values.iter().map(|factor| factor[run]).collect();
            terms_at(terms, &point)
        })
        .collect();
    let (own, blocks) = (terms.monomials.len() + 1, block_rows(blocks, runs));
    DMatrix::from_fn(runs, own + blocks.ncols(), |run, column| {
        match column.checked_sub(own) {
            None => rows[run][column],
            Some(block) => blocks[(run, block)],
        }
    })
}

fn terms_at(terms: &SurfaceTerms, point: &[f64]) -> DVector<f64> {
    let values = terms
        .monomials
        .iter()
        .map(|powers| monomial_value(powers, point));
    let all: Vec<f64> = std::iter::once(1.0).chain(values).collect();
    DVector::from_vec(all)
}

/// Where the response is wanted: at the stationary point, where it lies among the runs, else
/// at the centre.
fn place(coded: &CodedFactors, optimum: Option<&Canonical>) -> (Vec<f64>, Vec<FindingOutcome>) {
    let centre = vec![0.0; coded.factors.len()];
    let finding = |message: &str| vec![FindingOutcome::new("no-optimum", message)];
    let Some(optimum) = optimum else {
        let message = "the surface has no curvature, and so no optimum: the response is that at \
                       the centre";
        return (centre, finding(message));
    };
    if optimum.shape == Shape::Ridge {
        let message = "the surface is a ridge, whose optimum is not one place: the response is \
                       that at the centre";
        return (centre, finding(message));
    }
    let within = optimum
        .stationary
        .iter()
        .enumerate()
        .all(|(factor, value)| {
            let (low, high) = coded.range(factor);
            (low..=high).contains(value)
        });
    match within {
        true => (optimum.stationary.clone(), Vec::new()),
        false => {
            let message = "the stationary point lies outside of the runs: the response is that \
                           at the centre; move the design towards the optimum";
            (centre, finding(message))
        }
    }
}

fn about(
    request: &SurfacePlanRequest,
    coded: &CodedFactors,
    at: &[f64],
    optimum: Option<&Canonical>,
    scatter: &KnownScatter,
    surface: &Surface,
) -> Vec<String> {
    let settings = coded.factors.iter().zip(coded.actual(at));
    let settings: Vec<String> = settings
        .map(|(factor, value)| format!("{} {}", factor.name, plain(value)))
        .collect();
    let shape = match optimum.map(|own| own.shape) {
        Some(Shape::Maximum) => "maximum",
        Some(Shape::Minimum) => "minimum",
        Some(Shape::Saddle) => "saddle",
        Some(Shape::Ridge) | None => "centre",
    };
    let drawn = optimum.map(|_| {
        format!(
            "± of a factor: half of where 95 % of estimated optima lie; other shape: share of \
             studies that find none; {} drawn studies of each size (seed {})",
            request.simulation.simulations, request.simulation.seed
        )
    });
    let known = [
        format!(
            "response surface of {} runs, {} coefficients; {shape}, {} at {}",
            coded.values.first().map_or(0, Vec::len),
            surface.coded.len(),
            plain(surface.value(at)),
            settings.join(", ")
        ),
        scatter.words.clone(),
    ];
    known.into_iter().chain(drawn).collect()
}
