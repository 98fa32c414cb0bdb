// The arrangement of a user is there on another port, and a change that the server has not heard of is not lost.
import { expect, test } from "vitest";
import { Arrangement } from "../../live/arrangement";

/** The storage of a browser for one port. */
class Browser {
  private readonly texts = new Map<string, string>();
  getItem = (key: string) => this.texts.get(key) ?? null;
  setItem = (key: string, text: string) => void this.texts.set(key, text);
  removeItem = (key: string) => void this.texts.delete(key);
}

class Server {
  entries: Record<string, string> = {};
  sent = 0;
  gone = false;
  arrangement = () => (this.gone ? Promise.reject(new Error("gone")) : Promise.resolve({ entries: { ...this.entries } }));
  arrange = (name: string, text: string) => {
    if (this.gone) return Promise.reject(new Error("gone"));
    this.sent += 1;
    this.entries[name] = text;
    return Promise.resolve({ kept: true });
  };
}

const settled = () => new Promise((done) => setTimeout(done, 0));

async function pageOn(server: Server, browser = new Browser()) {
  const page = new Arrangement(server, browser);
  await page.load();
  return page;
}

test("another port has the panels and plots of the project, and nothing else", async () => {
  const server = new Server();
  const first = await pageOn(server);
  first.setItem("tessera.panels /p/spec.yaml", "a");
  first.setItem("tessera.panels /p/spec.yaml", "b");
  first.setItem("tessera.plots:/p/spec.yaml", "c");
  first.setItem("tessera.visited", "1");
  await settled();
  expect(server.entries).toEqual({ panels: "b", plots: "c" });
  expect(server.sent).toBe(3);
  const other = await pageOn(server);
  expect(other.getItem("tessera.panels /p/spec.yaml")).toBe("b");
  expect(other.getItem("tessera.plots:/p/spec.yaml")).toBe("c");
  expect(other.getItem("tessera.visited")).toBeNull();
});

test("a browser whose last change has not reached the server has the newer text", async () => {
  const server = new Server();
  const browser = new Browser();
  const page = await pageOn(server, browser);
  page.setItem("tessera.panels /p/spec.yaml", "old");
  await settled();
  server.gone = true;
  page.setItem("tessera.panels /p/spec.yaml", "new");
  await settled();
  server.gone = false;
  const again = await pageOn(server, browser);
  expect(again.getItem("tessera.panels /p/spec.yaml")).toBe("new");
  again.setItem("tessera.panels /p/spec.yaml", "newer");
  await settled();
  server.entries.panels = "of another port";
  expect((await pageOn(server, browser)).getItem("tessera.panels /p/spec.yaml")).toBe("of another port");
});
