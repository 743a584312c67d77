//! A question and what is wanted → a plan.

use crate::figure::figure_of_plan;
use crate::options::PlanOptions;
use crate::outcome::{PlanOutcome, PlanRow};
use crate::parse::{Fruit, at_least_zero, fruit, impacts, part, positive};
use crate::question::{Levels, Question, Size, Told};
use crate::search::{Goal, smallest, told};
use crate::text::impacts_text;
use windfall_draw::plot::write_plot;
use windfall_draw::xy::{csv_of_figure, svg_of_figure};
use windfall_files::error::Error;
use windfall_files::found::FindingOutcome;
use windfall_files::option_value::unusable;
use windfall_files::text::number::plain;
use windfall_files::write_file::check_outputs;
use windfall_statistics::power::Sides;

/// Power of the smallest detectable effect where none is wanted.
const USUAL_POWER: f64 = 0.8;

/// Points of a curve, and rows for a range.
const CURVE_POINTS: usize = 60;
const RANGE_ROWS: usize = 7;

/// What fruit and impacts cost.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Costs {
    fruit: f64,
    impact: f64,
    budget: Option<f64>,
}

/// What is asked for, read and checked.
struct Asked {
    fruit: Fruit,
    impacts: Vec<usize>,
    goal: Goal,
    levels: Levels,
    costs: Option<Costs>,
}

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
    findings.extend(simulated_findings(&rows));
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
        let svg = svg_of_figure(&figure, options.theme.colours());
        write_plot(path, svg, &csv_of_figure(&figure)?)?;
    }
    Ok(outcome)
}

fn asked(question: &dyn Question, options: &PlanOptions) -> Result<Asked, Error> {
    part("--confidence", options.confidence)?;
    if let Some(assurance) = options.assurance {
        part("--assurance", assurance)?;
        if !question.has_assurance() {
            let problem = "the half-width of this question is simulated, and its mean is planned";
            return Err(unusable("--assurance", problem));
        }
    }
    let costs = costs(options)?;
    let asked = Asked {
        fruit: fruit(options.fruit.as_deref(), options.most_fruit)?,
        impacts: impacts(options.impacts.as_deref(), question.usual_impacts())?,
        goal: goal(options)?,
        levels: Levels {
            confidence: options.confidence,
            sides: match options.one_sided {
                true => Sides::One,
                false => Sides::Two,
            },
            assurance: options.assurance,
        },
        costs,
    };
    let open = matches!(asked.fruit, Fruit::Open(_));
    let budget = asked.costs.is_some_and(|costs| costs.budget.is_some());
    match asked.goal {
        Goal::Open if open && !budget => {
            let problem = "say what is wanted, --power 0.8 or --half-width WIDTH, or how many \
                           fruit there are: --fruit 12";
            Err(unusable("--fruit", problem))
        }
        Goal::Power(_) if open && !budget && !question.has_effect() => {
            let problem = "the effect that is to be found is not stated: say it, or give --fruit \
                           to see the smallest effect that so many find";
            Err(unusable(question.effect_option(), problem))
        }
        _ => Ok(asked),
    }
}

fn goal(options: &PlanOptions) -> Result<Goal, Error> {
    match (options.power, options.half_width) {
        (Some(power), _) => {
            let alpha = 1.0 - options.confidence;
            if part("--power", power)? <= alpha {
                let problem = format!(
                    "{power} is no more than the level of the test, {}, which no fruit at all \
                     would reach: 0.8 and 0.9 are usual",
                    plain(alpha)
                );
                return Err(unusable("--power", problem));
            }
            Ok(Goal::Power(power))
        }
        (None, Some(width)) => Ok(Goal::HalfWidth(positive("--half-width", width)?)),
        (None, None) => Ok(Goal::Open),
    }
}

fn costs(options: &PlanOptions) -> Result<Option<Costs>, Error> {
    let given = |option: &str, cost: Option<f64>| match cost {
        Some(cost) => at_least_zero(option, cost),
        None => Ok(0.0),
    };
    let fruit = given("--cost-fruit", options.cost_fruit)?;
    let impact = given("--cost-impact", options.cost_impact)?;
    if let Some(budget) = options.budget {
        positive("--budget", budget)?;
        if fruit + impact == 0.0 {
            let problem = "a budget needs costs above zero: --cost-fruit, --cost-impact or both";
            return Err(unusable("--budget", problem));
        }
    }
    let stated = options.cost_fruit.is_some() || options.cost_impact.is_some();
    Ok(stated.then_some(Costs {
        fruit,
        impact,
        budget: options.budget,
    }))
}

/// Sizes of studies with one number of impacts on each fruit.
enum Sizes {
    /// These.
    Listed(Vec<usize>),
    /// The smallest between two that tells enough.
    Searched(usize, usize),
}

