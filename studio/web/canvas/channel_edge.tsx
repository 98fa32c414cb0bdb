import { BaseEdge, EdgeLabelRenderer, getSmoothStepPath, type EdgeProps } from "@xyflow/react";
import { leadsBack } from "../model/channel_labels";
import type { Point } from "../model/geometry";
import { channelLabel, type Channel } from "../model/structure";

/** A channel: solid where both ends wait, dashed where neither does; its label names the modes of both ends. */
export function ChannelEdge(props: EdgeProps) {
  const { channel, selected, complaint, lane, label } = props.data as unknown as {
    channel: Channel;
    selected: boolean;
    complaint?: "error" | "warning";
    /** Height of the line if the channel leads back. */
    lane?: number;
    /** The middle of its label. */
    label: Point;
  };
  const back = leadsBack({ x: props.sourceX, y: props.sourceY }, { x: props.targetX, y: props.targetY });
  const [path] = getSmoothStepPath({
    ...props,
    borderRadius: 8,
    ...(back && lane !== undefined ? { centerY: lane, offset: 22 } : {}),
  });
  const blocking = channel.send === "blocking" || channel.receive === "blocking";
  const { modes, timeout } = channelLabel(channel);
  const spoken = `${modes}${timeout ? ` ${timeout}` : ""}, channel from ${channel.from}, ${channel.send}, to ${channel.to}, ${channel.receive}`;
  return (
    <>
      <BaseEdge
        id={props.id}
        path={path}
        className={`channel${blocking ? " blocking" : ""}${selected ? " selected" : ""}${complaint ? ` ${complaint}` : ""}`}
        markerEnd="url(#channel-tip)"
        interactionWidth={16}
      />
      <EdgeLabelRenderer>
        <button
          className={`channel-label nodrag nopan${selected ? " selected" : ""}${complaint ? ` ${complaint}` : ""}`}
          style={{ transform: `translate(-50%, -50%) translate(${label.x}px, ${label.y}px)` }}
          data-path={props.id}
          aria-pressed={selected}
          aria-label={spoken}
          title={spoken}
        >
          {modes}
          {timeout && <span className="faint"> {timeout}</span>}
        </button>
      </EdgeLabelRenderer>
    </>
  );
}

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
    </defs>
  </svg>
);
