/**
 * What the server answers, and the calls for it.
 *
 * All numbers are SI. A failure is a `Problem` (RFC 9457,
 * `application/problem+json`), whose `detail` is a sentence for the user.
 */

export interface Problem {
  title: string;
  status: number;
  /** What is wrong, where, and what to do. */
  detail: string;
  /** Short name, such as "changed-meanwhile", "too-large", "exists". */
  code: string;
}

export interface About {
  version: string;
  /** Name of the directory that is served. */
  directory: string;
  /** Whether campaigns can be made in it; it may be a campaign itself. */
  creates: boolean;
  /** Bytes that an upload may have. */
  upload_limit: number;
  /** Kinds of campaigns that can be made. */
  kinds: string[];
  laws: LawAbout[];
}

export interface LawAbout {
  name: string;
  /** F = … */
  formula: string;
  parameters: { name: string; unit: string; meaning: string; default: number | null }[];
  /** "x" shape at first touch, source and so on, as `windfall card show --laws` says. */
  notes: string;
}

export type Kind = "impacts" | "compression" | "acoustic" | "repeats" | "drop";

/** GET /api/campaigns */
export interface CampaignEntry {
  /** Name of its directory, and of the campaign in addresses. */
  id: string;
  title: string;
  kind: Kind | null;
  /** Rows of impacts.csv. */
  recordings: number;
  /** Newest run in its store. */
  run: { time: string; results: number; failures: number } | null;
  /** Why it cannot be read; a sentence. */
  problem: string | null;
}

export interface TableView {
  columns: string[];
  rows: string[][];
}

/** GET /api/campaigns/{id}; its `ETag` is `version`. */
export interface CampaignView {
  id: string;
  /** Changes whenever campaign.toml, specimens.csv or impacts.csv change. */
  version: string;
  title: string;
  kind: Kind;
  simulated: string | null;
  /** Lines such as ["inertia", "0.01435 kg m²"]. */
  rig: [string, string][];
  channels: ChannelView[];
  /** Column of times and sampling rate of [files]. */
  time: string | null;
  rate: string | null;
  /** Law expressions. */
  laws: string[];
  options: FitOptionsView | null;
  group: string | null;
  specimens: TableView;
  impacts: TableView;
  /** Text of campaign.toml. */
  text: string;
  /** Names of the tables (CSV) that regress and surface can use, "tables/results.csv". */
  tables: string[];
  /** Whether report/report.html is there. */
  report: boolean;
  /** The equal command. */
  command: string;
}

export interface ChannelView {
  /** "force", "position", … */
  quantity: string;
  column: string;
  /** "11 mV/N", "mm", … */
  unit: string;
}

/** Words are those of the command line. */
export interface FitOptionsView {
  quantities: string[];
  weights: string;
  noise: string;
  intervals: string;
  onset: string;
  initial_velocity: string;
  displacement_offset: string;
  end: string;
  free: string[];
}

export interface Finding {
  code: string;
  message: string;
}

export interface Estimate {
  value: number;
  sd: number | null;
  low: number | null;
  high: number | null;
  unit: string;
  held: boolean;
}

/** One law on one impact; as in `windfall fit --format json`. */
export interface ImpactOutcome {
  id: string;
  specimen: string;
  group: string | null;
  file: string;
  law: string;
  quantities: string[];
  parameters: Record<string, Estimate>;
  nuisances: Record<string, Estimate>;
  correlations: Record<string, number>;
  cost: number;
  samples: number;
  evaluations: number;
  converged: boolean;
  residuals: Record<string, { samples: number; noise: number; rms: number; runs_z: number | null }>;
  derived: Record<string, number | null>;
  derived_sd: Record<string, number>;
  derived_from: Record<string, string>;
  fitted: Record<string, number | null>;
  findings: Finding[];
}

export interface Failure {
  id: string;
  specimen: string;
  file: string;
  law: string | null;
  message: string;
}

/** GET /api/campaigns/{id}/results: what the store holds for the present files and
 *  options; nothing is fitted by asking. */
export interface ResultsView {
  /** As `windfall fit --format json` gives them; `null` where nothing is stored. */
  outcome: CampaignOutcome | null;
  /** Results of impacts that changed, or were never fitted. */
  pending: number;
  time: string | null;
}

