//! The most desirable settings, all that are as good, and grids of predictions.

use crate::regress::findings::finding;
use crate::surface::outcome::{FamilyOutcome, GridOutcome, PredictedResponse, SettingOutcome};
use windfall_files::error::Error;
use windfall_files::found::FindingOutcome;
use windfall_files::option_value::unusable;
use windfall_files::text::number::plain;
use windfall_statistics::surface::analysis::Surface;
use windfall_statistics::surface::coding::CodedFactors;
use windfall_statistics::surface::desirability::{
    Goal, Optimum, Region, best_settings, desirability, equally_good,
};

/// Most points of a grid along a factor.
const MOST_POINTS: usize = 1001;

/// What is wanted.
pub(crate) struct SettingsRequest<'a> {
    pub names: &'a [String],
    /// What is wanted of each.
    pub goals: Vec<Option<Goal>>,
    pub hold: &'a [String],
    /// Factor at whose values equally good settings are given.
    pub along: Option<&'a str>,
    /// How many values.
    pub members: usize,
}

impl SettingsRequest<'_> {
    /// The centre in coded units, with held factors where they are held.
    pub fn centre(&self, coded: &CodedFactors) -> Result<Vec<f64>, Error> {
        let mut centre = vec![0.0; coded.factors.len()];
        for (place, value) in held(self, coded)? {
            centre[place] = value;
        }
        Ok(centre)
    }
}

/// An optimum, its family and what is to be said of them.
pub(crate) type Settings = (
    Option<SettingOutcome>,
    Option<FamilyOutcome>,
    Vec<FindingOutcome>,
);

/// Finds the most desirable settings, if anything is wanted.
pub(crate) fn settings(
    request: &SettingsRequest,
    surfaces: &[Surface],
    coded: &CodedFactors,
) -> Result<Settings, Error> {
    let wanted: Vec<usize> = (0..surfaces.len())
        .filter(|place| request.goals[*place].is_some())
        .collect();
    if wanted.is_empty() {
        return Ok((None, None, Vec::new()));
    }
    let region = region(request, coded)?;
    let goals: Vec<Goal> = request.goals.iter().flatten().copied().collect();
    let own: Vec<Surface> = wanted
        .iter()
        .map(|place| surfaces[*place].clone())
        .collect();
    let best = best_settings(&own, &goals, &region);
    let mut findings = Vec::new();
    if best.desirability == 0.0 {
        findings.push(finding(
            "undesirable",
            "no settings within the range of the runs give every response a desirability above \
             zero: widen the limits of the goals"
                .to_owned(),
        ));
        return Ok((
            Some(setting(request, surfaces, coded, &best)),
            None,
            findings,
        ));
    }
    let along = request.along.map(|name| place_of(name, coded, "--along"));
    let along = along.transpose()?;
    let family = equally_good(&own, &goals, &region, &best, along, request.members);
    let family = family.map(|family| {
        let factor = &coded.factors[family.along];
        findings.push(finding(
            "not-unique",
            format!(
                "the optimum is one of many: settings that are as good can change in {} direction{}, \
                 {} from {} to {}; a further response, a held factor or a prior must choose",
                family.dimension,
                if family.dimension == 1 { "" } else { "s" },
                factor.name,
                plain(factor.actual(family.range.0)),
                plain(factor.actual(family.range.1)),
            ),
        ));
        let members = family.members.iter();
        FamilyOutcome {
            dimension: family.dimension,
            along: factor.name.clone(),
            from: factor.actual(family.range.0),
            to: factor.actual(family.range.1),
            members: members.map(|m| setting(request, surfaces, coded, m)).collect(),
        }
    });
    Ok((
        Some(setting(request, surfaces, coded, &best)),
        family,
        findings,
    ))
}

