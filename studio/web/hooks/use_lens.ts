import type { Stuck } from "../live/lens";
import type { NetModel } from "../model/net/net";
import { useStore, useStudio } from "./use";

/** The subsystems of a standstill, if they stand still in this net: an edit may have mended it. */
export function useLens(net: NetModel | null): Stuck | null {
  const studio = useStudio();
  const shown = useStore(studio.lens.store, (all) => all.shown);
  return shown && (shown.net === null || net === null || shown.net.isNamed(net.hash)) ? shown : null;
}
