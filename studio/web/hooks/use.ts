import { createContext, useContext, useRef, useSyncExternalStore } from "react";
import { isUnsaved } from "../live/draft";
import type { Store } from "../live/store";
import type { Studio } from "../live/studio";

export const StudioContext = createContext<Studio | null>(null);

export function useStudio(): Studio {
  const studio = useContext(StudioContext);
  if (!studio) throw new Error("outside of the studio");
  return studio;
}

/** A part of a store. The component is drawn again only if that part changes. */
export function useStore<T extends object, S>(store: Store<T>, select: (value: T) => S): S {
  const last = useRef<{ value: T; part: S } | null>(null);
  const part = () => {
    const value = store.get();
    if (last.current?.value !== value) {
      const fresh = select(value);
      const same = last.current !== null && Object.is(last.current.part, fresh);
      last.current = { value, part: same ? last.current!.part : fresh };
    }
    return last.current!.part;
  };
  return useSyncExternalStore(store.subscribe, part);
}

/** Whether a run would save something first: the specification, or C++. */
export function useUnsaved(): boolean {
  const studio = useStudio();
  const specification = useStore(studio.draft.store, isUnsaved);
  const code = useStore(studio.sources.store, (all) => all.unsaved.length > 0);
  return specification || code;
}

/** Whether the specification on disk has a simulated world. */
export const useHasWorld = () => useStore(useStudio().project, (all) => Boolean(all.project?.simulation));
