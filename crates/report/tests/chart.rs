//! Pictures: what must be in them, what must not break them, how long they take.
#![allow(clippy::unwrap_used)]

use simgap_report::chart::{
    Bar, BarChart, ChartError, ChartSize, LineChart, Mark, Role, Scale, Series, Span, SpectrumChart,
};

fn ramp(n: usize) -> Vec<f64> {
    (0..n).map(|i| i as f64 * 1e-3).collect()
}

fn waves(t: &[f64], freq_hz: f64) -> Vec<f64> {
    t.iter()
        .map(|t| (std::f64::consts::TAU * freq_hz * t).sin())
        .collect()
}

/// Every coordinate pair of the drawn series, in tenths of a pixel; the frame is left out.
fn path_points(svg: &str) -> Vec<(f64, f64)> {
    svg.lines()
        .filter(|line| !line.contains("#8C959F"))
        .filter_map(|line| line.split("points=\"").nth(1)?.split('"').next())
        .flat_map(str::split_whitespace)
        .map(|pair| {
            let (x, y) = pair.split_once(',').unwrap();
            (x.parse().unwrap(), y.parse().unwrap())
        })
        .collect()
}

#[test]
fn verify_a_minute_at_a_kilohertz_becomes_a_few_hundred_points() {
    let t = ramp(60_000);
    let svg = LineChart::new("record", "time [s]", "y [m]")
        .with(Series::new("measured", Role::Measured, &t, waves(&t, 7.3)))
        .to_svg()
        .unwrap();
    let points = path_points(&svg);
    assert!((300..800).contains(&points.len()), "{}", points.len());
    assert!(svg.len() < 20_000, "{}", svg.len());
}

#[test]
fn verify_points_land_where_the_axes_say() {
    let mut chart = LineChart::new("", "", "").with(Series::from_points(
        "",
        Role::Nominal,
        &[(0.0, 0.0), (5.0, 1.0), (10.0, 0.0)],
    ));
    chart.x_range = Some([0.0, 10.0]);
    chart.y_range = Some([0.0, 2.0]);
    let points = path_points(&chart.to_svg().unwrap());
    // The middle point is half way along and half way up.
    assert_eq!(points.len(), 3);
    assert!((points[1].0 - 0.5 * (points[0].0 + points[2].0)).abs() <= 1.0);
    assert_eq!(points[0].1, points[2].1);
    // Natural size 720 x 300: the frame ends 16 px from the right and 26 px from the bottom.
    assert_eq!(points[2], (7040.0, 2740.0));
}

#[test]
fn verify_log_axes_place_decades_evenly() {
    let mut chart = LineChart::new("", "", "").with(Series::from_points(
        "",
        Role::Nominal,
        &[(1.0, 1.0), (10.0, 1.0), (100.0, 1.0)],
    ));
    chart.x_scale = Scale::Log;
    let p = path_points(&chart.to_svg().unwrap());
    assert!((p[1].0 - p[0].0 - (p[2].0 - p[1].0)).abs() <= 1.0, "{p:?}");
}

#[test]
fn verify_hostile_numbers_are_skipped() {
    let x = [0.0, 1.0, f64::NAN, 3.0, 4.0, f64::INFINITY, 6.0, 7.0];
    let y = [
        f64::NAN,
        1.0,
        1.0,
        f64::NEG_INFINITY,
        f64::MAX,
        1.0,
        -1.0,
        f64::MIN_POSITIVE,
    ];
    for mark in [Mark::Line, Mark::Points, Mark::Steps, Mark::Stems] {
        for (x_scale, y_scale) in [(Scale::Linear, Scale::Linear), (Scale::Log, Scale::Log)] {
            let mut chart = LineChart::new("t", "x", "y")
                .with(Series::new("s", Role::Other(250), &x[..], &y[..]).with_mark(mark));
            chart.x_scale = x_scale;
            chart.y_scale = y_scale;
            let svg = chart.to_svg().unwrap();
            assert!(!svg.contains("NaN") && !svg.contains("inf"), "{svg}");
        }
    }
}

#[test]
fn verify_empty_and_constant_series_have_a_picture() {
    let none = LineChart::new("t", "x", "y").to_svg().unwrap();
    assert!(none.contains("no data"));
    let empty =
        LineChart::new("t", "x", "y").with(Series::new("s", Role::Measured, vec![], vec![]));
    assert!(empty.to_svg().unwrap().contains("no data"));
    for value in [0.0, -2.5, 1e-300, 1e149] {
        let chart = LineChart::new("t", "x", "y").with(Series::new(
            "s",
            Role::Measured,
            ramp(50),
            vec![value; 50],
        ));
        let svg = chart.to_svg().unwrap();
        assert!(!svg.contains("no data") && !svg.contains("NaN"), "{value}");
    }
    let spectrum =
        SpectrumChart::new("t", "y").with(Series::new("s", Role::Nominal, ramp(5), vec![0.0; 5]));
    assert!(spectrum.to_svg().unwrap().contains("no data"));
    assert!(
        BarChart::shares("t", Vec::new())
            .to_svg()
            .unwrap()
            .contains("nothing to show")
    );
}

