import { afterEach, describe, expect, it, vi } from "vitest";
import { Api, ApiError } from "../../live/api";

afterEach(() => vi.unstubAllGlobals());

const answers = (answer: Response) => vi.stubGlobal("fetch", () => Promise.resolve(answer));
const asked = () => new Api("key").edit("", []).catch((error: unknown) => error as ApiError);

describe("an answer of the server", () => {
  it("that breaks off is none", async () => {
    let step = 0;
    const body = new ReadableStream({
      pull(stream) {
        if (step++ === 0) stream.enqueue(new TextEncoder().encode('{"edits": ['));
        else stream.error(new TypeError("network error"));
      },
    });
    answers(new Response(body));
    expect(await asked()).toMatchObject({ status: 0 });
  });

  it("that is complete and no JSON is an error", async () => {
    answers(new Response("<html>"));
    const error = await asked();
    expect(error).toMatchObject({ status: 200 });
    expect((error as ApiError).message).toMatch(/not JSON/);
  });

  it("may be empty", async () => {
    answers(new Response(""));
    expect(await asked()).toEqual({});
  });
});
