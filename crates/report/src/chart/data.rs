//! The data of a picture as comma-separated values, thinned as the picture itself is.

use super::decimate::telling;
use super::{BarChart, LineChart, Series};

/// Rows of a table at the most: more than any picture shows, and the predictions hold every sample.
const MOST_ROWS: usize = 20_000;

/// One column for the abscissa and one for each series where they share it, else a row for each
/// point with the name of its series. Cells that are not finite are empty.
pub(crate) fn lines_csv(chart: &LineChart<'_>) -> String {
    let Some(first) = chart.series.first() else {
        return row([chart.x_label.clone(), chart.y_label.clone()]);
    };
    let name = |s: &Series<'_>| {
        if s.name.is_empty() {
            chart.y_label.clone()
        } else {
            s.name.clone().into_owned()
        }
    };
    let mut out = String::new();
    if chart.series.iter().all(|s| s.x == first.x) {
        let head = std::iter::once(chart.x_label.clone());
        let unit = bracketed(&chart.y_label);
        let names = chart.series.iter().map(|s| name(s) + &unit);
        out.push_str(&row(head.chain(names)));
        let ys: Vec<&[f64]> = chart.series.iter().map(|s| &*s.y).collect();
        let [from, to] = chart.x_range.unwrap_or([f64::NEG_INFINITY, f64::INFINITY]);
        // What is shown of a rising abscissa lies together.
        let shown = |x: &f64| (from..=to).contains(x);
        let start = first.x.iter().position(shown).unwrap_or(0);
        let end = first.x.iter().rposition(shown).map_or(start, |i| i + 1);
        let inside: Vec<&[f64]> = ys
            .iter()
            .map(|y| y.get(start..end).unwrap_or_default())
            .collect();
        for i in telling(&first.x[start..end], &inside, MOST_ROWS, None) {
            let i = start + i;
            let values = ys.iter().map(|y| y.get(i).copied().unwrap_or(f64::NAN));
            out.push_str(&row(std::iter::once(first.x[i]).chain(values).map(number)));
        }
        return out;
    }
    let head = [
        "series".to_owned(),
        chart.x_label.clone(),
        chart.y_label.clone(),
    ];
    out.push_str(&row(head));
    for s in &chart.series {
        for (x, y) in s.x.iter().zip(s.y.iter()) {
            out.push_str(&row([name(s), number(*x), number(*y)]));
        }
    }
    out
}

/// A row for each bar.
pub(crate) fn bars_csv(chart: &BarChart) -> String {
    let marked = chart.bars.iter().any(|b| b.mark.is_some());
    let value = if chart.axis_label.is_empty() {
        "value"
    } else {
        &chart.axis_label
    };
    let mut head = vec!["bar".to_owned(), value.to_owned()];
    head.extend(marked.then(|| "mark".to_owned()));
    let mut out = row(head);
    let scale = if chart.percent { 100.0 } else { 1.0 };
    for bar in &chart.bars {
        let mut cells = vec![bar.label.clone(), number(scale * bar.value)];
        cells.extend(marked.then(|| number(scale * bar.mark.unwrap_or(f64::NAN))));
        out.push_str(&row(cells));
    }
    out
}

/// " [mm]" of "y [mm]".
fn bracketed(label: &str) -> String {
    label
        .rfind('[')
        .map_or(String::new(), |at| format!(" {}", &label[at..]))
}

/// To nine digits: more than a picture shows.
fn number(value: f64) -> String {
    if !value.is_finite() {
        return String::new();
    }
    let short: f64 = format!("{value:.8e}").parse().unwrap_or(value);
    if short != 0.0 && !(1e-5..1e9).contains(&short.abs()) {
        format!("{short:e}")
    } else {
        format!("{short}")
    }
}

/// Cells joined and ended, quoted where they must be. Control characters are dropped.
fn row(cells: impl IntoIterator<Item = String>) -> String {
    let mut out = String::new();
    for (i, cell) in cells.into_iter().enumerate() {
        if i > 0 {
            out.push(',');
        }
        let clean: String = cell.chars().filter(|c| !c.is_control()).collect();
        if clean.contains([',', '"', ';']) {
            out.push_str(&format!("\"{}\"", clean.replace('"', "\"\"")));
        } else {
            out.push_str(&clean);
        }
    }
    out.push('\n');
    out
}

#[cfg(test)]
mod tests {
    use super::super::{Bar, Role};
    use super::*;

    #[test]
    fn verify_series_on_one_abscissa_are_columns() {
        let x = [0.0, 0.5];
        let chart = LineChart::new("", "time [s]", "y [mm]")
            .with(Series::new(
                "measured, raw",
                Role::Measured,
                &x[..],
                vec![1.0, f64::NAN],
            ))
            .with(Series::new(
                "model",
                Role::Nominal,
                &x[..],
                vec![0.1 + 0.2, 2e-7],
            ));
        assert_eq!(
            lines_csv(&chart),
            "time [s],\"measured, raw [mm]\",model [mm]\n0,1,0.3\n0.5,,2e-7\n"
        );
    }

    #[test]
    fn verify_series_of_their_own_abscissa_are_rows() {
        let chart = LineChart::new("", "v [m/s]", "f [N]")
            .with(Series::from_points("points", Role::Nominal, &[(1.0, 2.0)]))
            .with(Series::from_points("mean", Role::Measured, &[(3.0, 4.0)]));
        assert_eq!(
            lines_csv(&chart),
            "series,v [m/s],f [N]\npoints,1,2\nmean,3,4\n"
        );
    }

    #[test]
    fn verify_bars_are_rows_with_their_marks() {
        let mut bar = Bar::share("a\"b", 0.25, Role::Nominal);
        bar.mark = Some(0.1);
        let mut chart = BarChart::shares("", vec![bar]);
        chart.axis_label = "share [%]".into();
        assert_eq!(bars_csv(&chart), "bar,share [%],mark\n\"a\"\"b\",25,10\n");
    }
}