export interface CampaignOutcome {
  windfall: string;
  campaign: string;
  simulated: string | null;
  effective_mass?: { value: number; sd: number; impacts: number };
  /** Impact outcomes; for other kinds documents with `id`, `specimen`, `values`. */
  impacts: ImpactOutcome[];
  failed: Failure[];
  summary: Record<string, { mean: number; sd: number | null; n: number; cv: number | null }>;
  groups?: {
    group: string | null;
    law: string;
    impacts: number;
    specimens: number;
    parameters: Record<string, { mean: number; sd: number | null; n: number; cv: number | null }>;
    derived: Record<string, { mean: number; sd: number | null; n: number; cv: number | null }>;
  }[];
  findings: Finding[];
}

/** GET /api/campaigns/{id}/recordings */
export interface RecordingEntry {
  /** Path below raw/. */
  file: string;
  bytes: number;
  /** Impacts that lie in it. */
  impacts: string[];
}

/** GET /api/campaigns/{id}/recording?file=F; as `windfall inspect --format json`,
 *  and what the channels seem to be. */
export interface RecordingView {
  file: string;
  format: string;
  rows: number;
  columns: {
    column: string;
    unit: string | null;
    /** "time", or the channel that it could feed ("force", "position", …). */
    role: string | null;
    stored_as: string;
    samples: number;
    smallest: number | null;
    largest: number | null;
    rate: number | null;
    length: number | null;
    start: number | null;
  }[];
  properties: Record<string, string>;
  findings: Finding[];
}

/** GET /api/campaigns/{id}/outline?file=F&channel=C&from=&to=&points=
 *  Smallest and largest sample of each stretch, in order; for few samples the
 *  samples themselves (then low equals high). Values are those of the file. */
export interface Outline {
  channel: string;
  unit: string | null;
  /** Whether `time` is in seconds; otherwise numbers of samples. */
  timed: boolean;
  /** The whole channel, s. */
  start: number;
  end: number;
  samples: number;
  /** Samples in the range asked for. */
  shown: number;
  /** Whether each point is one sample. */
  exact: boolean;
  time: number[];
  low: number[];
  high: number[];
}

/** POST /api/campaigns/{id}/refit: one impact, fitted now; nothing is kept. */
export interface RefitRequest {
  impact: string;
  /** Part of the recording to use, s; null as impacts.csv says or the whole. */
  from: number | null;
  to: number | null;
  /** Law expressions; empty: those of the campaign. */
  laws: string[];
  free: string[];
  quantities: string[];
  weights: string | null;
  noise: string | null;
  intervals: "asymptotic" | "profile" | null;
  onset: string | null;
  initial_velocity: string | null;
  displacement_offset: string | null;
  end: string | null;
  /** Whether the measured series and residuals are wanted. */
  series: boolean;
}

export interface Samples {
  time: number[];
  value: number[];
}

export interface RefitView {
  impact: string;
  /** Part of the recording that was used; null: all of it. */
  from: number | null;
  to: number | null;
  /** Ends of the recording; s. */
  start: number;
  stop: number;
  /** Contact as the force threshold shows it; s on the clock of the recording. */
  onset: number;
  end: number;
  /** "force", "displacement", "rate", "acceleration" around the contact; oriented,
   *  zeroed, SI. At most a few thousand samples each. Absent unless asked for. */
  measured: Record<string, Samples>;
  laws: {
    law: string;
    outcome: ImpactOutcome | null;
    /** Why it could not be fitted. */
    problem: string | null;
    /** Motion under the fitted law. */
    motion: { time: number[]; displacement: number[]; rate: number[]; force: number[] } | null;
    /** Measured less fitted, where measured; SI. */
    residuals: Record<string, Samples>;
  }[];
  findings: Finding[];
  /** The equal command. */
  command: string;
  /** Time that the server took for it; s. */
  seconds: number;
}

/** PUT /api/campaigns/{id}/window: from_s and to_s of an impact in impacts.csv.
 *  PUT /api/campaigns/{id}/options: [fit] of campaign.toml.
 *  PUT /api/campaigns/{id}/text: the whole campaign.toml.
 *  All with `If-Match: version`; 412 "changed-meanwhile" when it is not that any more.
 *  They answer the new CampaignView. */
export interface WindowRequest {
  impact: string;
  from: number | null;
  to: number | null;
}

