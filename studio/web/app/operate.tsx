import { StrictMode, useEffect } from "react";
import { createRoot } from "react-dom/client";
import { StudioContext, useStore, useStudio } from "../hooks/use";
import { Studio } from "../live/studio";
import { ChosenValues } from "../panels/operate/chosen_values";
import { OperateBar } from "../panels/operate/operate_bar";
import { SeenWorld } from "../panels/operate/seen_world";
import { WhatRuns } from "../panels/operate/what_runs";
import { OperatorPanel, useShownPanels } from "../panels/run/operator_panel";
import type { StickKeys } from "../model/run/panel_inputs";
import type { PanelShown } from "../model/protocol";
import { Boundary } from "../panels/boundary";
import "./operate.css";

// The page for operators: panels, values, world and the stop, for a tablet.

function OperatePage() {
  const studio = useStudio();
  const theme = useStore(studio.view, (view) => view.theme);
  const { panels, chooser } = useShownPanels();
  useEffect(() => {
    document.documentElement.dataset.theme = theme;
  }, [theme]);
  const keys = keysOf(panels);
  // Half of them for each hand.
  const left = panels.slice(0, Math.floor(panels.length / 2));
  const right = panels.slice(left.length);
  const side = (name: string, shown: readonly PanelShown[]) =>
    shown.length > 0 && (
      <div className={`operate-panels ${name}`}>
        {shown.map((panel) => (
          <OperatorPanel key={panel.path} panel={panel} pageKeys={keys.get(panel.path) ?? null} />
        ))}
      </div>
    );
  return (
    <div className="operate">
      <OperateBar />
      <main className={`hands-${Math.min(panels.length, 2)}`}>
        <div className="operate-seen">
          <WhatRuns />
          {chooser}
          <Boundary>
            <SeenWorld />
          </Boundary>
          <ChosenValues />
        </div>
        {side("left", left)}
        {side("right", right)}
      </main>
    </div>
  );
}

/** A single stick is moved by letters and arrows; of several, the first by letters and the second by arrows. */
function keysOf(panels: readonly PanelShown[]): ReadonlyMap<string, StickKeys> {
  const sticks = panels.filter(({ controls }) => controls.some(({ control }) => control.startsWith("stick")));
  if (sticks.length === 1) return new Map([[sticks[0]!.path, "both"]]);
  const kinds: StickKeys[] = ["letters", "arrows"];
  return new Map(sticks.slice(0, kinds.length).map(({ path }, at) => [path, kinds[at]!]));
}

const studio = new Studio([], false);
void studio.open();
createRoot(document.getElementById("root")!).render(
  <StrictMode>
    <StudioContext value={studio}>
      <Boundary>
        <OperatePage />
      </Boundary>
    </StudioContext>
  </StrictMode>,
);
