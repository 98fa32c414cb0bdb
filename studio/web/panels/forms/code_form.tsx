import { lazy, Suspense, useEffect, useMemo, useState, type ReactNode } from "react";
import { useStore, useStudio } from "../../hooks/use";
import { useStructure } from "../../hooks/use_structure";
import { edited, functionIn } from "../../live/code_draft";
import type { FunctionShown } from "../../model/protocol";
import { cppMembers } from "../../model/text/cpp_members";
import { buildMessages, functionAt, type BuildMessage, type FunctionText } from "../../model/text/cpp_function";
import type { Behaviour, Subsystem } from "../../model/structure/structure";
import { mergeLines, taking, type Side } from "../../model/text/merge";
import { Clashes } from "../text/conflict_dialog";
import type { CppEditorProps, Mark } from "../text/cpp_editor";

const CppEditor = lazy(() => import("../text/cpp_editor"));

/** The C++ function of a behaviour: read, edited, or begun if it is missing. */
export function CodeForm({ behaviour, subsystem }: { behaviour: Behaviour; subsystem: Subsystem }) {
  const studio = useStudio();
  const { functions, files, problem } = useStore(studio.sources.store, (all) => all);
  const text = useStore(studio.draft.store, (draft) => (draft.current ? draft.text : null));
  // Members of a fleet share the functions of their template.
  const owner = `${String(subsystem.yaml[1])}.${subsystem.name}`;
  const known = functions.find((one) => one.subsystem === owner && one.function === behaviour.function);
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
  const found = known ? functionIn(source, known) : null;
  return (
    <section className="code" aria-label={`C++ of ${behaviour.function}`}>
      <h3>C++</h3>
      {problem && <p className="problem-hint">{problem}</p>}
      {!known && <p className="faint">The function is shown once the specification has no errors.</p>}
      {known?.state === "missing" && <Missing of={known} alone={!functions.some((one) => isBeside(one, known))} />}
      {known?.state === "unclear" && (
        <p className="faint">A macro or a template may define it in {known.file}. The linker will tell.</p>
      )}
      {known && file && found && (
        <Edited
          key={`${file} ${owner}.${behaviour.function}`}
          known={known}
          subsystem={subsystem}
          source={source!}
          found={found}
        />
      )}
      {known && file && source !== undefined && !found && (
        <p className="faint">
          It is in {file}, line {known.line}.
        </p>
      )}
    </section>
  );
}

/** The same in the form of the behaviour, unless it is seen in its panel. */
export function CodeInForm(shown: { behaviour: Behaviour; subsystem: Subsystem }) {
  const studio = useStudio();
  const elsewhere = useStore(studio.dock.store, ({ seen }) => seen.includes("code"));
  return (
    <>
      {!elsewhere && <CodeForm {...shown} />}
      <div className="links">
        <button className="link" onClick={() => studio.dock.open("code")}>
          {elsewhere ? `The function ${shown.behaviour.function} is in the panel C++` : "Open it in the panel C++"}
        </button>
      </div>
    </>
  );
}

/** Another function of the same namespace, which exists. */
const isBeside = (one: FunctionShown, { subsystem }: FunctionShown) =>
  one.subsystem === subsystem && (one.state !== "missing" || one.leftovers.length > 0);

/** alone: the namespace of the subsystem has no function at all, as after a new name of its agent. */
function Missing({ of, alone }: { of: FunctionShown; alone: boolean }) {
  const studio = useStudio();
  const system = useStructure().system;
  return (
    <>
      <p className="faint">There is no function {of.function} yet. Without it, the controller cannot be built.</p>
      {alone && (
        <p className="faint">
          There is none in the namespace {[system, ...of.subsystem.split(".")].join("::")}. If you have renamed the agent,
          template or subsystem, rename its namespace and headers in src/ and test/, too.
        </p>
      )}
      <div className="buttons">
        {of.leftovers.map((from) => (
          <button key={from} onClick={() => void studio.sources.rename(of, from)}>
            Rename the function {from}, which no behaviour has
          </button>
        ))}
        <button onClick={() => void studio.sources.add(of)}>Write it into {of.file}</button>
      </div>
    </>
  );
}

const isWithin = (line: number, { firstLine, lastLine }: FunctionText) => line >= firstLine && line <= lastLine;

/** The functions of behaviours in a source. */
const functionsIn = (source: string, functions: readonly FunctionShown[], file: string) =>
  functions.flatMap((one) => (one.file === file && one.line ? (functionAt(source, one.line) ?? []) : []));

