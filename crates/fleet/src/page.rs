//! The report of a fleet: one page.

use std::collections::{BTreeMap, BTreeSet};

use simgap_report::chart::ChartError;
use simgap_report::markup::Html;
use simgap_report::page::{page_of, table_of};
use simgap_signal::median;

use crate::charts::{Drawn, charts};
use crate::findings::{Finding, Told};
use crate::observe::{Cause, Observation};
use crate::prior::FleetModel;
use crate::scope::Scope;
use crate::words::number;

/// Rows and columns of the heat map, and rows of the list of failures.
const MOST_ROWS: usize = 400;
const MOST_CAUSES: usize = 24;
const MOST_FAILURES: usize = 100;
/// What the heat map and the list need beyond the style of the report.
const STYLE: &str = "\
table.heat{font-size:13px}
.scroll table.heat th,.scroll table.heat td{padding:3px 8px;text-align:center;vertical-align:bottom}
.scroll table.heat th:first-child{text-align:left;white-space:nowrap}
table.heat td{font-variant-numeric:tabular-nums;border:1px solid var(--paper)}
.found li{margin:8px 0}
@media(max-width:720px){.scroll table.heat{display:table}.scroll table.heat thead{display:table-header-group}.scroll table.heat tbody{display:table-row-group}.scroll table.heat tr{display:table-row}.scroll table.heat td{display:table-cell;text-align:center}}
";

/// What the page tells.
pub(crate) struct PageInput<'a> {
    /// Name of the fleet.
    pub name: &'a str,
    /// What the plan says that no record answers to.
    pub notes: &'a [String],
    /// All diagnoses.
    pub observations: &'a [Observation],
    /// Units of the plan, answered or not.
    pub units: usize,
    /// What they say.
    pub told: &'a Told,
    /// What they say of the next machine.
    pub models: &'a [FleetModel],
}

/// The page.
///
/// # Errors
/// [`ChartError`] when a picture cannot be drawn.
pub(crate) fn page(input: &PageInput<'_>) -> Result<String, ChartError> {
    let pictures = charts(input.told, input.observations)?;
    let title = format!("{}: simgap fleet", input.name);
    Ok(page_of(&title, STYLE, |html| {
        html.within("header", &[], |html| head(html, input));
        html.within("main", &[], |html| {
            found(html, input.told);
            heat(html, input);
            drawn(html, &pictures);
            machines(html, input);
            next(html, input.models);
            failed(html, input.observations);
            guide(html);
        });
    }))
}

fn head(html: &mut Html, input: &PageInput<'_>) {
    let all = input.observations;
    let of =
        |level: fn(&Observation) -> &str| -> BTreeSet<&str> { all.iter().map(level).collect() };
    let (machines, dates) = (of(|o| &o.machine), of(|o| &o.date));
    let failed = all.iter().filter(|o| o.failed.is_some()).count();
    html.within("p", &[("class", "meta")], |html| {
        html.text("simgap report of the fleet ");
        html.element("b", &[], input.name);
        let (first, last) = (dates.first().copied(), dates.last().copied());
        html.text(&format!(
            " · {} to {}",
            first.unwrap_or_default(),
            last.unwrap_or_default()
        ));
    });
    for note in input.notes {
        html.element("p", &[("class", "meta")], &format!("Note: {note}."));
    }
    let count =
        |count: usize, of: &str| format!("{count} {of}{}", if count == 1 { "" } else { "s" });
    let machine_count = count(machines.len(), "machine");
    let finding_count = count(input.told.findings.len(), "finding");
    html.element("h1", &[], &format!("{machine_count}: {finding_count}"));
    // The figure of a tile is not broken: on a phone it has room for five digits.
    let tiles = [
        ("Machines".to_owned(), machines.len()),
        ("Dates".to_owned(), dates.len()),
        (format!("Diagnoses, of {}", input.units), all.len() - failed),
    ];
    html.within("div", &[("class", "tiles")], |html| {
        for (name, figure) in tiles {
            html.within("div", &[("class", "tile")], |html| {
                html.element("div", &[("class", "name")], &name);
                html.element("div", &[("class", "figure")], &figure.to_string());
            });
        }
    });
}

