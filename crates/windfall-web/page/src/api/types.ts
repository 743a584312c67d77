// Made by `npm run types` from the description of the interface; not to be edited.

/** What the page needs before it opens a campaign. */
export interface About {
  version: string; directory: string; creates: boolean; upload_limit: number; kinds: string[];
  laws: LawAbout[];
}

/** A term of the polynomial in actual units. */
export interface ActualTerm {
  name: string; coefficient: number;
}

/** A quantity of the rig that was estimated along. */
export interface AlongOutcome {
  quantity: string; known: MeasuredValue; value: number;
}

/** A row of an analysis of variance. */
export interface AnovaOutcome {
  term: string; ss: number | null; df: number; f: number; p: number;
}

/** What `fit` gives, whatever the campaign measures. In JSON every kind has `windfall`, `campaign`, `simulated`, `status`, `impacts` (one entry per result), `failed`, `summary` and `findings`. */
export type AnyOutcome = CampaignOutcome | MeasuredOutcome;

/** A model without random effects, or with them. */
export type AnyRegressOutcome = RegressOutcome | MixedOutcome;

/** A box of space; m. */
export interface Bounds {
  low: [number, number, number]; high: [number, number, number];
}

/** The power of the response that suits the model best. */
export interface BoxCoxOutcome {
  lambda: number; low: number | null; high: number | null;
}

/** How many fruit are bruised, and where. */
export interface BruiseOutcome {
  limits: LimitOutcome[]; mean_largest: number; places: PlaceOutcome[];
}

/** Everything that a calibration gives. */
export interface CalibrateOutcome {
  windfall: string; campaign: string; simulated: string | null; law: string; free: string[];
  plate: Record<string, MeasuredValue>; drops: DropOutcome[]; target: TargetOutcome;
  start: StartOutcome; waveform: WaveformOutcome | null; features: FeaturesOutcome | null;
  family: FamilyLine | null; closing: ClosingOutcome[]; design: DesignWayOutcome | null;
  next: NextOutcome | null; failed: FailureOutcome[]; findings: FindingOutcome[];
}

/** A free parameter as estimated. */
export interface CalibratedParameter {
  name: string; value: number; sd: number | null; unit: string; written: WrittenValue;
  at_limit: boolean;
}

/** The files of a campaign, or its store, have changed. */
export interface CampaignChanged {
  version: string;
}

/** A campaign in a list. */
export interface CampaignEntry {
  id: string; title: string; kind: string | null; recordings: number; run: RunView | null;
  problem: string | null;
}

/** Everything that `fit` gives for a campaign. */
export interface CampaignOutcome {
  windfall: string; campaign: string; simulated: string | null; effective_mass: MassOutcome;
  status: StatusOutcome; impacts: ImpactOutcome[]; failed: FailureOutcome[];
  summary: Record<string, SpreadOutcome>; groups: GroupOutcome[]; findings: FindingOutcome[];
}

/** What the files of a campaign say. */
export interface CampaignView {
  id: string; version: string; title: string; kind: string; simulated: string | null;
  rig: [string, string][]; channels: ChannelView[]; time: string | null; rate: string | null;
  laws: string[]; options: FitOptionsView | null; group: string | null; specimens: TableView;
  impacts: TableView; text: string; tables: string[]; report: boolean; command: string;
}

/** A further drop. */
export interface CandidateOutcome {
  height: number; mass: number; fruit: string; impacts: number; drops: number;
  sds: (number | null)[]; gain: number | null; rank: number; gain_of_interest: number | null;
}

/** The stationary point of a quadratic surface. */
export interface CanonicalOutcome {
  shape: string; coded: number[]; actual: number[]; distance: number; inside: boolean;
  value: number; eigenvalues: number[]; directions: number[][];
}

/** A channel. */
export interface ChannelGiven {
  quantity: string; column: string; unit: string;
}

/** A channel as campaign.toml has it. */
export interface ChannelView {
  quantity: string; column: string; unit: string;
}

/** The columns of the channels. */
export interface ChannelsGiven {
  channels: ChannelGiven[]; time?: string | null; rate?: string | null;
}

/** Uncertainties with some knowledge. */
export interface ClosingOutcome {
  with: string; rank: number; sds: (number | null)[];
}

/** One channel of a recording. */
export interface ColumnInspection {
  column: string; unit: string | null; role: string | null; stored_as: string; samples: number;
  smallest: number | null; largest: number | null; rate: number | null; length: number | null;
  start: number | null;
}

