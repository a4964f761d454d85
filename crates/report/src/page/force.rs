//! The restoring-force pictures: the force that the model as given lacks, over displacement and
//! over velocity.

use simgap_diagnose::{PlaceMotion, Status};
use simgap_model::Location;

use super::picture::{Picture, PictureFile, SIZE};
use super::{ReportError, ReportInput};
use crate::chart::{LineChart, Mark, Role, Series};
use crate::markup::Html;
use crate::restoring::{MissingForce, missing_force};
use crate::unit::prefixed;

const TITLE: &str = "The force that the model as given lacks";
/// Places shown.
const MOST_PLACES: usize = 2;
/// Dots of a picture.
const MOST_DOTS: usize = 1500;
/// Classes of the abscissa over which the mean is taken; even, so that one ends at zero.
const CLASSES: usize = 24;
/// Fewest dots of a class that has a mean.
const FEWEST_DOTS: usize = 3;

/// The pictures, with a heading; nothing where no force can be told.
pub(super) fn missing(
    html: &mut Html,
    files: &mut Vec<PictureFile>,
    input: &ReportInput<'_>,
) -> Result<(), ReportError> {
    if input.diagnosis.verdict.status == Status::None {
        html.element("h3", &[], TITLE);
        let none = "None: what is left is noise, and a force drawn from it would have no meaning.";
        html.element("p", &[], none);
        return Ok(());
    }
    let found: Vec<(&PlaceMotion, MissingForce)> = places(input)
        .into_iter()
        .filter_map(|motion| {
            let series = input.series.iter().find(|s| s.record == motion.record)?;
            let force = missing_force(input.nominal?, input.diagnosis, series, motion)?;
            Some((motion, force))
        })
        .collect();
    if found.is_empty() {
        return Ok(());
    }
    html.element("h3", &[], TITLE);
    html.element(
        "p",
        &[],
        "Estimated from the discrepancy alone, no effect assumed: were all of the gap one force at this place, it would be this. A step at zero velocity is dry friction, a slope over velocity damping, a slope over displacement stiffness, a curve a law that is not linear; a cloud without shape is none of these.",
    );
    html.within("div", &[("class", "pair")], |html| {
        for (motion, force) in found {
            let unit = |unit: &str| input.diagnosis.unit_at(unit, &motion.at);
            let over = [
                ("displacement", unit("m"), &force.displacement),
                ("velocity", unit("m/s"), &force.velocity),
            ];
            for (variable, x_unit, x) in over {
                let chart = chart(motion, (variable, &x_unit, &unit("N")), x, &force);
                let slug = match variable {
                    "velocity" => "missing-force-velocity",
                    _ => "missing-force-displacement",
                };
                Picture::lines(slug, chart, None, None)?.show(html, files);
            }
        }
        Ok(())
    })
}

/// Where named effects act on the machine, else where most of the gap lies; of each the record
/// that moves most.
fn places<'a>(input: &ReportInput<'a>) -> Vec<&'a PlaceMotion> {
    let diagnosis = input.diagnosis;
    let named = diagnosis.verdict.effects.iter().map(|e| &e.at);
    let others = diagnosis.r#where.locations.iter().map(|l| &l.at);
    let all = input.motions.iter().map(|m| &m.at);
    let named = named.filter(|at| matches!(at, Location::Between(_) | Location::Mass(_)));
    let most = named.clone().count().clamp(1, MOST_PLACES);
    let mut shown: Vec<&PlaceMotion> = Vec::new();
    for at in named.chain(others).chain(all) {
        let here = input.motions.iter().filter(|m| is_at(m, at));
        let energy = |m: &PlaceMotion| m.velocity.iter().map(|v| v * v).sum::<f64>();
        let best = here.max_by(|a, b| energy(a).total_cmp(&energy(b)));
        if let Some(best) = best.filter(|b| shown.iter().all(|s| s.at != b.at)) {
            shown.push(best);
        }
        if shown.len() >= most {
            break;
        }
    }
    shown
}

/// Whether the motion is across that place; a mass moves against the ground.
fn is_at(motion: &PlaceMotion, at: &Location) -> bool {
    match (at, &motion.at) {
        (Location::Mass(mass), Location::Between([a, b])) => a == mass && b == simgap_model::GROUND,
        (at, own) => at == own,
    }
}

