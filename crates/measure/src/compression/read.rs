//! campaign.toml of slow compressions → [`CompressionCampaign`].

use crate::compression::file::{CompressionFile, CompressionRigFile, YieldFile};
use std::path::Path;
use windfall_campaign::settings::channels::channel_plans;
use windfall_campaign::settings::conditioning::refuse_all_conditioning;
use windfall_campaign::settings::files::check_format;
use windfall_campaign::settings::fit::{LawKeys, free_names, law_expressions};
use windfall_campaign::settings::kind::{CAMPAIGN_FILE, CampaignKind};
use windfall_campaign::settings::model::Campaign;
use windfall_campaign::settings::shared::read_shared;
use windfall_contact::apparent_modulus::PrincipalRadii;
use windfall_contact::curvature::{radii_of_ellipsoid, radius_from_chord};
use windfall_contact::expression::LawExpression;
use windfall_files::error::{Error, Place};
use windfall_files::name::Name;
use windfall_files::text::cell_quantity::cell_quantity;
use windfall_files::text::spanned::Spanned;
use windfall_files::text::toml_source::{
    Needed, TomlSource, missing, number_that, parse_source, positive_quantity, read_source, refused,
};
use windfall_numerics::unit::quantity::parse_as;
use windfall_signal::compression::{CompressionOptions, FitRange};

/// A campaign of slow compressions.
#[derive(Clone, Debug)]
pub struct CompressionCampaign {
    /// What all kinds share.
    pub shared: Campaign,
    /// Plates that deform the fruit.
    pub plates: usize,
    /// Poisson's ratio of the fruit; 1.
    pub poisson_ratio: f64,
    /// Radii of plate or indenter; m.
    pub indenter: PrincipalRadii,
    /// How curves are read.
    pub options: CompressionOptions,
    /// Where the fitted range ends, where the campaign says so.
    pub fit_to: Option<FitRange>,
    /// Laws, each fitted to every curve.
    pub laws: Vec<LawExpression>,
    /// Parameters that are estimated although they have a value.
    pub free: Vec<String>,
}

const ADVICE: &str = "`windfall new compression DIR` writes a template";

/// Reads a campaign directory of slow compressions.
///
/// # Errors
/// A file of the campaign is missing or does not say what it must.
pub fn read_compression(directory: &Path) -> Result<CompressionCampaign, Error> {
    let source = read_source(&directory.join(CAMPAIGN_FILE), ADVICE)?;
    let file: CompressionFile = parse_source(&source)?;
    check_format(&source, file.format.as_ref())?;
    let (plates, poisson_ratio, indenter) = rig(&source, &file.rig)?;
    let keys = LawKeys {
        law: file.fit.law.as_ref(),
        laws: file.fit.laws.as_deref(),
        free: file.fit.free.as_deref(),
    };
    let laws = law_expressions(&source, &keys, &[])?;
    let free = free_names(&source, &keys, &laws)?;
    let why = "slow compressions are not filtered";
    refuse_all_conditioning(&source, file.channels.as_ref(), why)?;
    let channels = channel_plans(&source, file.channels.as_ref())?;
    let shared = (&file.campaign, &file.files, &file.summary);
    let kind = CampaignKind::Compression;
    Ok(CompressionCampaign {
        fit_to: fit_range(&source, file.compression.fit_to.as_ref())?,
        options: options(&source, &file.compression, file.rig.get_ref())?,
        shared: read_shared(&source, directory, kind, shared, channels)?,
        plates,
        poisson_ratio,
        indenter,
        laws,
        free,
    })
}

fn rig(
    source: &TomlSource,
    rig: &Spanned<CompressionRigFile>,
) -> Result<(usize, f64, PrincipalRadii), Error> {
    let (at, rig) = (rig.span(), rig.get_ref());
    let needed = Needed {
        table: "[rig]",
        key: "plates",
        meaning: "number of plates that deform the fruit: 2 between plane plates, 1 where only one \
                  end is pressed",
        unit: "",
        example: "plates = 2",
    };
    let Some(plates) = &rig.plates else {
        return Err(missing(source, &at, &needed, "[rig]".to_owned()));
    };
    let number = *plates.get_ref();
    if !(1..=2).contains(&number) {
        return Err(refused(
            source,
            plates,
            ("[rig]", "plates"),
            "expected 1 or 2",
        ));
    }
    let (key, fits) = (("[rig]", "poisson_ratio"), |ratio| {
        (0.0..0.5).contains(&ratio)
    });
    let expected = "a number from 0 to below 0.5";
    let poisson = number_that(source, rig.poisson_ratio.as_ref(), key, fits, expected)?;
    let radius = Needed {
        key: "indenter_radius",
        meaning: "radius of a spherical indenter",
        unit: "m",
        example: "indenter_radius = \"4 mm\"",
        ..needed
    };
    let indenter = match positive_quantity(source, rig.indenter_radius.as_ref(), &radius)? {
        Some(radius) => PrincipalRadii::sphere(radius),
        None => PrincipalRadii::PLANE,
    };
    Ok((number as usize, poisson.unwrap_or(0.3), indenter))
}

