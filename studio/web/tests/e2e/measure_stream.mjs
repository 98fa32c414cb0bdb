// Measures the response of the page while a run streams faster than it can be drawn: the gaps between frames,
// and the time from a click on another layer to its drawing.
import { button, example, onNet, tab, until } from "./page.mjs";

/** The measured cases: with a simulated world, and without one, which fires faster. */
const projects = {
  "01_line_follower": ["robot.control", "robot.sensor", "robot.control.follow", "robot.motor", "robot.sensor.watch"],
  "03_two_slot_buffer": [
    "watcher.control",
    "watcher.camera",
    "watcher.control.look",
    "watcher.camera.take",
    "watcher.control.study",
  ],
};

/** A run at full speed; `beside`: with a recording beside it that follows its time. */
export async function measureStream(beside) {
  for (const [name, layers] of Object.entries(projects)) {
    console.log(`${name}${beside ? ", with a recording beside it" : ""}:`);
    await measureProject(name, layers, beside);
  }
}

const measureProject = (name, layers, beside) =>
  onNet(example(name), async (page) => {
    await tab(page, "Run").click();
    if (beside) await start(page, "60s");
    if (beside) await page.getByTestId("run-state").getByText("Ended").waitFor();
    await start(page, "9000min");
    await until(page, async () => (await facts(page)).firings > 1000, "firings");
    if (beside) {
      await tab(page, "Recordings").click();
      await page.locator(".recordings button").first().click();
      await page.getByRole("switch", { name: "Same time" }).check();
    }
    await page.evaluate(() => {
      window.frames_ = [];
      const tick = (now) => (window.frames_.push(now), requestAnimationFrame(tick));
      requestAnimationFrame(tick);
    });
    const before = await facts(page);
    const answers = [];
    for (const path of layers) answers.push(await goTo(page, path));
    await page.evaluate(() => new Promise((done) => setTimeout(done, 8000)));
    const after = await facts(page);
    const times = await page.evaluate(() => window.frames_);
    await tab(page, "Run").click();
    const stop = button(page, "Stop");
    if (await stop.count()) await stop.click(); // unless it ended by itself
    tell(before, after, times, answers);
  });

async function start(page, time) {
  for (const [label, value] of [
    ["For", time],
    ["Speed", "0"],
  ]) {
    await page.getByRole("textbox", { name: label, exact: true }).fill(value);
    await page.keyboard.press("Enter");
  }
  await button(page, "Run").click();
}

async function facts(page) {
  const found = page.getByTestId("run-facts").first();
  const text = (await found.count()) ? await found.innerText() : "";
  const number = (pattern) => Number((pattern.exec(text)?.[1] ?? "0").replaceAll(",", ""));
  return { firings: number(/([\d,]+) firings/), dropped: number(/([\d,]+) only counted/), at: performance.now() };
}

function tell(before, after, times, answers) {
  const seconds = (after.at - before.at) / 1000;
  const gaps = times.slice(1).map((time, at) => time - times[at]);
  gaps.sort((a, b) => a - b);
  const fired = after.firings - before.firings;
  const shown = 100 * (1 - (after.dropped - before.dropped) / fired);
  const gap = (part) => `${gaps[Math.min(gaps.length - 1, Math.floor(part * gaps.length))].toFixed(1)} ms`;
  console.log(`${Math.round(fired / seconds)} firings/s, ${shown.toFixed(0)} % of them sent one by one`);
  console.log(`  ${gaps.length} frames in ${seconds.toFixed(1)} s: gap median ${gap(0.5)}, p95 ${gap(0.95)}, longest ${gap(1)}`);
  console.log(`  a layer drawn after a click: ${answers.map((time) => `${time.toFixed(0)} ms`).join(", ")}`);
}

/** From the click on one of the elements found to the frame in which its sheet is there and the view on it. */
async function goTo(page, path) {
  await page.keyboard.press("Control+k");
  await page.getByRole("combobox", { name: "Path" }).fill(path);
  const entry = page.getByRole("listbox", { name: "Elements" }).getByRole("option").first();
  await entry.waitFor();
  await page.evaluate((wanted) => {
    window.answer_ = new Promise((done) => {
      const clicked = ({ timeStamp }) => {
        const view = () => document.querySelector(".react-flow__viewport").style.transform;
        const before = view();
        const look = () => {
          const sheet = document.querySelector(`[data-sheet="${wanted}"]`)?.getBoundingClientRect();
          const area = document.querySelector(".canvas-area").getBoundingClientRect();
          const at = sheet && (sheet.left + sheet.right) / 2;
          if (sheet && view() !== before && at > area.left && at < area.right)
            setTimeout(() => done(performance.now() - timeStamp));
          else requestAnimationFrame(look);
        };
        requestAnimationFrame(look);
      };
      addEventListener("pointerdown", clicked, { once: true, capture: true });
    });
  }, path);
  await entry.click();
  return page.evaluate(() => window.answer_);
}
