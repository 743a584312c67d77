//! One recorded drop against the model: normal equations in one pass.

use crate::arrow_system::{ALL, OWN, RecordEquations, SHARED};
use crate::contact::ContactPiece;
use crate::event::{DropEvent, RigDuals, rig_duals};
use crate::flight::FlightPiece;
use crate::follow::{DropSink, Touch, follow_drop};
use crate::observe::{Observed, contact_at, flight_at, sigma_at};
use crate::simulate::tolerance;
use crate::waveform::{DropRecord, Knowledge};
use crate::waveform_parameters::{LEVEL, MASS, ONSET, Parameters, VELOCITY, log_prior};
use windfall_contact::law::{ContactLaw, EndRule};
use windfall_contact::laws::any_law::{AnyLaw, LARGEST_PARAMETERS};
use windfall_identify::error::Error;
use windfall_numerics::ode::step::StepError;
use windfall_numerics::real::Lanes;
use windfall_numerics::real_vector::compiled_for_vectors;

/// Accuracy of the integration: far below the noise of any force.
const ACCURACY: f64 = 1e-9;

/// What of a record is held against the model.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Stage {
    /// Impacts that are followed.
    pub impacts: usize,
    /// Impacts whose samples are used.
    pub waveforms: usize,
    /// Standard deviation at which the times between first touches are used;
    /// infinite for not at all; s.
    pub timing: f64,
    /// When a contact is over.
    pub end: EndRule,
}

/// Normal equations of one record.
///
/// # Errors
/// The law refuses the values, or the motion cannot be integrated.
pub(crate) fn evaluate<const W: usize>(
    parameters: &Parameters,
    record: &DropRecord,
    stage: &Stage,
    values: &[f64; SHARED],
    own: &[f64; OWN],
) -> Result<RecordEquations, Error> {
    let (velocity, mass) = (own[VELOCITY].exp(), own[MASS].exp());
    let event = DropEvent {
        law: AnyLaw(parameters.law(values)?),
        rig: parameters.rig(values, mass),
        velocity,
        end: stage.end,
        seeds: parameters.seeds::<W>(values, velocity, mass),
        tolerance: tolerance(ACCURACY, velocity),
    };
    let mut equations = compiled_for_vectors(OnePass {
        parameters,
        record,
        stage,
        event: &event,
        own,
    })?;
    for (place, knowledge) in [(VELOCITY, record.velocity), (MASS, record.mass)] {
        if let Some((value, sd)) = log_prior(knowledge) {
            let mut row = [0.0; ALL];
            row[SHARED + place] = 1.0;
            equations.add(1.0 / (sd * sd), own[place] - value, &row);
        }
        if matches!(knowledge, Knowledge::Fixed(_)) {
            hold(&mut equations, SHARED + place);
        }
    }
    Ok(equations)
}

/// The pass over the samples, compiled for the processor's vector instructions.
struct OnePass<'a, const W: usize> {
    parameters: &'a Parameters,
    record: &'a DropRecord,
    stage: &'a Stage,
    event: &'a DropEvent<AnyLaw, LARGEST_PARAMETERS, W>,
    own: &'a [f64; OWN],
}

impl<const W: usize> pulp::NullaryFnOnce for OnePass<'_, W> {
    type Output = Result<RecordEquations, StepError>;

    #[inline(always)]
    fn call(self) -> Self::Output {
        let (record, stage, own) = (self.record, self.stage, self.own);
        let rig = rig_duals(self.event);
        let windows = &record.windows[..stage.waveforms.min(record.windows.len())];
        let last = windows.last().map_or(0.0, |window| window.1);
        let until = match stage.timing.is_finite() {
            true => f64::INFINITY,
            false => last - own[ONSET],
        };
        let mut pass = Pass {
            event: self.event,
            rig: &rig,
            record,
            parameters: self.parameters,
            windows,
            onset: own[ONSET],
            level: own[LEVEL],
            weight: 1.0 / (record.noise * record.noise),
            next: 0,
            window: 0,
            touches: 0,
            timing: stage.timing,
            equations: RecordEquations::ZERO,
        };
        pass.enter_window();
        pass.silent(0.0);
        follow_drop(self.event, stage.impacts, until, &mut pass)?;
        // Past the last piece the plate has long come to rest.
        pass.silent(f64::INFINITY);
        Ok(pass.equations)
    }
}

