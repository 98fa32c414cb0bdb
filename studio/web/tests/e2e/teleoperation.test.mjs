// An operator drives a robot by keys and pointer in the page; it stops when the page is gone.
import assert from "node:assert/strict";
import { test } from "node:test";
import { button, folder, judges, onBuilt, tab, until } from "./page.mjs";

/** The studio's report on the newest run, requested beside the page, which may be closed. */
const speeds = async ({ address, url }) => {
  const token = /token=([^&]+)/.exec(url)[1];
  const ask = async (path) => (await fetch(new URL(path, address), { headers: { Authorization: `Bearer ${token}` } })).json();
  const [{ run }] = (await ask("/api/runs")).slice(-1);
  const { values } = await ask(`/api/runs/${run}`);
  const { left, right } = values["robot.control.wheels"];
  return {
    left,
    right,
    lever: values["crane.control.speed"],
    gear: values["robot.console.wish"].gear,
    horn: values["robot.console.wish"].horn,
  };
};

const eventually = async (look, what) => {
  const end = Date.now() + 30_000;
  while (!(await look())) {
    if (Date.now() > end) assert.fail(`never came: ${what}`);
    await new Promise((done) => setTimeout(done, 50));
  }
};

test("a robot is driven by keys, by the pointer and by controls, and stops when the page is closed", () =>
  onBuilt(folder("teleoperation"), async (page, server, open) => {
    await tab(page, "Run").click();
    await page.getByRole("textbox", { name: "For" }).fill("1000s");
    await button(page, "Run").click();
    const drive = page.getByRole("region", { name: "Panel robot.console.drive" });
    const crane = page.getByRole("region", { name: "Panel crane.cabin.lever" });
    await drive.waitFor();
    const stick = drive.getByRole("application");
    const is = (wanted, what) =>
      eventually(async () => {
        const now = await speeds(server);
        return Object.entries(wanted).every(([name, value]) =>
          typeof value === "number" ? Math.abs(now[name] - value) < 1e-3 : now[name] === value,
        );
      }, what);

    // Keys have no effect until the panel is operated.
    await stick.focus();
    await page.keyboard.press("ArrowUp");
    assert.match(await drive.innerText(), /forward 0 m\/s/);
    await drive.getByRole("button", { name: "Operate" }).click();
    await drive.getByRole("button", { name: "Stop operating" }).waitFor();
    await stick.focus();
    await page.keyboard.down("ArrowUp");
    await is({ left: 0.5 / 0.03, right: 0.5 / 0.03 }, "full speed ahead");
    await page.keyboard.down("ArrowRight");
    await is({ left: (0.5 + 0.2) / 0.03, right: (0.5 - 0.2) / 0.03 }, "a bend");
    await page.keyboard.up("ArrowRight");
    await page.keyboard.up("ArrowUp");
    await is({ left: 0, right: 0 }, "it springs back");

    const box = await stick.boundingBox();
    await page.mouse.move(box.x + box.width / 2, box.y + box.height / 2);
    await page.mouse.down();
    await page.mouse.move(box.x + box.width / 2, box.y + box.height * 0.75);
    await is({ left: -0.25 / 0.03 }, "backwards by the pointer");
    await page.mouse.up();
    await is({ left: 0 }, "it springs back");

    await drive.getByRole("slider", { name: "gear" }).focus();
    await page.keyboard.press("ArrowRight");
    await is({ gear: 2 }, "the second gear");
    await drive.getByRole("button", { name: "horn" }).focus();
    await page.keyboard.down("Space");
    await is({ horn: true }, "the horn");
    await page.keyboard.up("Space");
    await is({ horn: false, gear: 2 }, "silence");

    const objections = [];
    const judge = await judges(page, objections);
    for (const theme of ["light", "dark"]) {
      await judge(theme);
      await button(page, "Dark colours").click();
    }
    assert.deepEqual(objections, []);

    // An operator who leaves the controls lets go of them.
    await stick.focus();
    await page.keyboard.down("ArrowUp");
    await is({ left: 0.5 / 0.03 }, "ahead");
    await tab(page, "Verify").click();
    await is({ left: 0, gear: 1 }, "it stops when the tab is left");
    await page.keyboard.up("ArrowUp");
    await tab(page, "Run").click();
    await drive.getByRole("button", { name: "Operate" }).click();

    // A second page is refused as long as the first operates the panel.
    const second = await open();
    await second.goto(server.url);
    await tab(second, "Run").click();
    const taken = second.getByRole("region", { name: "Panel robot.console.drive" });
    await taken.getByRole("button", { name: "Operate" }).click();
    await taken.getByRole("alert").getByText("another operator has the panel").waitFor();
    await taken.getByRole("button", { name: "Operate" }).waitFor();

    // The crane goes on while its page is there, and stops with it.
    await page.bringToFront();
    await crane.getByRole("button", { name: "Operate" }).click();
    await crane.getByRole("slider", { name: "value" }).fill("0.5");
    await is({ lever: 0.5 }, "the crane");
    await stick.focus();
    await page.keyboard.down("ArrowUp");
    await is({ left: 0.5 / 0.03, lever: 0.5 }, "both move");
    await page.close();
    await is({ left: 0, right: 0, lever: 0 }, "both stop");
    await until(
      second,
      async () => {
        await taken.getByRole("button", { name: "Operate" }).click();
        return (await taken.getByRole("button", { name: "Stop operating" }).count()) > 0;
      },
      "the panel is free",
    );
    await button(second, "Stop").click();
    await second.locator(".run-state.ended").waitFor();
  }));

