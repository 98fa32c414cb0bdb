import type { LineState } from "./line_state";

/** The signs, so that the colour is not alone. */
const signs: Record<LineState["tone"], string> = {
  building: "M8 2.5a5.5 5.5 0 1 1-5.5 5.5",
  running: "M4.5 2.5l8.5 5.5l-8.5 5.5z",
  paused: "M4 3h3v10h-3zM9 3h3v10h-3z",
  stuck: "M3.5 7h9v6.5h-9zM5.5 7v-2a2.5 2.5 0 0 1 5 0v2",
  failed: "M4 4l8 8M12 4l-8 8",
  emergency: "M5.2 1.5h5.6l3.7 3.7v5.6l-3.7 3.7h-5.6l-3.7-3.7v-5.6zM8 4.5v4.5M8 11v.6",
  ended: "M4 4h8v8h-8z",
};

/** The state of the run: a coloured word with a sign. */
export function StateChip({ tone, word, why }: LineState) {
  return (
    <span className={`state-chip ${tone}`} role="status" data-testid="line-state" title={why || word}>
      <svg
        className={`svg-icon ${["running", "paused", "ended"].includes(tone) ? "solid" : ""}`}
        viewBox="0 0 16 16"
        aria-hidden="true"
      >
        <path d={signs[tone]} />
      </svg>
      {word}
    </span>
  );
}
