/**
 * The calls of the HTTP interface; what they send and answer is in types.ts.
 *
 * All numbers are SI. A failure is a `Problem` (RFC 9457,
 * `application/problem+json`), whose `detail` is a sentence for the user.
 */

import type {
  ExclusionGiven,
  Calls,
  FigureGiven,
  CampaignChanged,
  ChannelsGiven,
  GridGiven,
  ImpactsGiven,
  JobGiven,
  JobView,
  NewCampaign,
  NoteGiven,
  OptionsGiven,
  Problem,
  Refit,
  RegressGiven,
  SurfaceGiven,
  Way,
  WindowGiven,
} from "./types";

export class Failed extends Error {
  constructor(readonly problem: Problem) {
    super(problem.detail);
  }
}

/** Told whenever the server answers: whether it refused for want of its token. */
export const admission = { told: (_refused: boolean): void => {} };

interface Options<K extends keyof Calls> {
  /** Behind "?". */
  query?: Calls[K]["query"];
  body?: Calls[K]["body"];
  /** Version of the campaign that a change is based on. */
  version?: string;
  signal?: AbortSignal;
}

/** Sends a request; parts of the address in braces are filled from `path`, in order. */
async function call<K extends keyof Calls>(
  key: K,
  path: string[] = [],
  { query, body, version, signal }: Options<K> = {},
): Promise<Calls[K]["answer"]> {
  const [method, address] = key.split(" ") as [string, string];
  const headers: Record<string, string> = {};
  if (method !== "GET") headers["X-Windfall"] = "page";
  if (version !== undefined) headers["If-Match"] = `"${version}"`;
  if (body !== undefined) {
    headers["Content-Type"] = body instanceof Blob ? "application/octet-stream" : "application/json";
  }
  let response: Response;
  try {
    response = await fetch(addressOf(address, path, query), {
      method,
      headers,
      body: body === undefined || body instanceof Blob ? body : JSON.stringify(body),
      signal,
    });
  } catch (error) {
    if (error instanceof DOMException && error.name === "AbortError") throw error;
    throw new Failed({
      title: "No answer",
      status: 0,
      code: "no-answer",
      detail: "windfall does not answer; is `windfall serve` still running? Nothing was changed.",
    });
  }
  admission.told(response.status === 401);
  if (!response.ok) {
    const problem = (await response.json().catch(() => null)) as Problem | null;
    throw new Failed(problem ?? {
      title: response.statusText,
      status: response.status,
      code: "unknown",
      detail: `the server answered ${response.status} ${response.statusText}`,
    });
  }
  const json = response.headers.get("Content-Type")?.startsWith("application/json");
  return (await (json ? response.json() : response.arrayBuffer())) as Calls[K]["answer"];
}

function addressOf(template: string, path: string[], query: object = {}): string {
  let next = 0;
  const address = template.replace(/\{\w+\}/g, () => encodeURIComponent(path[next++] ?? ""));
  const pairs = Object.entries(query).filter(([, value]) => value !== null && value !== undefined);
  const words = new URLSearchParams(pairs.map(([key, value]) => [key, String(value)])).toString();
  return words === "" ? address : `${address}?${words}`;
}

