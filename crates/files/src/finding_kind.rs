//! Findings of a campaign, each kind once: the list that commands print and the page shows.

use crate::found::FindingOutcome;
use crate::name::Name;
use crate::named::grouped;
use crate::severity::Severity;
use crate::text::table::of_impacts;
use itertools::Itertools;
use serde::Serialize;

/// A kind of finding in a campaign: of the whole, or of the impacts that have it.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, utoipa::ToSchema)]
pub struct FindingKind {
    /// Its code.
    #[schema(value_type = String)]
    pub code: Name,
    /// How grave it is.
    pub severity: Severity,
    /// What the first of the impacts says.
    pub message: String,
    /// The laws whose fits have it, where the fits of others have not.
    pub laws: Vec<String>,
    /// The channel, or the quantity of the fit, that is meant, where all impacts mean the same
    /// one.
    #[schema(value_type = Option<String>)]
    pub channel: Option<Name>,
    /// Ids of the impacts that have it; none where it is one of the whole.
    pub impacts: Vec<String>,
    /// How many impacts there are, where they are all of one sort.
    pub of: Option<usize>,
}

/// A finding of an item.
#[derive(Clone, Copy, Debug)]
pub struct FoundOn<'a> {
    /// The finding.
    pub finding: &'a FindingOutcome,
    /// Id of the item.
    pub id: &'a str,
    /// The law that was fitted to it.
    pub law: &'a str,
}

/// Findings of the whole, then one of each kind on items, the gravest first.
///
/// * `laws`: those that were fitted
/// * `of`: how many items there are, where they are all of one sort
pub fn finding_kinds<'a>(
    whole: &[FindingOutcome],
    found: impl Iterator<Item = FoundOn<'a>>,
    laws: &[&str],
    of: Option<usize>,
) -> Vec<FindingKind> {
    let of_whole = whole.iter().map(|finding| FindingKind {
        code: finding.code,
        severity: finding.severity,
        message: finding.message.clone(),
        laws: Vec::new(),
        channel: finding.channel,
        impacts: Vec::new(),
        of: None,
    });
    let shared = grouped(found.map(|own| (&own.finding.code, own)));
    let shared = shared.into_iter().map(|(_, all)| {
        let own = all.iter().map(|own| own.law).unique().map(str::to_owned);
        let own: Vec<String> = own.collect();
        let first = all[0].finding;
        let one = all.iter().map(|own| own.finding.channel).all_equal();
        FindingKind {
            code: first.code,
            severity: first.severity,
            message: first.message.clone(),
            laws: if own.len() < laws.len() {
                own
            } else {
                Vec::new()
            },
            channel: first.channel.filter(|_| one),
            impacts: all.iter().map(|own| own.id.to_owned()).unique().collect(),
            of,
        }
    });
    let mut kinds: Vec<FindingKind> = of_whole.chain(shared).collect();
    kinds.sort_by_key(|kind| kind.severity);
    kinds
}

impl FindingKind {
    /// In words: the message, the law that is meant, and who has it.
    pub fn told(&self) -> FindingOutcome {
        let message = match &self.laws[..] {
            [] => self.message.clone(),
            laws => format!("{}: {}", laws.join(", "), self.message),
        };
        let ids: Vec<&str> = self.impacts.iter().map(String::as_str).collect();
        FindingOutcome {
            channel: self.channel,
            severity: self.severity,
            ..FindingOutcome::new(&self.code, of_impacts(&message, &ids, self.of))
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// 3 of 4 impacts, one of them by two laws of two, and a note of the whole.
    #[test]
    fn closed_form_each_kind_counts_impacts_and_names_its_law() {
        let [misfit, clipped] = ["misfit", "clipped"].map(|code| FindingOutcome::new(code, "odd"));
        let misfit = misfit.of_channel(Some("force"));
        let position = clipped.clone().of_channel(Some("position"));
        let clipped = clipped.of_channel(Some("force"));
        let on = |finding, id, law| FoundOn { finding, id, law };
        let found = [
            on(&misfit, "a", "hertz"),
            on(&misfit, "b", "hertz"),
            on(&misfit, "c", "hertz"),
            on(&clipped, "b", "hertz"),
            on(&position, "b", "simon"),
        ];
        let whole = [FindingOutcome::new("one-level", "one velocity")];
        let kinds = finding_kinds(&whole, found.into_iter(), &["hertz", "simon"], Some(4));
        let told = kinds.iter().map(|kind| {
            let told = kind.told();
            format!("{} {}: {}", kind.severity.word(), told.code, told.message)
        });
        assert_eq!(
            told.collect::<Vec<_>>(),
            [
                "wrong clipped: b: odd",
                "doubtful misfit: a: hertz: odd (so have b and c; 3 of 4)",
                "note one-level: one velocity"
            ]
        );
        assert_eq!((kinds[0].impacts.len(), kinds[2].of), (1, None));
        // Of two channels it is that of none.
        let channels = kinds.iter().map(|kind| kind.told().channel);
        let force = Some(Name::from("force"));
        assert_eq!(channels.collect::<Vec<_>>(), [None, force, None]);
    }
}
