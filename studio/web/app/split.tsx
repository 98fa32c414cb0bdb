import { useState, type CSSProperties, type KeyboardEvent, type PointerEvent, type ReactNode } from "react";

const kept = "tessera.split";
interface Sizes {
  left: number;
  right: number;
}

/** The widths that the user chose before; otherwise the drawing keeps its space in a narrow window. */
function keptSizes(): Partial<Sizes> {
  return JSON.parse(localStorage.getItem(kept) ?? "{}") as Partial<Sizes>;
}
/** The widths for a window of so many pixels. The text leaves the drawing and the side panel 780 of them. */
const usual: Record<keyof Sizes, (width: number) => number> = {
  left: (width) => Math.min(420, Math.max(220, width - 780)),
  right: (width) => Math.min(320, width * 0.32),
};
const usualCss: Record<keyof Sizes, string> = { left: "clamp(220px, 100vw - 780px, 420px)", right: "min(320px, 32vw)" };
const sizeOf = (chosen: Partial<Sizes>, side: keyof Sizes) => chosen[side] ?? Math.round(usual[side](innerWidth));
const widthOf = (chosen: Partial<Sizes>, side: keyof Sizes) =>
  chosen[side] === undefined ? usualCss[side] : `${chosen[side]}px`;

/** Three columns. The borders between them can be dragged, or moved by arrow keys. */
export function Split({ left, right, children }: { left: ReactNode; right: ReactNode; children: ReactNode }) {
  const [sizes, setSizes] = useState(keptSizes);
  const change = (side: keyof Sizes, size: number) => {
    const next = { ...sizes, [side]: Math.round(Math.min(Math.max(size, 220), innerWidth * 0.6)) };
    setSizes(next);
    localStorage.setItem(kept, JSON.stringify(next));
  };
  const style = {
    "--left": left ? widthOf(sizes, "left") : "0px",
    "--right": widthOf(sizes, "right"),
  } as CSSProperties;
  return (
    <div className="split" style={style}>
      {left && (
        <section className="side left" aria-label="Specification">
          <div className="pane">{left}</div>
          <Border label="Width of the text" size={sizeOf(sizes, "left")} sign={1} onChange={(size) => change("left", size)} />
        </section>
      )}
      {children}
      <aside className="side right" aria-label="Side panel">
        <Border
          label="Width of the side panel"
          size={sizeOf(sizes, "right")}
          sign={-1}
          onChange={(size) => change("right", size)}
        />
        <div className="pane">{right}</div>
      </aside>
    </div>
  );
}

function Border({
  label,
  size,
  sign,
  onChange,
}: {
  label: string;
  size: number;
  sign: 1 | -1;
  onChange: (size: number) => void;
}) {
  const drag = (event: PointerEvent<HTMLDivElement>) => {
    const [from, start] = [event.clientX, size];
    const border = event.currentTarget;
    border.setPointerCapture(event.pointerId);
    const move = (now: globalThis.PointerEvent) => onChange(start + sign * (now.clientX - from));
    border.addEventListener("pointermove", move);
    border.addEventListener("pointerup", () => border.removeEventListener("pointermove", move), { once: true });
  };
  const key = (event: KeyboardEvent) => {
    const step = event.key === "ArrowRight" ? 16 : event.key === "ArrowLeft" ? -16 : 0;
    if (step) onChange(size + sign * step);
  };
  return (
    <div
      className="border"
      role="separator"
      aria-orientation="vertical"
      aria-label={label}
      aria-valuenow={size}
      aria-valuemin={220}
      aria-valuemax={1200}
      tabIndex={0}
      onPointerDown={drag}
      onKeyDown={key}
    />
  );
}
