import { useRef, useState } from "react";

/**
 * The text of a field: its value, or what the user has typed or chosen, until that has taken effect or was refused. `base` is
 * the value that the user has given last, also if it has not taken effect yet.
 */
export function useTyped<T extends string>(value: T, onChange: (text: T) => unknown) {
  const [typed, setTyped] = useState<T | null>(null);
  const sent = useRef<{ text: T } | null>(null);
  const base = () => sent.current?.text ?? value;
  const type = (text: T) => setTyped(text === base() && !sent.current ? null : text);
  return {
    text: typed ?? value,
    base,
    type,
    /** Forgets what was typed. */
    reset: () => type(base()),
    take: async (text: T) => {
      if (text === base()) return type(text);
      const mine = (sent.current = { text });
      setTyped(text);
      await onChange(text);
      if (sent.current !== mine) return;
      sent.current = null;
      setTyped((now) => (now === text ? null : now));
    },
  };
}
