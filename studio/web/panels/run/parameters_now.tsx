import { useEffect, useId, useRef, useState } from "react";
import { useStore, useStudio } from "../../hooks/use";
import type { ParameterShown } from "../../model/protocol";
import { controlOf, same, stepOf } from "../../model/run/parameters";
import { IconButton } from "../icons";

/** The limit for fleets, which have too many parameters to read. */
const most = 40;

/** The parameters of the running controller: their values, and controls that change them. */
export function ParametersNow() {
  const studio = useStudio();
  const { parameters, kind } = useStore(studio.runner.store, (all) => all);
  const [filter, setFilter] = useState("");
  if (parameters.length === 0) return null;
  const found = parameters.filter(({ path }) => path.includes(filter));
  return (
    <details open>
      <summary>
        <h3>Parameters</h3>
      </summary>
      {kind === "deployment" && <p className="faint">The terminal changes them in all processes: tessera set.</p>}
      {parameters.length > 12 && (
        <div className="field">
          <label htmlFor="parameter-filter">Show</label>
          <input
            id="parameter-filter"
            type="text"
            placeholder="part of a path"
            value={filter}
            onChange={(event) => setFilter(event.target.value)}
          />
        </div>
      )}
      <div className="parameters-now">
        {found.slice(0, most).map((one) => (
          <Parameter key={one.path} shown={one} />
        ))}
      </div>
      {found.length > most && <p className="faint">{found.length - most} more: type a part of their path.</p>}
    </details>
  );
}

function Parameter({ shown }: { shown: ParameterShown }) {
  const studio = useStudio();
  const id = useId();
  const { path, type, unit, initial, value, differs } = shown;
  const control = controlOf(shown);
  const [typed, setTyped] = useState<string | null>(null);
  const [problem, setProblem] = useState("");
  const asking = useRef(false);
  const latest = useRef<string | null>(null);
  // A typed value stays until the controller has accepted it.
  useEffect(() => {
    if (typed !== null && value !== null && same(typed, value, type)) setTyped(null);
  }, [typed, value, type]);

  /** Among many changes in a row, as from a slider, only the latest is sent. */
  const send = async (text: string) => {
    setTyped(text);
    latest.current = text;
    if (asking.current) return;
    asking.current = true;
    while (latest.current !== null) {
      const wanted: string = latest.current;
      latest.current = null;
      const refused = await studio.runner.setParameter(path, wanted);
      setProblem(refused);
      if (refused && latest.current === null && control !== "text" && control !== "number") setTyped(null);
    }
    asking.current = false;
  };

  const held = value ?? "";
  const text = typed ?? held;
  const said = value === null ? "not known" : `${held}${unit && ` ${unit}`}${differs ? ", others differ" : ""}`;
  return (
    <div className="field parameter-now" data-parameter={path}>
      <label htmlFor={id}>
        <span className="path">{path}</span> <strong>{said}</strong>
        {value !== null && !same(value, initial, type) && (
          <IconButton
            name="undo"
            label={`${path} back to ${initial}, as the specification says`}
            onClick={() => void send(initial)}
          />
        )}
      </label>
      {control === "switch" && (
        <input id={id} type="checkbox" checked={text === "true"} onChange={(event) => void send(String(event.target.checked))} />
      )}
      {control === "slider" && (
        <input
          id={id}
          type="range"
          min={shown.minimum!}
          max={shown.maximum!}
          step={stepOf(shown)}
          value={Number(text) || 0}
          aria-valuetext={said}
          onChange={(event) => void send(event.target.value)}
        />
      )}
      {(control === "number" || control === "text") && (
        <input
          id={id}
          type="text"
          inputMode={control === "number" ? "decimal" : "text"}
          value={text}
          onChange={(event) => setTyped(event.target.value)}
          onBlur={() => typed !== null && typed !== held && void send(typed)}
          onKeyDown={(event) => {
            if (event.key === "Enter" && typed !== null) void send(typed);
            if (event.key === "Escape") {
              setTyped(null);
              setProblem("");
            }
          }}
        />
      )}
      {problem && (
        <p className="problem-hint" role="alert">
          {problem}
        </p>
      )}
    </div>
  );
}
