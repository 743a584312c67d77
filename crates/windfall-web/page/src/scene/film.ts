/** Pictures and films of a scene. */

import { drawLegend, drawOver, LEGEND, type Ink } from "./overlay";
import type { Player } from "./player";
import type { Shade } from "./shades";

/** Width of a picture: 174 mm at 350 dots per inch; px. */
const WIDE = 2400;
/** Width of a film; px. */
const FILM = 1280;
/** How long the last picture stands; ms. */
const STANDS = 400;
const LEAST = 100;
/** How long a recorder rests before it is stopped, as it then loses what it still encodes; ms. */
const RESTS = 1000;

/** What is seen. */
export interface Look {
  player: Player;
  shade: Shade;
  colours: string[];
  ink: Ink;
}

/** The scene, its overlay and legend on one canvas that is `width` pixels wide. */
function sheet(player: Player, width: number): { canvas: HTMLCanvasElement; scale: number } {
  const [wide, high] = player.size();
  const scale = width / wide;
  const canvas = document.createElement("canvas");
  // Codecs of films want even numbers.
  canvas.width = 2 * Math.round((wide * scale) / 2);
  canvas.height = 2 * Math.round(((high + LEGEND) * scale) / 2);
  return { canvas, scale };
}

function fill(canvas: HTMLCanvasElement, scale: number, look: Look, time: number): void {
  const context = canvas.getContext("2d");
  if (!context) throw new Error("this browser draws no pictures");
  const { player, ink } = look;
  const [wide, high] = player.size();
  context.setTransform(scale, 0, 0, scale, 0, 0);
  context.fillStyle = ink.background;
  context.fillRect(0, 0, wide + 1, high + LEGEND + 1);
  context.drawImage(player.canvas, 0, 0, wide, high);
  drawOver(context, player, high, ink);
  drawLegend(context, [wide, high], look.shade, look.colours, `${time.toFixed(3)} s`, ink);
}

/** A picture of what is shown, as PNG. */
export async function pictureOf(look: Look, time: number): Promise<Blob> {
  const { canvas, scale } = sheet(look.player, WIDE);
  look.player.enlarge(scale);
  try {
    look.player.render();
    fill(canvas, scale, look, time);
  } finally {
    look.player.enlarge(null);
  }
  const blob = await new Promise<Blob | null>((done) => canvas.toBlob(done, "image/png"));
  if (!blob) throw new Error("the picture is too large for this browser");
  return blob;
}

/** A film from one time to another, as WebM; it takes as long to make as to see.
 *
 *  * `speed`: seconds of the scene in one of the film
 *  * `show`: brings the player to a time
 *  * `going`: false to stop, with what was filmed until then
 */
export async function filmOf(
  look: Look,
  [from, to]: [number, number],
  speed: number,
  show: (time: number) => Promise<void>,
  going: () => boolean,
): Promise<Blob> {
  // VP8 takes a fraction of the work of VP9, which would leave fewer pictures.
  const kinds = ["video/webm;codecs=vp8", "video/webm;codecs=vp9", "video/webm"];
  const type = typeof MediaRecorder === "undefined" ? undefined : kinds.find((kind) => MediaRecorder.isTypeSupported(kind));
  if (!type) throw new Error("this browser makes no films (WebM); `windfall scene vtk` writes frames for ParaView");
  const { canvas, scale } = sheet(look.player, FILM);
  const draw = (time: number) => {
    look.player.render();
    fill(canvas, scale, look, time);
  };
  look.player.enlarge(scale);
  await show(from);
  draw(from);
  const stream = canvas.captureStream();
  const recorder = new MediaRecorder(stream, { mimeType: type, videoBitsPerSecond: 8e6 });
  const pieces: Blob[] = [];
  recorder.ondataavailable = (event) => pieces.push(event.data);
  const whole = new Promise<Blob>((done) => {
    recorder.onstop = () => done(new Blob(pieces, { type: "video/webm" }));
  });
  recorder.start(1000);
  try {
    const began = performance.now();
    // Slow computers film fewer pictures; the time stays right: each is of the time at which it
    // will be drawn, if it takes as long as the one before; ms.
    let takes = 0;
    for (let time = from; time < to && going(); ) {
      await new Promise(requestAnimationFrame);
      const asked = performance.now();
      time = Math.min(from + ((asked - began + takes) / 1000) * speed, to);
      await show(time);
      draw(time);
      takes = performance.now() - asked;
    }
    // What the last picture came too late by is taken off the time for which it stands.
    const late = performance.now() - began - (1000 * (to - from)) / speed;
    const stands = going() ? STANDS - late : STANDS;
    await new Promise((done) => setTimeout(done, Math.max(stands, LEAST)));
    recorder.pause();
    await new Promise((done) => setTimeout(done, RESTS));
  } finally {
    recorder.stop();
    look.player.enlarge(null);
  }
  const blob = await whole;
  for (const track of stream.getTracks()) track.stop();
  return blob;
}
