//! The scripts of the page: a plotting library and what drives it.

use crate::markup::Html;

/// uPlot 1.6.32, MIT; `assets/uplot/README.md` tells where it is from.
const LIBRARY: &str = include_str!("../../assets/uplot/uPlot.iife.min.js");
const LIBRARY_STYLE: &str = include_str!("../../assets/uplot/uPlot.min.css");
const LICENCE: &str = include_str!("../../assets/uplot/LICENSE");
const PAGE: &str = include_str!("../../assets/page/page.js");

/// Nothing is fetched from anywhere, whatever the page holds.
pub(super) const POLICY: &str =
    "default-src 'none'; style-src 'unsafe-inline'; script-src 'unsafe-inline'";

/// Style of the library, to stand before that of the page.
pub(super) fn style() -> &'static str {
    LIBRARY_STYLE
}

/// The library with its licence, and the script of the page.
pub(super) fn write(html: &mut Html) {
    html.raw("<script>\n/*\nuPlot 1.6.32\n");
    html.raw(LICENCE);
    html.raw("\n*/\n");
    html.raw(LIBRARY);
    html.raw("\n</script>\n<script>\n");
    html.raw(PAGE);
    html.raw("</script>\n");
}
