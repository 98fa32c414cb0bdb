import { useStore, useStudio } from "../../hooks/use";
import type { Structure } from "../../model/structure/structure";
import { problemAt } from "../../model/text/problem_at";
import type { YamlPath } from "../../model/text/yaml_text";

const none: never[] = [];

/** The complaints of the check about the value at a path; `own`: without those about the values inside. */
export function useProblems(structure: Structure): (at: YamlPath, own?: "own") => string | undefined {
  const studio = useStudio();
  // Positions of the text before are wrong.
  const found = useStore(studio.draft.store, (draft) => (draft.checking ? none : draft.diagnostics));
  return (at, own) => problemAt(structure.yaml, found, at, own !== undefined);
}

/** The complaints of the check about a map or a list as a whole. */
export function OwnProblem({ structure, at }: { structure: Structure; at: YamlPath }) {
  const problem = useProblems(structure)(at, "own");
  return problem ? <p className="problem-hint">{problem}</p> : null;
}
