/** The name in the list of recordings of a file that a run has written; null: it is elsewhere. */
export function recordingOf(file: string): string | null {
  return /(?:^|\/)runs\/([^/]+)\/[^/]+$/.exec(file)?.[1] ?? null;
}
