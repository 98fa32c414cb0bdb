import { useStudio } from "../hooks/use";
import { bundleAt } from "../model/structure/bundles";
import { channelMeaning } from "../model/structure/channel_words";
import { channelPath, type Channel, type Structure } from "../model/structure/structure";

/** The channels between two agents, by direction. */
export function BundlePanel({ structure, path }: { structure: Structure; path: string }) {
  const bundle = bundleAt(structure, path);
  if (!bundle) return <p className="faint">These channels are not there any more.</p>;
  const [one, other] = bundle.agents;
  const channels = bundle.channels.map((index) => structure.channels[index]!);
  const from = (agent: string) => channels.filter((channel) => new RegExp(`^${agent}[.[]`).test(channel.from));
  return (
    <div className="inspect">
      <h2>
        {channels.length === 1 ? "Channel" : `${channels.length} channels`} between {one} and {other}
      </h2>
      <Direction title={`From ${one} to ${other}`} channels={from(one)} structure={structure} />
      <Direction title={`From ${other} to ${one}`} channels={from(other)} structure={structure} />
    </div>
  );
}

function Direction({ title, channels, structure }: { title: string; channels: readonly Channel[]; structure: Structure }) {
  const studio = useStudio();
  if (channels.length === 0) return null;
  return (
    <>
      <h3>{title}</h3>
      <ul className="bundle-channels">
        {channels.map((channel) => {
          return (
            <li key={channel.index}>
              <button onClick={() => studio.choose(channelPath(channel.index), structure)}>
                <span>
                  {channel.from} → {channel.to}
                </span>
                <span className="faint">{channelMeaning(channel)}</span>
              </button>
            </li>
          );
        })}
      </ul>
    </>
  );
}
