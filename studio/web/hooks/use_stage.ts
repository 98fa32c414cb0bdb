import { useEffect, useState } from "react";
import type { Stage } from "../live/stage";
import type { NetModel } from "../model/net/net";
import { useStore, useStudio } from "./use";

/**
 * The running behaviour by path of the subsystem ("robot.control" -> "follow"), while
 * the stage plays something.
 */
export function useRunning(stage: Stage): ReadonlyMap<string, string> {
  const studio = useStudio();
  const net = useStore(stage.shown, (all) => all.net);
  const live = useStore(stage.shown, (all) => all.mode === "live");
  const told = useStore(studio.runner.store, (all) => all.behaviours);
  const [text, setText] = useState("");
  useEffect(() => {
    const look = () => setText(net && stage.mode !== "edit" && stage.is(net) ? running(net, stage.running(net)) : "");
    look();
    return stage.subscribe(look);
  }, [net, stage]);
  // Without the recording, only the reports of the controller are known.
  if (text === "" && live) return told;
  return new Map(
    text
      .split("\n")
      .filter(Boolean)
      .map((line) => line.split("=") as [string, string]),
  );
}

function running(net: NetModel, now: ReadonlyMap<number, string>): string {
  return net
    .subsystemPages()
    .flatMap((page) => {
      const { path, subsystem } = net.page(page);
      const name = subsystem === null ? undefined : now.get(subsystem);
      return name ? [`${path}=${name}`] : [];
    })
    .join("\n");
}