fn found(html: &mut Html, told: &Told) {
    html.element("h2", &[], "What the fleet says");
    if told.findings.is_empty() {
        html.element(
            "p",
            &[],
            "Nothing differs between machines, days or conditions by more than chance.",
        );
    }
    let sections = [
        (Scope::Common, "Common to all: the model is wrong"),
        (Scope::Machine, "One machine's own"),
        (
            Scope::Condition,
            "Days and conditions: no machine is to blame",
        ),
        (Scope::Undecided, "Cannot be told apart: nobody is to blame"),
    ];
    for (scope, title) in sections {
        let own: Vec<&Finding> = told.findings.iter().filter(|f| f.scope == scope).collect();
        if own.is_empty() {
            continue;
        }
        html.element("h3", &[], title);
        html.within("ul", &[("class", "found")], |html| {
            for finding in own {
                html.element("li", &[], &finding.text);
            }
        });
    }
    if !told.scattered.is_empty() {
        let all = told.scattered.iter();
        let all: Vec<String> = all
            .map(|(cause, [n, k])| format!("{cause} in {k} of {n} diagnoses"))
            .collect();
        let text = format!(
            "Named here and there, and nothing tells where: {}.",
            all.join("; ")
        );
        html.element("p", &[("class", "note")], &text);
    }
}

/// The causes by how often they are named.
fn causes(observations: &[Observation]) -> Vec<&Cause> {
    let mut counts: BTreeMap<&Cause, usize> = BTreeMap::new();
    for cause in observations.iter().flat_map(|o| o.named.keys()) {
        *counts.entry(cause).or_default() += 1;
    }
    let mut all: Vec<(&Cause, usize)> = counts.into_iter().collect();
    all.sort_by(|a, b| b.1.cmp(&a.1).then(a.0.cmp(b.0)));
    all.into_iter()
        .map(|(cause, _)| cause)
        .take(MOST_CAUSES)
        .collect()
}

fn by_machine(observations: &[Observation]) -> BTreeMap<&str, Vec<&Observation>> {
    let mut machines: BTreeMap<&str, Vec<&Observation>> = BTreeMap::new();
    for observation in observations {
        machines
            .entry(&observation.machine)
            .or_default()
            .push(observation);
    }
    machines
}

/// Machines by causes, as a table whose cells are the deeper the more often a cause is named.
fn heat(html: &mut Html, input: &PageInput<'_>) {
    let causes = causes(input.observations);
    if causes.is_empty() {
        return;
    }
    html.element("h2", &[], "Machines and causes");
    let text =
        "How many percent of the diagnoses of a machine name a cause; nothing where none does.";
    html.element("p", &[], text);
    let machines = by_machine(input.observations);
    html.within("div", &[("class", "scroll")], |html| {
        html.within("table", &[("class", "heat")], |html| {
            html.within("thead", &[], |html| {
                html.within("tr", &[], |html| {
                    html.element("th", &[], "Machine");
                    for cause in &causes {
                        html.within("th", &[], |html| {
                            html.text(&cause.kind.replace('_', " "));
                            html.void("br", &[]);
                            html.text(&cause.place);
                        });
                    }
                });
            });
            html.within("tbody", &[], |html| {
                for (machine, own) in machines.iter().take(MOST_ROWS) {
                    html.within("tr", &[], |html| {
                        html.element("th", &[], machine);
                        for cause in &causes {
                            cell(html, own, cause);
                        }
                    });
                }
            });
        });
    });
    if machines.len() > MOST_ROWS {
        let text = format!(
            "The first {MOST_ROWS} of {} machines; the table holds all.",
            machines.len()
        );
        html.element("p", &[("class", "note")], &text);
    }
}

fn cell(html: &mut Html, own: &[&Observation], cause: &Cause) {
    let sound: Vec<_> = own.iter().filter(|o| o.failed.is_none()).collect();
    let named = sound.iter().filter(|o| o.named.contains_key(cause)).count();
    if named == 0 {
        html.element("td", &[], "");
        return;
    }
    let percent = (100.0 * named as f64 / sound.len() as f64).round();
    // Up to three quarters of the colour, so that the number stays legible.
    let depth = 8.0 + 0.62 * percent;
    let style = format!("background:color-mix(in srgb,var(--accent) {depth:.0}%,transparent)");
    let title = format!("{named} of {}", sound.len());
    html.element(
        "td",
        &[("style", &style), ("title", &title)],
        &format!("{percent}"),
    );
}

