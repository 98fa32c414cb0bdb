import { existsSync } from "node:fs";
import { expect, it } from "vitest";
import { beginningOf, robots, worlds } from "../../model/beginnings";

it("each pair of answers leads to an example that exists, or to a specification with the name of the project", () => {
  for (const robot of robots)
    for (const world of worlds) {
      const one = beginningOf(robot, world);
      if ("example" in one)
        expect(existsSync(new URL(`../../../../examples/${one.example}/spec.yaml`, import.meta.url)), one.example).toBe(true);
      else expect(one.specification("my_system")).toMatch(/^tessera: 1\nsystem: my_system\n/);
      expect(one.says).toMatch(/\.$/);
    }
});
