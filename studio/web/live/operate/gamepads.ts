import { isEnabled, padInputs, setupFrom, takesAxis, usualSetup, type Pad, type PadSetup } from "../../model/run/gamepad";
import type { Inputs } from "../../model/run/panel_inputs";
import type { PanelShown } from "../../model/protocol";
import { Store } from "../store";

const kept = (path: string) => `tessera.gamepad.${path}`;

export interface GamepadState {
  /** The gamepad as it was at the last look; null: there is none, or the window has no focus. */
  pad: Pad | null;
  /** By path of a panel: what the user has chosen. */
  setups: ReadonlyMap<string, PadSetup>;
}

/** The gamepad of this computer, and the controls that its parts move. */
export class Gamepads {
  readonly store = new Store<GamepadState>({ pad: null, setups: new Map() });
  /** By path of a panel: axes that were at rest since the panel was taken and the gamepad was there. */
  private readonly atRest = new Map<string, Set<number>>();
  /** Buttons of switches that were pressed at the last look, so that each press switches once. */
  private readonly pressed = new Map<string, Set<string>>();

  constructor(
    private readonly pads: () => readonly (Pad | null)[] = () => (document.hasFocus() ? (navigator.getGamepads?.() ?? []) : []),
    private readonly storage: Pick<Storage, "getItem" | "setItem" | "removeItem"> | null = globalThis.localStorage ?? null,
  ) {}

  /** The gamepad now. A gamepad that is unplugged, or a window without focus, has none. */
  look(): Pad | null {
    const pad = this.pads().find((one) => one != null) ?? null;
    if (pad === null) {
      this.atRest.clear();
      this.pressed.clear();
    }
    return pad;
  }

  /** The same for the display. */
  show(): void {
    const pad = this.look();
    // Browsers give the same object again, so its present values are copied.
    const seen = pad && {
      id: pad.id ?? "",
      mapping: pad.mapping ?? "",
      axes: pad.axes.map((value) => Math.round(value * 100) / 100),
      buttons: pad.buttons.map(({ pressed }) => ({ pressed })),
    };
    if (JSON.stringify(seen) !== JSON.stringify(this.store.get().pad)) this.store.set({ pad: seen });
  }

  setup(panel: PanelShown, number: number): PadSetup {
    const known = this.store.get().setups.get(panel.path);
    return known ?? setupFrom(this.read(panel.path), usualSetup(panel.controls, number));
  }

  change(panel: PanelShown, setup: PadSetup | null): void {
    const setups = new Map(this.store.get().setups);
    if (setup) setups.set(panel.path, setup);
    else setups.delete(panel.path);
    // A button that is pressed while it is chosen switches nothing.
    this.pressed.delete(panel.path);
    this.store.set({ setups });
    try {
      if (setup) this.storage?.setItem(kept(panel.path), JSON.stringify(setup));
      else this.storage?.removeItem(kept(panel.path));
    } catch {
      // Without storage it counts until the page is closed.
    }
  }

  /** The panel was taken: an axis counts only after it was at rest, so that nothing moves by itself. */
  forget(path: string): void {
    this.atRest.delete(path);
    this.pressed.delete(path);
  }

  /** The inputs of the gamepad for the panel now, and the switches that its buttons have just been pressed for. */
  inputsOf(panel: PanelShown, number: number): { inputs: Inputs; switched: readonly string[] } {
    const pad = this.look();
    if (!pad) return { inputs: {}, switched: [] };
    const setup = this.setup(panel, number);
    const rested = this.atRest.get(panel.path) ?? new Set<number>();
    this.atRest.set(panel.path, rested);
    for (const one of panel.controls) {
      const part = takesAxis(one) ? setup.axes[one.field] : null;
      if (part && Math.abs(pad.axes[part.axis] ?? 1) <= setup.deadZone) rested.add(part.axis);
    }
    return {
      inputs: padInputs(panel.controls, pad, setup, (axis) => rested.has(axis)),
      switched: this.switched(panel, pad, setup),
    };
  }

  private switched(panel: PanelShown, pad: Pad, setup: PadSetup): readonly string[] {
    const before = this.pressed.get(panel.path);
    const now = new Set(
      panel.controls
        .filter(({ control, field }) => control === "switch" && pad.buttons[setup.buttons[field] ?? -1]?.pressed)
        .map(({ field }) => field),
    );
    this.pressed.set(panel.path, now);
    // A button that was pressed already when the panel was taken switches nothing.
    return before && isEnabled(setup, pad) ? [...now].filter((field) => !before.has(field)) : [];
  }

  private read(path: string): unknown {
    try {
      return JSON.parse(this.storage?.getItem(kept(path)) ?? "null");
    } catch {
      return null;
    }
  }
}
