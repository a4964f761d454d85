//! What each differentiation formula does to the unknown force, up to the Nyquist frequency.

use simgap_alpha::{GainRow, RateFormula, gain_table};
use simgap_integrate::inverse::Differentiator;
use simgap_report::chart::{LineChart, Role, Scale, Series};

use super::context::PARK;
use super::{Block, Cell, Context, Page, ReproduceError, Table, significant};

/// Frequencies of the table, Hz: the excitations' range, and the high lines of Table 2.
const TABLE_HZ: [f64; 8] = [1.0, 6.0, 25.0, 43.0, 45.0, 47.0, 49.0, 50.0];

fn name(differentiator: Differentiator) -> &'static str {
    match differentiator {
        Differentiator::Park => "Park",
        Differentiator::BackwardEuler => "backward Euler",
        Differentiator::Bdf2 => "BDF 2",
        Differentiator::CentralSecond => "central, order 2",
        Differentiator::CentralFourth => "central, order 4",
    }
}

pub(crate) fn page(context: &Context) -> Result<Page, ReproduceError> {
    let rows = gain_table(&context.plant, &TABLE_HZ, context.time_step_s())?;
    let mut table = Table::new(
        "Derivative and force over the exact ones, at the step of the paper",
        &[
            "formula",
            "frequency [Hz]",
            "rate",
            "rate, phase [°]",
            "force",
            "force, phase [°]",
        ],
    );
    let degrees = |value: f64| Cell::text(format!("{:.1}", (10.0 * value).round() / 10.0 + 0.0));
    for row in &rows {
        table.rows.push(vec![
            Cell::text(name(row.differentiator)),
            Cell::Number(row.freq_hz, 2),
            ratio(row.rate_ratio),
            if row.rate_ratio < 1e-9 {
                Cell::text("none")
            } else {
                degrees(row.rate_phase_deg)
            },
            ratio(row.force_ratio),
            degrees(row.force_phase_deg),
        ]);
    }
    Ok(Page {
        stem: "differentiators",
        title: "Differentiation formulas near the Nyquist frequency".to_owned(),
        summary: "gain and phase of Park's formula and others in the unknown force".to_owned(),
        blocks: vec![
            Block::Text(text(context)?),
            Block::Table(table),
            Block::Figure(
                "differentiators-force",
                "Unknown force over the exact one, for the mold of Table 1 at the paper's rate"
                    .to_owned(),
                chart(context)?,
            ),
        ],
    })
}

fn text(context: &Context) -> Result<String, ReproduceError> {
    let (nyquist, step) = (0.5 * context.sample_rate_hz(), context.time_step_s());
    let park = gain_table(&context.plant, &[nyquist], step)?
        .into_iter()
        .find(|row| row.differentiator == Differentiator::Park)
        .ok_or(ReproduceError::Story(
            "Park's formula is among the formulas",
        ))?;
    Ok(format!(
        "Eq. (3) takes two derivatives of a sampled displacement. A formula's factor D replaces iω, and \
         the force at a frequency is (m D² + c D + k) y. At the Nyquist frequency Park's formula has the gain \
         16/(3h) = {} 1/s where the true factor is π/h = {} 1/s, and a lag of {}°: a line at 50 − f \
         comes out in the unknown force {} times too large and with the sign turned over. Central differences \
         are blind there: only the spring force is left. Backward formulas therefore make the most \
         of whatever lies near half the sample rate, image or vibration.",
        significant(PARK.rate(nyquist, step)?.norm(), 3),
        significant(RateFormula::Exact.rate(nyquist, step)?.norm(), 3),
        significant(-park.rate_phase_deg, 2),
        significant(park.force_ratio, 2),
    ))
}

/// A ratio; rounding is shown as zero.
fn ratio(value: f64) -> Cell {
    Cell::Number(if value < 1e-9 { 0.0 } else { value }, 4)
}

fn chart(context: &Context) -> Result<LineChart<'static>, ReproduceError> {
    let freqs: Vec<f64> = (1..=200).map(|quarter| 0.25 * f64::from(quarter)).collect();
    let rows = gain_table(&context.plant, &freqs, context.time_step_s())?;
    let mut chart = LineChart::new(
        "Gain of the unknown force",
        "frequency [Hz]",
        "force over exact",
    );
    let roles = [
        Role::Measured,
        Role::Nominal,
        Role::Recalibrated,
        Role::Corrected,
        Role::Other(0),
    ];
    for (differentiator, role) in Differentiator::ALL.into_iter().zip(roles) {
        let of: Vec<&GainRow> = rows
            .iter()
            .filter(|row| row.differentiator == differentiator)
            .collect();
        let freq: Vec<f64> = of.iter().map(|row| row.freq_hz).collect();
        let gain: Vec<f64> = of.iter().map(|row| row.force_ratio).collect();
        chart = chart.with(Series::new(name(differentiator), role, freq, gain));
    }
    chart.y_scale = Scale::Log;
    Ok(chart)
}
