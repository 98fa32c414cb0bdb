import { describe, expect, it } from "vitest";
import type { Edit, SubsystemAtEnd, Verdict } from "../../model/protocol";
import type { Api } from "../../live/api";
import { mended, Repairs } from "../../live/repairs";
import { causesOf, circleIn, titleOf, waitsIn } from "../../model/causes";
import { buildMessages, functionAt } from "../../model/text/cpp_function";
import { csvOf } from "../../model/run/csv";
import { candidatesFor } from "../../model/text/repair_edits";
import { readStructure } from "../../model/structure/structure";
import { unitOf } from "../../model/text/units";

const atEnd = (known: Partial<SubsystemAtEnd>): SubsystemAtEnd => ({
  path: "a.control",
  state: "waits",
  awaited: "value",
  behaviour: "",
  channel: "b.control.y->a.control.x",
  from: ["b.control"],
  text: "",
  ...known,
});
const verdict = (name: string, known: Partial<Verdict> = {}): Verdict => ({
  name,
  asks: "",
  verdict: "violated",
  method: "",
  why: "",
  meaning: "",
  explanation: "",
  seconds: 0,
  states: 0,
  warning: false,
  waits: [],
  at_end: [],
  behaviours: [],
  trace: null,
  steps: null,
  narrative: null,
  ...known,
});

describe("causesOf", () => {
  const back = atEnd({ path: "b.control", from: ["a.control"], channel: "a.control.y->b.control.x" });
  it("groups the violations in which the same subsystem waits at the same channel", () => {
    const causes = causesOf([
      verdict("survives_exceptions", { warning: true, at_end: [atEnd({})] }),
      verdict("deadlock_free", { at_end: [atEnd({}), back] }),
      verdict("goes_on", { at_end: [atEnd({})], steps: [1, 2] }),
      verdict("live_behaviours", { behaviours: [{ path: "z.control.rest", line: 3 }] }),
      verdict("safe", { verdict: "holds" }),
    ]);
    expect(causes.map(({ verdicts }) => verdicts.map(({ name }) => name))).toEqual([
      ["goes_on", "deadlock_free", "survives_exceptions"],
      ["live_behaviours"],
    ]);
    expect(causes.map(({ warning }) => warning)).toEqual([false, false]);
    expect(causes[1]!.title).toBe("z.control.rest never runs");
  });
  it("gives the dead behaviours of those who are held up to the cause that holds them up, and no others", () => {
    const channel = (from: string, to: string, blocks: "send" | "receive", timeout = "") => ({
      from,
      to,
      send: blocks === "send" ? ("blocking" as const) : ("non_blocking" as const),
      receive: blocks === "receive" ? ("blocking" as const) : ("non_blocking" as const),
      timeout,
    });
    const channels = [
      channel("b.control.y", "c.control.x", "receive"),
      channel("d[i].control.y", "c.control.z", "send"),
      channel("a.control.y", "e.control.x", "receive", "1 s"),
    ];
    const dead = (...paths: string[]) =>
      verdict("live_behaviours", { behaviours: paths.map((path, at) => ({ path, line: at })) });
    const stuck = verdict("goes_on", { at_end: [atEnd({}), back] });
    const all = causesOf([dead("a.control.rest", "c.control.go", "d[2].control.go"), stuck], channels);
    expect(all.map(({ title }) => title)).toEqual(["a.control and b.control wait for each other"]);
    expect(all[0]!.verdicts.map(({ name }) => name)).toEqual(["goes_on", "live_behaviours"]);
    expect(all[0]!.dead.map(({ path }) => path)).toEqual(["a.control.rest", "c.control.go", "d[2].control.go"]);
    const [circle, other] = causesOf([stuck, dead("c.control.go", "e.control.go")], channels);
    expect(circle!.verdicts.map(({ name }) => name)).toEqual(["goes_on"]);
    expect(circle!.dead.map(({ path }) => path)).toEqual(["c.control.go"]);
    expect(other!.title).toBe("e.control.go never runs");
  });
  it("says in one sentence who is stuck and why", () => {
    expect(circleIn(waitsIn([atEnd({}), back]))).toEqual(["a.control", "b.control"]);
    expect(titleOf([atEnd({}), back])).toBe("a.control and b.control wait for each other");
    expect(titleOf([atEnd({}), atEnd({ path: "b.control", state: "ended", from: [] })])).toBe(
      "a.control waits for b.control, which has ended",
    );
    expect(titleOf([atEnd({ state: "no_successor", behaviour: "go", from: [] })])).toBe(
      "a.control leaves go, and nothing follows",
    );
  });
});

