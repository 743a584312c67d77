//! `[bruise]` of scene.toml.

use crate::error::Error;
use crate::file_scene::BruiseFile;
use crate::scene_key::needed;
use crate::toml_source::{
    Needed, TomlSource, choice, invalid, missing, needed_quantity, optional_quantity,
};
use toml::Spanned;
use windfall_scene::bruise::{BruiseModel, Predictor, SameSpot};

/// How contacts bruise, and what counts as bruised.
#[derive(Clone, Debug, PartialEq)]
pub struct BruisePlan {
    /// The model.
    pub model: BruiseModel,
    /// Volumes above which a fruit counts as bruised; m³.
    pub limits: Vec<f64>,
}

const TABLE: &str = "[bruise]";

/// The model of `[bruise]`.
///
/// # Errors
/// Something is missing or cannot be.
pub fn bruise_of(source: &TomlSource, bruise: &Spanned<BruiseFile>) -> Result<BruisePlan, Error> {
    let (file, at) = (bruise.get_ref(), bruise.span());
    let predictors = [
        ("absorbed energy", Predictor::AbsorbedEnergy),
        ("peak force", Predictor::PeakForce),
    ];
    let Some(predictor) = choice(
        source,
        file.predictor.as_ref(),
        (TABLE, "predictor"),
        &predictors,
    )?
    else {
        let meaning = "what of a contact tells its bruise";
        let key = needed(
            TABLE,
            "predictor",
            meaning,
            "",
            "predictor = \"absorbed energy\"",
        );
        return Err(missing(source, &at, &key, TABLE.to_owned()));
    };
    let (unit, per, threshold, volume) = match predictor {
        Predictor::AbsorbedEnergy => (
            "J",
            "m^3/J",
            "threshold = \"50 mJ\"",
            "susceptibility = \"3000 mm^3/J\"",
        ),
        Predictor::PeakForce => (
            "N",
            "m^3/N",
            "threshold = \"40 N\"",
            "susceptibility = \"5 mm^3/N\"",
        ),
    };
    let key = |key, unit, example| needed(TABLE, key, "a coefficient of the bruise", unit, example);
    let own = |value, needed: &Needed| needed_quantity(source, &at, value, needed);
    let sd = |value, needed: &Needed| {
        Ok::<f64, Error>(optional_quantity(source, value, needed)?.unwrap_or(0.0))
    };
    let spots = [("largest", SameSpot::Largest), ("sum", SameSpot::Sum)];
    let same = choice(
        source,
        file.same_spot.as_ref(),
        (TABLE, "same_spot"),
        &spots,
    )?;
    let model = BruiseModel {
        predictor,
        threshold: own(file.threshold.as_ref(), &key("threshold", unit, threshold))?,
        threshold_sd: sd(
            file.threshold_sd.as_ref(),
            &key("threshold_sd", unit, threshold),
        )?,
        susceptibility: own(
            file.susceptibility.as_ref(),
            &key("susceptibility", per, volume),
        )?,
        susceptibility_sd: sd(
            file.susceptibility_sd.as_ref(),
            &key("susceptibility_sd", per, volume),
        )?,
        same_spot: same.unwrap_or(SameSpot::Largest),
    };
    let numbers = [
        model.threshold,
        model.threshold_sd,
        model.susceptibility,
        model.susceptibility_sd,
    ];
    if numbers.iter().any(|own| !(*own >= 0.0 && own.is_finite())) {
        let problem = "coefficients of bruises must be at or above zero".to_owned();
        return Err(invalid(
            source,
            &at,
            (TABLE, "threshold"),
            &format!("{numbers:?}"),
            problem,
        ));
    }
    let volume = needed(
        TABLE,
        "limits",
        "a volume",
        "m^3",
        "limits = [\"100 mm^3\", \"500 mm^3\"]",
    );
    let limits = file.limits.iter().map(|limit| own(Some(limit), &volume));
    let limits: Vec<f64> = limits.collect::<Result<_, _>>()?;
    if limits.is_empty() {
        return Err(missing(source, &at, &volume, TABLE.to_owned()));
    }
    Ok(BruisePlan { model, limits })
}
