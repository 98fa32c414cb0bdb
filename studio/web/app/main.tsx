import "@xyflow/react/dist/style.css";
import { StrictMode } from "react";
import { createRoot } from "react-dom/client";
import { Studio } from "../live/studio";
import { warmElk } from "../canvas/elk";
import { App } from "./app";
import { panelTable } from "./panel_table";
import "./style.css";
import { StudioContext } from "../hooks/use";

const studio = new Studio(panelTable);
void studio.open();
// The drawing says why, if it cannot be laid out.
warmElk().catch(() => undefined);
createRoot(document.getElementById("root")!).render(
  <StrictMode>
    <StudioContext value={studio}>
      <App />
    </StudioContext>
  </StrictMode>,
);
