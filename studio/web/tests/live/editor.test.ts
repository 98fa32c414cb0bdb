import { beforeEach, describe, expect, it, vi } from "vitest";
import { isMap, parseDocument, type Document, type Pair, type Scalar } from "yaml";
import { ApiError, type Api } from "../../live/api";
import { Draft } from "../../live/draft";
import { Editor, keysNow, named } from "../../live/editor";
import type { Edit, PlacedText } from "../../model/protocol";
import { append, insert, remove, rename, set } from "../../model/text/edits";

const begin = parseDocument(`system: s
agents:
  a:
    control:
      rate: 10 Hz
      behaviours:
        run: {}
channels:
  - one
  - two
  - three

# end
`).toString();

const control = ["agents", "a", "control"];

/** Does the edits of these tests as the server does them. */
function edited(text: string, edit: Edit): string {
  const document: Document = parseDocument(text);
  const at = edit.at ?? [];
  if (edit.do === "set" || edit.do === "insert") {
    if (!document.hasIn(at)) throw new Error(`there is no ${at.join(".")}`);
    if (edit.do === "insert" && document.hasIn([...at, edit.key])) throw new Error(`${edit.key} is taken`);
    const fresh = document.createNode(edit.text ?? edit.value);
    fresh.comment = (document.getIn([...at, edit.key], true) as Scalar | undefined)?.comment;
    document.setIn([...at, edit.key], fresh);
  } else if (edit.do === "append") document.addIn(at, edit.value);
  else if (edit.do === "remove") {
    if (!document.deleteIn(at)) throw new Error(`there is no ${at.join(".")}`);
  } else {
    const map = at.length === 1 ? document.contents : document.getIn(at.slice(0, -1));
    const pair = isMap(map) ? map.items.find(({ key }) => (key as Scalar).value === at.at(-1)) : undefined;
    if (!pair) throw new Error(`there is no ${at.join(".")}`);
    ((pair as Pair).key as Scalar).value = edit.text;
  }
  return document.toString();
}

/** An editor whose server answers only when it is told to. */
async function opened(kept?: object) {
  const stored = new Map(kept ? [["tessera.draft here/spec.yaml", JSON.stringify(kept)]] : []);
  vi.stubGlobal("sessionStorage", {
    getItem: (key: string) => stored.get(key) ?? null,
    setItem: (key: string, value: string) => stored.set(key, value),
    removeItem: (key: string) => stored.delete(key),
  });
  const held: (() => void)[] = [];
  const asked: Edit[][] = [];
  let disk = begin;
  const api = {
    spec: async () => ({ text: disk, revision: "1", error: null, analysis: { diagnostics: [], net: null } }),
    check: async () => ({ diagnostics: [], net: null }),
    save: async (text: string) => ((disk = text), { revision: "2" }),
    edit: async (text: string, edits: Edit[]) => {
      asked.push(edits);
      await new Promise<void>((done) => held.push(done));
      const whole = { from: { line: 0, character: 0 }, to: { line: text.split("\n").length, character: 0 } };
      const answer: PlacedText[] = [{ ...whole, text: edits.reduce(edited, text) }];
      return { edits: answer, files: [] };
    },
  };
  const draft = new Draft(api as unknown as Api);
  const editor = new Editor(api as unknown as Api, draft);
  await editor.load(Promise.resolve("here/spec.yaml"));
  /** Answers the requests so far, and all that follow from them. */
  const answer = async () => {
    while (draft.queue.busy) {
      await vi.waitFor(() => expect(held.length).toBeGreaterThan(0));
      held.shift()!();
      await new Promise((done) => setTimeout(done));
    }
  };
  /** So many requests were sent. */
  const sent = (count: number) => vi.waitFor(() => expect(asked.length).toBe(count));
  return { api, draft, editor, answer, sent, asked, stored, onDisk: () => disk };
}

beforeEach(() => void vi.unstubAllGlobals());

