import { useId, useState } from "react";
import * as edits from "../../model/text/edits";
import { already, channelEnd, partnersOf } from "../../model/structure/connections";
import { channelPath, type Buffer, type Structure } from "../../model/structure/structure";
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
  const connect = () => {
    if (!chosen) return;
    const ends = [buffer.path, chosen.path].map((path) => channelEnd(structure, path));
    const [from, to] = sends ? ends : ends.reverse();
    void edit(edits.connect(from!, to!), (now) => channelPath(now.channels.length - 1));
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
      <button disabled={!chosen} onClick={connect}>
        Connect
      </button>
    </div>
  );
}