fn options(
    source: &TomlSource,
    file: &YieldFile,
    rig: &CompressionRigFile,
) -> Result<CompressionOptions, Error> {
    let defaults = CompressionOptions::default();
    let touch = Needed {
        table: "[compression]",
        key: "touch_force",
        meaning: "force from which the fruit counts as touched",
        unit: "N",
        example: "touch_force = \"0.05 N\"",
    };
    let machine = Needed {
        table: "[rig]",
        key: "machine_stiffness",
        meaning: "stiffness of machine, load cell and pads in series with the fruit",
        unit: "N/m",
        example: "machine_stiffness = \"50 N/mm\"",
    };
    let part = |value: &Option<Spanned<f64>>, key, default: f64| {
        let (key, fits) = (("[compression]", key), |part| part > 0.0 && part < 1.0);
        let part = number_that(source, value.as_ref(), key, fits, "a part between 0 and 1")?;
        Ok::<_, Error>(part.unwrap_or(default))
    };
    let stiffness = positive_quantity(source, rig.machine_stiffness.as_ref(), &machine)?;
    Ok(CompressionOptions {
        touch_force: positive_quantity(source, file.touch_force.as_ref(), &touch)?,
        machine_stiffness: stiffness.unwrap_or(defaults.machine_stiffness),
        yield_window: part(&file.yield_window, "yield_window", defaults.yield_window)?,
        stiffness_window: part(
            &file.stiffness_window,
            "stiffness_window",
            defaults.stiffness_window,
        )?,
        softening: part(&file.softening, "softening", defaults.softening)?,
        rupture: part(&file.rupture, "rupture", defaults.rupture)?,
    })
}

fn fit_range(
    source: &TomlSource,
    value: Option<&Spanned<String>>,
) -> Result<Option<FitRange>, Error> {
    let Some(value) = value else {
        return Ok(None);
    };
    let text = value.get_ref().trim();
    if text == "largest-stiffness" {
        return Ok(Some(FitRange::LargestStiffness));
    }
    let part = text
        .strip_suffix('%')
        .and_then(|part| part.trim().parse::<f64>().ok());
    if let Some(part) = part
        && part > 0.0
        && part <= 100.0
    {
        return Ok(Some(FitRange::PartOfYield(part / 100.0)));
    }
    match parse_as(text, "m") {
        Ok(length) if length > 0.0 && !text.ends_with('%') => {
            Ok(Some(FitRange::Deformation(length)))
        }
        _ => {
            let problem = "expected \"largest-stiffness\", a part of the yield force such as \
                           \"50 %\", or a deformation such as \"0.5 mm\"";
            Err(refused(source, value, ("[compression]", "fit_to"), problem))
        }
    }
}

/// Principal radii of a specimen from the columns of its row: `radius` (and
/// `radius_2`), or `diameter_1` to `diameter_3` with the first along the axis
/// that is pressed, or `chord` and `sagitta` (and `chord_2`, `sagitta_2`), each
/// with its unit. `None` where there are none.
///
/// # Errors
/// A cell is no positive number.
pub fn specimen_radii(
    cells: &[(Name, String)],
    place: &Place,
) -> Result<Option<PrincipalRadii>, Error> {
    let length = |name: &str| cell_quantity(cells, name, "m", place);
    if let Some(first) = length("radius")? {
        let second = length("radius_2")?.unwrap_or(first);
        return Ok(Some(PrincipalRadii { first, second }));
    }
    let diameters = (
        length("diameter_1")?,
        length("diameter_2")?,
        length("diameter_3")?,
    );
    if let (Some(first), Some(second), Some(third)) = diameters {
        return Ok(Some(radii_of_ellipsoid(first, second, third)));
    }
    if let (Some(chord), Some(sagitta)) = (length("chord")?, length("sagitta")?) {
        let first = radius_from_chord(chord, sagitta);
        let second = match (length("chord_2")?, length("sagitta_2")?) {
            (Some(chord), Some(sagitta)) => radius_from_chord(chord, sagitta),
            _ => first,
        };
        return Ok(Some(PrincipalRadii { first, second }));
    }
    Ok(None)
}
