//! Times of day that pass midnight.

use crate::text::rows::ColumnKind;

const DAY: f64 = 86_400.0;

/// A step back by more than this is midnight, not a clock that was set.
const BACK: f64 = 0.5 * DAY;

/// Follows a column of times of day from row to row.
#[derive(Clone, Debug)]
pub struct Clock {
    before: f64,
    days: f64,
    rows: usize,
    /// Rows before the first midnight, if one was passed.
    pub midnight: Option<usize>,
}

impl Clock {
    /// `None` if the column holds anything but times of day.
    pub fn of(kind: ColumnKind) -> Option<Self> {
        match kind {
            ColumnKind::Moments(start) if !start.dated => Some(Self {
                before: f64::NEG_INFINITY,
                days: 0.0,
                rows: 0,
                midnight: None,
            }),
            _ => None,
        }
    }

    /// Adds a day to the next times for each midnight before them.
    pub fn pass(&mut self, times: &mut [f64]) {
        for time in times {
            if time.is_finite() {
                if *time < self.before - BACK {
                    self.days += DAY;
                    self.midnight.get_or_insert(self.rows);
                }
                self.before = *time;
                *time += self.days;
            }
            self.rows += 1;
        }
    }
}
