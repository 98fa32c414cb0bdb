import type { NetModel, Operation, Page, PageTransition } from "./net";

/** The labels of the symbols. */

export const layerTitle: Record<Page["layer"], string> = {
  system: "multi-agent system",
  agent: "agent",
  subsystem: "subsystem",
  behaviour: "behaviour",
  communication: "communication",
};

export const pageName = (page: Page) => (page.parent === null ? "system" : page.name);

export function operationText(page: Page, operation: Operation | null): string {
  switch (operation?.kind) {
    case "transition_function":
      return `${page.name}()`;
    case "next_iteration":
      return "i := i + 1";
    case "write":
      return "write";
    case "read":
      return "read";
    default:
      return "";
  }
}

/** The condition in brackets; empty if it always holds. */
export function conditionText(transition: PageTransition, limit = 26): string {
  const text = transition.condition?.text ?? "";
  if (!text) return "";
  return `[${text.length > limit ? `${text.slice(0, limit - 1)}…` : text}]`;
}

/** Breaks a name after underscores into so many lines of similar length; fewer if it has fewer parts. */
export function nameLines(name: string, most: number): string[] {
  const parts = name.split(/(?<=_)/);
  const lines: string[] = [];
  for (let left = Math.min(most, parts.length); left > 0; left -= 1) {
    const share = parts.join("").length / left;
    let line = parts.shift()!;
    // Each line is as near to its share as possible and leaves a part for each further line.
    while (parts.length >= left && (left === 1 || line.length + parts[0]!.length / 2 <= share)) line += parts.shift()!;
    lines.push(line);
  }
  return lines;
}

/** A name of so many letters, with its begin and its end: the names of a system often have the same begin or the same end. */
export function inMiddle(name: string, letters: number): string {
  if (name.length <= letters) return name;
  const end = letters < 9 ? 0 : Math.floor((letters - 1) / 2);
  return `${name.slice(0, Math.max(1, letters - 1 - end))}…${name.slice(name.length - end)}`;
}

/** The text of a screen reader for an element. */
export function spoken(net: NetModel, path: string): string {
  const asPage = net.pageByPath.get(path);
  if (asPage !== undefined) return `${layerTitle[net.page(asPage).layer]} ${path || "system"}`;
  const element = net.find(path);
  if (!element) return path || "system";
  if (element.kind === "transition") {
    const transition = net.page(element.page).transitions[element.index]!;
    const condition = transition.condition?.text;
    return `transition ${path}${condition ? `, condition ${condition}` : ""}`;
  }
  const operation = operationText(net.page(element.page), net.page(element.page).nodes[element.index]!.operation);
  return `place ${path}${operation ? `, ${operation}` : ""}`;
}

/** The same text with line breaks allowed between the parts of its paths, and an arrow as one character. */
export const breakable = (text: string) => text.replaceAll("->", " → ").replace(/\.(?=\w)/g, ".\u200b");

/** A sentence of the server, with a capital letter unless it begins with a path. */
export const sentence = (text: string) =>
  breakable(/^[\w[\]]+\./.test(text) ? text : text.charAt(0).toUpperCase() + text.slice(1));
