import "@xyflow/react/dist/style.css";
import { StrictMode } from "react";
import { createRoot } from "react-dom/client";
import { Studio } from "../live/studio";
import { App } from "./app";
import { panelTable } from "./panel_table";
import "./style.css";
import { StudioContext } from "../hooks/use";

const studio = new Studio(panelTable);
void studio.open();
createRoot(document.getElementById("root")!).render(
  <StrictMode>
    <StudioContext value={studio}>
      <App />
    </StudioContext>
  </StrictMode>,
);
