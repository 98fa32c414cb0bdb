import { wordDifference, type Part } from "../../model/text/word_difference";

interface Side {
  /** Before each line: "mine │ ". */
  sign: string;
  className: string;
  lines: readonly string[];
}

/** The lines of two texts, below each other. The words that differ are marked. */
export function WordLines({ old, fresh }: { old: Side; fresh: Side }) {
  const difference = wordDifference(old.lines, fresh.lines);
  return (
    <>
      <Lines of={old} parts={difference.old} />
      <Lines of={fresh} parts={difference.fresh} />
    </>
  );
}

function Lines({ of, parts }: { of: Side; parts: readonly Part[][] }) {
  return parts.map((line, at) => (
    <div key={at} className={of.className}>
      {of.sign}
      {line.map(({ text, changed }, part) => (changed ? <mark key={part}>{text}</mark> : <span key={part}>{text}</span>))}
    </div>
  ));
}
