/** All keys of the page in one table: the handlers of keys and the page of shortcuts both read it. */

interface Row {
  /** "Mod": Ctrl, or Cmd on a Mac. */
  keys: readonly string[];
  text: string;
}

/** Keys that work everywhere on the page, but not while a letter would be typed into a field. */
const everywhere = {
  search: { keys: ["Mod-k"], text: "find anything by parts of its path" },
  save: { keys: ["Mod-s"], text: "save" },
  undo: { keys: ["Mod-z"], text: "undo" },
  redo: { keys: ["Mod-Shift-z", "Mod-y"], text: "redo" },
  help: { keys: ["?"], text: "show this help" },
} satisfies Record<string, Row>;

/** Keys of the drawing of the net, while it has the focus. */
const net = {
  left: { keys: ["ArrowLeft"], text: "to the element on the left" },
  right: { keys: ["ArrowRight"], text: "to the element on the right" },
  up: { keys: ["ArrowUp"], text: "to the element above" },
  down: { keys: ["ArrowDown"], text: "to the element below" },
  enter: { keys: ["Enter", "Space"], text: "into the selected page; in the token game, fire the selected transition" },
  leave: { keys: ["Escape", "Backspace"], text: "out of the page" },
  fold: { keys: ["f"], text: "fold or unfold the selected page" },
  nearer: { keys: ["+", "="], text: "zoom in" },
  farther: { keys: ["-"], text: "zoom out" },
  whole: { keys: ["0"], text: "show the whole system" },
} satisfies Record<string, Row>;

/** Keys of the text; the editor of the text has them. */
const text = {
  propose: { keys: ["Ctrl-Space"], text: "propose what fits here" },
  accept: { keys: ["Tab"], text: "take the first proposal" },
  definition: { keys: ["F12"], text: "go to the definition" },
  more: { keys: ["Mod-]"], text: "indent more" },
  less: { keys: ["Mod-["], text: "indent less" },
  find: { keys: ["Mod-f"], text: "find in the text" },
} satisfies Record<string, Row>;

export const shortcuts = { everywhere, net, text };
export type ShortcutGroup = keyof typeof shortcuts;
export type ShortcutOf<Group extends ShortcutGroup> = keyof (typeof shortcuts)[Group];

export const groupTitles: Record<ShortcutGroup, string> = {
  everywhere: "Everywhere",
  net: "In the drawing of the net",
  text: "In the text",
};

interface Pressed {
  key: string;
  ctrlKey: boolean;
  metaKey: boolean;
  altKey: boolean;
  shiftKey: boolean;
}

/** The parts of "Mod-Shift-z"; the key itself may be "-". */
function partsOf(keys: string): { modifiers: string[]; key: string } {
  const found = /^((?:(?:Mod|Ctrl|Shift|Alt)-)*)(.+)$/.exec(keys)!;
  return { modifiers: found[1]!.split("-").filter(Boolean), key: found[2]! };
}

function isPressed(event: Pressed, keys: string): boolean {
  const { modifiers, key } = partsOf(keys);
  const mod = modifiers.includes("Mod") || modifiers.includes("Ctrl");
  if ((event.ctrlKey || event.metaKey) !== mod || event.altKey !== modifiers.includes("Alt")) return false;
  // Signs such as ? and + need Shift on some keyboards.
  if (/^[a-z]$/.test(key) && event.shiftKey !== modifiers.includes("Shift")) return false;
  const pressed = event.key === " " ? "Space" : event.key.length === 1 ? event.key.toLowerCase() : event.key;
  return pressed === key;
}

/** The shortcut of a group that is pressed. */
export function shortcutOf<Group extends ShortcutGroup>(group: Group, event: Pressed): ShortcutOf<Group> | undefined {
  const rows = Object.entries(shortcuts[group] as Record<string, Row>);
  return rows.find(([, { keys }]) => keys.some((one) => isPressed(event, one)))?.[0] as ShortcutOf<Group> | undefined;
}

const signs: Record<string, string> = {
  ArrowLeft: "←",
  ArrowRight: "→",
  ArrowUp: "↑",
  ArrowDown: "↓",
  Escape: "Esc",
  Mod: "Ctrl",
};

/** The keys of a shortcut as a keyboard names them: ["Ctrl", "Shift", "Z"]. */
export function keysInWords(keys: string): string[] {
  const { modifiers, key } = partsOf(keys);
  return [...modifiers, key].map((one) => signs[one] ?? (one.length === 1 ? one.toUpperCase() : one));
}
