//! Dates and times of day in text.

/// A date and time: seconds since 1970, or since midnight.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Moment {
    /// Whole seconds.
    pub seconds: i64,
    /// Fraction of a second.
    pub fraction: f64,
    /// Whether it has a date.
    pub dated: bool,
}

impl Moment {
    /// Time elapsed since `start`; s.
    pub fn since(self, start: Self) -> f64 {
        (self.seconds - start.seconds) as f64 + (self.fraction - start.fraction)
    }
}

/// A date with a time of day, or a time of day alone.
///
/// Accepts "2024-11-19 20:39:53.123" (also with "T", "/", "Z" or a UTC offset),
/// "19.11.2024 20:39:53,123" and "20:39:53.123". Dates alone are rejected, and so
/// are dates with slashes and the year last, where day and month are ambiguous.
pub fn moment(text: &str) -> Option<Moment> {
    let text = text.trim();
    let (date, clock) = match text.find(['T', ' ']) {
        Some(at) => (Some(&text[..at]), text[at + 1..].trim_start()),
        None => (None, text),
    };
    let days = match date {
        Some(date) => days_of(date)?,
        None => 0,
    };
    let (clock, offset) = without_zone(clock)?;
    let (seconds, fraction) = clock_of(clock)?;
    Some(Moment {
        seconds: days * 86_400 + seconds - offset,
        fraction,
        dated: date.is_some(),
    })
}

fn days_of(date: &str) -> Option<i64> {
    let mark = ['-', '/', '.']
        .into_iter()
        .find(|mark| date.contains(*mark))?;
    let mut parts = date.split(mark);
    let [a, b, c] = [parts.next()?, parts.next()?, parts.next()?];
    let year_first = a.len() == 4;
    if parts.next().is_some() || (mark == '/' && !year_first) {
        return None;
    }
    let (year, month, day) = match year_first {
        true => (number(a, 4)?, number(b, 2)?, number(c, 2)?),
        false => (number(c, 4)?, number(b, 2)?, number(a, 2)?),
    };
    let valid = (1..=12).contains(&month) && (1..=31).contains(&day);
    valid.then(|| days_from_civil(year, month, day))
}

/// Days from 1970-01-01.
///
/// # Source
/// H. Hinnant, "chrono-compatible low-level date algorithms" (2013),
/// `days_from_civil`.
fn days_from_civil(year: i64, month: i64, day: i64) -> i64 {
    let year = if month <= 2 { year - 1 } else { year };
    let era = year.div_euclid(400);
    let year_of_era = year.rem_euclid(400);
    let shifted = if month > 2 { month - 3 } else { month + 9 };
    let day_of_year = (153 * shifted + 2) / 5 + day - 1;
    era * 146_097 + year_of_era * 365 + year_of_era / 4 - year_of_era / 100 + day_of_year - 719_468
}

/// Splits off the UTC offset; s.
fn without_zone(clock: &str) -> Option<(&str, i64)> {
    if let Some(clock) = clock.strip_suffix('Z') {
        return Some((clock, 0));
    }
    let Some(at) = clock.rfind(['+', '-']) else {
        return Some((clock, 0));
    };
    let zone = &clock[at + 1..];
    let (hours, minutes) = match zone.split_once(':') {
        Some((hours, minutes)) => (number(hours, 2)?, number(minutes, 2)?),
        None if zone.len() == 4 => (number(zone.get(..2)?, 2)?, number(zone.get(2..)?, 2)?),
        None => (number(zone, 2)?, 0),
    };
    let size = 3600 * hours + 60 * minutes;
    let sign = if clock.as_bytes()[at] == b'-' { -1 } else { 1 };
    Some((&clock[..at], sign * size))
}

fn clock_of(clock: &str) -> Option<(i64, f64)> {
    let mut parts = clock.split(':');
    let [hours, minutes] = [number(parts.next()?, 2)?, number(parts.next()?, 2)?];
    let (seconds, fraction) = match parts.next() {
        None => (0, 0.0),
        Some(text) => match text.split_once(['.', ',']) {
            Some((whole, rest)) if rest.bytes().all(|b| b.is_ascii_digit()) => {
                (number(whole, 2)?, format!("0.{rest}").parse().ok()?)
            }
            Some(_) => return None,
            None => (number(text, 2)?, 0.0),
        },
    };
    let valid = hours < 24 && minutes < 60 && seconds <= 60 && parts.next().is_none();
    valid.then_some((3600 * hours + 60 * minutes + seconds, fraction))
}

fn number(text: &str, most: usize) -> Option<i64> {
    let digits = !text.is_empty() && text.len() <= most && text.bytes().all(|b| b.is_ascii_digit());
    digits.then(|| text.parse().ok())?
}

#[cfg(test)]
mod tests {
    use super::*;

    /// By `date -u -d TEXT +%s` of GNU coreutils.
    #[test]
    fn reference_moments() {
        for (text, seconds, fraction) in [
            ("2024-11-19 20:39:53.123", 1_732_048_793, 0.123),
            (
                "2019-02-13T14:24:59.3946368+00:00",
                1_550_067_899,
                0.394_636_8,
            ),
            ("2019-02-13T14:24:59-05:30", 1_550_087_699, 0.0),
            ("2000/02/29 00:00:00Z", 951_782_400, 0.0),
            ("19.11.2024 20:39:53,5", 1_732_048_793, 0.5),
            ("20:39:53", 74_393, 0.0),
            ("07:05", 25_500, 0.0),
        ] {
            let found = moment(text).unwrap_or_else(|| panic!("{text}"));
            assert_eq!(
                (found.seconds, found.fraction),
                (seconds, fraction),
                "{text}"
            );
        }
        for text in [
            "",
            "12",
            "2024-11-19",
            "1:2:3:4",
            "25:00:00",
            "a:b",
            "11/19/2024 20:39:53",
            "2024-13-01 00:00",
        ] {
            assert_eq!(moment(text), None, "{text}");
        }
    }
}
