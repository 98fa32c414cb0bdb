import { expect, it } from "vitest";
import { lineText } from "../../model/text/list_text";
import { YamlText } from "../../model/text/yaml_text";

const text =
  "a: &r2 10 Hz\nb:\n  rate: *r2\n  lines: # them\n    - *r2\n    - x\n    - robot[0].b # first\n  map: { one: 1 }\nc: *m\n";
const yaml = new YamlText(text);

it("tells values as they are written, and where", () => {
  expect(yaml.valueText(["a"])).toBe("10 Hz");
  expect(yaml.valueText(["b", "rate"])).toBe("*r2");
  expect(yaml.isAlias(["b", "rate"])).toBe(true);
  expect(yaml.keys(["b"])).toEqual(["rate", "lines", "map"]);
  expect([yaml.line(["b", "lines"]), yaml.endLine(["b", "lines"])]).toEqual([4, 7]);
  expect(yaml.data(["b", "map"])).toEqual({ one: 1 });
  const [from, to] = yaml.range(["b", "lines", 2])!;
  expect(text.slice(from, to)).toBe("robot[0].b");
});

it("shows a list in lines of its own as one line", () => {
  expect(lineText(yaml, ["b", "lines"])).toBe('[*r2, x, "robot[0].b"]');
  expect(lineText(yaml, ["a"])).toBe("10 Hz");
});
