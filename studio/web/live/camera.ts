/** A view: pixels from the corner, and pixels per unit of the drawing. */
export interface Look {
  x: number;
  y: number;
  zoom: number;
}

const same = (one: Look, other: Look) => one.x === other.x && one.y === other.y && one.zoom === other.zoom;

/** All panes of the drawing share one view: when one moves, the others follow. */
export class Camera {
  look: Look | null = null;
  private readonly panes = new Set<(look: Look) => void>();

  /** Joins the panes that move together; `follow` receives the new view. Returns a function that leaves. */
  join(follow: (look: Look) => void): () => void {
    if (this.panes.size === 0) this.look = null;
    else if (this.look) follow(this.look);
    this.panes.add(follow);
    return () => this.panes.delete(follow);
  }

  moved(look: Look, by: (look: Look) => void): void {
    if (this.look && same(this.look, look)) return;
    this.look = look;
    for (const pane of this.panes) if (pane !== by) pane(look);
  }
}
