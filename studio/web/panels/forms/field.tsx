import { useEffect, useId, useState, type KeyboardEvent } from "react";

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
  onChange: (text: string) => void;
}

/**
 * A text field whose value takes effect when the field is left or on Enter; Escape restores the old value.
 */
export function Field({ label, of, value, hint, placeholder, choices, mono, wrong, onChange }: FieldProps) {
  const id = useId();
  const [text, setText] = useState(value);
  useEffect(() => setText(value), [value]);
  const problem = text === value ? undefined : wrong?.(text);
  const take = () => {
    if (text !== value && !problem) onChange(text);
  };
  const key = (event: KeyboardEvent<HTMLInputElement>) => {
    if (event.key === "Enter") take();
    // The text of the field is saved, too.
    if ((event.ctrlKey || event.metaKey) && event.key.toLowerCase() === "s") take();
    if (event.key === "Escape") setText(value);
  };
  return (
    <div className="field">
      <Label id={id} label={label} of={of} />
      <input
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
        onChange={(event) => setText(event.target.value)}
        onBlur={take}
        onKeyDown={key}
      />
      {choices && (
        <datalist id={`${id}-choices`}>
          {choices.map((choice) => (
            <option key={choice} value={choice} />
          ))}
        </datalist>
      )}
      {(problem || hint) && (
        <p id={`${id}-hint`} className={problem ? "problem-hint" : "faint"}>
          {problem ?? hint}
        </p>
      )}
    </div>
  );
}

function Label({ id, label, of }: { id: string; label: string; of: string | undefined }) {
  return (
    <label htmlFor={id}>
      {label}
      {of && <span className="visually-hidden"> {of}</span>}
    </label>
  );
}

export function Choice<T extends string>({
  label,
  of,
  value,
  choices,
  onChange,
}: {
  label: string;
  of?: string;
  value: T;
  choices: readonly { value: T; title: string }[];
  onChange: (value: T) => void;
}) {
  const id = useId();
  return (
    <div className="field">
      <Label id={id} label={label} of={of} />
      <select id={id} value={value} onChange={(event) => onChange(event.target.value as T)}>
        {choices.map((choice) => (
          <option key={choice.value} value={choice.value}>
            {choice.title}
          </option>
        ))}
      </select>
    </div>
  );
}
