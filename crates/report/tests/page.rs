//! The page of each kind of verdict: what it says, that it is well formed, safe and the same
//! every time.
#![allow(clippy::unwrap_used)]

use crate::common;

use simgap_diagnose::{ChannelSeries, CheckSeries, Diagnosis, Status};
use simgap_model::Location;
use simgap_report::page::{ReportContext, report_html};

fn page(diagnosis: &Diagnosis) -> String {
    report_html(
        diagnosis,
        &common::series_of(diagnosis.verdict.status),
        &common::context(),
    )
    .unwrap()
}

/// The page without what its scripts hold, which is no markup.
fn without_scripts(page: &str) -> String {
    let mut out = String::new();
    for (i, part) in page.split("<script").enumerate() {
        let after = match (i, part.split_once('>')) {
            (0, _) => Some(part),
            (_, Some((_, inside))) => inside.split_once("</script>").map(|(_, after)| after),
            _ => None,
        };
        out.push_str(after.unwrap_or("<script left open>"));
    }
    out
}

/// Walks the tags of a page: each end tag closes the last open one, attributes are quoted, text
/// holds no stray bracket. Returns the first fault.
fn fault(page: &str) -> Option<String> {
    const NO_END: [&str; 3] = ["!DOCTYPE", "meta", "br"];
    let page = without_scripts(page);
    let mut open: Vec<&str> = Vec::new();
    let mut rest = &*page;
    while let Some((text, after)) = rest.split_once('<') {
        if text.contains('>') && open.last() != Some(&"style") {
            return Some(format!("stray > in {text:?}"));
        }
        let (tag, after) = after.split_once('>')?;
        rest = after;
        if let Some(name) = tag.strip_prefix('/') {
            if open.pop() != Some(name) {
                return Some(format!("</{name}> closes nothing"));
            }
            continue;
        }
        if tag.matches('"').count() % 2 == 1 {
            return Some(format!("open quote in <{tag}>"));
        }
        let name = tag.split([' ', '/']).next()?;
        if !name.chars().all(|c| c.is_ascii_alphanumeric() || c == '!') {
            return Some(format!("strange tag <{tag}>"));
        }
        if !NO_END.contains(&name) && !tag.ends_with('/') {
            open.push(name);
        }
    }
    (!open.is_empty()).then(|| format!("{open:?} left open"))
}

/// The page without style sheet, scripts and pictures, which stand as their titles.
fn skeleton(page: &str) -> String {
    let page = without_scripts(page);
    let (head, body) = page.split_once("<style>").unwrap();
    let (_, body) = body.split_once("</style>").unwrap();
    let mut out = head.to_owned();
    let mut parts = body.split("<svg");
    out.push_str(parts.next().unwrap());
    for part in parts {
        let (svg, after) = part.split_once("</svg>").unwrap();
        let title = svg
            .split("<title>")
            .nth(1)
            .unwrap()
            .split("</title>")
            .next()
            .unwrap();
        out.push_str(&format!("[picture: {title}]"));
        out.push_str(after);
    }
    out
}

#[test]
fn regress_page_of_an_effect() {
    insta::assert_snapshot!(skeleton(&page(&common::effect())));
}

#[test]
fn regress_page_of_two_effects() {
    insta::assert_snapshot!(skeleton(&page(&common::two_effects())));
}

#[test]
fn regress_page_of_parameters() {
    insta::assert_snapshot!(skeleton(&page(&common::parameters())));
}

#[test]
fn regress_page_of_unknown() {
    insta::assert_snapshot!(skeleton(&page(&common::unknown())));
}

#[test]
fn regress_page_of_none() {
    insta::assert_snapshot!(skeleton(&page(&common::none())));
}

#[test]
fn verify_pages_are_well_formed_and_self_contained() {
    for diagnosis in [
        common::effect(),
        common::two_effects(),
        common::parameters(),
        common::unknown(),
        common::none(),
        common::bare(Status::Effect),
        common::bare(Status::Parameters),
        common::bare(Status::Unknown),
        common::bare(Status::None),
    ] {
        let page = page(&diagnosis);
        assert_eq!(fault(&page), None);
        let page = without_scripts(&page);
        assert!(!page.contains(" src=") && !page.contains("url(") && !page.contains(" href="));
        let links = page
            .replace("http://www.w3.org/2000/svg", "")
            .replace("http-equiv", "");
        assert!(!links.contains("http") && !links.contains("NaN"));
    }
}

#[test]
fn verify_the_check_of_form_sees_faults() {
    assert_eq!(fault("<p><b>x</b></p>"), None);
    for bad in [
        "<p><b>x</p></b>",
        "<p>",
        "</p>",
        "<p>a > b</p>",
        "<p a=\"x>y</p>",
        "<<p></p>",
    ] {
        assert!(fault(bad).is_some(), "{bad}");
    }
}

