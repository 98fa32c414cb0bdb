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
    await drive.getByRole("checkbox", { name: "Sliders spring back" }).check();
    const gear = drive.getByRole("slider", { name: "gear" });
    await gear.focus();
    await page.keyboard.down("ArrowRight");
    await is({ gear: 3 }, "the third gear");
    await page.keyboard.up("ArrowRight");
    await is({ gear: 1 }, "it springs back");
    await drive.getByRole("checkbox", { name: "Sliders spring back" }).uncheck();
    await gear.focus();
    await page.keyboard.press("ArrowRight");
    await is({ gear: 2 }, "it stays");
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
    const lever = await crane.getByRole("application").boundingBox();
    await page.mouse.move(lever.x + lever.width / 2, lever.y + lever.height / 4);
    await page.mouse.down();
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

/** Fingers on the screen, by number; `change` moves, adds (a place) or lifts (null) some of them. */
async function fingersOn(page) {
  const session = await page.context().newCDPSession(page);
  await session.send("Emulation.setTouchEmulationEnabled", { enabled: true, maxTouchPoints: 5 });
  const down = new Map();
  const send = (type, fingers = down) =>
    session.send("Input.dispatchTouchEvent", { type, touchPoints: [...fingers].map(([id, [x, y]]) => ({ id, x, y })) });
  return {
    session,
    async put(id, place) {
      const type = down.has(id) ? "touchMove" : "touchStart";
      down.set(id, place);
      await send(type);
    },
    async lift(id) {
      await send("touchEnd", [[id, down.get(id)]]);
      down.delete(id);
    },
    async cancel() {
      down.clear();
      await send("touchCancel");
    },
  };
}

