// FLIP between two pictures, in double precision: Andersson et al., "FLIP: A Difference Evaluator for Alternating Images", HPG 2020.
// core/metrics/flip_filters.h has the same constants; its tests and those of this page compare the two.

export const usualPixelsPerDegree = 67.0206432765823; // 0.7 m before a display 0.7 m wide with 3840 pixels

type Row = Float64Array;
type Matrix = [number[], number[], number[]];

const edgeRounding = 1.44e-7; // of the paper's program, as a share of the luma: core/metrics/flip_filters.h tells why it is added
const [colorPower, knee, kneeError] = [0.7, 0.4, 0.95];
const featureWidth = 0.082; // degrees

// BT.709 to XYZ, each divided by that of white.
const toXyz = [
  [0.41238656325299, 0.35759149092062, 0.18045049120356],
  [0.21263682167732, 0.71518298184124, 0.07218019648142],
  [0.01933062015248, 0.11919716364021, 0.95037258700543],
].map((row) => row.map((value) => value / (row[0]! + row[1]! + row[2]!))) as Matrix;

/** Filters are even or odd: their weights from the center to one end. */
function makeFilters(pixelsPerDegree: number) {
  const bell = (radius: number, exponent: number) => Array.from({ length: radius + 1 }, (_, i) => Math.exp(-exponent * i * i));
  const total = (weights: number[]) => weights.reduce((sum, w, i) => sum + (i ? 2 : 1) * w, 0);
  const scaled = (weights: number[], factor: number) => weights.map((w) => w * factor);
  const exponent = (b: number) => Math.PI ** 2 / (b * pixelsPerDegree ** 2);
  const radius = Math.ceil(3 * Math.sqrt(0.04 / (2 * Math.PI ** 2)) * pixelsPerDegree); // of the widest, for all
  const blur = (b: number) => {
    const weights = bell(radius, exponent(b));
    return scaled(weights, 1 / total(weights)).filter((w) => w > 1e-10); // what is left out would not show in a float
  };
  const yellow = [[34.1, 0.04], [13.5, 0.025]].map(([a, b]) => ({ weights: bell(radius, exponent(b!)), share: a! * Math.sqrt(Math.PI / b!) }));
  const height = yellow.reduce((sum, { weights, share }) => sum + share * total(weights) ** 2, 0);
  const sigma = (featureWidth * pixelsPerDegree) / 2;
  const smooth = bell(Math.ceil(3 * sigma), 1 / (2 * sigma * sigma));
  const first = smooth.map((g, i) => -i * g);
  const second = smooth.map((g, i) => ((i * i) / (sigma * sigma) - 1) * g);
  const side = (sign: number) => total(second.map((w) => Math.max(0, sign * w)));
  return {
    luma: blur(0.0047),
    redGreen: blur(0.0053),
    yellow: yellow.map(({ weights, share }) => scaled(weights, Math.sqrt(share / height))),
    smooth: scaled(smooth, 1 / total(smooth)),
    edge: scaled(first, -1 / first.reduce((a, b) => a + b)),
    point: second.map((w) => w / side(w > 0 ? 1 : -1)),
    radius: Math.max(radius, smooth.length - 1),
  };
}
type Filters = ReturnType<typeof makeFilters>;

/** Luma, red-green and blue-yellow: Y, X - Y and Y - Z of XYZ. */
function toOpponent(light: Float32Array): Float32Array {
  const count = light.length / 3;
  const planes = new Float32Array(light.length);
  for (let i = 0; i < count; ++i) {
    const [r, g, b] = [light[i]!, light[count + i]!, light[2 * count + i]!];
    const y = toXyz[1][0]! * r + toXyz[1][1]! * g + toXyz[1][2]! * b;
    planes[i] = y;
    planes[count + i] = toXyz[0][0]! * r + toXyz[0][1]! * g + toXyz[0][2]! * b - y;
    planes[2 * count + i] = y - (toXyz[2][0]! * r + toXyz[2][1]! * g + toXyz[2][2]! * b);
  }
  return planes;
}

