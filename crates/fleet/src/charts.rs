//! Values over time as pictures.

use simgap_estimate::NORMAL_95;
use simgap_report::chart::{ChartError, LineChart, Mark, Role, Series as Line};

use crate::findings::{Series, Told};
use crate::observe::{Observation, Quantity};
use crate::time::are_days;

/// Charts of values at the most; those that a finding tells of come first.
const MOST_CHARTS: usize = 12;
/// Values of which no finding tells are drawn where there are so many.
const LEAST_POINTS: usize = 10;
/// Machines that are drawn in a colour of their own in one chart.
const MOST_COLOURS: usize = 4;

/// A picture with its caption.
pub(crate) struct Drawn {
    pub(crate) caption: String,
    pub(crate) svg: String,
}

/// Values over time: those that a finding tells of, then those of named effects.
pub(crate) fn charts(told: &Told, observations: &[Observation]) -> Result<Vec<Drawn>, ChartError> {
    let finds = |quantity: &Quantity| -> Vec<&str> {
        let own = told.findings.iter().filter(|f| {
            let same = f.kind == quantity.cause.kind && f.place == quantity.cause.place;
            same && f
                .parameter
                .as_ref()
                .is_none_or(|p| *p == quantity.parameter)
        });
        let machines = own.filter_map(|f| f.levels.get("machine"));
        let mut all: Vec<&str> = machines.flatten().map(String::as_str).collect();
        all.sort_unstable();
        all.dedup();
        all
    };
    let mut chosen: Vec<(&Quantity, &Vec<Series>, Vec<&str>)> = told
        .series
        .iter()
        .map(|(quantity, series)| (quantity, series, finds(quantity)))
        .collect();
    let count = |series: &[Series]| series.iter().map(|one| one.estimates.len()).sum::<usize>();
    chosen.retain(|(_, series, machines)| !machines.is_empty() || count(series) >= LEAST_POINTS);
    chosen.sort_by_key(|(_, _, machines)| machines.is_empty());
    let dates: Vec<String> = observations.iter().map(|o| o.date.clone()).collect();
    let axis = match (are_days(&dates), dates.iter().min()) {
        (true, Some(first)) => format!("days since {first}"),
        _ => "date, in order".to_owned(),
    };
    let drawn = chosen
        .into_iter()
        .take(MOST_CHARTS)
        .map(|(quantity, series, machines)| {
            Ok(Drawn {
                caption: format!("{} of {}", quantity.parameter, quantity.cause),
                svg: chart(quantity, series, &machines, &axis)?,
            })
        });
    drawn.collect()
}

fn chart(
    quantity: &Quantity,
    series: &[Series],
    machines: &[&str],
    axis: &str,
) -> Result<String, ChartError> {
    let mut chart = LineChart::new("", axis, quantity.parameter.clone());
    let points = |one: &Series| -> Vec<(f64, f64)> {
        one.times
            .iter()
            .zip(&one.estimates)
            .map(|(t, e)| (*t, e.value))
            .collect()
    };
    let shown: Vec<&str> = machines.iter().copied().take(MOST_COLOURS).collect();
    let is_own = |one: &&Series| shown.contains(&one.machine.as_str());
    let rest: Vec<(f64, f64)> = series
        .iter()
        .filter(|one| !is_own(one))
        .flat_map(points)
        .collect();
    if !rest.is_empty() {
        let name = if shown.is_empty() {
            "all machines"
        } else {
            "other machines"
        };
        chart = chart.with(Line::from_points(name, Role::Reference, &rest).with_mark(Mark::Points));
    }
    for (place, one) in series.iter().filter(is_own).enumerate() {
        let role = Role::Other(place as u8);
        let ends: Vec<(f64, f64)> = one
            .times
            .iter()
            .zip(&one.estimates)
            .flat_map(|(t, e)| {
                let half = NORMAL_95 * e.std;
                // A gap ends each of them.
                [(*t, e.value - half), (*t, e.value + half), (*t, f64::NAN)]
            })
            .collect();
        chart = chart.with(Line::from_points("", role, &ends));
        let named = Line::from_points(one.machine.clone(), role, &points(one));
        chart = chart.with(named.with_mark(Mark::Points));
    }
    chart.to_svg()
}
