// The tour of docs/start/studio_tour.md, step by step, from a new project to a changed behaviour that runs. With
// STUDIO_PICTURES=FOLDER it leaves the tour's pictures there, and those of the moving one in FOLDER/moving.
import assert from "node:assert/strict";
import { execFileSync } from "node:child_process";
import { mkdirSync, mkdtempSync, readFileSync, rmSync, writeFileSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { after, test } from "node:test";
import { button, find, folder, noProblems, onNet, tab, until } from "./page.mjs";

const pictures = process.env.STUDIO_PICTURES;
const picture = async (page, name) => {
  if (!pictures) return;
  await page.mouse.move(720, 899);
  await page.evaluate(() => new Promise((done) => setTimeout(done, 400)));
  await page.screenshot({ path: join(pictures, `${name}.png`) });
};

/**
 * The parts of the moving picture: the run at double speed, then at a tenth of real speed, and one behaviour
 * from near.
 */
async function moving(page) {
  if (!pictures) return;
  const frames = join(pictures, "moving");
  mkdirSync(frames, { recursive: true });
  let taken = 0;
  const take = async (count) => {
    for (const end = taken + count; taken < end; taken += 1)
      await page.screenshot({ path: join(frames, `${String(taken).padStart(3, "0")}.png`) });
  };
  const speed = (power) => page.getByRole("slider", { name: /Speed/ }).fill(String(power));
  await speed(0.3);
  await take(36);
  await speed(-1);
  await find(page, "robot.control.follow");
  await take(36);
  await speed(0);
  await find(page, "robot.control");
}

const parent = mkdtempSync(join(tmpdir(), "studio-tour-"));
after(() => rmSync(parent, { recursive: true, force: true }));

function newProject() {
  execFileSync(process.env.TESSERA ?? "tessera", ["new", "rover"], { cwd: parent });
  return join(parent, "rover");
}

const turn = `/// Behaviour turn of robot.control: half the speed while the line is beside the middle.
void turn(Context& context, const Inputs& in, Memory& memory, Outputs& out) {
  out.motion = steer(in.line, context.parameters.v / 2, context.parameters.w);
}

`;

function writeTheFunction(root) {
  const file = join(root, "src/control.cpp");
  const text = readFileSync(file, "utf8");
  const end = text.lastIndexOf("}  // namespace");
  writeFileSync(file, text.slice(0, end) + turn + text.slice(end));
}

const field = (page, name) => page.getByRole("textbox", { name, exact: true });
const fill = async (page, name, text) => {
  await field(page, name).fill(text);
  await page.keyboard.press("Enter");
};
const followedBy = async (page, next) => {
  await button(page, "Add a next behaviour").click();
  await page.getByRole("combobox", { name: "Then 1: to" }).fill(next);
  await page.keyboard.press("Enter");
};
const facts = (page) => page.getByTestId("run-facts").first().innerText();
const seconds = async (page) => Number((await facts(page)).split(" ")[0]);
const firings = async (page) => Number(/([\d,]+) firings/.exec(await facts(page))[1].replaceAll(",", ""));
const runningNow = (page, behaviour) => page.locator(".running-now").getByText(behaviour, { exact: true });

const comparedAt = async (page) => Number((await page.getByTestId("compared-at").innerText()).split(" ")[1]);
const differing = (page) => page.getByRole("list", { name: "Subsystems that differ" });

/** Runs from the beginning to the end. */
async function runFor(page, duration) {
  await fill(page, "For", duration);
  await button(page, "Run").click();
  await page.getByTestId("run-state").getByText("Running").waitFor();
  await page.getByTestId("run-state").getByText("Ended").waitFor();
}

/** Searches the recording for a time, in seconds, at which it differs from the run beside it. */
async function momentThatDiffers(page, slider, seconds) {
  const start = Number(await slider.getAttribute("min"));
  // A time between the instants of the rates, so that nothing changes at that time itself.
  for (let hundredths = 52; hundredths < 100 * seconds; hundredths += 10) {
    const moment = hundredths / 100;
    await slider.fill(String(start + hundredths * 1e7));
    await until(page, async () => Math.abs((await comparedAt(page)) - moment) < 0.01, `a comparison at ${moment} s`);
    if ((await differing(page).count()) > 0) return moment;
  }
  return assert.fail("the runs on two tracks do the same all the time");
}

test("a behaviour is added in the drawing, verified, given its function, run and replayed", () =>
  onNet(newProject(), async (page, server) => {
    // The drawing of the net
    await find(page, "robot.control");
    await page.locator('[data-sheet="robot.control.follow"]').waitFor();
    await picture(page, "net");
    // 1. Structure
    await tab(page, "Structure").click();
    await page.locator('[data-path="robot.control"]').click();
    // 2. A behaviour
    await button(page, "Add behaviour").click();
    await field(page, "Name").waitFor();
    await fill(page, "Name", "turn");
    await page.locator('.chip[data-path="robot.control.turn"]').waitFor();
    await fill(page, "Terminal condition", "in.line.middle");
    await followedBy(page, "follow");
    // 3. How one gets there
    await page.locator('.chip[data-path="robot.control.follow"]').click();
    await fill(page, "Terminal condition", "!in.line.middle");
    await followedBy(page, "turn");
    await page.getByTestId("editor").getByText("next: turn").waitFor();
    await noProblems(page);
    await picture(page, "structure");
    // 4. Verify
    await tab(page, "Verify").click();
    await button(page, "Verify").click();
    await page.locator(".toolbar").getByText("verified").waitFor();
    await picture(page, "verified");
    // 5. The function
    writeTheFunction(server.root);
    // 6. Run
    await tab(page, "Net").click();
    await button(page, "Text of the specification").click();
    await find(page, "robot.control");
    await tab(page, "Run").click();
    await button(page, "Save and run").click();
    await runningNow(page, "follow").waitFor({ timeout: 400_000 }); // the controller is built
    assert.match(server.text(), /turn:\n\s+terminal: in\.line\.middle\n\s+next: follow/);
    await page.locator(".value-list").getByText("robot.control.motion.angular").click();
    await moving(page);
    await runningNow(page, "turn").waitFor();
    // The plot has come before the timeline.
    await tab(page, "Timeline").click();
    await until(page, async () => (await seconds(page)) > 6, "six seconds of the run");
    await picture(page, "run");
    await button(page, "Pause").click();
    await page.getByTestId("run-state").getByText("Paused").waitFor();
    // Firings before the pause may still be on their way to the page.
    let before = -1;
    let since = Date.now();
    await until(
      page,
      async () => {
        const now = await firings(page);
        if (now !== before) since = Date.now();
        before = now;
        return Date.now() - since > 2000;
      },
      "the pause",
    );
    await button(page, "Step one firing").click();
    await until(page, async () => (await firings(page)) === before + 1, "one more firing");
    await button(page, "Stop").click();
    await page.getByTestId("run-state").getByText("Ended").waitFor();
    await button(page, "Close this run").click();
    // 7. Recordings
    await tab(page, "Recordings").click();
    await page.locator(".recordings button").first().click();
    // Three seconds into it, wherever that is on the slider.
    const time = page.getByRole("slider", { name: "Time" });
    await time.fill(String(Number(await time.getAttribute("min")) + 3e9));
    await picture(page, "recording");
    await button(page, "To the next firing").click();
    // 8. Side by side
    await tab(page, "Run").click();
    await page.getByRole("combobox", { name: "Track" }).selectOption("curves.png");
    await runFor(page, "4s");
    // On simulated time, repeated runs are equal: a time at which the two differ is one in the next run too.
    const moment = await momentThatDiffers(page, time, 4);
    await tab(page, "Run").click();
    await runFor(page, `${moment}s`);
    await page.getByRole("switch", { name: "Same time" }).check();
    await until(page, async () => (await comparedAt(page)) === moment, "the comparison at the end of the run");
    await until(page, async () => (await differing(page).count()) > 0, "the difference that was found before");
    await picture(page, "beside");
    await page.getByRole("button", { name: /^Close Run/ }).click();
    await button(page, "Close").click();
  }));

test("a violation is told step by step", { skip: pictures === undefined }, () =>
  onNet(folder("standoff"), async (page) => {
    await tab(page, "Verify").click();
    await button(page, "Verify").click();
    await page
      .getByRole("button", { name: /Show the run/ })
      .first()
      .click();
    await find(page, "left.control.talk");
    await page.locator('[data-sheet="left.control.talk.snd"]').waitFor();
    await picture(page, "violation");
  }),
);
