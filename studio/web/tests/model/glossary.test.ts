import { readFileSync } from "node:fs";
import { describe, expect, it } from "vitest";
import { meaningOf, readGlossary } from "../../model/glossary";

const glossary = readGlossary(readFileSync(new URL("../../../../docs/reference/glossary.md", import.meta.url), "utf8"));

describe("the glossary", () => {
  it("has a sentence without marks for every term that the page explains", () => {
    const properties = [
      "safe",
      "exclusive_channels",
      "deadlock_free",
      "goes_on",
      "channels_flow",
      "sound_pages",
      "live_behaviours",
      "survives_exceptions",
      "survives_partition",
    ];
    const terms = ["N", "B", "place", "transition", "behaviour", "blocking", "invariants", "agents", "subsystem", "receptor"];
    for (const term of [...properties, ...terms, "effector", "channel", "seed", "recording", "iteration", "token", "rate"]) {
      const meaning = meaningOf(glossary, term);
      expect(meaning, term).toMatch(/^[A-Z].*[a-z)]\.$/);
      expect(meaning!.length, term).toBeLessThan(220);
    }
    for (const [term, meaning] of glossary) expect(meaning, term).not.toMatch(/\*|`|\]\(|\.md/);
    expect(glossary.size).toBeGreaterThan(80);
  });

  it("does not know other words", () => {
    expect(meaningOf(glossary, "who is at the dock was lent it")).toBeUndefined();
  });

  it("gives the sentence of the documents", () => {
    expect(meaningOf(glossary, "N")).toBe("This end of the channel does not wait for the other one.");
    expect(meaningOf(glossary, "rate")).toBe("How often a subsystem begins an iteration, such as 20 Hz.");
  });
});
