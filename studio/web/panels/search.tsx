import { useEffect, useMemo, useRef, useState, type KeyboardEvent } from "react";
import { focusDrawn } from "../canvas/drawing_focus";
import { useStore, useStudio } from "../hooks/use";
import { useStructure } from "../hooks/use_structure";
import { layerTitle } from "../model/net/labels";
import type { NetModel } from "../model/net/net";
import { rank } from "../model/structure/rank";
import { findThing, type Structure } from "../model/structure/structure";

interface Found {
  path: string;
  kind: string;
  /** The fields of a buffer, if it is selected. */
  selection?: string;
}

/** Buffers have no page of the net: they are shown in the structure. */
const buffer = "buffer";
const buffersOf = (structure: Structure): Found[] =>
  structure.agents.flatMap((agent) =>
    agent.subsystems.flatMap((one) => one.buffers.map(({ path, selection }) => ({ path, kind: buffer, selection }))),
  );

/** A net with more agents than this is searched by agents first. */
const manyAgents = 1000;

/**
 * The possible meanings of a text. In a large fleet: the agents, and the elements of those that fit its first
 * word or name best.
 */
function candidates(net: NetModel | null, text: string): Found[] {
  if (!net) return [];
  const { agents } = net.elements;
  const isLarge = agents.length > manyAgents;
  const first = text.trim().split(/[\s.]/)[0]!;
  const all = agents.map(({ name }, agent) => ({ path: name, agent }));
  const near = isLarge ? (first ? rank(first, all, ({ path }) => path).slice(0, 10) : []) : all;
  const of = (what: "pages" | "places" | "transitions") => near.flatMap(({ agent }) => net.elements.range(what, agent));
  const own = { places: net.elements.range("places", -1), transitions: net.elements.range("transitions", -1) };
  const fused = isLarge
    ? []
    : Array.from({ length: net.places.length - net.elements.firstFused }, (_, at) => net.elements.firstFused + at);
  return [
    ...(isLarge ? all.map(({ path }) => ({ path, kind: layerTitle.agent })) : []),
    ...of("pages").map((at) => ({ path: net.page(at).path, kind: layerTitle[net.page(at).layer] })),
    ...[...own.places, ...of("places")].map((at) => ({ path: net.places.at(at)!.name, kind: "place" })),
    ...fused.map((at) => ({ path: net.places.at(at)!.name, kind: "channel" })),
    ...[...own.transitions, ...of("transitions")].map((at) => ({ path: net.transitions.at(at)!.name, kind: "transition" })),
  ];
}

/** Search by path: type parts of it and choose; the drawing flies there. */
export function Search() {
  const studio = useStudio();
  const net = useStore(studio.draft.store, (draft) => draft.net);
  const view = useStore(studio.view, (all) => all.view);
  const [text, setText] = useState("");
  const [chosen, setChosen] = useState(0);
  const head = net && net.elements.agents.length > manyAgents ? text : "";
  const structure = useStructure();
  const all = useMemo(() => [...candidates(net, head), ...buffersOf(structure)], [net, head, structure]);
  const found = useMemo(() => rank(text, all, (one) => one.path).slice(0, 12), [text, all]);
  const dialog = useRef<HTMLDialogElement>(null);
  const close = () => studio.view.set({ searching: false });
  useEffect(() => void dialog.current?.showModal(), []);
  const take = (one: Found | undefined) => {
    // The structure has all but places and transitions.
    const near = one && (one.selection ?? (view === "structure" && findThing(structure, one.path) ? one.path : undefined));
    if (near !== undefined) studio.comeNear(near, structure);
    else if (one) studio.flyTo(one.path);
    close();
    if (one) focusDrawn(near === undefined ? "net" : "structure", near ?? one.path);
  };
  const key = (event: KeyboardEvent) => {
    if (event.key === "ArrowDown") setChosen(Math.min(chosen + 1, found.length - 1));
    else if (event.key === "ArrowUp") setChosen(Math.max(chosen - 1, 0));
    else if (event.key === "Enter") take(found[chosen]);
    else return;
    event.preventDefault();
  };
  return (
    <dialog
      ref={dialog}
      className="search"
      aria-label="Find by path"
      onClose={close}
      onClick={(event) => event.target === dialog.current && close()}
    >
      <input
        autoFocus
        type="text"
        placeholder="Find by path, such as control.follow"
        aria-label="Path"
        role="combobox"
        aria-expanded="true"
        aria-controls="search-results"
        aria-activedescendant={found.length ? `found-${chosen}` : undefined}
        value={text}
        onChange={(event) => {
          setText(event.target.value);
          setChosen(0);
        }}
        onKeyDown={key}
      />
      <ul id="search-results" role="listbox" aria-label="Elements">
        {found.map((one, at) => (
          <li
            key={one.selection ?? `${one.kind}:${one.path}`}
            id={`found-${at}`}
            role="option"
            aria-selected={at === chosen}
            onClick={() => take(one)}
            onPointerMove={() => setChosen(at)}
          >
            <span className="path">{one.path}</span>
            <span className="kind">{one.kind}</span>
          </li>
        ))}
        {found.length === 0 && (
          <li className="faint" role="option" aria-selected="false">
            Nothing has such a path
          </li>
        )}
      </ul>
    </dialog>
  );
}
