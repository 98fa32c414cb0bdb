import { useStore, useStudio } from "../../hooks/use";
import { useStructure } from "../../hooks/use_structure";
import { findThing } from "../../model/structure/structure";
import { CodeForm } from "./code_form";

/** The C++ of the selected behaviour, in a panel of its own. */
export default function CodePanel() {
  const studio = useStudio();
  const structure = useStructure();
  const selected = useStore(studio.view, (view) => view.selected);
  const thing = selected === null ? undefined : findThing(structure, selected);
  if (thing?.kind !== "behaviour" || thing.of.isGroup) return <BehaviourChoice />;
  return (
    <div className="panel code-panel">
      <CodeForm key={thing.of.path} behaviour={thing.of} subsystem={thing.subsystem} />
    </div>
  );
}

/** The behaviours of the system, if none is selected. */
function BehaviourChoice() {
  const studio = useStudio();
  const structure = useStructure();
  const subsystems = structure.agents.flatMap((agent) => agent.subsystems);
  return (
    <div className="panel">
      <p className="faint">Select a behaviour to see its function.</p>
      <ul className="behaviour-choice">
        {subsystems.flatMap(({ path, behaviours }) =>
          behaviours
            .filter(({ isGroup }) => !isGroup)
            .map((one) => (
              <li key={one.path}>
                <button className="link" onClick={() => studio.view.set({ selected: one.path })}>
                  {path}.{one.function}
                </button>
              </li>
            )),
        )}
      </ul>
    </div>
  );
}
