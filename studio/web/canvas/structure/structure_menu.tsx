import { useEffect, useLayoutEffect, useRef, useState, type KeyboardEvent } from "react";
import { createPortal } from "react-dom";
import type { ElementEdits } from "../../live/element_edits";
import type { Studio } from "../../live/studio";
import { kindName } from "../../model/structure/copied";
import { findThing, nextEntryOf, selectedPath, withoutIndex, type Structure, type Thing } from "../../model/structure/structure";

/** The commands for an element: the menu of a right click, of Shift F10, and of the button at the element. */

export interface Item {
  title: string;
  /** The keys that do the same. */
  keys?: string;
  act: () => unknown;
  /** It loses something. */
  danger?: boolean;
}

export interface OpenMenu {
  /** The element; null: the system. */
  path: string | null;
  /** On the screen. */
  x: number;
  y: number;
}

export interface MenuActions {
  /** Opens the form for an entry of `next` that begins at a behaviour. */
  leadOn: (behaviour: string) => void;
  /** Gives up the moves of boxes; undefined: none was moved. */
  arrange: (() => unknown) | undefined;
}

/** Focuses a field of the form at the side, once the form is there. */
function focusForm(selector: string): void {
  const until = performance.now() + 3000;
  const look = () => {
    const found = document.querySelector<HTMLElement>(`.inspect ${selector}`);
    if (found) {
      found.scrollIntoView({ block: "center" });
      found.focus();
      if (found instanceof HTMLInputElement) found.select();
    } else if (performance.now() < until) requestAnimationFrame(look);
  };
  requestAnimationFrame(look);
}

/** Selects an element and focuses the field with its name. */
export function renameInForm(studio: Studio, path: string, structure: Structure): void {
  studio.choose(path, structure);
  focusForm("input[type=text]");
}

const addItems = (elements: ElementEdits, thing: Thing): Item[] => {
  switch (thing.kind) {
    case "agent":
    case "template": {
      const { of } = thing;
      if (of.included) return [];
      const control = of.subsystems.some(({ kind }) => kind === "control");
      return [
        ...(control ? [] : [{ title: "Add control subsystem", act: () => elements.addSubsystem(of, "control") }]),
        { title: "Add virtual receptor", act: () => elements.addSubsystem(of, "receptor") },
        { title: "Add virtual effector", act: () => elements.addSubsystem(of, "effector") },
      ];
    }
    case "subsystem": {
      const { of } = thing;
      return [
        { title: "Add behaviour", act: () => elements.addBehaviour(of, false) },
        { title: "Add group of behaviours", act: () => elements.addBehaviour(of, true) },
        { title: "Add input", act: () => elements.addBuffer(of, "input") },
        { title: "Add output", act: () => elements.addBuffer(of, "output") },
        ...(of.kind === "control" ? [] : [{ title: "Add real buffer", act: () => elements.addBuffer(of, "real") }]),
      ];
    }
    case "behaviour":
      if (!thing.of.isGroup || thing.of.template) return [];
      return [{ title: "Add behaviour", act: () => elements.addBehaviour(thing.of, false) }];
    default:
      return [];
  }
};

/** The items of the menu of an element, in parts. */
export function itemsFor(studio: Studio, structure: Structure, path: string | null, actions: MenuActions): Item[][] {
  const { elements } = studio;
  const arrange = actions.arrange ? [{ title: "Arrange automatically", act: actions.arrange }] : [];
  const paste = { title: "Paste", keys: "Ctrl V", act: () => elements.pasteFromClipboard() };
  const thing = path === null ? undefined : findThing(structure, withoutIndex(path));
  if (path === null || !thing) return [[{ title: "Add agent", act: () => elements.addAgent() }], [paste], arrange];
  const entry = nextEntryOf(path);
  const toText = { title: "Go to its text", act: () => (studio.view.set({ text: true }), studio.showLine(thing.of.line)) };
  const remove = (title: string) => ({ title, keys: "Delete", danger: true, act: () => elements.remove(path) });
  if (entry !== undefined) {
    const edit = () => (studio.choose(path, structure), focusForm(".next-entry.chosen input"));
    return [[{ title: "Change its condition", act: edit }], [toText], [remove("Remove this entry of next")]];
  }
  if (thing.kind === "channel") return [[toText], [remove("Remove channel")]];
  const name = selectedPath(path);
  const isControl = thing.kind === "subsystem" && thing.of.kind === "control";
  const isTemplate = thing.kind === "template";
  const leads = thing.kind === "behaviour" ? [{ title: "Add what follows…", act: () => actions.leadOn(thing.of.path) }] : [];
  const connects =
    thing.kind === "buffer" && thing.of.direction !== "real"
      ? [{ title: "Add channel…", act: () => (studio.choose(path, structure), focusForm(".connect select")) }]
      : [];
  const copies = isTemplate
    ? [paste]
    : [
        ...(isControl ? [] : [{ title: "Duplicate", keys: "Ctrl D", act: () => elements.duplicate(path) }]),
        { title: "Copy", keys: "Ctrl C", act: () => elements.copyToClipboard(path) },
        paste,
      ];
  const rename = isControl ? [] : [{ title: "Rename", keys: "F2", act: () => renameInForm(studio, path, structure) }];
  const code =
    thing.kind === "behaviour" && !thing.of.isGroup
      ? [
          {
            title: "Go to its C++ function",
            act: () => (
              studio.choose(path, structure),
              focusForm("section.code textarea, section.code button, section.code [contenteditable=true]")
            ),
          },
        ]
      : [];
  const net = studio.draft.store.get().net?.find(name) ? [{ title: "Show in the net", act: () => studio.flyTo(name) }] : [];
  return [
    [...leads, ...connects, ...addItems(elements, thing)],
    [...rename, ...copies],
    [toText, ...code, ...net],
    arrange,
    [remove(`Remove ${kindName(thing)}`)],
  ];
}

