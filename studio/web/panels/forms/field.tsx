import { useEffect, useId, useRef, type KeyboardEvent } from "react";
import { useStudio } from "../../hooks/use";
import { useTyped } from "../../hooks/use_typed";
import { Term } from "../../canvas/term";

interface FieldProps {
  label: string;
  /** The subject of the label, if it is visible beside the field: "of left". Screen readers read it. */
  of?: string;
  value: string;
  hint?: string;
  placeholder?: string;
  /** Proposals while typing. */
  choices?: readonly string[];
  mono?: boolean;
  /** The reason why a text is not accepted; undefined: it is. */
  wrong?: (text: string) => string | undefined;
  /** The complaint of the check about the value. */
  problem?: string | undefined;
  /** It is no part of the specification, whose changes it does not undo. */
  apart?: boolean;
  /** false: the value stays as it was. */
  onChange: (text: string) => unknown;
}

/** Whether the keys of undo or of redo were pressed. */
export function undoOf(event: Pick<KeyboardEvent, "ctrlKey" | "metaKey" | "shiftKey" | "key">): "undo" | "redo" | null {
  if (!event.ctrlKey && !event.metaKey) return null;
  const key = event.key.toLowerCase();
  return key === "y" || (key === "z" && event.shiftKey) ? "redo" : key === "z" ? "undo" : null;
}

/**
 * A text field whose value takes effect when the field is left or on Enter; Escape restores the old value. Undo takes back
 * what was typed; after that, the last change of the specification.
 */
export function Field({
  label,
  of,
  value,
  hint,
  placeholder,
  choices,
  mono,
  wrong,
  problem: found,
  apart,
  onChange,
}: FieldProps) {
  const studio = useStudio();
  const id = useId();
  const input = useRef<HTMLInputElement>(null);
  const { text, base, type, reset, take } = useTyped(value, onChange);
  useEffect(() => {
    // A text that was refused goes with the value that it was to replace.
    if (input.current !== document.activeElement) reset();
  }, [value]);
  const refused = text === base() ? undefined : wrong?.(text);
  const problem = text === value ? found : refused;
  const takeNow = () => void (refused === undefined && take(text));
  const key = (event: KeyboardEvent<HTMLInputElement>) => {
    const undo = undoOf(event);
    if (undo && !apart) {
      // The browser would undo letters, also those of values that have taken effect long ago.
      event.preventDefault();
      event.stopPropagation();
      if (text !== base()) reset();
      else if (undo === "undo") void studio.editor.undo();
      else void studio.editor.redo();
    }
    if (event.key === "Enter") takeNow();
    // The text of the field is saved, too.
    if ((event.ctrlKey || event.metaKey) && event.key.toLowerCase() === "s") takeNow();
    if (event.key === "Escape") reset();
  };
  return (
    <div className="field">
      <Label id={id} label={label} of={of} tip={hint} />
      <input
        ref={input}
        id={id}
        type="text"
        className={mono ? "mono" : ""}
        value={text}
        placeholder={placeholder}
        list={choices ? `${id}-choices` : undefined}
        aria-invalid={problem !== undefined}
        aria-describedby={problem || hint ? `${id}-hint` : undefined}
        spellCheck={false}
        autoComplete="off"
        onChange={(event) => type(event.target.value)}
        onBlur={() => takeNow()}
        onKeyDown={key}
      />
      {choices && (
        <datalist id={`${id}-choices`}>
          {choices.map((choice) => (
            <option key={choice} value={choice} />
          ))}
        </datalist>
      )}
      <Hint id={id} hint={hint} problem={problem} />
    </div>
  );
}

function Hint({ id, hint, problem }: { id: string; hint: string | undefined; problem: string | undefined }) {
  if (!problem && !hint) return null;
  return (
    <p id={`${id}-hint`} className={problem ? "problem-hint" : "faint"}>
      {problem ?? hint}
    </p>
  );
}

function Label({ id, label, of, tip }: { id: string; label: string; of: string | undefined; tip: string | undefined }) {
  return (
    <div className="label-row">
      <label htmlFor={id} title={tip}>
        {label}
        {of && <span className="visually-hidden"> {of}</span>}
      </label>
      <Term of={label} />
    </div>
  );
}

export function Choice<T extends string>({
  label,
  of,
  value,
  choices,
  hint,
  problem,
  onChange,
}: {
  label: string;
  of?: string;
  value: T;
  choices: readonly { value: T; title: string }[];
  hint?: string;
  problem?: string | undefined;
  onChange: (value: T) => unknown;
}) {
  const id = useId();
  const { text, take } = useTyped(value, onChange);
  return (
    <div className="field">
      <Label id={id} label={label} of={of} tip={hint} />
      <select
        id={id}
        value={text}
        aria-invalid={problem !== undefined}
        aria-describedby={problem || hint ? `${id}-hint` : undefined}
        onChange={(event) => void take(event.target.value as T)}
      >
        {choices.map((choice) => (
          <option key={choice.value} value={choice.value}>
            {choice.title}
          </option>
        ))}
      </select>
      <Hint id={id} hint={hint} problem={problem} />
    </div>
  );
}
