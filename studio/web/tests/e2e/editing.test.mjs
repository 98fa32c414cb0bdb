import assert from "node:assert/strict";
import { execFileSync } from "node:child_process";
import { readFileSync, writeFileSync } from "node:fs";
import { join } from "node:path";
import { test } from "node:test";
import {
  button,
  changes,
  checked,
  draftText,
  drawn,
  environment,
  example,
  find,
  folder,
  judges,
  near,
  noProblems,
  onNet,
  onPage,
  tab,
  until,
} from "./page.mjs";

const lineFollower = example("01_line_follower");

test("an edit in the drawing is a clean diff, in the text too, and is undone", () =>
  onPage(lineFollower, async (page, server) => {
    const before = server.text();
    await tab(page, "Structure").click();
    await page.locator('[data-path="robot.control"]').click();
    await button(page, "Add behaviour").click();
    await page.getByRole("heading", { name: "Behaviour act" }).waitFor();
    await page.getByRole("textbox", { name: "Name" }).fill("stop");
    await page.keyboard.press("Enter");
    await page.locator('.chip[data-path="robot.control.stop"]').waitFor();
    await page.getByRole("textbox", { name: "Terminal condition" }).fill("in.line.left");
    await page.keyboard.press("Enter");
    const expected = ["+        stop:", "+          terminal: in.line.left"];
    assert.deepEqual(changes(before, await draftText(page)), expected);
    await page.getByTestId("editor").getByText("terminal: in.line.left").waitFor();
    await button(page, "Save").click();
    await page.getByText("Saved").waitFor();
    assert.deepEqual(changes(before, server.text()), expected);
    for (let step = 0; step < 3; step += 1) await button(page, "Undo").click();
    assert.equal(await draftText(page), before);
    await tab(page, "Net").click();
    await find(page, "robot.control.follow");
    await page.locator('[data-sheet="robot.control.follow"]').waitFor();
  }));

test("a group is made, a behaviour is moved into it, and undo gives the text back", () =>
  onPage(lineFollower, async (page, server) => {
    const before = server.text();
    await tab(page, "Structure").click();
    await page.locator('.subsystem-head[data-path="robot.control"]').click();
    await button(page, "Add group").click();
    await page.locator('.chip.group[data-path="robot.control.group"]').waitFor();
    await page.locator('.chip[data-path="robot.control.group.act"]').waitFor();
    await page.locator('.chip[data-path="robot.control.follow"]').click();
    await page.getByRole("combobox", { name: "In the group" }).selectOption("group");
    await page.locator('.chip[data-path="robot.control.group.follow"][aria-pressed="true"]').waitFor();
    const text = await draftText(page);
    const follow = before.split("\n").find((line) => line.trim().startsWith("follow:"));
    assert.ok(text.includes(`\n    ${follow}`), text);
    for (let step = 0; step < 2; step += 1) await button(page, "Undo").click();
    // Nothing is left to save.
    assert.equal(await draftText(page), undefined);
  }));

test("renaming an agent changes its name everywhere and nothing else", () =>
  onPage(lineFollower, async (page, server) => {
    await tab(page, "Structure").click();
    await page.locator('.agent-name[data-path="robot"]').click();
    const before = server.text();
    await page.getByRole("textbox", { name: "Name" }).fill("rover");
    await page.keyboard.press("Enter");
    await renameEverywhere(page);
    await page.locator('.agent-name[data-path="rover"]').waitFor();
    await noProblems(page);
    assert.equal(server.text().replaceAll("rover", "robot"), before);
    assert.notEqual(server.text(), before);
  }));

const renameEverywhere = (page) => page.getByRole("dialog").getByRole("button", { name: "Rename everywhere" }).click();

