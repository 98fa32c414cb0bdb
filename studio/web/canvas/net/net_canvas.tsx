import { ReactFlowProvider } from "@xyflow/react";
import { useState, type ReactNode } from "react";
import { useStore, useStudio } from "../../hooks/use";
import type { Pane } from "../../live/scene";
import { spoken } from "../../model/net/labels";
import type { NetModel } from "../../model/net/net";
import { Breadcrumbs } from "../breadcrumbs";
import { Drawing } from "./drawing";
import { useSheets } from "./sheets";
import { ArrowTips } from "./symbols";

export interface DrawnPane {
  pane: Pane;
  net: NetModel;
  title: string;
  /** The elements above and below its drawing. */
  head: ReactNode;
  foot: ReactNode;
  /** A legend in a corner of it. */
  legend: ReactNode;
}

/** The net, once or twice side by side. All panes show the same part of it. */
export function NetCanvas({ panes, between, film }: { panes: readonly DrawnPane[]; between: ReactNode; film: ReactNode }) {
  const studio = useStudio();
  const selected = useStore(studio.view, (view) => view.selected);
  const sheets = useSheets(panes.map(({ net }) => net));
  const [current, setCurrent] = useState(0);
  const { net } = panes[0]!;
  return (
    <div className="canvas" data-testid="canvas">
      <ArrowTips />
      <Breadcrumbs net={net} page={current < net.pages.length ? current : 0} film={film} />
      {between}
      <div className="panes">
        {panes.map((drawn, at) => (
          // The key is the position: if the pane gets another content, the view stays where it is.
          <section key={at} className="net-pane" aria-label={`Net of ${drawn.title}`}>
            {drawn.head}
            <ReactFlowProvider>
              <Drawing
                pane={drawn.pane}
                net={drawn.net}
                sheets={sheets.of(drawn.net)}
                version={sheets.version}
                lead={at === 0}
                label={panes.length > 1 ? `Drawing of the net: ${drawn.title}` : "Drawing of the net"}
                onCurrent={setCurrent}
                legend={drawn.legend}
              />
            </ReactFlowProvider>
            {drawn.foot}
          </section>
        ))}
      </div>
      <div className="visually-hidden" aria-live="polite">
        {selected === null ? "" : spoken(net, selected)}
      </div>
    </div>
  );
}
