import * as edits from "../../model/text/edits";
import { fieldsOf } from "../../model/text/schema_fields";
import type { Channel, Structure } from "../../model/structure/structure";
import type { YamlPath } from "../../model/text/yaml_text";
import { Choice, Field } from "./field";
import { Term } from "../../canvas/term";
import { Remove, useEdit } from "./form_parts";
import { ObjectFields } from "./object_fields";
import { schema } from "./schema";
import { useProblems } from "./use_problems";

/** The timeouts of one side. */
const timeouts = fieldsOf(schema.$defs!.channel!.anyOf![1]!, schema).filter(({ key }) => /_timeout$/.test(key));

const titles: Record<string, string> = { non_blocking: "goes on at once", blocking: "waits (blocking)" };

/** The modes of one side, as the schema lists them; the default one first. */
const modesOf = (side: string) =>
  (fieldsOf(schema.$defs!.channel!.anyOf![1]!, schema).find(({ key }) => key === side)?.choices ?? [])
    .map((value) => ({ value, title: titles[value] ?? value.replace("_", " ") }))
    .reverse();
const modes = { send: modesOf("send"), receive: modesOf("receive") };

export function ChannelForm({ structure, channel }: { structure: Structure; channel: Channel }) {
  const edit = useEdit();
  const at: YamlPath = ["channels", channel.index];
  const problem = useProblems(structure);
  const models = structure.yaml.keys(["models"]);
  const set = (fields: Partial<edits.ChannelFields>) => edit(edits.setChannel(channel, fields));
  return (
    <>
      <dl>
        <dt>From</dt>
        <dd className="path">{channel.from}</dd>
        <dt>To</dt>
        <dd className="path">{channel.to}</dd>
      </dl>
      {(models.length > 0 || channel.model) && (
        <Choice
          label="Communication model"
          value={channel.model}
          choices={["", ...models, ...(channel.model && !models.includes(channel.model) ? [channel.model] : [])].map((one) => ({
            value: one,
            title: one || "built in",
          }))}
          problem={problem([...at, "model"])}
          onChange={(model) => set({ model })}
        />
      )}
      {!channel.model && (
        <>
          <p className="faint">
            An end can wait <Term of="blocking" /> or not wait <Term of="non-blocking" />.
          </p>
          <Choice label="The sender" value={channel.send} choices={modes.send} onChange={(send) => set({ send })} />
          <Choice label="The receiver" value={channel.receive} choices={modes.receive} onChange={(receive) => set({ receive })} />
        </>
      )}
      <Field
        label="Timeout of a side that waits"
        value={channel.timeout}
        placeholder="waits for ever"
        problem={problem([...at, "timeout"])}
        onChange={(timeout) => set({ timeout })}
      />
      {structure.yaml.map(at) && <ObjectFields structure={structure} at={at} shapes={timeouts} />}
      <Remove what="channel" at={at} select={null} />
    </>
  );
}
