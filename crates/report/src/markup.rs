//! Text made safe for HTML and SVG, and pages made of it.
//!
//! ```
//! use simgap_report::markup::Html;
//! let mut html = Html::default();
//! html.element("p", &[("class", "note")], "a < b");
//! assert_eq!(html.finish(), "<p class=\"note\">a &lt; b</p>\n");
//! ```

/// `text` with the five special characters escaped and control characters (not legal in XML)
/// dropped, safe between tags and inside quoted attributes.
#[must_use]
pub fn escape(text: &str) -> String {
    let mut out = String::with_capacity(text.len());
    for c in text.chars() {
        match c {
            '&' => out.push_str("&amp;"),
            '<' => out.push_str("&lt;"),
            '>' => out.push_str("&gt;"),
            '"' => out.push_str("&quot;"),
            '\'' => out.push_str("&#39;"),
            '\n' | '\t' => out.push(c),
            c if c.is_control() => {}
            c => out.push(c),
        }
    }
    out
}

/// HTML under construction. Elements close themselves, text is escaped.
///
/// [`page_of`](crate::page::page_of) makes a whole page of it in the look of the report.
#[derive(Debug, Default)]
pub struct Html {
    out: String,
}

impl Html {
    /// An element with further content written by `inside`.
    pub fn within<R>(
        &mut self,
        tag: &str,
        attributes: &[(&str, &str)],
        inside: impl FnOnce(&mut Self) -> R,
    ) -> R {
        self.start(tag, attributes);
        let result = inside(self);
        self.out.push_str(&format!("</{tag}>\n"));
        result
    }

    /// An element that holds only text.
    pub fn element(&mut self, tag: &str, attributes: &[(&str, &str)], text: &str) {
        self.start(tag, attributes);
        self.text(text);
        self.out.push_str(&format!("</{tag}>\n"));
    }

    /// An element without content or end tag.
    pub fn void(&mut self, tag: &str, attributes: &[(&str, &str)]) {
        self.start(tag, attributes);
        self.out.push('\n');
    }

    /// Text.
    pub fn text(&mut self, text: &str) {
        self.out.push_str(&escape(text));
    }

    /// Markup that is safe already: a picture of [`crate::chart`], the style sheet.
    pub fn raw(&mut self, markup: &str) {
        self.out.push_str(markup);
    }

    /// What was written.
    #[must_use]
    pub fn finish(self) -> String {
        self.out
    }

    fn start(&mut self, tag: &str, attributes: &[(&str, &str)]) {
        self.out.push('<');
        self.out.push_str(tag);
        for (name, value) in attributes {
            self.out.push_str(&format!(" {name}=\"{}\"", escape(value)));
        }
        self.out.push('>');
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn verify_text_and_attributes_are_escaped() {
        let mut html = Html::default();
        html.within("p", &[("title", "\"><b>")], |html| {
            html.text("a<b & 'c'\u{7}")
        });
        assert_eq!(
            html.finish(),
            "<p title=\"&quot;&gt;&lt;b&gt;\">a&lt;b &amp; &#39;c&#39;</p>\n"
        );
    }
}
