import { useEffect, useMemo, useRef, useState, type KeyboardEvent } from "react";
import { useStore, useStudio } from "../hooks/use";
import { layerTitle } from "../model/labels";
import type { NetModel } from "../model/net";
import { rank } from "../model/rank";

interface Found {
  path: string;
  kind: string;
}

function everything(net: NetModel | null): Found[] {
  if (!net) return [];
  const pages = net.pages.map((page) => ({ path: page.path, kind: layerTitle[page.layer] }));
  const places = net.places.map((place) => ({ path: place.name, kind: place.channel === null ? "place" : "channel" }));
  const bars = net.transitions.map((transition) => ({ path: transition.name, kind: "transition" }));
  return [...pages.filter((page) => page.path), ...places, ...bars];
}

/** Search by path: type parts of it and choose; the drawing flies there. */
export function Search() {
  const studio = useStudio();
  const net = useStore(studio.draft.store, (draft) => draft.net);
  const [text, setText] = useState("");
  const [chosen, setChosen] = useState(0);
  const all = useMemo(() => everything(net), [net]);
  const found = useMemo(() => rank(text, all, (one) => one.path).slice(0, 12), [text, all]);
  const dialog = useRef<HTMLDialogElement>(null);
  const close = () => studio.view.set({ searching: false });
  useEffect(() => void dialog.current?.showModal(), []);
  const take = (one: Found | undefined) => {
    if (one) studio.flyTo(one.path);
    close();
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
            key={`${one.kind}:${one.path}`}
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
