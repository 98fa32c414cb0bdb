// Nothing that was typed is lost, and no file is changed otherwise than was asked.
import assert from "node:assert/strict";
import { readFileSync, writeFileSync } from "node:fs";
import { join } from "node:path";
import { test } from "node:test";
import { button, checked, codeText, draftText, drawn, example, folder, onPage, serve, tab, until } from "./page.mjs";

const lineFollower = example("01_line_follower");
const subsystem = '[data-path="robot.control"]';

async function setRate(page, rate) {
  await tab(page, "Structure").click();
  await page.locator(subsystem).click();
  await page.getByRole("textbox", { name: "Rate" }).fill(rate);
  await page.keyboard.press("Enter");
}

/** The C++ of `follow`, in its text field. */
async function codeOf(page) {
  await tab(page, "Structure").click();
  await page.locator('.chip[data-path="robot.control.follow"]').click();
  const area = page.locator("section.code").getByRole("textbox");
  await area.waitFor();
  return area;
}

async function typeAtBegin(page, area, text) {
  await area.focus();
  await page.keyboard.press("Control+Home");
  await page.keyboard.type(text);
}

const sourceOf = (server) => join(server.root, "src/control.cpp");

/** Holds back the answer with the file until the text pane is in the page, but before its effects run. */
function holdFileUntilTextPane() {
  const fetched = window.fetch;
  window.fetch = async (path, options) => {
    const answer = await fetched(path, options);
    if (!String(path).endsWith("/api/spec") || window.held) return answer;
    const body = await answer.text();
    // A body that is there needs no further task of the browser.
    const ready = { ok: true, status: 200, headers: answer.headers, text: async () => body, json: async () => JSON.parse(body) };
    const isThere = () => document.querySelector('[data-testid="editor"]') !== null;
    await new Promise((done) => {
      if (isThere()) return done();
      window.held = true;
      new MutationObserver((_, observer) => isThere() && (observer.disconnect(), done())).observe(document, {
        childList: true,
        subtree: true,
      });
    });
    return ready;
  };
}

/** A stream of events beside the page's. */
async function listen({ address, token }) {
  const stream = await fetch(`${address}/api/events`, { headers: { Authorization: `Bearer ${token}` } });
  const reader = stream.body.getReader();
  let heard = "";
  const hear = async (wanted) => {
    while (!heard.includes(wanted)) heard += new TextDecoder().decode((await reader.read()).value);
    await reader.cancel();
  };
  return { hear };
}

test("a change on disk after the file was read and before events come is shown", () =>
  onPage(lineFollower, async (_, server, open) => {
    const page = await open();
    const changeFirst = async (route) => {
      const others = await listen(server);
      writeFileSync(server.file, server.text().replace("v: 0.2 m/s", "v: 0.3 m/s"));
      await others.hear("event: spec"); // the server has told all that listen
      await route.continue();
    };
    // A tab whose browser has no shared workers has a stream of its own, which can be held back.
    await page.addInitScript(() => delete window.SharedWorker);
    await page.route("**/api/events*", changeFirst, { times: 1 });
    await page.goto(server.url);
    await page.getByTestId("editor").getByText("v: 0.3 m/s").waitFor();
    await page.getByText("The file changed on disk; reloaded").waitFor();
  }));

test("a file that comes while the page is drawn for the first time stays as it is", () =>
  onPage(lineFollower, async (_, server, open) => {
    const page = await open();
    await page.addInitScript(holdFileUntilTextPane);
    // The part of the page with the editor comes late.
    await page.route(/text_pane/, async (route) => {
      await until(page, () => page.evaluate(() => window.held), "the file was held back");
      await route.continue();
    });
    await page.goto(server.url);
    await page.getByText("Opening…").waitFor({ state: "detached" });
    await until(page, () => page.evaluate(() => window.held), "the file was held back");
    await drawn(page);
    const shown = await page.locator(".cm-content").innerText();
    assert.match(shown, /system: line_follower/);
    assert.equal(await draftText(page), undefined, "something is not saved");
  }));

test("undo in the C++ undoes the C++ and not the specification, and a reload loses neither", () =>
  onPage(lineFollower, async (page) => {
    await setRate(page, "33 Hz");
    const area = await codeOf(page);
    const before = await codeText(area);
    await typeAtBegin(page, area, "X");
    await page.keyboard.press("Control+z");
    assert.equal(await codeText(area), before);
    assert.match(await draftText(page), /33 Hz/);
    await typeAtBegin(page, area, "/* mine */ ");
    const text = await codeText(area);
    await page.reload();
    const again = await codeOf(page);
    await until(page, async () => (await codeText(again)) === text, "the C++ is there again");
    assert.match(await draftText(page), /33 Hz/);
  }));

