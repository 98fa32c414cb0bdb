/** How a shape is drawn, in units of its sheet. */
export interface ShapeInk {
  shown: boolean;
  fill: string | null;
  stroke: string | null;
  width: number;
  dash: number[];
  opacity: number;
}

/** How letters are drawn: of `u` units of the sheet, which may grow `more` times while they are far away. */
export interface LetterInk {
  shown: boolean;
  u: number;
  more: number;
  k: number;
  fill: string;
  halo: string | null;
  haloWidth: number;
  weight: string;
  family: string;
}

const svg = "http://www.w3.org/2000/svg";

/** An element inside another one, by a selector such as "g.element.bar". */
function made(selector: string, parent: Element): SVGElement {
  const [tag, ...classes] = selector.split(".");
  const element = document.createElementNS(svg, tag!) as SVGElement;
  element.setAttribute("class", classes.join(" "));
  return parent.appendChild(element);
}

const visible = (colour: string) =>
  colour === "none" || colour === "transparent" || colour === "rgba(0, 0, 0, 0)" ? null : colour;

/**
 * Colours, lines and letters of a drawing on a canvas. They are those of the style sheet: an element of SVG with
 * the same classes is made once and asked. So both drawings look alike, in every theme.
 */
export class Ink {
  private readonly shapes = new Map<string, ShapeInk>();
  private readonly letters_ = new Map<string, LetterInk>();

  /** area: the element that the drawing is in. */
  constructor(private readonly area: Element) {}

  /** sheet, element: the classes; part: the way from the element to the shape, such as "circle.shape". */
  shape(sheet: string, element: string, part: string): ShapeInk {
    const key = `${sheet}|${element}|${part}`;
    let ink = this.shapes.get(key);
    if (!ink) this.shapes.set(key, (ink = this.ask(sheet, element, part, shapeInk)));
    return ink;
  }

  letters(sheet: string, element: string, part: string): LetterInk {
    const key = `${sheet}|${element}|${part}`;
    let ink = this.letters_.get(key);
    if (!ink) this.letters_.set(key, (ink = this.ask(sheet, element, part, letterInk)));
    return ink;
  }

  private ask<T>(sheet: string, element: string, part: string, answer: (style: CSSStyleDeclaration) => T): T {
    const root = made("svg", this.area);
    root.setAttribute("class", sheet);
    root.setAttribute("aria-hidden", "true");
    root.setAttribute("style", "position: absolute; width: 0; height: 0; visibility: hidden");
    let at: SVGElement = root;
    if (element) (at = made("g", at)).setAttribute("class", element);
    for (const step of part.split(" ")) at = made(step, at);
    const found = answer(getComputedStyle(at));
    root.remove();
    return found;
  }
}

function shapeInk(style: CSSStyleDeclaration): ShapeInk {
  return {
    shown: style.display !== "none",
    fill: visible(style.fill),
    stroke: visible(style.stroke),
    width: parseFloat(style.strokeWidth) || 0,
    dash: style.strokeDasharray === "none" ? [] : style.strokeDasharray.split(",").map(parseFloat),
    opacity: Number(style.opacity),
  };
}

function letterInk(style: CSSStyleDeclaration): LetterInk {
  const number = (name: string, otherwise: number) => {
    const value = style.getPropertyValue(name).trim();
    return value === "" ? otherwise : Number(value);
  };
  return {
    shown: style.display !== "none",
    u: number("--u", parseFloat(style.fontSize)),
    more: number("--more", 1),
    k: number("--k", 1),
    fill: style.fill,
    halo: visible(style.stroke),
    haloWidth: parseFloat(style.strokeWidth) || 0,
    weight: style.fontWeight,
    family: style.fontFamily,
  };
}
