import { useEffect, useState } from "react";
import { useStore, useStudio } from "../../hooks/use";
import { YamlText } from "../../model/text/yaml_text";

/** The names that drivers in the world can use, by their kinds. */
export type Targets = { readonly [kind: string]: readonly string[] };

/** Asks the simulated world of the text. While the text has errors, the last answer counts. */
export function useTargets(): Targets {
  const studio = useStudio();
  const text = useStore(studio.draft.store, (draft) => (draft.current ? draft.text : null));
  const [targets, setTargets] = useState<Targets>({});
  // Only another world has other elements.
  const world = text === null ? null : worldIn(text);
  useEffect(() => {
    if (world === null) return;
    let late = false;
    studio.api.worldTargets(studio.draft.store.get().text).then(
      ({ targets }) => late || setTargets(targets),
      // Without an answer, there are only no proposals.
      () => {},
    );
    return () => void (late = true);
  }, [studio, world]);
  return targets;
}

function worldIn(text: string): string {
  const yaml = new YamlText(text);
  return ["world", "models"].map((key) => yaml.valueText(["simulation", key]) ?? "").join("\n");
}
