/** Lines that two texts have in common, and those that only one has. */

interface DiffLine {
  sign: " " | "-" | "+";
  text: string;
}

/** Turns `before` into `after` with as few changed lines as possible. */
export function difference(before: string, after: string): DiffLine[] {
  const [all, next] = [before.split("\n"), after.split("\n")];
  // Long texts mostly agree: only what lies between their common ends is compared.
  const most = Math.min(all.length, next.length);
  let head = 0;
  while (head < most && all[head] === next[head]) head++;
  let tail = 0;
  while (tail < most - head && all.at(-1 - tail) === next.at(-1 - tail)) tail++;
  const same = (lines: string[]) => lines.map((text): DiffLine => ({ sign: " ", text }));
  const between = (lines: string[]) => lines.slice(head, lines.length - tail);
  return [
    ...same(all.slice(0, head)),
    ...differenceOf(between(all), between(next)),
    ...same(all.slice(all.length - tail)),
  ];
}

function differenceOf(old: string[], young: string[]): DiffLine[] {
  // common[i][j]: length of the longest common part of old[i..] and young[j..].
  const common = Array.from({ length: old.length + 1 }, () => new Uint32Array(young.length + 1));
  for (let i = old.length - 1; i >= 0; i--) {
    for (let j = young.length - 1; j >= 0; j--) {
      common[i]![j] =
        old[i] === young[j]
          ? common[i + 1]![j + 1]! + 1
          : Math.max(common[i + 1]![j]!, common[i]![j + 1]!);
    }
  }
  const lines: DiffLine[] = [];
  let [i, j] = [0, 0];
  while (i < old.length || j < young.length) {
    if (i < old.length && j < young.length && old[i] === young[j]) {
      lines.push({ sign: " ", text: old[i++]! });
      j++;
    } else if (j >= young.length || (i < old.length && common[i + 1]![j]! >= common[i]![j + 1]!)) {
      lines.push({ sign: "-", text: old[i++]! });
    } else {
      lines.push({ sign: "+", text: young[j++]! });
    }
  }
  return lines;
}

/** The changed lines with `around` lines about them; null where lines are left out. */
export function changes(lines: DiffLine[], around = 2): (DiffLine | null)[] {
  const near = lines.map((_, index) =>
    lines.slice(Math.max(0, index - around), index + around + 1).some((line) => line.sign !== " "),
  );
  const out: (DiffLine | null)[] = [];
  lines.forEach((line, index) => {
    if (near[index]) out.push(line);
    else if (out.at(-1) !== null) out.push(null);
  });
  return out;
}
