import { useStore, useStudio } from "../app/use";
import { layerTitle, operationText } from "../model/labels";
import type { Element, NetModel } from "../model/net";

/** What the selected element is. */
export function InspectPanel() {
  const studio = useStudio();
  const net = useStore(studio.draft.store, (draft) => draft.net);
  const selected = useStore(studio.view, (view) => view.selected);
  const element = selected === null ? undefined : net?.find(selected);
  if (!net || !element) return <p className="faint">Select something in the drawing to see what it is.</p>;
  return (
    <div className="inspect">
      <h2>{element.path.split(".").at(-1) || "system"}</h2>
      <p className="path">{element.path || "system"}</p>
      <dl>{facts(net, element).map(([term, value]) => [<dt key={term}>{term}</dt>, <dd key={`${term}.`}>{value}</dd>])}</dl>
      {element.span.line > 0 && (
        <button className="link" onClick={() => studio.showLine(element.span.line)}>
          Line {element.span.line} of the specification
        </button>
      )}
    </div>
  );
}

function facts(net: NetModel, element: Element): [string, string][] {
  const page = net.page(element.page);
  if (element.kind === "page") {
    const of = net.page(net.pageByPath.get(element.path)!);
    const pages = of.nodes.filter((node) => node.page !== null).length;
    return [
      ["Layer", layerTitle[of.layer]],
      ["Net", `${of.nodes.length - pages} places, ${pages} pages, ${of.transitions.length} transitions`],
    ];
  }
  if (element.kind === "place") {
    const node = page.nodes[element.index]!;
    const operation = operationText(page, node.operation);
    const fused: [string, string][] = node.fusion === null ? [] : [["Fused", "one place seen in several nets: memory of a channel"]];
    return [["Kind", "place"], ...(operation ? [["Operation", operation] as [string, string]] : []), ...fused, ["At start", node.tokens ? `${node.tokens} token` : "empty"]];
  }
  const transition = page.transitions[element.index]!;
  const names = (nodes: number[]) => nodes.map((at) => page.nodes[at]!.name).join(", ");
  const { condition } = transition;
  return [
    ["Kind", "transition"],
    ["From", names(transition.inputs)],
    ["To", names(transition.outputs)],
    ["Condition", condition === null || condition.truth === "always" ? "none" : condition.text],
  ];
}
