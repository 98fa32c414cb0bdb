/** How the lines of a file end. The page edits every text with "\n", as text fields of browsers do. */
export type LineEnd = "\n" | "\r\n" | "\r";

/** The end that most lines of a text have. */
export function lineEndOf(text: string): LineEnd {
  const both = text.split("\r\n").length - 1;
  const returns = text.split("\r").length - 1 - both;
  const feeds = text.split("\n").length - 1 - both;
  return both >= feeds && both >= returns && both > 0 ? "\r\n" : returns > feeds ? "\r" : "\n";
}

export const withFeeds = (text: string) => text.replace(/\r\n?/g, "\n");

/** end: for a text whose lines end with "\n". */
export const withEnds = (text: string, end: LineEnd) => (end === "\n" ? text : text.replaceAll("\n", end));

/** The offset of each line. A line ends with LF, CRLF or CR. */
export function lineStarts(text: string): number[] {
  return [0, ...[...text.matchAll(/\r\n?|\n/g)].map(({ 0: end, index }) => index + end.length)];
}
