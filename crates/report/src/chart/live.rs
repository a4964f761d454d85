//! A line chart as data for the script of the page, which draws it again with zoom and cursor.
//!
//! Values are rounded to one part in 65 000 of their range and packed two bytes each, which is
//! finer than a screen and a tenth of the same numbers in writing.

use serde_json::{Value, json};

use super::decimate::telling;
use super::{LineChart, Mark, Scale, Series};

/// Stands for a value that is not shown.
const GAP: u16 = u16::MAX;
/// Number of steps that a value can take.
const STEPS: f64 = 65_534.0;

/// JSON without any `<`, safe inside a script element; `None` if the series do not share a rising
/// abscissa of two or more points, or are not lines.
///
/// `home` is a stretch of the abscissa that is kept in full as far as `budget`, the number of
/// points, allows.
pub(crate) fn live_json(
    chart: &LineChart<'_>,
    budget: usize,
    home: Option<[f64; 2]>,
) -> Option<String> {
    let first = chart.series.first()?;
    let shared = chart
        .series
        .iter()
        .all(|s| s.mark == Mark::Line && s.x == first.x);
    let log = chart.x_scale == Scale::Log;
    let inside = |x: f64| x.is_finite() && (!log || x > 0.0);
    if !shared || !first.x.windows(2).all(|w| w[0] < w[1]) {
        return None;
    }
    let ys: Vec<&[f64]> = chart.series.iter().map(|s| &*s.y).collect();
    let mut kept = telling(&first.x, &ys, budget, home);
    kept.retain(|&i| inside(first.x[i]));
    let (from, to) = (*first.x.get(*kept.first()?)?, *first.x.get(*kept.last()?)?);
    if from >= to {
        return None;
    }
    let series: Vec<Value> = chart
        .series
        .iter()
        .map(|s| one(s, &kept, chart.y_scale))
        .collect();
    let spans: Vec<Value> = chart
        .spans
        .iter()
        .map(|s| json!({"from": s.from, "to": s.to, "label": s.label}))
        .collect();
    let value = json!({
        "x": {"label": chart.x_label, "log": log, "from": from, "to": to,
              "data": base64(&abscissa(&first.x, &kept, from, to))},
        "y": {"label": chart.y_label, "log": chart.y_scale == Scale::Log},
        "series": series,
        "spans": spans,
        "range": chart.x_range,
        "home": home,
    });
    // The only characters that could end the element.
    Some(
        value
            .to_string()
            .replace('<', "\\u003c")
            .replace('>', "\\u003e")
            .replace('&', "\\u0026"),
    )
}

fn one(series: &Series<'_>, kept: &[usize], scale: Scale) -> Value {
    let log = scale == Scale::Log;
    let value = |i: usize| {
        let y = series.y.get(i).copied().unwrap_or(f64::NAN);
        let y = if log { y.log10() } else { y };
        (y.abs() < 1e150).then_some(y)
    };
    let shown = || kept.iter().filter_map(|&i| value(i));
    let low = shown().fold(f64::INFINITY, f64::min);
    let high = shown().fold(f64::NEG_INFINITY, f64::max);
    let (low, high) = if low <= high { (low, high) } else { (0.0, 0.0) };
    let span = if high > low { high - low } else { 1.0 };
    let mut bytes = Vec::with_capacity(2 * kept.len());
    for &i in kept {
        let step = value(i).map_or(GAP, |y| ((y - low) / span * STEPS).round() as u16);
        bytes.extend(step.to_le_bytes());
    }
    let colour = series.role.colour();
    json!({
        "name": series.name,
        "light": colour.light,
        "dark": colour.dark,
        "width": f64::from(series.role.line_width()) / 10.0,
        "dashed": series.dashed,
        "from": low,
        "step": span / STEPS,
        "data": base64(&bytes),
    })
}

/// Four bytes each, as a share of the range.
fn abscissa(x: &[f64], kept: &[usize], from: f64, to: f64) -> Vec<u8> {
    let share = |i: &usize| ((x[*i] - from) / (to - from) * f64::from(u32::MAX)).round() as u32;
    kept.iter().flat_map(|i| share(i).to_le_bytes()).collect()
}

/// RFC 4648, with padding.
fn base64(bytes: &[u8]) -> String {
    const DIGITS: &[u8; 64] = b"ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    let mut out = String::with_capacity(bytes.len().div_ceil(3) * 4);
    for three in bytes.chunks(3) {
        let at = |i: usize| u32::from(three.get(i).copied().unwrap_or(0));
        let bits = at(0) << 16 | at(1) << 8 | at(2);
        for k in 0..4 {
            if k <= three.len() {
                out.push(char::from(DIGITS[(bits >> (18 - 6 * k)) as usize & 63]));
            } else {
                out.push('=');
            }
        }
    }
    out
}

#[cfg(test)]
mod tests {
    use super::super::Role;
    use super::*;

    #[test]
    fn verify_base64_of_the_standard() {
        for (bytes, text) in [
            ("", ""),
            ("f", "Zg=="),
            ("fo", "Zm8="),
            ("foo", "Zm9v"),
            ("foobar", "Zm9vYmFy"),
        ] {
            assert_eq!(base64(bytes.as_bytes()), text);
        }
    }

    #[test]
    fn verify_ends_of_the_range_are_exact_and_gaps_are_marked() {
        let x = vec![0.0, 1.0, 2.0];
        let chart = LineChart::new("", "t", "</script>").with(Series::new(
            "s",
            Role::Nominal,
            x,
            vec![-1.0, f64::NAN, 3.0],
        ));
        let text = live_json(&chart, 100, None).expect("a line");
        assert!(!text.contains('<') && text.contains("\\u003c/script"));
        let value: Value = serde_json::from_str(&text).expect("JSON");
        assert_eq!(
            value["series"][0]["data"],
            base64(&[0, 0, 255, 255, 254, 255])
        );
        assert_eq!(value["series"][0]["from"], -1.0);
        let step = value["series"][0]["step"].as_f64().expect("a number");
        assert!((STEPS * step - 4.0).abs() < 1e-12);
    }

    #[test]
    fn verify_what_cannot_be_redrawn_is_left_to_the_picture() {
        let points = |x: Vec<f64>| {
            let y = x.clone();
            LineChart::new("", "x", "y").with(Series::new("s", Role::Nominal, x, y))
        };
        assert!(live_json(&points(vec![0.0, 2.0, 1.0]), 9, None).is_none());
        assert!(live_json(&points(vec![0.0]), 9, None).is_none());
        assert!(live_json(&points(vec![]), 9, None).is_none());
        assert!(live_json(&points(vec![0.0, 1.0]), 9, None).is_some());
    }
}
