//! What every page needs: the published numbers, the plant, and the one timing error.

use simgap_alpha::{
    ConverterFault, Explanation, ObservedLine, Oscillator, RateFormula, UnknownForce,
    explain_lines, unknown_force_of_record,
};
use simgap_integrate::inverse::Differentiator;
use simgap_mold::{
    DISPLACEMENT_CHANNEL, FORCE_CHANNEL, OneDof, Reading, RebuiltRecord, published_line_amplitude,
    published_plan, rebuild,
};
use simgap_tables::{StatedValues, Table1, Table2, Table3, Table4, Table5};

use super::ReproduceError;

/// Park's formula, seen from the frequency domain.
pub const PARK: RateFormula = RateFormula::Scheme(Differentiator::Park);

/// Excitations that Tables 3, 4 and 5 share, Hz.
pub(crate) const EXCITATIONS_HZ: [f64; 6] = [1.0, 2.0, 3.0, 4.0, 5.0, 6.0];

/// Rate at which the two readings part, Hz.
pub(crate) const FAST_RATE_HZ: f64 = 500.0;

/// The published numbers and what follows at once.
#[derive(Debug, Clone)]
pub struct Context {
    /// Table 1.
    pub table1: Table1,
    /// Table 2.
    pub table2: Table2,
    /// Table 3.
    pub table3: Table3,
    /// Table 4.
    pub table4: Table4,
    /// Table 5.
    pub table5: Table5,
    /// Values stated in the text.
    pub stated: StatedValues,
    /// The mold of Table 1.
    pub mold: OneDof,
    /// The same for Eq. (3).
    pub plant: Oscillator,
    /// The alternating timing that explains Table 4 best, through Park's formula.
    pub timing: Explanation,
}

impl Context {
    /// Reads the tables and fits the one timing error.
    ///
    /// # Errors
    /// Those of the tables, the model and the fit.
    pub fn new() -> Result<Self, ReproduceError> {
        let (table4, stated) = (simgap_tables::table4()?, simgap_tables::stated_values()?);
        let mold = OneDof::published()?;
        let plant = Oscillator::from_model(&mold.model()?)?;
        let timing = explain_lines(
            &observed(&table4),
            &plant,
            stated.amplitude.si(),
            stated.time_step.si(),
            PARK,
            ConverterFault::AlternatingTiming,
        )?;
        Ok(Self {
            table1: simgap_tables::table1()?,
            table2: simgap_tables::table2()?,
            table3: simgap_tables::table3()?,
            table4,
            table5: simgap_tables::table5()?,
            stated,
            mold,
            plant,
            timing,
        })
    }

    /// The paper's sampling step, s.
    pub(crate) fn time_step_s(&self) -> f64 {
        self.stated.time_step.si()
    }

    /// The paper's sample rate, Hz.
    pub(crate) fn sample_rate_hz(&self) -> f64 {
        self.time_step_s().recip().round()
    }

    /// First and last excitation of Table 2, as printed, Hz.
    pub(crate) fn stated_excitations(&self) -> [&str; 2] {
        let rows = &self.table2.rows;
        [rows.first(), rows.last()].map(|row| row.map_or("none", |row| row.excitation.printed()))
    }

    /// Samples of the first second: past the start of every formula, and a whole number of
    /// periods of every excitation, so that lines stay orthogonal in what is left.
    pub(crate) fn first_second(&self) -> usize {
        self.sample_rate_hz() as usize
    }

    /// The paper's amplitude, m.
    pub(crate) fn amplitude(&self) -> f64 {
        self.stated.amplitude.si()
    }

    /// Another fault or formula for Table 4.
    pub(crate) fn explain(
        &self,
        formula: RateFormula,
        fault: ConverterFault,
    ) -> Result<Explanation, ReproduceError> {
        let observed = observed(&self.table4);
        let (amplitude, step) = (self.amplitude(), self.time_step_s());
        Ok(explain_lines(
            &observed,
            &self.plant,
            amplitude,
            step,
            formula,
            fault,
        )?)
    }

    /// The first reading: one timing error for all excitations.
    pub(crate) fn timing_reading(&self) -> Reading {
        Reading::AlternatingTiming {
            timing_error_s: self.timing.value,
        }
    }

    /// The second reading: a vibration at 50 -+ f, as high as Table 4 asks for at this excitation.
    pub(crate) fn support_reading(&self, freq_hz: f64) -> Result<Reading, ReproduceError> {
        Ok(Reading::FlexibleSupport {
            line_amplitude: published_line_amplitude(freq_hz)?,
            base_hz: self.stated.image_base.si(),
        })
    }

    /// A rebuilt record of the paper's excitation.
    pub(crate) fn record(
        &self,
        freq_hz: f64,
        sample_rate_hz: f64,
        reading: Reading,
    ) -> Result<RebuiltRecord, ReproduceError> {
        Ok(rebuild(
            &self.mold,
            published_plan(freq_hz, sample_rate_hz, reading)?,
        )?)
    }

    /// The unknown force of a rebuilt record, through Park's formula as in the paper.
    pub(crate) fn unknown_force(
        &self,
        rebuilt: &RebuiltRecord,
    ) -> Result<UnknownForce, ReproduceError> {
        Ok(unknown_force_of_record(
            &self.plant,
            &rebuilt.record,
            DISPLACEMENT_CHANNEL,
            FORCE_CHANNEL,
            Differentiator::Park,
        )?)
    }
}

fn observed(table4: &Table4) -> Vec<ObservedLine> {
    let line = |row: &simgap_tables::BeatRow| ObservedLine {
        excitation_freq_hz: row.excitation.si(),
        force_amplitude: row.amplitude.si(),
    };
    table4.rows.iter().map(line).collect()
}

/// The samples of a channel.
pub(crate) fn samples(rebuilt: &RebuiltRecord, channel: &str) -> Result<Vec<f64>, ReproduceError> {
    Ok(rebuilt.record.require(channel)?.values.clone())
}

/// The mean of some values.
pub(crate) fn mean(values: &[f64]) -> f64 {
    values.iter().sum::<f64>() / values.len() as f64
}
