import { useEffect, useState } from "react";
import { runningBehaviours } from "../model/game";
import type { NetModel } from "../model/net";
import { useStore, useStudio } from "./use";

/** Running behaviour by path of subsystem ("robot.control" -> "follow"), while something plays. */
export function useRunning(): ReadonlyMap<string, string> {
  const studio = useStudio();
  const net = useStore(studio.stage.shown, (all) => all.net);
  const [text, setText] = useState("");
  useEffect(() => {
    const look = () =>
      setText(net && studio.stage.mode !== "edit" && studio.stage.is(net) ? running(net, studio.stage.marking) : "");
    look();
    return studio.stage.subscribe(look);
  }, [net, studio]);
  return new Map(
    text
      .split("\n")
      .filter(Boolean)
      .map((line) => line.split("=") as [string, string]),
  );
}

function running(net: NetModel, marking: Int32Array): string {
  const now = runningBehaviours(net, marking);
  return net
    .subsystemPages()
    .flatMap((page) => {
      const { path, subsystem } = net.page(page);
      const name = subsystem === null ? undefined : now.get(subsystem);
      return name ? [`${path}=${name}`] : [];
    })
    .join("\n");
}