describe("an edit that is not done yet", () => {
  it("is not saved, and a save that was asked for after it waits for it", async () => {
    const { draft, editor, answer, onDisk } = await opened();
    void editor.change(set(control, "rate", "33 Hz"));
    expect([draft.text === begin, draft.dirty]).toEqual([true, true]);
    const saved = draft.save();
    void editor.change(set(control, "rate", "34 Hz"));
    await answer();
    expect(await saved).toBe(true);
    expect(onDisk()).toContain("33 Hz");
    expect(draft.text).toContain("34 Hz");
    expect(draft.dirty).toBe(true);
    await draft.save();
    expect([onDisk().includes("34 Hz"), draft.dirty]).toEqual([true, false]);
  });
  it("is undone by an undo that was asked for after it", async () => {
    const { draft, editor, answer } = await opened();
    void editor.change(set(control, "rate", "33 Hz"));
    void editor.undo();
    await answer();
    expect([draft.text, draft.dirty]).toEqual([begin, false]);
    void editor.redo();
    await answer();
    expect(draft.text).toContain("33 Hz");
  });
  it("comes before the text that is typed meanwhile, which is the first that is undone", async () => {
    const { draft, editor, answer, sent } = await opened();
    draft.edit(begin.replace("# end", "# end."), "typing");
    void editor.change(set(control, "rate", "33 Hz"));
    await sent(1);
    for (const end of ["# end.!", "# end.!!"]) draft.edit(begin.replace("# end", end), "typing");
    await answer();
    expect(draft.text).toMatch(/33 Hz[^]*# end\.!!\n/);
    const steps = [];
    for (let step = 0; step < 3; step += 1) {
      await editor.undo();
      steps.push([/33 Hz/.test(draft.text), /# end(.*)/.exec(draft.text)![1]]);
    }
    expect(steps).toEqual([
      [true, "."],
      [false, "."],
      [false, ""],
    ]);
  });
  it("is done with the text that is typed meanwhile on its line", async () => {
    const { draft, editor, answer, sent } = await opened();
    void editor.change(set(control, "rate", "33 Hz"));
    await sent(1);
    draft.edit(begin.replace("rate: 10 Hz", "rate: 10 Hz # mine"), "typing");
    await answer();
    expect(draft.text).toContain("rate: 33 Hz # mine");
  });
  it("is done after a reload", async () => {
    const { editor, answer, stored, draft } = await opened();
    void editor.change(set(control, "rate", "33 Hz"));
    void editor.change(rename(["agents", "a"], "b"));
    void editor.change(set(control, "start", "run"));
    const [[, kept]] = [...stored] as [[string, string]];
    await answer();
    const again = await opened(JSON.parse(kept) as object);
    await again.answer();
    expect(again.draft.text).toBe(draft.text);
    expect(again.draft.text).toMatch(/b:[^]*33 Hz[^]*start: run/);
    await again.draft.save();
    expect([...again.stored]).toEqual([]);
  });
  it("is done once a server that was gone, and has another key, answers", async () => {
    const { draft, editor, answer, api } = await opened();
    const wait = setTimeout;
    vi.stubGlobal("setTimeout", queueMicrotask);
    const { edit } = api;
    const failures = [new ApiError(0, "no answer"), new ApiError(401, "another key")];
    api.edit = (text, edits) => (failures.length > 0 ? Promise.reject(failures.shift()!) : edit(text, edits));
    const done = editor.change(set(control, "rate", "33 Hz"));
    expect(draft.dirty).toBe(true);
    await vi.waitFor(() => expect(failures).toEqual([]));
    vi.stubGlobal("setTimeout", wait);
    await answer();
    expect([await done, draft.text.includes("33 Hz"), draft.store.get().notice]).toEqual([true, true, ""]);
  });
  it("that is refused is no change, and those after it are done", async () => {
    const { draft, editor, answer } = await opened();
    const refused = editor.change(insert([...control, "behaviours"], "run", "{}"));
    void editor.change(set(control, "rate", "33 Hz"));
    await answer();
    expect(await refused).toBe(false);
    expect(draft.store.get().notice).toBe("Not changed: run is taken");
    expect(draft.text).toContain("33 Hz");
  });
});

describe("an edit that is asked for before another one is done", () => {
  it("changes the item that the user saw, wherever it stands then, or is refused", async () => {
    const { draft, editor, answer, asked } = await opened();
    void editor.change(remove(["channels", 0]));
    void editor.change(append(["channels"], "four"));
    void editor.change(remove(["channels", 2]));
    const gone = editor.change(remove(["channels", 0]));
    await answer();
    expect(asked.map(([edit]) => edit!.at)).toEqual([["channels", 0], ["channels"], ["channels", 1]]);
    expect(draft.text).toMatch(/channels:\n {2}- two\n {2}- four\n/);
    expect([await gone, draft.store.get().notice]).toEqual([false, "Not changed: it is not there any more"]);
  });
  it("has the new names of what was renamed", async () => {
    const { draft, editor, answer } = await opened();
    void editor.change(rename(["agents", "a"], "b"));
    void editor.change(rename([...control, "behaviours", "run"], "go"));
    void editor.change(set([...control, "behaviours"], "run", "first"));
    await answer();
    expect(draft.text).toMatch(/b:[^]*go: first/);
  });
  it("gets a name that is free when it is done", async () => {
    const { draft, editor, answer } = await opened();
    const behaviours = [...control, "behaviours"];
    const added = [1, 2].map(() => named("act", keysNow(behaviours), (name) => insert(behaviours, name, "{}")));
    for (const { wish } of added) void editor.change(wish);
    await answer();
    expect(added.map(({ name }) => name)).toEqual(["act", "act_2"]);
    expect(draft.text).toMatch(/act: [^]*act_2: /);
  });
  it("tells where an element of the text before is", async () => {
    const { editor, answer } = await opened();
    let present: unknown;
    void editor.change(rename(["agents", "a"], "b"), (before, moved) => (present = [before, moved(control)]));
    await answer();
    expect(present).toEqual([begin, ["agents", "b", "control"]]);
  });
});
