import { describe, expect, it } from "vitest";
import { nameList } from "../../../model/text/name_list";

describe("nameList", () => {
  it("makes a list of YAML from typed names, with quotes around an index", () => {
    expect(nameList("grant")).toBe("[grant]");
    expect(nameList(" line, +motion ,-back")).toBe("[line, +motion, -back]");
    expect(nameList("grant[i], request")).toBe('["grant[i]", request]');
    expect(nameList("[grant[i]]")).toBe('["grant[i]"]');
  });
  it("keeps what is a list already, an alias, and what it does not understand", () => {
    expect(nameList('["grant[i]", a]')).toBe('["grant[i]", a]');
    for (const text of ["", "[]", "*names", "&names [a]", "{ first: [a] }", "a b", "a,", "+'a[i]'"])
      expect(nameList(text)).toBe(text);
  });
});
