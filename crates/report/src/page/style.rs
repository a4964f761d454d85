//! The style sheet of the page.

use crate::chart::{NEUTRAL_COLOURS, ROLE_COLOURS};

const BASE: &str = "\
:root{--paper:#ffffff;--card:#f6f8fa;--ink:#1f2328;--soft:#57606a;--line:#d0d7de;--accent:#0072b2;--shade:#e9eef4;--grid:#e1e5ea}
*{box-sizing:border-box}
html{-webkit-text-size-adjust:100%}
body{margin:0;background:var(--paper);color:var(--ink);font:16px/1.5 system-ui,-apple-system,\"Segoe UI\",Roboto,\"Helvetica Neue\",Arial,sans-serif}
main,header{max-width:1160px;margin:0 auto;padding:0 24px}
main{padding-bottom:40px}
header{padding-top:28px}
.meta{color:var(--soft);font-size:14px;margin:0;max-width:none}
.meta b{color:var(--ink);font-weight:600}
h1{font-size:30px;line-height:1.25;margin:14px 0 8px;max-width:34em;text-wrap:balance}
h2{font-size:21px;margin:34px 0 10px;padding-top:14px;border-top:1px solid var(--line)}
h3{font-size:16px;margin:22px 0 6px}
p,ul,dl{margin:8px 0;max-width:76ch}
ul{padding-left:22px}
.lead{font-size:17px}
.soft,.note{color:var(--soft)}
.note{font-size:14px;margin:4px 0 0}
.sub{font-weight:600;color:var(--soft);margin:10px 0 0}
.sub+ul{margin-top:2px}
.tiles{display:grid;grid-template-columns:repeat(3,minmax(0,1fr));gap:12px;margin:16px 0}
.tile{background:var(--card);border:1px solid var(--line);border-radius:8px;padding:10px 14px}
.tile .name{color:var(--soft);font-size:13px;line-height:1.35}
.tile .figure{font-size:25px;font-weight:650;line-height:1.3;font-variant-numeric:tabular-nums;white-space:nowrap}
.pair{display:grid;grid-template-columns:repeat(auto-fit,minmax(min(100%,440px),1fr));gap:26px 36px;margin:12px 0;align-items:start}
.pair>*{min-width:0}
figure{margin:0;min-width:0}
figure.live.wide{grid-column:1/-1}
figure>svg{display:block;width:100%;max-width:640px;height:auto}
figure svg text{font-family:inherit}
figcaption{font-size:15px;font-weight:650;line-height:1.35;margin:0 0 6px;max-width:70ch}
figure.live>svg{display:none}
.plot{min-width:0}
.tools{display:flex;flex-wrap:wrap;gap:6px;margin:2px 0 4px}
.tools button{font:13px/1.2 inherit;font-family:inherit;color:var(--ink);background:var(--card);border:1px solid var(--line);border-radius:6px;padding:5px 10px;min-width:34px;cursor:pointer}
.tools button:hover{border-color:var(--accent)}
.u-legend{text-align:left!important;font-size:13px;margin:0!important}
.uplot .u-legend tbody{display:flex;flex-wrap:wrap}
.uplot .u-legend.u-inline .u-series{padding:0 6px 0 0}
.uplot .u-legend.u-inline.u-live th::after{content:none}
.uplot .u-legend .u-series:first-child{order:9}
.uplot .u-legend .u-series:first-child:has(.u-value:empty){visibility:hidden}
.uplot .u-legend .u-marker{width:1.3em!important;height:0!important;border-top-width:3px!important}
.u-legend .u-value{font-variant-numeric:tabular-nums}
.uplot .u-select{background:var(--accent);opacity:.18}
.u-cursor-x,.u-cursor-y{border-color:var(--soft)!important}
.scroll{overflow-x:auto;margin:10px 0}
table{border-collapse:collapse;font-size:15px}
.scroll table{min-width:min(100%,480px)}
.scroll th,.scroll td{text-align:left;padding:5px 18px 5px 0;border-bottom:1px solid var(--line);vertical-align:top}
.scroll th{color:var(--soft);font-weight:600;font-size:14px}
.scroll td.n,.scroll th.n{text-align:right;font-variant-numeric:tabular-nums;white-space:nowrap}
tr.named td{font-weight:650}
.box{background:var(--card);border:1px solid var(--line);border-left:4px solid var(--accent);border-radius:6px;padding:10px 16px;margin:12px 0;max-width:84ch}
.box p{margin:2px 0}
details{margin:12px 0}
summary{cursor:pointer;color:var(--accent);font-weight:600}
dt{font-weight:650;margin-top:10px}
dd{margin:0}
.facts{display:grid;grid-template-columns:max-content minmax(0,1fr);gap:4px 18px}
.facts dt{margin:0;color:var(--soft);font-weight:600}
code,pre{font:14px/1.45 ui-monospace,SFMono-Regular,Menlo,Consolas,monospace}
pre{background:var(--card);border:1px solid var(--line);border-radius:6px;padding:8px 12px;overflow-x:auto;white-space:pre-wrap;overflow-wrap:anywhere}
li,h1,h3,p,dd,.tile,figcaption,td{overflow-wrap:anywhere}
@media(max-width:720px){.uplot .u-legend .u-series:first-child:has(.u-value:empty){display:none}main,header{padding-left:15px;padding-right:15px}h1{font-size:24px}.tiles{gap:8px}.tile{padding:8px 10px}.tile .figure{font-size:20px}.scroll table,.scroll tbody,.scroll tr,.scroll td{display:block}.scroll thead{display:none}.scroll tr{border-bottom:1px solid var(--line);padding:6px 0}.scroll td,.scroll td.n{border:0;padding:1px 0;text-align:left;white-space:normal}.scroll td:first-child{font-weight:600}.scroll td[data-name]::before{content:attr(data-name) \": \";color:var(--soft);font-weight:400}}
@media print{body{font-size:10.5pt}h2,h3,figcaption{break-after:avoid}figure,.tile,.box,tr,.facts{break-inside:avoid}main,header{max-width:none;padding-left:0;padding-right:0}.tile,.box,pre{background:none}.plot,.tools,summary{display:none!important}figure.live>svg{display:block}figure.live.wide{grid-column:auto}.pair{grid-template-columns:1fr 1fr;gap:16px 20px}.pair.stack{grid-template-columns:1fr}.stack figure{max-width:480px}h3+p{break-after:avoid}.tiles{max-width:600px}p,li{orphans:3;widows:3}a{color:inherit}}
";

const DARK: &str = "\
:root{--paper:#0f1419;--card:#171d24;--ink:#e6edf3;--soft:#a3abb5;--line:#30373f;--accent:#5cb8f2;--shade:#242b33;--grid:#2c333b;color-scheme:dark}
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
