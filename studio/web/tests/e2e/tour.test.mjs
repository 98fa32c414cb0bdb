// The tour of docs/studio_tour.md, from a new project to a changed behaviour that runs. With STUDIO_PICTURES=FOLDER it leaves
// the tour's pictures there.
import assert from "node:assert/strict";
import { execFileSync } from "node:child_process";
import { mkdtempSync, readFileSync, writeFileSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { test } from "node:test";
import { button, find, folder, onPage, tab, until } from "./page.mjs";

const pictures = process.env.STUDIO_PICTURES;
const picture = async (page, name) => {
  if (pictures) await page.screenshot({ path: join(pictures, `${name}.png`) });
};

function newProject() {
  const parent = mkdtempSync(join(tmpdir(), "studio-tour-"));
  execFileSync(process.env.TESSERA ?? "tessera", ["new", "rover"], { cwd: parent });
  const root = join(parent, "rover");
  const functions = join(root, "src/control.cpp");
  const text = readFileSync(functions, "utf8");
  const rest =
    "/// Behaviour rest: a little back.\nvoid rest(Context& context, const Inputs& in, Memory& memory, Outputs& out) {\n  out.motion = {-0.05, 0};\n}\n\n";
  const end = text.lastIndexOf("}  // namespace");
  writeFileSync(functions, text.slice(0, end) + rest + text.slice(end));
  return root;
}

const field = (page, name) => page.getByRole("textbox", { name, exact: true });
const fill = async (page, name, text) => {
  await field(page, name).fill(text);
  await page.keyboard.press("Enter");
};

test(
  "a behaviour is added in the drawing, verified and run in the simulator",
  { skip: process.env.STUDIO_FIXTURE !== undefined },
  () =>
    onPage(newProject(), async (page, server) => {
      await find(page, "robot.control");
      await page.locator('[data-sheet="robot.control.follow"]').waitFor();
      await picture(page, "studio_net");
      await tab(page, "Structure").click();
      await page.locator('[data-path="robot.control"]').click();
      await button(page, "Add behaviour").click();
      await field(page, "Name").waitFor();
      await fill(page, "Name", "rest");
      await page.locator('.chip[data-path="robot.control.rest"]').waitFor();
      await fill(page, "Terminal condition", "in.line.middle");
      await button(page, "Add what follows").click();
      await page.getByRole("combobox", { name: "Then 1: to" }).fill("follow");
      await page.keyboard.press("Enter");
      await page.locator('.chip[data-path="robot.control.follow"]').click();
      await fill(page, "Terminal condition", "!in.line.left && !in.line.middle && !in.line.right");
      await button(page, "Add what follows").click();
      await page.getByRole("combobox", { name: "Then 1: to" }).fill("rest");
      await page.keyboard.press("Enter");
      await page.getByTestId("editor").getByText("next: rest").waitFor();
      await page.getByText("No problems").waitFor();
      await picture(page, "studio_structure");
      await tab(page, "Verify").click();
      await button(page, "Verify").click();
      await page.locator(".toolbar").getByText("verified").waitFor();
      await tab(page, "Net").click();
      await find(page, "robot.control");
      await tab(page, "Run").click();
      await button(page, "Save and run").click();
      await page.locator(".running-now").getByText("follow").waitFor({ timeout: 240_000 });
      assert.match(server.text(), /rest:\n\s+terminal: in\.line\.middle\n\s+next: follow/);
      const seconds = async () => Number((await page.getByTestId("run-facts").innerText()).split(" ")[0]);
      await until(page, async () => (await seconds()) > 6, "six seconds of the run");
      await page.locator(".value-list").getByText("robot.control.motion.angular").click();
      await picture(page, "studio_run");
      await button(page, "Pause").click();
      await page.getByTestId("run-state").getByText("Paused").waitFor();
      const firings = async () =>
        Number(/([\d,]+) firings/.exec(await page.getByTestId("run-facts").innerText())[1].replaceAll(",", ""));
      let before = -1;
      await until(
        page,
        async () => {
          const [last, now] = [before, await firings()];
          before = now;
          return last === now;
        },
        "the pause",
      );
      await button(page, "Step one firing").click();
      await until(page, async () => (await firings()) === before + 1, "one more firing");
      await button(page, "Stop").click();
      await page.getByTestId("run-state").getByText("Ended").waitFor();
      await button(page, "Close this run").click();
      await tab(page, "Recordings").click();
      await page.locator(".recordings button").first().click();
      await page.getByRole("slider", { name: "Time" }).waitFor();
      await button(page, "To the next firing").click();
      await button(page, "Close").click();
    }),
);

test("a violation is told step by step", { skip: pictures === undefined }, () =>
  onPage(folder("standoff"), async (page) => {
    await tab(page, "Verify").click();
    await button(page, "Verify").click();
    await page
      .getByRole("button", { name: /Show the run/ })
      .first()
      .click();
    await find(page, "left.control.talk");
    await page.locator('[data-sheet="left.control.talk.snd"]').waitFor();
    await picture(page, "studio_verify");
  }),
);
