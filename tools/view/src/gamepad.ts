// SPDX-License-Identifier: Apache-2.0
// A gamepad: what its sticks and buttons ask for since the last look. Standard mapping (W3C Gamepad); others are tried as they are.

export interface PadInput {
  /** Of full tilt, -1 to 1: the hand, and the view. */
  hand: [number, number];
  view: [number, number];
  /** 0: nothing pressed; 1: all the way. */
  pressure: number;
  record: boolean; // has just been pressed
}

const DEAD = 0.12; // of full tilt: what a stick at rest may show
const [A, START, RIGHT_TRIGGER] = [0, 9, 7];

function tilt(x: number | undefined, y: number | undefined): [number, number] {
  const length = Math.hypot(x ?? 0, y ?? 0);
  if (!(length > DEAD)) return [0, 0];
  const kept = (Math.min(1, length) - DEAD) / (1 - DEAD) / length;
  return [(x ?? 0) * kept, (y ?? 0) * kept];
}

export class GamepadReader {
  private hadRecord = false;

  get isThere(): boolean {
    return this.first() !== undefined;
  }
  private first(): Gamepad | undefined {
    return [...(navigator.getGamepads?.() ?? [])].find((pad): pad is Gamepad => pad !== null && pad.connected);
  }

  read(): PadInput | undefined {
    const pad = this.first();
    if (pad === undefined) return undefined;
    const { axes, buttons } = pad;
    const isRecord = buttons[START]?.pressed ?? false;
    const record = isRecord && !this.hadRecord;
    this.hadRecord = isRecord;
    const pressure = Math.max(buttons[RIGHT_TRIGGER]?.value ?? 0, buttons[A]?.pressed ? 1 : 0);
    return { hand: tilt(axes[0], axes[1]), view: tilt(axes[2], axes[3]), pressure, record };
  }
}