fn sizes(question: &dyn Question, asked: &Asked, impacts: usize) -> Result<Sizes, Error> {
    let fewest = question.fewest(impacts)?;
    let least = match &asked.fruit {
        Fruit::Listed(numbers) => numbers.first().copied().unwrap_or_default(),
        Fruit::Range(_, most) | Fruit::Open(most) => *most,
    };
    if least < fewest {
        return Err(too_few(question, least, fewest));
    }
    let searched = match asked.goal {
        Goal::Open => false,
        Goal::Power(_) => question.has_effect(),
        Goal::HalfWidth(_) => true,
    };
    Ok(match (&asked.fruit, searched) {
        (Fruit::Listed(numbers), _) => Sizes::Listed(numbers.clone()),
        (Fruit::Range(low, high), true) => Sizes::Searched((*low).max(fewest), *high),
        (Fruit::Range(low, high), false) => {
            Sizes::Listed(spread_over((*low).max(fewest), *high, RANGE_ROWS))
        }
        (Fruit::Open(most), true) => Sizes::Searched(fewest, *most),
        (Fruit::Open(most), false) => {
            let fruit = affordable(question, asked, impacts, (fewest, *most))?;
            Sizes::Listed(vec![fruit])
        }
    })
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

fn too_few(question: &dyn Question, found: usize, fewest: usize) -> Error {
    let problem = format!(
        "{found} {} cannot tell how much fruit differ: at least {fewest} are needed",
        question.counted()
    );
    unusable("--fruit", problem)
}

/// The most fruit that a budget pays.
fn affordable(
    question: &dyn Question,
    asked: &Asked,
    impacts: usize,
    (fewest, most): (usize, usize),
) -> Result<usize, Error> {
    let pays = |fruit: usize| {
        let cost = cost(question, asked, Size { fruit, impacts });
        let budget = asked.costs.and_then(|costs| costs.budget);
        cost.zip(budget).is_none_or(|(cost, budget)| cost <= budget)
    };
    if !pays(fewest) {
        let size = Size {
            fruit: fewest,
            impacts,
        };
        let needed = cost(question, asked, size).unwrap_or_default();
        let problem = format!(
            "the smallest study, {fewest} {} with {} each, costs {}",
            question.counted(),
            impacts_text(impacts),
            plain(needed)
        );
        return Err(unusable("--budget", problem));
    }
    let (mut low, mut high) = (fewest, most.max(fewest) + 1);
    while high - low > 1 {
        let middle = low.midpoint(high);
        match pays(middle) {
            true => low = middle,
            false => high = middle,
        }
    }
    Ok(low)
}

fn cost(question: &dyn Question, asked: &Asked, size: Size) -> Option<f64> {
    let count = question.count(size);
    let costs = asked.costs?;
    Some(costs.fruit * count.fruit as f64 + costs.impact * count.impacts as f64)
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
        reached: asked.goal.reached(&told),
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

/// Whole numbers from low to high, at most so many, evenly spread.
fn spread_over(low: usize, high: usize, most: usize) -> Vec<usize> {
    let span = high - low;
    let points = (span + 1).min(most);
    let place = |k: usize| low + (k * span + (points - 1) / 2) / (points - 1).max(1);
    (0..points).map(place).collect()
}

/// Studies of many sizes.
fn curve(question: &dyn Question, asked: &Asked, rows: &[PlanRow]) -> Result<Vec<PlanRow>, Error> {
    let reached = rows.iter().filter(|row| row.reached != Some(false));
    let largest = reached.map(|row| row.fruit).max().unwrap_or_default();
    let mut points = Vec::new();
    for impacts in &asked.impacts {
        let fewest = question.fewest(*impacts)?;
        let (low, high) = match &asked.fruit {
            Fruit::Range(low, high) => ((*low).max(fewest), *high),
            Fruit::Open(most) => (fewest, (largest + largest / 2).min(*most)),
            Fruit::Listed(_) => (fewest, largest),
        };
        for fruit in spread_over(low, high.max(low + 1), CURVE_POINTS) {
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
        return Some(FindingOutcome::new(
            "over-budget",
            format!(
                "the budget pays for no study that tells enough: the cheapest costs {}",
                plain(cheapest)
            ),
        ));
    };
    let same = |row: &&mut PlanRow| row.fruit == best.fruit && row.impacts == best.impacts;
    if let Some(row) = rows.iter_mut().find(same) {
        row.best = true;
    }
    None
}

/// Simulated studies that failed.
fn simulated_findings(rows: &[PlanRow]) -> Vec<FindingOutcome> {
    let failed = rows.iter().filter(|row| row.failed > 0);
    let finding = |row: &PlanRow| {
        let causes = row.failures.iter();
        let causes: Vec<String> = causes
            .map(|(why, count)| format!("{count}: {why}"))
            .collect();
        let so = match row.power {
            Some(_) => "and count as not having found the effect",
            None => "and are left out of the mean, which is not told where they are many",
        };
        FindingOutcome::new(
            "simulations-failed",
            format!(
                "{} fruit with {}: {} of {} simulated studies could not be evaluated {so} ({})",
                row.fruit,
                impacts_text(row.impacts),
                row.failed,
                row.simulations.unwrap_or_default(),
                causes.join("; ")
            ),
        )
    };
    failed.map(finding).collect()
}
