//! A question and what is wanted → a plan.

use crate::asked::{Asked, asked, cost};
use crate::figure::figure_of_plan;
use crate::options::PlanOptions;
use crate::outcome::{PlanOutcome, PlanRow};
use crate::parse::Fruit;
use crate::question::{Question, Size, Told};
use crate::search::{Goal, smallest, told};
use crate::simulated::{coverage_findings, failed_findings};
use crate::sizes::{Sizes, sizes, stepped_over};
use crate::text::impacts_text;
use windfall_draw::plot::write_plot;
use windfall_draw::xy::{csv_of_figure, drawing_of_figure};
use windfall_files::error::Error;
use windfall_files::found::FindingOutcome;
use windfall_files::option_value::unusable;
use windfall_files::text::number::plain;
use windfall_files::write_file::check_outputs;

/// Power of the smallest detectable effect where none is wanted.
const USUAL_POWER: f64 = 0.8;

/// Points of a curve.
const CURVE_POINTS: usize = 60;

/// Plans a study, and draws the curve where a figure is asked for.
///
/// # Errors
/// An option cannot be used; no study tells what is wanted; the figure cannot be written.
pub(crate) fn plan(question: &dyn Question, options: &PlanOptions) -> Result<PlanOutcome, Error> {
    check_outputs([options.figure.as_deref()])?;
    let asked = asked(question, options)?;
    let (mut rows, looked_at) = rows(question, &asked)?;
    let mut findings = question.findings();
    findings.extend(missed(question, &asked, &rows)?);
    findings.extend(choose(&asked, &mut rows));
    findings.extend(failed_findings(&rows));
    findings.extend(coverage_findings(&rows, &looked_at, &asked.levels));
    let curve = match question.is_closed_form() {
        true => curve(question, &asked, &rows)?,
        false => looked_at,
    };
    let outcome = PlanOutcome {
        question: question.name(),
        about: question.about(),
        counted: question.counted(),
        half_width_of: question.half_width_of(),
        wanted_power: options.power,
        wanted_half_width: options.half_width,
        assurance: options.assurance,
        confidence: options.confidence,
        sides: if options.one_sided { 1 } else { 2 },
        detectable_power: options.power.unwrap_or(USUAL_POWER),
        budget: options.budget,
        rows,
        curve,
        findings,
    };
    if let Some(path) = &options.figure {
        let figure = figure_of_plan(&outcome);
        let svg = drawing_of_figure(&figure, options.width).svg(options.theme.colours());
        write_plot("--figure", path, &svg, &csv_of_figure(&figure)?)?;
    }
    Ok(outcome)
}

/// A row for each number of impacts, or for each size that was asked for; and all that were
/// looked at on the way.
fn rows(question: &dyn Question, asked: &Asked) -> Result<(Vec<PlanRow>, Vec<PlanRow>), Error> {
    let (mut rows, mut looked_at) = (Vec::new(), Vec::new());
    for impacts in asked.impacts.iter().copied() {
        let (chosen, studies) = match sizes(question, asked, impacts)? {
            Sizes::Searched(low, high) => {
                let wanted = (impacts, &asked.levels, asked.goal);
                let (chosen, studies) = smallest(question, wanted, (low, high))?;
                (vec![chosen], studies)
            }
            Sizes::Listed(numbers) => {
                let study = |fruit: usize| {
                    let size = Size { fruit, impacts };
                    Ok((size, told(question, size, &asked.levels)?))
                };
                let studies = numbers.into_iter().map(study);
                let studies = studies.collect::<Result<Vec<_>, Error>>()?;
                (studies.clone(), studies)
            }
        };
        let of =
            |with_detectable| move |(size, told)| row(question, asked, size, told, with_detectable);
        rows.extend(chosen.into_iter().map(of(true)));
        looked_at.extend(studies.into_iter().map(of(false)));
    }
    Ok((rows, looked_at))
}

fn row(
    question: &dyn Question,
    asked: &Asked,
    size: Size,
    told: Told,
    with_detectable: bool,
) -> PlanRow {
    let count = question.count(size);
    let cost = cost(question, asked, size);
    let budget = asked.costs.and_then(|costs| costs.budget);
    let power = match asked.goal {
        Goal::Power(power) => power,
        _ => USUAL_POWER,
    };
    let detectable = with_detectable.then(|| question.detectable(size, &asked.levels, power));
    PlanRow {
        fruit: size.fruit,
        impacts: size.impacts,
        fruit_in_all: count.fruit,
        impacts_in_all: count.impacts,
        detectable: detectable.flatten().filter(|value| value.is_finite()),
        cost,
        reached: asked.goal.reached(&told, &asked.levels),
        within_budget: cost.zip(budget).map(|(cost, budget)| cost <= budget),
        best: false,
        power: told.power,
        half_width: told.half_width,
        half_width_se: told.half_width_se,
        df: told.df,
        simulations: told.simulations,
        failed: told.failed,
        failures: told.failures,
        singular: told.singular,
        also: told.also,
    }
}

