//! What `windfall fit` is asked for of campaigns that fit no impacts.

use crate::impacts::request::{FitRequest, columns, known_group};
use crate::measure::item_campaign::ItemCampaign;
use crate::settings::kind::CampaignKind;
use windfall_files::error::Error;
use windfall_files::option_value::unusable;

/// Puts what is asked for in the place of what a campaign says that fits no
/// impacts: only the group, and laws where it fits some ([`laws_and_free`](crate::impacts::request::laws_and_free)).
///
/// # Errors
/// An option that only impacts have, or one that cannot be used.
pub fn apply_request_to_items(
    campaign: &mut ItemCampaign,
    request: &FitRequest,
) -> Result<(), Error> {
    let kind = campaign.kind;
    let fits_laws = kind == CampaignKind::Compression;
    let laws = !(request.laws.is_empty() && request.free.is_empty());
    let strangers = [
        ("--law and --free", laws && !fits_laws),
        ("--laws", request.laws_file.is_some()),
        ("--card", request.card.is_some()),
        ("--quantities", !request.quantities.is_empty()),
        ("--weights", request.weights.is_some()),
        ("--noise", request.noise.is_some()),
        ("--intervals", request.intervals.is_some()),
        ("--initial-velocity", request.initial_velocity.is_some()),
        ("--onset", request.onset.is_some()),
        (
            "--displacement-offset",
            request.displacement_offset.is_some(),
        ),
        ("--end", request.end.is_some()),
    ];
    if let Some((option, _)) = strangers.iter().find(|(_, given)| *given) {
        let problem = format!("a campaign of kind \"{}\" has no such option", kind.name());
        return Err(unusable((*option).to_owned(), problem));
    }
    if let Some(group) = &request.group {
        let names = columns(&campaign.specimens, &campaign.entries);
        campaign.group = Some(known_group(group, &names)?);
    }
    Ok(())
}