describe("candidatesFor", () => {
  const text =
    "agents:\n  a: { control: { inputs: { x: bool }, behaviours: { go: { terminal: in.x, next: [{ to: rest, when: in.x }] }, rest: { next: go } } } }\n  b: { control: { outputs: { y: bool }, behaviours: { run: {} } } }\nchannels:\n  - { from: b.control.y, to: a.control.x, receive: blocking }\n";
  const of = (one: SubsystemAtEnd) =>
    candidatesFor({ title: "", verdicts: [], atEnd: [one], dead: [], warning: false }, readStructure(text)).map((candidate) => [
      candidate.title,
      ...candidate.edits.map((edit) => JSON.stringify(edit)),
    ]);
  it("gives the side that waits a timeout, or lets it go on", () => {
    expect(of(atEnd({}))).toEqual([
      ["Give up waiting at a.control.x after 1 s", '{"do":"set","at":["channels",0],"key":"timeout","text":"1 s","as":"scalar"}'],
      ["Let a.control.x go on at once", '{"do":"channel","at":["channels",0],"fields":{"receive":"non_blocking"}}'],
    ]);
  });
  it("lets something follow where nothing does", () => {
    const [again] = of(atEnd({ state: "no_successor", behaviour: "go", channel: "", from: [] }));
    expect(again![1]).toContain('"fields":{"to":"go","when":""}');
  });
});

it("a repair mends all of its cause and loses nothing", () => {
  const cause = causesOf([verdict("goes_on", { at_end: [atEnd({})] }), verdict("deadlock_free", { at_end: [atEnd({})] })])[0]!;
  const before = [verdict("goes_on"), verdict("deadlock_free"), verdict("safe", { verdict: "holds" })];
  const after = (lost: string) => before.map((one) => verdict(one.name, { verdict: one.name === lost ? "unknown" : "holds" }));
  expect(mended(cause, before, after(""))).toEqual(["goes_on", "deadlock_free"]);
  expect(mended(cause, before, after("goes_on"))).toEqual([]);
  expect(mended(cause, before, after("safe"))).toEqual([]);
});

it("an edit that mends nothing costs one property, and timeouts are put together last", async () => {
  const channel = (from: string, to: string) => `  - { from: ${from}, to: ${to}, send: blocking, receive: blocking }\n`;
  const agent = (name: string) =>
    `  ${name}: { control: { inputs: { x: bool }, outputs: { y: bool }, behaviours: { run: {} } } }\n`;
  const text = `agents:\n${agent("a")}${agent("b")}channels:\n${channel("a.control.y", "b.control.x")}${channel("b.control.y", "a.control.x")}`;
  const waits = ["a", "b"].map((who, at) => {
    const whom = at === 0 ? "b" : "a";
    const named = { path: `${who}.control`, from: [`${whom}.control`], channel: `${who}.control.y->${whom}.control.x` };
    return atEnd({ ...named, awaited: "acknowledgement" });
  });
  const before = [
    verdict("goes_on", { at_end: waits, steps: [1] }),
    verdict("deadlock_free", { at_end: waits, steps: [1, 2] }),
    verdict("safe", { verdict: "holds" }),
  ];
  const asked: string[][] = [];
  // It holds only if both senders go on at once.
  const goesOn = (edited: string) => !edited.includes("timeout") && !/send: blocking/.test(edited);
  let last = "";
  /** The channels after the edits, as the server would write them: one line each. */
  const edited = (lines: string[], edits: Edit[]) =>
    edits.reduce((all, { at, key, fields }) => {
      const line = all.findIndex((one) => one.startsWith("channels")) + 1 + Number(at![1]);
      const [end = ""] = Object.keys(fields ?? {});
      const after = key
        ? all[line]!.replace(" }", `, ${key}: 1 s }`)
        : all[line]!.replace(`${end}: blocking`, `${end}: non_blocking`);
      return all.with(line, after);
    }, lines);
  const api = {
    edit: async (of: string, edits: Edit[]) => {
      const all = { from: { line: 0, character: 0 }, to: { line: of.split("\n").length, character: 0 } };
      return { edits: [{ ...all, text: edited(of.split("\n"), edits).join("\n") }], files: [] };
    },
    check: async () => ({ diagnostics: [] }),
    verify: async (edited: string, _: string, properties: string[]) => {
      asked.push(properties);
      last = edited;
      return { job: "1" };
    },
    verifyState: async () => ({
      state: "done",
      result: {
        properties: before
          .filter(({ name }) => asked.at(-1)!.includes(name))
          .map((one) => (goesOn(last) ? verdict(one.name, { verdict: "holds" }) : one)),
      },
    }),
  } as unknown as Api;
  const repairs = new Repairs(api);
  await repairs.find(causesOf(before)[0]!, text, before);
  const { found } = repairs.store.get();
  expect(found[0]!.title).toBe("Let a.control.y go on at once; let b.control.y go on at once");
  expect(found[0]!.mends).toEqual(["goes_on", "deadlock_free"]);
  // Four single edits and the first two of them together, before everything else.
  const firstRest = asked.findIndex((names) => names.length > 1);
  expect(asked.slice(0, firstRest).every((names) => names.join() === "goes_on")).toBe(true);
  expect(asked[firstRest]).toEqual(["deadlock_free", "safe"]);
  expect(firstRest).toBeLessThanOrEqual(7);
});

