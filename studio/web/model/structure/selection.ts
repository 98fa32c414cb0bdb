import type { Direction } from "./structure";

/** The texts that select an element of a structure. */

/** The path in the drawing: `robot[3].control` is drawn as `robot.control`. */
export const withoutIndex = (path: string) => path.replace(/\[[^\]]*\]/g, "");

/** A template is selected and shown like an agent of this name. */
export const templatePath = (name: string) => `template:${name}`;

export const channelPath = (index: number) => `channel:${index}`;

export const bufferSelection = (direction: Direction, path: string) => `${direction}:${path}`;

/** An entry of `next` of a behaviour, which is an arrow in the drawing. */
export const nextSelection = (behaviour: string, entry: number) => `next:${behaviour}#${entry}`;

/** The number of the entry of `next` that is selected; undefined: another element is. */
export const nextEntryOf = (selection: string): number | undefined => {
  const [, entry] = /^next:.*#([0-9]+)$/.exec(selection) ?? [];
  return entry === undefined ? undefined : Number(entry);
};

/**
 * The path in the drawing of what is selected: that of a buffer without its direction, of an entry of `next` that of its
 * behaviour.
 */
export const selectedPath = (selection: string) =>
  nextEntryOf(selection) === undefined
    ? selection.replace(/^(input|output|real):/, "")
    : selection.replace(/^next:|#[0-9]+$/g, "");
