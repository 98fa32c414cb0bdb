// Measures the cost of watching a controller with the studio: the line follower with its world, at full
// speed.
//
//     node benchmarks/watched.mjs build/release/tessera [rounds] [simulated seconds]
//
// Each round runs the same controller four times: plain (`simulate`), controlled without a client, watched by
// the studio with one event stream that reads its recording from disk, and the same through the control
// socket. The wall time of the last three is that from `resume` to the end of the process; CPU time is that
// of the controller alone.
import { spawn } from "node:child_process";
import { cpSync, mkdtempSync, readFileSync, readdirSync, rmSync } from "node:fs";
import { connect } from "node:net";
import { tmpdir } from "node:os";
import { join, resolve } from "node:path";

const tessera = resolve(process.argv[2] ?? "build/release/tessera");
const rounds = Number(process.argv[3] ?? 7), seconds = Number(process.argv[4] ?? 600);
const folder = mkdtempSync(join(tmpdir(), "watched-")), project = join(folder, "project");
process.env.XDG_RUNTIME_DIR = folder;
cpSync(new URL("../examples/01_line_follower", import.meta.url), project, { recursive: true });

const ended = (child) => new Promise((done) => child.on("close", done));
const moment = () => new Promise((done) => setTimeout(done, 2));
const first = (list) => (list.length > 0 ? list[0] : null);
async function until(what) {
  for (;;) {
    const found = await what();
    if (found) return found;
    await moment();
  }
}

/** The command line of the controller, as `tessera simulate` starts it. */
async function commandOfController() {
  const parent = spawn(tessera, ["simulate", project, "--for", "1000000s"], { stdio: "ignore" });
  const words = await until(() => {
    const children = readFileSync(`/proc/${parent.pid}/task/${parent.pid}/children`, "utf8").trim().split(" ");
    const lines = children.filter(Boolean).map((child) => readFileSync(`/proc/${child}/cmdline`, "utf8").split("\0"));
    return lines.find((line) => line[0].endsWith("/controller"));
  });
  parent.kill("SIGINT");
  await ended(parent);
  return words.filter((word, index) => word !== "" && word !== "--for" && words[index - 1] !== "--for");
}

/** A controller, which begins when `go` is called; wall and CPU time in seconds. */
async function run(command, begin) {
  const child = spawn("bash", ["-c", '"$@"; times', "-", ...command, "--for", `${seconds}s`], { stdio: ["ignore", "pipe", "inherit"] });
  let said = "";
  child.stdout.on("data", (bytes) => (said += bytes));
  const start = begin ? await begin() : performance.now();
  await ended(child);
  const wall = (performance.now() - start) / 1000;
  const [user, system] = said.trim().split("\n").at(-1).split(" ").map((time) => {
    const [, minutes, rest] = /(\d+)m([\d.]+)s/.exec(time);
    return 60 * Number(minutes) + Number(rest);
  });
  return { wall, cpu: user + system };
}

const sockets = () => {
  try {
    return readdirSync(join(folder, "tessera")).filter((name) => name.endsWith(".sock"));
  } catch {
    return [];
  }
};
/** Makes the waiting controller go on. */
const resume = async () => {
  const name = await until(() => first(sockets()));
  const socket = connect(join(folder, "tessera", name));
  await until(() => socket.readyState === "open");
  socket.on("error", () => undefined);
  const start = performance.now();
  socket.end('{"command":"resume"}\n');
  socket.resume();
  return start;
};

async function studio() {
  const child = spawn(tessera, ["studio", project, "--no-browser", "--port", "0"], { stdio: ["ignore", "pipe", "inherit"] });
  let said = "";
  child.stdout.on("data", (bytes) => (said += bytes));
  const [, address, token] = await until(() => /(http:\/\/[\d.:]+).*token=(\w+)/.exec(said));
  const ask = async (path, body) => {
    const answer = await fetch(address + path, {
      method: body ? "POST" : "GET",
      headers: { Authorization: `Bearer ${token}` },
      body: body && JSON.stringify(body),
    });
    return answer.json();
  };
  const counted = { batches: 0, shown: 0, dropped: 0 };
  const stream = await fetch(`${address}/api/events?token=${token}`);
  void (async () => {
    let text = "";
    for await (const bytes of stream.body) {
      text += Buffer.from(bytes).toString();
      const whole = text.lastIndexOf("\n\n") + 2;
      for (const event of text.slice(0, whole).split("\n\n").filter((one) => one.startsWith("event: firings"))) {
        const data = JSON.parse(event.slice(event.indexOf("data: ") + 6));
        counted.batches++;
        counted.shown += data.firings.length;
        counted.dropped += data.dropped;
      }
      text = text.slice(whole);
    }
  })().catch(() => undefined);
  const watch = async () => {
    const name = await until(() => first(sockets()));
    const { run: id } = await until(async () => {
      const answer = await ask("/api/runs", { kind: "attach", socket: name });
      return answer.run ? answer : null;
    });
    await until(async () => (await ask(`/api/runs/${id}`)).state === "paused");
    const start = performance.now();
    await ask(`/api/runs/${id}/control`, { command: "resume" });
    return start;
  };
  // The unit is clock ticks, of which there are 100 a second.
  const cpu = () => readFileSync(`/proc/${child.pid}/stat`, "utf8").split(") ")[1].split(" ").slice(11, 13).reduce((sum, ticks) => sum + Number(ticks) / 100, 0);
  return { watch, counted, cpu, close: () => (child.kill("SIGINT"), ended(child)) };
}

const median = (numbers) => [...numbers].sort((a, b) => a - b)[Math.floor(numbers.length / 2)];
const command = await commandOfController();
const controlled = [...command, "--controlled", "--speed=0", "--paused"];
const elsewhere = controlled.map((word, index) => (controlled[index - 1] === "--record" ? join(folder, "elsewhere.tsr") : word));
const server = await studio();
const kinds = {
  plain: () => run(command),
  "nobody there": () => run(controlled, resume),
  "watched, from disk": () => run(controlled, server.watch),
  "watched, through the socket": () => run(elsewhere, server.watch),
};
const measured = Object.fromEntries(Object.keys(kinds).map((kind) => [kind, []]));
for (let round = 0; round < rounds; round++)
  for (const [kind, once] of Object.entries(kinds)) {
    measured[kind].push(await once());
    await until(() => sockets().length === 0);
  }
const cpuOfStudio = server.cpu();
await server.close();
rmSync(folder, { recursive: true });
const base = measured["nobody there"];
for (const [kind, times] of Object.entries(measured)) {
  const of = (what) => {
    const ratio = median(times.map((time, round) => time[what] / base[round][what]));
    return `${median(times.map((time) => time[what])).toFixed(3)} s (${times.map((time) => time[what].toFixed(2)).join(" ")}), ${((ratio - 1) * 100).toFixed(1)} %`;
  };
  console.log(`${kind.padEnd(28)} wall ${of("wall")}; CPU ${of("cpu")}`);
}
console.log(`${server.counted.batches} batches, ${server.counted.shown} firings shown, ${server.counted.dropped} counted only; studio: ${cpuOfStudio.toFixed(2)} s of CPU`);
process.exit(0);
