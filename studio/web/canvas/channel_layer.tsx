import { ViewportPortal } from "@xyflow/react";
import { roundedPath } from "../model/net/geometry";
import { bundlePath, bundleTitle, isNext } from "../model/structure/bundles";
import { channelMeaning, waits } from "../model/structure/channel_words";
import {
  channelLabel,
  channelPath,
  selectedPath,
  withoutIndex,
  type Channel,
  type Structure,
} from "../model/structure/structure";
import type { DrawnBundle, StructureDrawing } from "../model/structure/structure_graph";

/** The appearance of channels besides their modes. */
export interface ChannelLook {
  selected: string | null;
  complaints: ReadonlyMap<string, { severity: "error" | "warning" }>;
  /** Indices of the channels at which a subsystem is stuck. */
  stuck: ReadonlySet<number>;
  /** The channel or bundle under the pointer, or with the focus. */
  over: string | null;
  onOver: (path: string | null) => void;
}

const spoken = (channel: Channel) => {
  const { modes, timeout } = channelLabel(channel);
  return `${modes}${timeout ? ` ${timeout}` : ""}, channel from ${channel.from}, ${channel.send}, to ${channel.to}, ${channel.receive}`;
};

const joined = (...classes: (string | false | undefined)[]) => classes.filter(Boolean).join(" ");

