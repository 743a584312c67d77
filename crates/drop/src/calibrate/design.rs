//! Calibration by design and surface: a central composite design over the free
//! parameters, the simulator at each point, response surfaces, the settings that
//! meet the targets, and the simulator there.

use crate::calibrate::features::{height_features, telling_heights};
use crate::calibrate::law::{FreeLaw, Setting, law_error};
use crate::calibrate::outcome::{
    DepthOutcome, DesignFactorOutcome, DesignHeight, DesignMember, DesignOptimum, DesignRunOutcome,
    DesignSurfaceOutcome, DesignTerm, DesignWayOutcome, VerifiedResponse,
};
use crate::calibrate::target::{DropData, INTERVAL, PEAK, heights_of, mean_feature, same_height};
use rayon::prelude::*;
use windfall_contact::expression::LawExpression;
use windfall_contact::law::EndRule;
use windfall_contact::laws::kind::Law;
use windfall_design::composite::{Alpha, CompositeOptions, Ends, central_composite};
use windfall_design::kind::{Design, Factor};
use windfall_drop_rig::measured::{DropFeature, feature_values};
use windfall_drop_rig::rig::DropRig;
use windfall_files::error::Error;
use windfall_files::found::FindingOutcome;
use windfall_files::option_value::unusable;
use windfall_files::text::number::plain;
use windfall_statistics::model::anova::{AnovaType, anova};
use windfall_statistics::surface::analysis::{Surface, fit_surface};
use windfall_statistics::surface::coding::FactorCoding;
use windfall_statistics::surface::desirability::{
    Goal, Optimum, Region, Wanted, best_settings, equally_good,
};
use windfall_statistics::surface::terms::{letter, monomial_name, surface_terms};
use windfall_tables::regress::findings::finding;

/// Responses of the design.
pub(crate) const RESPONSES: [DropFeature; 2] = [PEAK, INTERVAL];

/// A term leaves a surface at or above this probability, unless a higher one needs
/// it: the default of Design-Expert and SPSS.
const REMOVE: f64 = 0.1;

/// Members of the family that are looked for.
const MEMBERS: usize = 9;

/// Shares of the depth of full damping at which the responses are compared.
const DEPTHS: [f64; 3] = [100.0, 10.0, 1.0];

/// The design over the free parameters.
///
/// # Errors
/// A parameter has no range, or there are fewer than two.
pub fn design_of_law(law: &FreeLaw) -> Result<Design, Error> {
    let unusable = |problem: String| unusable("[calibrate] ways = [\"design\"]", problem);
    let names = law.names();
    let mut factors = Vec::new();
    for (place, range) in law.ranges.iter().enumerate() {
        let Some(range) = range else {
            return Err(unusable(format!(
                "the free parameter {name} has no range; add it in campaign.toml: [calibrate] \
                 ranges = {{ {name} = [\"…\", \"…\"] }}",
                name = names[place]
            )));
        };
        let unit = law.level_unit(place);
        let factor = Factor::between(&names[place], &unit, range.low, range.high);
        factors.push(factor.map_err(|error| unusable(error.to_string()))?);
    }
    let options = CompositeOptions {
        alpha: Alpha::Rotatable,
        ends: Ends::Axial,
        // A simulation has no noise: one centre point says all.
        centre: 1,
        ..CompositeOptions::default()
    };
    central_composite(factors, &options).map_err(|error| unusable(error.to_string()))
}

/// Responses of the simulator at the points of a design, run in parallel.
///
/// # Errors
/// A point cannot be simulated; names its levels.
pub fn run_design(
    design: &Design,
    law: &FreeLaw,
    rig: &DropRig,
    height: f64,
    end: EndRule,
) -> Result<Vec<DesignRunOutcome>, Error> {
    let run = |coded: &Vec<f64>| {
        let levels = levels_of(design, coded);
        let own = law.law_of_levels(&levels)?;
        let responses = feature_values(&own, rig, height, &RESPONSES, end).map_err(|source| {
            let subject = format!("run of the design at {}", LawExpression::from(own));
            Error::identify(subject, source)
        })?;
        Ok(DesignRunOutcome {
            coded: coded.clone(),
            levels,
            responses,
        })
    };
    let points = design.runs.par_iter().map(|run| &run.coded);
    points.map(run).collect()
}

