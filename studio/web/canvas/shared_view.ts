import { useReactFlow, useStore as useFlow, useStoreApi } from "@xyflow/react";
import { useEffect, useState } from "react";
import { useStudio } from "../hooks/use";
import type { Look } from "../live/camera";
import type { Sheet } from "../model/geometry";

/** Looks where the other panes look, or at the whole drawing; before it does, nothing is drawn, for it would be drawn twice. */
export function useSharedView(root: Sheet | undefined): boolean {
  const { camera } = useStudio();
  const flow = useReactFlow();
  const store = useStoreApi();
  const ready = useFlow((state) => state.width > 0) && root !== undefined;
  const [shown, setShown] = useState(false);
  useEffect(() => {
    if (!ready || !root) return;
    const now = () => setShown(true);
    const follow = (look: Look) => void flow.setViewport(look).then(now);
    const leave = camera.join(follow);
    const stop = store.subscribe(({ transform }, before) => {
      if (transform === before.transform) return;
      const [x, y, zoom] = transform;
      camera.moved({ x, y, zoom }, follow);
    });
    const whole = { x: 0, y: 0, width: root.width, height: root.height };
    if (!camera.look) void flow.fitBounds(whole, { duration: 0, padding: 0.03 }).then(now);
    return () => (leave(), stop());
    // What the root is later does not move the view.
  }, [ready, camera, flow, store]);
  return shown;
}
