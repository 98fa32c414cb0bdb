import { useEffect, useState } from "react";
import { useStore, useStudio } from "../hooks/use";
import { message } from "../live/api";

const empty = (name: string) =>
  `tessera: 1\nsystem: ${name}\nagents:\n  robot:\n    control:\n      rate: 10 Hz\n      behaviours:\n        run: {}\n`;

/** The page for an empty or missing specification: ways to begin. */
export function StartPage() {
  const studio = useStudio();
  const project = useStore(studio.project, (all) => all.project);
  const [examples, setExamples] = useState<readonly { name: string; title: string }[]>([]);
  const [problem, setProblem] = useState("");
  const [kept, setKept] = useState<readonly string[]>([]);
  useEffect(() => {
    studio.api.examples().then(setExamples, (error: unknown) => setProblem(message(error)));
  }, [studio]);
  const name = (project?.folder.split("/").at(-1) ?? "").toLowerCase().replace(/[^a-z0-9_]+/g, "_");
  const beginEmpty = async () => {
    // A folder may have a name that no system can have, such as a keyword of C++.
    const { diagnostics } = await studio.api.check(empty(name));
    const is = diagnostics.some(({ severity }) => severity === "error") ? "robot_system" : name;
    studio.draft.edit(empty(is), "edit");
    studio.view.set({ view: "structure", panel: "inspect", selected: null });
  };
  const begin = async (example: string) => {
    try {
      const { kept: others } = await studio.api.begin(example);
      setKept(others);
      await studio.draft.changedOnDisk("");
    } catch (error) {
      setProblem(message(error));
    }
  };
  return (
    <div className="start-page">
      <h2>Begin a specification</h2>
      <p>
        {project?.file ?? "The file"} in {project?.folder ?? "this folder"} is empty. Choose what to begin with; everything can be
        changed afterwards.
      </p>
      <div className="buttons">
        <button className="primary" onClick={() => void beginEmpty()}>
          An empty system
        </button>
      </div>
      <h3>Or a copy of an example, with its C++ and its world</h3>
      {problem && <p className="problem-hint">{problem}</p>}
      {kept.length > 0 && <p className="problem-hint">These files were there already and stay as they are: {kept.join(", ")}</p>}
      <ul className="examples">
        {examples.map((one) => (
          <li key={one.name}>
            <button className="choice" onClick={() => void begin(one.name)}>
              <strong>{one.name.replace(/^\d+_/, "").replaceAll("_", " ")}</strong>
              <span>{one.title}</span>
            </button>
          </li>
        ))}
      </ul>
    </div>
  );
}
