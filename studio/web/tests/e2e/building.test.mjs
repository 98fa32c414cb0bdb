// Building in the browser alone: channels by keyboard, functions with the errors of their build, a whole
// robot.
import assert from "node:assert/strict";
import { cpSync, mkdirSync, mkdtempSync, readFileSync, rmSync, writeFileSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { after, test } from "node:test";
import {
  button,
  codeText,
  draftText,
  drawn,
  example,
  judges,
  middleOf,
  isInDrawing,
  near,
  noProblems,
  onPage,
  tab,
  until,
} from "./page.mjs";

const parent = mkdtempSync(join(tmpdir(), "studio-building-"));
after(() => rmSync(parent, { recursive: true, force: true }));

test("buffers are connected by the keyboard alone, and those that do not fit say why", () => {
  const root = join(parent, "keys");
  mkdirSync(root);
  const buffers = (side, all) => `      ${side}: { ${all} }\n`;
  writeFileSync(
    join(root, "spec.yaml"),
    `tessera: 1\nsystem: keys\nagents:\n  a:\n    control:\n      rate: 10 Hz\n${buffers("outputs", "speed: float64 m/s")}      behaviours: { run: {} }\n` +
      `  b:\n    control:\n      rate: 10 Hz\n${buffers("inputs", "go: bool, slow: float64, fast: float64 m/s")}      behaviours: { run: {} }\n`,
  );
  return onPage(
    root,
    async (page) => {
      const focused = () =>
        page.evaluate(() => {
          const { id, textContent, tagName } = document.activeElement;
          return (id && document.querySelector(`label[for="${CSS.escape(id)}"]`)?.textContent) || `${tagName} ${textContent}`;
        });
      await tab(page, "Structure").click();
      await page.locator('[data-handle="a.control.speed"]').waitFor();
      await page.keyboard.press("Control+k");
      await page.keyboard.type("a.control.speed");
      await page.keyboard.press("Enter");
      await page.getByLabel("Connect to").waitFor();
      for (let presses = 0; (await focused()) !== "Connect to"; presses += 1) {
        assert.ok(presses < 200, "Tab leads to the choice of a buffer");
        await page.keyboard.press("Tab");
      }
      const options = await page
        .getByLabel("Connect to")
        .locator("option")
        .evaluateAll((all) => all.map((one) => [one.disabled, one.textContent]));
      assert.deepEqual(options, [
        [false, "b.control.slow"],
        [false, "b.control.fast"],
        [true, "b.control.go: its type is bool"],
      ]);
      await page.keyboard.press("ArrowDown");
      await page.keyboard.press("Tab");
      await page.keyboard.press("Enter");
      await until(page, async () => /- a\.control\.speed -> b\.control\.fast\n/.test(await draftText(page)), "the channel");
      // The form of the channel follows, and the buffer has its source now.
      await page.getByLabel("The sender").waitFor();
      await page.keyboard.press("Control+k");
      await page.keyboard.type("b.control.fast");
      await page.keyboard.press("Enter");
      await page.getByLabel("Connect from").getByText("a.control.speed: connected already").waitFor({ state: "attached" });
      assert.equal(await button(page, "Connect").isDisabled(), true);
    },
    { server: { copy: false } },
  );
});

test("an error of the build is shown beside its function, with its hint, and a function follows its behaviour", () => {
  const root = join(parent, "mistake");
  cpSync(example("01_line_follower"), root, { recursive: true, filter: (path) => !path.includes(".tessera") });
  return onPage(
    root,
    async (page) => {
      const chip = (path) => page.locator(`.chip[data-path="${path}"]`).click();
      await tab(page, "Structure").click();
      await chip("robot.control.follow");
      const area = page.getByLabel(/^src\/control\.cpp, line \d+$/);
      await area.waitFor();
      await area.fill((await codeText(area)).replace("in.line", "in.lin"));
      await button(page, "Save the function").click();
      await tab(page, "Run").click();
      // The world of this example has a floor, and each of its tracks is offered once.
      const tracks = await page.getByLabel("Track").locator("option").allTextContents();
      assert.ok(tracks.includes("oval.png") && new Set(tracks).size === tracks.length, tracks.join());
      await button(page, "Run").click();
      await page.getByTestId("run-state").getByText("Failed").waitFor();
      await chip("robot.control.follow");
      const said = page.getByRole("list", { name: "What the build says" });
      await said.getByText(/error E501: .*no member named 'lin'/).waitFor();
      await said.getByText("Hint: did you mean 'line'?").waitFor();
      // The mistake is underlined in the text, too.
      const marked = page.locator(".code-editor .cm-lintRange-error");
      await marked.waitFor();
      assert.equal(await marked.innerText(), "lin");
      await said.getByRole("button", { name: "Line 2 of the function" }).click();
      const after = await area.evaluate((one) => {
        const { doc, selection } = one.closest(".code-editor").editor.state;
        return doc.sliceString(selection.main.head);
      });
      assert.match(after, /^lin,/);
      // The behaviour of another subsystem has no errors.
      await chip("robot.motor.drive");
      await page.getByLabel(/^src\/motor\.cpp, line \d+$/).waitFor();
      assert.equal(await said.count(), 0);
      await chip("robot.control.follow");
      await area.fill((await codeText(area)).replace("in.lin,", "in.line,"));
      await button(page, "Save the function").click();
      await page.getByRole("textbox", { name: "Name", exact: true }).fill("pursue");
      await page.keyboard.press("Enter");
      await page.getByRole("dialog").getByRole("button", { name: "Rename everywhere" }).click();
      await until(page, async () => /^void pursue\(/.test(await codeText(area)), "the function with its new name");
      assert.doesNotMatch(readFileSync(join(root, "src/control.cpp"), "utf8"), /void follow/);
    },
    { server: { copy: false } },
  );
});

test("a patrol robot is built in the browser alone, and drives", () => {
  const root = join(parent, "patrol");
  mkdirSync(root);
  return onPage(
    root,
    async (page, server) => {
      const field = (name, exact = true) => page.getByRole("textbox", { name, exact });
      const fill = async (locator, text) => {
        await locator.fill(text);
        await locator.press("Enter");
      };
      const group = (name) => page.getByRole("group", { name, exact: true });
      /** Adds an entry to a map of the specification, under a name of its own. */
      const entry = async (map, one, fresh, name) => {
        await group(map)
          .getByRole("button", { name: `Add ${one}` })
          .click();
        if (name !== fresh) await fill(group(map).getByLabel(`New name of ${fresh}`), name);
        return group(map).getByRole("group", { name, exact: true });
      };
      const structure = async (name, fields) => {
        const of = await entry("Types", "type", "Value", name);
        for (const [at, [field, base, unit]] of fields.entries()) {
          if (at > 0) await of.getByRole("button", { name: "Add field" }).click();
          await fill(of.getByLabel(`Field ${at + 1}`), field);
          await of.getByLabel(`Type of ${field}`).selectOption(base);
          if (unit) await fill(of.getByLabel(`Unit of ${field}`), unit);
        }
      };
      const parameter = async (name, value, unit, most) => {
        const of = await entry("Parameters", "parameter", "speed", name);
        await fill(of.getByLabel(`Value of ${name}`), value);
        await fill(of.getByLabel(`Unit of ${name}`), unit);
        if (most) await fill(of.getByLabel(`Most of ${name}`), most);
      };
      const nothing = () => page.locator(".react-flow__pane").click({ position: { x: 8, y: 8 } });
      /** Selects a box. It may still be moving, because another gets more space, so that a click can miss it. */
      const select = (kind, path) => {
        const one = page.locator(`.${kind}[data-path="${path}"]`);
        const isSelected = async () => {
          if (!(await isInDrawing(page, one))) await near(page, path);
          await one.click();
          await drawn(page);
          return (await one.getAttribute("aria-pressed")) === "true";
        };
        return until(page, isSelected, `${path} is selected`);
      };
      const head = (path) => select("subsystem-head", path);
      const chip = (path) => select("chip", path);
      const buffer = async (subsystem, what, fresh, name, type) => {
        await head(subsystem);
        await button(page, `Add ${what}`).click();
        await page.getByRole("heading", { name: `Buffer ${fresh}`, exact: true }).waitFor();
        await fill(field("Name"), name);
        const [base, unit] = type.split(" ");
        await page.getByLabel("Type", { exact: true }).selectOption(base);
        if (unit) await fill(field("Unit"), unit);
      };

      const judged = [];
      const judge = await judges(page, judged);
      for (const width of [640, 1024, 1440]) {
        await page.setViewportSize({ width, height: 900 });
        await judge(`the start page at ${width}`);
      }
      await button(page, "An empty system").click();
      await page.locator('.chip[data-path="robot.control.run"]').waitFor();
      await page.getByRole("group", { name: "Types" }).waitFor();
      await structure("Light", [
        ["left", "bool"],
        ["middle", "bool"],
        ["right", "bool"],
      ]);
      await structure("Motion", [
        ["linear", "float64", "m/s"],
        ["angular", "float64", "rad/s"],
      ]);
      await parameter("v", "0.2", "m/s", "0.5");
      await parameter("w", "2", "rad/s");
      await parameter("wheel", "0.03", "m");
      await parameter("base", "0.16", "m");
      await page.locator('[data-path="robot"]').first().click();
      await button(page, "Add receptor").click();
      await head("robot.sensor");
      for (const name of ["left", "middle", "right"]) await buffer("robot.sensor", "real buffer", "device", name, "float64");
      await buffer("robot.sensor", "output", "output", "light", "Light");
      await page.locator('[data-path="robot"]').first().click();
      await button(page, "Add effector").click();
      await head("robot.motor");
      for (const name of ["left", "right"]) await buffer("robot.motor", "real buffer", "device", name, "float64 rad/s");
      await buffer("robot.motor", "input", "input", "motion", "Motion");
      await head("robot.motor");
      await fill(field("Inputs are stale after"), "500 ms");
      await fill(group("Safe command").getByLabel("left (rad/s)"), "0");
      await buffer("robot.control", "input", "input", "light", "Light");
      await buffer("robot.control", "output", "output", "motion", "Motion");
      const line = async (from, to) => {
        const [start, end] = [from, to].map((path) => page.locator(`[data-handle="${path}"]`));
        // The boxes may still be moving to make space for a new channel.
        for (const handle of [start, end]) await middleOf(page, handle);
        await start.dragTo(end);
      };
      await line("robot.sensor.light", "robot.control.light");
      await page.locator('.channel-label[data-path="channel:0"]').waitFor();
      await line("robot.control.motion", "robot.motor.motion");
      await page.locator('.channel-label[data-path="channel:1"]').waitFor();
      await chip("robot.control.run");
      await fill(field("Name"), "cruise");
      for (const name of ["turn_left", "turn_right", "back_off", "rest", "recover"]) {
        await head("robot.control");
        await button(page, "Add behaviour").click();
        await page.getByRole("heading", { name: "Behaviour act" }).waitFor();
        await fill(field("Name"), name);
        await page.locator(`.chip[data-path="robot.control.${name}"][aria-pressed="true"]`).waitFor();
      }
      const conditions = {
        cruise: {
          terminal: "!in.light.middle",
          error: "!in.light.left && !in.light.middle && !in.light.right",
          next: ["recover when error", "turn_left when in.light.left", "turn_right"],
        },
        turn_left: { terminal: "in.light.middle", next: ["cruise"] },
        turn_right: { terminal: "in.light.middle", next: ["cruise"] },
        recover: { terminal: "elapsed > 100 ms", next: ["back_off"] },
        back_off: { terminal: "in.light.middle", next: ["rest"] },
        rest: { terminal: "elapsed > 100 ms", next: ["cruise"] },
      };
      for (const [name, { terminal, error, next }] of Object.entries(conditions)) {
        await chip(`robot.control.${name}`);
        await fill(field("Terminal condition"), terminal);
        if (error) await fill(field("Error condition"), error);
        for (const [at, one] of next.entries()) {
          const [to, when] = one.split(" when ");
          await button(page, "Add a next behaviour").click();
          await fill(page.getByRole("combobox", { name: `Then ${at + 1}: to` }), to);
          if (when) await fill(page.getByRole("combobox", { name: "when", exact: true }).nth(at), when);
        }
      }
      // A name that is taken is refused.
      await chip("robot.control.rest");
      await field("Name").fill("cruise");
      await page.getByText("The name cruise is taken here").waitFor();
      await field("Name").press("Escape");
      await nothing();
      await fill(page.getByLabel("World", { exact: true }), "line_world.xml");
      await button(page, "Add a track").click();
      const track = group("Track");
      await fill(track.getByLabel("Image"), "oval.png");
      for (const key of ["Metres per pixel", "Start", "Footprint"]) await track.getByLabel("Add a setting").selectOption(key);
      await fill(track.getByLabel("Metres per pixel"), "0.005");
      for (const [name, value] of [
        ["x", "1.2"],
        ["y", "0.1"],
        ["Heading", "0 deg"],
      ])
        await fill(track.getByLabel(name, { exact: true }), value);
      await fill(track.getByLabel("Footprint"), "8 mm");
      const world = group("Drivers in the world");
      const devices = [
        ["robot.sensor.left", "reflectance", "eye_left"],
        ["robot.sensor.middle", "reflectance", "eye_middle"],
        ["robot.sensor.right", "reflectance", "eye_right"],
        ["robot.motor.left", "velocity", "wheel_left"],
        ["robot.motor.right", "velocity", "wheel_right"],
      ];
      for (const [path, kind, device] of devices) {
        // The next real buffer without a driver gets one.
        await world.getByRole("button", { name: "Add driver" }).click();
        const of = world.getByRole("group", { name: path, exact: true });
        await of.getByLabel("Kind").selectOption(kind);
        // The world lists its elements.
        await of.locator(`option[value="${device}"]`).waitFor({ state: "attached" });
        await fill(of.getByLabel("Device"), device);
      }
      for (const width of [640, 1440]) {
        await page.setViewportSize({ width, height: 900 });
        await judge(`the form of the system at ${width}`);
      }
      assert.deepEqual(judged, []);
      await noProblems(page);
      /** The function of a behaviour: begun by a click, then typed. */
      const code = async (path, body) => {
        await chip(path);
        await page.getByRole("button", { name: /^Write it into / }).click();
        const area = page.getByLabel(/^src\/.*line \d+$/);
        await area.waitFor();
        if (!body) return;
        const text = await codeText(area);
        await area.fill(`${text.slice(0, text.indexOf("{") + 1)}\n  ${body}\n}`);
        await button(page, "Save the function").click();
        await button(page, "Discard").waitFor({ state: "detached" });
      };
      const move = (linear, angular) => `out.motion = {${linear}, ${angular}};`;
      const [v, w] = ["context.parameters.v", "context.parameters.w"];
      await code("robot.control.cruise", move(v, `(in.light.right - in.light.left) * ${w} / 15`));
      await code("robot.control.turn_left", move(v, `-${w}`));
      await code("robot.control.turn_right", move(v, w));
      await code("robot.control.recover", move("0", "0"));
      await code("robot.control.back_off", move(`-${v}`, `-${w} / 2`));
      await code("robot.control.rest", move("0", "0"));
      await code("robot.sensor.run", "out.light = {in.left < 0.5, in.middle < 0.5, in.right < 0.5};");
      await code(
        "robot.motor.run",
        `const double turn = in.motion.angular * context.parameters.base / 2;
  out.left = (in.motion.linear + turn) / context.parameters.wheel;
  out.right = (in.motion.linear - turn) / context.parameters.wheel;`,
      );
      await tab(page, "Run").click();
      await fill(field("For"), "60s");
      await fill(field("Speed"), "0");
      await button(page, "Save and run").click();
      await page.getByTestId("run-state").getByText("Ended").waitFor();
      await page.locator(".value-list").getByText("robot.control.motion.linear").waitFor();
      // It follows the oval at its speed, all the way around.
      const headers = { Authorization: `Bearer ${server.token}` };
      const ask = async (path) => (await fetch(`${server.address}/api/runs${path}`, { headers })).json();
      const [{ run }] = await ask("");
      const { path, outcome } = await ask(`/${run}`);
      const steps = path.slice(1).map(([, x, y], at) => Math.hypot(x - path[at][1], y - path[at][2]));
      const way = steps.reduce((sum, step) => sum + step, 0);
      assert.ok(way > 8, `${way} m in a minute`);
      const extent = (at) => Math.max(...path.map((row) => row[at])) - Math.min(...path.map((row) => row[at]));
      assert.ok(extent(1) > 1 && extent(2) > 0.5, `it went around: ${extent(1)} m x ${extent(2)} m`);
      const errors = outcome.subsystems.reduce((sum, one) => sum + one.errors, 0);
      assert.ok(errors <= 3, `${errors} errors`);
      assert.deepEqual(new Set(await page.locator(".problem-hint").allTextContents()), new Set());
      assert.match(readFileSync(join(root, "spec.yaml"), "utf8"), /recover/);
    },
    { server: { copy: false } },
  );
});
