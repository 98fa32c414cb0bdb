import { lazy, Suspense } from "react";
import { useStore, useStudio } from "../hooks/use";
import { useComplaints, useStructure } from "../hooks/use_structure";
import { sameBreakpoint, type NamedBreakpoint } from "../live/run/breakpoints";
import { layerTitle, operationText } from "../model/net/labels";
import type { Element, NetModel } from "../model/net/net";
import { findThing, selectedPath, type Thing } from "../model/structure/structure";
import { Term } from "../canvas/term";
import { isBundlePath } from "../model/structure/bundles";
import { BundlePanel } from "./bundle_panel";
import { MemoryNow } from "./run/memory_now";

const forms = () => import("./forms/every_form");
const EditForm = lazy(() => forms().then((all) => ({ default: all.EditForm })));
const SystemForm = lazy(() => forms().then((all) => ({ default: all.SystemForm })));

/** Describes the selected element, and offers its possible changes. */
export function InspectPanel() {
  const studio = useStudio();
  const structure = useStructure();
  const complaints = useComplaints(structure);
  const net = useStore(studio.draft.store, (draft) => draft.net);
  const view = useStore(studio.view, (all) => all.view);
  const selected = useStore(studio.view, (all) => all.selected);
  if (selected === null)
    return (
      <Suspense fallback={<p className="faint">Loading the form…</p>}>
        <SystemForm structure={structure} />
      </Suspense>
    );
  if (isBundlePath(selected)) return <BundlePanel structure={structure} path={selected} />;
  const thing = findThing(structure, selected);
  const element = net?.find(selected);
  if (!thing && !element) return <p className="faint">{selected} is not there any more.</p>;
  const line = thing?.of.line ?? element!.span.line;
  return (
    <div className="inspect">
      <div className="titled">
        <h2>{title(thing, selected)}</h2>
        <Term of={thing ? termOf(thing) : element!.kind} />
      </div>
      <p className="path">{thing?.kind === "channel" ? "" : selectedPath(selected) || "system"}</p>
      {(thing ? (complaints.get(selected)?.messages ?? []) : []).map((text) => (
        <p key={text} className="problem-hint">
          {text}
        </p>
      ))}
      {net && <MemoryNow subsystem={ownerOf(thing, selected)} />}
      {thing && (
        <Suspense fallback={<p className="faint">Loading the form…</p>}>
          <EditForm key={studio.formOf(selected)} structure={structure} thing={thing} />
        </Suspense>
      )}
      {net && element && (
        <>
          {thing && <h3>Its net</h3>}
          <dl>{facts(net, element).map(([term, value]) => [<dt key={term}>{term}</dt>, <dd key={`${term}.`}>{value}</dd>])}</dl>
        </>
      )}
      {net && element && <Breakpoints net={net} element={element} path={selected} />}
      <div className="links">
        {line > 0 && (
          <button className="link" onClick={() => studio.showLine(line)}>
            Line {line} of the specification
          </button>
        )}
        {view === "structure" && element && (
          <button className="link" onClick={() => studio.flyTo(selected)}>
            Show its net
          </button>
        )}
        {view === "net" && thing && !selectedPath(selected).startsWith("template:") && (
          <button className="link" onClick={() => studio.view.set({ view: "structure" })}>
            Show it in the structure
          </button>
        )}
      </div>
    </div>
  );
}

/** The subsystem of the selected element, in the names of its memory: "robot[3].control". */
function ownerOf(thing: Thing | undefined, selected: string): string {
  if (thing?.kind === "agent" || thing?.kind === "template" || thing?.kind === "channel") return "";
  return selectedPath(selected).split(".").slice(0, 2).join(".");
}

/** The breakpoints of a run in simulated time. */
function Breakpoints({ net, element, path }: { net: NetModel; element: Element; path: string }) {
  if (element.kind === "place") return <BreakpointButton at={{ on: "place", path }} text="Pause a run here" />;
  if (element.kind !== "transition" || net.transitionByName.get(path) === undefined) return null;
  const { condition } = net.page(element.page).transitions[element.index]!;
  return (
    <>
      <BreakpointButton at={{ on: "transition", path }} text="Pause a run when it fires" />
      {condition !== null && condition.truth !== "always" && (
        <BreakpointButton at={{ on: "condition", path }} text="Pause a run when its condition holds" />
      )}
    </>
  );
}

function BreakpointButton({ at, text }: { at: NamedBreakpoint; text: string }) {
  const studio = useStudio();
  const set = useStore(studio.runner.store, (all) => all.breakpoints.some((one) => sameBreakpoint(one, at)));
  return (
    <div className="buttons">
      <button aria-pressed={set} onClick={() => studio.runner.toggleBreakpoint(at)}>
        {set ? "Remove the breakpoint" : text}
      </button>
    </div>
  );
}

/** The kind of an element in the words of the glossary. */
function termOf(thing: Thing): string {
  return thing.kind === "subsystem" ? (thing.of.kind === "control" ? "control subsystem" : thing.of.kind) : thing.kind;
}

const kinds: Record<Thing["kind"], string> = {
  agent: "Agent",
  template: "Template",
  subsystem: "Subsystem",
  behaviour: "Behaviour",
  buffer: "Buffer",
  channel: "Channel",
};

function title(thing: Thing | undefined, selected: string): string {
  if (thing?.kind === "channel") return "Channel";
  const name =
    selectedPath(selected)
      .replace(/^template:/, "")
      .split(".")
      .at(-1) || "system";
  if (thing?.kind === "behaviour" && thing.of.isGroup) return `Group ${name}`;
  return thing ? `${kinds[thing.kind]} ${name}` : name;
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
    const fused: [string, string][] =
      node.fusion === null ? [] : [["Fused", "one place seen in several nets: memory of a channel"]];
    return [
      ["Kind", "place"],
      ...(operation ? [["Operation", operation] as [string, string]] : []),
      ...fused,
      ["At start", node.tokens ? `${node.tokens} token` : "empty"],
    ];
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
