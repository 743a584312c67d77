// Made by `npm run types` from the description of the interface; not to be edited.

export interface About {
  version: string; directory: string; creates: boolean; upload_limit: number; kinds: string[]; laws: LawAbout[];
}
export interface ActualTerm { name: string; coefficient: number; }
export interface AlongOutcome { quantity: string; known: MeasuredValue; value: number; }
export interface AnovaOutcome {
  term: string; ss: number | null; df: number; f: number | null; p: number | null;
}
export type AnyOutcome = CampaignOutcome | MeasuredOutcome;
export type AnyRegressOutcome = RegressOutcome | MixedOutcome;
export interface BenchOutcome {
  value: number; sd: number; unit: string; told: number | null; impacts: number;
}
export interface BlockEffect { block: string; effect: number; }
export type BlockOutcome = SumOfSquares & { effects: BlockEffect[]; };
export interface Bounds { low: [number, number, number]; high: [number, number, number]; }
export interface BoxCoxOutcome { lambda: number; low: number | null; high: number | null; }
export interface BruiseOutcome {
  fruit: number; limits: LimitOutcome[]; mean_largest: number; places: PlaceOutcome[];
}
export interface CalibrateOutcome {
  windfall: string; campaign: string; simulated: string | null; law: string; free: string[];
  plate: Record<string, MeasuredValue>; drops: DropOutcome[]; target: TargetOutcome; start: StartOutcome;
  waveform: WaveformOutcome | null; features: FeaturesOutcome | null; family: FamilyLine | null;
  closing: ClosingOutcome[]; design: DesignWayOutcome | null; next: NextOutcome | null; failed: FailureOutcome[];
  findings: FindingOutcome[];
}
export interface CalibratedParameter {
  name: string; value: number; sd: number | null; unit: string; written: WrittenValue; at_limit: boolean;
}
export interface CampaignChanged { version: string; }
export interface CampaignEntry {
  id: string; title: string; kind: string | null; recordings: number; run: RunView | null; problem: string | null;
}
export interface CampaignOutcome {
  windfall: string; campaign: string; simulated: string | null; note: string | null; effective_mass: MassOutcome;
  bench: Record<string, PooledOutcome>; estimated: Record<string, BenchOutcome>; trends: TrendOutcome[];
  status: StatusOutcome; impacts: ImpactOutcome[]; failed: FailureOutcome[]; summary: Record<string, SpreadOutcome>;
  groups: GroupOutcome[]; joint: JointOutcome[]; findings: FindingOutcome[];
}
export interface CampaignView {
  id: string; version: string; title: string; kind: string; simulated: string | null; rig: [string, string][];
  rig_asked: string | null; channels: ChannelView[]; time: string | null; rate: string | null; laws: string[];
  options: FitOptionsView | null; group: string | null; specimens: TableView; impacts: TableView; text: string;
  tables: string[]; results_table_outdated: boolean; report: boolean; command: string; note: string | null;
  undo: StepView | null; redo: StepView | null;
}
export interface CandidateOutcome {
  height: number; mass: number; fruit: string; impacts: number; drops: number; sds: (number | null)[];
  gain: number | null; rank: number; gain_of_interest: number | null;
}
export interface CanonicalOutcome {
  shape: string; coded: number[]; actual: number[]; distance: number; inside: boolean; value: number;
  eigenvalues: number[]; directions: number[][];
}
export interface ChannelGiven { quantity: string; column: string; unit: string; }
export interface ChannelView { quantity: string; column: string; unit: string; }
export interface ChannelsGiven { channels: ChannelGiven[]; time?: string | null; rate?: string | null; }
export interface ClosingOutcome { with: string; rank: number; sds: (number | null)[]; }
export interface ColumnInspection {
  column: string; unit: string | null; role: string | null; channel: string | null; stored_as: string; samples: number;
  smallest: number | null; largest: number | null; rate: number | null; length: number | null; start: number | null;
}
export interface ContactView {
  time: number; duration: number; lasting: boolean; partner: string; partner_fruit: number | null;
  spot: [number, number, number]; normal_speed: number; tangential_speed: number; peak_force: number;
  absorbed_energy: number;
}
export interface ContourLevel {
  value: number; colour: string; area: [number, number][][]; lines: [number, number][][];
}
export interface ContourMap {
  x: number[]; y: number[]; values: number[]; ground: string; levels: ContourLevel[]; colours: string[];
}
export interface CovariateEffect { name: string; centre: number; effects: number[]; sds: number[]; }
export interface CrossValidationOutcome { folds: number; rms: number; r2: number; }
export interface DataColumn { name: string; numbers: boolean; }
export interface DataTable { file: string; columns: DataColumn[]; rows: string[][]; }
export interface DepthOutcome {
  law: string; rows: [number, number[]][]; mean: number[]; sd: number[]; cv: number[];
}
export interface DesignFactorOutcome {
  letter: string; name: string; unit: string; low: number; high: number; centre: number; half: number;
}
export interface DesignHeight { height: number; drops: number; responses: VerifiedResponse[]; }
export interface DesignMember { levels: number[]; desirability: number; heights: HeightFeatures[]; }
export interface DesignOptimum {
  levels: number[]; law: string; desirability: number; responses: VerifiedResponse[];
}
export interface DesignRunOutcome { coded: number[]; levels: number[]; responses: number[]; }
export interface DesignSurfaceOutcome {
  response: string; unit: string; model: string; terms: DesignTerm[]; whole: AnovaOutcome; anova: AnovaOutcome[];
  residual_ss: number; residual_df: number; total_ss: number; r2: number; r2_adjusted: number; r2_predicted: number;
  sigma: number;
}
export interface DesignTerm { term: string; coded: number; actual: number; }
export interface DesignWayOutcome {
  kind: string; alpha: number; factors: DesignFactorOutcome[]; runs: DesignRunOutcome[];
  surfaces: DesignSurfaceOutcome[]; optimum: DesignOptimum; family: DesignMember[]; heights: DesignHeight[];
  depth: DepthOutcome | null;
}
export type Detail = "whole" | "brief";
export interface DifferenceOutcome {
  within: string[]; contrast: string; difference: number; se: number | null; df: number | null; t: number | null;
  p: number | null; low: number | null; high: number | null; ratio: OnScale | null;
}
export interface DirectionOutcome { parts: Record<string, number>; sd: number | null; words: string; }
export interface DropOutcome {
  id: string; specimen: string; mass: MeasuredValue; height: MeasuredValue; features: Record<string, MeasuredValue>;
}
export interface EffectOutcome { by: string; group: string; of: string; value: number; sd: number; }
export interface EnergyOutcome {
  kinetic: number; rotational: number; potential: number; in_contacts: number; in_friction: number;
  lost_in_contacts: number; lost_by_friction: number; lost_by_drag: number; done_by_walls: number;
}
export interface EqualityOutcome {
  within: string[]; f: number | null; df: number; df_denominator: number | null; p: number | null;
}
export interface EstimateOutcome {
  value: number; sd: number | null; low: number | null; high: number | null; unit: string; held: boolean;
}
export interface ExclusionGiven { impact: string; excluded: boolean; note?: string; }
export interface Explanation {
  code: string; section: string; severity: Severity; meaning: string; advice: string;
}
export interface FactorOutcome {
  letter: string; name: string; centre: number; half_range: number; lowest: number; highest: number;
}
export interface FailureOutcome {
  id: string; specimen: string; file: string; law: string | null; message: string; findings?: FindingOutcome[];
}
export interface FamilyLine { dimension: number; words: string; members: FamilyMember[]; }
export interface FamilyMember { parameters: number[]; law: string; heights: HeightFeatures[]; }
export interface FamilyOutcome {
  dimension: number; along: string; from: number; to: number; members: SettingOutcome[];
}
export interface FeaturesOutcome {
  law: string; parameters: CalibratedParameter[]; correlations: number[][]; rank: number;
  directions: DirectionOutcome[]; chi_square: number; freedom: number; p: number | null; widened: number;
  fitted: FittedFeature[]; along: AlongOutcome[]; converged: boolean; evaluations: number;
}
export type FigureFormat = "svg" | "pdf" | "png";
export interface FigureGiven {
  fit?: Refit | null; figure?: string | null; item?: string | null; width?: string | null; format: FigureFormat;
}
export interface FileBeside { file: string; now: string; before: string; }
export interface FindingKind {
  code: string; severity: Severity; message: string; laws: string[]; channel: string | null; impacts: string[];
  of: number | null;
}
export interface FindingOutcome { code: string; severity: Severity; message: string; channel: string | null; }
export interface FitOptionsView {
  quantities: string[]; weights: string; noise: string; intervals: string; onset: string; initial_velocity: string;
  displacement_offset: string; end: string; free: string[];
}
export interface FittedFeature {
  drop: string; feature: string; measured: MeasuredValue; fitted: number; standardised: number;
}
export interface FlowOutcome {
  forward: number; backward: number; mass_forward: number; first: number | null; last: number | null;
  mean_flow: number | null; mean_mass_flow: number | null; largest_flow: number; largest_mass_flow: number;
}
export interface FramesAbout {
  title: string; end: number; interval: number; fruit: number; walls: WallAbout[]; bounds: Bounds;
  periods: [number, number, number];
}
export interface FruitHistory { fruit: number; contacts: number; told: ContactView[]; }
export interface FruitOutcome { specimen: string; impacts: number; parameters: number[]; }
export interface FruitTotals { absorbed_energy: number[]; largest_bruise: number[] | null; }
export interface GoodnessOutcome {
  chi_squared: number | null; reduced_chi_squared: number | null; caveat: string; root_mean_square: number;
  mean_absolute: number; mean_absolute_relative: number | null;
}
export interface GridGiven { x: number[]; y: number[]; values: number[]; }
export interface GridOutcome { columns: string[]; rows: number[][]; }
export interface GroupLoss { group: string; left_out: number; rows: number; }
export interface GroupOutcome {
  group: string | null; law: string; impacts: number; left_out: number; specimens: number;
  parameters: Record<string, SpreadOutcome>; derived: Record<string, SpreadOutcome>;
}
export interface HardestFruit {
  fruit: number; contacts: number; peak_force: number; partner: string; time: number | null;
  impact_speed: number | null; absorbed_energy: number;
}
export interface HeightFeatures { height: number; features: Record<string, number>; }
export interface HistogramOutcome { quantity: string; unit: string; edges: number[]; fruit: number[]; }
export interface ImpactEvidenceOutcome { id: string; aicc: number; }
export interface ImpactGiven { id: string; specimen: string; file: string; cells?: Record<string, string>; }
export interface ImpactOutcome {
  id: string; specimen: string; group: string | null; file: string; law: string; quantities: string[];
  parameters: Record<string, EstimateOutcome>; nuisances: Record<string, EstimateOutcome>;
  correlations: Record<string, number>; cost: number; samples: number; evaluations: number; converged: boolean;
  residual_norm: number; residuals: Record<string, ResidualOutcome>; regression: Record<string, EstimateOutcome>;
  derived: Record<string, null | number>; derived_sd: Record<string, number>; derived_from: Record<string, string>;
  fitted: Record<string, null | number>; directions: Record<string, number>[];
  common: Record<string, Record<string, number>>; intervals: IntervalOutcome; findings: FindingOutcome[];
  left_out: FindingOutcome[];
}
export interface ImpactsGiven { impacts: ImpactGiven[]; }
export interface InflationOutcome { term: string; df: number; factor: number; }
export interface Inspection {
  file: string; format: string; rows: number; columns: ColumnInspection[]; properties: Record<string, string>;
  assumed: string[]; findings: FindingOutcome[];
}
export interface IntervalOutcome {
  method: string; replicates?: number; failed?: number; chains?: number; draws?: number; divergences?: number;
  mixing?: Record<string, MixingOutcome>; drawn?: Record<string, number[]>; profiles?: Record<string, ProfileOutcome>;
}
export interface JobGiven {
  work: Work; laws?: string[]; covariates?: string[]; intervals?: string | null;
}
export type JobState = "running" | "done" | "failed" | "cancelled";
export type JobView = JobWork & ({
  job: string; campaign: string; state: JobState; done: number; all: number; problem: string | null; command: string;
});
export type JobWork = { result: AnyOutcome | null; work: "fit"; } | { result: LawsOutcome | null; work: "laws"; } | { result: PopulationOutcome | null; work: "population"; } | { result: CalibrateOutcome | null; work: "calibrate"; } | { result: ReportFiles | null; work: "report"; };
export interface JointOutcome {
  specimen: string; law: string; impacts: string[]; parameters: Record<string, EstimateOutcome>;
  correlations: Record<string, number>; common: Record<string, Record<string, number>>; chi_square: number;
  freedom: number; p: number; scale: number;
}
export interface KeptWork { time: string; stale: boolean; job: JobView; }
export interface LackOfFitOutcome { lack: AnovaOutcome; pure_error: SumOfSquares; }
export interface LawAbout { name: string; formula: string; parameters: ParameterAbout[]; notes: string; }
export interface LawEvidenceOutcome {
  law: string; failed: number; parameters_per_impact: number; cost: number; aicc: number; aicc_low?: number;
  aicc_high?: number; impacts: ImpactEvidenceOutcome[]; bic: number; first_share: number; prediction: number | null;
  prediction_sd: number | null; residual_ratio: number; runs_z: number;
}
export interface LawsOutcome {
  windfall: string; campaign: string; simulated: string | null; impacts: number; levels: number; verdict: string;
  meaning: string; laws: LawEvidenceOutcome[]; specimens_first: number[]; failed: FailureOutcome[];
  findings: FindingOutcome[];
}
export interface LevelVarianceOutcome {
  level: string; rows: number; sd: number; low: number | null; high: number | null; df: number | null;
}
export interface LimitOutcome { limit: number; share: number; interval: number[]; }
export interface LiveLaw {
  law: string; outcome: ImpactOutcome | null; problem: string | null; aicc: number | null; motion: ShownMotion | null;
  residuals: Record<string, ShownSamples>;
}
export interface LiveOutcome {
  impact: string; from: number | null; to: number | null; start: number; stop: number; onset: number; end: number;
  measured: Record<string, ShownSamples>; laws: LiveLaw[]; findings: FindingOutcome[]; command: string; seconds: number;
}
export interface MassOutcome { value: number; sd: number; impacts: number; }
export interface MeanOutcome {
  levels: string[]; mean: number; se: number | null; df: number | null; low: number | null; high: number | null;
  original: OnScale | null;
}
export interface MeansOutcome {
  slope_on: string | null; of: string[]; within: string[]; at: [string, number][]; means: MeanOutcome[];
  original: string | null; meaning: string | null; compared: string; adjusted: string; differences: DifferenceOutcome[];
  tests: EqualityOutcome[];
}
export interface MeasuredGroup {
  group: string | null; law: string; recordings: number; values: Record<string, SpreadOutcome>;
}
export interface MeasuredItem {
  id: string; specimen: string; group: string | null; file: string; law: string; words: Record<string, string>;
  parameters: Record<string, MeasuredValue>; derived: Record<string, MeasuredValue>; findings: FindingOutcome[];
}
export interface MeasuredOutcome {
  windfall: string; campaign: string; kind: string; simulated: string | null; note: string | null;
  status: StatusOutcome; impacts: MeasuredItem[]; parts?: MeasuredItem[]; failed: FailureOutcome[];
  specimens: MeasuredItem[]; whole: MeasuredItem[]; summary: Record<string, SpreadOutcome>; groups: MeasuredGroup[];
  findings: FindingOutcome[];
}
export interface MeasuredValue {
  value: number; sd: number | null; low: number | null; high: number | null; unit: string;
}
export interface MeasuredView {
  tables: ShownTable[]; figures: ShownFigure[]; findings: FindingOutcome[]; failed: FailureOutcome[];
}
export interface MixedLevelsOutcome { by: string; rows: [string, number][]; test: VariancesTest; }
export type MixedOutcome = RowCount & ({
  formula: string; response: string; method: string; df_method: string; groups: [string, number][];
  weights: string | null; level_variances: MixedLevelsOutcome | null; terms: TermOutcome[]; covariance: number[][];
  ranges: ModelRange[]; anova: MixedTest[]; variances: VarianceOutcome[]; r2: number; r2_adjusted: number | null;
  r2_conditional: number; intraclass: number[]; log_likelihood: number; criterion: number; aic: number; aicc: number;
  bic: number; removed: string[]; effects: EffectOutcome[]; predictions: MixedPredictionOutcome[];
  means: MeansOutcome[]; findings: FindingOutcome[];
});
export interface MixedPrediction {
  population: number; predicted: number; se: number | null; mean_low: number | null; mean_high: number | null;
  low: number | null; high: number | null;
}
export type MixedPredictionOutcome = MixedPrediction & ({ line: number; original: OriginalPrediction | null; });
export type MixedTest = AnovaOutcome & ({ df_denominator: number | null; });
export interface MixingOutcome { r_hat: number | null; bulk_draws: number; tail_draws: number; }
export interface ModelRange { column: string; low: number; high: number; }
export interface ModelResiduals {
  tests: TestOutcome[]; box_cox: BoxCoxOutcome | null; goodness: GoodnessOutcome | null;
}
export interface MomentumView { mass: MassOutcome | null; of_rig: number | null; }
export interface NewCampaign { id: string; kind: string; }
export interface NextOutcome { interest: string; now: (number | null)[]; candidates: CandidateOutcome[]; }
export interface NoteGiven { impact?: string | null; note: string; }
export interface OnScale { value: number | null; low: number | null; high: number | null; }
export interface OptionsGiven {
  laws?: string[] | null; free?: string[] | null; quantities?: string[] | null; weights?: string | null;
  noise?: string | null; intervals?: string | null; onset?: string | null; initial_velocity?: string | null;
  displacement_offset?: string | null; end?: string | null; group?: string | null;
}
export interface OriginalPrediction {
  predicted: number | null; mean_low: number | null; mean_high: number | null; low: number | null; high: number | null;
}
export interface Outline {
  channel: string; unit: string | null; timed: boolean; start: number; end: number; samples: number; shown: number;
  exact: boolean; time: number[]; low: number[]; high: number[];
}
export interface ParameterAbout {
  name: string; unit: string; meaning: string; default: number | null; typical: number;
}
export interface PartnerOutcome {
  name: string; contacts: number; fruit: number; static_loads: number; static_fruit: number;
  largest_static_force: number; peak_force: number[]; impact_speed: number[]; absorbed_energy: number[];
}
export interface PlaceOutcome { name: string; bruises: number; fruit: number; largest: number; }
export interface PooledOutcome { value: number; sd: number; impacts: number; chi_square: number; }
export interface Population {
  parameters: string[]; logarithmic: boolean[]; median: number[]; median_covariance: number[][]; between: number[][];
  within: number[][]; covariates: CovariateEffect[]; fruits: number; impacts: number; method: string;
}
export interface PopulationCorrelation { first: string; second: string; between: RangeOutcome; within: RangeOutcome; }
export interface PopulationEffect {
  covariate: string; centre: number; parameter: string; effect: number; se: number; df: number; low: number;
  high: number; p: number;
}
export interface PopulationOutcome {
  windfall: string; campaign: string; simulated: string | null; law: string; method: string; fruits: number;
  impacts: number; parameters: PopulationParameter[]; correlations: PopulationCorrelation[];
  effects: PopulationEffect[]; two_stage: TwoStageOutcome; posterior?: PopulationPosteriorOutcome;
  log_likelihood: number; shift_from_fits: number; shift_from_first_order: number; converged: boolean;
  fruit: FruitOutcome[]; population: Population; failed: FailureOutcome[]; findings: FindingOutcome[];
}
export interface PopulationParameter {
  name: string; unit: string; scale: string; median: RangeOutcome; between: RangeOutcome; within: RangeOutcome;
}
export interface PopulationPosteriorOutcome {
  medians: RangeOutcome[]; between: RangeOutcome[]; within: RangeOutcome[]; between_correlations: RangeOutcome[];
  within_correlations: RangeOutcome[]; effects: RangeOutcome[]; chains: number; draws: number; seed: number;
  largest_r_hat: number; fewest_draws: number; divergences: number;
}
export interface PredictedResponse {
  response: string; predicted: number; low: number | null; high: number | null; desirability: number | null;
}
export interface Prediction {
  predicted: number; se: number | null; mean_low: number | null; mean_high: number | null; low: number | null;
  high: number | null;
}
export type PredictionOutcome = Prediction & ({ line: number; original: OriginalPrediction | null; });
export interface ProbeImpactOutcome {
  fruit: number; time: number; duration: number; peak_acceleration: number; velocity_change: number;
  struck: string | null; struck_fruit: number | null; lasting: boolean;
}
export interface ProbeOutcome {
  fruit: number; least_acceleration: number; largest_acceleration: number | null; impacts: number;
  peak_acceleration: number[] | null; velocity_change: number[] | null; hardest: ProbeImpactOutcome | null;
}
export interface Problem { title: string; status: number; detail: string; code: string; }
export interface ProfileOutcome { values: number[]; rises: number[]; open?: string; }
export interface QualityOutcome {
  r2: number | null; r2_adjusted: number | null; r2_predicted: number | null; press: number | null;
  adequate_precision: number | null; sigma: number | null; log_likelihood: number | null; aic: number | null;
  aicc: number | null; bic: number | null;
}
export interface RandomOutcome {
  groups: [string, number][]; method: string; df_method: string; model_df_denominator: number | null;
  variances: VarianceOutcome[]; r2_conditional: number; intraclass: number[];
}
export interface RangeOutcome { value: number; low: number | null; high: number | null; }
export interface RecordingEntry { file: string; bytes: number; impacts: string[]; }
export interface Refit {
  impact?: string; from?: number | null; to?: number | null; laws?: string[]; free?: string[]; quantities?: string[];
  weights?: string | null; noise?: string | null; intervals?: string | null; onset?: string | null;
  initial_velocity?: string | null; displacement_offset?: string | null; end?: string | null; series?: boolean;
}
export type RegressAnswer = AnyRegressOutcome & { units: TermUnits; command: string; };
export interface RegressGiven {
  table: string; response: string; terms: string; random?: string[]; select?: boolean;
}
export type RegressOutcome = RowCount & QualityOutcome & ({
  formula: string; response: string; weights: string | null; level_variances: VariancesOutcome | null;
  terms: TermOutcome[]; robust: boolean; covariance: ((number | null)[])[]; ranges: ModelRange[]; model: WholeModel;
  residual: SumOfSquares; total: SumOfSquares; anova_type: string; anova: AnovaOutcome[];
  lack_of_fit: LackOfFitOutcome | null; vif: InflationOutcome[]; removed: StepOutcome[]; steps: StepOutcome[];
  cross_validation: CrossValidationOutcome | null; fold_by: string | null; residuals: ModelResiduals;
  influence: RowOutcome[]; predictions: PredictionOutcome[]; means: MeansOutcome[]; findings: FindingOutcome[];
});
export interface ReportFiles { page: string; files: string[]; impacts: number; failed: number; }
export interface ResidenceOutcome { fruit: number; mean: number; median: number; largest: number; }
export interface ResidualOutcome {
  samples: number; weight: number; noise: number; persistence: number; rms: number; runs_z: number | null;
  by_phase: number[];
}
export interface ResponseGiven { name: string; model: string; }
export interface ResponseMap { response: string; map: ContourMap; errors: number[]; }
export interface RidgeOutcome { of: string; radius: number; actual: number[]; value: number; }
export interface RigForm { kind: string; asked: boolean; keys: RigKey[]; }
export interface RigGiven { keys: Record<string, string>; }
export interface RigKey {
  key: string; meaning: string; units: string[]; words: string[]; typical: string; needed: boolean;
}
export interface RowCount { rows: number; left_out: number; left_out_by: GroupLoss[]; }
export interface RowInfluence {
  observed: number; fitted: number; residual: number; leverage: number; standardised: number | null;
  studentised: number | null; cook: number | null; dffits: number | null;
}
export type RowOutcome = RowInfluence & { line: number; };
export interface RunView { time: string; results: number; failures: number; }
export interface SceneEntry {
  id: string; title: string; fruit: number | null; contacts: number | null; end: number | null; frames: boolean;
  problem: string | null;
}
export interface SceneOutcome {
  title: string; start: number | null; end: number; engine: string; step: SceneStep; steps: number; fruit: number;
  waiting: number; left: number; contacts: number; written: number; partners: PartnerOutcome[];
  histograms: HistogramOutcome[]; sensors: SensorOutcome[]; bruise: BruiseOutcome | null; energy: EnergyOutcome;
  energy_closure: number; findings: FindingOutcome[]; files: string[];
}
export interface SceneStep {
  time_step: number; between: string[]; speed: number; contact_duration: number; peak_force_error: number;
  energy_error: number;
}
export interface SceneView {
  id: string; about: FramesAbout; radii: number[]; vertices: number[][]; faces: number[][]; times: number[];
  counts: number[]; most: number; fastest: number; colours: string[]; outcome: SceneOutcome | null;
}
export interface SensorOutcome {
  name: string; look: number; interval: number; flow: FlowOutcome | null; space: SpaceOutcome | null;
  probe: ProbeOutcome | null;
}
export interface SettingOutcome {
  actual: number[]; coded: number[]; responses: PredictedResponse[]; desirability: number | null;
}
export type Severity = "wrong" | "doubtful" | "note";
export interface ShownFigure { name: string; title: string; caption: string; svg: string; }
export interface ShownMotion { time: number[]; displacement: number[]; rate: number[]; force: number[]; }
export interface ShownSamples { time: number[]; value: number[]; }
export interface ShownTable { caption: string; columns: string[]; rows: string[][]; }
export interface SpaceOutcome {
  entered: number; inside: number; mass: number; fruit_share: number; level: number | null; most: number;
  largest_mass: number; largest_level: number | null; residence: ResidenceOutcome | null;
}
export interface SpreadOutcome {
  mean: number; sd: number | null; n: number; cv: number | null; median: number; robust_sd: number | null;
  common_sd: number | null;
}
export interface StartOutcome { law: string; rule: string; hertz_stiffness: number | null; }
export interface StatusOutcome { fitted: number; stored: number; failed: number; up_to_date: boolean; }
export interface StepOutcome {
  term: string; action: string; f: number | null; p: number | null; criterion: number | null; r2: number;
}
export interface StepView { words: string; time: string; }
export interface StoredResults {
  outcome: AnyOutcome | null; findings: FindingKind[]; pending: number; time: string | null;
}
export interface SumOfSquares { ss: number | null; df: number | null; }
export type SurfaceAnswer = SurfaceOutcome & {
  maps: ResponseMap[]; factor_units: string[]; units: TermUnits[]; command: string;
};
export interface SurfaceGiven {
  table: string; factors: string[]; responses: ResponseGiven[]; goals?: string[]; hold?: string[];
  along?: string | null; members?: number; grid?: string | null; grid_points?: number;
}
export type SurfaceModel = QualityOutcome & ({
  response: string; terms: SurfaceTerm[]; actual_terms: ActualTerm[]; blocks: BlockOutcome | null;
  random: RandomOutcome | null; model: WholeModel; residual: SumOfSquares; total: SumOfSquares;
  cv_percent: number | null; anova_type: string; lack_of_fit: LackOfFitOutcome | null;
  canonical: CanonicalOutcome | null; ridge: RidgeOutcome[]; influence: RowOutcome[];
});
export type SurfaceOutcome = SurfaceModel & ({
  factors: FactorOutcome[]; coding: string; responses: SurfaceModel[]; optimum: SettingOutcome | null;
  family: FamilyOutcome | null; findings: FindingOutcome[]; grid: GridOutcome | null;
});
export interface SurfaceTerm {
  term: string; name: string; coded: number | null; se: number | null; low: number | null; high: number | null;
  actual: number | null; ss: number | null; df: number | null; df_denominator: number | null; f: number | null;
  p: number | null; vif: number | null;
}
export interface TableView { columns: string[]; rows: string[][]; }
export interface TargetOutcome {
  of: string; drops: number; mass: number; height: number; features: Record<string, MeasuredValue>;
}
export interface TermOutcome {
  term: string; estimate: number; se: number | null; t: number | null; p: number | null; low: number | null;
  high: number | null; df: number | null;
}
export interface TermUnits { response: string; terms: string[]; }
export interface TestOutcome { test: string; statistic: number; p: number; }
export interface TextGiven { text: string; }
export interface TrendOutcome {
  law: string; quantity: string; over: string; slope: number; sd: number; range: number; p: number; impacts: number;
  specimens: number; within_specimens: boolean; order_correlation: number;
}
export interface TwoStageOutcome {
  medians: RangeOutcome[]; between: RangeOutcome[]; correlations: number[]; effects: PopulationEffect[];
}
export interface UndoGiven { way: Way; }
export interface Uploaded { file: string; bytes: number; sha256: string; recording: Inspection | null; }
export interface VarianceOutcome {
  group: string; kind: string; of: string; value: number; low: number | null; high: number | null;
}
export interface VariancesOutcome {
  by: string; method: string; levels: LevelVarianceOutcome[]; test: VariancesTest; anova_df: (number | null)[];
  model_df: number | null;
}
export interface VariancesTest { statistic: number; df: number; p: number; }
export interface VerifiedResponse {
  response: string; unit: string; measured: number | null; predicted: number | null; simulated: number | null;
  difference: number | null;
}
export interface WallAbout {
  name: string; material: string; moves: boolean; endless: boolean; corners: number; vertices: number; faces: number;
}
export interface WaveformDropOutcome {
  id: string; specimen: string; height: number; onset: MeasuredValue; velocity: MeasuredValue; mass: MeasuredValue;
  level: MeasuredValue; misfit: number; samples: number;
}
export interface WaveformOutcome {
  law: string; parameters: WaveformParameter[]; covariance: number[][]; logarithmic: boolean[];
  correlations: number[][]; weakest: WeakOutcome | null; by_scatter: boolean; misfit: number; samples: number;
  impacts: number; drops: WaveformDropOutcome[]; converged: boolean; evaluations: number;
}
export interface WaveformParameter {
  name: string; value: MeasuredValue; sd_of_noise: number; per_millimetre: MeasuredValue | null;
}
export type Way = "undo" | "redo";
export interface WeakOutcome { sd: number; shares: Record<string, number>; }
export interface WholeModel { ss: number | null; df: number; f: number | null; p: number | null; }
export interface WindowGiven { impact: string; from?: number | null; to?: number | null; }
export type Work = "fit" | "laws" | "population" | "calibrate" | "report";
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
  "GET /api/about": Call<About>;
  "GET /api/campaigns": Call<CampaignEntry[]>;
  "POST /api/campaigns": Call<CampaignView, NewCampaign>;
  "GET /api/campaigns/{id}": Call<CampaignView>;
  "GET /api/campaigns/{id}/card": Call<string, undefined, { law?: string }>;
  "PUT /api/campaigns/{id}/channels": Call<CampaignView, ChannelsGiven>;
  "GET /api/campaigns/{id}/events": Call<string>;
  "PUT /api/campaigns/{id}/exclusion": Call<CampaignView, ExclusionGiven>;
  "POST /api/campaigns/{id}/figure": Call<ArrayBuffer, FigureGiven>;
  "POST /api/campaigns/{id}/impacts": Call<CampaignView, ImpactsGiven>;
  "POST /api/campaigns/{id}/jobs": Call<JobView, JobGiven>;
  "GET /api/campaigns/{id}/kept": Call<KeptWork[]>;
  "GET /api/campaigns/{id}/measured": Call<MeasuredView, undefined, { item?: string }>;
  "GET /api/campaigns/{id}/momentum": Call<MomentumView>;
  "PUT /api/campaigns/{id}/note": Call<CampaignView, NoteGiven>;
  "PUT /api/campaigns/{id}/options": Call<CampaignView, OptionsGiven>;
  "GET /api/campaigns/{id}/outline": Call<Outline, undefined, { file: string; channel: string; from?: number; to?: number; points?: number }>;
  "PUT /api/campaigns/{id}/raw": Call<Uploaded, Blob, { file: string }>;
  "GET /api/campaigns/{id}/recording": Call<Inspection, undefined, { file: string }>;
  "GET /api/campaigns/{id}/recordings": Call<RecordingEntry[]>;
  "POST /api/campaigns/{id}/refit": Call<LiveOutcome, Refit>;
  "POST /api/campaigns/{id}/regress": Call<RegressAnswer, RegressGiven>;
  "GET /api/campaigns/{id}/report/{file}": Call<string>;
  "GET /api/campaigns/{id}/results": Call<StoredResults, undefined, { impacts?: Detail }>;
  "PUT /api/campaigns/{id}/rig": Call<CampaignView, RigGiven>;
  "POST /api/campaigns/{id}/surface": Call<SurfaceAnswer, SurfaceGiven>;
  "GET /api/campaigns/{id}/table": Call<DataTable, undefined, { file: string }>;
  "PUT /api/campaigns/{id}/table": Call<Uploaded, Blob, { file: string }>;
  "PUT /api/campaigns/{id}/text": Call<CampaignView, TextGiven>;
  "GET /api/campaigns/{id}/undo": Call<FileBeside[], undefined, { way: Way }>;
  "POST /api/campaigns/{id}/undo": Call<CampaignView, UndoGiven>;
  "PUT /api/campaigns/{id}/window": Call<CampaignView, WindowGiven>;
  "POST /api/contours": Call<ContourMap, GridGiven>;
  "GET /api/findings": Call<Explanation[]>;
  "GET /api/jobs": Call<JobView[]>;
  "GET /api/jobs/{job}": Call<JobView>;
  "DELETE /api/jobs/{job}": Call<JobView>;
  "GET /api/jobs/{job}/events": Call<string>;
  "GET /api/rigs": Call<RigForm[]>;
  "GET /api/scenes": Call<SceneEntry[]>;
  "GET /api/scenes/{id}": Call<SceneView>;
  "GET /api/scenes/{id}/frames": Call<ArrayBuffer, undefined, { from?: number }>;
  "GET /api/scenes/{id}/hardest": Call<HardestFruit[], undefined, { most?: number }>;
  "GET /api/scenes/{id}/history": Call<FruitHistory, undefined, { fruit: number }>;
  "GET /api/scenes/{id}/totals": Call<FruitTotals>;
}
