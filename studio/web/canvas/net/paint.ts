import type { Marks } from "./marks";
import { marksOf } from "./marks";

const mark = (element: Element, all: readonly string[], marks: string) => {
  const wanted = marks === "" ? [] : marks.split(" ");
  for (const name of all) element.classList.toggle(name, wanted.includes(name));
};
const write = (text: Element, wanted: string) => {
  if (text.textContent !== wanted) text.textContent = wanted;
};

/**
 * Shows the state of a stage on the drawing, by the elements' numbers. This runs at the frame rate and touches
 * only what is on screen, so it bypasses React.
 */
export function paint(root: SVGSVGElement, marks: Marks): void {
  root.querySelectorAll<SVGGElement>("[data-place]").forEach((group) => {
    const place = Number(group.dataset.place);
    const tokens = marks.tokens(place);
    group.style.display = tokens > 0 ? "" : "none";
    mark(group.parentElement!, marksOf.place, marks.place(place));
    write(group.lastElementChild!, tokens > 1 ? String(tokens) : "");
  });
  root.querySelectorAll<SVGGElement>("[data-transition]").forEach((group) => {
    const index = Number(group.dataset.transition);
    mark(group, marksOf.transition, marks.transition(index));
    write(group.lastElementChild!, marks.firings(index));
  });
  root.querySelectorAll<SVGGElement>("[data-page]").forEach((group) => {
    mark(group, marksOf.page, marks.page(Number(group.dataset.page)));
  });
  root.classList.toggle("runs", marks.runs(Number(root.dataset.of)));
  root.querySelectorAll<SVGTextElement>("[data-running]").forEach((text) => {
    write(text, marks.running(Number(text.dataset.running)));
  });
}
