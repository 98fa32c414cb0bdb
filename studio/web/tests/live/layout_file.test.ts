// Two tabs that move boxes: all moves count, and nobody loses one without being told.
import { expect, test } from "vitest";
import { ApiError, type Api } from "../../live/api";
import { Draft } from "../../live/draft";
import { LayoutFile } from "../../live/layout_file";

type Boxes = Record<string, [number, number]>;

/** The server, with the file that all tabs share. */
class Disk {
  boxes: Boxes = {};
  private version = 0;
  readonly api = {
    layout: () => Promise.resolve({ boxes: { ...this.boxes }, revision: this.revision, error: null }),
    saveLayout: (boxes: Boxes, revision: string) => {
      if (revision !== this.revision) return Promise.reject(new ApiError(409, "another program has changed it"));
      this.boxes = { ...boxes };
      this.version += 1;
      return Promise.resolve({ revision: this.revision });
    },
  } as unknown as Api;
  get revision(): string {
    return String(this.version);
  }
}

async function tabOn(disk: Disk) {
  const draft = new Draft(disk.api);
  const file = new LayoutFile(disk.api, draft);
  await file.load();
  return {
    file,
    draft,
    move: (path: string, x: number) => {
      const before = file.store.get().boxes[path] ?? null;
      file.move({ before: { [path]: before }, after: { [path]: [x, 0] } }, `move ${path}`);
    },
    hears: () => file.changedOnDisk(disk.revision),
    notice: () => draft.store.get().notice,
  };
}

test("a tab follows the moves of another, and nothing is said of boxes that it has not moved", async () => {
  const disk = new Disk();
  const [one, other] = [await tabOn(disk), await tabOn(disk)];
  one.move("robot", 1);
  await one.hears();
  await other.hears();
  expect(other.file.store.get().boxes).toEqual({ robot: [1, 0] });
  expect([one.notice(), other.notice()]).toEqual(["", ""]);
});

test("a tab whose box another one moves later says so, and undo leads back to its own place", async () => {
  const disk = new Disk();
  const [one, other] = [await tabOn(disk), await tabOn(disk)];
  one.move("robot", 1);
  await one.hears();
  await other.hears();
  other.move("robot", 2);
  await other.hears();
  await one.hears();
  expect(one.file.store.get().boxes).toEqual({ robot: [2, 0] });
  expect(one.notice()).toContain("moved robot. Undo");
  expect(other.notice()).toBe("");
  one.draft.step("undo");
  await one.hears();
  expect(disk.boxes).toEqual({ robot: [1, 0] });
});

test("of two moves at the same time the later one counts, and both tabs say so", async () => {
  const disk = new Disk();
  const [one, other] = [await tabOn(disk), await tabOn(disk)];
  one.move("robot", 1);
  other.move("robot", 2);
  other.move("desk", 3);
  await one.hears();
  await other.hears();
  expect(disk.boxes).toEqual({ robot: [2, 0], desk: [3, 0] });
  await one.hears();
  expect(one.file.store.get().boxes).toEqual(disk.boxes);
  expect(one.notice()).toContain("moved robot. Undo");
  expect(other.notice()).toContain("this tab was later");
});
