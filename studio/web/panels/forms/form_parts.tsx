import { useState } from "react";
import { useStudio } from "../../hooks/use";
import { changedLines } from "../../model/text/changed_lines";
import type { Wish } from "../../live/editor";
import { isName, remove } from "../../model/text/edits";
import {
  behavioursIn,
  sharersOf,
  structureOf,
  type Agent,
  type Structure,
  type Subsystem,
} from "../../model/structure/structure";
import type { YamlPath } from "../../model/text/yaml_text";

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
export const namespaceHint = "Its C++ namespace and headers have the same name, and change with it";

/** The names that are taken in a subsystem; in a group of it, those of its behaviours. */
export const namesIn = (subsystem: Subsystem, group = "") =>
  [...behavioursIn(subsystem, group), ...(group ? [] : subsystem.buffers)].map((one) => one.name);

type Select = string | null | undefined;

/** Does an edit of the specification and selects the changed element. The promise is false if it was refused. */
export function useEdit() {
  const studio = useStudio();
  return (wish: Wish, select?: Select | ((now: Structure) => Select)) =>
    studio.change(wish, (now) => {
      const selected = typeof select === "function" ? select(now) : select;
      return selected === undefined ? {} : { selected };
    });
}

/** Removes an element; it stands at the end of a form, apart from what adds. It asks first if something else goes or changes with it. */
export function Remove({ what, at, select }: RemoveProps) {
  const studio = useStudio();
  const edit = useEdit();
  const [asking, ask] = useState<string[] | null>(null);
  const removeNow = () => edit(remove(at), select);
  const removeIfAlone = async () => {
    const found = await studio.editor.preview(remove(at));
    if (!found) return;
    const lines = changedLines(found.before, found.after);
    const { yaml } = structureOf(found.before);
    const own = yaml.endLine(found.at(at)) - yaml.line(found.at(at)) + 1;
    if (lines.length > own) ask(lines);
    else await removeNow();
  };
  if (!asking)
    return (
      <div className="buttons apart">
        <button className="danger" onClick={() => void removeIfAlone()}>
          Remove {what}
        </button>
      </div>
    );
  return (
    <div className="asked" role="group" aria-label={`Remove ${what}?`}>
      <p>This also removes or changes what needs it:</p>
      <pre tabIndex={0} aria-label="Changed lines">
        {asking.join("\n")}
      </pre>
      <button className="danger" onClick={() => void removeNow()}>
        Remove all of it
      </button>{" "}
      <button onClick={() => ask(null)}>Keep it</button>
    </div>
  );
}

interface RemoveProps {
  what: string;
  /** The element. */
  at: YamlPath;
  /** The element to select then. */
  select: string | null;
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
