import { useMemo } from "react";
import { structureOf, thingAt, type Structure } from "../model/structure/structure";
import { useStore, useStudio } from "./use";

/** The structure of the current text. */
export function useStructure(): Structure {
  const studio = useStudio();
  const text = useStore(studio.draft.store, (draft) => draft.text);
  return structureOf(text);
}

/** Complaints by the path of the element on whose line they are. */
export function useComplaints(structure: Structure): ReadonlyMap<string, { severity: "error" | "warning"; messages: string[] }> {
  const studio = useStudio();
  const diagnostics = useStore(studio.draft.store, (draft) => draft.diagnostics);
  return useMemo(() => {
    const found = new Map<string, { severity: "error" | "warning"; messages: string[] }>();
    for (const one of diagnostics) {
      const path = thingAt(structure, one.line);
      if (path === undefined || (one.severity !== "error" && one.severity !== "warning")) continue;
      const known = found.get(path);
      const severity = one.severity === "error" || known?.severity === "error" ? "error" : "warning";
      found.set(path, { severity, messages: [...(known?.messages ?? []), one.message] });
    }
    return found;
  }, [structure, diagnostics]);
}