/** Only what is given is changed. */
export interface OptionsRequest {
  laws?: string[];
  free?: string[];
  quantities?: string[];
  weights?: string;
  noise?: string;
  intervals?: string;
  onset?: string;
  initial_velocity?: string;
  displacement_offset?: string;
  end?: string;
  group?: string;
}

/** PUT /api/campaigns/{id}/channels, with If-Match: [channels] and times of [files].
 *  For campaigns of impacts. */
export interface ChannelsRequest {
  channels: { quantity: string; column: string; unit: string }[];
  /** Column of times, or null where the file or the rate tells them. */
  time: string | null;
  /** Sampling rate, "200 kHz", or null. */
  rate: string | null;
}

/** POST /api/campaigns/{id}/impacts, with If-Match: rows of impacts.csv, and of
 *  specimens.csv where the specimen is new. */
export interface ImpactsRequest {
  impacts: { id: string; specimen: string; file: string; cells: Record<string, string> }[];
}

/** PUT /api/campaigns/{id}/raw?file=F (body: the bytes): 201; 409 "exists", 413 "too-large".
 *  PUT /api/campaigns/{id}/table?file=F: a CSV for regress and surface, into tables/. */
export interface Uploaded {
  file: string;
  bytes: number;
  sha256: string;
  /** What inspect says of it; null for tables. */
  recording: RecordingView | null;
}

/** POST /api/campaigns {id, kind, simulated?}: 201 CampaignView. */
export interface NewCampaign {
  id: string;
  kind: string;
}

export type Work = "fit" | "laws" | "population" | "calibrate" | "report";

/** POST /api/campaigns/{id}/jobs: 202 Job. */
export interface JobRequest {
  work: Work;
  /** Laws of "laws"; covariates of "population"; ways of "calibrate" come from the campaign. */
  laws?: string[];
  covariates?: string[];
  intervals?: string;
}

/** GET /api/jobs, GET /api/jobs/{job}, DELETE /api/jobs/{job} (cancels).
 *  GET /api/jobs/{job}/events: server-sent "progress" and, once, "end"; both with a Job. */
export interface Job {
  job: string;
  campaign: string;
  work: Work;
  state: "running" | "done" | "failed" | "cancelled";
  done: number;
  all: number;
  /** The JSON of the command, once it is done; not in lists. */
  result: unknown;
  problem: string | null;
  command: string;
}

/** GET /api/campaigns/{id}/table?file=F */
export interface DataTable {
  file: string;
  columns: { name: string; numbers: boolean }[];
  rows: string[][];
}

/** POST /api/campaigns/{id}/regress: answers as `windfall regress --format json`
 *  (crates/windfall/src/workflow_regress.rs, workflow_mixed.rs). */
export interface RegressRequest {
  table: string;
  response: string;
  /** "V*R + t" */
  terms: string;
  /** "specimen" */
  random: string[];
  /** "backward" selection with AIC, or none. */
  select: boolean;
}

/** POST /api/campaigns/{id}/surface: answers as `windfall surface --format json`
 *  (crates/windfall/src/surface_outcome.rs), with `command`. */
export interface SurfaceRequest {
  table: string;
  factors: string[];
  responses: { name: string; model: string }[];
  /** "force_N = target 11.3" */
  goals: string[];
  /** "k=0.868" */
  hold: string[];
  along: string | null;
  members: number;
  /** "k,e": predictions over two factors, with the others at `hold` or the optimum. */
  grid: string | null;
  grid_points: number;
}

/** GET /api/scenes */
export interface SceneEntry {
  /** Its directory, and its name in addresses. */
  id: string;
  title: string;
  fruit: number | null;
  contacts: number | null;
  /** When it ended; s. */
  end: number | null;
  /** Whether it can be played. */
  frames: boolean;
  problem: string | null;
}

export interface WallAbout {
  name: string;
  material: string;
  moves: boolean;
  /** Stands for an endless plane. */
  endless: boolean;
  /** Vertices of each face. */
  corners: number;
}

