import { ViewportPortal } from "@xyflow/react";
import { useState } from "react";
import { roundedPath } from "../model/net/geometry";
import { channelLabel, channelPath, withoutIndex, type Channel, type Structure } from "../model/structure/structure";
import { isNext, type StructureDrawing } from "../model/structure/structure_graph";

/** The appearance of a channel besides its modes. */
export interface ChannelLook {
  selected: string | null;
  complaints: ReadonlyMap<string, { severity: "error" | "warning" }>;
  /** Indices of the channels at which a subsystem is stuck. */
  stuck: ReadonlySet<number>;
}

const blocks = ({ send, receive, model }: Channel) => send === "blocking" || receive !== "non_blocking" || model !== "";

const spoken = (channel: Channel) => {
  const { modes, timeout } = channelLabel(channel);
  return `${modes}${timeout ? ` ${timeout}` : ""}, channel from ${channel.from}, ${channel.send}, to ${channel.to}, ${channel.receive}`;
};

/** The text of a label. */
const meaning = ({ send, receive, model, timeout }: Channel) =>
  model
    ? `It works as the communication model ${model} says.`
    : `The sender ${send === "blocking" ? "waits until the value is taken (B)" : "does not wait (N)"}, ` +
      `the receiver ${receive !== "non_blocking" ? "waits for a value (B)" : "does not wait (N)"}` +
      `${timeout ? `, at most ${timeout}` : ""}.`;

/**
 * The channels of the structure: solid if an end waits, dashed if none does. Labels name the modes of both
 * ends. All of it comes from the same layout as the boxes, so a channel ends where its buffer is drawn.
 */
export function ChannelLayer({
  structure,
  drawing,
  look,
}: {
  structure: Structure;
  drawing: StructureDrawing;
  look: ChannelLook;
}) {
  const [over, setOver] = useState<number | null>(null);
  const chosen = structure.channels.findIndex(({ index }) => channelPath(index) === look.selected);
  const isAt = (path: string) => look.selected !== null && withoutIndex(path).startsWith(`${withoutIndex(look.selected)}.`);
  const wires = drawing.wires.map((wire, at) => ({
    wire,
    at,
    channels: wire.channels.flatMap((one) => structure.channels[one] ?? []),
  }));
  const rank = (channels: readonly Channel[]) => Number(channels.some(({ index }) => index === over || index === chosen));
  return (
    <ViewportPortal>
      <svg className="channels" width={drawing.width} height={drawing.height} aria-hidden="true">
        {wires
          .sort((a, b) => rank(a.channels) - rank(b.channels))
          .map(({ wire, at, channels }) => {
            const classes = [
              "channel",
              channels.some(blocks) ? "blocking" : "",
              channels.length > 1 ? "trunk" : "",
              wire.between ? "between" : "inside",
              wire.between?.forth ? "forth" : "",
              wire.between?.back ? "back" : "",
              channels.some(({ from, to }) => isAt(from) || isAt(to)) ? "of-selected" : "",
              channels.some(({ index }) => index === chosen) ? "selected" : "",
              channels.some(({ index }) => index === over) ? "over" : "",
              channels.some(({ index }) => look.complaints.get(channelPath(index))?.severity === "error") ? "error" : "",
              channels.some(({ index }) => look.stuck.has(index)) ? "stuck" : "",
            ];
            const path = roundedPath(wire.points, 8);
            const [only] = channels;
            return (
              <g key={at} data-channels={wire.channels.join(" ")}>
                <path className={classes.join(" ")} d={path} markerEnd={wire.ends ? "url(#channel-tip)" : undefined} />
                {channels.length === 1 && (
                  <path
                    className="channel-reach"
                    d={path}
                    data-reach={channelPath(only!.index)}
                    onPointerEnter={() => setOver(only!.index)}
                    onPointerLeave={() => setOver(null)}
                  />
                )}
              </g>
            );
          })}
      </svg>
      {structure.channels.map((channel) => {
        const box = drawing.labels.get(channel.index);
        if (!box) return null;
        const { modes, timeout } = channelLabel(channel);
        const path = channelPath(channel.index);
        const complaint = look.complaints.get(path)?.severity ?? "";
        return (
          <button
            key={channel.index}
            className={`channel-label nodrag nopan ${path === look.selected ? "selected" : ""} ${complaint} ${look.stuck.has(channel.index) ? "stuck" : ""}`}
            style={{ left: box.x, top: box.y, width: box.width, height: box.height }}
            data-path={path}
            aria-label={spoken(channel)}
            aria-pressed={path === look.selected}
            title={`${channel.from} → ${channel.to}\n${meaning(channel)}`}
            onPointerEnter={() => setOver(channel.index)}
            onPointerLeave={() => setOver(null)}
            onFocus={() => setOver(channel.index)}
            onBlur={() => setOver(null)}
          >
            {isNext(channel) && <span aria-hidden="true">↻ </span>}
            {modes}
            {timeout && <span className="faint"> {timeout}</span>}
          </button>
        );
      })}
    </ViewportPortal>
  );
}

/** The tip of all channels. */
export const ChannelTip = () => (
  <svg width="0" height="0" aria-hidden="true" style={{ position: "absolute" }}>
    <defs>
      <marker
        id="channel-tip"
        viewBox="0 0 10 8"
        refX="9.5"
        refY="4"
        markerWidth="9"
        markerHeight="7.2"
        markerUnits="userSpaceOnUse"
        orient="auto"
      >
        <path className="tip" d="M0 0L10 4L0 8L2.5 4Z" />
      </marker>
      {/* For the lines between agents, seen from afar. */}
      <marker
        id="trunk-tip"
        viewBox="0 0 10 8"
        refX="9.5"
        refY="4"
        markerWidth="6"
        markerHeight="4.8"
        orient="auto-start-reverse"
      >
        <path className="tip" d="M0 0L10 4L0 8Z" />
      </marker>
    </defs>
  </svg>
);
