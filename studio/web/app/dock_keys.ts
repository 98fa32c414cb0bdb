import { useEffect } from "react";
import { useStudio } from "../hooks/use";
import { shortcutOf } from "../model/shortcuts";

/** The elements of the panels that can be seen, in their order on the page. */
function panelsSeen(): HTMLElement[] {
  const all = [...document.querySelectorAll<HTMLElement>(".dock [role=tabpanel]")].filter((one) => one.offsetParent !== null);
  return all.sort((a, b) => {
    const [one, other] = [a.getBoundingClientRect(), b.getBoundingClientRect()];
    return one.left - other.left || one.top - other.top;
  });
}

/** The name of the panel that holds an element, or whose tab it is. */
export function panelAround(element: Element | null): string | null {
  const panel = element?.closest(".dock :is([role=tabpanel], [role=tab])");
  return panel?.id.match(/[a-z]+$/)?.[0] ?? null;
}

/** A panel that is drawn elsewhere keeps the keys; or its tab does, if they were there. */
function keepFocus(panel: string, onTab: boolean): void {
  requestAnimationFrame(() =>
    requestAnimationFrame(() => {
      if (document.activeElement !== null && document.activeElement !== document.body) return;
      const drawn = (role: string) => document.querySelector<HTMLElement>(`.dock [role=${role}][id$="-${panel}"]`);
      (onTab ? (drawn("tab") ?? drawn("tabpanel")) : drawn("tabpanel"))?.focus();
    }),
  );
}

/** F6 and Shift F6 go from panel to panel, Alt Enter gives the panel the whole page. */
export function useDockKeys(): void {
  const studio = useStudio();
  useEffect(() => {
    const key = (event: KeyboardEvent) => {
      if (document.querySelector("dialog[open]")) return;
      const pressed = shortcutOf("panels", event);
      if (pressed === "nextPanel" || pressed === "lastPanel") {
        const panels = panelsSeen();
        const at = panels.findIndex((one) => one.contains(document.activeElement));
        const step = pressed === "lastPanel" ? -1 : 1;
        panels.at(at < 0 ? (step > 0 ? 0 : -1) : (at + step) % panels.length)?.focus();
        event.preventDefault();
      } else if (pressed === "maximise") {
        const panel = panelAround(document.activeElement);
        if (!panel) return;
        const onTab = document.activeElement?.getAttribute("role") === "tab";
        studio.dock.maximise(panel);
        keepFocus(panel, onTab);
        event.preventDefault();
        event.stopPropagation();
      }
    };
    addEventListener("keydown", key, true);
    return () => removeEventListener("keydown", key, true);
  }, [studio]);
}