/** GET /api/scenes/{id} */
export interface SceneView {
  id: string;
  about: {
    title: string;
    end: number;
    interval: number;
    fruit: number;
    walls: WallAbout[];
    bounds: { low: [number, number, number]; high: [number, number, number] };
  };
  /** Radius of each fruit; m. */
  radii: number[];
  /** Vertices of each wall at rest, three numbers each; m. */
  vertices: number[][];
  /** Numbers of the vertices of each face of each wall. */
  faces: number[][];
  /** Time of each frame; s. */
  times: number[];
  /** Fruit in each frame. */
  counts: number[];
  /** Force of the last colour; N. */
  most: number;
  /** Colours from no force to the largest. */
  colours: string[];
  /** scene.json, once the scene has ended. */
  outcome: { contacts: number; fruit: number; left: number; end: number; findings: Finding[] } | null;
}

/** A contact of a fruit, in GET /api/scenes/{id}/history?fruit=N. */
export interface ContactView {
  time: number;
  duration: number;
  lasting: boolean;
  partner: string;
  partner_fruit: number | null;
  /** Direction from the centre of the fruit, fixed to it. */
  spot: [number, number, number];
  normal_speed: number;
  tangential_speed: number;
  peak_force: number;
  absorbed_energy: number;
}

export interface FruitHistory {
  fruit: number;
  /** Contacts in events.csv; the hardest are told where there are very many. */
  contacts: number;
  told: ContactView[];
}

/** GET /api/scenes/{id}/hardest?most=N */
export interface HardestFruit {
  fruit: number;
  contacts: number;
  peak_force: number;
  partner: string;
  time: number | null;
  impact_speed: number | null;
  absorbed_energy: number;
}

/** GET /api/campaigns/{id}/card?law=NAME: the law card (TOML) to be saved.
 *  GET /api/campaigns/{id}/report/report.html and what lies beside it.
 *  GET /api/campaigns/{id}/events: server-sent "changed" with {version} when the
 *  files of the campaign or its store change on disk, by whomever.
 *  GET /api/openapi.json */

export class Failed extends Error {
  constructor(readonly problem: Problem) {
    super(problem.detail);
  }
}

async function call<T>(method: string, path: string, options: {
  body?: BodyInit | object;
  version?: string;
  signal?: AbortSignal;
  bytes?: boolean;
} = {}): Promise<T> {
  const headers: Record<string, string> = {};
  let body: BodyInit | undefined;
  if (method !== "GET") headers["X-Windfall"] = "page";
  if (options.version !== undefined) headers["If-Match"] = `"${options.version}"`;
  if (options.body instanceof Blob || typeof options.body === "string") {
    body = options.body;
    headers["Content-Type"] = "application/octet-stream";
  } else if (options.body !== undefined) {
    body = JSON.stringify(options.body);
    headers["Content-Type"] = "application/json";
  }
  let response: Response;
  try {
    response = await fetch(path, { method, headers, body, signal: options.signal });
  } catch (error) {
    if (error instanceof DOMException && error.name === "AbortError") throw error;
    throw new Failed({
      title: "No answer",
      status: 0,
      code: "no-answer",
      detail: "windfall does not answer; is `windfall serve` still running? Nothing was changed.",
    });
  }
  if (!response.ok) {
    const problem = (await response.json().catch(() => null)) as Problem | null;
    throw new Failed(problem ?? {
      title: response.statusText,
      status: response.status,
      code: "unknown",
      detail: `the server answered ${response.status} ${response.statusText}`,
    });
  }
  if (options.bytes) return (await response.arrayBuffer()) as T;
  return response.status === 204 ? (undefined as T) : ((await response.json()) as T);
}

const at = (id: string) => `/api/campaigns/${encodeURIComponent(id)}`;
const scene = (id: string) => `/api/scenes/${encodeURIComponent(id)}`;
const query = (parts: Record<string, string | number | null | undefined>) => {
  const pairs = Object.entries(parts).filter(([, value]) => value !== null && value !== undefined);
  return new URLSearchParams(pairs.map(([key, value]) => [key, String(value)])).toString();
};

