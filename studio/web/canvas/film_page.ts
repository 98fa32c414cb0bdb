/** A film of a net as one HTML file that plays by itself, without the studio and without a network. */

import type { Film } from "../model/run/film";

const escaped = (text: string) => text.replace(/[&<>"]/g, (one) => `&#${one.charCodeAt(0)};`);

/** svg: the drawing, as a first picture (`takePicture`). accent, soft: colours of active elements. */
export function filmPage(film: Film, svg: string, accent: string, soft: string): string {
  // "<" could end the script element.
  const data = JSON.stringify(film).replaceAll("<", "\\u003c");
  return `<!doctype html>
<html lang="en">
<head>
<meta charset="utf-8">
<meta name="viewport" content="width=device-width">
<title>${escaped(film.title)}</title>
<style>
${style.replaceAll("ACCENT", accent).replaceAll("SOFT", soft)}
</style>
</head>
<body>
<h1>${escaped(film.title)}</h1>
<figure>${svg}</figure>
<div class="controls">
<button id="back" aria-label="One firing back">◀|</button>
<button id="play">Play</button>
<button id="on" aria-label="One firing on">|▶</button>
<label>Speed <select id="speed"><option value="0.1">0.1 ×</option><option value="0.25">0.25 ×</option><option value="0.5">0.5 ×</option><option value="1" selected>1 ×</option><option value="2">2 ×</option><option value="5">5 ×</option><option value="20">20 ×</option></select></label>
<output id="time"></output>
</div>
<input id="position" type="range" min="0" step="any" aria-label="Position">
<p id="last" role="status"></p>
<script type="application/json" id="film">${data}</script>
<script>
${player}
</script>
</body>
</html>
`;
}

const style = `body { font: 15px/1.4 system-ui, sans-serif; margin: 16px; background: #fff; color: #1c2530; }
h1 { font-size: 18px; margin: 0 0 10px; }
figure { margin: 0; border: 1px solid #dde1e5; }
figure svg { display: block; width: 100%; height: auto; max-height: 78vh; }
figure svg svg { width: auto; max-height: none; }
.controls { display: flex; flex-wrap: wrap; gap: 10px; align-items: center; margin-top: 10px; }
button, select { font: inherit; min-width: 44px; padding: 4px 10px; }
#position { width: 100%; margin: 10px 0; }
#last { font-family: ui-monospace, monospace; margin: 0; min-height: 1.4em; }
.bar.fired > .shape { fill: ACCENT; }
.page.occupied > .shape { stroke: ACCENT; fill: SOFT; }
.page .token.inside { display: none; }
.page.folded.occupied > .token.inside { display: inline; }`;

// Plain JavaScript for any recent browser.
const player = `"use strict";
const film = JSON.parse(document.getElementById("film").textContent);
const byId = (id) => document.getElementById(id);
const groups = (attribute) => {
  const found = new Map();
  for (const group of document.querySelectorAll("[data-" + attribute + "]")) {
    const key = Number(group.getAttribute("data-" + attribute));
    found.set(key, [...(found.get(key) || []), group]);
  }
  return found;
};
const places = groups("place"), bars = groups("transition"), pages = groups("page"), running = groups("running");
const length = film.fired.length;
const secondsOf = (at) => (at === 0 ? 0 : film.times === null ? at : film.times[at - 1] / 1e9);
const end = film.times === null ? length : length === 0 ? 0 : film.times[length - 1] / 1e9;
let position = 0, tokens = new Map(film.start), counts = new Map(), time = 0, timer = 0, before = 0;

const move = (by) => {
  const transition = film.fired[by > 0 ? position : position - 1];
  for (const [place, change] of film.effects[transition] || []) tokens.set(place, (tokens.get(place) || 0) + by * change);
  counts.set(transition, (counts.get(transition) || 0) + by);
  position += by;
  return transition;
};
const draw = (fired) => {
  for (const [place, all] of places) {
    const count = tokens.get(place) || 0;
    for (const group of all) {
      group.style.display = count > 0 ? "inline" : "none";
      group.lastElementChild.textContent = count > 1 ? count : "";
    }
  }
  for (const [page, all] of pages) for (const group of all) group.classList.toggle("occupied", (tokens.get(-1 - page) || 0) > 0);
  for (const [transition, all] of bars)
    for (const group of all) {
      group.classList.toggle("fired", fired.has(transition));
      const count = counts.get(transition) || 0;
      group.lastElementChild.textContent = count > 0 ? "\\u00d7" + count : "";
      group.lastElementChild.removeAttribute("display");
    }
  const now = new Map();
  for (const [at, page, behaviour] of film.running) if (at <= position) now.set(page, behaviour);
  for (const [page, all] of running) for (const text of all) text.textContent = now.get(page) ? "\\u25b8 " + now.get(page) : "";
  byId("position").value = time;
  byId("time").textContent =
    film.times === null ? "step " + position + " of " + length : (film.begin + time).toFixed(3) + " s of " + (film.begin + end).toFixed(3) + " s";
  byId("last").textContent = position > 0 ? film.names[film.fired[position - 1]] : "";
};
/** To the state after \`wanted\` firings. */
const seek = (wanted) => {
  const fired = new Set();
  while (position > wanted) move(-1);
  while (position < wanted) fired.add(move(1));
  if (fired.size === 0 && position > 0) fired.add(film.fired[position - 1]);
  draw(fired);
};
const seekTime = (wanted) => {
  time = Math.min(end, Math.max(0, wanted));
  let low = 0, high = length;
  while (low < high) {
    const middle = (low + high) >> 1;
    if (secondsOf(middle + 1) <= time) low = middle + 1;
    else high = middle;
  }
  seek(low);
};
const play = (on) => {
  cancelAnimationFrame(timer);
  timer = 0;
  byId("play").textContent = on ? "Pause" : "Play";
  if (!on) return;
  if (time >= end) seekTime(0);
  before = performance.now();
  const tick = (now) => {
    // Steps without times: two a second.
    seekTime(time + ((now - before) / 1000) * Number(byId("speed").value) * (film.times === null ? 2 : 1));
    before = now;
    if (time >= end) play(false);
    else timer = requestAnimationFrame(tick);
  };
  timer = requestAnimationFrame(tick);
};
const step = (by) => {
  play(false);
  const wanted = Math.min(length, Math.max(0, position + by));
  time = secondsOf(wanted);
  seek(wanted);
};
byId("position").max = end;
byId("position").addEventListener("input", (event) => {
  play(false);
  seekTime(Number(event.target.value));
});
byId("play").addEventListener("click", () => play(timer === 0));
byId("back").addEventListener("click", () => step(-1));
byId("on").addEventListener("click", () => step(1));
document.addEventListener("keydown", (event) => {
  if (event.target instanceof HTMLSelectElement || event.target instanceof HTMLInputElement) return;
  if (event.key === "ArrowRight") step(1);
  else if (event.key === "ArrowLeft") step(-1);
  else if (event.key === " " && !(event.target instanceof HTMLButtonElement)) play(timer === 0);
  else return;
  event.preventDefault();
});
seek(0);`;
