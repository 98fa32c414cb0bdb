import { expect, test } from "vitest";
import type { Api } from "../../live/api";
import type { Draft } from "../../live/draft";
import { Sources } from "../../live/sources";
import type { FunctionShown } from "../../model/protocol";
import { Store } from "../../live/store";

const at = (line: number): FunctionShown => ({
  subsystem: "robot.control",
  function: "follow",
  state: "defined",
  file: "src/control.cpp",
  line,
  stub: "",
  leftovers: [],
});

test("a file that another program changed is read again when its functions are elsewhere", async () => {
  let text = "void follow() {\n}\n";
  const read: string[] = [];
  const api = {
    functions: () => Promise.resolve([at(1 + text.split("\n").indexOf("void follow() {"))]),
    source: (file: string) => {
      read.push(file);
      return Promise.resolve({ text, revision: text });
    },
  };
  const draft = { store: new Store({ text: "" }) };
  const sources = new Sources(api as unknown as Api, draft as unknown as Draft);
  await sources.look();
  await sources.open("src/control.cpp");
  expect(read).toHaveLength(1);
  text = `// theirs\n${text}`;
  await sources.look();
  expect(read).toHaveLength(2);
  expect(sources.store.get().files.get("src/control.cpp")?.text).toBe(text);
  await sources.look();
  expect(read).toHaveLength(2);
});