/** A contact of a fruit. */
export interface ContactView {
  time: number; duration: number; lasting: boolean; partner: string; partner_fruit: number | null;
  spot: [number, number, number]; normal_speed: number; tangential_speed: number;
  peak_force: number; absorbed_energy: number;
}

/** A level of a contour map. */
export interface ContourLevel {
  value: number; colour: string; area: [number, number][][]; lines: [number, number][][];
}

/** Values on a rectangular grid with their contours. */
export interface ContourMap {
  x: number[]; y: number[]; values: number[]; ground: string; levels: ContourLevel[];
  colours: string[];
}

/** One covariate of a [`Population`]. */
export interface CovariateEffect {
  name: string; centre: number; effects: number[]; sds: number[];
}

/** Quality of predictions of rows left out in parts. */
export interface CrossValidationOutcome {
  folds: number; rms: number; r2: number;
}

/** A column of a table. */
export interface DataColumn {
  name: string; numbers: boolean;
}

/** A table. */
export interface DataTable {
  file: string; columns: DataColumn[]; rows: string[][];
}

/** Table 2 of the study: responses over the depth of full damping. */
export interface DepthOutcome {
  law: string; rows: [number, number[]][]; mean: number[]; sd: number[]; cv: number[];
}

/** A factor of the design. */
export interface DesignFactorOutcome {
  letter: string; name: string; unit: string; low: number; high: number; centre: number;
  half: number;
}

/** The optimum at another height. */
export interface DesignHeight {
  height: number; drops: number; responses: VerifiedResponse[];
}

/** A member of the family on the surfaces. */
export interface DesignMember {
  levels: number[]; desirability: number; heights: HeightFeatures[];
}

/** Settings of a surface with the response there and in the simulator. */
export interface DesignOptimum {
  levels: number[]; law: string; desirability: number; responses: VerifiedResponse[];
}

/** A run of the design. */
export interface DesignRunOutcome {
  coded: number[]; levels: number[]; responses: number[];
}

/** The surface of a response. */
export interface DesignSurfaceOutcome {
  response: string; unit: string; model: string; terms: DesignTerm[]; whole: AnovaOutcome;
  anova: AnovaOutcome[]; residual_ss: number; residual_df: number; total_ss: number; r2: number;
  r2_adjusted: number; r2_predicted: number; sigma: number;
}

/** A term of a surface. */
export interface DesignTerm {
  term: string; coded: number; actual: number;
}

/** Calibration by design and surface. */
export interface DesignWayOutcome {
  kind: string; alpha: number; factors: DesignFactorOutcome[]; runs: DesignRunOutcome[];
  surfaces: DesignSurfaceOutcome[]; optimum: DesignOptimum; family: DesignMember[];
  heights: DesignHeight[]; depth: DepthOutcome | null;
}

/** A direction in the free parameters. */
export interface DirectionOutcome {
  parts: Record<string, number>; sd: number | null; words: string;
}

/** Features of one drop. */
export interface DropOutcome {
  id: string; specimen: string; mass: MeasuredValue; height: MeasuredValue;
  features: Record<string, MeasuredValue>;
}

/** An effect of a group. */
export interface EffectOutcome {
  by: string; group: string; of: string; value: number; sd: number;
}

/** Energies; J. */
export interface EnergyOutcome {
  kinetic: number; rotational: number; potential: number; in_contacts: number; in_friction: number;
  lost_in_contacts: number; lost_by_friction: number; lost_by_drag: number; done_by_walls: number;
}

/** One estimated or held value. */
export interface EstimateOutcome {
  value: number; sd: number | null; low: number | null; high: number | null; unit: string;
  held: boolean;
}

/** Coding of a factor. */
export interface FactorOutcome {
  letter: string; name: string; centre: number; half_range: number; lowest: number; highest: number;
}

/** An impact that could not be fitted. */
export interface FailureOutcome {
  id: string; specimen: string; file: string; law: string | null; message: string;
}

/** The line of laws that have the same features at one height. */
export interface FamilyLine {
  dimension: number; words: string; members: FamilyMember[];
}

/** A law of the line. */
export interface FamilyMember {
  parameters: number[]; law: string; heights: HeightFeatures[];
}

/** Settings that are as good as the best. */
export interface FamilyOutcome {
  dimension: number; along: string; from: number; to: number; members: SettingOutcome[];
}

