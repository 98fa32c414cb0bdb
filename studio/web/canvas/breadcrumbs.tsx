import type { ReactNode } from "react";
import { useStore, useStudio } from "../hooks/use";
import { ExportButtons } from "./export_button";
import { layerTitle, pageName } from "../model/net/labels";
import type { NetModel } from "../model/net/net";

/**
 * The path from the system to the current page, and buttons to fold and unfold. A click on a part flies
 * there. film: the button that saves what is played as a film.
 */
export function Breadcrumbs({ net, page, film }: { net: NetModel; page: number; film: ReactNode }) {
  const studio = useStudio();
  const selected = useStore(studio.view, (view) => view.selected);
  const chain = net.ancestry(page);
  const foldable = selected !== null && net.pageByPath.has(selected) && selected !== "";
  const foldAll = (folded: boolean) => {
    studio.foldMany(
      net.children(page).map((child) => net.page(child).path),
      folded,
    );
    studio.fly(net.page(page).path);
  };
  return (
    <nav className="breadcrumbs" aria-label="Layers">
      <ol>
        {chain.map((at) => (
          <li key={at}>
            <button
              className="crumb"
              aria-current={at === page ? "page" : undefined}
              title={layerTitle[net.page(at).layer]}
              onClick={() => studio.fly(net.page(at).path)}
            >
              {pageName(net.page(at))}
            </button>
          </li>
        ))}
      </ol>
      <span className="layer-name">{layerTitle[net.page(page).layer]}</span>
      <span className="spring" />
      {foldable && (
        <button
          className="quiet"
          onClick={() => studio.fold(selected, true)}
          title="Draw the selected page as a double circle (F)"
        >
          Fold {selected.split(".").at(-1)}
        </button>
      )}
      {net.children(page).length > 0 && (
        <>
          <button className="quiet" onClick={() => foldAll(true)} title="Draw the pages of this net as double circles">
            Fold all
          </button>
          <button className="quiet" onClick={() => foldAll(false)} title="Show the nets of the pages of this net">
            Unfold all
          </button>
        </>
      )}
      {film}
      <ExportButtons name={net.page(page).path} />
    </nav>
  );
}
