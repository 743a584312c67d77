/** Pictures that a browser has encoded as VP8 (RFC 6386), as a WebM file (RFC 9559). */

/** A picture, and when it is shown from the beginning on; ms. */
interface Encoded {
  time: number;
  /** Whether it is whole, and not the difference from the one before. */
  whole: boolean;
  data: Uint8Array<ArrayBuffer>;
}

type Bytes = Uint8Array<ArrayBuffer>[];

const size = (parts: Bytes) => parts.reduce((sum, part) => sum + part.length, 0);

/** An integer in so many bytes, the most significant first. */
function bytes(value: number, count: number): Uint8Array<ArrayBuffer> {
  return Uint8Array.from({ length: count }, (_, k) => Math.floor(value / 256 ** (count - 1 - k)) % 256);
}

/** An element: what it is, how long, what is in it. */
function element(id: number, content: Bytes): Bytes {
  const name = bytes(id, Math.ceil(Math.log2(id + 1) / 8));
  // Eight bytes, the first of which says that there are eight.
  const length = bytes(size(content), 8);
  length[0] = 1;
  return [name, length, ...content];
}

const integer = (id: number, value: number) => element(id, [bytes(value, 4)]);
const words = (id: number, text: string) => element(id, [new TextEncoder().encode(text)]);

function float(id: number, value: number): Bytes {
  const held = new Uint8Array(8);
  new DataView(held.buffer).setFloat64(0, value);
  return element(id, [held]);
}

/** Pictures from a whole one, at `start`, up to the next; they can be shown without what was before. */
function cluster(start: number, pictures: Encoded[]): Bytes {
  const blocks = pictures.map(({ time, whole, data }) =>
    // Of track 1, so long after the start.
    element(0xa3, [Uint8Array.of(0x81), bytes(time - start, 2), Uint8Array.of(whole ? 0x80 : 0), data]));
  return element(0x1f43b675, [...integer(0xe7, start), ...blocks.flat()]);
}

/** Where in the file the pictures of a time are. */
function cue(time: number, position: number): Bytes {
  const place = element(0xb7, [...integer(0xf7, 1), ...integer(0xf1, position)]);
  return element(0xbb, [...integer(0xb3, time), ...place]);
}

/** A film.
 *
 *  * `pictures`: in order of time, in whole milliseconds; the first is whole, and no more than 32 s
 *    lie between two that are
 *  * `duration`: ms
 */
export function webm(pictures: Encoded[], [width, height]: [number, number], duration: number): Blob {
  const head = element(0x1a45dfa3, [
    ...integer(0x4286, 1), ...integer(0x42f7, 1), ...integer(0x42f2, 4), ...integer(0x42f3, 8),
    ...words(0x4282, "webm"), ...integer(0x4287, 2), ...integer(0x4285, 2),
  ]);
  const info = element(0x1549a966, [
    // Times in milliseconds.
    ...integer(0x2ad7b1, 1e6), ...float(0x4489, duration),
    ...words(0x4d80, "windfall"), ...words(0x5741, "windfall"),
  ]);
  const video = element(0xe0, [...integer(0xb0, width), ...integer(0xba, height)]);
  const track = element(0xae, [
    // Number, identity, video, no lacing.
    ...integer(0xd7, 1), ...integer(0x73c5, 1), ...integer(0x83, 1), ...integer(0x9c, 0),
    ...words(0x86, "V_VP8"), ...video,
  ]);
  const content: Bytes = [...info, ...element(0x1654ae6b, track)];

  const starts = pictures.flatMap(({ whole, time }, first) => (whole ? [{ time, first }] : []));
  const cues: Bytes = [];
  let position = size(content);
  starts.forEach(({ time, first }, k) => {
    const own = cluster(time, pictures.slice(first, starts[k + 1]?.first));
    cues.push(...cue(time, position));
    position += size(own);
    content.push(...own);
  });
  return new Blob([...head, ...element(0x18538067, [...content, ...element(0x1c53bb6b, cues)])], { type: "video/webm" });
}