#[test]
fn verify_names_from_files_cannot_become_markup() {
    let evil = "</title></style><script>alert(\"x\")</script>&'\u{1}";
    let mut d = common::two_effects();
    d.model = evil.into();
    d.notes = vec![evil.into()];
    d.next_experiment = Some(evil.into());
    d.verdict.description = vec![evil.into()];
    for e in &mut d.verdict.effects {
        e.kind = evil.into();
        e.at = Location::Between([evil.into(), evil.into()]);
        e.evidence = vec![evil.into()];
        e.parameters[0].name = evil.into();
        for r in &mut e.indistinguishable {
            r.because = evil.into();
        }
    }
    for c in &mut d.gap.channels {
        c.channel = evil.into();
    }
    for b in &mut d.r#where.bands {
        b.label = evil.into();
    }
    for s in &mut d.r#where.states {
        s.label = evil.into();
    }
    let mut series = common::series();
    series[0].record = evil.into();
    series[0].channels[0].channel = evil.into();
    let context = ReportContext {
        program_version: evil.into(),
        model_file: evil.into(),
        train_records: vec![evil.into()],
        check_records: vec![evil.into()],
        command_line: evil.into(),
        seed: 0,
    };
    let scripts = page(&common::two_effects()).matches("<script").count();
    let page = report_html(&d, &series, &context).unwrap();
    assert_eq!(page.matches("<script").count(), scripts);
    assert_eq!(page.matches("</script").count(), scripts);
    assert!(!page.contains("<script>alert") && !page.contains('\u{1}'));
    assert_eq!(fault(&page), None);
    assert_eq!(page.matches("</style>").count(), 1);
}

#[test]
fn verify_the_same_input_gives_the_same_bytes() {
    assert_eq!(page(&common::effect()), page(&common::effect()));
}

#[test]
fn verify_pages_without_records_or_values() {
    for status in [
        Status::None,
        Status::Parameters,
        Status::Effect,
        Status::Unknown,
    ] {
        let d = common::bare(status);
        let page = report_html(&d, &[], &ReportContext::default()).unwrap();
        assert_eq!(fault(&page), None);
        assert!(page.contains("There is no check record to show."));
    }
    let channel = |values: Vec<f64>| ChannelSeries {
        channel: "y".into(),
        unit: "m",
        measured: values.clone(),
        nominal: values.clone(),
        corrected: values,
    };
    for (time_s, values) in [
        (vec![], vec![]),
        (vec![0.0], vec![1.0]),
        (vec![f64::NAN; 500], vec![f64::NAN; 500]),
        (vec![1.0; 500], vec![2.0; 500]),
        ((0..500).map(f64::from).collect(), vec![f64::INFINITY; 500]),
        (
            (0..500).rev().map(f64::from).collect(),
            (0..500).map(f64::from).collect(),
        ),
    ] {
        let series = CheckSeries {
            record: "r".into(),
            time_s,
            channels: vec![channel(values)],
        };
        let page = report_html(&common::effect(), &[series], &common::context()).unwrap();
        assert_eq!(fault(&page), None);
    }
}

#[test]
fn verify_lists_of_unequal_length_are_named() {
    let mut series = common::series();
    series[0].channels[1].nominal.pop();
    let error = report_html(&common::effect(), &series, &common::context()).unwrap_err();
    assert_eq!(
        error.to_string(),
        "channel `F_cylinder` of check record `production.csv` has 11999 nominal values for 12000 times, equally many are needed"
    );
}

#[test]
fn verify_numbers_that_are_not_finite_show_as_dashes() {
    let mut d = common::effect();
    d.gap.nominal = f64::NAN;
    d.gap.closed = f64::NEG_INFINITY;
    d.candidates[0].held_back_gap = f64::INFINITY;
    d.verdict.effects[0].parameters[0].value = f64::NAN;
    d.r#where.locations[0].share = f64::NAN;
    let page = page(&d);
    assert!(!page.contains("NaN") && !page.contains("inf<") && page.contains('–'));
}

#[test]
fn verify_a_page_of_a_million_samples_stays_small() {
    let n = 1_000_000;
    let time_s: Vec<f64> = (0..n).map(|i| i as f64 * 1e-3).collect();
    let measured = common::noise(n, 1e-3, 7);
    let series = CheckSeries {
        record: "long.csv".into(),
        channels: vec![ChannelSeries {
            channel: "y".into(),
            unit: "m",
            nominal: measured.iter().map(|v| 0.9 * v).collect(),
            corrected: measured.iter().map(|v| 0.99 * v).collect(),
            measured,
        }],
        time_s,
    };
    let context = common::context();
    let page = report_html(&common::effect(), &[series], &context).unwrap();
    // The library and its driver take 65 kB, the record 130 kB at the most; its size must not grow
    // with the number of samples.
    assert!(page.len() < 350_000, "{}", page.len());
}
