/** A view of the page as one self-contained SVG, for a paper or a report. */

const svg = "http://www.w3.org/2000/svg";
const kept = [
  "fill",
  "fill-opacity",
  "stroke",
  "stroke-width",
  "stroke-dasharray",
  "stroke-linejoin",
  "stroke-linecap",
  "opacity",
  "font-family",
  "font-size",
  "font-weight",
  "font-style",
  "text-anchor",
  "paint-order",
  "marker-start",
  "marker-end",
];
const hidden = (style: CSSStyleDeclaration) => style.display === "none" || style.visibility === "hidden";

export interface Picture {
  text: string;
  width: number;
  height: number;
}

/** Classes that a film adds and removes. */
const changing = ["fired", "enabled", "occupied", "runs", "selected"];

/**
 * The part of `areas` (elements with a flow in each) that is visible now. moves: it is the first picture of a
 * film, so elements that appear and disappear stay in it, hidden, with their classes.
 */
export function takePicture(areas: readonly Element[], moves = false): Picture {
  const frames = areas.map((area) => area.getBoundingClientRect());
  const [left, top] = [Math.min(...frames.map((one) => one.left)), Math.min(...frames.map((one) => one.top))];
  const width = Math.max(...frames.map((one) => one.right)) - left;
  const height = Math.max(...frames.map((one) => one.bottom)) - top;
  const root = make("svg", { xmlns: svg, width, height, viewBox: `0 0 ${round(width)} ${round(height)}` });
  const markers = make("defs", {});
  document
    .querySelectorAll("marker[id^='tip'], marker[id='channel-tip'], marker[id='trunk-tip']")
    .forEach((marker) => markers.append(copy(marker)));
  root.append(markers);
  areas.forEach((area, at) => {
    const frame = frames[at]!;
    // An SVG within an SVG cuts off everything outside of it.
    const size = { width: round(frame.width), height: round(frame.height) };
    const inner = make("svg", { x: round(frame.left - left), y: round(frame.top - top), ...size });
    inner.append(make("rect", { ...size, fill: getComputedStyle(area).getPropertyValue("--net-bg") || "#fff" }));
    for (const part of stacked(area)) add(part, inner, frame, moves);
    root.append(inner);
  });
  return { text: new XMLSerializer().serializeToString(root), width, height };
}

/** The first picture of a film: no element has fired or is running. */
export function takeFirstPicture(area: Element): Picture {
  const lit = changing.flatMap((name) => [...area.getElementsByClassName(name)].map((element) => ({ element, name })));
  area.classList.add("still");
  for (const { element, name } of lit) element.classList.remove(name);
  try {
    return takePicture([area], true);
  } finally {
    for (const { element, name } of lit) element.classList.add(name);
    area.classList.remove("still");
  }
}

/** The parts of a flow from the lowest to the highest. */
function stacked(area: Element): Element[] {
  const parts = [...area.querySelectorAll(".react-flow__edges > svg, .react-flow__node, .react-flow__viewport-portal > *")];
  const height = (part: Element) => Number(getComputedStyle(part).zIndex) || 0;
  return parts.sort((a, b) => height(a) - height(b));
}

/** HTML becomes boxes and texts at their positions on the screen; SVG is copied with its style. */
function add(element: Element, to: Element, frame: DOMRect, moves: boolean): void {
  const style = getComputedStyle(element);
  if (hidden(style)) return;
  if (element instanceof SVGSVGElement) {
    const at = element.getScreenCTM();
    const copied =
      at &&
      make("g", { transform: `matrix(${[at.a, at.b, at.c, at.d, at.e - frame.left, at.f - frame.top].map(exact).join(" ")})` });
    if (!copied) return;
    for (const child of element.children) copied.append(copy(child, moves));
    to.append(copied);
    return;
  }
  const box = element.getBoundingClientRect();
  const scale = element instanceof HTMLElement && element.offsetWidth > 0 ? box.width / element.offsetWidth : 1;
  addBox(style, box, scale, to, frame);
  if (style.webkitLineClamp && style.webkitLineClamp !== "none") return addLines(element, style, scale, to, frame);
  for (const node of element.childNodes) {
    if (node instanceof Element) add(node, to, frame, moves);
    else if (node.nodeType === Node.TEXT_NODE && node.textContent?.trim()) addText(node, style, scale, to, frame);
  }
}

function addBox(style: CSSStyleDeclaration, box: DOMRect, scale: number, to: Element, frame: DOMRect): void {
  const clear = (colour: string) => colour === "rgba(0, 0, 0, 0)" || colour === "transparent";
  const width = (side: "Top" | "Bottom" | "Left") =>
    style[`border${side}Style`] === "none" || clear(style[`border${side}Color`])
      ? 0
      : parseFloat(style[`border${side}Width`]) * scale;
  const border = width("Top");
  const outlined = border > 0 && width("Left") > 0;
  if (box.width === 0) return;
  // A border only above or below becomes a line.
  if (!outlined)
    for (const [side, y] of [
      ["Top", box.top],
      ["Bottom", box.bottom],
    ] as const)
      if (width(side) > 0)
        to.append(
          make("path", {
            d: `M${round(box.left - frame.left)} ${round(y - frame.top)}h${round(box.width)}`,
            stroke: plainColour(style[`border${side}Color`]),
            "stroke-width": round(width(side)),
            ...(style[`border${side}Style`] === "dashed" ? { "stroke-dasharray": "4 3" } : {}),
          }),
        );
  if (clear(style.backgroundColor) && !outlined) return;
  const rect = make("rect", {
    x: round(box.left - frame.left),
    y: round(box.top - frame.top),
    width: round(box.width),
    height: round(box.height),
    rx: round(Math.min(parseFloat(style.borderTopLeftRadius) * scale || 0, box.height / 2)),
  });
  rect.setAttribute("fill", clear(style.backgroundColor) ? "none" : plainColour(style.backgroundColor));
  if (outlined) {
    rect.setAttribute("stroke", plainColour(style.borderTopColor));
    rect.setAttribute("stroke-width", String(round(border)));
    if (style.borderTopStyle === "dashed") rect.setAttribute("stroke-dasharray", "4 3");
  }
  to.append(rect);
}

