import { useEffect, useState } from "react";
import { useStore, useStudio } from "../hooks/use";
import { message } from "../live/api";
import { beginningOf, robots, robotTitles, worlds, worldTitles, type Robot, type World } from "../model/beginnings";

const titleOf = (name: string) => name.replace(/^\d+_/, "").replaceAll("_", " ");

/** The page for an empty or missing specification: two questions lead to a project, or an example is chosen by its picture. */
export function StartPage() {
  const studio = useStudio();
  const project = useStore(studio.project, (all) => all.project);
  const [examples, setExamples] = useState<readonly { name: string; title: string }[]>([]);
  const [problem, setProblem] = useState("");
  const byHand = useStore(studio.guide.store, (all) => all.byHand);
  const [busy, setBusy] = useState(false);
  useEffect(() => {
    studio.api.examples().then(setExamples, (error: unknown) => setProblem(message(error)));
  }, [studio]);
  const shown = () => studio.view.set({ view: "structure", panel: "inspect", selected: null });
  const beginWith = async (specification: (system: string) => string) => {
    const name = (project?.folder.split("/").at(-1) ?? "").toLowerCase().replace(/[^a-z0-9_]+/g, "_");
    // A folder may have a name that no system can have, such as a keyword of C++.
    const { diagnostics } = await studio.api.check(specification(name));
    const is = diagnostics.some(({ severity }) => severity === "error") ? "robot_system" : name;
    studio.draft.edit(specification(is), "edit");
    shown();
  };
  const copy = async (example: string) => {
    const { kept: others } = await studio.api.begin(example);
    shown();
    await studio.draft.changedOnDisk("");
    // The page itself has written the file: it is no news that it changed on disk.
    const notice = others.length > 0 ? `These files were there already and stay as they are: ${others.join(", ")}` : "";
    studio.draft.store.set({ notice });
  };
  const begin = async (act: () => Promise<void>) => {
    setBusy(true);
    try {
      await act();
    } catch (error) {
      setProblem(message(error));
    } finally {
      setBusy(false);
    }
  };
  // Beside the text, it is a part of the main part of the page.
  const Frame = byHand ? "div" : "main";
  return (
    <Frame className="start-page" aria-busy={busy}>
      <h2>Begin a project</h2>
      <p>
        {project?.file ?? "The file"} in {project?.folder ?? "this folder"} is empty. Answer two questions, or choose an example.
        Everything can be changed afterwards.{" "}
        {!byHand && (
          <button className="link" onClick={() => studio.guide.store.set({ byHand: true })}>
            Or write it as text
          </button>
        )}
      </p>
      {problem && <p className="problem-hint">{problem}</p>}
      <Questions
        busy={busy}
        onBegin={(robot, world) => {
          const one = beginningOf(robot, world);
          void begin(() => ("example" in one ? copy(one.example) : beginWith(one.specification)));
        }}
      />
      <h3>Or a copy of an example, with its C++ and its world</h3>
      <ul className="examples">
        {examples.map((one) => (
          <li key={one.name}>
            <button className="choice" disabled={busy} onClick={() => void begin(() => copy(one.name))}>
              <img src={`examples/${one.name}.png`} alt="" width="400" height="250" loading="lazy" />
              <strong>{titleOf(one.name)}</strong>
              <span>{one.title}</span>
            </button>
          </li>
        ))}
      </ul>
    </Frame>
  );
}

function Questions({ busy, onBegin }: { busy: boolean; onBegin: (robot: Robot, world: World) => void }) {
  const [robot, setRobot] = useState<Robot>("mobile");
  const [world, setWorld] = useState<World>("simulated");
  return (
    <form
      className="questions"
      onSubmit={(event) => {
        event.preventDefault();
        onBegin(robot, world);
      }}
    >
      <Question title="Which robot?" name="robot" answers={robots} titles={robotTitles} chosen={robot} onChoose={setRobot} />
      {robot !== "nothing" && (
        <Question
          title="Simulated or real?"
          name="world"
          answers={worlds}
          titles={worldTitles}
          chosen={world}
          onChoose={setWorld}
        />
      )}
      <div className="begin">
        <button type="submit" className="primary" disabled={busy}>
          Begin
        </button>
        <p role="status">{beginningOf(robot, world).says}</p>
      </div>
    </form>
  );
}

function Question<Answer extends string>({
  title,
  name,
  answers,
  titles,
  chosen,
  onChoose,
}: {
  title: string;
  name: string;
  answers: readonly Answer[];
  titles: Record<Answer, { title: string; text: string }>;
  chosen: Answer;
  onChoose: (answer: Answer) => void;
}) {
  return (
    <fieldset>
      <legend>{title}</legend>
      <div className="answers">
        {answers.map((one) => (
          <label key={one} className={one === chosen ? "chosen" : ""}>
            <input type="radio" name={name} checked={one === chosen} onChange={() => onChoose(one)} />
            <span>
              <strong>{titles[one].title}</strong>
              <span className="faint">{titles[one].text}</span>
            </span>
          </label>
        ))}
      </div>
    </fieldset>
  );
}
