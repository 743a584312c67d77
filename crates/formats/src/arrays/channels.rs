//! Turns a tree of arrays into channels; shared by MAT and HDF5 files.

use crate::arrays::clock::{names_time, time_bases};
use crate::arrays::tree::{Array, Extent, Listing, Series, Tree, count};
use crate::contents::{ChannelContents, Note, TimeBase};
use crate::names::Names;
use crate::text::number::rises_evenly;

/// Most channels made from one array; larger ones are pictures or matrices.
const MOST_SERIES: u64 = 4096;

const MOST_CHANNELS: usize = 1 << 16;

/// A later dimension must be longer than this to be taken as the samples.
const LONG: u64 = 64;

/// Most names listed in a note.
const MOST_NAMES: usize = 6;

/// Lists the channels: a vector is one channel, each column of a matrix is one;
/// scalars and texts are properties.
///
/// Samples run along the first dimension of a matrix, unless another is longer
/// than it and than 64.
pub(crate) fn list_channels(mut tree: Tree) -> Listing {
    let mut listing = Listing::default();
    let only_scalars = tree.arrays.iter().all(|a| count(&a.extents) <= 1);
    for at in 0..tree.arrays.len() {
        let array = tree.arrays[at].clone();
        let name = format!("{}{}", array.path.join("/"), array.part);
        match count(&array.extents) {
            0 => tree.leave_out(&array.path, "it is empty"),
            1 => {
                if let Some(value) = array.value {
                    listing.properties.push((name.clone(), value.to_string()));
                }
                if only_scalars {
                    add_channels(at, &array, &name, &mut tree, &mut listing);
                }
            }
            _ => add_channels(at, &array, &name, &mut tree, &mut listing),
        }
    }
    let mut names = Names::default();
    for channel in &mut listing.channels {
        channel.name = names.unique(&channel.name);
    }
    listing
        .properties
        .extend(tree.texts.iter().map(|(p, t)| (p.join("/"), t.clone())));
    add_units(&tree, &mut listing);
    let mut time_notes = time_bases(&tree, &mut listing);
    listing.notes.append(&mut tree.notes);
    listing.notes.append(&mut time_notes);
    listing
        .notes
        .extend(tree.left_out.into_iter().map(note_left_out));
    listing
}

fn add_channels(at: usize, array: &Array, name: &str, tree: &mut Tree, listing: &mut Listing) {
    let wide: Vec<Extent> = array
        .extents
        .iter()
        .filter(|e| e.length > 1)
        .copied()
        .collect();
    let samples = sample_extent(&wide);
    let others: Vec<Extent> = (0..wide.len())
        .filter(|&i| i != samples)
        .map(|i| wide[i])
        .collect();
    let many = count(&others);
    if many > MOST_SERIES {
        let why = "it would give more than 4096 channels, so it is probably a picture";
        return tree.leave_out(&array.path, why);
    }
    if listing.channels.len() + many as usize > MOST_CHANNELS {
        return tree.leave_out(&array.path, "the file already holds 65536 channels");
    }
    if samples != 0 {
        tree.notes
            .push(rows_are_channels(array, wide[samples].length));
    }
    let along = wide
        .get(samples)
        .copied()
        .unwrap_or(Extent { length: 1, step: 1 });
    for k in 0..many {
        let (suffix, start) = place_of(k, &others);
        listing.series.push(Series {
            array: at,
            start,
            step: along.step,
            length: along.length,
        });
        listing.channels.push(ChannelContents {
            name: format!("{name}{suffix}"),
            unit: array.unit.clone(),
            length: Some(along.length),
            time: TimeBase::Unknown,
            stored_as: array.stored_as.clone(),
            properties: array.properties.clone(),
        });
    }
    if samples == 0 && others.len() == 1 && rises_evenly(&array.beginning) {
        first_is_time(name, many as usize, tree, listing);
    }
}

/// The first of the last `many` channels is the time of the others.
fn first_is_time(name: &str, many: usize, tree: &mut Tree, listing: &mut Listing) {
    let first = listing.channels.len() - many;
    tree.notes.push(Note::Assumed(format!(
        "the first column of \"{name}\" rises evenly and is taken as the time in seconds"
    )));
    for channel in &mut listing.channels[first + 1..] {
        channel.time = TimeBase::Channel(first);
    }
}

/// Index of the dimension along which samples run.
fn sample_extent(wide: &[Extent]) -> usize {
    let mut best = 0;
    for (i, extent) in wide.iter().enumerate().skip(1) {
        if extent.length > LONG && extent.length > wide[best].length {
            best = i;
        }
    }
    best
}

