/** The program of a film: plain JavaScript for any recent browser. */
export const player = `"use strict";
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
const end = film.times === null ? length : film.length !== null ? film.length : length === 0 ? 0 : film.times[length - 1] / 1e9;
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
  byId("last").textContent = position > 0 ? film.sentences[film.told[position - 1]] : "";
  byId("last").title = position > 0 ? film.names[film.fired[position - 1]] : "";
  // Firings follow each other too fast to be read; the last change of a behaviour stays.
  const turn = turnBefore(position);
  byId("turn").textContent = turn > 0 ? film.sentences[film.told[turn - 1]] + (film.times === null ? "" : " (" + (film.begin + secondsOf(turn)).toFixed(2) + " s)") : "";
  // The subsystems that wait for each other do so at the end of the steps.
  document.body.classList.toggle("before-end", film.times === null && position < length);
  drawWorld();
  const cursor = byId("cursor");
  if (cursor && end > 0) cursor.style.left = 100 * (film.plots.left + (film.plots.right - film.plots.left) * (time / end)) + "%";
};
const turnBefore = (position) => {
  let low = 0, high = film.turns.length;
  while (low < high) {
    const middle = (low + high) >> 1;
    if (film.turns[middle] <= position) low = middle + 1;
    else high = middle;
  }
  return low > 0 ? film.turns[low - 1] : 0;
};
/** The last of the times that is not after this moment. */
const shownAt = (times) => {
  let low = 0, high = times.length;
  while (low < high) {
    const middle = (low + high) >> 1;
    if (times[middle] <= time + 1e-9) low = middle + 1;
    else high = middle;
  }
  return Math.max(0, low - 1);
};
const canvas = byId("world");
const pictures = film.world && film.world.kind === "pictures" ? film.world.pictures.map((address) => Object.assign(new Image(), { src: address })) : [];
const floor = film.world && film.world.floor ? Object.assign(new Image(), { src: film.world.floor.picture }) : null;
for (const image of [...pictures, ...(floor ? [floor] : [])]) image.addEventListener("load", () => drawWorld());
const style = getComputedStyle(document.body);
let worldDrawn = "";
const drawWorld = () => {
  if (!canvas) return;
  const { world } = film;
  const at = shownAt(world.times);
  const image = pictures[at];
  const state = [at, canvas.clientWidth, devicePixelRatio, (image || floor || {}).complete].join();
  if (state === worldDrawn) return;
  worldDrawn = state;
  const width = (canvas.width = Math.round(canvas.clientWidth * devicePixelRatio));
  const height = (canvas.height = Math.round(canvas.clientHeight * devicePixelRatio));
  const context = canvas.getContext("2d");
  if (world.kind === "pictures") {
    if (image && image.complete && image.naturalWidth > 0) context.drawImage(image, 0, 0, width, height);
    return;
  }
  const { poses } = world;
  let [left, right, bottom, top] = floor ? [0, world.floor.width, 0, world.floor.height] : [Infinity, -Infinity, Infinity, -Infinity];
  for (let one = 0; one < poses.length; one += 3) {
    [left, right] = [Math.min(left, poses[one]), Math.max(right, poses[one])];
    [bottom, top] = [Math.min(bottom, poses[one + 1]), Math.max(top, poses[one + 1])];
  }
  [left, right, bottom, top] = [left - 0.25, right + 0.25, bottom - 0.25, top + 0.25];
  const scale = Math.min(width / (right - left), height / (top - bottom));
  const x = (metres) => width / 2 + (metres - (left + right) / 2) * scale;
  const y = (metres) => height / 2 - (metres - (bottom + top) / 2) * scale;
  if (floor && floor.complete) {
    context.globalAlpha = 0.45;
    context.drawImage(floor, x(0), y(world.floor.height), world.floor.width * scale, world.floor.height * scale);
    context.globalAlpha = 1;
  }
  const line = (from, to, colour) => {
    context.strokeStyle = colour;
    context.lineWidth = 2 * devicePixelRatio;
    context.beginPath();
    for (let one = from; one <= to; one += 1) context.lineTo(x(poses[3 * one]), y(poses[3 * one + 1]));
    context.stroke();
  };
  context.globalAlpha = 0.25;
  line(at, poses.length / 3 - 1, style.color);
  context.globalAlpha = 1;
  line(0, at, getComputedStyle(byId("position")).accentColor);
  context.translate(x(poses[3 * at]), y(poses[3 * at + 1]));
  context.rotate(-poses[3 * at + 2]);
  context.scale(devicePixelRatio * 1.3, devicePixelRatio * 1.3);
  context.fillStyle = style.color;
  context.beginPath();
  for (const [px, py] of [[9, 0], [-6, 5.5], [-3.5, 0], [-6, -5.5]]) context.lineTo(px, py);
  context.fill();
};
addEventListener("resize", () => drawWorld());
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
const jump = (wanted) => {
  play(false);
  seekTime(wanted);
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
  // The keys of a control keep their meaning; the slider would go by parts of a second.
  if (event.target instanceof HTMLSelectElement || event.ctrlKey || event.metaKey || event.altKey) return;
  if (event.key === "ArrowRight") step(1);
  else if (event.key === "ArrowLeft") step(-1);
  else if (event.key === "ArrowUp" || event.key === "ArrowDown") jump(time + (event.key === "ArrowUp" ? 1 : -1));
  else if (event.key === "Home" || event.key === "End") jump(event.key === "Home" ? 0 : end);
  else if (event.key === " " && !(event.target instanceof HTMLButtonElement)) play(timer === 0);
  else return;
  event.preventDefault();
});
seekTime(0);
// It plays by itself, unless the reader has asked for less motion.
if (end > 0 && !matchMedia("(prefers-reduced-motion: reduce)").matches) play(true);`;
