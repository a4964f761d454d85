//! Draws one chart of each kind into the folder named on the command line.

use std::path::PathBuf;

use simgap_report::chart::{
    Bar, BarChart, LineChart, Mark, Role, Scale, Series, Span, SpectrumChart,
};

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let folder = PathBuf::from(std::env::args().nth(1).ok_or("name a folder to write to")?);
    std::fs::create_dir_all(&folder)?;
    let t: Vec<f64> = (0..60_000).map(|n| f64::from(n) * 1e-3).collect();
    let wave = |gain: f64, ripple: f64| -> Vec<f64> {
        t.iter()
            .map(|t| 1e-3 * (gain * (2.0 * t).sin() + ripple * (37.0 * t).sin()))
            .collect()
    };
    let mut lines = LineChart::new("Displacement of the table", "time [s]", "y [m]")
        .with(Series::new("measured", Role::Measured, &t, wave(1.0, 0.2)))
        .with(Series::new(
            "nominal model",
            Role::Nominal,
            &t,
            wave(1.3, 0.0),
        ))
        .with(Series::new(
            "corrected model",
            Role::Corrected,
            &t,
            wave(0.99, 0.2),
        ))
        .with(Series::from_points("limit", Role::Reference, &[(0.0, 1e-3), (60.0, 1e-3)]).dashed());
    std::fs::write(folder.join("lines.svg"), lines.to_svg()?)?;
    lines.x_range = Some([10.0, 13.0]);
    lines.spans.push(Span {
        from: 11.0,
        to: 11.5,
        label: "worst".into(),
    });
    std::fs::write(folder.join("zoom.svg"), lines.to_svg()?)?;

    let freq: Vec<f64> = (1..2000).map(|n| f64::from(n) * 0.1).collect();
    let density = |peak: f64| -> Vec<f64> {
        freq.iter()
            .map(|f| 1e-12 + 1e-7 * peak / (1.0 + (f - 12.0).powi(2)))
            .collect()
    };
    let mut spectrum = SpectrumChart::new("Discrepancy", "density [m²/Hz]")
        .with(Series::new("nominal", Role::Nominal, &freq, density(1.0)))
        .with(Series::new(
            "corrected",
            Role::Corrected,
            &freq,
            density(0.01),
        ));
    spectrum.x_scale = Scale::Log;
    spectrum.bands.push(Span {
        from: 9.0,
        to: 15.0,
        label: "first mode".into(),
    });
    std::fs::write(folder.join("spectrum.svg"), spectrum.to_svg()?)?;

    let orders: Vec<(f64, f64)> = (1..12)
        .map(|n| (f64::from(n), 2e-3 / f64::from(n * n)))
        .collect();
    let stems = LineChart::new("Harmonics of the drive", "order [1]", "amplitude [m]")
        .with(Series::from_points("", Role::Measured, &orders).with_mark(Mark::Stems));
    std::fs::write(folder.join("stems.svg"), stems.to_svg()?)?;

    let bars = [
        ("between mold and ground", 0.81),
        ("mass mold", 0.13),
        ("channel y", 0.06),
    ]
    .map(|(label, share)| Bar::share(label, share, Role::Nominal));
    let bars = BarChart::shares("Where the discrepancy lies", bars.to_vec());
    std::fs::write(folder.join("bars.svg"), bars.to_svg()?)?;
    Ok(())
}
