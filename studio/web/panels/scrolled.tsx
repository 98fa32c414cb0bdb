import type { ReactNode } from "react";

/** The frame of a panel that is read from top to bottom, and scrolled. */
export function Scrolled({ children }: { children: ReactNode }) {
  return (
    <div className="panel" tabIndex={-1}>
      {children}
    </div>
  );
}
