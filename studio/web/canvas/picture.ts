/** A view of the page as one SVG that stands on its own, for a paper or a report. */

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
  "marker-end",
];
const hidden = (style: CSSStyleDeclaration) => style.display === "none" || style.visibility === "hidden";

export interface Picture {
  text: string;
  width: number;
  height: number;
}

/** What of `area` (an element with a flow in it) can be seen now. */
export function takePicture(area: Element): Picture {
  const frame = area.getBoundingClientRect();
  const root = make("svg", {
    xmlns: svg,
    width: frame.width,
    height: frame.height,
    viewBox: `0 0 ${round(frame.width)} ${round(frame.height)}`,
  });
  root.append(
    make("rect", { width: "100%", height: "100%", fill: getComputedStyle(area).getPropertyValue("--net-bg") || "#fff" }),
  );
  const markers = make("defs", {});
  document.querySelectorAll("marker[id^='tip'], marker[id='channel-tip']").forEach((marker) => markers.append(copy(marker)));
  root.append(markers);
  for (const part of stacked(area)) add(part, root, frame);
  return { text: new XMLSerializer().serializeToString(root), width: frame.width, height: frame.height };
}

/** The parts of a flow from the lowest to the highest. */
function stacked(area: Element): Element[] {
  const parts = [...area.querySelectorAll(".react-flow__edges > svg, .react-flow__node, .react-flow__edgelabel-renderer > *")];
  const height = (part: Element) => Number(getComputedStyle(part).zIndex) || 0;
  return parts.sort((a, b) => height(a) - height(b));
}

/** HTML becomes boxes and texts where they stand on the screen; SVG is copied with its style. */
function add(element: Element, to: Element, frame: DOMRect): void {
  const style = getComputedStyle(element);
  if (hidden(style)) return;
  if (element instanceof SVGSVGElement) {
    const at = element.getScreenCTM();
    const copied =
      at &&
      make("g", { transform: `matrix(${[at.a, at.b, at.c, at.d, at.e - frame.left, at.f - frame.top].map(exact).join(" ")})` });
    if (!copied) return;
    for (const child of element.children) copied.append(copy(child));
    to.append(copied);
    return;
  }
  const box = element.getBoundingClientRect();
  const scale = element instanceof HTMLElement && element.offsetWidth > 0 ? box.width / element.offsetWidth : 1;
  addBox(style, box, scale, to, frame);
  for (const node of element.childNodes) {
    if (node instanceof Element) add(node, to, frame);
    else if (node.nodeType === Node.TEXT_NODE && node.textContent?.trim()) addText(node, style, scale, to, frame);
  }
}

function addBox(style: CSSStyleDeclaration, box: DOMRect, scale: number, to: Element, frame: DOMRect): void {
  const border = parseFloat(style.borderTopWidth) * scale;
  const clear = (colour: string) => colour === "rgba(0, 0, 0, 0)" || colour === "transparent";
  const outlined = border > 0 && style.borderTopStyle !== "none" && !clear(style.borderTopColor);
  if (box.width === 0 || (clear(style.backgroundColor) && !outlined)) return;
  const rect = make("rect", {
    x: round(box.left - frame.left),
    y: round(box.top - frame.top),
    width: round(box.width),
    height: round(box.height),
    rx: round(Math.min(parseFloat(style.borderTopLeftRadius) * scale || 0, box.height / 2)),
  });
  rect.setAttribute("fill", clear(style.backgroundColor) ? "none" : style.backgroundColor);
  if (outlined) {
    rect.setAttribute("stroke", style.borderTopColor);
    rect.setAttribute("stroke-width", String(round(border)));
    if (style.borderTopStyle === "dashed") rect.setAttribute("stroke-dasharray", "4 3");
  }
  to.append(rect);
}

function addText(node: Node, style: CSSStyleDeclaration, scale: number, to: Element, frame: DOMRect): void {
  const range = document.createRange();
  range.selectNodeContents(node);
  const box = range.getBoundingClientRect();
  const size = parseFloat(style.fontSize) * scale;
  const text = make("text", {
    x: round(box.left - frame.left),
    y: round(box.top - frame.top + box.height / 2 + size * 0.35),
    fill: style.color,
    "font-size": round(size),
    "font-family": style.fontFamily,
    "font-weight": style.fontWeight,
  });
  text.textContent = node.textContent!.trim();
  to.append(text);
}

function copy(element: Element): Element {
  const same = element.cloneNode(false) as Element;
  const style = getComputedStyle(element);
  if (hidden(style) && !(element instanceof SVGMarkerElement)) return make("g", {});
  for (const property of kept) {
    const value = style.getPropertyValue(property);
    if (value && value !== "none" && value !== "normal") same.setAttribute(property, value.replace(/url\("[^"#]*#/, 'url("#'));
    else if (value === "none" && (property === "fill" || property === "stroke")) same.setAttribute(property, value);
  }
  for (const name of ["class", "style", "role", "aria-label", "tabindex"]) same.removeAttribute(name);
  if (!(element instanceof SVGMarkerElement)) same.removeAttribute("id");
  for (const child of element.childNodes) same.append(child instanceof Element ? copy(child) : child.cloneNode(true));
  return same;
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