/** Least squares of features. */
export interface FeaturesOutcome {
  law: string; parameters: CalibratedParameter[]; correlations: number[][]; rank: number;
  directions: DirectionOutcome[]; chi_square: number; freedom: number; p: number | null;
  widened: number; fitted: FittedFeature[]; along: AlongOutcome[]; converged: boolean;
  evaluations: number;
}

/** Something that a reader of the result must know. */
export interface FindingOutcome {
  code: string; message: string;
}

/** Options of the fit, in the words of the command line. */
export interface FitOptionsView {
  quantities: string[]; weights: string; noise: string; intervals: string; onset: string;
  initial_velocity: string; displacement_offset: string; end: string; free: string[];
}

/** A feature as measured and as the law has it. */
export interface FittedFeature {
  drop: string; feature: string; measured: MeasuredValue; fitted: number; standardised: number;
}

/** What the file is about, in its JSON. */
export interface FramesAbout {
  title: string; end: number; interval: number; fruit: number; walls: WallAbout[]; bounds: Bounds;
}

/** What one fruit went through. */
export interface FruitHistory {
  fruit: number; contacts: number; told: ContactView[];
}

/** One fruit. */
export interface FruitOutcome {
  specimen: string; impacts: number; parameters: number[];
}

/** How far predictions are from what was measured. */
export interface GoodnessOutcome {
  chi_squared: number | null; reduced_chi_squared: number | null; caveat: string;
  root_mean_square: number; mean_absolute: number; mean_absolute_relative: number | null;
}

/** Values over a rectangular grid. */
export interface GridGiven {
  x: number[]; y: number[]; values: number[];
}

/** Predictions over two factors, for contours and surfaces. */
export interface GridOutcome {
  columns: string[]; rows: number[][];
}

/** Spread of parameters and derived quantities over the impacts of a group. */
export interface GroupOutcome {
  group: string | null; law: string; impacts: number; specimens: number;
  parameters: Record<string, SpreadOutcome>; derived: Record<string, SpreadOutcome>;
}

/** A fruit in the list of those that were hit hardest. */
export interface HardestFruit {
  fruit: number; contacts: number; peak_force: number; partner: string; time: number | null;
  impact_speed: number | null; absorbed_energy: number;
}

/** Features at a height. */
export interface HeightFeatures {
  height: number; features: Record<string, number>;
}

/** Counts of fruit over the values of a quantity. */
export interface HistogramOutcome {
  quantity: string; unit: string; edges: number[]; fruit: number[];
}

/** Evidence of one impact for one law. */
export interface ImpactEvidenceOutcome {
  id: string; aicc: number;
}

/** A row of impacts.csv. */
export interface ImpactGiven {
  id: string; specimen: string; file: string; cells?: Record<string, string>;
}

/** One law fitted to one impact. */
export interface ImpactOutcome {
  id: string; specimen: string; group: string | null; file: string; law: string;
  quantities: string[]; parameters: Record<string, EstimateOutcome>;
  nuisances: Record<string, EstimateOutcome>; correlations: Record<string, number>; cost: number;
  samples: number; evaluations: number; converged: boolean; residual_norm: number;
  residuals: Record<string, ResidualOutcome>; regression: Record<string, EstimateOutcome>;
  derived: Record<string, null | number>; derived_sd: Record<string, number>;
  derived_from: Record<string, string>; fitted: Record<string, null | number>;
  directions: Record<string, number>[]; intervals: IntervalOutcome; findings: FindingOutcome[];
}

/** Further impacts. */
export interface ImpactsGiven {
  impacts: ImpactGiven[];
}

/** Variance inflation of a term. */
export interface InflationOutcome {
  term: string; df: number; factor: number;
}

/** What a recording holds. */
export interface Inspection {
  file: string; format: string; rows: number; columns: ColumnInspection[];
  properties: Record<string, string>; findings: FindingOutcome[];
}

/** How the intervals of a fit came about. */
export interface IntervalOutcome {
  method: string; replicates?: number | null; failed?: number | null; chains?: number | null;
  draws?: number | null; divergences?: number | null; mixing?: Record<string, MixingOutcome>;
  drawn?: Record<string, number[]>; profiles?: Record<string, ProfileOutcome>;
}

/** A job to start. */
export interface JobGiven {
  work: Work; laws?: string[]; covariates?: string[]; intervals?: string | null;
}

/** State of a job. */
export type JobState = "running" | "done" | "failed" | "cancelled";

/** A job as it is shown. */
export type JobView = JobWork & ({
  job: string; campaign: string; state: JobState; done: number; all: number; problem: string | null;
  command: string;
});

