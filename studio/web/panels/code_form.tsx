import { useEffect, useId, useState } from "react";
import { useStore, useStudio } from "../hooks/use";
import type { FunctionShown } from "../live/protocol";
import { buildMessages, functionAt, type FunctionText } from "../model/cpp_function";
import type { Behaviour, Subsystem } from "../model/structure";

/** The C++ function of a behaviour: read, edited, or begun if it is missing. */
export function CodeForm({ behaviour, subsystem }: { behaviour: Behaviour; subsystem: Subsystem }) {
  const studio = useStudio();
  const { functions, files, problem } = useStore(studio.sources.store, (all) => all);
  const text = useStore(studio.draft.store, (draft) => (draft.current ? draft.text : null));
  // Members of a fleet share the functions of their template.
  const owner = `${String(subsystem.yaml[1])}.${subsystem.name}`;
  const known = functions.find((one) => one.subsystem === owner && one.function === behaviour.name);
  const file = known?.state === "defined" ? known.file : undefined;
  useEffect(() => {
    if (text === null) return;
    const timer = setTimeout(() => void studio.sources.look(), 250);
    return () => clearTimeout(timer);
  }, [studio, text]);
  useEffect(() => {
    if (file) void studio.sources.open(file);
  }, [studio, file]);
  const source = file === undefined ? undefined : files.get(file)?.text;
  const found = source !== undefined && known?.line ? functionAt(source, known.line) : null;
  return (
    <section className="code" aria-label={`C++ of ${behaviour.name}`}>
      <h3>C++</h3>
      {problem && <p className="problem-hint">{problem}</p>}
      {!known && <p className="faint">The function is shown once the specification has no errors.</p>}
      {known?.state === "missing" && <Missing of={known} />}
      {known?.state === "unclear" && (
        <p className="faint">A macro or a template may define it in {known.file}. The linker will tell.</p>
      )}
      {known && file && found && (
        <Edited key={`${file} ${owner}.${behaviour.name}`} known={known} source={source!} found={found} />
      )}
      {known && file && source !== undefined && !found && (
        <p className="faint">
          It is in {file}, line {known.line}.
        </p>
      )}
    </section>
  );
}

function Missing({ of }: { of: FunctionShown }) {
  const studio = useStudio();
  return (
    <>
      <p className="faint">There is no function {of.function} yet. Without it, the controller cannot be built.</p>
      <div className="buttons">
        <button onClick={() => void studio.sources.add(of)}>Write it into {of.file}</button>
      </div>
    </>
  );
}

function Edited({ known, source, found }: { known: FunctionShown; source: string; found: FunctionText }) {
  const studio = useStudio();
  const id = useId();
  const name = `${known.subsystem}.${known.function}`;
  const [text, show] = useState(studio.sources.unsaved.get(name) ?? found.text);
  const [base, setBase] = useState(found.text);
  const build = useStore(studio.runner.store, (all) => all.build);
  const setText = (text: string) => {
    if (text === found.text) studio.sources.unsaved.delete(name);
    else studio.sources.unsaved.set(name, text);
    show(text);
  };
  useEffect(() => {
    // Text that is not saved yet stays when the file changes.
    if (text === base) setText(found.text);
    setBase(found.text);
  }, [found.text]);
  const dirty = text !== found.text;
  if (!dirty) studio.sources.unsaved.delete(name);
  const messages = buildMessages(build, known.file).filter(({ line }) => line >= found.firstLine && line <= found.lastLine);
  const save = () => void studio.sources.save(known.file, source.slice(0, found.from) + text + source.slice(found.to));
  return (
    <>
      <label htmlFor={id}>
        {known.file}, line {found.firstLine}
      </label>
      <textarea
        id={id}
        className="mono"
        value={text}
        rows={Math.min(24, Math.max(5, text.split("\n").length + 1))}
        spellCheck={false}
        wrap="off"
        onChange={(event) => setText(event.target.value)}
        onKeyDown={(event) => {
          if (!(event.ctrlKey || event.metaKey) || event.key.toLowerCase() !== "s") return;
          event.preventDefault();
          event.stopPropagation();
          if (dirty) save();
        }}
      />
      {messages.map(({ line, severity, text: said }) => (
        <p key={`${line} ${said}`} className={severity === "error" ? "problem-hint" : "faint"}>
          {severity}, line {line - found.firstLine + 1} of the function: {said}
        </p>
      ))}
      <div className="buttons">
        <button className={dirty ? "primary" : ""} disabled={!dirty} onClick={save}>
          Save the function
        </button>
        {dirty && <button onClick={() => setText(found.text)}>Discard</button>}
      </div>
    </>
  );
}
