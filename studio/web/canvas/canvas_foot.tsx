import { Controls } from "@xyflow/react";
import type { ReactNode } from "react";

/** The row below a drawing: the meaning of its symbols, and its zoom. Nothing of it lies over the drawing. */
export function CanvasFoot({ children, zoom }: { children?: ReactNode; zoom: "none" | "near and far" | "near, far and whole" }) {
  return (
    <div className="canvas-foot">
      {children}
      <span className="spring" />
      {zoom !== "none" && (
        <Controls orientation="horizontal" showInteractive={false} showFitView={zoom === "near, far and whole"} />
      )}
    </div>
  );
}
