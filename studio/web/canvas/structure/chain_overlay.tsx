import { ViewportPortal } from "@xyflow/react";
import { useStore, useStudio } from "../../hooks/use";
import { roundedPath, type Box } from "../../model/net/geometry";
import { channelOf, withoutIndex } from "../../model/structure/structure";
import { shownChain } from "../../model/timing";
import type { Drawn } from "./drawn_structure";

const rim = 5;

/** The chain that the panel Timing shows: its subsystems with their numbers, and its channels. */
export function ChainOverlay({ drawn, boxOf }: { drawn: Drawn; boxOf: (path: string) => Box | undefined }) {
  const studio = useStudio();
  const visible = useStore(studio.dock.store, ({ seen }) => seen.includes("timing"));
  const chain = useStore(studio.timing.store, ({ found, chosen }) => shownChain(found, chosen));
  if (!visible || !chain) return null;
  const { drawing, structure } = drawn;
  const channels = new Set(chain.channels.flatMap((name) => channelOf(structure, name)?.index ?? []));
  const lines = [
    ...drawing.wires.filter(({ channel }) => channels.has(channel)).map(({ points }) => roundedPath(points, 6)),
    ...drawing.bundles
      .filter((bundle) => bundle.channels.some((one) => channels.has(one)))
      .map(({ points }) => roundedPath(points, 8)),
  ];
  const boxes = new Map(
    chain.path.flatMap((path, at) => {
      const box = boxOf(path);
      return box ? [[withoutIndex(path), { box, at: at + 1 }] as const] : [];
    }),
  );
  return (
    <ViewportPortal>
      <svg className="chain-lines" width={drawing.width} height={drawing.height} data-testid="chain" aria-hidden="true">
        {lines.map((line) => (
          <path key={line} d={line} />
        ))}
        {[...boxes].map(([path, { box }]) => (
          <rect
            key={path}
            data-chain={path}
            x={box.x - rim}
            y={box.y - rim}
            width={box.width + 2 * rim}
            height={box.height + 2 * rim}
            rx={rim + 3}
          />
        ))}
      </svg>
      {[...boxes].map(([path, { box, at }]) => (
        <span key={path} className="chain-number" aria-hidden="true" style={{ left: box.x - rim, top: box.y - rim }}>
          {at}
        </span>
      ))}
    </ViewportPortal>
  );
}