/** Work with what the equal command gives in JSON, once it is done. */
export type JobWork = {
  result: AnyOutcome | null; work: "fit";
} | {
  result: LawsOutcome | null; work: "laws";
} | {
  result: PopulationOutcome | null; work: "population";
} | {
  result: CalibrateOutcome | null; work: "calibrate";
} | {
  result: ReportFiles | null; work: "report";
};

/** Lack of fit against pure error. */
export interface LackOfFitOutcome {
  lack: AnovaOutcome; pure_error: SumOfSquares;
}

/** A force law. */
export interface LawAbout {
  name: string; formula: string; parameters: ParameterAbout[]; notes: string;
}

/** Evidence for one law. */
export interface LawEvidenceOutcome {
  law: string; failed: number; parameters_per_impact: number; cost: number; aicc: number;
  aicc_low?: number | null; aicc_high?: number | null; impacts: ImpactEvidenceOutcome[];
  bic: number; first_share: number; prediction: number | null; prediction_sd: number | null;
  residual_ratio: number; runs_z: number;
}

/** What `windfall laws` gives. */
export interface LawsOutcome {
  windfall: string; campaign: string; simulated: string | null; impacts: number; levels: number;
  verdict: string; meaning: string; laws: LawEvidenceOutcome[]; specimens_first: number[];
  failed: FailureOutcome[]; findings: FindingOutcome[];
}

/** Share of fruit above a limit. */
export interface LimitOutcome {
  limit: number; share: number; interval: number[];
}

/** One law on the impact. */
export interface LiveLaw {
  law: string; outcome: ImpactOutcome | null; problem: string | null; motion: ShownMotion | null;
  residuals: Record<string, ShownSamples>;
}

/** What a live fit gives. */
export interface LiveOutcome {
  impact: string; from: number | null; to: number | null; start: number; stop: number;
  onset: number; end: number; measured: Record<string, ShownSamples>; laws: LiveLaw[];
  findings: FindingOutcome[]; command: string; seconds: number;
}

/** A value of the rig that was found from the recordings. */
export interface MassOutcome {
  value: number; sd: number; impacts: number;
}

/** Spread of the values over a group. */
export interface MeasuredGroup {
  group: string | null; law: string; recordings: number; values: Record<string, SpreadOutcome>;
}

/** What was found in one recording, or of one specimen. */
export interface MeasuredItem {
  id: string; specimen: string; group: string | null; file: string; law: string;
  words: Record<string, string>; parameters: Record<string, MeasuredValue>;
  derived: Record<string, MeasuredValue>; findings: FindingOutcome[];
}

/** Everything that `fit` gives for such a campaign. */
export interface MeasuredOutcome {
  windfall: string; campaign: string; kind: string; simulated: string | null; status: StatusOutcome;
  impacts: MeasuredItem[]; parts?: MeasuredItem[]; failed: FailureOutcome[];
  specimens: MeasuredItem[]; whole: MeasuredItem[]; summary: Record<string, SpreadOutcome>;
  groups: MeasuredGroup[]; findings: FindingOutcome[];
}

/** One value; SI. */
export interface MeasuredValue {
  value: number; sd: number | null; low: number | null; high: number | null; unit: string;
}

/** A fitted mixed model. */
export interface MixedOutcome {
  formula: string; response: string; method: string; df_method: string; rows: number;
  left_out: number; groups: [string, number][]; terms: TermOutcome[]; covariance: number[][];
  ranges: ModelRange[]; anova: MixedTest[]; variances: VarianceOutcome[]; r2: number;
  r2_adjusted: number | null; r2_conditional: number; intraclass: number[]; log_likelihood: number;
  criterion: number; aic: number; aicc: number; bic: number; removed: string[];
  effects: EffectOutcome[]; predictions: MixedPredictionOutcome[]; findings: FindingOutcome[];
}

/** A prediction with the effects of known groups. */
export interface MixedPredictionOutcome {
  line: number; population: number; predicted: number; se: number; mean_low: number;
  mean_high: number; low: number; high: number;
}

/** An F test of a term. */
export type MixedTest = AnovaOutcome & {
  df_denominator: number;
};

/** How well the chains of one parameter agree. */
export interface MixingOutcome {
  r_hat: number | null; bulk_draws: number; tail_draws: number;
}

/** In which range a column was. */
export interface ModelRange {
  column: string; low: number; high: number;
}

/** Tests of residuals, transform of the response, goodness indices. */
export interface ModelResiduals {
  tests: TestOutcome[]; box_cox: BoxCoxOutcome | null; goodness: GoodnessOutcome | null;
}

