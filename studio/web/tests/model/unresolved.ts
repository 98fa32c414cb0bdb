import { parse } from "yaml";

/**
 * A small checker of names, written apart from the code under test: it reads the data of a specification, not its text.
 * It returns each name that leads nowhere, as `tessera check` would (E101, E304), and what the world places for agents.
 */

type Data = Record<string, unknown>;
const map = (value: unknown) => (value && typeof value === "object" && !Array.isArray(value) ? value : {}) as Data;
const list = (value: unknown): unknown[] => (Array.isArray(value) ? value : value === undefined || value === null ? [] : [value]);
const texts = (value: unknown): string[] =>
  typeof value === "string" ? [value] : Object.values(Array.isArray(value) ? value : map(value)).flatMap(texts);
const words = (text: string) => text.match(/[A-Za-z_][\w.[\]*+\-/]*/g) ?? [];

export interface Names {
  unresolved: string[];
  /** Words of checks and measures that name a placed model, and models placed for agents. */
  placed: number;
}

export function namesOf(text: string): Names {
  const spec = map(parse(text));
  const unresolved: string[] = [];
  const need = (found: boolean, what: string) => void (found || unresolved.push(what));
  const agents = map(spec.agents);
  const has = (value: unknown, key: string) => key in map(value);

  const bodyOf = (of: unknown): Data => {
    const { use } = map(of);
    if (typeof use !== "string") return map(of);
    need(has(spec.templates, use), `template ${use}`);
    return bodyOf(map(spec.templates)[use]);
  };
  const subsystemsOf = (body: Data): Data => ({
    ...(body.control ? { control: body.control } : {}),
    ...map(body.receptors),
    ...map(body.effectors),
  });
  /** The subsystem of a path, and its third word. */
  const follow = (path: string): [Data | undefined, string, string] => {
    const [agent = "", subsystem = "", name = ""] = path.replace(/\[[^\]]*\]/g, "").split(".");
    need(has(agents, agent), `agent ${path}`);
    const all = subsystemsOf(bodyOf(agents[agent]));
    if (subsystem) need(has(all, subsystem), `subsystem ${path}`);
    return [map(all[subsystem]), name, subsystem];
  };
  const member = (path: string, ...of: string[]) => {
    const [subsystem, name] = follow(path.trim());
    if (name)
      need(
        of.some((key) => has(subsystem?.[key], name)),
        `${of.join(" or ")} ${path}`,
      );
  };
  const type = (written: unknown) => {
    const name = /^[A-Za-z]\w*/.exec(String(map(written).type ?? written))?.[0] ?? "";
    need(/^(bool|u?int(8|16|32|64)|float(32|64)|string)$/.test(name) || has(spec.types, name), `type ${name}`);
  };

  for (const fields of Object.values(map(spec.types))) Object.values(map(fields)).forEach(type);
  for (const of of [...Object.values(map(spec.templates)), ...Object.values(agents)])
    for (const [name, one] of Object.entries(subsystemsOf(bodyOf(of)))) unresolvedIn(name, map(one));
  for (const channel of list(spec.channels)) {
    const [from, to] = typeof channel === "string" ? channel.split("->") : [map(channel).from, map(channel).to];
    member(String(from), "outputs");
    member(String(to), "inputs");
    const { model } = map(channel);
    if (model) need(has(spec.models, String(model)), `model ${String(model)}`);
  }
  const simulation = map(spec.simulation);
  for (const path of [...Object.keys(map(spec.drivers)), ...Object.keys(map(simulation.drivers))]) member(path, "real");
  for (const property of list(spec.properties))
    for (const [kind, value] of Object.entries(map(property)))
      if (kind !== "name") for (const formula of texts(value)) claims(formula);
  if (spec.deploy) deployed(map(map(spec.deploy).processes));
  const placedNames = Object.keys(map(simulation.models)).map((key) => key.replace(/\[.*/, ""));
  const { models: _, drivers: __, checks, measures } = simulation;
  const ofWorld = [...list(checks).flatMap((one) => texts({ ...map(one), name: "" })), ...texts(measures)].flatMap(words);
  return {
    unresolved,
    placed:
      placedNames.filter((name) => has(agents, name)).length +
      ofWorld.filter((word) => placedNames.includes(word.replace(/[[/].*/, ""))).length,
  };

  function claims(formula: string) {
    for (const claim of formula.split(/=>|\band\b|\bor\b/)) {
      const [from, to] = claim.split("->").map((side) => words(side).filter((word) => !/^(not|any|all)$/.test(word)));
      if (to) [member(from![0]!, "outputs"), member(to[0]!, "inputs")];
      else for (const path of from!) member(path, "behaviours", "inputs", "outputs");
    }
  }
  function deployed(processes: Data) {
    const named = Object.values(processes).flatMap((one) =>
      list(Array.isArray(one) || typeof one === "string" ? one : map(one).agents),
    );
    for (const agent of named) follow(String(agent));
    for (const agent of Object.keys(agents))
      need(
        named.some((one) => String(one).replace(/\[.*/, "") === agent),
        `process of ${agent}`,
      );
  }
  function unresolvedIn(name: string, subsystem: Data) {
    for (const key of ["inputs", "outputs", "real", "memory"]) Object.values(map(subsystem[key])).forEach(type);
    for (const key of ["safe", "limits"])
      for (const path of Object.keys(map(subsystem[key]))) need(has(subsystem.real, path.split(".")[0]!), `real ${name}.${path}`);
    const behaviours = map(subsystem.behaviours);
    const start = subsystem.start;
    if (start !== undefined) need(has(behaviours, String(start)), `start ${name}.${String(start)}`);
    for (const [own, value] of Object.entries(behaviours)) {
      const { next, send, receive, terminal, error } = map(value);
      for (const entry of list(next)) {
        const to = String(map(entry).to ?? entry);
        need(to === "end" || has(behaviours, to), `next ${name}.${own} ${to}`);
      }
      for (const buffer of list(send)) need(has(subsystem.outputs, String(buffer)), `send ${name}.${own} ${String(buffer)}`);
      for (const buffer of list(receive)) need(has(subsystem.inputs, String(buffer)), `receive ${name}.${own} ${String(buffer)}`);
      for (const condition of texts([terminal, error, list(next).map((entry) => map(entry).when)]))
        for (const [, base, of] of condition.matchAll(/(?<![\w.])(in|out|memory|parameters)\.(\w+)/g))
          need(
            holders(subsystem, base!).some((holder) => has(holder, of!)),
            `${base}.${of} in ${name}.${own}`,
          );
    }
  }
  function holders(subsystem: Data, base: string): unknown[] {
    if (base === "parameters") return [subsystem.parameters, spec.parameters];
    if (base === "memory") return [subsystem.memory];
    return [base === "in" ? subsystem.inputs : subsystem.outputs, subsystem.real];
  }
}
