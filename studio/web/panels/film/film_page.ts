/** A film of a net as one HTML file that plays by itself, without the studio and without a network. */

import type { Film } from "../../model/run/film";
import { player } from "./film_player";

const escaped = (text: string) => text.replace(/[&<>"]/g, (one) => `&#${one.charCodeAt(0)};`);

/** The colours of the studio when the film was saved; the drawing has them, too. */
export interface FilmColours {
  accent: string;
  /** The colour of pages in which a token is. */
  runs: string;
  background: string;
  surface: string;
  text: string;
  soft: string;
  line: string;
  isDark: boolean;
}

/** svg: the drawing, as a first picture (`takeFirstPicture`). */
export function filmPage(film: Film, svg: string, colours: FilmColours): string {
  // "<" could end the script element. The plots are a part of the page.
  const data = JSON.stringify({ ...film, plots: film.plots && { ...film.plots, svg: "" } }).replaceAll("<", "\\u003c");
  const world =
    film.world && `<figure class="world"><canvas id="world" role="img" aria-label="The simulated world"></canvas></figure>`;
  const plots = film.plots && `<figure class="plots" id="plots">${film.plots.svg}<div id="cursor"></div></figure>`;
  return `<!doctype html>
<html lang="en">
<head>
<meta charset="utf-8">
<meta name="viewport" content="width=device-width">
<title>${escaped(film.title)}</title>
<style>
${styleOf(colours)}
</style>
</head>
<body>
<main>
<h1>${escaped(film.title)}</h1>
<p id="turn"></p>
<p id="last"></p>
<div class="controls">
<button id="back" aria-label="One firing back" title="One firing back (←)">◀|</button>
<button id="play" title="Play or pause (space)">Play</button>
<button id="on" aria-label="One firing on" title="One firing on (→)">|▶</button>
<label>Speed <select id="speed"><option value="0.1">0.1 ×</option><option value="0.25">0.25 ×</option><option value="0.5">0.5 ×</option><option value="1" selected>1 ×</option><option value="2">2 ×</option><option value="5">5 ×</option><option value="20">20 ×</option></select></label>
<output id="time"></output>
</div>
<input id="position" type="range" min="0" step="any" aria-label="Position">
<div class="seen">
<figure class="net">${svg}</figure>
${world ?? ""}
${plots ?? ""}
</div>
<p class="keys">Space plays and pauses. ← and → go by one firing, ↑ and ↓ by one second, Home and End to the ends.</p>
</main>
<script type="application/json" id="film">${data}</script>
<script>
${player}
</script>
</body>
</html>
`;
}

const styleOf = ({
  accent,
  runs,
  background,
  surface,
  text,
  soft,
  line,
  isDark,
}: FilmColours) => `:root { color-scheme: ${isDark ? "dark" : "light"}; }
* { box-sizing: border-box; }
body { font: 15px/1.4 system-ui, sans-serif; margin: 0 auto; padding: 14px; max-width: 1700px; background: ${background}; color: ${text}; }
h1 { font-size: 18px; margin: 0 0 6px; overflow-wrap: anywhere; }
figure { margin: 0; border: 1px solid ${line}; border-radius: 6px; overflow: hidden; position: relative; background: ${surface}; min-width: 0; }
figure svg { display: block; width: 100%; height: auto; max-height: 74vh; }
figure svg svg { width: auto; max-height: none; }
.seen { display: grid; gap: 10px; grid-template-columns: 1fr; }
.seen:has(.world) { grid-template-columns: minmax(0, 3fr) minmax(0, 2fr); align-items: start; }
.plots { grid-column: 1 / -1; max-width: 1100px; }
@media (max-width: 800px) { .seen:has(.world) { grid-template-columns: 1fr; } }
#world { display: block; width: 100%; aspect-ratio: 3 / 2; }
${isDark ? ".plots svg { filter: invert(0.88) hue-rotate(180deg); }" : ""}
#cursor { position: absolute; top: 0; bottom: 0; width: 1.5px; background: ${accent}; }
.controls { display: flex; flex-wrap: wrap; gap: 8px; align-items: center; margin-top: 6px; }
button, select { font: inherit; color: inherit; min-width: 44px; padding: 4px 10px; background: ${surface}; border: 1px solid ${line}; border-radius: 6px; }
#position { width: 100%; margin: 10px 0; accent-color: ${accent}; }
#turn, #last { margin: 0; min-height: 1.4em; overflow-wrap: anywhere; }
#turn { font-weight: 600; }
#last { color: ${soft}; }
.keys { color: ${soft}; font-size: 13px; margin: 10px 0 0; }
.bar.fired > .shape { fill: ${accent}; }
.page.occupied > .shape { stroke: ${accent}; fill: ${runs}; }
.before-end :is(.lens-wait, .lens-stuck, .lens-awaited) { display: none; }
.page .token.inside { display: none; }
.page.folded.occupied > .token.inside { display: inline; }`;