/** A campaign to create. */
export interface NewCampaign {
  id: string; kind: string;
}

/** What to measure next. */
export interface NextOutcome {
  interest: string; now: (number | null)[]; candidates: CandidateOutcome[];
}

/** Options of the fit; those left out are unchanged. */
export interface OptionsGiven {
  laws?: string[] | null; free?: string[] | null; quantities?: string[] | null;
  weights?: string | null; noise?: string | null; intervals?: string | null; onset?: string | null;
  initial_velocity?: string | null; displacement_offset?: string | null; end?: string | null;
  group?: string | null;
}

/** A part of a channel as it is shown. */
export interface Outline {
  channel: string; unit: string | null; timed: boolean; start: number; end: number; samples: number;
  shown: number; exact: boolean; time: number[]; low: number[]; high: number[];
}

/** A parameter of a force law. */
export interface ParameterAbout {
  name: string; unit: string; meaning: string; default: number | null; typical: number;
}

/** Contacts with one wall, or of fruit with fruit. */
export interface PartnerOutcome {
  name: string; contacts: number; fruit: number; static_loads: number; static_fruit: number;
  largest_static_force: number; peak_force: number[]; impact_speed: number[];
  absorbed_energy: number[];
}

/** Bruises made by one wall, or by other fruit. */
export interface PlaceOutcome {
  name: string; bruises: number; fruit: number; largest: number;
}

/** The population in numbers alone, as a law card carries it. */
export interface Population {
  parameters: string[]; logarithmic: boolean[]; median: number[]; median_covariance: number[][];
  between: number[][]; within: number[][]; covariates: CovariateEffect[]; fruits: number;
  impacts: number; method: string;
}

/** Correlation of two parameters. */
export interface PopulationCorrelation {
  first: string; second: string; between: RangeOutcome; within: RangeOutcome;
}

/** Effect of a covariate on a parameter. */
export interface PopulationEffect {
  covariate: string; centre: number; parameter: string; effect: number; se: number; df: number;
  low: number; high: number; p: number;
}

/** What `windfall population` returns. */
export interface PopulationOutcome {
  windfall: string; campaign: string; simulated: string | null; law: string; method: string;
  fruits: number; impacts: number; parameters: PopulationParameter[];
  correlations: PopulationCorrelation[]; effects: PopulationEffect[]; two_stage: TwoStageOutcome;
  posterior?: PopulationPosteriorOutcome | null; log_likelihood: number; shift_from_fits: number;
  shift_from_first_order: number; converged: boolean; fruit: FruitOutcome[]; population: Population;
  failed: FailureOutcome[]; findings: FindingOutcome[];
}

/** One parameter of the law over the fruit. */
export interface PopulationParameter {
  name: string; unit: string; scale: string; median: RangeOutcome; between: RangeOutcome;
  within: RangeOutcome;
}

/** The posterior, drawn beside the estimate. */
export interface PopulationPosteriorOutcome {
  medians: RangeOutcome[]; between: RangeOutcome[]; within: RangeOutcome[];
  between_correlations: RangeOutcome[]; within_correlations: RangeOutcome[];
  effects: RangeOutcome[]; chains: number; draws: number; seed: number; largest_r_hat: number;
  fewest_draws: number; divergences: number;
}

/** A response at some settings. */
export interface PredictedResponse {
  response: string; predicted: number; low: number; high: number; desirability: number | null;
}

/** A prediction with intervals. */
export interface PredictionOutcome {
  line: number; predicted: number; se: number; mean_low: number; mean_high: number; low: number;
  high: number;
}

/** A failure. */
export interface Problem {
  title: string; status: number; detail: string; code: string;
}

/** Profile of one parameter. */
export interface ProfileOutcome {
  values: number[]; rises: number[]; open?: string | null;
}

/** How good a model is. */
export interface QualityOutcome {
  r2: number; r2_adjusted: number; r2_predicted: number; press: number; adequate_precision: number;
  sigma: number; log_likelihood: number; aic: number; aicc: number; bic: number;
}

/** A number with its interval, where there is one. */
export interface RangeOutcome {
  value: number; low: number | null; high: number | null;
}

/** A file of recordings. */
export interface RecordingEntry {
  file: string; bytes: number; impacts: string[];
}

/** What to fit; what is left out is taken from the campaign. */
export interface Refit {
  impact?: string; from?: number | null; to?: number | null; laws?: string[]; free?: string[];
  quantities?: string[]; weights?: string | null; noise?: string | null; intervals?: string | null;
  onset?: string | null; initial_velocity?: string | null; displacement_offset?: string | null;
  end?: string | null; series?: boolean;
}