/// Quadratic surfaces of the responses without insignificant terms; the hierarchy is kept.
///
/// # Errors
/// Too few runs, or a response that does not change.
pub fn design_surfaces(design: &Design, runs: &[DesignRunOutcome]) -> Result<Vec<Surface>, Error> {
    let names: Vec<String> = design.factors.iter().map(|f| f.name.clone()).collect();
    let codings = design.factors.iter().map(|factor| FactorCoding {
        name: factor.name.clone(),
        centre: factor.centre,
        half: factor.half,
    });
    let codings: Vec<FactorCoding> = codings.collect();
    let columns: Vec<Vec<f64>> = (0..names.len())
        .map(|factor| runs.iter().map(|run| run.coded[factor]).collect())
        .collect();
    let surface = |place: usize| {
        let y: Vec<f64> = runs.iter().map(|run| run.responses[place]).collect();
        let mut terms = surface_terms("quadratic", &names)?;
        terms.letters = true;
        loop {
            let fitted = fit_surface(&codings, &terms, &columns, &y, 0.95)?;
            match leaving(&fitted) {
                Some(term) => terms.monomials.remove(term),
                None => return Ok(fitted),
            };
        }
    };
    let surfaces: Result<Vec<Surface>, _> = (0..RESPONSES.len()).map(surface).collect();
    surfaces.map_err(Error::Statistics)
}

/// The least significant term, if it may go and no higher term needs it.
fn leaving(surface: &Surface) -> Option<usize> {
    let monomials = &surface.terms.monomials;
    // A model of one term says something; none has no test.
    if monomials.len() < 2 || surface.fit.residual_df == 0 {
        return None;
    }
    let every: Vec<usize> = (0..monomials.len()).collect();
    let table = anova(&surface.frame, &surface.reduced, &every, AnovaType::Partial);
    let needed = |term: usize| {
        let mut others = monomials.iter().enumerate().filter(|(i, _)| *i != term);
        others.any(|(_, other)| monomials[term].iter().zip(other).all(|(own, of)| own <= of))
    };
    let p = |term: &usize| table.rows[*term].p;
    every
        .iter()
        .copied()
        .filter(|term| !needed(*term) && p(term) >= REMOVE)
        .max_by(|a, b| p(a).total_cmp(&p(b)))
}

/// Calibrates by design and surface.
///
/// # Errors
/// A range is missing, or a point of the design cannot be simulated.
pub fn calibrate_by_design(
    setting: &Setting,
) -> Result<(DesignWayOutcome, Vec<FindingOutcome>), Error> {
    let design = design_of_law(setting.law)?;
    let mut rig = setting.rig.rig;
    rig.mass = setting.target.mass.value;
    let height = setting.target.height.value;
    let runs = run_design(&design, setting.law, &rig, height, setting.end)?;
    let surfaces = design_surfaces(&design, &runs)?;
    let features = setting.target.features.iter();
    let goals: Vec<Goal> = features
        .map(|own| goal(own.value, setting.settings.tolerance))
        .collect();
    let alpha = design.alpha.unwrap_or(1.0);
    let count = design.factors.len();
    let region = Region {
        low: vec![-alpha; count],
        high: vec![alpha; count],
        radius: None,
    };
    let best = best_settings(&surfaces, &goals, &region);
    let family = equally_good(&surfaces, &goals, &region, &best, Some(0), MEMBERS);
    let optimum = optimum_outcome(setting, &design, &rig, &best)?;
    let members = family.iter().flat_map(|family| &family.members);
    let members: Vec<DesignMember> = members
        .map(|member| member_outcome(setting, &design, &rig, member))
        .collect::<Result<_, Error>>()?;
    let mut findings = Vec::new();
    if best.desirability == 0.0 {
        let message = format!(
            "no settings within the ranges come within {} % of both targets on the surfaces",
            plain(100.0 * setting.settings.tolerance)
        );
        findings.push(finding("targets-out-of-reach", message));
    }
    if let Some(family) = &family {
        findings.push(one_of_a_family(&design, family.dimension, &members));
    }
    let law = setting.law.law_of_levels(&optimum.levels)?;
    let outcome = DesignWayOutcome {
        kind: design.kind.clone(),
        alpha,
        factors: factor_outcomes(&design, setting.law),
        surfaces: surface_outcomes(&surfaces, &runs),
        heights: other_heights(setting, &law),
        depth: depth_outcome(setting, &rig),
        runs,
        optimum,
        family: members,
    };
    findings.extend(verification_findings(&outcome, setting.settings.tolerance));
    Ok((outcome, findings))
}

fn goal(target: f64, tolerance: f64) -> Goal {
    Goal {
        wanted: Wanted::Target(target),
        low: target * (1.0 - tolerance),
        high: target * (1.0 + tolerance),
        weight_low: 1.0,
        weight_high: 1.0,
        importance: 3.0,
    }
}

