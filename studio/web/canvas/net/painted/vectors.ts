import { Store } from "../../../live/store";

/** Whether a picture is taken that needs every drawing in elements of SVG. */
export const vectors = new Store<{ wanted: number }>({ wanted: 0 });

/** The mark of a drawing that is on a canvas at present. */
export const painted = "data-painted";

const frame = () => new Promise((done) => requestAnimationFrame(done));

/** Draws the net in elements of SVG, however many they are, until `take` has its picture of them. */
export async function withVectors<T>(areas: readonly Element[], take: () => T): Promise<T> {
  vectors.set({ wanted: vectors.get().wanted + 1 });
  try {
    const waits = () => areas.some((area) => area.hasAttribute(painted) || !area.querySelector(".react-flow__node"));
    for (let frames = 0; waits() && frames < 600; frames += 1) await frame();
    return take();
  } finally {
    vectors.set({ wanted: vectors.get().wanted - 1 });
  }
}
