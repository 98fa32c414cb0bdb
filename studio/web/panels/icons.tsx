const paths: Record<string, string> = {
  search: "M7 2.5a4.5 4.5 0 1 0 0 9a4.5 4.5 0 0 0 0-9M10.4 10.4L14 14",
  undo: "M5.5 3L2.5 6l3 3M2.5 6H9.5a4 4 0 0 1 0 8H6",
  redo: "M10.5 3l3 3l-3 3M13.5 6H6.5a4 4 0 0 0 0 8H10",
  text: "M3 3.5h10M3 6.5h7M3 9.5h10M3 12.5h6",
  full: "M2.5 6V2.5H6M10 2.5h3.5V6M13.5 10v3.5H10M6 13.5H2.5V10",
  lamp: "M6 11.5h4M6.5 13.5h3M8 2a4 4 0 0 0-2.2 7.3c.4.4.7.8.7 1.4h3c0-.6.3-1 .7-1.4A4 4 0 0 0 8 2",
  panels: "M2.5 3h11v10h-11zM6 3v10M6 9h7.5",
  theme: "M8 2a6 6 0 1 0 0 12zM8 2a6 6 0 0 1 0 12",
  play: "M5 3l8 5l-8 5z",
  pause: "M5 3v10M11 3v10",
  stop: "M4 4h8v8H4z",
  forward: "M4 3l6 5l-6 5zM12.5 3v10",
  back: "M12 3L6 8l6 5zM3.5 3v10",
  first: "M8 3L4 8l4 5M13 3L9 8l4 5",
  last: "M8 3l4 5l-4 5M3 3l4 5l-4 5",
  add: "M8 3v10M3 8h10",
  remove: "M4 4l8 8M12 4l-8 8",
  export: "M8 2v8M4.5 6.5L8 10l3.5-3.5M3 13.5h10",
  check: "M3 8.5l3.5 3.5L13 4.5",
  cross: "M4 4l8 8M12 4l-8 8",
  question: "M5.5 6a2.5 2.5 0 1 1 3.6 2.2C8.3 8.7 8 9.2 8 10M8 12.5v.5",
};

export function Icon({ name }: { name: string }) {
  if (name === "logo")
    return (
      <svg className="svg-icon" viewBox="0 0 16 16" aria-hidden="true">
        <circle cx="8" cy="8" r="6.5" />
        <circle className="filled" cx="8" cy="8" r="2.6" />
      </svg>
    );
  return (
    <svg className="svg-icon" viewBox="0 0 16 16" aria-hidden="true">
      <path d={paths[name]} />
    </svg>
  );
}

/** A button with an icon; its name appears when the pointer rests on it. */
export function IconButton({
  name,
  label,
  title = label,
  disabled = false,
  onClick,
}: {
  name: string;
  label: string;
  /** A longer text than the label, if there is one. */
  title?: string;
  disabled?: boolean;
  onClick: () => void;
}) {
  return (
    <button className="icon" aria-label={label} title={title} disabled={disabled} onClick={onClick}>
      <Icon name={name} />
    </button>
  );
}
