//! Which of the triangles of a mesh that overlap a fruit it is felt at.

use crate::shape::surface::{Closest, Facet};
use crate::vector::{Vector, dot};

/// Contacts with one mesh whose normals have a larger cosine are one; 1. It is where a
/// contact is handed on from one part of a wall to the next.
const ONE_CONTACT: f64 = 0.9;

/// A point so close to a triangle lies on it; of the radius.
const ON: f64 = 1e-4;

/// Leaves, of the triangles of a mesh that overlap a fruit, those that it is felt at.
///
/// A fruit touches a surface where its distance is least. A point on an edge is no such
/// place where another triangle that it lies on comes closer. Of places in nearly the same
/// direction, as on a curved surface of many triangles, the closest alone is felt: its
/// depth goes on steadily from one triangle to the next, so that the energy does. How
/// finely a surface is parted therefore does not count.
///
/// * `facets`: parts of all walls, with the number of the wall
/// * `closest`: the point of a part that is closest to a place
pub(crate) fn thin(
    facets: &[(u32, Facet)],
    closest: impl Fn(u32, Vector) -> Closest,
    radius: f64,
    hits: &mut Vec<(u32, Closest)>,
) {
    let of_mesh = |facet: u32| matches!(facets[facet as usize].1, Facet::Triangle(_));
    if hits.iter().filter(|(facet, _)| of_mesh(*facet)).count() < 2 {
        return;
    }
    hits.sort_by(|(a, at), (b, bt)| at.distance.total_cmp(&bt.distance).then(a.cmp(b)));
    let mut keep = vec![true; hits.len()];
    for place in 1..hits.len() {
        let (facet, own) = hits[place];
        if !of_mesh(facet) {
            continue;
        }
        let wall = facets[facet as usize].0;
        let before = hits[..place].iter().zip(&keep);
        let mut before = before.filter(|((other, _), _)| facets[*other as usize].0 == wall);
        keep[place] = !before.any(|((other, found), felt)| {
            let one = *felt && dot(found.normal, own.normal) > ONE_CONTACT;
            one || !own.inside && closest(*other, own.point).distance < ON * radius
        });
    }
    let mut place = 0;
    hits.retain(|_| {
        place += 1;
        keep[place - 1]
    });
}