export const api = {
  about: () => call<About>("GET", "/api/about"),
  campaigns: () => call<CampaignEntry[]>("GET", "/api/campaigns"),
  create: (body: NewCampaign) => call<CampaignView>("POST", "/api/campaigns", { body }),
  campaign: (id: string) => call<CampaignView>("GET", at(id)),
  results: (id: string) => call<ResultsView>("GET", `${at(id)}/results`),
  recordings: (id: string) => call<RecordingEntry[]>("GET", `${at(id)}/recordings`),
  recording: (id: string, file: string) =>
    call<RecordingView>("GET", `${at(id)}/recording?${query({ file })}`),
  outline: (
    id: string,
    parts: { file: string; channel: string; from?: number; to?: number; points?: number },
    signal?: AbortSignal,
  ) => call<Outline>("GET", `${at(id)}/outline?${query(parts)}`, { signal }),
  refit: (id: string, body: RefitRequest, signal?: AbortSignal) =>
    call<RefitView>("POST", `${at(id)}/refit`, { body, signal }),
  saveWindow: (id: string, version: string, body: WindowRequest) =>
    call<CampaignView>("PUT", `${at(id)}/window`, { body, version }),
  saveOptions: (id: string, version: string, body: OptionsRequest) =>
    call<CampaignView>("PUT", `${at(id)}/options`, { body, version }),
  saveText: (id: string, version: string, text: string) =>
    call<CampaignView>("PUT", `${at(id)}/text`, { body: { text }, version }),
  saveChannels: (id: string, version: string, body: ChannelsRequest) =>
    call<CampaignView>("PUT", `${at(id)}/channels`, { body, version }),
  addImpacts: (id: string, version: string, body: ImpactsRequest) =>
    call<CampaignView>("POST", `${at(id)}/impacts`, { body, version }),
  upload: (id: string, to: "raw" | "table", file: string, bytes: Blob, signal?: AbortSignal) =>
    call<Uploaded>("PUT", `${at(id)}/${to}?${query({ file })}`, { body: bytes, signal }),
  start: (id: string, body: JobRequest) => call<Job>("POST", `${at(id)}/jobs`, { body }),
  jobs: () => call<Job[]>("GET", "/api/jobs"),
  job: (job: string) => call<Job>("GET", `/api/jobs/${job}`),
  cancel: (job: string) => call<Job>("DELETE", `/api/jobs/${job}`),
  table: (id: string, file: string) => call<DataTable>("GET", `${at(id)}/table?${query({ file })}`),
  regress: (id: string, body: RegressRequest) =>
    call<Record<string, unknown>>("POST", `${at(id)}/regress`, { body }),
  surface: (id: string, body: SurfaceRequest, signal?: AbortSignal) =>
    call<Record<string, unknown>>("POST", `${at(id)}/surface`, { body, signal }),
  scenes: () => call<SceneEntry[]>("GET", "/api/scenes"),
  scene: (id: string) => call<SceneView>("GET", scene(id)),
  /** Whole frames from a number on: as many as the server gives at once. */
  frames: (id: string, from: number) =>
    call<ArrayBuffer>("GET", `${scene(id)}/frames?${query({ from })}`, { bytes: true }),
  hardest: (id: string, most: number) =>
    call<HardestFruit[]>("GET", `${scene(id)}/hardest?${query({ most })}`),
  history: (id: string, fruit: number, signal?: AbortSignal) =>
    call<FruitHistory>("GET", `${scene(id)}/history?${query({ fruit })}`, { signal }),
  cardAddress: (id: string, law: string) => `${at(id)}/card?${query({ law })}`,
  reportAddress: (id: string) => `${at(id)}/report/report.html`,
};

/** Follows a job until it ends. */
export function follow(job: string, progress: (job: Job) => void): Promise<Job> {
  return new Promise((resolve, reject) => {
    const events = new EventSource(`/api/jobs/${job}/events`);
    events.addEventListener("progress", (event) => progress(JSON.parse(event.data) as Job));
    events.addEventListener("end", (event) => {
      events.close();
      resolve(JSON.parse(event.data) as Job);
    });
    events.onerror = () => {
      if (events.readyState === EventSource.CLOSED) reject(new Error("the connection was lost"));
    };
  });
}

/** Calls back whenever the files of a campaign change, and when the connection is lost
 *  or there again; the result ends it. */
export function watch(
  id: string,
  changed: (version: string) => void,
  connected: (there: boolean) => void,
): () => void {
  const events = new EventSource(`${at(id)}/events`);
  events.onopen = () => connected(true);
  events.onerror = () => connected(false);
  events.addEventListener("changed", (event) => {
    changed((JSON.parse(event.data) as { version: string }).version);
  });
  return () => events.close();
}
