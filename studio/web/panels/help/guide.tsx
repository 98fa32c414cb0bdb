import { useEffect, useRef } from "react";
import { useStore, useStudio } from "../../hooks/use";
import { tourSteps } from "../../live/guide";
import { groupTitles, keysInWords, shortcuts, type ShortcutGroup } from "../../model/shortcuts";
import { Tour } from "./tour";

/** The help of the page: a dialog with the shortcuts, and the tour. */
export function Guide() {
  const studio = useStudio();
  const open = useStore(studio.guide.store, (all) => all.open);
  const step = useStore(studio.guide.store, (all) => all.step);
  return (
    <>
      {open && <HelpDialog />}
      {step !== null && <Tour key={step} step={step} />}
    </>
  );
}

/** A row below the head of the page, at the first visit only. */
export function TourOffer() {
  const studio = useStudio();
  const offered = useStore(studio.guide.store, (all) => all.offered);
  const loaded = useStore(studio.draft.store, (draft) => draft.loaded && draft.text.trim() !== "");
  if (!offered || !loaded) return null;
  return (
    <div className="tour-offer" role="region" aria-label="Tour">
      <span>New here? A tour of five steps shows the page.</span>
      <button className="primary" onClick={() => studio.guide.go(tourSteps[0])}>
        Take the tour
      </button>
      <button onClick={() => studio.guide.refuse()}>No, thanks</button>
    </div>
  );
}

function HelpDialog() {
  const studio = useStudio();
  const ref = useRef<HTMLDialogElement>(null);
  useEffect(() => void ref.current?.showModal(), []);
  return (
    <dialog ref={ref} className="dialog guide" aria-labelledby="guide-title" onClose={() => studio.guide.open(false)}>
      <h2 id="guide-title">Help</h2>
      <p>
        A small <span className="term-sign">?</span> beside a term explains it in a sentence.
      </p>
      <div className="buttons">
        <button onClick={() => studio.guide.go(tourSteps[0])}>Take the tour</button>
        <a className="button" href="docs/index.html" target="_blank" rel="noreferrer">
          Documents
        </a>
        <a className="button" href="docs/reference/glossary.html" target="_blank" rel="noreferrer">
          Glossary
        </a>
      </div>
      <h3>Shortcuts</h3>
      <div className="shortcut-groups">
        {(Object.keys(shortcuts) as ShortcutGroup[]).map((group) => (
          <section key={group} aria-label={groupTitles[group]}>
            <h4>{groupTitles[group]}</h4>
            <dl>
              {Object.entries<{ keys: readonly string[]; text: string }>(shortcuts[group]).map(([name, { keys, text }]) => (
                <div key={name}>
                  <dt>
                    {keys.map((one, at) => (
                      <span key={one}>
                        {at > 0 && " or "}
                        {keysInWords(one).map((key) => (
                          <kbd key={key}>{key}</kbd>
                        ))}
                      </span>
                    ))}
                  </dt>
                  <dd>{text}</dd>
                </div>
              ))}
            </dl>
          </section>
        ))}
      </div>
      <div className="buttons">
        <button autoFocus onClick={() => ref.current?.close()}>
          Close
        </button>
      </div>
    </dialog>
  );
}