/** Across rows, into a row that goes on beyond both ends by the filters' radius. Odd filters have no weight at the center. */
function filterAcross(plane: Float32Array, width: number, height: number, y: number, weights: number[], sign: number, radius: number, out: Row) {
  const center = y * width;
  for (let x = 0; x < width; ++x) out[radius + x] = weights[0]! * plane[center + x]!;
  for (let i = 1; i < weights.length; ++i) {
    const w = weights[i]!;
    const [above, below] = [Math.max(0, y - i) * width, Math.min(height - 1, y + i) * width];
    for (let x = 0; x < width; ++x) out[radius + x]! += w * (plane[below + x]! + sign * plane[above + x]!);
  }
  out.fill(out[radius]!, 0, radius);
  out.fill(out[radius + width - 1]!, radius + width);
}
/** Along the row, added to what is there. */
function filterAlong(row: Row, width: number, weights: number[], sign: number, radius: number, out: Row) {
  for (let x = 0; x < width; ++x) out[x]! += weights[0]! * row[radius + x]!;
  for (let i = 1; i < weights.length; ++i) {
    const w = weights[i]!;
    for (let x = 0; x < width; ++x) out[x]! += w * (row[radius + x + i]! + sign * row[radius + x - i]!);
  }
}

/** What an observer sees of a row: colors, edges and points. */
class SeenRow {
  readonly colors: [Row, Row, Row];
  readonly features: [Row, Row, Row, Row]; // edges in x and y, points in x and y
  private readonly across: Row;
  constructor(
    private readonly f: Filters,
    private readonly planes: Float32Array,
    private readonly width: number,
    private readonly height: number,
  ) {
    const row = () => new Float64Array(width);
    this.colors = [row(), row(), row()];
    this.features = [row(), row(), row(), row()];
    this.across = new Float64Array(width + 2 * f.radius);
  }
  read(y: number) {
    for (const row of [...this.colors, ...this.features]) row.fill(0);
    const { f, colors, features } = this;
    const add = (channel: number, down: number[], downSign: number, along: [weights: number[], sign: number, to: Row][]) => {
      const plane = this.planes.subarray(channel * this.width * this.height, (channel + 1) * this.width * this.height);
      filterAcross(plane, this.width, this.height, y, down, downSign, f.radius, this.across);
      for (const [weights, sign, to] of along) filterAlong(this.across, this.width, weights, sign, f.radius, to);
    };
    const rounding = [edgeRounding];
    add(0, f.luma, 1, [[f.luma, 1, colors[0]]]);
    add(1, f.redGreen, 1, [[f.redGreen, 1, colors[1]]]);
    for (const weights of f.yellow) add(2, weights, 1, [[weights, 1, colors[2]]]);
    add(0, f.smooth, 1, [[f.edge, -1, features[0]], [rounding, 1, features[0]], [rounding, 1, features[1]], [f.point, 1, features[2]]]);
    add(0, f.edge, -1, [[f.smooth, 1, features[1]]]);
    add(0, f.point, 1, [[f.smooth, 1, features[3]]]);
  }
}

function inverse(m: Matrix): Matrix {
  const minor = (i: number, j: number) => m[(i + 1) % 3]![(j + 1) % 3]! * m[(i + 2) % 3]![(j + 2) % 3]! - m[(i + 1) % 3]![(j + 2) % 3]! * m[(i + 2) % 3]![(j + 1) % 3]!;
  const determinant = [0, 1, 2].reduce((sum, j) => sum + m[0][j]! * minor(0, j), 0);
  return [0, 1, 2].map((i) => [0, 1, 2].map((j) => minor(j, i) / determinant)) as Matrix;
}
const toRgb = inverse(toXyz);