/// Studies of many sizes.
fn curve(question: &dyn Question, asked: &Asked, rows: &[PlanRow]) -> Result<Vec<PlanRow>, Error> {
    let reached = rows.iter().filter(|row| row.reached != Some(false));
    let largest = reached.map(|row| row.fruit).max().unwrap_or_default();
    let mut points = Vec::new();
    for impacts in &asked.impacts {
        let step = question.step();
        let fewest = question.fewest(*impacts)?.next_multiple_of(step);
        let (low, high) = match &asked.fruit {
            Fruit::Range(low, high) => ((*low).max(fewest), *high),
            Fruit::Open(most) => {
                // half-widths of the fewest fruit would hide the wanted one
                let low = match asked.goal {
                    Goal::HalfWidth(_) => fewest.max(largest / 4),
                    _ => fewest,
                };
                (low, (largest + largest / 2).min(*most))
            }
            Fruit::Listed(_) => (fewest, largest),
        };
        let low = low.next_multiple_of(step);
        for fruit in stepped_over(low, high.max(low + step), CURVE_POINTS, step) {
            let size = Size {
                fruit,
                impacts: *impacts,
            };
            let told = told(question, size, &asked.levels)?;
            points.push(row(question, asked, size, told, false));
        }
    }
    Ok(points)
}

/// Numbers of impacts with which no study tells enough; an error where none at all does.
fn missed(
    question: &dyn Question,
    asked: &Asked,
    rows: &[PlanRow],
) -> Result<Option<FindingOutcome>, Error> {
    let short: Vec<&PlanRow> = rows
        .iter()
        .filter(|row| row.reached == Some(false))
        .collect();
    if short.is_empty() || matches!(asked.fruit, Fruit::Listed(_)) {
        return Ok(None);
    }
    let told = |row: &PlanRow| {
        let value = match asked.goal {
            Goal::Power(_) => row.power.map(|power| power.value),
            _ => row.half_width,
        };
        format!(
            "{} {} with {} each reach {}",
            row.fruit,
            question.counted(),
            impacts_text(row.impacts),
            value.map_or_else(|| "nothing".to_owned(), plain)
        )
    };
    if short.len() == rows.len() {
        let option = match asked.goal {
            Goal::Power(power) => format!("--power {power}"),
            Goal::HalfWidth(width) => format!("--half-width {width}"),
            Goal::Open => String::new(),
        };
        let best = short
            .iter()
            .copied()
            .reduce(|a, b| if tells_more(asked.goal, b, a) { b } else { a });
        let best = best.map(told).unwrap_or_default();
        let problem = format!(
            "no study that was tried tells so much: {best}; ask for less, or allow more fruit \
             (--most-fruit, --fruit) or more impacts on each (--impacts)"
        );
        return Err(unusable(option, problem));
    }
    let said: Vec<String> = short.into_iter().map(told).collect();
    Ok(Some(FindingOutcome::new(
        "not-reached",
        format!(
            "not enough even with the most fruit that were tried: {}",
            said.join("; ")
        ),
    )))
}

/// Whether a study tells more than another, by what is wanted.
fn tells_more(goal: Goal, own: &PlanRow, other: &PlanRow) -> bool {
    let power = |row: &PlanRow| row.power.map_or(f64::NEG_INFINITY, |power| power.value);
    let narrow = |row: &PlanRow| row.half_width.map_or(f64::NEG_INFINITY, |half| -half);
    match goal {
        Goal::Power(_) => power(own) > power(other),
        Goal::HalfWidth(_) => narrow(own) > narrow(other),
        Goal::Open => (power(own), narrow(own)) > (power(other), narrow(other)),
    }
}

/// Marks the best study: the cheapest that tells enough, or what tells most for the budget.
fn choose(asked: &Asked, rows: &mut [PlanRow]) -> Option<FindingOutcome> {
    asked.costs?;
    let cost = |row: &PlanRow| row.cost.unwrap_or(f64::INFINITY);
    let enough = rows.iter().filter(|row| row.reached != Some(false));
    let cheapest = enough.clone().map(cost).reduce(f64::min)?;
    let paid = enough.filter(|row| row.within_budget != Some(false));
    let best = match asked.goal {
        Goal::Open => {
            // without a budget nothing says how much is to be paid
            asked.costs.and_then(|costs| costs.budget)?;
            paid.reduce(|a, b| if tells_more(asked.goal, b, a) { b } else { a })
        }
        _ => paid.reduce(|a, b| if cost(b) < cost(a) { b } else { a }),
    };
    let Some(best) = best.cloned() else {
        let of = match rows.iter().any(|row| row.reached.is_some()) {
            true => "none of the studies tried that tell enough: the cheapest of them",
            false => "none of the studies tried: the cheapest",
        };
        return Some(FindingOutcome::new(
            "over-budget",
            format!("the budget pays for {of} costs {}", plain(cheapest)),
        ));
    };
    let same = |row: &&mut PlanRow| row.fruit == best.fruit && row.impacts == best.impacts;
    if let Some(row) = rows.iter_mut().find(same) {
        row.best = true;
    }
    None
}