test("everything that drives devices is stopped from the page, also past a dialog, until it is reset", () =>
  onBuilt(folder("teleoperation"), async (page, server, open) => {
    const bar = (of) => of.getByRole("region", { name: "Emergency stop" });
    const stop = (of) => of.getByRole("button", { name: "EMERGENCY STOP" });
    await tab(page, "Run").click();
    assert.equal(await bar(page).count(), 0, "nothing drives anything");
    await page.getByRole("combobox", { name: "Run" }).selectOption("run");
    await page.getByRole("textbox", { name: "For" }).fill("1000s");
    await button(page, "Run").click();
    await bar(page)
      .getByText(/Drives devices: teleoperation\.\d+/)
      .waitFor();
    const place = await stop(page).boundingBox();
    assert.ok(place.height >= 44 && place.width >= 200, "it is large");
    const other = await open();
    await other.goto(server.url);
    await bar(other).getByText("Drives devices").waitFor();

    const objections = [];
    const judge = await judges(page, objections);
    await judge("driving");
    await button(page, "About Tessera").click();
    const inDialog = page.getByRole("dialog").getByRole("button", { name: "EMERGENCY STOP" });
    assert.deepEqual(await inDialog.boundingBox(), place, "it is where it always is");
    await inDialog.click();
    await page.getByRole("dialog").getByText("All have stopped").waitFor();
    await button(page, "Close").click();
    await bar(page)
      .getByText(/teleoperation\.\d+: emergency stop/)
      .waitFor();
    await bar(page)
      .getByText(/teleoperation\.\d+ is stopped/)
      .waitFor();
    await judge("stopped");
    await bar(other).getByText("is stopped").waitFor();

    // It holds for whoever comes later, and is asked about before devices move again.
    await page.reload();
    await bar(page).getByRole("button", { name: "Reset…" }).click();
    await bar(page).getByText("Its devices will move again").waitFor();
    await bar(page)
      .getByRole("button", { name: /^Reset teleoperation/ })
      .click();
    await bar(page).getByText("Drives devices").waitFor();
    await bar(other).getByText("Drives devices").waitFor();
    await tab(page, "Run").click();
    await button(page, "Stop").click();
    await bar(other).waitFor({ state: "detached" });
    assert.deepEqual(objections, []);
  }));
