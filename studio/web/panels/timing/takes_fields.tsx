import { useStudio } from "../../hooks/use";
import type { Structure, Subsystem } from "../../model/structure/structure";
import type { YamlPath } from "../../model/text/yaml_text";
import { set } from "../../model/text/edits";
import { Field } from "../forms/field";

/** The times that the calls of a subsystem take. */
export function TakesFields({ structure, subsystem }: { structure: Structure; subsystem: Subsystem }) {
  const studio = useStudio();
  const own = subsystem.behaviours.filter(({ isGroup }) => !isGroup);
  const of = (yaml: YamlPath) => structure.yaml.followedText([...yaml, "takes"]) ?? "";
  const missing = own.filter(({ yaml }) => of(yaml) === "" && structure.yaml.keys([...yaml, "takes"]).length === 0).length;
  return (
    <details className="takes" open={missing > 0}>
      <summary>
        {missing > 0 ? `${missing} of ${own.length} behaviours do not say what they take` : "What its behaviours take"}
      </summary>
      {own.map(({ path, name, yaml }) =>
        // The element has the whole form of a distribution.
        structure.yaml.keys([...yaml, "takes"]).length > 0 ? (
          <p key={path}>
            <button className="link" onClick={() => studio.choose(path, structure)}>
              {name}
            </button>{" "}
            <code>{structure.yaml.lineText([...yaml, "takes"])}</code>
          </p>
        ) : (
          <Field
            key={path}
            label={name}
            of={`of ${subsystem.path} takes`}
            value={of(yaml)}
            placeholder="1..3 ms"
            onChange={(text) => studio.change(set(yaml, "takes", text))}
          />
        ),
      )}
    </details>
  );
}
