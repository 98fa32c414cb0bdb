import { useState } from "react";
import { useStudio } from "../../hooks/use";
import { changedLines } from "../../model/text/changed_lines";
import { isName } from "../../model/text/edits";
import { sharersOf, type Agent, type Structure, type Subsystem } from "../../model/structure/structure";
import { YamlText, type YamlPath } from "../../model/text/yaml_text";

/** Why a name cannot be used for an element beside those that exist. */
export const nameProblem =
  (own: string, taken: readonly string[] = []) =>
  (text: string) =>
    !isName(text)
      ? "Letters, digits and single underscores, beginning with a letter"
      : text !== own && taken.includes(text)
        ? `The name ${text} is taken here`
        : undefined;

/** The hint below the name of a subsystem, or of an agent or template with subsystems of its own. */
export const namespaceHint = "Its C++ namespace and headers have the same name: rename them there too";

export const namesIn = (subsystem: Subsystem) => [...subsystem.behaviours, ...subsystem.buffers].map((one) => one.name);

/** Puts a changed text into the draft and selects the changed element. A change that would leave an alias without its anchor is refused. */
export function useEdit() {
  const studio = useStudio();
  return (text: string, select?: string | null) => {
    const lost = new YamlText(text).lostAlias();
    if (lost && !new YamlText(studio.draft.store.get().text).lostAlias()) {
      studio.draft.store.set({ notice: `Not changed: *${lost.name} stands for it in other places of the text` });
      return;
    }
    studio.draft.edit(text, "edit");
    if (select !== undefined) studio.view.set({ selected: select });
  };
}

/** Removes an element. It asks first if something else goes or changes with it. */
export function Remove({ what, structure, at, after, onClick }: RemoveProps) {
  const [asking, setAsking] = useState(false);
  const remove = () => {
    const others = changedLines(structure.yaml.text, after()).length;
    const own = structure.yaml.endLine(at) - structure.yaml.line(at) + 1;
    if (others > own && !asking) setAsking(true);
    else onClick(after());
  };
  if (!asking)
    return (
      <button className="danger" onClick={remove}>
        Remove {what}
      </button>
    );
  return (
    <div className="asked" role="group" aria-label={`Remove ${what}?`}>
      <p>This also removes or changes what needs it:</p>
      <pre tabIndex={0} aria-label="Changed lines">
        {changedLines(structure.yaml.text, after()).join("\n")}
      </pre>
      <button className="danger" onClick={remove}>
        Remove all of it
      </button>{" "}
      <button onClick={() => setAsking(false)}>Keep it</button>
    </div>
  );
}

interface RemoveProps {
  what: string;
  structure: Structure;
  /** The element. */
  at: YamlPath;
  /** The text without it. */
  after: () => string;
  onClick: (text: string) => void;
}

/** Tells the user that a change of a template changes all agents that use it. */
export function SharedNote({ structure, agent }: { structure: Structure; agent: Agent }) {
  const others = sharersOf(structure, agent).filter((one) => one.name !== agent.name);
  if (agent.yaml[0] === "templates")
    return (
      <p className="shared-note">
        {others.length > 0
          ? `A change of this template changes ${others.map(({ name, count }) => (count ? `all ${count} members of ${name}` : name)).join(", ")}.`
          : "No agent uses this template."}
      </p>
    );
  if (!agent.template) return null;
  return (
    <p className="shared-note">
      Part of the template {agent.template}: a change here changes{" "}
      {agent.count ? `all ${agent.count} members of ${agent.name}` : agent.name}
      {others.length > 0 && `, and ${others.map(({ name }) => name).join(", ")}`}.
    </p>
  );
}
