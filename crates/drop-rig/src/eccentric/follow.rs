//! A planar body from its release on: flights and contacts in turn.

use crate::eccentric::body::{Planar, State};
use crate::eccentric::contact::{Ending, Piece, follow_contact};
use crate::eccentric::flight::Flight;
use windfall_contact::law::EndRule;
use windfall_contact::laws::any_law::AnyLaw;
use windfall_identify::error::Error;

/// Takes the pieces of a drop as they come; `start` is their time since the
/// release.
pub(crate) trait EccentricSink {
    /// Free flight for `duration` (s).
    fn flight(&mut self, start: f64, flight: &Flight, duration: f64);
    /// First touch.
    fn touch(&mut self, _time: f64, _state: &State) {}
    /// A piece of a contact that began at `start`.
    fn contact(&mut self, start: f64, piece: &Piece);
    /// The body has left the plate, or stays on it.
    fn ending(&mut self, _start: f64, _ending: &Ending) {}
}

/// What falls, on what, under which law.
#[derive(Clone, Copy, Debug)]
pub(crate) struct EccentricEvent {
    pub planar: Planar,
    pub law: AnyLaw,
    pub end: EndRule,
    pub release: State,
}

/// Follows a drop through `impacts` impacts and the flight after the last, or
/// to the first event after `until` (s since the release).
///
/// Returns whether the body stays on the plate.
///
/// # Errors
/// [`Error::Integration`], [`Error::EndlessContact`].
pub(crate) fn follow_eccentric(
    event: &EccentricEvent,
    impacts: usize,
    until: f64,
    sink: &mut impl EccentricSink,
) -> Result<bool, Error> {
    let planar = &event.planar;
    let (mut time, mut state) = (0.0, event.release);
    for impact in 0..=impacts {
        let flight = Flight::new(planar, state);
        let Some((duration, touch)) = flight.next_contact() else {
            return Ok(true);
        };
        sink.flight(time, &flight, duration);
        time += duration;
        if impact == impacts || time > until {
            break;
        }
        sink.touch(time, &touch);
        let ending = follow_contact(planar, event.law, event.end, touch, &mut |piece| {
            sink.contact(time, piece);
        })?;
        sink.ending(time, &ending);
        if !ending.left {
            return Ok(true);
        }
        time += ending.time;
        state = ending.touching.state;
    }
    Ok(false)
}
