import { useEffect, useId, useRef, useState } from "react";
import text from "../../../docs/reference/glossary.md?raw";
import { meaningOf, readGlossary } from "../model/glossary";

let glossary: ReturnType<typeof readGlossary> | undefined;
const meaning = (term: string) => meaningOf((glossary ??= readGlossary(text)), term);

/**
 * A small "?" beside a term: a click, or the focus of the keyboard, shows its meaning in a sentence. Nothing if the glossary does
 * not have the term, such as a property of the user.
 */
export function Term({ of }: { of: string }) {
  const id = useId();
  const button = useRef<HTMLButtonElement>(null);
  const note = useRef<HTMLSpanElement>(null);
  const [open, setOpen] = useState(false);
  const said = meaning(of);
  useEffect(() => {
    const shown = note.current;
    if (!open || !shown || !button.current) return;
    shown.showPopover();
    const at = button.current.getBoundingClientRect();
    const { offsetWidth: width, offsetHeight: height } = shown;
    const below = at.bottom + 6;
    shown.style.left = `${Math.max(8, Math.min(at.left, innerWidth - width - 8))}px`;
    shown.style.top = `${below + height < innerHeight ? below : Math.max(8, at.top - height - 6)}px`;
    const close = () => setOpen(false);
    const outside = (event: PointerEvent) => event.target instanceof Node && !button.current?.contains(event.target) && close();
    window.addEventListener("pointerdown", outside);
    window.addEventListener("scroll", close, true);
    window.addEventListener("resize", close);
    return () => {
      window.removeEventListener("pointerdown", outside);
      window.removeEventListener("scroll", close, true);
      window.removeEventListener("resize", close);
      if (shown.isConnected) shown.hidePopover();
    };
  }, [open]);
  if (!said) return null;
  return (
    <>
      <button
        ref={button}
        type="button"
        className="term-help"
        aria-expanded={open}
        aria-describedby={open ? id : undefined}
        onClick={(event) => {
          // Within a summary or a label, the click is meant for the meaning only.
          event.preventDefault();
          event.stopPropagation();
          setOpen(!open);
        }}
        onFocus={(event) => event.currentTarget.matches(":focus-visible") && setOpen(true)}
        onBlur={() => setOpen(false)}
        onKeyDown={(event) => {
          if (event.key !== "Escape" || !open) return;
          event.stopPropagation();
          setOpen(false);
        }}
      >
        <span aria-hidden="true">?</span>
        <span className="visually-hidden">Meaning of {of.replaceAll("_", " ")}</span>
      </button>
      {open && (
        <span ref={note} id={id} className="term-meaning" popover="manual" role="note">
          {said}
        </span>
      )}
    </>
  );
}
