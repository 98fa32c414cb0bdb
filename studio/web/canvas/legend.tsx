import type { ReactNode } from "react";
import { Term } from "./term";

const structure: [string, ReactNode, ReactNode][] = [
  [
    "N → B",
    "N → B",
    <>
      The sender does not wait (N <Term of="N" />
      ), the receiver waits (B <Term of="B" />)
    </>,
  ],
  ["dashed", <Line key="" dash="6 4" />, "A channel at which nobody waits"],
  ["solid", <Line key="" />, "A channel at which an end waits"],
  ["thick", <Line key="" wide={3} />, "All channels between two agents"],
  ["next", "↻", "From each member of a fleet to the next one"],
  ["circle", "○", "An input (left) or output (right): drag from one to the other"],
  ["device", <span key="" className="legend-device" />, "The device of a virtual receptor or effector"],
];

const net: [string, ReactNode, ReactNode][] = [
  [
    "place",
    "○",
    <>
      A place <Term of="place" />; dashed: memory of a channel
    </>,
  ],
  ["token", "●", "A token: this is so now"],
  [
    "bar",
    "┃",
    <>
      A transition <Term of="transition" />; grey: it can never fire
    </>,
  ],
  ["condition", "[x > 0]", "It fires only if this holds"],
  ["page", "◎", "A page: a net of its own, folded; double frame: open"],
];

function Line({ dash, wide = 1.5 }: { dash?: string; wide?: number }) {
  return (
    <svg width="30" height="8" aria-hidden="true">
      <path d="M0 4H30" stroke="var(--arc)" strokeWidth={wide} strokeDasharray={dash} />
    </svg>
  );
}

/** Explains the symbols of a drawing. */
export function Legend({ of }: { of: "net" | "structure" }) {
  return (
    <details className="legend nodrag nopan">
      <summary>Legend</summary>
      <dl>
        {(of === "net" ? net : structure).map(([key, symbol, meaning]) => (
          <div key={key}>
            <dt>{symbol}</dt>
            <dd>{meaning}</dd>
          </div>
        ))}
      </dl>
    </details>
  );
}
