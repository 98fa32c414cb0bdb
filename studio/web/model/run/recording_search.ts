import type { RecordingInfo } from "../protocol";

/** The recordings whose name, title, text or marks hold all words. */
export function recordingsWith(list: readonly RecordingInfo[], words: string): RecordingInfo[] {
  const wanted = words.toLowerCase().split(/\s+/).filter(Boolean);
  return list.filter(({ name, notes }) => {
    const said = [name, notes?.title, notes?.text, ...(notes?.marks.map(({ text }) => text) ?? [])].join(" ").toLowerCase();
    return wanted.every((word) => said.includes(word));
  });
}
