import { useEffect, useRef, useState, type KeyboardEvent, type ReactNode } from "react";
import { useStore, useStudio } from "../hooks/use";
import { layoutNames, layoutTitles } from "../model/dock/ready_layouts";
import { Icon } from "./icons";

/** The menu of the panels: the ready layouts, and what is open. */
export function PanelsMenu() {
  const [open, setOpen] = useState(false);
  const button = useRef<HTMLButtonElement>(null);
  const close = (focus: boolean) => {
    setOpen(false);
    if (focus) button.current?.focus();
  };
  return (
    <div className="menu-place">
      <button
        ref={button}
        className="icon"
        aria-label="Panels"
        title="Panels and layouts"
        aria-haspopup="menu"
        aria-expanded={open}
        onClick={() => setOpen(!open)}
      >
        <Icon name="panels" />
      </button>
      {open && <Menu close={close} />}
    </div>
  );
}

function Menu({ close }: { close: (focus: boolean) => void }) {
  const studio = useStudio();
  const { dock } = studio;
  const { layout, open, available, chosen, seen } = useStore(dock.store, (all) => all);
  const ref = useRef<HTMLDivElement>(null);
  const leave = useRef(close);
  leave.current = close;
  useEffect(() => {
    ref.current?.querySelector<HTMLElement>("[aria-checked=true]")?.focus();
    const away = (event: PointerEvent) => {
      if (!ref.current?.parentElement?.contains(event.target as Node)) leave.current(false);
    };
    addEventListener("pointerdown", away, true);
    return () => removeEventListener("pointerdown", away, true);
  }, []);
  const key = (event: KeyboardEvent) => {
    const items = [...ref.current!.querySelectorAll<HTMLElement>("button:not(:disabled)")];
    const at = items.indexOf(document.activeElement as HTMLElement);
    const to = { ArrowDown: at + 1, ArrowUp: at - 1, Home: 0, End: -1 }[event.key];
    if (event.key === "Escape" || event.key === "Tab") close(true);
    if (to !== undefined) items.at(to % items.length)?.focus();
    if (to !== undefined || event.key === "Escape") event.preventDefault();
  };
  const whole = seen.length === 1 && open.length > 1;
  return (
    <div ref={ref} className="menu" role="menu" aria-label="Panels and layouts" onKeyDown={key}>
      <div role="group" aria-label="Layout">
        <p aria-hidden="true">Layout</p>
        {layoutNames.map((name) => (
          <Item key={name} role="menuitemradio" checked={layout === name} choose={() => (dock.use(name), close(true))}>
            {layoutTitles[name]}
          </Item>
        ))}
        <Item role="menuitem" choose={() => (dock.reset(), close(true))}>
          Reset layout
        </Item>
      </div>
      <div role="group" aria-label="Panels">
        <p aria-hidden="true">Panels</p>
        {studio.panels
          .filter(({ name }) => name !== "drawing")
          .map(({ name, title }) => (
            <Item
              key={name}
              role="menuitemcheckbox"
              checked={open.includes(name)}
              disabled={!available.includes(name)}
              title={available.includes(name) ? "" : "It opens when it has something to show"}
              choose={() => (open.includes(name) ? dock.close(name) : dock.open(name))}
            >
              {title}
            </Item>
          ))}
      </div>
      <div role="group" aria-label="The chosen panel">
        <p aria-hidden="true">The chosen panel</p>
        <Item role="menuitemcheckbox" checked={whole} choose={() => (dock.maximise(whole ? seen[0]! : chosen), close(true))}>
          {whole ? "Maximised" : `Maximise ${studio.panels.find(({ name }) => name === chosen)?.title ?? "it"}`}{" "}
          <kbd>Alt Enter</kbd>
        </Item>
        <p aria-hidden="true">
          From panel to panel: <kbd>F6</kbd> <kbd>Shift F6</kbd>
        </p>
      </div>
    </div>
  );
}

interface ItemProps {
  role: "menuitem" | "menuitemradio" | "menuitemcheckbox";
  checked?: boolean;
  disabled?: boolean;
  title?: string;
  choose: () => void;
  children: ReactNode;
}

function Item({ role, checked, disabled = false, title, choose, children }: ItemProps) {
  return (
    <button role={role} aria-checked={checked} disabled={disabled} title={title} tabIndex={-1} onClick={choose}>
      <span className="tick">{checked && <Icon name="check" />}</span>
      {children}
    </button>
  );
}
