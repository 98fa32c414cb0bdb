import { useEffect, useId, useLayoutEffect, useRef, useState, type FormEvent, type KeyboardEvent } from "react";
import { createPortal } from "react-dom";
import { useStudio } from "../hooks/use";
import { findThing, targetsIn, withoutIndex, type Structure } from "../model/structure/structure";

/** A new entry of `next` that is asked for: where it begins, and perhaps where it leads. */
export interface LeadOn {
  from: string;
  /** The name of the behaviour; undefined: it is chosen in the form. */
  to?: string;
  /** On the screen. */
  x: number;
  y: number;
}

/** The form of a new entry of `next`, near its arrow. Escape takes it back. */
export function LeadOnForm({ structure, of, onClose }: { structure: Structure; of: LeadOn; onClose: () => void }) {
  const studio = useStudio();
  const id = useId();
  const form = useRef<HTMLFormElement>(null);
  const before = useRef(document.activeElement as HTMLElement | null);
  const thing = findThing(structure, withoutIndex(of.from));
  const behaviour = thing?.kind === "behaviour" ? thing.of : undefined;
  const targets = thing?.kind === "behaviour" ? [...targetsIn(thing.subsystem, thing.of.group, "[i]"), "end"] : [];
  const other = targets.find((name) => withoutIndex(name) !== behaviour?.name) ?? "end";
  const [to, setTo] = useState(targets.find((name) => withoutIndex(name) === of.to) ?? other);
  const [when, setWhen] = useState("");
  const [place, setPlace] = useState({ left: of.x, top: of.y });
  useLayoutEffect(() => {
    const { width, height } = form.current!.getBoundingClientRect();
    const inside = (at: number, size: number, room: number) => Math.max(4, Math.min(at, room - size - 4));
    setPlace({ left: inside(of.x + 8, width, innerWidth), top: inside(of.y + 8, height, innerHeight) });
    form.current!.querySelector<HTMLElement>(of.to === undefined ? "select" : "input")?.focus();
  }, [of]);
  const close = () => {
    onClose();
    before.current?.focus({ preventScroll: true });
  };
  useEffect(() => {
    if (!behaviour) onClose();
  }, [behaviour, onClose]);
  const add = (event: FormEvent) => {
    event.preventDefault();
    close();
    void studio.elements.leadOn(of.from, to, when.trim());
  };
  const key = (event: KeyboardEvent) => {
    event.stopPropagation();
    if (event.key === "Escape") close();
    if (event.key !== "Tab") return;
    // Tab goes round in the form: behind it is the end of the page.
    const all = [...form.current!.querySelectorAll<HTMLElement>("select, input, button")];
    const [end, other] = event.shiftKey ? [all[0], all.at(-1)] : [all.at(-1), all[0]];
    if (document.activeElement !== end) return;
    event.preventDefault();
    other!.focus();
  };
  const first = behaviour?.next.length ?? 0;
  const named = ["error", ...(behaviour?.isGroup ? ["until"] : [])];
  const always = behaviour?.next.some((one) => one.when === "");
  return createPortal(
    <form
      ref={form}
      className="lead-on"
      aria-labelledby={`${id}-title`}
      style={place}
      onSubmit={add}
      onKeyDown={key}
      onClick={(event) => event.stopPropagation()}
    >
      <h2 id={`${id}-title`}>After {behaviour?.name}</h2>
      <label>
        goes on with
        <select value={to} onChange={(event) => setTo(event.target.value)}>
          {targets.map((name) => (
            <option key={name}>{name}</option>
          ))}
        </select>
      </label>
      <label>
        when
        <input
          type="text"
          className="mono"
          value={when}
          placeholder="always"
          list={`${id}-named`}
          spellCheck={false}
          autoComplete="off"
          onChange={(event) => setWhen(event.target.value)}
        />
        <datalist id={`${id}-named`}>
          {named.map((name) => (
            <option key={name} value={name} />
          ))}
        </datalist>
      </label>
      <p className="faint">
        {always && first > 0
          ? "An entry before it is always taken: this one is tried after it. Give that one a condition."
          : "A condition in C++, or error after a failure. Entries are tried in their order."}
      </p>
      {behaviour && !behaviour.isGroup && behaviour.terminal === "" && when.trim() !== "error" && (
        <p className="faint">
          {behaviour.name} never ends: it has no terminal condition. If this is its only way on, write the condition there, and
          leave this field empty.
        </p>
      )}
      <div className="buttons">
        <button type="button" onClick={close}>
          Cancel
        </button>
        <button type="submit" className="primary">
          Add
        </button>
      </div>
    </form>,
    document.body,
  );
}
