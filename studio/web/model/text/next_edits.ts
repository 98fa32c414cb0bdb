import { nextPaths, type Behaviour, type Structure } from "../structure/structure";
import { apply, scalarText, YamlText, type TextEdit, type YamlPath } from "./yaml_text";

/** Changes of `next`, one entry at a time: the others keep their layout and comments. */

type Next = Behaviour["next"][number];

const done = ({ yaml }: Structure, edits: readonly TextEdit[]) => apply(yaml.text, edits);

const entryText = ({ to, when }: Next) => (when ? `{ to: ${scalarText(to)}, when: ${scalarText(when)} }` : scalarText(to));

/** Adds an entry after the others. A single unconditional entry is written in short form. */
export function addNext(structure: Structure, behaviour: Behaviour, entry: Next): string {
  const { yaml } = structure;
  const at: YamlPath = [...behaviour.yaml, "next"];
  const text = entryText(entry);
  if (yaml.seq(at)) return done(structure, yaml.append(at, text));
  if (behaviour.next.length === 0) return done(structure, yaml.set(behaviour.yaml, "next", entry.when ? `[${text}]` : text));
  const listed = new YamlText(done(structure, yaml.makeList(at)));
  return apply(listed.text, listed.append(at, text));
}

/** Changes where an entry leads; an empty `when` removes its condition. */
export function changeNext(structure: Structure, behaviour: Behaviour, index: number, change: Partial<Next>): string {
  const { yaml } = structure;
  const at = nextPaths(yaml, behaviour.yaml)[index];
  const old = behaviour.next[index];
  if (!at || !old) return yaml.text;
  const entry = { ...old, ...change };
  if (yaml.map(at) && (entry.when || !isOneLine(yaml, at))) return setFields(yaml, at, change);
  const text = entryText(entry);
  const isItem = typeof at.at(-1) === "number";
  return done(structure, yaml.replace(at, entry.when && !isItem ? `[${text}]` : text));
}

/** A map in one line becomes a name again when it loses its condition. */
const isOneLine = (yaml: YamlText, at: YamlPath) => yaml.map(at)!.flow === true && yaml.line(at) === yaml.endLine(at);

const setFields = (yaml: YamlText, at: YamlPath, change: Partial<Next>): string =>
  Object.entries(change).reduce((now, [key, text]) => new YamlText(apply(now.text, now.set(at, key, text))), yaml).text;

export function removeNext(structure: Structure, behaviour: Behaviour, index: number): string {
  return done(
    structure,
    nextToRemove(structure, behaviour, [index]).flatMap((at) => structure.yaml.remove(at)),
  );
}

/** The parts to remove with entries of `next`: all of it, if none is left. */
export function nextToRemove({ yaml }: Structure, behaviour: Behaviour, entries: readonly number[]): YamlPath[] {
  const paths = nextPaths(yaml, behaviour.yaml);
  if (entries.length === 0) return [];
  return entries.length === paths.length ? [[...behaviour.yaml, "next"]] : entries.map((index) => paths[index]!);
}

/** The names of behaviours in `next`. */
export const nextTargets = ({ yaml }: Structure, behaviour: Behaviour) =>
  nextPaths(yaml, behaviour.yaml).map((at) => yaml.node(yaml.map(at) ? [...at, "to"] : at));