/** A message of the build: its position, its line with a caret, the mistake and the hint. */
function Message({ of, source, children }: { of: BuildMessage; source: string; children: ReactNode }) {
  const text = source.split("\n")[of.line - 1] ?? "";
  const indent = text.length - text.trimStart().length;
  return (
    <li className={of.severity}>
      {children}
      <pre tabIndex={0} aria-label={`Line ${of.line}`}>
        {text.trimStart()}
        {of.column > indent && `\n${" ".repeat(of.column - 1 - indent)}^`}
      </pre>
      <p className={of.severity === "error" ? "problem-hint" : "faint"}>
        {of.severity}
        {of.code && ` ${of.code}`}: {of.text}
      </p>
      {of.hint && <p className="faint">Hint: {of.hint}</p>}
    </li>
  );
}

/** Another program changed the same lines of the function: the user decides which text to go on with. */
function Conflict({
  base,
  mine,
  theirs,
  choose,
}: Record<"base" | "mine" | "theirs", string> & { choose: (text: string) => void }) {
  const take = (side: Side) => choose(taking(mergeLines(base, mine, theirs), side));
  return (
    <div className="asked" role="group" aria-label="The function was changed by another program">
      <p>Another program changed these lines of this function in its file. All other changes of both are kept:</p>
      <Clashes base={base} mine={mine} theirs={theirs} />
      <button onClick={() => take("theirs")}>Take the lines on disk</button>{" "}
      <button onClick={() => take("mine")}>Keep mine</button>
    </div>
  );
}

interface EditedProps {
  known: FunctionShown;
  subsystem: Subsystem;
  source: string;
  found: FunctionText;
}

const noMarks: readonly Mark[] = [];

function Edited({ known, subsystem, source, found }: EditedProps) {
  const studio = useStudio();
  const structure = useStructure();
  const held = studio.sources.edited(known);
  // Drawn again with each change of it.
  useStore(studio.sources.store, () => studio.sources.edited(known)?.text);
  const now = edited(held, found.text);
  const text = now?.text ?? held!.text;
  const dirty = text !== found.text;
  const set = (text: string) => studio.sources.edit(known, { text, base: now ? found.text : held!.base });
  const build = useStore(studio.runner.store, (all) => all.build);
  const functions = useStore(studio.sources.store, (all) => all.functions);
  const [place, setPlace] = useState<CppEditorProps["place"]>(null);
  const messages = useMemo(() => buildMessages(build, known.file), [build, known.file]);
  const { firstLine, lastLine } = found;
  const inside = useMemo(
    () => messages.filter(({ line }) => line >= firstLine && line <= lastLine),
    [messages, firstLine, lastLine],
  );
  /** Errors that no form of another function shows: those of the rest of the file. */
  const outside = messages.filter(
    ({ line, severity }) =>
      severity === "error" && !functionsIn(source, functions, known.file).some((one) => isWithin(line, one)),
  );
  const marks = useMemo(
    () =>
      inside.map(({ line, column, severity, code, text, hint }) => ({
        line: line - firstLine + 1,
        column,
        severity,
        text: [code && `${code}: `, text, hint && `\n${hint}`].join(""),
      })),
    [inside, firstLine],
  );
  const save = () => void studio.sources.saveFunction(known);
  return (
    <>
      <p className="path">
        {known.file}, line {firstLine}
      </p>
      <Suspense fallback={<p className="faint">Loading the editor…</p>}>
        <CppEditor
          label={`${known.file}, line ${firstLine}`}
          text={text}
          firstLine={firstLine}
          marks={marks.length > 0 ? marks : noMarks}
          place={place}
          members={(path) => cppMembers(structure, subsystem, path)}
          onChange={(text) => text !== (edited(studio.sources.edited(known), found.text)?.text ?? null) && set(text)}
          onSave={() => dirty && now && save()}
        />
      </Suspense>
      {inside.length + outside.length > 0 && (
        <ul className="build-messages" aria-label="What the build says">
          {inside.map((one) => (
            <Message key={`${one.line} ${one.column} ${one.text}`} of={one} source={source}>
              <button
                className="link"
                onClick={() =>
                  setPlace({ line: one.line - firstLine + 1, column: one.column, request: (place?.request ?? 0) + 1 })
                }
              >
                Line {one.line - firstLine + 1} of the function
              </button>
            </Message>
          ))}
          {outside.map((one) => (
            <Message key={`${one.line} ${one.column} ${one.text}`} of={one} source={source}>
              {known.file}, line {one.line}
            </Message>
          ))}
        </ul>
      )}
      {!now && (
        <Conflict
          base={held!.base}
          mine={text}
          theirs={found.text}
          choose={(text) => studio.sources.edit(known, { text, base: found.text })}
        />
      )}
      {now && (
        <div className="buttons">
          <button className={dirty ? "primary" : ""} disabled={!dirty} onClick={save}>
            Save the function
          </button>
          {dirty && <button onClick={() => set(found.text)}>Discard</button>}
        </div>
      )}
    </>
  );
}
