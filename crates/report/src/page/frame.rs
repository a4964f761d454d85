//! A page in the look of the report, for other contents.

use super::style::style_sheet;
use super::tables;
use crate::markup::Html;

/// Nothing is fetched and nothing is run, whatever the page holds.
const POLICY: &str = "default-src 'none'; style-src 'unsafe-inline'";

/// A self-contained page without scripts, in the look of the report: light and dark, narrow and on paper.
///
/// `style` comes after the style sheet of the report.
///
/// ```
/// let page = simgap_report::page::page_of("Fleet", "", |html| html.element("h1", &[], "20 machines"));
/// assert!(page.starts_with("<!DOCTYPE html>") && page.contains("<h1>20 machines</h1>"));
/// ```
pub fn page_of(title: &str, style: &str, body: impl FnOnce(&mut Html)) -> String {
    let mut html = Html::default();
    html.raw("<!DOCTYPE html>\n");
    html.within("html", &[("lang", "en")], |html| {
        html.within("head", &[], |html| {
            html.void("meta", &[("charset", "utf-8")]);
            let policy = ("http-equiv", "Content-Security-Policy");
            html.void("meta", &[policy, ("content", POLICY)]);
            let viewport = "width=device-width,initial-scale=1";
            html.void("meta", &[("name", "viewport"), ("content", viewport)]);
            html.void(
                "meta",
                &[("name", "color-scheme"), ("content", "light dark")],
            );
            html.element("title", &[], title);
            html.within("style", &[], |html| {
                html.raw(&style_sheet());
                html.raw(style);
            });
        });
        html.within("body", &[], body);
    });
    html.finish()
}

/// A table in the look of the report: heads, the column from which cells are numbers, rows.
pub fn table_of(html: &mut Html, head: &[&str], numbers_from: usize, rows: Vec<Vec<String>>) {
    let rows: Vec<(bool, Vec<String>)> = rows.into_iter().map(|row| (false, row)).collect();
    tables::table(html, head, numbers_from, &rows);
}
