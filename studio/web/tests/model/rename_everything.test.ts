import { readdirSync, readFileSync } from "node:fs";
import { expect, it } from "vitest";
import { readStructure, readTemplate, type Structure } from "../../model/structure/structure";
import * as renames from "../../model/text/renames";
import { namesOf } from "./unresolved";

/** Every name of every example gets a new name: the new specification has no name that leads nowhere. */

const folders = ["../../../../examples", "../e2e/projects"].flatMap((folder) => {
  const at = new URL(`${folder}/`, import.meta.url);
  // One project has mistakes on purpose.
  return readdirSync(at)
    .filter((name) => name !== "broken")
    .map((name) => ({ name, file: new URL(`${name}/spec.yaml`, at) }));
});

interface Renaming {
  title: string;
  rename: (structure: Structure, from: string, to: string) => string;
  name: string;
}

/** Every element with a name, found again by its name after another renaming. */
function renamings(structure: Structure): Renaming[] {
  const { yaml } = structure;
  const text = (now: Structure) => now.yaml.text;
  const templates = yaml.keys(["templates"]).flatMap((name) => readTemplate(structure, name) ?? []);
  const keys = (part: string, rename: Renaming["rename"]) => yaml.keys([part]).map((name) => ({ title: part, name, rename }));
  return [
    ...keys("agents", (now, from, to) =>
      renames.renameAgent(
        now,
        now.agents.find(({ name }) => name === from)!,
        to,
      ),
    ),
    ...keys("types", (now, from, to) => renames.renameType(text(now), from, to)),
    ...keys("parameters", (now, from, to) => renames.renameParameter(text(now), from, to)),
    ...keys("templates", (now, from, to) => renames.renameUsed(text(now), "templates", from, to)),
    ...keys("models", (now, from, to) => renames.renameUsed(text(now), "models", from, to)),
    ...[...structure.agents, ...templates].flatMap((agent) =>
      agent.subsystems.flatMap((one) => within(agent.name, one.name, structure)),
    ),
  ];
}

const found = (structure: Structure, agent: string, subsystem: string) =>
  (agent.startsWith("template:")
    ? readTemplate(structure, agent.slice(9))!
    : structure.agents.find(({ name }) => name === agent)!
  ).subsystems.find(({ name }) => name === subsystem)!;

function within(agent: string, subsystem: string, structure: Structure): Renaming[] {
  const title = `${agent}.${subsystem}`;
  const { kind, behaviours, buffers, yaml } = found(structure, agent, subsystem);
  const at = (now: Structure) => found(now, agent, subsystem);
  const cells = (["memory", "parameters"] as const).flatMap((part) =>
    structure.yaml.keys([...yaml, part]).map((name) => ({
      title: `${title}.${part}`,
      name,
      rename: (now: Structure, from: string, to: string) => renames.renameCell(now, at(now), part, from, to),
    })),
  );
  return [
    ...(kind === "control"
      ? []
      : [
          {
            title,
            name: subsystem,
            rename: (now: Structure, from: string, to: string) => renames.renameSubsystem(now, found(now, agent, from), to),
          },
        ]),
    ...behaviours.map(({ name }) => ({
      title: `${title} behaviour`,
      name,
      rename: (now: Structure, from: string, to: string) =>
        renames.renameBehaviour(
          now,
          at(now),
          at(now).behaviours.find((one) => one.name === from)!,
          to,
        ),
    })),
    ...buffers.map(({ name, direction }) => ({
      title: `${title} ${direction}`,
      name,
      rename: (now: Structure, from: string, to: string) =>
        renames.renameBuffer(
          now,
          at(now),
          at(now).buffers.find((one) => one.name === from && one.direction === direction)!,
          to,
        ),
    })),
    ...cells,
  ];
}

it.each(folders)("$name", ({ file }) => {
  const before = readFileSync(file, "utf8");
  const structure = readStructure(before);
  const names = namesOf(before);
  expect(names.unresolved).toEqual([]);
  const all = renamings(structure);
  expect(all.length).toBeGreaterThan(3);
  for (const { title, name, rename } of all) {
    const about = `${title} ${name}`;
    const after = rename(structure, name, "renamed_here");
    expect(after, about).toContain("renamed_here");
    expect(namesOf(after), about).toEqual(names);
    // The way back leads to the same text: nothing else was touched, and no name was there twice.
    expect(rename(readStructure(after), "renamed_here", name), about).toBe(before);
  }
});
