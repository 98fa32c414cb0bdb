/** A function in a C++ file: its characters, and the lines that they are on, from 1. */
export interface FunctionText {
  from: number;
  to: number;
  firstLine: number;
  lastLine: number;
  text: string;
}

/** The function whose name is on a line, up to the end of its body; null: there is no body. */
export function functionAt(source: string, line: number): FunctionText | null {
  const lines = source.split("\n");
  if (line < 1 || line > lines.length) return null;
  const from = lines.slice(0, line - 1).reduce((sum, one) => sum + one.length + 1, 0);
  let depth = 0;
  for (let at = from; at < source.length; at += 1) {
    const skipped = afterLiteral(source, at);
    if (skipped > at) at = skipped - 1;
    else if (source[at] === ";" && depth === 0) return null;
    else if (source[at] === "{") depth += 1;
    else if (source[at] === "}" && (depth -= 1) === 0) {
      const text = source.slice(from, at + 1);
      return { from, to: at + 1, firstLine: line, lastLine: line + text.split("\n").length - 1, text };
    }
  }
  return null;
}

/** The end of a comment, a string or a character that begins here; the same position if none does. */
function afterLiteral(source: string, at: number): number {
  const rest = source.slice(at, at + 24);
  const until = (end: string, start: number) => {
    const found = source.indexOf(end, start);
    return found < 0 ? source.length : found + end.length;
  };
  if (rest.startsWith("//")) return until("\n", at);
  if (rest.startsWith("/*")) return until("*/", at + 2);
  const raw = /^R"([^()\\ ]{0,16})\(/.exec(rest);
  if (raw) return until(`)${raw[1]!}"`, at);
  // 1'000 is a number.
  if (rest[0] !== '"' && (rest[0] !== "'" || /\w/.test(source[at - 1] ?? ""))) return at;
  for (let end = at + 1; end < source.length; end += 1) {
    if (source[end] === "\\") end += 1;
    else if (source[end] === rest[0] || source[end] === "\n") return end + 1;
  }
  return source.length;
}

export interface BuildMessage {
  line: number;
  /** From 1; 0: unknown. */
  column: number;
  severity: "error" | "warning";
  /** Such as "E501"; empty: a message of the compiler itself. */
  code: string;
  text: string;
  hint: string;
}

const head = /^(\S+?):(\d+):(?:(\d+):)? (?:fatal )?(error|warning)(?: ([A-Z]\d{3}))?: (.*)$/;

/**
 * The messages of a build about a file: those of `tessera` and of compilers. A hint belongs to the message
 * before it.
 */
export function buildMessages(build: readonly string[], file: string): BuildMessage[] {
  const found: BuildMessage[] = [];
  let last: BuildMessage | undefined;
  for (const one of build) {
    const [, where, line, column, severity, code, text] = head.exec(one) ?? [];
    if (where !== undefined) {
      last = {
        line: Number(line),
        column: Number(column ?? 0),
        severity: severity as BuildMessage["severity"],
        code: code ?? "",
        text: text!,
        hint: "",
      };
      if (where === file || where.endsWith(`/${file}`)) found.push(last);
    } else if (one.startsWith("hint: ") && last) last.hint = one.slice("hint: ".length);
  }
  return found;
}