/// Takes a parameter out: without a row it does not move.
fn hold(equations: &mut RecordEquations, place: usize) {
    equations.gradient[place] = 0.0;
    for i in 0..ALL {
        equations.normal[place][i] = 0.0;
        equations.normal[i][place] = 0.0;
    }
}

/// The samples of a record in order, as the pieces of the motion come.
struct Pass<'a, L, const N: usize, const W: usize> {
    event: &'a DropEvent<L, N, W>,
    rig: &'a RigDuals<W>,
    record: &'a DropRecord,
    parameters: &'a Parameters,
    windows: &'a [(f64, f64)],
    onset: f64,
    level: f64,
    weight: f64,
    /// Next sample, and the window that it is in.
    next: usize,
    window: usize,
    /// First touches so far.
    touches: usize,
    timing: f64,
    equations: RecordEquations,
}

impl<L: ContactLaw<N>, const N: usize, const W: usize> Pass<'_, L, N, W> {
    /// Moves to the first sample of the present window.
    fn enter_window(&mut self) {
        if let Some(&(from, _)) = self.windows.get(self.window) {
            let times = &self.record.times;
            self.next += times[self.next..].partition_point(|time| *time < from);
        }
    }

    /// The next sample, if its time is at or before `end` (s since first
    /// touch): its time and value.
    #[inline(always)]
    fn sample(&mut self, end: f64) -> Option<(f64, f64)> {
        loop {
            let &(_, to) = self.windows.get(self.window)?;
            let &time = self.record.times.get(self.next)?;
            if time > to {
                self.window += 1;
                self.enter_window();
                continue;
            }
            let since = time - self.onset;
            if since > end {
                return None;
            }
            self.next += 1;
            return Some((since, self.record.force[self.next - 1]));
        }
    }

    /// Samples up to `end` in which nothing acts.
    fn silent(&mut self, end: f64) {
        let mut row = [0.0; ALL];
        row[SHARED + LEVEL] = 1.0;
        while let Some((_, force)) = self.sample(end) {
            self.equations.add(self.weight, self.level - force, &row);
            self.equations.samples += 1;
        }
    }

    /// A row of derivatives from lanes.
    #[inline(always)]
    fn row(&self, lanes: &Lanes<W>) -> [f64; ALL] {
        let mut row = [0.0; ALL];
        let shared = &self.parameters.shared;
        for (i, parameter) in shared.iter().enumerate() {
            row[parameter.place] = lanes.0[i + 1];
        }
        row[SHARED + VELOCITY] = lanes.0[shared.len() + 1];
        row[SHARED + MASS] = lanes.0[shared.len() + 2];
        row
    }

    /// Samples of a piece that began at `start` and ends at `end`.
    #[inline(always)]
    fn read(&mut self, start: Lanes<W>, end: f64, seen: impl Fn(f64) -> Observed<W>) {
        while let Some((since, force)) = self.sample(end) {
            let seen = seen((since - start.0[0]).max(0.0));
            // At a fixed time of the record: the piece begins with its event.
            let lanes = seen.support_force - start * seen.support_rate;
            let mut row = self.row(&lanes);
            row[SHARED + ONSET] = -seen.support_rate;
            row[SHARED + LEVEL] = 1.0;
            let residual = self.level + seen.support_force.0[0] - force;
            self.equations.add(self.weight, residual, &row);
            self.equations.samples += 1;
        }
    }
}

impl<L: ContactLaw<N>, const N: usize, const W: usize> DropSink<W> for Pass<'_, L, N, W> {
    fn touch(&mut self, touch: &Touch<W>) {
        let onsets = &self.record.onsets;
        if self.timing.is_finite()
            && self.touches > 0
            && let Some(&seen) = onsets.get(self.touches)
        {
            let row = self.row(&touch.time);
            let residual = touch.time.0[0] - (seen - onsets[0]);
            let weight = 1.0 / (self.timing * self.timing);
            self.equations.add(weight, residual, &row);
        }
        self.touches += 1;
    }

    #[inline(always)]
    fn contact(&mut self, piece: &ContactPiece<W>) {
        let (event, rig) = (self.event, self.rig);
        let end = piece.start.0[0] + piece.to;
        self.read(piece.start, end, |time| {
            contact_at(event, rig, piece, sigma_at(piece, time).min(1.0))
        });
    }

    #[inline(always)]
    fn flight(&mut self, piece: &FlightPiece<W>) {
        let rig = self.rig;
        let end = piece.start.0[0] + piece.duration;
        self.read(piece.start, end, |time| flight_at(rig, piece, time));
    }
}