fn one_of_a_family(design: &Design, dimension: usize, members: &[DesignMember]) -> FindingOutcome {
    let ends = [members.first(), members.last()].map(|member| {
        let levels = member.map_or(&[][..], |member| &member.levels);
        let pairs = design.factors.iter().zip(levels);
        let words = pairs.map(|(factor, level)| format!("{} = {}", factor.name, plain(*level)));
        words.collect::<Vec<_>>().join(", ")
    });
    let message = format!(
        "the optimum is one of a family: {dimension} direction(s) of the settings are open, and \
         ({}) to ({}) meet the targets as well on these surfaces; two responses do not determine \
         {} parameters",
        ends[0],
        ends[1],
        design.factors.len()
    );
    finding("one-of-a-family", message)
}

fn levels_of(design: &Design, coded: &[f64]) -> Vec<f64> {
    let pairs = design.factors.iter().zip(coded);
    pairs.map(|(factor, x)| factor.actual(*x)).collect()
}

fn optimum_outcome(
    setting: &Setting,
    design: &Design,
    rig: &DropRig,
    best: &Optimum,
) -> Result<DesignOptimum, Error> {
    let levels = levels_of(design, &best.point);
    let law = setting.law.law_of_levels(&levels)?;
    let height = setting.target.height.value;
    let simulated =
        feature_values(&law, rig, height, &RESPONSES, setting.end).map_err(law_error)?;
    let responses = (0..RESPONSES.len()).map(|place| {
        let measured = Some(setting.target.features[place].value);
        verified(place, measured, best.values[place], Some(simulated[place]))
    });
    Ok(DesignOptimum {
        levels,
        law: LawExpression::from(law).to_string(),
        desirability: best.desirability,
        responses: responses.collect(),
    })
}

fn verified(
    place: usize,
    measured: Option<f64>,
    predicted: f64,
    simulated: Option<f64>,
) -> VerifiedResponse {
    let difference = |measured: f64| simulated.map(|s| (s - measured) / measured);
    VerifiedResponse {
        response: RESPONSES[place].name(),
        unit: RESPONSES[place].unit().to_owned(),
        difference: measured.and_then(difference),
        measured,
        predicted,
        simulated,
    }
}

fn member_outcome(
    setting: &Setting,
    design: &Design,
    rig: &DropRig,
    member: &Optimum,
) -> Result<DesignMember, Error> {
    let levels = levels_of(design, &member.point);
    let law = setting.law.law_of_levels(&levels)?;
    let own = setting.target.height.value;
    let heights = telling_heights(&heights_of(setting.drops), own).into_iter();
    let shown = heights.map(|height| height_features(&law, rig, height, setting.end));
    Ok(DesignMember {
        heights: shown.collect(),
        desirability: member.desirability,
        levels,
    })
}

/// The optimum against the drops from every height.
fn other_heights(setting: &Setting, law: &Law) -> Vec<DesignHeight> {
    let of = |height: f64| {
        let drops = setting.drops.iter();
        let own = drops.filter(|drop| same_height(drop.height.value, height));
        let own: Vec<&DropData> = own.collect();
        let mut rig = setting.rig.rig;
        rig.mass = own.iter().map(|drop| drop.mass.value).sum::<f64>() / own.len() as f64;
        let simulated = feature_values(law, &rig, height, &RESPONSES, setting.end).ok();
        let responses = (0..RESPONSES.len()).map(|place| {
            let measured = mean_feature(&own, RESPONSES[place]).map(|feature| feature.value);
            let simulated = simulated.as_ref().map(|values| values[place]);
            verified(place, measured, f64::NAN, simulated)
        });
        DesignHeight {
            height,
            drops: own.len(),
            responses: responses.collect(),
        }
    };
    heights_of(setting.drops).into_iter().map(of).collect()
}