/** A name in several lines. Lines that do not fit are left out, as on the screen. */
function addLines(element: Element, style: CSSStyleDeclaration, scale: number, to: Element, frame: DOMRect): void {
  const bottom = element.getBoundingClientRect().bottom;
  const lines: { text: string; box: DOMRect }[] = [];
  let cut = false;
  const walk = document.createTreeWalker(element, NodeFilter.SHOW_TEXT);
  for (let node = walk.nextNode(); node; node = walk.nextNode())
    for (let at = 0; at < node.textContent!.length; at += 1) {
      const range = document.createRange();
      range.setStart(node, at);
      range.setEnd(node, at + 1);
      const box = range.getBoundingClientRect();
      const last = lines.at(-1);
      if (box.top + box.height / 2 > bottom) cut = true;
      else if (last && Math.abs(last.box.top - box.top) < 2) last.text += node.textContent![at]!;
      else lines.push({ text: node.textContent![at]!, box });
    }
  const end = lines.at(-1);
  if (cut && end) end.text = `${end.text.slice(0, -1)}…`;
  for (const { text, box } of lines) addLine(text, box, style, scale, to, frame);
}

function addText(node: Node, style: CSSStyleDeclaration, scale: number, to: Element, frame: DOMRect): void {
  const range = document.createRange();
  range.selectNodeContents(node);
  addLine(node.textContent!.replace(/\s+/g, " "), range.getBoundingClientRect(), style, scale, to, frame);
}

function addLine(words: string, box: DOMRect, style: CSSStyleDeclaration, scale: number, to: Element, frame: DOMRect): void {
  const size = parseFloat(style.fontSize) * scale;
  const text = make("text", {
    x: round(box.left - frame.left),
    y: round(box.top - frame.top + box.height / 2 + size * 0.35),
    fill: plainColour(style.color),
    "font-size": round(size),
    "font-family": style.fontFamily,
    "font-weight": style.fontWeight,
  });
  text.setAttribute("xml:space", "preserve");
  text.textContent = words;
  to.append(text);
}

function copy(element: Element, moves = false): Element {
  const same = element.cloneNode(false) as Element;
  const style = getComputedStyle(element);
  if (hidden(style) && !(element instanceof SVGMarkerElement)) {
    if (!moves) return make("g", {});
    same.setAttribute("display", "none");
  }
  for (const property of kept) {
    const value = style.getPropertyValue(property);
    if (value && value !== "none" && value !== "normal")
      same.setAttribute(property, plainColour(value.replace(/url\("[^"#]*#/, 'url("#')));
    else if (value === "none" && (property === "fill" || property === "stroke")) same.setAttribute(property, value);
  }
  for (const name of ["style", "role", "aria-label", "tabindex"]) same.removeAttribute(name);
  if (moves) same.classList.remove(...changing);
  else same.removeAttribute("class");
  if (!(element instanceof SVGMarkerElement)) same.removeAttribute("id");
  for (const child of element.childNodes) same.append(child instanceof Element ? copy(child, moves) : child.cloneNode(true));
  return same;
}

/** A mixed colour as the browser computes it, in a notation that every program understands. */
export function plainColour(value: string): string {
  const mixed = /^color\(srgb ([-\d.e]+) ([-\d.e]+) ([-\d.e]+)(?: \/ ([\d.e-]+))?\)$/.exec(value);
  if (!mixed) return value;
  const [red, green, blue] = mixed.slice(1, 4).map((part) => Math.round(Math.min(1, Math.max(0, Number(part))) * 255));
  return mixed[4] === undefined ? `rgb(${red}, ${green}, ${blue})` : `rgba(${red}, ${green}, ${blue}, ${mixed[4]})`;
}

function make(name: string, attributes: Record<string, string | number>): Element {
  const element = document.createElementNS(svg, name);
  for (const [key, value] of Object.entries(attributes)) if (key !== "xmlns") element.setAttribute(key, String(value));
  return element;
}

const round = (value: number) => Math.round(value * 100) / 100;
const exact = (value: number) => Number(value.toPrecision(8));

export async function asPng({ text, width, height }: Picture, scale = 2): Promise<Blob> {
  const image = new Image();
  image.src = `data:image/svg+xml;charset=utf-8,${encodeURIComponent(text)}`;
  await image.decode();
  const canvas = document.createElement("canvas");
  canvas.width = width * scale;
  canvas.height = height * scale;
  canvas.getContext("2d")!.drawImage(image, 0, 0, canvas.width, canvas.height);
  return new Promise((done, failed) =>
    canvas.toBlob((blob) => (blob ? done(blob) : failed(new Error("the picture could not be drawn"))), "image/png"),
  );
}

export function download(blob: Blob, name: string): void {
  const address = URL.createObjectURL(blob);
  const link = document.createElement("a");
  link.href = address;
  link.download = name;
  link.click();
  setTimeout(() => URL.revokeObjectURL(address), 10_000);
}