test("on the page for operators, fingers, keys and a gamepad move the robot, and whatever ends them brings it to rest", () =>
  onBuilt(folder("teleoperation"), async (page, server, open) => {
    const ask = async (path, body) => {
      const headers = { Authorization: `Bearer ${server.token}` };
      const sent = body ? { method: "POST", body: JSON.stringify(body) } : {};
      return (await fetch(new URL(path, server.address), { headers, ...sent })).json();
    };
    const tablet = await open();
    await page.close();
    await tablet.setViewportSize({ width: 1024, height: 768 });
    await tablet.addInitScript(() => {
      window.pad = null;
      Navigator.prototype.getGamepads = () => [window.pad];
    });
    const pad = (axes, ...pressed) =>
      tablet.evaluate(
        ([axes, pressed]) => {
          const buttons = Array.from({ length: 17 }, (_, at) => ({ pressed: pressed.includes(at) }));
          window.pad = axes && { id: "Pad of the test", mapping: "standard", axes, buttons };
        },
        [axes, pressed],
      );
    await tablet.goto(server.url.replace("/#", "/operate#"));
    await tablet.getByText("Nothing runs.").waitFor();
    const place = await tablet.getByRole("button", { name: "EMERGENCY STOP" }).boundingBox();
    const { run } = await ask("/api/runs", { kind: "simulate", for: "1000s", speed: 1 });
    await tablet.getByTestId("operated").getByText("Simulation").waitFor();
    const stop = tablet.getByRole("button", { name: "STOP THE RUN" });
    const { x, y, width, height } = await stop.boundingBox();
    assert.deepEqual([x, y], [place.x, place.y], "the stop is where it always is");
    assert.ok(height >= 44 && width >= 180);

    const drive = tablet.getByRole("region", { name: "Panel robot.console.drive" });
    const crane = tablet.getByRole("region", { name: "Panel crane.cabin.lever" });
    for (const panel of [drive, crane]) {
      await panel.getByRole("button", { name: "Operate" }).click();
      await panel.getByRole("button", { name: "Stop operating" }).waitFor();
    }
    const is = (wanted, what) =>
      eventually(async () => {
        const now = await speeds(server);
        return Object.entries(wanted).every(([name, value]) =>
          typeof value === "number" ? Math.abs(now[name] - value) < 0.2 : now[name] === value,
        );
      }, what);
    const at = async (panel, right, up) => {
      const box = await panel.getByRole("application").boundingBox();
      return [box.x + (box.width / 2) * (1 + right), box.y + (box.height / 2) * (1 - up)];
    };
    const full = 0.5 / 0.03;

    // Two fingers, each on a stick of its own.
    const fingers = await fingersOn(tablet);
    await fingers.put(1, await at(drive, 0, 0.5));
    await fingers.put(2, await at(crane, 0, 0.5));
    await is({ left: full / 2, right: full / 2, lever: 0.5 }, "both sticks");
    await fingers.put(1, await at(drive, 0, 1.5));
    await is({ left: full, lever: 0.5 }, "beyond the edge");
    await fingers.lift(2);
    await is({ left: full, lever: 0 }, "one is lifted");
    await fingers.cancel();
    await is({ left: 0 }, "the other is taken away by the browser");

    // A finger that was down when the window lost the focus counts again when it is lifted and put down.
    await fingers.put(1, await at(drive, 0, 1));
    await is({ left: full }, "ahead");
    await tablet.evaluate(() => window.dispatchEvent(new Event("blur")));
    await is({ left: 0 }, "the focus is lost");
    await fingers.put(1, await at(drive, 0, 0.9));
    assert.match(await drive.locator("output").innerText(), /forward 0 m\/s/);
    await fingers.lift(1);
    await fingers.put(1, await at(drive, 0, 1));
    await is({ left: full }, "ahead again");

    // A server that cannot be reached.
    await tablet.route(/\/control$/, (route) => route.abort());
    await drive.getByRole("alert").getByText("did not answer").waitFor();
    await is({ left: 0 }, "the controller gives it up");
    await fingers.lift(1);
    await tablet.unroute(/\/control$/);
    for (const panel of [drive, crane])
      if (await panel.getByRole("button", { name: "Operate" }).count())
        await panel.getByRole("button", { name: "Operate" }).click();

    // Keys of the whole page, as each stick shows them.
    await tablet.keyboard.down("w");
    await tablet.keyboard.down("ArrowDown");
    await is({ left: full, lever: -1 }, "letters and arrows");
    await tablet.keyboard.down("Alt");
    await is({ left: 0, lever: 0 }, "no key is relied on while Alt may hide its release");
    for (const key of ["Alt", "w", "ArrowDown"]) await tablet.keyboard.up(key);

    // A gamepad: its stick, its buttons, one that must be held, and its plug.
    await pad([0, 0, 0, 0]);
    await drive.getByText("Gamepad", { exact: true }).click();
    await drive.getByText("Pad of the test").waitFor();
    await pad([0, -1, 0, 0], 0);
    await is({ left: full, horn: true }, "the left stick and the first button");
    await pad(null);
    await is({ left: 0, horn: false }, "it is unplugged");
    await pad([0, -1, 0, 0]);
    await drive.getByLabel("forward", { exact: true }).getByText("-1.00").waitFor({ state: "attached" });
    assert.match(await drive.locator("output").innerText(), /forward 0 m\/s/, "plugged in with its stick pushed");
    await pad([0, 0, 0, 0]);
    // An axis counts after the page has looked at it at rest: a timer of its own, which comes before this later one.
    await tablet.evaluate(() => new Promise((done) => setTimeout(done, 200)));
    await drive.getByLabel("Must be held to move anything").selectOption({ label: "left shoulder" });
    await drive.getByLabel("horn", { exact: true }).selectOption({ label: "right shoulder" });
    await drive.getByText("hold left shoulder").waitFor();
    await pad([0, -1, 0, 0], 5);
    await drive.getByLabel("forward", { exact: true }).getByText("-1.00").waitFor({ state: "attached" });
    assert.match(await drive.locator("output").innerText(), /forward 0 m\/s/);
    await pad([0, -1, 0, 0], 4, 5);
    await is({ left: full, horn: true }, "the button is held");
    await pad([0, -1, 0, 0], 5);
    await is({ left: 0, horn: false }, "it is released");
    await pad(null);

    // Everything can be reached, upright and on its side, and by everybody.
    const objections = [];
    const judge = await judges(tablet, objections);
    for (const [width, height] of [
      [640, 360],
      [390, 844],
      [1440, 900],
    ]) {
      await tablet.setViewportSize({ width, height });
      await judge(`light, ${width}`);
      await button(tablet, "Dark colours").click();
      await judge(`dark, ${width}`);
      await button(tablet, "Dark colours").click();
      const wrong = await tablet.evaluate(() => {
        const small = [...document.querySelectorAll("button, select, summary, .stick")].filter((one) => {
          const { width, height } = one.getBoundingClientRect();
          const least = one.matches(".stick") ? 160 : 44;
          return one.checkVisibility() && (width < least || height < least);
        });
        // The stop is seen however long a message is, and wherever it is scrolled to.
        const [bar, stop, message] = [".operate-bar", ".emergency-stop", ".operate-state"].map((one) =>
          document.querySelector(one),
        );
        const long = document.createElement("p");
        long.textContent = "a long message of a controller ".repeat(40);
        message.append(long);
        bar.scrollTo(0, bar.scrollHeight);
        const place = stop.getBoundingClientRect();
        if (!stop.contains(document.elementFromPoint(place.x + place.width / 2, place.y + place.height / 2))) small.push(stop);
        long.remove();
        return [...small.map((one) => one.outerHTML), ...(document.documentElement.scrollWidth > innerWidth ? ["too wide"] : [])];
      });
      objections.push(...wrong.map((one) => `${width}: ${one}`));
    }
    assert.deepEqual(objections, []);
    await tablet.setViewportSize({ width: 1024, height: 768 });

    // Another page sees who operates; and when this one dies with a finger down, the controller rests by itself.
    const other = await open();
    await other.goto(server.url.replace("/#", "/operate#"));
    await other
      .getByRole("region", { name: "Panel robot.console.drive" })
      .getByText(/Another page operates it/)
      .waitFor();
    await tablet.bringToFront();
    await fingers.put(1, await at(drive, 0, 1));
    await is({ left: full }, "ahead");
    const crashed = tablet.waitForEvent("crash");
    fingers.session.send("Page.crash").catch(() => undefined);
    await crashed;
    const died_ns = (await ask(`/api/runs/${run}`)).t;
    await is({ left: 0 }, "nobody is there");
    await other.getByRole("button", { name: "STOP THE RUN" }).click();
    await other.getByTestId("operated").getByText("ended").waitFor();
    assert.equal(await other.getByRole("button", { name: "Operate" }).count(), 0, "there is nothing to operate");
    const [{ name }] = await ask("/api/recordings");
    const speedsThen = (await ask(`/api/recordings/${name}`)).values["robot.control.wheels.left"];
    const [rested_ns] = speedsThen.find(([t, value]) => t > died_ns - 1e8 && Math.abs(value) < 1e-6);
    // Inputs count for 0.5 s; then come two subsystems of 20 Hz, and the time was asked for a little late.
    assert.ok(rested_ns - died_ns < 0.8e9, `it moved for ${(rested_ns - died_ns) / 1e9} s`);
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
