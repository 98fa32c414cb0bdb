// Runs of the fixture server: the net is played at random but by its rules, at the speed asked for; nothing is compiled.
import { randomBytes } from "node:crypto";

export function addRuns(state) {
  const { runs, send } = state;
  const recordings = new Map();
  const info = ({ run, state: now, why, marking }) => ({ run, state: now, why, marking: marked(marking), net_hash: "" });
  const marked = (marking) => [...marking.entries()].filter(([, tokens]) => tokens > 0).map(([place]) => place);

  async function start(_, request) {
    const run = randomBytes(3).toString("hex");
    const { net } = await state.analyse(state.text());
    const it = {
      run,
      net,
      state: "building",
      why: "",
      marking: net.flat.places.map((place) => place.tokens),
      t: 0,
      speed: request.speed ?? 1,
      paused: Boolean(request.paused),
      firings: [],
      breakpoints: [],
    };
    runs.set(run, it);
    const tell = (now, why = "") => {
      it.state = now;
      it.why = why;
      send("run", { run, state: now, why });
    };
    it.tell = tell;
    setTimeout(() => {
      for (const line of ["[1/3] generating the controller", "[2/3] compiling", "[3/3] linking"]) send("build", { run, line });
      tell(it.paused ? "paused" : "running");
      it.timer = setInterval(() => it.paused || advance(it, Math.max(1, Math.round(4 * it.speed))), 40);
    }, 300);
    return [202, { run }];
  }

  const can = (it) =>
    it.net.flat.transitions.flatMap((one, index) =>
      one.condition?.truth !== "never" && one.inputs.every((arc) => it.marking[arc.place] > 0) ? [index] : [],
    );

  function advance(it, count) {
    const firings = [];
    for (let step = 0; step < count; step += 1) {
      const active = can(it);
      if (active.length === 0) break;
      const chosen = active[Math.floor(Math.random() * active.length)];
      const { inputs, outputs } = it.net.flat.transitions[chosen];
      for (const arc of inputs) it.marking[arc.place] -= 1;
      for (const arc of outputs) it.marking[arc.place] += 1;
      it.t += 4_000_000;
      firings.push([it.t, chosen]);
      if (outputs.some((arc) => it.breakpoints.includes(arc.place))) {
        it.paused = true;
        it.tell("paused", "breakpoint");
        break;
      }
    }
    it.firings.push(...firings);
    const seconds = it.t / 1e9;
    send("firings", { run: it.run, t: it.t, dropped: 0, firings, marking: marked(it.marking) });
    send("values", {
      run: it.run,
      t: it.t,
      values: {
        "robot.sensor.line": { left: Math.sin(3 * seconds) > 0.4, middle: true, right: Math.sin(3 * seconds) < -0.4 },
        "robot.control.motion": { linear: 0.2, angular: 2 * Math.sin(3 * seconds) },
      },
    });
    send("pose", {
      run: it.run,
      t: it.t,
      x: Math.cos(seconds / 2),
      y: 0.6 * Math.sin(seconds / 2) + 0.03 * Math.sin(9 * seconds),
      heading: seconds / 2 + Math.PI / 2,
    });
  }

  function control([run], { command, value, breakpoints }) {
    const it = runs.get(run);
    if (!it) return [404, { error: "no such run" }];
    if (command === "pause") ((it.paused = true), it.tell("paused"));
    if (command === "resume") ((it.paused = false), it.tell("running"));
    if (command === "step_firing") advance(it, 1);
    if (command === "step_iteration") advance(it, 12);
    if (command === "speed") it.speed = value;
    if (command === "breakpoints") it.breakpoints = breakpoints.map((one) => one.place);
    if (command === "stop") {
      clearInterval(it.timer);
      recordings.set(`${run}.tsr`, it);
      it.tell("ended", "stopped");
    }
    return {};
  }

  state.extra = [
    ["POST", /^\/api\/runs$/, start],
    ["GET", /^\/api\/runs$/, () => [...runs.values()].map(info)],
    ["GET", /^\/api\/runs\/(\w+)$/, ([run]) => info(runs.get(run))],
    ["POST", /^\/api\/runs\/(\w+)\/control$/, control],
    [
      "GET",
      /^\/api\/recordings$/,
      () =>
        [...recordings].map(([name, it]) => ({
          name,
          bytes: it.firings.length * 24,
          modified: Date.now(),
          system: "s",
          duration: it.t / 1e9,
        })),
    ],
    [
      "GET",
      /^\/api\/recordings\/(.+)$/,
      ([name]) => ({ net_hash: "", subsystems: [], firings: recordings.get(name).firings, values: {} }),
    ],
  ];
}