test("a rename also changes C++, tests and params.yaml, says so before, and is one step of undo", () =>
  onPage(lineFollower, async (page, server) => {
    const names = ["spec.yaml", "src/control.cpp", "test/control_test.cpp", "params.yaml"];
    const all = () => names.map((name) => readFileSync(join(server.root, name), "utf8"));
    writeFileSync(join(server.root, "params.yaml"), "v: 0.1   # slow\n");
    const before = all();
    const count = (pattern) => all().map((text) => text.match(pattern)?.length ?? 0);
    const name = page.getByRole("textbox", { name: "Name", exact: true });
    const dialog = page.getByRole("dialog");
    await tab(page, "Structure").click();
    await page.locator('.chip[data-path="robot.control.follow"]').click();
    await name.fill("pursue");
    await page.keyboard.press("Enter");
    await dialog.getByText("test/control_test.cpp").waitFor();
    assert.deepEqual(all(), before, "nothing is written before the answer");
    await dialog.getByRole("button", { name: "Keep the old name" }).click();
    await until(page, async () => (await name.inputValue()) === "follow", "the old name in the field");
    assert.deepEqual(all(), before);
    await name.fill("pursue");
    await page.keyboard.press("Enter");
    await renameEverywhere(page);
    await page.getByRole("heading", { name: "Behaviour pursue" }).waitFor();
    assert.ok(
      count(/\bpursue\b/g)
        .slice(0, 3)
        .every((times) => times > 0),
    );
    assert.deepEqual(count(/next: follow|follow: |void follow\(|control::follow/g), [0, 0, 0, 0]);
    // Another program changes other lines of a file: they stay when the rename is undone.
    const code = join(server.root, "src/control.cpp");
    writeFileSync(code, `${readFileSync(code, "utf8")}// mine\n`);
    await button(page, "Undo").click();
    await until(page, async () => all()[0] === before[0], "the specification of before on disk");
    // The other files are written after it.
    await checked(page);
    assert.deepEqual(
      all(),
      before.map((text, at) => (at === 1 ? `${text}// mine\n` : text)),
    );
    await button(page, "Redo").click();
    await until(page, async () => count(/\bpursue\b/g)[1] > 0, "the new name again");
    await checked(page);
    // The same lines changed by another program: nothing is taken back, and the page says why.
    writeFileSync(code, readFileSync(code, "utf8").replaceAll("void pursue(", "void pursue_it("));
    const now = all();
    await button(page, "Undo").click();
    await page.getByText("the same lines of src/control.cpp were changed since then").waitFor();
    assert.deepEqual(all(), now);
  }));

test("an edit that cannot be done is refused with its reason", () =>
  onPage(lineFollower, async (page, server) => {
    const before = server.text();
    await tab(page, "Structure").click();
    await page.locator('.chip[data-path="robot.control.follow"]').click();
    const name = page.getByRole("textbox", { name: "Name", exact: true });
    await name.fill("while");
    await page.keyboard.press("Enter");
    await page.getByText(/Not changed: .*keyword of C\+\+/).waitFor();
    await until(page, async () => (await name.inputValue()) === "follow", "the old name in the field");
    assert.equal(await draftText(page), undefined);
    assert.equal(server.text(), before);
  }));

test("a behaviour and an output of one name have forms and names of their own", () =>
  onPage(example("07_fleet"), async (page, server) => {
    const before = server.text();
    const name = page.getByRole("textbox", { name: "Name" });
    await tab(page, "Structure").click();
    await near(page, "supervisor.control");
    await page.locator('[data-selection="output:supervisor.control.call"]').click();
    await page.getByText("output buffer").waitFor();
    await name.fill("summon");
    await page.keyboard.press("Enter");
    await renameEverywhere(page);
    await page.getByRole("heading", { name: "Buffer summon" }).waitFor();
    assert.deepEqual(
      changes(before, server.text()).filter((line) => line.startsWith("+")),
      [
        "+      outputs: { summon: uint32, count: Count }",
        "+          send:     [summon, count]",
        "+  - supervisor.control.summon -> robot[*].control.call                                          # they look at it",
      ],
    );
    await button(page, "Undo").click();
    await until(page, async () => server.text() === before, "the text of before on disk");
    await page.locator('.chip[data-path="supervisor.control.call"]').click();
    await page.getByRole("heading", { name: "Behaviour call" }).waitFor();
    await name.fill("roll_call");
    await page.keyboard.press("Enter");
    await renameEverywhere(page);
    await page.getByRole("heading", { name: "Behaviour roll_call" }).waitFor();
    const renamed = changes(before, server.text()).filter((line) => line.startsWith("+"));
    assert.deepEqual(
      renamed.map((line) => line.split("#")[0].trimEnd()),
      ["+          next:     [{ to: rest, when: error }, roll_call]", "+        roll_call:"],
    );
  }));

test("a channel is dragged from an output to an input, and its modes are chosen", () =>
  onPage(lineFollower, async (page, server) => {
    const before = server.text();
    await page.setViewportSize({ width: 1920, height: 1000 }); // both ends are in the drawing
    await tab(page, "Structure").click();
    await page.locator('[data-path="robot.motor"]').click();
    await button(page, "Add input").click();
    await page.locator('[data-handle="robot.motor.input"]').waitFor();
    // The new input moves the drawing. On a busy machine this happens under the mouse, so it is tried again.
    const channel = page.locator('[data-path="channel:2"]');
    for (let turn = 0; turn < 20 && (await channel.count()) === 0; turn += 1) {
      await page.locator('[data-handle="robot.sensor.line"]').dragTo(page.locator('[data-handle="robot.motor.input"]'));
      await channel.waitFor({ timeout: 2000 }).catch(() => undefined);
    }
    await channel.waitFor();
    await page.getByLabel("The receiver").selectOption("blocking");
    await page.locator('.channel-label[data-path="channel:2"]').getByText("N → B").waitFor();
    assert.deepEqual(
      changes(before, await draftText(page)).at(-1),
      "+  - { from: robot.sensor.line, to: robot.motor.input, receive: blocking }",
    );
  }));

test("the text completes names, says what they mean, and leads to their definition", () =>
  onPage(lineFollower, async (page) => {
    const editor = page.getByTestId("editor").locator(".cm-content");
    const line = editor.locator(".cm-line", { hasText: "next: follow" });
    await line.click();
    await page.keyboard.press("End");
    for (let i = 0; i < 8; ++i) await page.keyboard.press(i < 2 ? "ArrowLeft" : "Backspace");
    await page.keyboard.type("f");
    await page.locator(".cm-tooltip-autocomplete li").getByText("follow").waitFor();
    await page.keyboard.press("Tab");
    await editor.locator(".cm-line", { hasText: "next: follow }" }).waitFor();
    await page.keyboard.press("F12");
    await editor.locator(".cm-activeLine", { hasText: "follow: {}" }).waitFor();
    await page.mouse.move(0, 0); // what the mouse rested on may lie over the other line
    await page.locator(".cm-tooltip-hover").waitFor({ state: "detached" });
    const { x, y } = await editor.locator(".cm-line", { hasText: "outputs: { motion" }).boundingBox();
    await page.mouse.move(x + 220, y + 8);
    await page.locator(".cm-tooltip-hover").getByText("linear: float64 m/s").waitFor();
  }));

test("a broken file says where, keeps its drawing, and is repaired", () =>
  onNet(lineFollower, async (page) => {
    const editor = page.getByTestId("editor").locator(".cm-content");
    await editor.getByText("start: [1.2").count();
    await find(page, "robot.control.init");
    await editor.focus();
    await page.keyboard.press("End");
    await page.keyboard.type(" ]");
    await page
      .getByTestId("problem-count")
      .getByText(/\d+ error/)
      .waitFor();
    await page.getByText("this is the drawing of the last version without").waitFor();
    assert.ok((await page.locator(".sheet").count()) > 0);
    assert.ok((await page.locator(".problem-list .problem").count()) > 0);
    await page.keyboard.press("Backspace");
    await page.keyboard.press("Backspace");
    await noProblems(page);
  }));

test("a file that is broken on disk opens with its errors", () =>
  onNet(folder("broken"), async (page) => {
    await page.getByText("No drawing yet").waitFor();
    assert.ok((await page.locator(".problem-list .problem").count()) > 0);
    await tab(page, "Structure").click();
    await page.locator('[data-path="robot.control"]').waitFor();
  }));

test("a change on disk is taken, merged, or asked about", () =>
  onPage(lineFollower, async (page, server) => {
    const before = server.text();
    writeFileSync(server.file, before.replace("rate: 20 Hz", "rate: 25 Hz"));
    await page.getByTestId("editor").getByText("25 Hz").waitFor();
    await tab(page, "Structure").click();
    await page.locator('[data-path="robot.motor"]').click();
    await page.getByRole("textbox", { name: "Rate" }).fill("40 Hz");
    await page.keyboard.press("Enter");
    writeFileSync(server.file, server.text().replace("rate: 25 Hz", "rate: 30 Hz"));
    await page.getByText("both changes were merged").waitFor();
    assert.match(await draftText(page), /rate: 30 Hz[\s\S]*rate: 40 Hz/);
    writeFileSync(server.file, server.text().replace(/(motor:\n\s+rate:) 50 Hz/, "$1 60 Hz"));
    const dialog = page.getByRole("dialog");
    await dialog.getByText("60 Hz").waitFor();
    await dialog.getByRole("button", { name: "Keep mine" }).click();
    assert.match(await draftText(page), /rate: 40 Hz/);
    await page.keyboard.press("Control+s");
    await page.getByText("Saved").waitFor();
    assert.match(server.text(), /rate: 40 Hz/);
  }));

test("without a mouse: a behaviour is added, the text verified, undone and saved", () =>
  onPage(lineFollower, async (page, server) => {
    const before = server.text();
    const press = async (...keys) => {
      for (const key of keys) await page.keyboard.press(key);
    };
    /** Presses the tabulator key until the element with that name has the focus. */
    const tabTo = async (role, name) => {
      for (let turn = 0; turn < 120; turn += 1) {
        const there = await page
          .getByRole(role, { name, exact: true })
          .evaluateAll((all) => all.includes(document.activeElement));
        if (there) return;
        await press("Tab");
      }
      assert.fail(`the tabulator key never came to the ${role} ${name}`);
    };
    await tabTo("tab", "Structure");
    await press("Enter");
    await page.locator('[data-path="robot.control"]').waitFor();
    await page.locator('.subsystem-head[data-path="robot.control"]').focus();
    await press("Enter");
    await button(page, "Add behaviour").waitFor();
    await tabTo("button", "Add behaviour");
    await press("Enter");
    await page.locator('.chip[data-path="robot.control.act"]').waitFor();
    await tabTo("textbox", "Name");
    await press("Control+a");
    await page.keyboard.type("wait");
    await press("Enter");
    await page.locator('.chip[data-path="robot.control.wait"]').waitFor();
    // One stop for all tabs; the arrow keys lead from tab to tab.
    await tabTo("tab", "Element");
    await press("ArrowRight", "Enter");
    await tab(page, "Verify").and(page.locator('[aria-selected="true"]')).waitFor();
    await tabTo("button", "Verify");
    await press("Enter");
    await page.locator(".verdict").first().waitFor();
    await press("Control+s");
    await page.getByText("Saved").waitFor();
    assert.deepEqual(changes(before, server.text()), ["+        wait: {}"]);
    // Its name, and itself.
    await press("Control+z", "Control+z");
    await press("Control+s");
    await until(page, async () => server.text() === before, "the text of before on disk");
  }));

test("checks, measures, limits, templates and models have fields, which leave a clean diff that the check accepts", () =>
  onPage(folder("crossing"), async (page, server) => {
    // A world without a floor picture offers no tracks.
    await tab(page, "Run").click();
    await page.getByLabel("Seed").waitFor();
    assert.equal(await page.getByLabel("Track").count(), 0);

    const before = server.text();
    const within = (...names) =>
      names.reduce((outer, name) => outer.getByRole("group", { name, exact: true }), page.locator(".inspect"));
    const fill = async (locator, text) => {
      await locator.fill(text);
      await locator.press("Enter");
    };
    const found = [];
    const judge = await judges(page, found);
    /** Judges the form where it is narrow: nothing sticks out, and no letters are too small. */
    const judged = async (what) => {
      await page.setViewportSize({ width: 640, height: 900 });
      await judge(what);
      const faults = await page.locator(".inspect").evaluate((form) => {
        const edge = form.getBoundingClientRect().right + 1;
        const wrong = (one) =>
          one.getBoundingClientRect().right > edge || (one.innerText && parseFloat(getComputedStyle(one).fontSize) < 10);
        return [...form.querySelectorAll("*")].filter(wrong).map((one) => one.outerHTML.slice(0, 200));
      });
      found.push(...faults.map((one) => `${what}: ${one}`));
      await page.setViewportSize({ width: 1440, height: 900 });
    };
    await tab(page, "Structure").click();
    await page.locator('.subsystem-head[data-path="robot.control"]').waitFor();
    await tab(page, "Element").click();

    // By keys alone: a check is added, its kind is chosen, and its fields follow.
    await within("Checks").getByRole("button", { name: "Add check" }).press("Enter");
    const check = within("Checks", "Check 6");
    await check.getByLabel("Kind").focus();
    await page.keyboard.type("event");
    await check.getByLabel("Eventually").waitFor();
    await page.keyboard.press("Tab");
    await page.keyboard.type("inside(robot[0])");
    await page.keyboard.press("Tab");
    await page.keyboard.type("20");
    await check.getByText(/^This cannot be within/).waitFor();
    await page.keyboard.type(" s");
    await page.keyboard.press("Tab");
    // The complaint of the check is beside the field, and goes with its cause.
    const condition = check.getByLabel("Eventually");
    const problem = check.locator(".problem-hint");
    await problem.getByText(/inside/).waitFor();
    // The check that follows the last field takes the complaint away for a moment.
    const isMarked = async () =>
      (await condition.getAttribute("aria-invalid")) === "true" &&
      (await condition.getAttribute("aria-describedby")) === (await problem.getAttribute("id"));
    await until(page, isMarked, "the field is marked");
    await fill(condition, "inside(robot[0], north)");
    await problem.waitFor({ state: "detached" });
    await fill(check.getByLabel("Name"), "it turns north");
    await within("Measures").getByRole("button", { name: "Add measure" }).click();
    await fill(within("Measures").getByLabel("New name of measure"), "pace");
    await fill(within("Measures").getByLabel("pace", { exact: true }), "speed(robot[0])");
    // Entries of a check that its kind does not have go with a change of the kind.
    await within("Checks", "Check 5").getByLabel("Kind").selectOption("at_end");
    await within("Communication models").getByRole("button", { name: "Add model" }).click();
    await within("Communication models", "own", "Send", "Transitions", "end").getByLabel("To").waitFor();

    await judged("the system");

    await fill(within("Communication models").getByLabel("New name of own"), "one_value");

    await page.getByRole("button", { name: "Template rover" }).click();
    await page.getByText("A change of this template changes all 2 members of robot.").waitFor();
    await page.getByRole("button", { name: "Effector base" }).click();
    const limits = within("Limits of real outputs");
    await fill(limits.getByRole("group", { name: "command.ahead", exact: true }).getByLabel("Change per second"), "4 m/s");
    await limits.getByRole("group", { name: "command.turn", exact: true }).getByLabel("Beyond them").selectOption("fault");
    await page.getByLabel("Add a setting").selectOption("realtime");
    await fill(within("Realtime").getByLabel("Priority"), "80");
    await fill(within("Safe command", "command").getByLabel("ahead (m/s)"), "0.1");
    await judged("the effector of a template");

    // The channels between two agents are one line, which names them.
    await page.locator('.channel-label[data-path="bundle:crossing|robot"]').click();
    await page
      .getByRole("button", { name: /^robot\[0\]\.control\.request → crossing\.control\.request_0 The sender does not/ })
      .click();
    await page.getByLabel("Communication model").selectOption("one_value");
    // An agent that is to be a fleet becomes a template, as it is.
    await page.locator('.agent-name[data-path="crossing"]').click();
    await button(page, "Make it a template").click();
    await button(page, "Template crossing").waitFor();
    await noProblems(page);
    assert.deepEqual(found, []);
    await button(page, "Save").click();
    await page.getByText("Saved").waitFor();
    const [gone, come] = ["-", "+"].map((sign) =>
      changes(before, server.text())
        .filter((line) => line.startsWith(sign))
        .map((line) => line.slice(1)),
    );
    assert.equal(gone.length, 4);
    assert.deepEqual(come.slice(0, 10), [
      "          command.ahead: { min: -1, max: 1, per_second: 4 m/s }",
      "          command.turn:  { min: -3, max: 3, beyond: fault }",
      "        realtime:",
      "          priority: 80",
      "        safe:",
      "          command:",
      "            ahead: 0.1",
      "  crossing: { use: crossing }",
      `  - { from: "robot[0].control.request", to: crossing.control.request_0, model: one_value }${" ".repeat(36)}# it looks at both`,
      '    - { name: the second gets across, at_end: "inside(robot[1], north)" }',
    ]);
    assert.deepEqual(come.slice(10, 13), [
      '    - { name: it turns north, eventually: "inside(robot[0], north)", within: 20 s }',
      '    pace: "speed(robot[0])"',
      "models:",
    ]);
    assert.match(execFileSync(environment.tessera, ["check", server.root], { env: environment.env, encoding: "utf8" }), /place/);
  }));
