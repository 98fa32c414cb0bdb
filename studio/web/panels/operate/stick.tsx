import { useEffect, useRef, useState, type PointerEvent } from "react";
import type { PanelControl } from "../../model/protocol";
import {
  deflected,
  deflectionOf,
  directionOf,
  pushOf,
  type Direction,
  type Inputs,
  type StickKeys,
} from "../../model/run/panel_inputs";
import { noMenu, withUnit } from "./controls";

interface StickProps {
  x: PanelControl | undefined;
  y: PanelControl | undefined;
  inputs: Inputs;
  disabled: boolean;
  rests: number;
  /** The keys that move it wherever the focus is; null: only while it has the focus. */
  pageKeys: StickKeys | null;
  onMove: (change: Inputs) => void;
}

const letters = { up: "W", left: "A", down: "S", right: "D" };
const arrows = { up: "↑", left: "←", down: "↓", right: "→" };
const shownKeys: Record<StickKeys, Record<Direction, string>> = { letters, arrows, both: letters };
const keyNames: Record<StickKeys, string> = {
  letters: "W, A, S, D",
  arrows: "Arrow keys",
  both: "Arrow keys or W, A, S, D",
};

/** Fields, and sticks that have no keys of the page, take letters and arrows for themselves. */
const isOwnTarget = (target: EventTarget | null) =>
  target instanceof Element &&
  target.closest("input:not([type=checkbox]), select, textarea, [data-own-keys], [contenteditable]") !== null;

/** A square with a knob that a pointer or keys move. It springs back to zero when it is released. */
export function Stick({ x, y, inputs, disabled, rests, pageKeys, onMove }: StickProps) {
  /** By the position of the key, since another key pressed meanwhile may change the letter of its release. */
  const keys = useRef(new Map<string, Direction>());
  /** The finger that holds the knob; others do not count. */
  const finger = useRef<number | null>(null);
  const [dragged, setDragged] = useState(false);
  const axes = [x, y].filter((axis) => axis !== undefined);
  const push = (right: number, up: number) => {
    if (!disabled) onMove({ ...(x && { [x.field]: deflected(x, right) }), ...(y && { [y.field]: deflected(y, up) }) });
  };
  const releaseKeys = () => {
    if (keys.current.size === 0) return;
    keys.current.clear();
    if (finger.current === null) push(0, 0);
  };
  const key = (event: KeyboardEvent, down: boolean, of: StickKeys) => {
    // While one of these is held, browsers do not report the release of other keys.
    if (["Meta", "Control", "Alt", "AltGraph"].includes(event.key)) return releaseKeys();
    const direction = directionOf(event.key, of);
    if (event.key === "Shift") {
      if (keys.current.size === 0) return;
    } else if (down) {
      if (direction === undefined || event.ctrlKey || event.metaKey || event.altKey) return;
      event.preventDefault();
      if (event.repeat || disabled) return;
      keys.current.set(event.code, direction);
    } else if (!keys.current.delete(event.code)) return;
    if (finger.current === null) push(...pushOf(keys.current.values(), event.shiftKey));
  };
  const taken = useRef({ key, releaseKeys });
  taken.current = { key, releaseKeys };
  useEffect(() => {
    if (pageKeys === null || disabled) return;
    const down = (event: KeyboardEvent) => isOwnTarget(event.target) || taken.current.key(event, true, pageKeys);
    // A release counts, wherever the focus is by now.
    const up = (event: KeyboardEvent) => taken.current.key(event, false, pageKeys);
    window.addEventListener("keydown", down);
    window.addEventListener("keyup", up);
    return () => {
      window.removeEventListener("keydown", down);
      window.removeEventListener("keyup", up);
    };
  }, [pageKeys, disabled]);
  useEffect(() => {
    keys.current.clear();
    finger.current = null;
    setDragged(false);
  }, [rests, disabled]);
  const drag = (event: PointerEvent<HTMLDivElement>) => {
    const box = event.currentTarget.getBoundingClientRect();
    const half = box.width / 2;
    push((event.clientX - box.left - half) / half, -(event.clientY - box.top - half) / half);
  };
  const letGo = (event: PointerEvent) => {
    if (finger.current !== event.pointerId) return;
    finger.current = null;
    setDragged(false);
    push(...pushOf(keys.current.values(), event.shiftKey));
  };
  const at = (axis: PanelControl | undefined) => (axis ? deflectionOf(axis, Number(inputs[axis.field])) : 0);
  const said = axes.map((axis) => `${axis.field} ${withUnit(inputs[axis.field]!, axis)}`);
  const name = axes.map((axis) => `${axis.field} ${axis === x ? "to the right" : "up"}`).join(", ");
  const ways: Direction[] = [...(y ? (["up", "down"] as const) : []), ...(x ? (["left", "right"] as const) : [])];
  return (
    <div className="operator-stick">
      <div
        className={`stick${dragged ? " dragged" : ""}`}
        role="application"
        aria-roledescription="joystick"
        aria-label={`Stick: ${name}. ${keyNames[pageKeys ?? "both"]} move it.`}
        aria-disabled={disabled}
        tabIndex={0}
        onContextMenu={noMenu}
        {...(pageKeys === null && {
          "data-own-keys": true,
          onKeyDown: (event: React.KeyboardEvent) => key(event.nativeEvent, true, "both"),
          onKeyUp: (event: React.KeyboardEvent) => key(event.nativeEvent, false, "both"),
          onBlur: releaseKeys,
        })}
        onPointerDown={(event) => {
          if (disabled || finger.current !== null || event.button !== 0) return;
          event.currentTarget.setPointerCapture(event.pointerId);
          finger.current = event.pointerId;
          setDragged(true);
          drag(event);
        }}
        onPointerMove={(event) => finger.current === event.pointerId && drag(event)}
        onPointerUp={letGo}
        onPointerCancel={letGo}
        onLostPointerCapture={letGo}
      >
        {ways.map((way) => (
          <kbd key={way} className={`way ${way}`} aria-hidden="true">
            {shownKeys[pageKeys ?? "arrows"][way]}
          </kbd>
        ))}
        <span className="knob" style={{ left: `${50 + 40 * at(x)}%`, top: `${50 - 40 * at(y)}%` }} />
      </div>
      <output>
        {said.map((one) => (
          <span key={one}>{one}</span>
        ))}
      </output>
    </div>
  );
}
