// A deployed system whose processes really run on this machine, and a studio that watches them.
import assert from "node:assert/strict";
import { spawn } from "node:child_process";
import { existsSync, readFileSync } from "node:fs";
import { join } from "node:path";
import { test } from "node:test";
import { environment, example, onBuilt } from "./page.mjs";

/** Checks until it holds; the time depends on the load of the machine. */
async function until(holds, what) {
  const end = Date.now() + 120_000;
  while (!holds()) {
    assert.ok(Date.now() < end, `waited in vain: ${what}`);
    await new Promise((done) => setTimeout(done, 50));
  }
}

test("all processes of a deployment are watched on one page, which shows who is gone and who waits for it", () =>
  onBuilt(example("11_crossing_apart"), async (page, server) => {
    const options = ["--on-failure", "go-on", "--for", "300s", "--domain", String(1 + (process.pid % 230))];
    const run = spawn(environment.tessera, ["run", server.root, "--deploy", ...options], {
      env: environment.env,
      stdio: "ignore",
    });
    const ended = new Promise((done) => run.once("exit", done));
    const file = join(server.root, ".tessera/last/deployment.json");
    const processes = () => JSON.parse(readFileSync(file, "utf8")).processes;
    const pidOf = (name) =>
      processes()
        .find((one) => one.name === name)
        .starts.at(-1).pid;
    const alive = (name) => existsSync(`/proc/${pidOf(name)}`);
    try {
      await until(() => existsSync(file) && processes().every((one) => one.starts.length > 0), "the processes start");
      await page.getByRole("tab", { name: "Fleet" }).click();
      await page.getByRole("button", { name: "Watch all processes" }).click();
      await page.getByText("3 of 3 processes run on this machine").waitFor();
      await page.getByTestId("process-rover[1]").getByText("robot[1].odometry").waitFor();
      await page.getByTestId("process-rover[1]").getByText("measure").waitFor();
      await page
        .getByRole("cell", { name: /± .* ms/ })
        .first()
        .waitFor();
      assert.equal(await page.locator(".fleet-links tbody tr").count(), 4);

      process.kill(pidOf("gate"), "SIGKILL");
      await page
        .getByTestId("process-gate")
        .getByText(/^gone for/)
        .waitFor();
      await page.getByText("robot[0].control waits for crossing.control").first().waitFor();
      await page.getByText("process gate is gone").first().waitFor();
      await page
        .getByText(/disconnected for/)
        .first()
        .waitFor();

      // The other views show all processes, too.
      await page.getByRole("tab", { name: "Structure" }).click();
      // From afar, the behaviours are not drawn.
      await page.locator(".chip.running", { hasText: "measure" }).first().waitFor({ state: "attached" });
      await page.reload();
      await page.getByRole("tab", { name: "Fleet" }).click();
      await page.getByText("2 of 3 processes run on this machine").waitFor();
      await page.getByTestId("fleet").getByRole("button", { name: "Stop watching" }).click();
      await page.getByText("let go; they run on").waitFor();
      await server.kill();
      assert.ok(alive("rover[0]") && alive("rover[1]"), "a studio that dies disturbs nobody");
    } finally {
      run.kill("SIGINT");
      await ended;
    }
  }));
