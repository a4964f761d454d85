//! The style sheet of the page.

use crate::chart::{NEUTRAL_COLOURS, ROLE_COLOURS};

const BASE: &str = "\
:root{--paper:#ffffff;--card:#f6f8fa;--ink:#1f2328;--soft:#57606a;--line:#d0d7de;--accent:#0072b2}
*{box-sizing:border-box}
html{-webkit-text-size-adjust:100%}
body{margin:0;background:var(--paper);color:var(--ink);font:16px/1.5 system-ui,-apple-system,\"Segoe UI\",Roboto,\"Helvetica Neue\",Arial,sans-serif}
main,header,footer{max-width:1160px;margin:0 auto;padding:0 24px}
header{padding-top:28px}
.meta{color:var(--soft);font-size:14px;margin:0;max-width:none}
.meta b{color:var(--ink);font-weight:600}
h1{font-size:30px;line-height:1.25;margin:14px 0 8px;max-width:34em;text-wrap:balance}
h2{font-size:20px;margin:30px 0 10px;padding-top:14px;border-top:1px solid var(--line)}
h3{font-size:16px;margin:22px 0 6px}
p,ul,dl{margin:8px 0;max-width:76ch}
ul{padding-left:22px}
.lead{font-size:17px;max-width:96ch}
.soft{color:var(--soft)}
.tiles{display:grid;grid-template-columns:2fr 1fr 1fr;gap:14px;margin:20px 0 8px}
.tile{background:var(--card);border:1px solid var(--line);border-radius:8px;padding:12px 16px}
.tile .name{color:var(--soft);font-size:14px}
.tile .figure{font-size:27px;font-weight:650;line-height:1.3;font-variant-numeric:tabular-nums}
.tile .note{color:var(--soft);font-size:13px}
.steps{display:flex;flex-wrap:wrap;align-items:baseline;gap:2px 12px}
.steps small{display:block;font-size:13px;font-weight:400;color:var(--soft)}
.steps .arrow{color:var(--soft);font-weight:400}
.pair{display:grid;grid-template-columns:repeat(auto-fit,minmax(min(100%,440px),1fr));gap:14px 20px;margin:12px 0}
figure{margin:0;min-width:0}
figure svg{display:block;width:100%;max-width:760px;height:auto}
figure svg text{font-family:inherit}
figcaption{color:var(--soft);font-size:14px;max-width:70ch}
.scroll{overflow-x:auto;margin:10px 0}
table{border-collapse:collapse;font-size:15px;min-width:min(100%,480px)}
th,td{text-align:left;padding:5px 18px 5px 0;border-bottom:1px solid var(--line);vertical-align:top}
th{color:var(--soft);font-weight:600;font-size:14px}
td.n,th.n{text-align:right;font-variant-numeric:tabular-nums;white-space:nowrap}
tr.named td{font-weight:650}
.box{background:var(--card);border:1px solid var(--line);border-left:4px solid var(--accent);border-radius:6px;padding:10px 16px;margin:12px 0;max-width:84ch}
.box p{margin:2px 0}
details{margin:12px 0}
summary{cursor:pointer;color:var(--accent);font-weight:600}
dt{font-weight:650;margin-top:10px}
dd{margin:0 0 0 0}
code,pre{font:14px/1.45 ui-monospace,SFMono-Regular,Menlo,Consolas,monospace}
pre{background:var(--card);border:1px solid var(--line);border-radius:6px;padding:8px 12px;overflow-x:auto;white-space:pre-wrap;overflow-wrap:anywhere}
footer{color:var(--soft);font-size:14px;padding-bottom:40px;margin-top:40px}
li,h1,p,dd,.tile{overflow-wrap:anywhere}
@media(max-width:720px){main,header,footer{padding-left:15px;padding-right:15px}h1{font-size:24px}.tiles{grid-template-columns:1fr 1fr}.tile:first-child{grid-column:1/-1}.tile .figure{font-size:23px}}
@media print{body{font-size:11pt}h2{break-after:avoid}figure,.tile,.box,tr{break-inside:avoid}main,header,footer{max-width:none;padding-left:0;padding-right:0}.tile,.box{background:none}}
";

const DARK: &str = "\
:root{--paper:#0f1419;--card:#171d24;--ink:#e6edf3;--soft:#a3abb5;--line:#30373f;--accent:#5cb8f2;color-scheme:dark}
";

/// The style sheet. On dark screens the colours written in the pictures are replaced by their
/// counterparts; paper stays white.
pub(crate) fn style_sheet() -> String {
    let mut css = String::from(BASE);
    css.push_str("@media screen and (prefers-color-scheme:dark){");
    css.push_str(DARK);
    for c in ROLE_COLOURS.iter().chain(&NEUTRAL_COLOURS) {
        css.push_str(&format!(
            "figure svg [stroke=\"{0}\"]{{stroke:{1}}}figure svg [fill=\"{0}\"]{{fill:{1}}}\n",
            c.light, c.dark
        ));
    }
    css.push_str("}\n");
    css
}
