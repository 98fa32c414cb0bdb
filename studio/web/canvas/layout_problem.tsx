import { useStore, useStudio } from "../hooks/use";

/** Says that the file with moved boxes is not understood. It stays as it is, unless the user replaces it. */
export function LayoutProblem() {
  const studio = useStudio();
  const problem = useStore(studio.layoutFile.store, (all) => all.problem);
  if (!problem) return null;
  return (
    <div className="strip warning" role="status">
      Moved boxes are not kept: .tessera-layout.json is not understood ({problem}).{" "}
      <button onClick={() => studio.layoutFile.replace()}>Replace the file</button>
    </div>
  );
}
