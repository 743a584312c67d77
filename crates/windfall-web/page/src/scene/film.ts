/** Pictures and films of a scene. */

import { drawLegend, drawOver, LEGEND, type Ink } from "./overlay";
import type { Player } from "./player";
import type { Shade } from "./shades";
import { webm } from "./webm";

/** Width of a picture: 174 mm at 350 dots per inch; px. */
const WIDE = 2400;
/** Width of a film; px. */
const FILM = 1280;
/** Pictures of a film in a second. */
const RATE = 30;
/** How long the last picture stands; ms. */
const STANDS = 400;
/** Every how many pictures one is whole, and one can jump to it. */
const WHOLE = 30;

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

/** A film from one time to another, as WebM.
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
  const { canvas, scale } = sheet(look.player, FILM);
  const { width, height } = canvas;
  // VP8 takes a fraction of the work of VP9, and every browser plays it.
  const settings = { codec: "vp8", width, height, bitrate: 8e6, framerate: RATE };
  const known = typeof VideoEncoder !== "undefined" && (await VideoEncoder.isConfigSupported(settings)).supported;
  if (!known) throw new Error("this browser makes no films (WebM); `windfall scene vtk` writes frames for ParaView");

  const pictures: Parameters<typeof webm>[0] = [];
  let failed: DOMException | null = null;
  const encoder = new VideoEncoder({
    output: (chunk) => {
      const data = new Uint8Array(chunk.byteLength);
      chunk.copyTo(data);
      pictures.push({ time: Math.round(chunk.timestamp / 1000), whole: chunk.type === "key", data });
    },
    error: (error) => (failed = error),
  });
  encoder.configure(settings);
  // Microseconds.
  const encode = (timestamp: number, whole: boolean) => {
    const frame = new VideoFrame(canvas, { timestamp });
    encoder.encode(frame, { keyFrame: whole });
    frame.close();
  };
  const seconds = (to - from) / speed;
  let last = 0;
  look.player.enlarge(scale);
  try {
    for (let k = 0; ; k++) {
      const passed = Math.min(k / RATE, seconds);
      const time = passed === seconds ? to : from + passed * speed;
      await show(time);
      look.player.render();
      fill(canvas, scale, look, time);
      last = 1e6 * passed;
      encode(last, k % WHOLE === 0);
      // The page stays alive, and the encoder is not given more than it can do.
      do await new Promise((done) => setTimeout(done));
      while (encoder.encodeQueueSize > 2);
      if (failed || passed === seconds || !going()) break;
    }
    if (failed) throw failed;
    encode(last + 1000 * STANDS, false);
    await encoder.flush();
  } finally {
    look.player.enlarge(null);
    if (encoder.state !== "closed") encoder.close();
  }
  return webm(pictures, [width, height], last / 1000 + STANDS);
}
