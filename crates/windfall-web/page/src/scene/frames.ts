/**
 * Frames of a scene, as they stand in frames.bin (crates/scene-run/src/run/frame_format.rs):
 * fetched in pieces around the time shown, and dropped again.
 */

import { api } from "../api/calls";
import type { SceneView } from "../api/types";

const HEADER = 16;
const WALL = 28;
const FRUIT = 48;
/** Words of 32 bits of a fruit. */
export const WORDS = FRUIT / 4;
/** Where in them place, orientation, velocity and largest peak force begin. */
export const PLACE = 1;
export const TURN = 4;
export const VELOCITY = 8;
export const PEAK = 11;

/** Bytes that the server gives at once. */
const PIECE = 4 << 20;
/** Pieces that are kept. */
const KEPT = 24;

export interface Frame {
  time: number;
  count: number;
  /** Of each wall: rotation (w, x, y, z) and shift. */
  walls: Float32Array;
  /** Numbers of fruit are words of it, all else is numbers. */
  words: Uint32Array;
  numbers: Float32Array;
}

/** All frames of a piece. */
function decode(bytes: ArrayBuffer, walls: number): Frame[] {
  const view = new DataView(bytes);
  const frames: Frame[] = [];
  for (let at = 0; at + HEADER <= bytes.byteLength; ) {
    if (view.getUint32(at, true) !== 0x656d7266) throw new Error("the frames cannot be read: reload the page");
    const count = view.getUint32(at + 4, true);
    const fruit = at + HEADER + walls * WALL;
    frames.push({
      time: view.getFloat64(at + 8, true),
      count,
      walls: new Float32Array(bytes, at + HEADER, walls * (WALL / 4)),
      words: new Uint32Array(bytes, fruit, count * WORDS),
      numbers: new Float32Array(bytes, fruit, count * WORDS),
    });
    at = fruit + count * FRUIT;
  }
  return frames;
}

export class Frames {
  /** First frames of the pieces. */
  readonly #starts: number[] = [];
  readonly #pieces = new Map<number, Promise<Frame[]>>();
  readonly #there = new Map<number, Frame[]>();

  constructor(readonly view: SceneView) {
    const walls = view.about.walls.length;
    let size = Infinity;
    view.counts.forEach((count, frame) => {
      const own = HEADER + walls * WALL + count * FRUIT;
      // As the server fills its pieces.
      if (size + own > PIECE) {
        this.#starts.push(frame);
        size = 0;
      }
      size += own;
    });
  }

  #startOf(frame: number): number {
    let start = 0;
    for (const own of this.#starts) if (own <= frame) start = own;
    return start;
  }

  /** A frame, where it is there already. */
  get(frame: number): Frame | null {
    const start = this.#startOf(frame);
    return this.#there.get(start)?.[frame - start] ?? null;
  }

  /** A frame, fetched if need be, and the piece behind it. */
  async need(frame: number): Promise<Frame | null> {
    const start = this.#startOf(frame);
    const next = this.#starts[this.#starts.indexOf(start) + 1];
    const frames = await this.#piece(start);
    // Prefetches what plays next.
    if (next !== undefined) void this.#piece(next).catch(() => undefined);
    return frames[frame - start] ?? null;
  }

  #piece(start: number): Promise<Frame[]> {
    const known = this.#pieces.get(start);
    // Least recently used pieces go first.
    if (known) this.#pieces.delete(start);
    const piece = known ?? this.#fetch(start);
    this.#pieces.set(start, piece);
    for (const old of this.#pieces.keys()) {
      if (this.#pieces.size <= KEPT) break;
      this.#pieces.delete(old);
      this.#there.delete(old);
    }
    return piece;
  }

  async #fetch(start: number): Promise<Frame[]> {
    try {
      const frames = decode(await api.frames(this.view.id, start), this.view.about.walls.length);
      this.#there.set(start, frames);
      return frames;
    } catch (error) {
      this.#pieces.delete(start);
      throw error;
    }
  }
}

/** Number of the last frame that is not later than a time. */
export function frameAt(times: number[], time: number): number {
  let low = 0;
  let high = times.length - 1;
  while (low < high) {
    const middle = (low + high + 1) >> 1;
    if (times[middle]! <= time + 1e-9) low = middle;
    else high = middle - 1;
  }
  return low;
}