test("C++ that another program changed is merged, or asked about, and a run saves it first", () =>
  onPage(lineFollower, async (page, server) => {
    const area = await codeOf(page);
    const source = sourceOf(server);
    await typeAtBegin(page, area, "/* mine */ ");
    // Two lines before the function: it is elsewhere now.
    writeFileSync(source, `// theirs\n\n${readFileSync(source, "utf8")}`);
    const saved = () => /\/\* mine \*\/ void follow/.test(readFileSync(source, "utf8"));
    // The page may see it by itself, before the function is saved.
    await button(page, "Save the function").click();
    const told = page.getByText("This is its text now");
    await until(page, async () => saved() || (await told.isVisible()), "the function is saved, or its new text is there");
    if (!saved()) await button(page, "Save the function").click();
    await until(page, saved, "the function is saved");
    assert.ok(readFileSync(source, "utf8").startsWith("// theirs\n\n"));
    await typeAtBegin(page, area, "/* again */ ");
    writeFileSync(source, readFileSync(source, "utf8").replace("/* mine */", "/* not mine */"));
    await button(page, "Save the function").click();
    const asked = page.getByRole("group", { name: "The function was changed by another program" });
    await asked.getByText("/* not mine */").waitFor();
    assert.match(readFileSync(source, "utf8"), /\/\* not mine \*\//);
    await asked.getByRole("button", { name: "Keep mine" }).click();
    await tab(page, "Run").click();
    await button(page, "Save and run").click();
    await until(page, () => /\/\* again \*\/ \/\* mine \*\/ void follow/.test(readFileSync(source, "utf8")), "the run saved it");
    await button(page, "Stop").click();
    await page.getByTestId("run-state").getByText("Ended").or(page.getByTestId("run-state").getByText("Failed")).waitFor();
  }));

test("lines keep their ends in the specification and in C++", () =>
  onPage(lineFollower, async (page, server) => {
    const source = sourceOf(server);
    const [text, code] = [server.text(), readFileSync(source, "utf8")];
    const windows = (text) => text.replaceAll("\n", "\r\n");
    writeFileSync(server.file, windows(text));
    writeFileSync(source, windows(code));
    await page.reload();
    await page.getByTestId("editor").getByText("20 Hz").waitFor();
    assert.equal(await page.getByLabel("not saved").count(), 0, "nothing was edited");
    await setRate(page, "33 Hz");
    await page.keyboard.press("Control+s");
    await page.getByText("Saved").waitFor();
    assert.equal(server.text(), windows(text.replace("rate: 20 Hz", "rate: 33 Hz")));
    await typeAtBegin(page, await codeOf(page), "/* mine */ ");
    await button(page, "Save the function").click();
    const expected = windows(code.replace("void follow", "/* mine */ void follow"));
    await until(page, () => readFileSync(source, "utf8") === expected, "the function is saved");
  }));

test("what is typed in a field is saved with the rest, and a second save waits for the first", () =>
  onPage(lineFollower, async (page, server) => {
    await tab(page, "Structure").click();
    await page.locator(subsystem).click();
    await page.getByRole("textbox", { name: "Rate" }).fill("33 Hz");
    let goOn;
    const askedAgain = new Promise((done) => (goOn = done));
    await page.route("**/api/spec", async (route) => {
      const answer = await route.fetch();
      await askedAgain;
      await route.fulfill({ response: answer });
    });
    await page.keyboard.press("Control+s");
    await page.getByRole("textbox", { name: "Rate" }).fill("34 Hz");
    await page.keyboard.press("Control+s");
    goOn();
    await until(page, () => /rate: 34 Hz/.test(server.text()), "both are saved");
    await page.getByLabel("not saved").waitFor({ state: "detached" });
    assert.equal(await page.getByRole("dialog").isVisible(), false);
  }));

/** Edits wait at the door of the server until they are let in. */
async function holdEdits(page) {
  let held = [];
  let open = false;
  await page.route("**/api/edit", async (route) => {
    if (!open) await new Promise((done) => held.push(done));
    await route.continue().catch(() => undefined); // the page may be loaded again
  });
  return {
    hold: () => (open = false),
    letIn: async () => {
      open = true;
      held.splice(0).forEach((done) => done());
      await checked(page);
    },
  };
}

test("while edits are on their way, fields show what was typed, and nothing of it is lost", () =>
  onPage(lineFollower, async (page) => {
    const { hold, letIn } = await holdEdits(page);
    await tab(page, "Structure").click();
    await page.locator(subsystem).click();
    const rate = page.getByRole("textbox", { name: "Rate" });
    await rate.fill("33 Hz");
    await rate.press("Enter");
    await page.getByLabel("not saved").waitFor();
    await rate.fill("34 Hz");
    await letIn();
    assert.equal(await rate.inputValue(), "34 Hz", "it is not taken yet");
    assert.match(await draftText(page), /rate: 33 Hz/);
    hold();
    await rate.press("Enter");
    // Undo takes the edit back, also one on its way.
    await rate.press("Control+z");
    await letIn();
    assert.equal(await rate.inputValue(), "33 Hz");
    hold();
    await button(page, "Add behaviour").click();
    await button(page, "Add behaviour").click();
    await letIn();
    assert.match(await draftText(page), /act: \{\}\n\s+act_2: \{\}/);
    hold();
    const name = page.getByRole("textbox", { name: "Name", exact: true });
    await name.fill("stop");
    await name.press("Enter");
    await name.fill("stop_now");
    await letIn();
    await page.getByRole("heading", { name: "Behaviour stop" }).waitFor();
    assert.equal(await name.inputValue(), "stop_now");
    hold();
    await name.press("Enter");
    // An element is chosen under its old name.
    await page.locator(subsystem).click();
    await letIn();
    await page.getByRole("heading", { name: "Subsystem control" }).waitFor();
    assert.match(await draftText(page), /stop_now: \{\}/);
    hold();
    await rate.fill("36 Hz");
    // Without leaving the field.
    await page.reload();
    await letIn();
    await until(page, async () => /rate: 36 Hz/.test((await draftText(page)) ?? ""), "the edit of before");
  }));

test("parts of one value that are changed while edits are on their way are all changed", () =>
  onPage(lineFollower, async (page) => {
    const { hold, letIn } = await holdEdits(page);
    await tab(page, "Structure").click();
    await tab(page, "Element").click();
    await button(page, "Change v").click();
    await page.getByLabel("Value of v", { exact: true }).fill("0.5");
    await page.getByLabel("Unit of v", { exact: true }).fill("cm/s");
    const start = page.getByRole("group", { name: "Start", exact: true });
    await start.getByLabel("x", { exact: true }).fill("1.5");
    await start.getByLabel("y", { exact: true }).fill("0.25");
    await start.getByLabel("y", { exact: true }).press("Enter");
    await letIn();
    assert.match(await draftText(page), /v: 0\.5 cm\/s[^]*start: \[1\.5, 0\.25, /);
    hold();
    await page.locator('.channel-label[data-path="channel:1"]').click();
    const receiver = page.getByLabel("The receiver");
    await receiver.selectOption("non_blocking");
    assert.equal(await receiver.inputValue(), "non_blocking");
    await letIn();
    assert.equal(await receiver.inputValue(), "non_blocking");
    assert.doesNotMatch(await draftText(page), /receive: blocking/);
  }));

test("a conflict that another program puts right is none, and undo leads to the text that was not kept", () =>
  onPage(lineFollower, async (page, server) => {
    const before = server.text();
    await setRate(page, "33 Hz");
    const dialog = page.getByRole("dialog");
    writeFileSync(server.file, "");
    await dialog.waitFor();
    writeFileSync(server.file, before);
    await dialog.waitFor({ state: "hidden" });
    assert.match(await draftText(page), /33 Hz/);
    writeFileSync(server.file, before.replace("rate: 20 Hz", "rate: 44 Hz"));
    await dialog.getByRole("button", { name: "Keep mine" }).click();
    await page.keyboard.press("Control+s");
    await page.getByText("Saved").waitFor();
    assert.match(server.text(), /rate: 33 Hz/);
    await button(page, "Undo").click();
    assert.match(await draftText(page), /rate: 44 Hz/);
  }));

test("a file that cannot be read is not taken for an empty one", () =>
  onPage(lineFollower, async (page, server) => {
    const large = `${server.text()}${"# a long comment\n".repeat(600_000)}`;
    writeFileSync(server.file, large);
    await page.reload();
    await page.getByText("spec.yaml cannot be read").waitFor();
    await page.getByText("it is larger than 8 MB").waitFor();
    assert.equal(await button(page, "Begin").count(), 0);
    await page.getByTestId("editor").locator(".cm-content").focus();
    await page.keyboard.type("x");
    await page.keyboard.press("Control+s");
    await page.getByText("the file cannot be written").waitFor();
    assert.ok(server.text() === large, "it stays as it was");
  }));

test("an address that is opened in the old tab is taken, and another project's text is not mixed in", () =>
  onPage(lineFollower, async (page, server) => {
    await setRate(page, "33 Hz");
    await until(page, async () => /33 Hz/.test((await draftText(page)) ?? ""), "the edit");
    await server.kill();
    const other = await serve(folder("orchard"), { port: server.port });
    try {
      await page.goto(other.url);
      await page.getByRole("heading", { name: "orchard" }).waitFor();
      assert.equal(await page.getByLabel("not saved").count(), 0);
    } finally {
      await other.close();
    }
    const again = await serve(server.root, { port: server.port, copy: false });
    try {
      await page.goto(again.url);
      await page.getByRole("heading", { name: "line_follower" }).waitFor();
      await page.getByTestId("editor").getByText("33 Hz").waitFor();
    } finally {
      await again.close();
    }
  }));

test("a conflict asks only about the lines that both changed, and keeps the other changes of both", () =>
  onPage(lineFollower, async (page, server) => {
    await setRate(page, "33 Hz");
    writeFileSync(server.file, server.text().replace("rate: 20 Hz", "rate: 44 Hz").replace("v: 0.2 m/s", "v: 0.3 m/s"));
    const dialog = page.getByRole("dialog", { name: "The file was changed by another program" });
    await dialog.getByText("rate: 44 Hz").waitFor();
    assert.doesNotMatch(await dialog.innerText(), /0\.3 m\/s/);
    // A reload in the meantime forgets nothing.
    await page.reload();
    await dialog.getByText("rate: 44 Hz").waitFor();
    await page.reload();
    await dialog.getByRole("button", { name: "Keep mine" }).click();
    await page.keyboard.press("Control+s");
    await page.getByText("Saved").waitFor();
    assert.match(server.text(), /v: 0\.3 m\/s[\s\S]*rate: 33 Hz/);
  }));

test("undo in a field takes back the edit, and an alias stays an alias", () =>
  onPage(lineFollower, async (page, server) => {
    const text = server
      .text()
      .replace("rate: 20 Hz", "rate: &r2 20 Hz")
      .replace(/(motor:\n\s+rate:) 50 Hz/, "$1 *r2");
    assert.match(text, /\*r2/);
    writeFileSync(server.file, text);
    await page.getByTestId("editor").getByText("*r2", { exact: false }).first().waitFor();
    await tab(page, "Structure").click();
    await page.locator('[data-path="robot.motor"]').click();
    const rate = page.getByRole("textbox", { name: "Rate" });
    assert.equal(await rate.inputValue(), "*r2");
    await rate.click();
    await page.keyboard.press("Control+a");
    await page.keyboard.type("30 Hz");
    await page.keyboard.press("Enter");
    await until(page, async () => /rate: 30 Hz/.test((await draftText(page)) ?? ""), "the edit");
    await page.keyboard.press("Control+z");
    await until(page, async () => (await rate.inputValue()) === "*r2", "it is undone");
    await rate.blur();
    assert.equal(await page.getByLabel("not saved").count(), 0, "the text is as it was");
    // Typed again, it is the alias, and not a text of that name.
    await rate.fill("30 Hz");
    await rate.press("Enter");
    await rate.fill("*r2");
    await rate.press("Enter");
    await page.getByLabel("not saved").waitFor({ state: "detached" });
    // Text that is not taken yet goes first.
    await rate.fill("99");
    await rate.press("Control+z");
    assert.equal(await rate.inputValue(), "*r2");
  }));

test("eight tabs share one stream: each can save, hears of it, and goes on when another is closed", () =>
  onPage(lineFollower, async (first, server, open) => {
    const tabs = [first];
    while (tabs.length < 8) {
      const page = await open();
      await page.goto(server.url);
      await page.getByText("Opening…").waitFor({ state: "detached" });
      tabs.push(page);
    }
    const last = tabs.at(-1);
    await last.bringToFront();
    await setRate(last, "33 Hz");
    await last.keyboard.press("Control+s");
    await last.getByText("Saved").waitFor();
    assert.match(server.text(), /rate: 33 Hz/);
    const shows = (page, rate) => page.getByTestId("editor").getByText(rate).waitFor();
    for (const page of tabs.slice(0, -1)) await shows(page, "33 Hz");
    await first.close();
    writeFileSync(server.file, server.text().replace("rate: 33 Hz", "rate: 44 Hz"));
    for (const page of tabs.slice(1)) await shows(page, "44 Hz");
    // All begin again after the server was gone.
    await server.kill();
    for (const page of tabs.slice(1)) await page.getByText("The server does not answer.").first().waitFor();
    const again = await serve(server.root, { port: server.port, copy: false });
    try {
      await last.goto(again.url);
      writeFileSync(server.file, server.text().replace("rate: 44 Hz", "rate: 55 Hz"));
      for (const page of tabs.slice(1)) await shows(page, "55 Hz");
    } finally {
      await again.close();
    }
  }));
