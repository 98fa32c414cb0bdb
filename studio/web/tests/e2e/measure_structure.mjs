// The time from the request of the page to the first drawing of the structure, with the load of the machine.
import { loadavg } from "node:os";
import { example, folder, onPage } from "./page.mjs";

const systems = {
  "line follower": example("01_line_follower"),
  depot: example("05_depot"),
  orchard: folder("orchard"),
  "eight agents with long names": folder("long_names"),
};

export async function measureStructure() {
  for (const [name, project] of Object.entries(systems))
    await onPage(project, async (page, server, open) => {
      const times = [];
      for (let turn = 0; turn < 3; turn += 1) {
        const other = await open();
        await other.goto(server.url);
        times.push(
          await other.evaluate(
            () =>
              new Promise((done) => {
                const look = () =>
                  document.querySelector(".agent-title") ? done(Math.round(performance.now())) : requestAnimationFrame(look);
                look();
              }),
          ),
        );
        await other.close();
      }
      console.log(`${name}: first drawing of the structure after ${times.join(", ")} ms, load ${loadavg()[0].toFixed(1)}`);
    });
}
