import { useReactFlow, useStore as useFlow, useStoreApi } from "@xyflow/react";
import { useEffect, useState } from "react";
import { useStudio } from "../hooks/use";
import type { Look } from "../live/camera";
import type { Sheet } from "../model/net/geometry";

/**
 * Uses the view of the other panes, or else shows the whole drawing. Before that, it draws nothing, because
 * it would be drawn twice.
 */
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
    // Later changes of the root do not move the view.
  }, [ready, camera, flow, store]);
  return shown;
}
