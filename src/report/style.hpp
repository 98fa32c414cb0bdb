#pragma once

#include <string_view>

namespace tessera::report {

/// The page's style sheet: light and dark by the reader's choice, light on paper.
constexpr std::string_view style = R"css(
:root{color-scheme:light dark;--paper:#fbfbf9;--card:#fff;--ink:#1d2329;--soft:#5d6872;--rule:#e2e4e2;--accent:#215c9e;
--good:#1c7a4a;--bad:#b3261e;--lost:#e8a33d55;--b0:#3f77b5;--b1:#3a9d8f;--b2:#d99a2b;--b3:#a05a9c;--b4:#c4573f;--b5:#6b7f3a;--b6:#5a6fc0;--b7:#8a7560}
@media(prefers-color-scheme:dark){:root{--paper:#14181c;--card:#1c2126;--ink:#e7eaec;--soft:#9aa5ae;--rule:#30373d;
--accent:#79b0ea;--good:#5cc78d;--bad:#f28b82;--lost:#e8a33d44}}
*{box-sizing:border-box}
body{margin:0;background:var(--paper);color:var(--ink);font:15px/1.5 system-ui,-apple-system,"Segoe UI",Roboto,sans-serif}
main{max-width:1080px;margin:0 auto;padding:32px 24px 64px}
h1{font-size:28px;line-height:1.2;margin:0}h2{font-size:17px;margin:36px 0 10px}
.lead{color:var(--soft);margin:4px 0 24px}
.figures{display:grid;grid-template-columns:repeat(auto-fill,minmax(130px,1fr));gap:12px}
.figure,.panel{background:var(--card);border:1px solid var(--rule);border-radius:8px}
.figure{padding:12px 14px}.figure b{display:block;font-size:20px;font-weight:600;font-variant-numeric:tabular-nums}
.figure span{color:var(--soft);font-size:13px}
.panel{padding:14px;overflow-x:auto}.panel svg{display:block;width:100%;height:auto}
.floor svg{max-height:80vh;background:#fff;border-radius:4px}
.messages td:nth-child(1){width:1%;white-space:nowrap}.messages td:nth-child(2){width:24%}
.notice{border-left:4px solid #b07614;margin:0 0 16px}.notice.failed{border-left-color:var(--bad)}
.poster img{display:block;width:100%;height:auto;border-radius:4px}
.ground{max-height:620px;background:#fff;border-radius:4px}.ground polyline{stroke-width:2;stroke-linejoin:round;stroke-opacity:.85}
.ground .from{fill:#fff;stroke-width:2}.ground .now{stroke:#fff;stroke-width:.8}.ground .name{font-weight:600;paint-order:stroke;fill:revert-layer}
.ground .key{fill:#5d6872}.scale{stroke:#5d6872;stroke-width:2}
.legend{display:flex;flex-wrap:wrap;gap:4px 18px;margin:10px 0 0;font-size:13px}.panel .legend svg{display:inline-block;width:26px;height:6px;margin-right:6px;stroke-width:3}
.plots{display:grid;grid-template-columns:repeat(auto-fill,minmax(430px,1fr));gap:12px}.plot p{margin:0 0 4px}.plot .note{margin:0 0 4px}
.band{fill:var(--accent);fill-opacity:.25;stroke:var(--accent);stroke-width:1.2;stroke-linejoin:round}.truth{fill:var(--accent);fill-opacity:.35;stroke:var(--accent)}
.limit{stroke:var(--bad);stroke-dasharray:5 4}svg .limit-text,svg .failed-text{fill:var(--bad)}
.note{color:var(--soft);font-size:13px;margin:8px 0 0}
.ramp{display:inline-block;width:120px;height:9px;border-radius:5px;vertical-align:middle;margin:0 6px}
table{border-collapse:collapse;width:100%;font-variant-numeric:tabular-nums}
th,td{text-align:left;padding:6px 12px 6px 0;border-bottom:1px solid var(--rule);vertical-align:top}
tr:last-child td{border-bottom:0}th{color:var(--soft);font-weight:500;font-size:13px}
td.n,th.n{text-align:right}.mono{font-family:ui-monospace,Menlo,Consolas,monospace;font-size:13px;overflow-wrap:anywhere}
.good{color:var(--good)}.bad{color:var(--bad)}.warn{color:#b07614}.message{white-space:pre-wrap;overflow-wrap:anywhere}
svg text{font:12px system-ui,-apple-system,"Segoe UI",Roboto,sans-serif;fill:var(--ink)}
svg .tick,svg .key{fill:var(--soft)}svg .lane{font-weight:600;font-size:13px}
.grid{stroke:var(--rule)}.zero{stroke:var(--soft)}.curve{fill:none;stroke:var(--accent);stroke-width:1.3;stroke-linejoin:round}
.lost{fill:var(--lost)}.error{stroke:var(--bad);stroke-width:2}
.middle{fill:none;stroke:#777;stroke-width:.003;stroke-dasharray:.012 .012}
.path polyline{fill:none;stroke-width:.006;stroke-linecap:round;stroke-linejoin:round}
.start{fill:#fff;stroke:#1d2329;stroke-width:.005}
.robot rect{fill:#1d2329}.robot circle{fill:#295989;fill-opacity:.9}.robot path{stroke:#1d2329;stroke-width:.012}
.b0{fill:var(--b0)}.b1{fill:var(--b1)}.b2{fill:var(--b2)}.b3{fill:var(--b3)}.b4{fill:var(--b4)}.b5{fill:var(--b5)}.b6{fill:var(--b6)}.b7{fill:var(--b7)}
@media print{:root{color-scheme:light;--paper:#fff;--card:#fff;--ink:#000;--soft:#444;--rule:#ccc;--accent:#215c9e;--good:#1c7a4a;--bad:#b3261e}
main{max-width:none;padding:0}*{print-color-adjust:exact;-webkit-print-color-adjust:exact}.panel,.figure,tr{break-inside:avoid}h2{break-after:avoid}}
)css";

}  // namespace tessera::report
