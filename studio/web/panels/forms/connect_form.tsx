import { useId, useState } from "react";
import { already, fleetOf, isForEach, partnersOf } from "../../model/structure/connections";
import { connectEdits } from "../../model/text/connect_edits";
import { channelPath, findThing, type Buffer, type Structure } from "../../model/structure/structure";
import { useEdit } from "./form_parts";

/** A channel from or to a buffer, without the mouse. */
export function ConnectForm({ structure, buffer }: { structure: Structure; buffer: Buffer }) {
  const edit = useEdit();
  const id = useId();
  const partners = partnersOf(structure, buffer);
  const [wish, choose] = useState("");
  const chosen = partners.find(({ path, reason }) => path === wish && !reason) ?? partners.find(({ reason }) => !reason);
  const sends = buffer.direction === "output";
  if (buffer.direction === "real") return null;
  const nothing =
    partners.length === 0
      ? "there is no buffer to connect"
      : !sends && partners.some(({ reason }) => reason === already)
        ? "it has its source"
        : "no buffer fits";
  const [output, input] = sends ? [buffer.path, chosen?.path] : [chosen?.path, buffer.path];
  const fleet = output && input ? fleetOf(structure, output, input) : undefined;
  const readers = output && input ? fleetOf(structure, input, output) : undefined;
  const typeOf = (path: string) => {
    const found = findThing(structure, `output:${path}`);
    return found?.kind === "buffer" ? found.of.type : "";
  };
  const connect = () => {
    if (!output || !input) return;
    void edit(connectEdits(structure, output, input), (now) => channelPath(now.channels.length - 1));
  };
  return (
    <div className="field connect">
      <label htmlFor={id}>{sends ? "Connect to" : "Connect from"}</label>
      <select id={id} value={chosen?.path ?? ""} onChange={(event) => choose(event.target.value)}>
        {!chosen && <option value="">{nothing}</option>}
        {partners.map(({ path, reason }) => (
          <option key={path} value={path} disabled={reason !== ""}>
            {path}
            {reason && `: ${reason}`}
          </option>
        ))}
      </select>
      {fleet && (
        <p className="faint">
          {input} gets a value from each {fleet}: in C++ in.{input!.split(".").at(-1)}[i]
        </p>
      )}
      {output && readers && !isForEach(readers, typeOf(output)) && (
        <p className="faint">
          Each {readers} gets the same value. For a value of its own, give {output} the length: each {readers}
        </p>
      )}
      <button disabled={!chosen} onClick={connect}>
        Connect
      </button>
    </div>
  );
}
