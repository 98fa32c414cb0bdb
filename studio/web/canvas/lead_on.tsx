import { useEffect, useId, useLayoutEffect, useRef, useState, type FormEvent, type KeyboardEvent } from "react";
import { createPortal } from "react-dom";
import { useStudio } from "../hooks/use";
import { terminalWith } from "../model/text/lead_on";
import { findThing, targetsIn, withoutIndex, type Behaviour, type Structure } from "../model/structure/structure";

/** A new entry of `next` that is asked for: where it begins, and perhaps where it leads. */
export interface LeadOn {
  from: string;
  /** The name of the behaviour; undefined: it is chosen in the form. */
  to?: string;
  /** On the screen. */
  x: number;
  y: number;
}

/** Tells when a new arrow is taken. terminal: the new terminal condition of the behaviour; undefined: it stays. */
function whenTaken({ name, isGroup, terminal: old, next }: Behaviour, when: string, terminal: string | undefined): string {
  if (when === "error") return `Taken after a failure of ${name}.`;
  if (isGroup) return `Taken when ${name} is left. Arrows are tried in their order. error: after a failure in it.`;
  if (terminal !== undefined)
    return old === ""
      ? `${name} had no end. It now ends when this condition holds, and this arrow is taken.`
      : `${name} now ends when ${terminal}. This arrow is taken if its condition holds then.`;
  if (old === "")
    return when === ""
      ? `${name} never ends, so this arrow is not taken. Write the condition that ends ${name}, or error: after a failure.`
      : `${name} never ends, so this arrow is not taken.`;
  const ended = old === "true" ? `Tried after each round of ${name}` : `Tried when ${name} has ended: ${old}`;
  if (when !== "") return `${ended}.`;
  return next.some((one) => one.when === "")
    ? `${ended}. Another arrow is always taken before it: give one of them a condition.`
    : `${ended}.`;
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
  const [ends, setEnds] = useState(true);
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
    void studio.elements.leadOn(of.from, { to, when: condition, ends });
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
  const named = ["error", ...(behaviour?.isGroup ? ["until"] : [])];
  const condition = when.trim();
  const terminal = behaviour && terminalWith(behaviour, condition);
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
      {terminal !== undefined && (
        <label className="check">
          <input type="checkbox" checked={ends} onChange={(event) => setEnds(event.target.checked)} />
          {behaviour?.name} ends when this holds
        </label>
      )}
      {behaviour && <p className="faint">{whenTaken(behaviour, condition, ends ? terminal : undefined)}</p>}
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