fn drawn(html: &mut Html, pictures: &[Drawn]) {
    if pictures.is_empty() {
        return;
    }
    html.element("h2", &[], "Values over time");
    let text = "Points are estimates, with 95 % intervals for machines in colour. Of effects only what is named has a value; \
                factors of the model's own parameters are what the data say without the stated uncertainty.";
    html.element("p", &[], text);
    html.within("div", &[("class", "pair")], |html| {
        for picture in pictures {
            html.within("figure", &[], |html| {
                html.element("figcaption", &[], &picture.caption);
                html.raw(&picture.svg);
            });
        }
    });
}

fn machines(html: &mut Html, input: &PageInput<'_>) {
    html.element("h2", &[], "The machines");
    let share = |count: usize, all: usize| format!("{count} of {all}");
    let rows = by_machine(input.observations)
        .into_iter()
        .take(MOST_ROWS)
        .map(|(machine, own)| {
            let sound: Vec<&&Observation> = own.iter().filter(|o| o.failed.is_none()).collect();
            let with = |status: &str| sound.iter().filter(|o| o.status == status).count();
            let gap = |index: usize| {
                let mut gaps: Vec<f64> = sound
                    .iter()
                    .filter_map(|o| o.gap.map(|gap| gap[index]))
                    .collect();
                if gaps.is_empty() {
                    "–".to_owned()
                } else {
                    number(median(&mut gaps))
                }
            };
            let complete = sound.iter().filter(|o| o.complete).count();
            vec![
                machine.to_owned(),
                share(sound.len(), own.len()),
                with("none").to_string(),
                with("parameters").to_string(),
                with("effect").to_string(),
                with("unknown").to_string(),
                share(complete, sound.len()),
                gap(0),
                gap(1),
            ]
        });
    let head = [
        "Machine",
        "Diagnosed",
        "none",
        "parameters",
        "effect",
        "unknown",
        "Complete",
        "Gap as given (median)",
        "Gap corrected (median)",
    ];
    table_of(html, &head, 1, rows.collect());
}

fn next(html: &mut Html, models: &[FleetModel]) {
    if models.is_empty() {
        return;
    }
    html.element("h2", &[], "The next machine");
    let text = "How the model's own parameters are distributed over the fleet, as factors of the model file. The files in \
                models/ hold these means and, as uncertainty, how far the next machine may be from them.";
    html.element("p", &[], text);
    for model in models {
        let file = simgap_app::text::file_name(std::path::Path::new(&model.file));
        html.element("h3", &[], &file);
        let rows = model.values.iter().map(|value| {
            vec![
                format!("{} {}", value.kind, value.place),
                value.machines.to_string(),
                number(value.mean),
                format!("{} %", number(100.0 * value.between)),
                format!("{} %", number(100.0 * value.uncertainty)),
                value.left_out.join(", "),
            ]
        });
        let head = [
            "Parameter",
            "Machines",
            "Mean factor",
            "Scatter between them",
            "Uncertainty",
            "Left out",
        ];
        table_of(html, &head, 1, rows.collect());
    }
}

fn failed(html: &mut Html, observations: &[Observation]) {
    let failed: Vec<&Observation> = observations.iter().filter(|o| o.failed.is_some()).collect();
    if failed.is_empty() {
        return;
    }
    html.element("h2", &[], "Diagnoses that failed");
    let rows = failed.iter().take(MOST_FAILURES).map(|one| {
        let reason = one.failed.clone().unwrap_or_default();
        vec![one.machine.clone(), one.date.clone(), reason]
    });
    table_of(html, &["Machine", "Date", "Reason"], 9, rows.collect());
    if failed.len() > MOST_FAILURES {
        let text = format!(
            "The first {MOST_FAILURES} of {}; the table holds all.",
            failed.len()
        );
        html.element("p", &[("class", "note")], &text);
    }
}

fn guide(html: &mut Html) {
    html.within("details", &[], |html| {
        html.element("summary", &[], "How to read this page");
        let text = [
            "Each machine and date is one diagnosis. A cause is told of a machine, a day or a condition where it is named in \
             most of the diagnoses there and in few elsewhere: the odds against chance are above 400 to 1.",
            "Where two of them divide the diagnoses alike (a machine that was measured on days of its own, on a rig of its \
             own), the data cannot tell which it is. The page says so and blames nobody; records of that machine on another \
             day, or of another machine on that rig, would tell.",
            "A value goes along a line or in steps where that describes its estimates better than a constant, by odds of 20 to \
             1 and as many more as there are series. A machine lies apart by four standard deviations of the fleet, \
             or more where the fleet is small.",
        ];
        for text in text {
            html.element("p", &[], text);
        }
    });
}
