//! Counts of a clock as dates.

/// A count of parts of a second since 1970, or since midnight, as text.
pub(crate) fn text(stamp: i64, per_second: u32, of_day: bool) -> String {
    let per_second = i64::from(per_second);
    let (seconds, part) = (stamp.div_euclid(per_second), stamp.rem_euclid(per_second));
    let digits = per_second.ilog10() as usize;
    let (days, of_the_day) = (seconds.div_euclid(86_400), seconds.rem_euclid(86_400));
    let (hours, minutes, seconds) = (of_the_day / 3600, of_the_day / 60 % 60, of_the_day % 60);
    let part = if digits > 0 {
        format!(".{part:0digits$}")
    } else {
        String::new()
    };
    let clock = format!("{hours:02}:{minutes:02}:{seconds:02}{part}");
    if of_day {
        return clock;
    }
    let (year, month, day) = civil(days);
    format!("{year:04}-{month:02}-{day:02} {clock}")
}

/// Year, month and day of a day counted from 1970-01-01, in the calendar of today for all times.
///
/// Counted in years from March, so that the day that leap years add is the last of its year.
fn civil(days: i64) -> (i64, i64, i64) {
    // Days of 400 years, of 100, of 4, and of 1.
    const CYCLE: i64 = 146_097;
    let from_march = days + 719_468;
    let (cycle, day) = (from_march.div_euclid(CYCLE), from_march.rem_euclid(CYCLE));
    let year = (day - day / 1_460 + day / 36_524 - day / (CYCLE - 1)) / 365;
    let day = day - (365 * year + year / 4 - year / 100);
    let month = (5 * day + 2) / 153;
    let day = day - (153 * month + 2) / 5 + 1;
    let (month, late) = if month < 10 {
        (month + 3, 0)
    } else {
        (month - 9, 1)
    };
    (400 * cycle + year + late, month, day)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn verify_days_of_the_calendar() {
        let cases = [
            (0, (1970, 1, 1)),
            (-1, (1969, 12, 31)),
            (11_016, (2000, 2, 29)),
            (19_782, (2024, 2, 29)),
            (19_783, (2024, 3, 1)),
            (47_540, (2100, 2, 28)),
            (47_541, (2100, 3, 1)),
        ];
        for (days, date) in cases {
            assert_eq!(civil(days), date, "{days}");
        }
    }
}