export const api = {
  about: () => call("GET /api/about"),
  findings: () => call("GET /api/findings"),
  campaigns: () => call("GET /api/campaigns"),
  create: (body: NewCampaign) => call("POST /api/campaigns", [], { body }),
  campaign: (id: string) => call("GET /api/campaigns/{id}", [id]),
  results: (id: string) => call("GET /api/campaigns/{id}/results", [id], { query: { impacts: "brief" } }),
  rigs: () => call("GET /api/rigs"),
  /** What impulse and momentum say of the mass. */
  momentum: (id: string) => call("GET /api/campaigns/{id}/momentum", [id]),
  /** Tables and figures of a campaign that fits no impacts, or of one of its recordings. */
  measured: (id: string, item?: string) => call("GET /api/campaigns/{id}/measured", [id], { query: { item } }),
  recordings: (id: string) => call("GET /api/campaigns/{id}/recordings", [id]),
  recording: (id: string, file: string) => call("GET /api/campaigns/{id}/recording", [id], { query: { file } }),
  outline: (id: string, query: Calls["GET /api/campaigns/{id}/outline"]["query"], signal?: AbortSignal) =>
    call("GET /api/campaigns/{id}/outline", [id], { query, signal }),
  refit: (id: string, body: Refit, signal?: AbortSignal) =>
    call("POST /api/campaigns/{id}/refit", [id], { body, signal }),
  /** A figure as a file. */
  figure: (id: string, body: FigureGiven) => call("POST /api/campaigns/{id}/figure", [id], { body }),
  saveWindow: (id: string, version: string, body: WindowGiven) =>
    call("PUT /api/campaigns/{id}/window", [id], { body, version }),
  saveExclusion: (id: string, version: string, body: ExclusionGiven) =>
    call("PUT /api/campaigns/{id}/exclusion", [id], { body, version }),
  /** Without an impact: the note on the campaign. */
  saveNote: (id: string, version: string, body: NoteGiven) =>
    call("PUT /api/campaigns/{id}/note", [id], { body, version }),
  undo: (id: string, version: string, way: Way) =>
    call("POST /api/campaigns/{id}/undo", [id], { body: { way }, version }),
  /** Files of the change that would be undone, as they are and as they were. */
  undone: (id: string, way: Way) => call("GET /api/campaigns/{id}/undo", [id], { query: { way } }),
  kept: (id: string) => call("GET /api/campaigns/{id}/kept", [id]),
  saveOptions: (id: string, version: string, body: OptionsGiven) =>
    call("PUT /api/campaigns/{id}/options", [id], { body, version }),
  saveRig: (id: string, version: string, keys: Record<string, string>) =>
    call("PUT /api/campaigns/{id}/rig", [id], { body: { keys }, version }),
  saveText: (id: string, version: string, text: string) =>
    call("PUT /api/campaigns/{id}/text", [id], { body: { text }, version }),
  saveChannels: (id: string, version: string, body: ChannelsGiven) =>
    call("PUT /api/campaigns/{id}/channels", [id], { body, version }),
  addImpacts: (id: string, version: string, body: ImpactsGiven) =>
    call("POST /api/campaigns/{id}/impacts", [id], { body, version }),
  upload: (id: string, to: "raw" | "table", file: string, body: Blob, signal?: AbortSignal) =>
    call(`PUT /api/campaigns/{id}/${to}`, [id], { query: { file }, body, signal }),
  start: (id: string, body: JobGiven) => call("POST /api/campaigns/{id}/jobs", [id], { body }),
  jobs: () => call("GET /api/jobs"),
  cancel: (job: string) => call("DELETE /api/jobs/{job}", [job]),
  table: (id: string, file: string) => call("GET /api/campaigns/{id}/table", [id], { query: { file } }),
  regress: (id: string, body: RegressGiven) => call("POST /api/campaigns/{id}/regress", [id], { body }),
  surface: (id: string, body: SurfaceGiven, signal?: AbortSignal) =>
    call("POST /api/campaigns/{id}/surface", [id], { body, signal }),
  contours: (body: GridGiven, signal?: AbortSignal) => call("POST /api/contours", [], { body, signal }),
  scenes: () => call("GET /api/scenes"),
  scene: (id: string) => call("GET /api/scenes/{id}", [id]),
  /** Whole frames from a number on: as many as the server gives at once. */
  frames: (id: string, from: number) => call("GET /api/scenes/{id}/frames", [id], { query: { from } }),
  hardest: (id: string, most: number) => call("GET /api/scenes/{id}/hardest", [id], { query: { most } }),
  totals: (id: string) => call("GET /api/scenes/{id}/totals", [id]),
  history: (id: string, fruit: number, signal?: AbortSignal) =>
    call("GET /api/scenes/{id}/history", [id], { query: { fruit }, signal }),
  cardAddress: (id: string, law: string) => addressOf("/api/campaigns/{id}/card", [id], { law }),
  reportAddress: (id: string) => addressOf("/api/campaigns/{id}/report/report.html", [id]),
};

/** Follows a job until it ends. */
export function follow(job: string, progress: (job: JobView) => void): Promise<JobView> {
  return new Promise((resolve, reject) => {
    const events = new EventSource(addressOf("/api/jobs/{job}/events", [job]));
    events.addEventListener("progress", (event) => progress(JSON.parse(event.data) as JobView));
    events.addEventListener("end", (event) => {
      events.close();
      resolve(JSON.parse(event.data) as JobView);
    });
    events.onerror = () => {
      if (events.readyState === EventSource.CLOSED) reject(new Error("the connection was lost"));
    };
  });
}

/** Calls back whenever the files of a campaign change, and when the connection is lost
 *  or restored; the result ends it. */
export function watch(
  id: string,
  changed: (version: string) => void,
  connected: (there: boolean) => void,
): () => void {
  let events: EventSource;
  let again: ReturnType<typeof setTimeout> | undefined;
  const connect = (): void => {
    events = new EventSource(addressOf("/api/campaigns/{id}/events", [id]));
    events.onopen = () => connected(true);
    events.onerror = () => {
      connected(false);
      if (events.readyState !== EventSource.CLOSED) return;
      // The browser tries again only where nobody answers. Here somebody did: a call tells why.
      void api.about().catch(() => {});
      again = setTimeout(connect, 2000);
    };
    events.addEventListener("changed", (event) => {
      changed((JSON.parse(event.data) as CampaignChanged).version);
    });
  };
  connect();
  return () => {
    clearTimeout(again);
    events.close();
  };
}
