//! Dates as numbers.

/// Days of a list of dates since the first of them; places in the sorted list where one is no `YYYY-MM-DD` (what follows
/// the day, as a time of day, is left out).
#[must_use]
pub(crate) fn days(dates: &[String]) -> Vec<f64> {
    let civil: Option<Vec<i64>> = dates.iter().map(|date| day_of(date)).collect();
    match civil {
        Some(days) => {
            let first = days.iter().copied().min().unwrap_or_default();
            days.iter().map(|day| (day - first) as f64).collect()
        }
        None => {
            let mut sorted: Vec<&String> = dates.iter().collect();
            sorted.sort();
            sorted.dedup();
            let place = |date| sorted.binary_search(&date).unwrap_or_default() as f64;
            dates.iter().map(place).collect()
        }
    }
}

/// Whether all of them are dates of the calendar.
#[must_use]
pub(crate) fn are_days(dates: &[String]) -> bool {
    dates.iter().all(|date| day_of(date).is_some())
}

/// Day of the Gregorian calendar, counted from 0000-03-01.
fn day_of(date: &str) -> Option<i64> {
    let number = |from: usize, to: usize| -> Option<i64> {
        let digits = date.get(from..to)?;
        let plain = digits.bytes().all(|b| b.is_ascii_digit());
        plain.then(|| digits.parse().ok()).flatten()
    };
    let dashes = date.get(4..5) == Some("-") && date.get(7..8) == Some("-");
    let (year, month, day) = (number(0, 4)?, number(5, 7)?, number(8, 10)?);
    if !dashes || !(1..=12).contains(&month) || !(1..=31).contains(&day) {
        return None;
    }
    // The year begins in March, so that a leap day is its last.
    let (y, m) = match month > 2 {
        true => (year, month - 3),
        false => (year - 1, month + 9),
    };
    Some(
        365 * y + y.div_euclid(4) - y.div_euclid(100) + y.div_euclid(400) + (153 * m + 2) / 5 + day
            - 1,
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn verify_days_between_dates() {
        let dates = ["2024-02-28", "2024-03-01", "2025-03-01", "2024-01-01"].map(str::to_owned);
        assert_eq!(days(&dates), [58.0, 60.0, 425.0, 0.0]);
        let shifts = ["run-2", "run-10", "run-2"].map(str::to_owned);
        assert_eq!(days(&shifts), [1.0, 0.0, 1.0]);
        assert!(!are_days(&shifts) && are_days(&dates));
    }
}
