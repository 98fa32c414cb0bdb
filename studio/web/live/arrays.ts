import { count } from "../model/sorted";
import { message } from "./api";
import type { ArraysEvent, ArraysRow, RecordedArrays as Answer } from "../model/protocol";

/** The numbers of a buffer in a recording; null: not recorded, or too large to be sent. */
export type Bytes = Uint8Array | null;

/** The arrays that devices gave: scans and pictures. */
export interface Arrays {
  /** Grows with each new array. */
  readonly version: number;
  /** Undefined: none so far, or not loaded yet. The same object until there is another value. */
  at(path: string, time: number): Bytes | undefined;
}

const decoded = (text: string | null): Bytes =>
  text === null ? null : Uint8Array.from(atob(text), (letter) => letter.charCodeAt(0));

/** For a running run: the newest arrays. */
export class LiveArrays implements Arrays {
  version = 0;
  private readonly latest = new Map<string, string | null>();
  private readonly known = new Map<string, Bytes>();

  take({ arrays }: ArraysEvent): void {
    for (const [path, text] of Object.entries(arrays)) {
      this.latest.set(path, text);
      this.known.delete(path);
    }
    this.version += 1;
  }

  at(path: string): Bytes | undefined {
    const text = this.latest.get(path);
    // Decoded at the first use.
    if (text !== undefined && !this.known.has(path)) this.known.set(path, decoded(text));
    return this.known.get(path);
  }
}

/** Nanoseconds that are loaded after a requested time. */
const ahead = 4e9;

interface Part {
  from: number;
  until: number;
  rows: readonly ArraysRow[];
}

/** For a recording, of which one part is loaded at a time. */
export class RecordedArrays implements Arrays {
  version = 0;
  private part: Part = { from: 0, until: -1, rows: [] };
  private readonly known = new Map<string, Bytes>();
  private loading = false;
  private problem = "";

  constructor(private readonly source: (from: number, to: number) => Promise<Answer>) {}

  at(path: string, time: number): Bytes | undefined {
    const { from, until, rows } = this.part;
    if (time < from || time > until) {
      void this.load(time);
      return undefined;
    }
    let row = count(rows, ([at]) => at <= time) - 1;
    while (row >= 0 && rows[row]![1][path] === undefined) row -= 1;
    if (row < 0) return undefined;
    const key = `${row} ${path}`;
    let bytes = this.known.get(key);
    if (bytes === undefined) {
      if (this.known.size > 200) this.known.clear();
      this.known.set(key, (bytes = decoded(rows[row]![1][path]!)));
    }
    return bytes;
  }

  private async load(time: number): Promise<void> {
    if (this.loading || this.problem) return;
    this.loading = true;
    const from = Math.floor(Math.max(0, time));
    try {
      const { arrays, until } = await this.source(from, Math.ceil(from + ahead));
      this.known.clear();
      this.part = { from, until: Math.max(until, from + 0.1e9), rows: arrays };
    } catch (error) {
      this.problem = message(error);
    }
    this.loading = false;
    this.version += 1;
  }
}