/**
 * The channels of the structure: solid if an end waits, dashed if none does. Those between two agents are one line with
 * their number; the lines to their buffers are drawn once it is open. All of it comes from the same layout as the
 * boxes, so a channel ends where its buffer is drawn.
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
  const { selected, over, stuck, complaints } = look;
  const at = selected === null ? null : withoutIndex(selectedPath(selected));
  const touches = (path: string) => at !== null && (withoutIndex(path) === at || withoutIndex(path).startsWith(`${at}.`));
  const isAt = ({ from, to }: Channel) => touches(from) || touches(to);
  const isShown = (path: string) => path === selected || path === over;
  const isError = ({ index }: Channel) => complaints.get(channelPath(index))?.severity === "error";
  const known = (index: number) => structure.channels[index];
  // An agent has too many channels to open all of their bundles.
  const opensAt = at !== null && at.includes(".");
  const shows = (channel: Channel) =>
    isShown(channelPath(channel.index)) ||
    (opensAt && isAt(channel)) ||
    stuck.has(channel.index) ||
    isShown(bundlePath(channel) ?? "");
  const wires = drawing.wires.flatMap((wire) => {
    const channel = known(wire.channel);
    return channel && (wire.bundle === undefined || shows(channel)) ? [{ wire, channel }] : [];
  });
  const bundles = drawing.bundles.map((bundle) => ({ bundle, channels: bundle.channels.flatMap((one) => known(one) ?? []) }));
  const hover = (path: string) => ({ onPointerEnter: () => look.onOver(path), onPointerLeave: () => look.onOver(null) });
  const focus = (path: string) => ({ ...hover(path), onFocus: () => look.onOver(path), onBlur: () => look.onOver(null) });
  const open = (channels: readonly Channel[], path: string) =>
    isShown(path) || channels.some(({ index }) => isShown(channelPath(index)));
  return (
    <ViewportPortal>
      <svg className="channels" width={drawing.width} height={drawing.height} aria-hidden="true">
        {bundles
          .sort((a, b) => Number(open(a.channels, a.bundle.path)) - Number(open(b.channels, b.bundle.path)))
          .map(({ bundle, channels }) => {
            const { path, points, forth, back } = bundle;
            const line = roundedPath(points, 8);
            const classes = joined(
              "channel between",
              channels.some(waits) && "blocking",
              forth && "forth",
              back && "back",
              channels.some(isAt) && "of-selected",
              open(channels, path) && "over",
              channels.some(isError) && "error",
              channels.some(({ index }) => stuck.has(index)) && "stuck",
            );
            return (
              <g key={path} data-channels={bundle.channels.join(" ")} data-bundle={path}>
                <path className="halo" d={line} />
                <path className={classes} d={line} />
                <path className="channel-reach" d={line} data-reach={path} {...hover(path)}>
                  <title>{namesOf(bundle, channels)}</title>
                </path>
              </g>
            );
          })}
        {wires.map(({ wire, channel }, key) => {
          const path = channelPath(channel.index);
          const classes = joined(
            "channel inside",
            wire.bundle && "opened",
            waits(channel) && "blocking",
            isAt(channel) && "of-selected",
            path === selected && "selected",
            (path === over || (wire.bundle && isShown(wire.bundle))) && "over",
            isError(channel) && "error",
            stuck.has(channel.index) && "stuck",
          );
          const line = roundedPath(wire.points, 6);
          return (
            <g key={key} data-channels={channel.index}>
              <path className={classes} d={line} markerEnd={wire.ends ? "url(#channel-tip)" : undefined} />
              <path className="channel-reach" d={line} data-reach={path} {...hover(path)}>
                <title>{`${channel.from} → ${channel.to}`}</title>
              </path>
            </g>
          );
        })}
      </svg>
      {structure.channels.map((channel) => {
        const box = drawing.labels.get(channel.index);
        if (!box) return null;
        const { modes, timeout } = channelLabel(channel);
        const path = channelPath(channel.index);
        const complaint = complaints.get(path)?.severity;
        return (
          <button
            key={channel.index}
            className={joined(
              "channel-label nodrag nopan",
              path === selected && "selected",
              complaint,
              stuck.has(channel.index) && "stuck",
            )}
            style={{ left: box.x, top: box.y, width: box.width, height: box.height }}
            data-path={path}
            aria-label={spoken(channel)}
            aria-pressed={path === selected}
            title={`${channel.from} → ${channel.to}\n${channelMeaning(channel)}`}
            {...focus(path)}
          >
            {isNext(channel) && <span aria-hidden="true">↻ </span>}
            {modes}
            {timeout && <span className="faint"> {timeout}</span>}
          </button>
        );
      })}
      {bundles.map(({ bundle, channels }) => {
        const { path, label: box } = bundle;
        const isOpen = open(channels, path);
        return (
          <button
            key={path}
            className={joined(
              "channel-label bundle nodrag nopan",
              isOpen && "selected",
              channels.some(isError) && "error",
              channels.some(({ index }) => stuck.has(index)) && "stuck",
            )}
            style={{ left: box.x, top: box.y, width: box.width, height: box.height }}
            data-path={path}
            aria-label={namesOf(bundle, channels)}
            aria-pressed={path === selected}
            title={namesOf(bundle, channels)}
            {...focus(path)}
          >
            <span>{channels.length}</span>
          </button>
        );
      })}
    </ViewportPortal>
  );
}

const namesOf = (bundle: DrawnBundle, channels: readonly Channel[]) =>
  `${bundleTitle(bundle)}\n${channels.map(({ from, to }) => `${from} → ${to}`).join("\n")}`;

/** The tips of channels and of the arrows of state machines. */
export const ChannelTip = () => (
  <svg width="0" height="0" aria-hidden="true" style={{ position: "absolute" }}>
    <defs>
      <Tip id="channel-tip" size={9} />
      <Tip id="machine-tip" size={7} />
      <Tip id="failure-tip" size={7} />
      {/* For the lines between agents: their width is that of the line. */}
      <marker id="trunk-tip" viewBox="0 0 10 8" refX="9.5" refY="4" markerWidth="5" markerHeight="4" orient="auto-start-reverse">
        <path className="tip" d="M0 0L10 4L0 8Z" />
      </marker>
    </defs>
  </svg>
);

const Tip = ({ id, size }: { id: string; size: number }) => (
  <marker
    id={id}
    viewBox="0 0 10 8"
    refX="9.5"
    refY="4"
    markerWidth={size}
    markerHeight={size * 0.8}
    markerUnits="userSpaceOnUse"
    orient="auto"
  >
    <path className={`tip ${id}`} d="M0 0L10 4L0 8L2.5 4Z" />
  </marker>
);