describe("functionAt", () => {
  const source =
    'int x;\nvoid go(Context& c) {\n  // not the end: }\n  log("}", \'}\', 1\'000, R"(})");\n  if (x) { y(); }\n}\nvoid other();\n';
  it("ends where the body ends, whatever is in strings and comments", () => {
    const found = functionAt(source, 2)!;
    expect([found.firstLine, found.lastLine]).toEqual([2, 6]);
    expect(source.slice(found.from, found.to)).toBe(found.text);
    expect(found.text.endsWith("y(); }\n}")).toBe(true);
  });
  it("finds no body of a declaration, or beyond the end", () => {
    expect(functionAt(source, 7)).toBeNull();
    expect(functionAt(source, 70)).toBeNull();
  });
});

it("messages of a build are found by their file, with their hints", () => {
  // Messages as `tessera simulate` prints them, and a message of the compiler itself.
  const build = `src/robot/control.cpp:12:25: error E501: robot.control has no input 'rom'
   12 |   const bool known = in.rom.valid && in.scan.known && in.scan.age < std::chrono::milliseconds(300);
      |                         ^~~
hint: declare it in the specification under \`inputs\`
src/robot/base.cpp:6:84: error E501: robot.base has no input 'motin'
    6 | void drive(Context& context, const Inputs& in, Memory& memory, Outputs& out) { out.command = in.motin; }
      |                                                                                                 ^~~~~
hint: did you mean 'motion'?
src/robot/control.cpp:22:10: error E501: robot.control has no memory 'fre'
   22 |   memory.fre = room.free_m;
      |          ^~~
hint: did you mean 'free'?
/home/x/p/src/robot/control.cpp:13:1: warning: odd
src/robot/control.cpp:24:1: error E507: the function 'drive' of robot.control has other parameters
the whole output of the compiler: /home/x/p/.tessera/build/release/compiler.log
tessera: error: the controller was not built`;
  const all = buildMessages(build.split("\n"), "src/robot/control.cpp");
  expect(all.map(({ line, column, severity, code, text, hint }) => [line, column, severity, code, text, hint])).toEqual([
    [12, 25, "error", "E501", "robot.control has no input 'rom'", "declare it in the specification under `inputs`"],
    [22, 10, "error", "E501", "robot.control has no memory 'fre'", "did you mean 'free'?"],
    [13, 1, "warning", "", "odd", ""],
    [24, 1, "error", "E507", "the function 'drive' of robot.control has other parameters", ""],
  ]);
  expect(buildMessages(build.split("\n"), "src/robot/base.cpp")).toHaveLength(1);
});

it("a table has a row for each time, with the values that hold then", () => {
  const series = [
    { path: "a", samples: { times: [1e9, 3e9], values: [1, 2] } },
    { path: "b", samples: { times: [2e9], values: [5] } },
  ];
  expect(csvOf(series)).toBe("time_s,a,b\n1.000000000,1,\n2.000000000,1,5\n3.000000000,2,5\n");
});

const typed =
  "types:\n  Speed: { linear: float64 m/s, SpeedUp: bool }\n  Both: { one: Speed }\nparameters: { v: 1 m/s }\nagents:\n  a: { control: { inputs: { s: Speed, all: 'Speed[3]' }, behaviours: { go: { terminal: in.s.linear > parameters.v } } } }\n";

it("a value has the unit of its type", () => {
  const structure = readStructure(typed);
  expect(unitOf(structure, "a.control.s.linear")).toBe("m/s");
  expect(unitOf(structure, "a[2].control.all[1].linear")).toBe("m/s");
  expect(unitOf(structure, "a.control.s.SpeedUp")).toBe("");
  expect(unitOf(structure, "nobody.control.s")).toBe("");
});
