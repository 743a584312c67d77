import { Failed, admission } from "../api/calls";
import type { Problem } from "../api/types";

/** Downloads an address under a name; throws on failure. */
export async function download(address: string, name: string): Promise<void> {
  const response = await fetch(address).catch(() => {
    throw new Error("windfall does not answer; is `windfall serve` still running?");
  });
  admission.told(response.status === 401);
  if (!response.ok) {
    const problem = (await response.json().catch(() => null)) as Problem | null;
    throw problem ? new Failed(problem) : new Error(`the server answered ${response.status}`);
  }
  saveAs(await response.blob(), name);
}

/** Gives a file to the user. */
export function saveAs(blob: Blob, name: string): void {
  const link = document.createElement("a");
  link.href = URL.createObjectURL(blob);
  link.download = name;
  link.click();
  // Firefox reads the address only after the click was handled.
  setTimeout(() => URL.revokeObjectURL(link.href), 10_000);
}
