// Checks the outputs of the README's commands from the reader's side: pages, pictures, drawings and texts.
// TESSERA_REPORT_SECONDS=3600 is the long form of the run.
import assert from "node:assert/strict";
import { execFile } from "node:child_process";
import { cpSync, existsSync, mkdtempSync, readFileSync, rmSync } from "node:fs";
import { tmpdir } from "node:os";
import path from "node:path";
import { after, before, test } from "node:test";
import { pathToFileURL } from "node:url";
import { promisify } from "node:util";
import { launch } from "./browser.mjs";
import { example } from "./page.mjs";

const binary = process.env.TESSERA ?? path.resolve("../../build/release/tessera");
const seconds = Number(process.env.TESSERA_REPORT_SECONDS ?? 30);
const folder = mkdtempSync(path.join(tmpdir(), "tessera_reports_"));
const demo = path.join(folder, "demo");
const rover = path.join(folder, "rover");
const run = promisify(execFile);

/** The output of the command. */
async function tessera(arguments_, where = folder) {
  const { stdout } = await run(binary, arguments_, { cwd: where, maxBuffer: 1 << 28 });
  return stdout;
}

/** Checks text for people: English, printable, without leftovers of a program. */
function assertReadable(text, what) {
  const odd = [...text].find(
    (c) =>
      !/[\n\x20-\x7e\u00a0\u00b7\u00d7\u2009\u2026\u2580-\u259f\u2500-\u257f\u2190-\u21ff\u2022\u2800-\u28ff\u25a0-\u25ff]/u.test(
        c,
      ),
  );
  assert.equal(odd, undefined, `${what}: U+${odd?.codePointAt(0).toString(16)} in ${JSON.stringify(text.slice(0, 500))}`);
  const left = /(\bnan\b|\binf(inity)?\b|\bundefined\b|\bnull\b|\[object |\{[a-z_]*\}|%[sdf]\b|TODO|FIXME)/i.exec(text);
  assert.equal(
    left,
    null,
    `${what}: '${left?.[0]}' in ${text.slice(Math.max(0, (left?.index ?? 0) - 80), (left?.index ?? 0) + 80)}`,
  );
}

/** Every number is finite and every text readable. */
function assertJson(value, what) {
  if (value === null) assert.fail(`${what} is null`);
  else if (typeof value === "string") assertReadable(value, what);
  else if (typeof value === "object") for (const [key, part] of Object.entries(value)) assertJson(part, `${what}.${key}`);
}

let browser, page;
const problems = [];

before(async () => {
  cpSync(example("01_line_follower"), path.join(folder, "01_line_follower"), {
    recursive: true,
    filter: (from) => path.basename(from) !== ".tessera",
  });
  const driveDemo = tessera(["simulate", "01_line_follower", "--for", `${seconds}s`, "--seed", "1", "--report", demo]);
  const driveRover = tessera(["new", "rover"]).then(() =>
    tessera(["simulate", "--for", "10s", "--report", "report", "--json", "summary.json"], rover),
  );
  browser = await launch();
  const context = await browser.newContext({ viewport: { width: 1280, height: 900 } });
  page = await context.newPage();
  page.on("pageerror", (error) => problems.push(error.stack));
  page.on("console", (message) => message.type() === "error" && problems.push(message.text()));
  page.on("request", (request) => {
    if (!/^(file|data|about):/.test(request.url())) problems.push(`request to ${request.url()}`);
  });
  page.on("requestfailed", (request) => problems.push(`not there: ${request.url()}`));
  assertReadable(await driveDemo, "summary of the demo");
  assertReadable(await driveRover, "summary of a new project");
});

after(async () => {
  await browser?.close();
  rmSync(folder, { recursive: true, force: true });
});

/** The number of colours of a picture, coarsely counted. */
const coloursOf = (bytes) =>
  page.evaluate(
    async (source) => {
      const picture = new Image();
      picture.src = source;
      await picture.decode();
      const canvas = new OffscreenCanvas(200, 200);
      const context = canvas.getContext("2d");
      context.drawImage(picture, 0, 0, 200, 200);
      return new Set(new Uint32Array(context.getImageData(0, 0, 200, 200).data.buffer)).size;
    },
    `data:image/png;base64,${bytes.toString("base64")}`,
  );

/** The complete content of a page. */
const shown = () =>
  page.evaluate(() => {
    const drawings = [...document.querySelectorAll("svg")].map((svg) => {
      const { width, height } = svg.viewBox.baseVal;
      const outside = [...svg.querySelectorAll("text")].filter((text) => {
        const box = text.getBBox();
        return box.x < -1 || box.y < -1 || box.x + box.width > width + 1 || box.y + box.height > height + 1;
      });
      return {
        label: svg.getAttribute("aria-label") ?? "drawing",
        outside: outside.map((text) => text.textContent),
        shapes: svg.querySelectorAll("rect,polyline,polygon,path,circle,ellipse").length,
        points: [...svg.querySelectorAll("polyline, polygon.band")].map((line) => line.points.length),
        wrong: /(nan|inf|undefined)/i.exec(svg.outerHTML.replace(/base64,[^"]*/g, ""))?.[0] ?? "",
      };
    });
    return {
      text: document.body.innerText.replaceAll("\t", " "), // between cells
      language: document.documentElement.lang,
      height: document.documentElement.scrollHeight,
      tooWide: document.documentElement.scrollWidth - document.documentElement.clientWidth,
      drawings,
      pictures: [...document.querySelectorAll("image,img")].map((image) => image.getAttribute("href") ?? image.src),
      links: [...document.querySelectorAll("a[href],link[href],script[src]")].map((link) => link.href ?? link.src),
    };
  });

async function assertReport(file) {
  await page.goto(pathToFileURL(file).href);
  const { text, language, height, tooWide, drawings, pictures, links } = await shown();
  assertReadable(text, file);
  assert.equal(language, "en");
  assert.ok(height < 5000, `${file} is ${height} px high`);
  assert.ok(tooWide <= 0, `${file} is ${tooWide} px too wide`);
  assert.deepEqual(drawings.map((drawing) => drawing.label).sort(), [
    "Behaviours of each subsystem over time",
    "Distribution of ages",
    "Distribution of reactions",
    "Lateral error over time",
    "The path of the robot over the floor",
    "error over time",
    "laps over time",
    "the line is not lost for long over time",
  ]);
  for (const { label, outside, shapes, points, wrong } of drawings) {
    assert.deepEqual(outside, [], `${label}: text outside`);
    assert.equal(wrong, "", label);
    assert.ok(shapes > 0, `${label} is empty`);
    if (!/^(Behaviours|Distribution) of/.test(label))
      assert.ok(points.reduce((sum, count) => sum + count, 0) > 100, `${label} has no curve`);
  }
  assert.deepEqual(links, []);
  assert.ok(pictures.length > 0);
  for (const picture of pictures) {
    assert.match(picture, /^data:image\/png;base64,/);
    assert.ok((await coloursOf(Buffer.from(picture.split(",")[1], "base64"))) > 3, "the floor is blank");
  }
  assert.ok((await coloursOf(readFileSync(path.join(path.dirname(file), "path.png")))) > 20, "path.png is blank");
  assert.deepEqual(problems, []);
  return text;
}

test("the page of the demo", async () => {
  const text = await assertReport(path.join(demo, "index.html"));
  for (const part of ["laps", "mean error", "robot.control", "deadlock_free", "holds", "ended: duration"])
    assert.ok(text.includes(part), part);
  assert.doesNotMatch(text, /cut off|missing/);
});

test("the page of a new project", async () => {
  await assertReport(path.join(rover, "report", "index.html"));
});

test("the drawing of a net", async () => {
  await tessera(["show", "--svg", "net.svg"], rover);
  await page.goto(pathToFileURL(path.join(rover, "net.svg")).href);
  const drawing = await page.evaluate(() => ({
    text: [...document.querySelectorAll("text")].map((text) => text.textContent).join("\n"),
    shapes: document.querySelectorAll("path,rect,circle,ellipse,polygon").length,
    wrong: /(="[^"]*\b(nan|inf)\b[^"]*")/i.exec(document.documentElement.outerHTML)?.[0] ?? "",
  }));
  assertReadable(drawing.text, "net.svg");
  assert.ok(drawing.text.length > 20 && drawing.shapes > 10, "the drawing is empty");
  assert.equal(drawing.wrong, "");
  assert.deepEqual(problems, []);
});

test("texts and JSON", async () => {
  const recording = ".tessera/last/recording.tsr";
  for (const arguments_ of [
    ["check"],
    ["show"],
    ["replay", recording],
    ["replay", recording, "--check"],
    ["replay", recording, "--print", "--last", "200"],
    ["replay", recording, "--values=control.motion", "--last", "50"],
    ["replay", recording, "--csv", "-", "--last", "200"],
  ])
    assertReadable(await tessera(arguments_, rover), arguments_.join(" "));
  assert.match(await tessera(["replay", recording, "--check"], rover), /^legal: /);
  assertJson(JSON.parse(readFileSync(path.join(rover, "summary.json"), "utf8")), "summary");
  for (const arguments_ of [
    ["replay", recording, "--check", "--json", "-"],
    ["show", "--json", "-"],
    ["verify", "--json", "-"],
  ])
    JSON.parse(await tessera(arguments_, rover));
});

test("links of the README", () => {
  const root = path.resolve("../..");
  const text = readFileSync(path.join(root, "README.md"), "utf8");
  for (const [, target] of text.matchAll(/\]\((?!https?:)([^)#]+)/g)) assert.ok(existsSync(path.join(root, target)), target);
});