/** The menu on the screen. It takes the focus, and gives it back. */
export function StructureMenu({ open, items, onClose }: { open: OpenMenu; items: Item[][]; onClose: () => void }) {
  const menu = useRef<HTMLDivElement>(null);
  const [place, setPlace] = useState({ left: open.x, top: open.y });
  useLayoutEffect(() => {
    const { width, height } = menu.current!.getBoundingClientRect();
    const inside = (at: number, size: number, room: number) => Math.max(4, Math.min(at, room - size - 4));
    setPlace({ left: inside(open.x, width, innerWidth), top: inside(open.y, height, innerHeight) });
    menu.current!.querySelector("button")?.focus();
  }, [open]);
  const before = useRef(document.activeElement as HTMLElement | null);
  const close = (back: boolean) => {
    onClose();
    if (back) before.current?.focus({ preventScroll: true });
  };
  useEffect(() => {
    const outside = (event: Event) => {
      if (!menu.current?.contains(event.target as Node)) onClose();
    };
    addEventListener("pointerdown", outside, true);
    addEventListener("wheel", outside, true);
    addEventListener("blur", onClose);
    return () => {
      removeEventListener("pointerdown", outside, true);
      removeEventListener("wheel", outside, true);
      removeEventListener("blur", onClose);
    };
  }, [onClose]);
  const key = (event: KeyboardEvent) => {
    event.stopPropagation();
    const all = [...menu.current!.querySelectorAll("button")];
    const at = all.indexOf(document.activeElement as HTMLButtonElement);
    const go = (to: number) => all[(to + all.length) % all.length]!.focus();
    const steps: Record<string, () => void> = {
      ArrowDown: () => go(at + 1),
      ArrowUp: () => go(at - 1),
      Home: () => go(0),
      End: () => go(-1),
      Escape: () => close(true),
      Tab: () => close(true),
    };
    const letter = event.key.length === 1 && !event.ctrlKey && !event.metaKey && event.key !== " ";
    const step = steps[event.key];
    if (step) step();
    else if (letter) {
      const later = [...all.slice(at + 1), ...all.slice(0, at + 1)];
      later.find((one) => one.textContent?.toLowerCase().startsWith(event.key.toLowerCase()))?.focus();
    } else return;
    event.preventDefault();
  };
  return createPortal(
    // A landmark: everything on the page is in one.
    <aside aria-label="Menu of the drawing">
      <div
        ref={menu}
        className="structure-menu"
        role="menu"
        aria-label={open.path === null ? "System" : selectedPath(open.path)}
        style={place}
        onKeyDown={key}
        // A click in the menu is none on the drawing, from which React would see it come.
        onClick={(event) => event.stopPropagation()}
        onContextMenu={(event) => event.preventDefault()}
      >
        {items
          .filter((part) => part.length > 0)
          .map((part, at) => (
            <div key={at} role="group">
              {part.map(({ title, keys, danger, act }) => (
                <button
                  key={title}
                  role="menuitem"
                  tabIndex={-1}
                  className={danger ? "danger" : ""}
                  aria-keyshortcuts={keys?.replace("Ctrl ", "Control+")}
                  onClick={() => {
                    close(true);
                    void act();
                  }}
                >
                  {title}
                  {keys && <kbd aria-hidden="true">{keys}</kbd>}
                </button>
              ))}
            </div>
          ))}
      </div>
    </aside>,
    document.body,
  );
}
