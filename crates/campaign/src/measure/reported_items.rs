//! What a report of a campaign that fits no impacts is made of.

use crate::measure::item_campaign::{ItemCampaign, group_of};
use crate::measure::measured::MeasuredOutcome;
use crate::settings::model::ImpactEntry;
use windfall_draw::files::NamedFigure;

/// Recordings that a report shows one by one, at most, besides one of each group.
const SHOWN: usize = 6;

/// A campaign that fits no impacts, evaluated, with what its report says and shows.
#[derive(Clone, Debug)]
pub struct ReportedItems {
    /// The campaign.
    pub campaign: ItemCampaign,
    /// Results.
    pub outcome: MeasuredOutcome,
    /// Paragraphs that say how the results came about.
    pub methods: Vec<String>,
    /// Figures of the whole, or of some recordings.
    pub figures: Vec<NamedFigure>,
    /// Which recordings the figures show.
    pub shown: String,
}

/// Recordings for a report: of those with a result the middle one of each group, then
/// some spread evenly over the table.
#[must_use]
pub fn shown_entries(
    campaign: &ItemCampaign,
    evaluated: impl Fn(&ImpactEntry) -> bool,
) -> Vec<&ImpactEntry> {
    let entries: Vec<&ImpactEntry> = campaign.entries.iter().filter(|e| evaluated(e)).collect();
    let mut groups: Vec<(Option<String>, Vec<usize>)> = Vec::new();
    for (place, entry) in entries.iter().enumerate() {
        let group = group_of(campaign, entry);
        match groups.iter_mut().find(|(known, _)| *known == group) {
            Some((_, members)) => members.push(place),
            None => groups.push((group, vec![place])),
        }
    }
    let mut chosen: Vec<usize> = groups
        .iter()
        .map(|(_, members)| members[members.len() / 2])
        .collect();
    let most = SHOWN.min(entries.len());
    for part in 0..most {
        if chosen.len() >= most {
            break;
        }
        let place = part * entries.len() / most;
        if !chosen.contains(&place) {
            chosen.push(place);
        }
    }
    chosen.sort_unstable();
    chosen.into_iter().map(|place| entries[place]).collect()
}

/// A report with figures of some recordings.
///
/// * `figure`: of one recording, where it can be drawn
#[must_use]
pub fn reported_items(
    campaign: &ItemCampaign,
    outcome: MeasuredOutcome,
    methods: Vec<String>,
    figure: impl Fn(&ImpactEntry) -> Option<NamedFigure>,
) -> ReportedItems {
    let known = |entry: &ImpactEntry| outcome.impacts.iter().any(|item| item.id == entry.id);
    let shown = shown_entries(campaign, known);
    ReportedItems {
        figures: shown.iter().filter_map(|entry| figure(entry)).collect(),
        shown: shown_words(campaign, shown.len()),
        campaign: campaign.clone(),
        methods,
        outcome,
    }
}

/// Says which recordings of a campaign are shown.
#[must_use]
pub fn shown_words(campaign: &ItemCampaign, shown: usize) -> String {
    match shown == campaign.entries.len() {
        true => "Every recording.".to_owned(),
        false => format!(
            "{shown} of {} recordings: the middle one of each group, and others spread evenly over \
             the table. `windfall fit --figures` draws all of them.",
            campaign.entries.len()
        ),
    }
}