fn chart<'a>(
    motion: &PlaceMotion,
    (variable, unit, force_unit): (&str, &str, &str),
    x: &[f64],
    found: &MissingForce,
) -> LineChart<'a> {
    let size = |values: &[f64]| values.iter().fold(0.0, |m: f64, v| m.max(v.abs()));
    let x_unit = prefixed(unit, size(x));
    let y_unit = prefixed(force_unit, size(&found.force));
    let points: Vec<(f64, f64)> = x
        .iter()
        .zip(&found.force)
        .map(|(x, f)| (x * x_unit.factor, f * y_unit.factor))
        .collect();
    let stride = points.len().div_ceil(MOST_DOTS).max(1);
    let dots: Vec<(f64, f64)> = points.iter().step_by(stride).copied().collect();
    let mut chart = LineChart::new(
        format!(
            "Force that the model lacks {} over {variable}, {}",
            motion.at, motion.record
        ),
        format!("{variable} [{}]", x_unit.unit),
        format!("missing force [{}]", y_unit.unit),
    )
    .with(Series::from_points("samples", Role::Nominal, &dots).with_mark(Mark::Points));
    if variable == "velocity" {
        let mean = means(&points, variable);
        chart = chart.with(Series::from_points("mean", Role::Measured, &mean));
    } else {
        // A force that depends on the direction has two branches.
        let moving = |sign: f64| -> Vec<(f64, f64)> {
            let with_velocity = points.iter().zip(&found.velocity);
            let kept = with_velocity.filter(|(_, v)| *v * sign > 0.0);
            means(&kept.map(|(p, _)| *p).collect::<Vec<_>>(), variable)
        };
        chart = chart
            .with(Series::from_points(
                "mean, forward",
                Role::Measured,
                &moving(1.0),
            ))
            .with(Series::from_points("mean, back", Role::Corrected, &moving(-1.0)).dashed());
    }
    chart.size = SIZE;
    chart
}

/// The mean force in equal classes; those of velocity lie about zero.
fn means(points: &[(f64, f64)], variable: &str) -> Vec<(f64, f64)> {
    let fold = |(low, high): (f64, f64), p: &(f64, f64)| (low.min(p.0), high.max(p.0));
    let (mut low, mut high) = points.iter().fold((f64::INFINITY, f64::NEG_INFINITY), fold);
    if variable == "velocity" {
        let reach = high.max(-low);
        (low, high) = (-reach, reach);
    }
    let width = (high - low) / CLASSES as f64;
    if !(width > 0.0 && width.is_finite()) {
        return vec![];
    }
    let mut classes = [(0.0, 0usize); CLASSES];
    for (x, force) in points {
        let class = (((x - low) / width) as usize).min(CLASSES - 1);
        classes[class].0 += force;
        classes[class].1 += 1;
    }
    let classes = levelled(&classes, variable == "velocity");
    classes
        .iter()
        .enumerate()
        .filter(|(_, (_, count))| *count >= 2 * FEWEST_DOTS)
        .map(|(i, (sum, count))| (low + (i as f64 + 0.5) * width, sum / *count as f64))
        .collect()
}

/// Sums and counts with half of those of both neighbours: samples that come in step with the motion
/// fall into every other class. Nothing is carried over zero where a force may jump there.
fn levelled(classes: &[(f64, usize); CLASSES], jumps_at_zero: bool) -> [(f64, usize); CLASSES] {
    let mut out = *classes;
    for (i, (sum, count)) in out.iter_mut().enumerate() {
        (*sum, *count) = (2.0 * *sum, 2 * *count);
        for j in [i.wrapping_sub(1), i + 1] {
            let apart = jumps_at_zero && (i < CLASSES / 2) != (j < CLASSES / 2);
            if let Some((more, others)) = classes.get(j).filter(|_| !apart) {
                *sum += more;
                *count += others;
            }
        }
    }
    out
}

#[cfg(test)]
mod tests {
    use super::means;

    #[test]
    fn verify_means_follow_a_step_and_leave_out_thin_classes() {
        let step: Vec<(f64, f64)> = (-100..=100)
            .map(|i| (f64::from(i), if i < 0 { -2.0 } else { 2.0 }))
            .collect();
        let found = means(&step, "velocity");
        assert_eq!(found.len(), super::CLASSES);
        assert!(
            found
                .iter()
                .all(|(v, f)| (f - 2.0 * v.signum()).abs() < 1e-12)
        );
        assert!(means(&[(0.0, 1.0), (1.0, 1.0)], "displacement").is_empty());
        assert!(means(&[], "velocity").is_empty());
    }
}
