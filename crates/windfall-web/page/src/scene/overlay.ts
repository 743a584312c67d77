/** What is drawn over a scene: axes, a bar of known length, and in pictures and films the time
 *  and the scale of colours. */

import { number, quantity } from "../lib/format";
import { ticks, type Scale } from "../plots/scale";
import { wholeLabels } from "./labels";
import type { Player } from "./player";
import type { Shade } from "./shades";

/** Colours of text and lines. */
export interface Ink {
  text: string;
  background: string;
}

const FONT = "12px system-ui, sans-serif";
/** Distance from the edges, and length of an axis; px. */
const EDGE = 14;
const ARM = 30;

/** Axes and the bar of length, at the bottom of a picture of that height. */
export function drawOver(context: CanvasRenderingContext2D, player: Player, height: number, ink: Ink): void {
  context.font = FONT;
  context.lineWidth = 1.6;
  const middle = [EDGE + ARM + 8, height - EDGE - ARM - 6] as const;
  // What points towards the viewer lies over what points away.
  const axes = player.axes().sort((a, b) => a.towards - b.towards);
  context.textAlign = "center";
  context.textBaseline = "middle";
  for (const { name, x, y } of axes) {
    context.strokeStyle = ink.text;
    context.beginPath();
    context.moveTo(...middle);
    context.lineTo(middle[0] + ARM * x, middle[1] + ARM * y);
    context.stroke();
    // An axis along the line of sight is a point with its letter beside it.
    const short = Math.hypot(x, y) < 0.15;
    const at = short ? [middle[0] - 9, middle[1] + 9] : [middle[0] + (ARM + 9) * x, middle[1] + (ARM + 9) * y];
    halo(context, name, at[0]!, at[1]!, ink);
  }
  const { length, width } = player.bar(110);
  const left = 2 * (EDGE + ARM) + 32;
  const bottom = height - EDGE;
  context.beginPath();
  context.moveTo(left, bottom - 5);
  context.lineTo(left, bottom);
  context.lineTo(left + width, bottom);
  context.lineTo(left + width, bottom - 5);
  context.stroke();
  halo(context, quantity(length, "m", 2), left + width / 2, bottom - 12, ink);
}

/** Letters that are read on whatever lies behind. */
function halo(context: CanvasRenderingContext2D, words: string, x: number, y: number, ink: Ink): void {
  const width = context.lineWidth;
  context.lineWidth = 3;
  context.lineJoin = "round";
  context.strokeStyle = ink.background;
  context.strokeText(words, x, y);
  context.fillStyle = ink.text;
  context.fillText(words, x, y);
  context.strokeStyle = ink.text;
  context.lineWidth = width;
}

/** Height of what stands below the scene in a picture; px. */
export const LEGEND = 58;

/** The scale of colours, what it means, and the time, from `top` on. */
export function drawLegend(
  context: CanvasRenderingContext2D,
  [width, top]: [number, number],
  shade: Shade,
  colours: string[],
  time: string,
  ink: Ink,
): void {
  const bar = Math.min(width - 2 * EDGE - 90, 420);
  const scale: Scale = { kind: "linear", domain: [0, shade.most], range: [EDGE, EDGE + bar] };
  const fill = context.createLinearGradient(EDGE, 0, EDGE + bar, 0);
  colours.forEach((own, k) => fill.addColorStop(k / (colours.length - 1), own));
  context.fillStyle = fill;
  context.fillRect(EDGE, top + 6, bar, 10);
  context.fillStyle = ink.text;
  context.font = FONT;
  context.textBaseline = "middle";
  context.textAlign = "center";
  const places = ticks(scale, 5);
  const labels = wholeLabels(scale, places);
  places.forEach((tick, k) => {
    context.fillText(labels[k] ?? number(tick, 3), EDGE + (tick / shade.most) * bar, top + 26);
  });
  context.textAlign = "left";
  context.fillText(shade.title, EDGE, top + 45);
  context.textAlign = "right";
  context.fillText(time, width - EDGE, top + 12);
}
