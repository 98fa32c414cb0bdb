import { useEffect, useRef, useState } from "react";
import { useStore, useStudio } from "../hooks/use";
import { Icon } from "./icons";

/** The name of the program. A click shows information about it. */
export function About() {
  const [open, setOpen] = useState(false);
  return (
    <>
      <button className="brand" aria-label="About Tessera" title="About Tessera" onClick={() => setOpen(true)}>
        <Icon name="logo" /> Tessera
      </button>
      {open && <AboutDialog close={() => setOpen(false)} />}
    </>
  );
}

function AboutDialog({ close }: { close: () => void }) {
  const studio = useStudio();
  const version = useStore(studio.project, (all) => all.project?.version);
  const ref = useRef<HTMLDialogElement>(null);
  useEffect(() => void ref.current?.showModal(), []);
  return (
    <dialog ref={ref} className="dialog about" aria-labelledby="about-title" onClose={close}>
      <h2 id="about-title">Tessera {version}</h2>
      <p>Multi-agent robot controllers from hierarchical Petri nets.</p>
      <ul>
        <li>
          <a href="LICENSE.txt" target="_blank" rel="noreferrer">
            Licence of Tessera
          </a>
        </li>
        <li>
          <a href="THIRD_PARTY.txt" target="_blank" rel="noreferrer">
            Software of others in Tessera, with its licences
          </a>
        </li>
      </ul>
      <div className="buttons">
        <button autoFocus onClick={() => ref.current?.close()}>
          Close
        </button>
      </div>
    </dialog>
  );
}