fn setting(
    request: &SettingsRequest,
    surfaces: &[Surface],
    coded: &CodedFactors,
    optimum: &Optimum,
) -> SettingOutcome {
    let responses = surfaces.iter().enumerate().map(|(place, surface)| {
        let predicted = surface.predict(std::slice::from_ref(&optimum.point))[0];
        PredictedResponse {
            response: request.names[place].clone(),
            predicted: predicted.mean,
            low: predicted.low,
            high: predicted.high,
            desirability: request.goals[place].as_ref().map_or(f64::NAN, |goal| {
                desirability(goal, surface.value(&optimum.point))
            }),
        }
    });
    SettingOutcome {
        actual: coded.actual(&optimum.point),
        coded: optimum.point.clone(),
        responses: responses.collect(),
        desirability: optimum.desirability,
    }
}

fn place_of(name: &str, coded: &CodedFactors, option: &str) -> Result<usize, Error> {
    let place = coded
        .factors
        .iter()
        .position(|factor| factor.name == name.trim());
    place.ok_or_else(|| {
        let names: Vec<&str> = coded.factors.iter().map(|f| f.name.as_str()).collect();
        let problem = format!("this is none of the factors {}", names.join(", "));
        unusable(format!("{option} {name}"), problem)
    })
}

/// The ranges of the runs, with held factors where they are held.
fn region(request: &SettingsRequest, coded: &CodedFactors) -> Result<Region, Error> {
    let ranges = (0..coded.factors.len()).map(|factor| coded.range(factor));
    let (low, high) = ranges.unzip();
    let mut region = Region {
        low,
        high,
        radius: None,
    };
    for (place, value) in held(request, coded)? {
        (region.low[place], region.high[place]) = (value, value);
    }
    Ok(region)
}

/// Held factors with their coded values.
fn held(request: &SettingsRequest, coded: &CodedFactors) -> Result<Vec<(usize, f64)>, Error> {
    let parsed = request.hold.iter().map(|text| {
        let expected = || unusable(format!("--hold {text}"), "expected FACTOR=VALUE");
        let (name, value) = text.split_once('=').ok_or_else(expected)?;
        let value: f64 = value
            .trim()
            .parse()
            .ok()
            .filter(|v: &f64| v.is_finite())
            .ok_or_else(expected)?;
        let place = place_of(name, coded, "--hold")?;
        Ok((place, coded.factors[place].coded(value)))
    });
    parsed.collect()
}

/// Predictions over two factors, the others held or at their centre.
pub(crate) fn grid_of(
    request: &SettingsRequest,
    pair: &str,
    points: usize,
    surfaces: &[Surface],
    coded: &CodedFactors,
) -> Result<GridOutcome, Error> {
    let names: Vec<&str> = pair.split(',').map(str::trim).collect();
    let [first, second] = names[..] else {
        return Err(unusable(
            format!("--grid {pair}"),
            "expected two factors: k,e",
        ));
    };
    if !(2..=MOST_POINTS).contains(&points) {
        let problem = format!("expected 2 to {MOST_POINTS} points");
        return Err(unusable(format!("--grid-points {points}"), problem));
    }
    let places = [
        place_of(first, coded, "--grid")?,
        place_of(second, coded, "--grid")?,
    ];
    if places[0] == places[1] {
        return Err(unusable(
            format!("--grid {pair}"),
            "expected two different factors",
        ));
    }
    let base = request.centre(coded)?;
    let at = |place: usize, step: usize| {
        let (low, high) = coded.range(place);
        low + (high - low) * step as f64 / (points - 1) as f64
    };
    let settings: Vec<Vec<f64>> = (0..points * points)
        .map(|index| {
            let mut point = base.clone();
            point[places[0]] = at(places[0], index % points);
            point[places[1]] = at(places[1], index / points);
            point
        })
        .collect();
    let predicted: Vec<_> = surfaces.iter().map(|s| s.predict(&settings)).collect();
    let rows = settings.iter().enumerate().map(|(row, point)| {
        let responses = predicted
            .iter()
            .flat_map(|own| [own[row].mean, own[row].se]);
        coded.actual(point).into_iter().chain(responses).collect()
    });
    let factors = coded.factors.iter().map(|factor| factor.name.clone());
    let responses = request.names.iter();
    let responses = responses.flat_map(|name| [name.clone(), format!("{name}_se")]);
    Ok(GridOutcome {
        columns: factors.chain(responses).collect(),
        rows: rows.collect(),
    })
}