#[test]
fn verify_bars_are_as_long_as_their_shares() {
    let bars = vec![
        Bar::share("all", 1.0, Role::Nominal),
        Bar::share("half", 0.5, Role::Nominal),
        Bar::share("bad", f64::NAN, Role::Nominal),
    ];
    let svg = BarChart::shares("Shares", bars).to_svg().unwrap();
    let widths: Vec<f64> = svg
        .lines()
        .filter(|l| l.contains("fill=\"#D55E00\""))
        .map(|l| {
            l.split("width=\"")
                .nth(1)
                .unwrap()
                .split('"')
                .next()
                .unwrap()
                .parse()
                .unwrap()
        })
        .collect();
    assert_eq!(widths.len(), 2);
    assert!((widths[0] - 2.0 * widths[1]).abs() <= 1.0, "{widths:?}");
    assert!(svg.contains("100\u{a0}%") && svg.contains("50\u{a0}%") && svg.contains('–'));
}

#[test]
fn verify_text_from_files_is_escaped() {
    let evil = "a<script>\"&'\u{0}b";
    let mut chart = LineChart::new(evil, evil, evil).with(Series::from_points(
        evil,
        Role::Nominal,
        &[(0.0, 1.0), (1.0, 2.0)],
    ));
    chart.spans.push(Span {
        from: 0.0,
        to: 1.0,
        label: evil.into(),
    });
    let bars = BarChart::shares(evil, vec![Bar::share(evil, 0.5, Role::Nominal)]);
    for svg in [chart.to_svg().unwrap(), bars.to_svg().unwrap()] {
        assert!(!svg.contains("<script") && !svg.contains('\u{0}'));
        assert!(svg.contains("&lt;script&gt;"));
    }
}

#[test]
fn verify_dashes_colours_and_view_box() {
    let series = Series::from_points("floor", Role::Reference, &[(0.0, 1.0), (1.0, 2.0)]).dashed();
    let chart = LineChart::new("t", "x", "y").with(series);
    let svg = chart.to_svg().unwrap();
    assert!(
        svg.contains("viewBox=\"0 0 7200 3000\"") && svg.contains("width=\"720\" height=\"300\"")
    );
    // The line and its key in the legend.
    assert_eq!(svg.matches("stroke-dasharray").count(), 2);
    assert!(svg.contains(Role::Reference.colour().light));
    assert!(!svg.contains("opacity"));
    assert_eq!(svg, chart.to_svg().unwrap());
}

#[test]
fn verify_errors_say_what_is_needed() {
    let chart =
        LineChart::new("t", "x", "y").with(Series::new("s", Role::Nominal, vec![0.0], vec![]));
    assert_eq!(
        chart.to_svg().unwrap_err().to_string(),
        "series `s` of chart `t` has 0 y values for 1 x values, equally many are needed"
    );
    let mut chart = LineChart::new("t", "x", "y");
    chart.size = ChartSize::new(10, 10);
    assert_eq!(
        chart.to_svg().unwrap_err().to_string(),
        "a chart of 10 x 10 pixels was asked for, 160 x 60 to 4000 x 4000 are possible"
    );
    let mut chart = LineChart::new("t", "x", "y");
    chart.y_scale = Scale::Log;
    for bad in [[0.0, 1.0], [2.0, 1.0], [1.0, f64::NAN]] {
        chart.y_range = Some(bad);
        assert!(
            matches!(chart.to_svg(), Err(ChartError::BadRange { axis: "y", .. })),
            "{bad:?}"
        );
    }
    assert_eq!(
        chart.to_svg().unwrap_err().to_string(),
        "the y axis of chart `t` is set from 1 to NaN, two rising positive numbers are needed"
    );
}

#[test]
fn verify_a_chart_of_a_million_samples_draws_a_few_hundred_points() {
    let t = ramp(1_000_000);
    let y = waves(&t, 50.0);
    let svg = LineChart::new("t", "x", "y")
        .with(Series::new("measured", Role::Measured, &t, &y))
        .with(Series::new("points", Role::Nominal, &t, &y).with_mark(Mark::Points))
        .to_svg()
        .unwrap();
    assert!(path_points(&svg).len() < 800);
}
