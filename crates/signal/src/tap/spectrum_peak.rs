//! Peaks of a curve of evenly spaced ordinates.

/// A peak.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Peak {
    /// Index of the highest ordinate; the middle one of a plateau.
    pub index: usize,
    /// The ordinate there.
    pub height: f64,
    /// Height above the higher of the two saddles that separate the peak from
    /// higher ground, or from the end of the curve.
    pub prominence: f64,
    /// Width at half the prominence, in steps, interpolated.
    pub width: f64,
}

/// All peaks: ordinates higher than those on both sides, in their order.
///
/// # Source
/// Results are those of scipy.signal.find_peaks, peak_prominences and
/// peak_widths (rel_height = 0.5), with which a test compares.
pub fn peaks(curve: &[f64]) -> Vec<Peak> {
    let mut found = Vec::new();
    let mut i = 1;
    while i + 1 < curve.len() {
        let mut ahead = i + 1;
        if curve[i - 1] < curve[i] {
            // A plateau counts when it falls off on its right.
            while ahead + 1 < curve.len() && curve[ahead] == curve[i] {
                ahead += 1;
            }
            if curve[ahead] < curve[i] {
                found.push(peak_at(curve, usize::midpoint(i, ahead - 1)));
                i = ahead;
                continue;
            }
        }
        i += 1;
    }
    found
}

fn peak_at(curve: &[f64], index: usize) -> Peak {
    let height = curve[index];
    let low = |side: &mut dyn Iterator<Item = usize>| {
        let (mut lowest, mut at) = (height, index);
        for i in side.take_while(|&i| curve[i] <= height) {
            if curve[i] < lowest {
                (lowest, at) = (curve[i], i);
            }
        }
        (lowest, at)
    };
    let (left, left_at) = low(&mut (0..=index).rev());
    let (right, right_at) = low(&mut (index..curve.len()));
    let prominence = height - left.max(right);
    let level = height - 0.5 * prominence;
    Peak {
        index,
        height,
        prominence,
        width: right_crossing(curve, index, right_at, level)
            - left_crossing(curve, index, left_at, level),
    }
}

fn left_crossing(curve: &[f64], index: usize, base: usize, level: f64) -> f64 {
    let at = (base..=index).rev().find(|&i| curve[i] <= level);
    let at = at.unwrap_or(base);
    match curve[at] < level {
        true => at as f64 + (level - curve[at]) / (curve[at + 1] - curve[at]),
        false => at as f64,
    }
}

fn right_crossing(curve: &[f64], index: usize, base: usize, level: f64) -> f64 {
    let at = (index..=base).find(|&i| curve[i] <= level).unwrap_or(base);
    match curve[at] < level {
        true => at as f64 - (level - curve[at]) / (curve[at - 1] - curve[at]),
        false => at as f64,
    }
}

/// Distance in steps from the highest ordinate to the vertex of the parabola
/// through it and its neighbours; between −½ and ½.
pub fn parabolic_offset(curve: &[f64], index: usize) -> f64 {
    if index == 0 || index + 1 >= curve.len() {
        return 0.0;
    }
    let (a, b, c) = (curve[index - 1], curve[index], curve[index + 1]);
    let bend = a - 2.0 * b + c;
    match bend < 0.0 {
        true => (0.5 * (a - c) / bend).clamp(-0.5, 0.5),
        false => 0.0,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn closed_form_triangle_and_plateau() {
        let found = peaks(&[0.0, 2.0, 4.0, 2.0, 0.0, 1.0, 1.0, 1.0, 0.5]);
        assert_eq!(found.len(), 2);
        let (first, second) = (found[0], found[1]);
        assert_eq!((first.index, first.prominence, first.width), (2, 4.0, 2.0));
        assert_eq!((second.index, second.prominence), (6, 0.5));
        assert!(peaks(&[1.0, 1.0]).is_empty() && peaks(&[]).is_empty());
    }

    #[test]
    fn closed_form_vertex_of_a_parabola() {
        let curve: Vec<f64> = (0..5).map(|i| 3.0 - (f64::from(i) - 2.2).powi(2)).collect();
        assert!((parabolic_offset(&curve, 2) - 0.2).abs() < 1e-14);
        assert_eq!(parabolic_offset(&curve, 0), 0.0);
    }
}