/** A linear model with the equal command. */
export type RegressAnswer = AnyRegressOutcome & {
  command: string;
};

/** A linear model of a table. */
export interface RegressGiven {
  table: string; response: string; terms: string; random?: string[]; select?: boolean;
}

/** A fitted linear model. */
export type RegressOutcome = QualityOutcome & ({
  formula: string; response: string; rows: number; left_out: number; terms: TermOutcome[];
  robust: boolean; covariance: number[][]; ranges: ModelRange[]; model: WholeModel;
  residual: SumOfSquares; total: SumOfSquares; anova_type: string; anova: AnovaOutcome[];
  lack_of_fit: LackOfFitOutcome | null; vif: InflationOutcome[]; removed: StepOutcome[];
  steps: StepOutcome[]; cross_validation: CrossValidationOutcome | null; residuals: ModelResiduals;
  influence: RowOutcome[]; predictions: PredictionOutcome[]; findings: FindingOutcome[];
});

/** What a report consists of; names are those below the campaign. */
export interface ReportFiles {
  page: string; files: string[]; impacts: number; failed: number;
}

/** How one quantity of the cost function fits. */
export interface ResidualOutcome {
  samples: number; weight: number; noise: number; persistence: number; rms: number;
  runs_z: number | null;
}

/** A response with its model. */
export interface ResponseGiven {
  name: string; model: string;
}

/** The map of a response over two factors. */
export interface ResponseMap {
  response: string; map: ContourMap; errors: number[];
}

/** A point of a ridge. */
export interface RidgeOutcome {
  of: string; radius: number; actual: number[]; value: number;
}

/** What a row does to the fit. */
export interface RowOutcome {
  line: number; observed: number; fitted: number; residual: number; leverage: number;
  standardised: number; studentised: number | null; cook: number | null; dffits: number;
}

/** A run in a store. */
export interface RunView {
  time: string; results: number; failures: number;
}

/** Results of a scene in a list. */
export interface SceneEntry {
  id: string; title: string; fruit: number | null; contacts: number | null; end: number | null;
  frames: boolean; problem: string | null;
}

/** What came of a scene; SI throughout. */
export interface SceneOutcome {
  title: string; end: number; engine: string; step: SceneStep; steps: number; fruit: number;
  waiting: number; left: number; contacts: number; written: number; partners: PartnerOutcome[];
  histograms: HistogramOutcome[]; bruise: BruiseOutcome | null; energy: EnergyOutcome;
  energy_closure: number; findings: FindingOutcome[]; files: string[];
}

/** A time step, and what it does to the contact that suffers most. */
export interface SceneStep {
  time_step: number; between: string[]; speed: number; contact_duration: number;
  peak_force_error: number; energy_error: number;
}

/** A scene that can be played. */
export interface SceneView {
  id: string; about: FramesAbout; radii: number[]; vertices: number[][]; faces: number[][];
  times: number[]; counts: number[]; most: number; colours: string[]; outcome: SceneOutcome | null;
}

/** Settings with what they give. */
export interface SettingOutcome {
  actual: number[]; coded: number[]; responses: PredictedResponse[]; desirability: number;
}

/** The motion under a fitted law. */
export interface ShownMotion {
  time: number[]; displacement: number[]; rate: number[]; force: number[];
}

/** Values at times on the clock of the recording. */
export interface ShownSamples {
  time: number[]; value: number[];
}

/** Spread of one quantity over impacts. */
export interface SpreadOutcome {
  mean: number; sd: number | null; n: number; cv: number | null;
}

/** Where the search starts. */
export interface StartOutcome {
  law: string; rule: string; hertz_stiffness: number | null;
}

/** How the results came about. */
export interface StatusOutcome {
  fitted: number; stored: number; failed: number; up_to_date: boolean;
}

/** A step of a selection. */
export interface StepOutcome {
  term: string; action: string; f: number; p: number; criterion: number | null; r2: number;
}

/** What the store holds of a campaign as it is now. */
export interface StoredResults {
  outcome: AnyOutcome | null; pending: number; time: string | null;
}

/** A sum of squares with its degrees of freedom. */
export interface SumOfSquares {
  ss: number; df: number;
}

/** Response surfaces with the equal command. */
export type SurfaceAnswer = SurfaceOutcome & {
  maps: ResponseMap[]; command: string;
};