/** L, and a and b made smaller by 0.01 L (Hunt), of light within 0..1, into `lab`: a pixel makes no garbage. */
function adjustedLab(r: number, g: number, b: number, lab: Row) {
  const fx = labCurve(toXyz[0][0]! * r + toXyz[0][1]! * g + toXyz[0][2]! * b);
  const fy = labCurve(toXyz[1][0]! * r + toXyz[1][1]! * g + toXyz[1][2]! * b);
  const fz = labCurve(toXyz[2][0]! * r + toXyz[2][1]! * g + toXyz[2][2]! * b);
  const l = 116 * fy - 16;
  lab[0] = l;
  lab[1] = 0.01 * l * 500 * (fx - fy);
  lab[2] = 0.01 * l * 200 * (fy - fz);
}
function labCurve(t: number): number {
  return t > 216 / 24389 ? Math.cbrt(t) : ((t * 24389) / 27 + 16) / 116;
}
function length(x: number, y: number): number {
  return Math.sqrt(x * x + y * y); // Math.hypot takes ten times as long
}
function clamp(value: number): number {
  return value < 0 ? 0 : value > 1 ? 1 : value;
}
const labs = [new Float64Array(3), new Float64Array(3)] as const;
/** HyAB of the two in `labs`, to the power of 0.7. */
function colorDifference(): number {
  const [a, b] = labs;
  return (Math.abs(a[0]! - b[0]!) + length(a[1]! - b[1]!, a[2]! - b[2]!)) ** colorPower;
}
adjustedLab(0, 1, 0, labs[0]);
adjustedLab(0, 0, 1, labs[1]);
const largest = colorDifference();
const kneeAt = knee * largest;

function seeColor(row: SeenRow, x: number, lab: Row) {
  const y = row.colors[0][x]!;
  const [rx, gx, bx] = [y + row.colors[1][x]!, y, y - row.colors[2][x]!];
  const light = (m: number[]) => clamp(m[0]! * rx + m[1]! * gx + m[2]! * bx);
  adjustedLab(light(toRgb[0]), light(toRgb[1]), light(toRgb[2]), lab);
}
function errorAt(a: SeenRow, b: SeenRow, x: number): number {
  seeColor(a, x, labs[0]);
  seeColor(b, x, labs[1]);
  const power = colorDifference();
  const color = power < kneeAt ? (kneeError / kneeAt) * power : kneeError + ((power - kneeAt) / (largest - kneeAt)) * (1 - kneeError);
  const [p, q] = [a.features, b.features];
  const edges = Math.abs(length(p[0][x]!, p[1][x]!) - length(q[0][x]!, q[1][x]!));
  const points = Math.abs(length(p[2][x]!, p[3][x]!) - length(q[2][x]!, q[3][x]!));
  return Math.min(1, color) ** (1 - Math.sqrt(Math.min(1, Math.max(edges, points) / Math.SQRT2)));
}

const kSlice = 12; // ms of work, then the page may draw

/**
 * The error of each pixel, 0..1, of linear light of 0..1, plane after plane. Long work is done in slices, and given up (null) when
 * it is wanted no more.
 */
export async function flipMap(
  [a, b]: readonly [Float32Array, Float32Array],
  { width, height }: { width: number; height: number },
  pixelsPerDegree: number,
  isWanted: () => boolean,
): Promise<Float32Array | null> {
  const filters = makeFilters(pixelsPerDegree);
  const [rowA, rowB] = [a, b].map((light) => new SeenRow(filters, toOpponent(light), width, height)) as [SeenRow, SeenRow];
  const errors = new Float32Array(width * height);
  let start = performance.now();
  for (let y = 0; y < height; ++y) {
    rowA.read(y);
    rowB.read(y);
    for (let x = 0; x < width; ++x) errors[y * width + x] = errorAt(rowA, rowB, x);
    if (performance.now() - start < kSlice) continue;
    await new Promise((done) => setTimeout(done));
    if (!isWanted()) return null;
    start = performance.now();
  }
  return errors;
}
