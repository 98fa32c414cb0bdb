import { useEffect, useId, useState, type KeyboardEvent } from "react";

interface FieldProps {
  label: string;
  value: string;
  hint?: string;
  placeholder?: string;
  /** Offered while typing. */
  choices?: readonly string[];
  mono?: boolean;
  /** The reason why a text is not accepted; undefined: it is. */
  wrong?: (text: string) => string | undefined;
  onChange: (text: string) => void;
}

/**
 * A text field whose value takes effect when the field is left or on Enter; Escape restores the old value.
 */
export function Field({ label, value, hint, placeholder, choices, mono, wrong, onChange }: FieldProps) {
  const id = useId();
  const [text, setText] = useState(value);
  useEffect(() => setText(value), [value]);
  const problem = text === value ? undefined : wrong?.(text);
  const take = () => {
    if (text !== value && !problem) onChange(text);
  };
  const key = (event: KeyboardEvent<HTMLInputElement>) => {
    if (event.key === "Enter") take();
    if (event.key === "Escape") setText(value);
  };
  return (
    <div className="field">
      <label htmlFor={id}>{label}</label>
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

export function Choice<T extends string>({
  label,
  value,
  choices,
  onChange,
}: {
  label: string;
  value: T;
  choices: readonly { value: T; title: string }[];
  onChange: (value: T) => void;
}) {
  const id = useId();
  return (
    <div className="field">
      <label htmlFor={id}>{label}</label>
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