/// Name suffix and first element of the `k`th series, last dimension fastest.
fn place_of(mut k: u64, others: &[Extent]) -> (String, u64) {
    let mut suffix = String::new();
    let mut start = 0_u64;
    for extent in others.iter().rev() {
        let index = k % extent.length;
        k /= extent.length;
        start += index * extent.step;
        suffix = format!("/{}{suffix}", index + 1);
    }
    (suffix, start)
}

fn rows_are_channels(array: &Array, samples: u64) -> Note {
    let shape: Vec<String> = array.extents.iter().map(|e| e.length.to_string()).collect();
    Note::Assumed(format!(
        "\"{}\" is {}: the extent of {samples} is taken as the samples; transpose it before \
             it is saved if that is wrong",
        array.path.join("/"),
        shape.join(" × "),
    ))
}

/// A text named "unit" beside a single array gives its unit.
fn add_units(tree: &Tree, listing: &mut Listing) {
    for (path, text) in &tree.texts {
        let Some((name, level)) = path.split_last() else {
            continue;
        };
        if !["unit", "units"].contains(&name.to_lowercase().as_str()) || text.is_empty() {
            continue;
        }
        let beside: Vec<usize> = (0..listing.series.len())
            .filter(|&i| {
                let path = &tree.arrays[listing.series[i].array].path;
                path.split_last()
                    .is_some_and(|(name, above)| above == level && !names_time(name))
            })
            .collect();
        let same = |i: &&usize| listing.series[**i].array == listing.series[beside[0]].array;
        if beside.iter().filter(same).count() == beside.len() {
            for i in beside {
                listing.channels[i].unit.get_or_insert_with(|| text.clone());
            }
        }
    }
}

fn note_left_out((why, names): (String, Vec<String>)) -> Note {
    let shown: Vec<String> = names
        .iter()
        .take(MOST_NAMES)
        .map(|n| format!("\"{n}\""))
        .collect();
    let mut what = shown.join(", ");
    if names.len() > MOST_NAMES {
        what.push_str(&format!(" and {} more", names.len() - MOST_NAMES));
    }
    Note::LeftOut { what, why }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::arrays::tree::first_fastest;

    fn array(path: &str, lengths: &[u64]) -> Array {
        Array {
            path: path.split('/').map(str::to_owned).collect(),
            part: "",
            extents: first_fastest(lengths),
            stored_as: "64-bit float".to_owned(),
            beginning: Vec::new(),
            value: (lengths.iter().product::<u64>() == 1).then_some(1000.0),
            unit: None,
            properties: Vec::new(),
        }
    }

    fn names(arrays: Vec<Array>) -> (Vec<String>, Listing) {
        let listing = list_channels(Tree {
            arrays,
            ..Tree::default()
        });
        let names = listing.channels.iter().map(|c| c.name.clone()).collect();
        (names, listing)
    }

    #[test]
    fn closed_form_columns_rows_and_vectors() {
        let (found, listing) = names(vec![array("a", &[3, 2]), array("b", &[2, 65])]);
        assert_eq!(found, ["a/1", "a/2", "b/1", "b/2"]);
        let of = |array, start, step, length| Series {
            array,
            start,
            step,
            length,
        };
        assert_eq!(
            listing.series,
            [
                of(0, 0, 1, 3),
                of(0, 3, 1, 3),
                of(1, 0, 2, 65),
                of(1, 1, 2, 65)
            ]
        );
        assert_eq!(listing.notes.len(), 1);
        let (found, _) = names(vec![
            array("v", &[1, 1, 9]),
            array("v", &[9]),
            array("n", &[1, 1]),
        ]);
        assert_eq!(found, ["v", "v (2)"]);
        let (found, listing) = names(vec![array("c", &[2, 3, 4])]);
        assert_eq!(found.len(), 12);
        assert_eq!((found[1].as_str(), listing.series[1].start), ("c/1/2", 6));
        let (found, _) = names(vec![array("x", &[1, 1]), array("y", &[1, 1])]);
        assert_eq!(found, ["x", "y"]);
    }

    #[test]
    fn rejects_extents_that_cannot_be_counted() {
        assert_eq!(count(&first_fastest(&[u64::MAX, 3])), u64::MAX);
        assert_eq!(count(&first_fastest(&[u64::MAX, 3, 0])), 0);
        let (found, listing) = names(vec![array("picture", &[5000, 5000])]);
        assert!(found.is_empty());
        assert_eq!(listing.notes[0].code(), "left-out");
    }
}
