import { useMemo, useRef, useState } from "react";
import { useStore, useStudio } from "../../hooks/use";
import type { NetModel } from "../../model/net/net";
import { Sheets } from "../../model/net/sheets";
import { elk } from "../elk";

/** Pages with more children than this are folded at first. */
const many = 24;

/**
 * The sheets of each net that is drawn, and a number that grows when a sheet has arrived. Folding one member
 * of a fleet folds all of them.
 */
export function useSheets(nets: readonly NetModel[]): { of: (net: NetModel) => Sheets; version: number } {
  const studio = useStudio();
  const folds = useStore(studio.view, (view) => view.folds);
  const [version, setVersion] = useState(0);
  const before = useRef<Sheets | undefined>(undefined);
  const sheets = useMemo(() => {
    const made = new Map<NetModel, Sheets>();
    for (const net of nets) {
      if (made.has(net)) continue;
      const known = new Map<number, boolean>();
      const crowded = (page: number) => {
        let is = known.get(page);
        if (is === undefined) known.set(page, (is = net.children(page).length > many));
        return is;
      };
      const folded = (page: number) => folds.get(net.page(page).path) ?? crowded(net.page(page).parent ?? 0);
      before.current = new Sheets(net, folded, elk, () => setVersion((at) => at + 1), before.current);
      made.set(net, before.current);
    }
    return made;
  }, [folds, nets[0], nets[1]]);
  return { of: (net) => sheets.get(net)!, version };
}