/** Response surfaces of a table. */
export interface SurfaceGiven {
  table: string; factors: string[]; responses: ResponseGiven[]; goals?: string[]; hold?: string[];
  along?: string | null; members?: number; grid?: string | null; grid_points?: number;
}

/** The surface of one response. */
export type SurfaceModel = QualityOutcome & ({
  response: string; terms: SurfaceTerm[]; actual_terms: ActualTerm[]; model: WholeModel;
  residual: SumOfSquares; total: SumOfSquares; cv_percent: number; anova_type: string;
  lack_of_fit: LackOfFitOutcome | null; canonical: CanonicalOutcome | null; ridge: RidgeOutcome[];
  influence: RowOutcome[];
});

/** What `windfall surface` found. */
export type SurfaceOutcome = SurfaceModel & ({
  factors: FactorOutcome[]; coding: string; responses: SurfaceModel[];
  optimum: SettingOutcome | null; family: FamilyOutcome | null; findings: FindingOutcome[];
  grid: GridOutcome | null;
});

/** A term of a surface. */
export interface SurfaceTerm {
  term: string; name: string; coded: number; se: number; low: number; high: number; actual: number;
  ss: number | null; df: number | null; f: number | null; p: number | null; vif: number | null;
}

/** A table of text. */
export interface TableView {
  columns: string[]; rows: string[][];
}

/** The features that are to be met at one height. */
export interface TargetOutcome {
  of: string; drops: number; mass: number; height: number; features: Record<string, MeasuredValue>;
}

/** An estimate. */
export interface TermOutcome {
  term: string; estimate: number; se: number; t: number; p: number; low: number; high: number;
  df: number;
}

/** A test. */
export interface TestOutcome {
  test: string; statistic: number; p: number;
}

/** The whole of campaign.toml. */
export interface TextGiven {
  text: string;
}

/** The usual way: fit each impact, average per fruit, regress all fits. */
export interface TwoStageOutcome {
  medians: RangeOutcome[]; between: RangeOutcome[]; correlations: number[];
  effects: PopulationEffect[];
}

/** An uploaded file. */
export interface Uploaded {
  file: string; bytes: number; sha256: string; recording: Inspection | null;
}

/** A standard deviation between groups, or the correlation of two effects. */
export interface VarianceOutcome {
  group: string; kind: string; of: string; value: number; low: number | null; high: number | null;
}

/** A response at the optimum: Table 6 of the study. */
export interface VerifiedResponse {
  response: string; unit: string; measured: number | null; predicted: number | null;
  simulated: number | null; difference: number | null;
}

/** A wall without its faces. */
export interface WallAbout {
  name: string; material: string; moves: boolean; endless: boolean; corners: number;
  vertices: number; faces: number;
}

/** What the waveform of one drop tells. */
export interface WaveformDropOutcome {
  id: string; specimen: string; height: number; onset: MeasuredValue; velocity: MeasuredValue;
  mass: MeasuredValue; level: MeasuredValue; misfit: number; samples: number;
}

/** A law calibrated on waveforms. */
export interface WaveformOutcome {
  law: string; parameters: WaveformParameter[]; covariance: number[][]; logarithmic: boolean[];
  correlations: number[][]; weakest: WeakOutcome | null; by_scatter: boolean; misfit: number;
  samples: number; impacts: number; drops: WaveformDropOutcome[]; converged: boolean;
  evaluations: number;
}

/** An estimate. */
export interface WaveformParameter {
  name: string; value: MeasuredValue; sd_of_noise: number; per_millimetre: MeasuredValue | null;
}

/** A combination of parameters that is known little. */
export interface WeakOutcome {
  sd: number; shares: Record<string, number>;
}

/** The whole model against none. */
export interface WholeModel {
  ss: number; df: number; f: number; p: number;
}

/** The part of the recording that an impact uses. */
export interface WindowGiven {
  impact: string; from?: number | null; to?: number | null;
}

/** Kinds of jobs. */
export type Work = "fit" | "laws" | "population" | "calibrate" | "report";

/** A value in the unit of a campaign's ranges: N/mm^e. */
export interface WrittenValue {
  value: number; sd: number | null; low: number | null; high: number | null; unit: string;
}

/** A request with what it answers, what it sends, and its parameters behind "?". */
export interface Call<Answer, Body = undefined, Query = undefined> {
  answer: Answer;
  body: Body;
  query: Query;
}

