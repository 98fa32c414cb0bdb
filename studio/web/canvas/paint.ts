import { isActive } from "../model/net/game";
import type { NetModel } from "../model/net/net";
import { runningBehaviours } from "../model/net/game";
import type { Breakpoint } from "../model/protocol";
import type { Stage } from "../live/stage";

/**
 * Shows the marking on the drawing, by the elements' numbers. This runs at the frame rate and touches only
 * what is on screen, so it bypasses React.
 */
export function paint(root: ParentNode, net: NetModel, stage: Stage, breakpoints: readonly Breakpoint[] = []): void {
  if (!stage.is(net)) return;
  const { marking, occupied, counts, firedAt, mode, differing, sampled, unreached } = stage;
  const playing = mode !== "edit";
  const now = performance.now();
  const stops = { places: new Set<number>(), transitions: new Set<number>() };
  for (const one of breakpoints)
    if ("place" in one) stops.places.add(one.place);
    else stops.transitions.add("transition" in one ? one.transition : one.condition);
  root.querySelectorAll<SVGGElement>("[data-place]").forEach((group) => {
    const tokens = marking[Number(group.dataset.place)] ?? 0;
    group.style.display = tokens > 0 ? "" : "none";
    group.parentElement!.classList.toggle("unreached", unreached?.places.has(Number(group.dataset.place)) ?? false);
    group.parentElement!.classList.toggle("breakpoint", stops.places.has(Number(group.dataset.place)));
    const text = group.lastElementChild!;
    const many = tokens > 1 ? String(tokens) : "";
    if (text.textContent !== many) text.textContent = many;
  });
  root.querySelectorAll<SVGGElement>("[data-transition]").forEach((group) => {
    const index = Number(group.dataset.transition);
    group.classList.toggle("enabled", mode === "game" && isActive(net, marking, index));
    group.classList.toggle("fired", playing && now - firedAt[index]! < 350);
    group.classList.toggle("breakpoint", stops.transitions.has(index));
    const isUnreached = unreached?.transitions.has(index) ?? false;
    group.classList.toggle("unreached", isUnreached);
    group.classList.toggle("one-sided", !isUnreached && (unreached?.oneSided.has(index) ?? false));
    const text = group.lastElementChild!;
    const count = playing && counts[index]! > 0 ? `${sampled ? "≥" : "×"}${short(counts[index]!)}` : "";
    if (text.textContent !== count) text.textContent = count;
  });
  root.querySelectorAll<SVGGElement>("[data-page]").forEach((group) => {
    const page = Number(group.dataset.page);
    const layer = net.page(page).layer;
    const idle = layer === "system";
    group.classList.toggle("occupied", playing && !idle && occupied[page] === 1);
    group.classList.toggle("unreached", unreached?.pages.has(net.page(page).path) ?? false);
    group.classList.toggle("differs", layer === "subsystem" && differing.has(net.page(page).path));
  });
  if (root instanceof SVGElement) root.classList.toggle("runs", playing && occupied[Number(root.dataset.of)] === 1);
  const running = playing ? runningBehaviours(net, marking) : new Map<number, string>();
  root.querySelectorAll<SVGTextElement>("[data-running]").forEach((text) => {
    const page = net.page(Number(text.dataset.running));
    const name = page.layer === "subsystem" && page.subsystem !== null ? (running.get(page.subsystem) ?? "") : "";
    const label = name ? `▸ ${name}` : "";
    if (text.textContent !== label) text.textContent = label;
  });
}

/** 999, 12k, 3.4M */
export function short(count: number): string {
  if (count < 1000) return String(count);
  if (count < 1e6) return `${(count / 1000).toFixed(count < 1e4 ? 1 : 0)}k`;
  return `${(count / 1e6).toFixed(1)}M`;
}