/// Responses over the depth of full damping at the start law, where it has one.
fn depth_outcome(setting: &Setting, rig: &DropRig) -> Option<DepthOutcome> {
    let start = setting.law.start;
    let position = start.kind().describe().index_of("d")?;
    let values = start.parameters();
    let height = setting.target.height.value;
    let row = |times: f64| {
        let mut values = values.clone();
        values[position] *= times;
        let law = start.kind().with_parameters(&values).ok()?;
        let responses = feature_values(&law, rig, height, &RESPONSES, setting.end).ok()?;
        Some((values[position], responses))
    };
    let rows: Vec<(f64, Vec<f64>)> = DEPTHS.into_iter().filter_map(row).collect();
    let count = rows.len() as f64;
    if rows.len() < 2 {
        return None;
    }
    let places = 0..RESPONSES.len();
    let of = |place: usize| rows.iter().map(move |(_, responses)| responses[place]);
    let mean = |place| of(place).sum::<f64>() / count;
    let mean: Vec<f64> = places.clone().map(mean).collect();
    let sd = |place| {
        let squares = of(place).map(|response| (response - mean[place]).powi(2));
        (squares.sum::<f64>() / count).sqrt()
    };
    let sd: Vec<f64> = places.map(sd).collect();
    Some(DepthOutcome {
        law: LawExpression::from(start).to_string(),
        cv: sd.iter().zip(&mean).map(|(sd, mean)| sd / mean).collect(),
        rows,
        mean,
        sd,
    })
}

fn factor_outcomes(design: &Design, law: &FreeLaw) -> Vec<DesignFactorOutcome> {
    let factors = design.factors.iter().zip(&law.ranges).enumerate();
    let outcome = |(place, (factor, range)): (usize, (&Factor, &Option<_>))| {
        let range: Option<&crate::calibrate_settings::ParameterRange> = range.as_ref();
        DesignFactorOutcome {
            letter: letter(place),
            name: factor.name.clone(),
            unit: factor.unit.clone(),
            low: range.map_or(f64::NAN, |range| range.low),
            high: range.map_or(f64::NAN, |range| range.high),
            centre: factor.centre,
            half: factor.half,
        }
    };
    factors.map(outcome).collect()
}

fn surface_outcomes(surfaces: &[Surface], runs: &[DesignRunOutcome]) -> Vec<DesignSurfaceOutcome> {
    let outcome = |(place, surface): (usize, &Surface)| {
        let y: Vec<f64> = runs.iter().map(|run| run.responses[place]).collect();
        let every: Vec<usize> = (0..surface.terms.monomials.len()).collect();
        let table = anova(&surface.frame, &surface.reduced, &every, AnovaType::Partial);
        let quality = surface.fit.quality(&y);
        let names: Vec<String> = surface.factors.iter().map(|f| f.name.clone()).collect();
        let terms = surface.actual.iter().map(|(powers, actual)| {
            let own = surface.terms.monomials.iter().position(|m| m == powers);
            let coded = match (own, powers.iter().all(|power| *power == 0)) {
                (_, true) => surface.coded[0],
                (Some(term), _) => surface.coded[term + 1],
                (None, _) => 0.0,
            };
            DesignTerm {
                term: monomial_name(powers, &names, true),
                coded,
                actual: *actual,
            }
        });
        let letters = surface.terms.monomials.iter();
        let letters: Vec<String> = letters.map(|m| monomial_name(m, &names, true)).collect();
        DesignSurfaceOutcome {
            response: RESPONSES[place].name(),
            unit: RESPONSES[place].unit().to_owned(),
            model: letters.join(" + "),
            terms: terms.collect(),
            whole: surface.fit.whole().row(),
            anova: table.rows,
            residual_ss: surface.fit.residual_ss,
            residual_df: surface.fit.residual_df as f64,
            total_ss: surface.fit.total_ss,
            r2: quality.r2,
            r2_adjusted: quality.r2_adjusted,
            r2_predicted: quality.r2_predicted,
            sigma: quality.sigma,
        }
    };
    surfaces.iter().enumerate().map(outcome).collect()
}

fn verification_findings(outcome: &DesignWayOutcome, tolerance: f64) -> Vec<FindingOutcome> {
    let mut findings = Vec::new();
    for response in &outcome.optimum.responses {
        let Some(simulated) = response.simulated else {
            continue;
        };
        let off = simulated / response.predicted - 1.0;
        if off.abs() > 0.5 * tolerance {
            let message = format!(
                "{}: the simulator at the optimum differs by {:+.1} % from its surface; the way \
                 \"features\" needs no surface",
                response.response,
                100.0 * off
            );
            findings.push(finding("surface-off", message));
        }
    }
    for at in &outcome.heights {
        for response in &at.responses {
            let off = response.difference.filter(|off| off.abs() > tolerance);
            if let Some(off) = off {
                let message = format!(
                    "{} from {} m: the optimum differs by {:+.1} % from what was measured",
                    response.response,
                    plain(at.height),
                    100.0 * off
                );
                findings.push(finding("other-height-off", message));
            }
        }
    }
    findings
}