/** All requests by method and address. */
export interface Calls {
  /** Version, directory, limits and force laws. */
  "GET /api/about": Call<About>;
  /** All campaigns of the directory. */
  "GET /api/campaigns": Call<CampaignEntry[]>;
  /** Makes a campaign from a template, as `windfall new` does. */
  "POST /api/campaigns": Call<CampaignView, NewCampaign>;
  /** A campaign as its files describe it; its version is the ETag. */
  "GET /api/campaigns/{id}": Call<CampaignView>;
  /** The law card of a campaign, as a download. */
  "GET /api/campaigns/{id}/card": Call<string, undefined, { law?: string }>;
  /** Sets the columns of the channels. */
  "PUT /api/campaigns/{id}/channels": Call<CampaignView, ChannelsGiven>;
  /** Changes of a campaign's files or store on disk: the data of each event is a `CampaignChanged`. */
  "GET /api/campaigns/{id}/events": Call<string>;
  /** Adds impacts, and specimens that are new. */
  "POST /api/campaigns/{id}/impacts": Call<CampaignView, ImpactsGiven>;
  /** Starts a job on a campaign. */
  "POST /api/campaigns/{id}/jobs": Call<JobView, JobGiven>;
  /** Sets options of the fit. */
  "PUT /api/campaigns/{id}/options": Call<CampaignView, OptionsGiven>;
  /** A part of a channel at the resolution of a screen. */
  "GET /api/campaigns/{id}/outline": Call<Outline, undefined, { file: string; channel: string; from?: number; to?: number; points?: number }>;
  /** Uploads a recording into the campaign; existing files are never replaced. */
  "PUT /api/campaigns/{id}/raw": Call<Uploaded, Blob, { file: string }>;
  /** Contents of a recording, as `windfall inspect` shows them. */
  "GET /api/campaigns/{id}/recording": Call<Inspection, undefined, { file: string }>;
  /** The recordings of a campaign. */
  "GET /api/campaigns/{id}/recordings": Call<RecordingEntry[]>;
  /** Fits one impact now; nothing is kept. */
  "POST /api/campaigns/{id}/refit": Call<LiveOutcome, Refit>;
  /** A linear model, as `windfall regress` gives it. */
  "POST /api/campaigns/{id}/regress": Call<RegressAnswer, RegressGiven>;
  /** A file of the report of a campaign. */
  "GET /api/campaigns/{id}/report/{file}": Call<string>;
  /** Stored results for the current files and options; nothing is fitted. */
  "GET /api/campaigns/{id}/results": Call<StoredResults>;
  /** Response surfaces, as `windfall surface` gives them. */
  "POST /api/campaigns/{id}/surface": Call<SurfaceAnswer, SurfaceGiven>;
  /** A table of the campaign, cell by cell. */
  "GET /api/campaigns/{id}/table": Call<DataTable, undefined, { file: string }>;
  /** Uploads a table for regressions and surfaces; existing files are never replaced. */
  "PUT /api/campaigns/{id}/table": Call<Uploaded, Blob, { file: string }>;
  /** Replaces campaign.toml. */
  "PUT /api/campaigns/{id}/text": Call<CampaignView, TextGiven>;
  /** Sets from_s and to_s of an impact. */
  "PUT /api/campaigns/{id}/window": Call<CampaignView, WindowGiven>;
  /** Contours of values over a grid. */
  "POST /api/contours": Call<ContourMap, GridGiven>;
  /** All jobs since the server was started. */
  "GET /api/jobs": Call<JobView[]>;
  /** A job, with its result once it is done. */
  "GET /api/jobs/{job}": Call<JobView>;
  /** Cancels a job; nothing unfinished is kept. */
  "DELETE /api/jobs/{job}": Call<JobView>;
  /** Progress of a job until it ends: the data of each event is a `JobView`. */
  "GET /api/jobs/{job}/events": Call<string>;
  /** The results of scenes in the directory. */
  "GET /api/scenes": Call<SceneEntry[]>;
  /** A scene with its walls and the times of its frames. */
  "GET /api/scenes/{id}": Call<SceneView>;
  /** Whole frames from a number on, as in frames.bin: about 4 MB of them, at least one; none after the last. */
  "GET /api/scenes/{id}/frames": Call<ArrayBuffer, undefined, { from?: number }>;
  /** The fruit that were hit hardest, hardest first. */
  "GET /api/scenes/{id}/hardest": Call<HardestFruit[], undefined, { most?: number }>;
  /** The contacts of a fruit. */
  "GET /api/scenes/{id}/history": Call<FruitHistory, undefined, { fruit: number }>;
}
