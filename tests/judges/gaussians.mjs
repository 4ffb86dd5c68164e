// Gaussians whose every value is known, as .ply and as readers give them, and how far they are from each other.
//
// A reading: {count, degree, position [3], covariance [6: xx xy xz yy yz zz], rgb [3, 0 to 1 from f_dc alone],
// alpha, sh [3 per coefficient, coefficient by coefficient] or null}, in the axes of a .ply: x right, y down, z forward.
import {writeFileSync} from 'node:fs';

export const COUNT = 96;
const SH_C0 = 0.28209479177387814;
export const coefficients = (degree) => (degree + 1) ** 2 - 1;

// Evenly spread in [0, 1): the fractional parts of multiples of an irrational number, another one for each property.
const spread = (row, property) => (0.5 + (row + 1) * Math.sqrt(2 + 1.37 * property)) % 1;

// Raw values of a .ply, by name.
export function knownRows(degree) {
  const names = ['x', 'y', 'z', 'f_dc_0', 'f_dc_1', 'f_dc_2'];
  for (let i = 0; i < 3 * coefficients(degree); ++i) names.push(`f_rest_${i}`);
  names.push('opacity', 'scale_0', 'scale_1', 'scale_2', 'rot_0', 'rot_1', 'rot_2', 'rot_3');
  const within = (name, t) => name.length === 1 ? 8 * t - 4 : name === 'opacity' ? 5 * t - 2 : name.startsWith('scale') ? 3 * t - 5
    : name.startsWith('f_rest') ? 0.8 * t - 0.4 : name.startsWith('f_dc') ? 2 * t - 1 : 2 * t - 0.9;
  return names.map((name, property) =>
    ({name, values: Float32Array.from({length: COUNT}, (_, row) => within(name, spread(row, property)))}));
}

export function plyOf(columns, comments = []) {
  const count = columns[0].values.length;
  const header = ['ply', 'format binary_little_endian 1.0', ...comments.map((c) => `comment ${c}`), `element vertex ${count}`,
    ...columns.map((c) => `property float ${c.name}`), 'end_header', ''].join('\n');
  const rows = new Float32Array(count * columns.length);
  columns.forEach((column, c) => column.values.forEach((v, row) => { rows[row * columns.length + c] = v; }));
  return Buffer.concat([Buffer.from(header), Buffer.from(rows.buffer)]);
}

// A scene of XGRIDS in a folder, Gaussians of any bits in two units, with spherical harmonics or without. Without
// what lies around, which the converter leaves out of a .ply.
export function writeLcc(folder, withSh) {
  let state = 12345;
  const bits = () => (state = Math.imul(state, 1664525) + 1013904223 >>> 0) >>> 8;  // 24 of them
  const data = Buffer.alloc(32 * COUNT), sh = Buffer.alloc(64 * COUNT), index = Buffer.alloc(40);
  for (let i = 0; i < COUNT; ++i) {
    for (let axis = 0; axis < 3; ++axis) data.writeFloatLE(bits() / (1 << 20) - 8, 32 * i + 4 * axis);
    for (let byte = 12; byte < 32; ++byte) data[32 * i + byte] = bits() % 256;
    data[32 * i + 15] = 1 + bits() % 254;  // an opacity whose logit is a number
    for (let byte = 0; byte < 60; ++byte) sh[64 * i + byte] = bits() % 256;
  }
  for (const [at, count, begin] of [[4, COUNT - 10, 0], [24, 10, 32 * (COUNT - 10)]]) {
    index.writeInt32LE(count, at);
    index.writeBigInt64LE(BigInt(begin), at + 4);
    index.writeInt32LE(32 * count, at + 12);
  }
  const range = (name, least, most) => ({name, min: [least, least, least], max: [most, 2 * most, 3 * most]});
  const text = {version: '5.0', totalLevel: 1, splats: [COUNT], fileType: withSh ? 'Quality' : 'Portable',
    attributes: [range('scale', 0.01, 0.5), range('shcoef', -1, 1)]};
  for (const [name, content] of [['meta.lcc', JSON.stringify(text)], ['index.bin', index], ['data.bin', data], ['shcoef.bin', sh]])
    writeFileSync(`${folder}/${name}`, content);
}

export function columnsOfPly(bytes) {
  const end = bytes.indexOf('end_header\n') + 'end_header\n'.length;
  const lines = bytes.subarray(0, end).toString().split('\n');
  const count = Number(lines.find((l) => l.startsWith('element vertex')).split(' ')[2]);
  const names = lines.filter((l) => l.startsWith('property float')).map((l) => l.split(' ')[2]);
  const rows = new Float32Array(bytes.buffer.slice(bytes.byteOffset + end, bytes.byteOffset + end + 4 * count * names.length));
  return names.map((name, c) => ({name, values: Float32Array.from({length: count}, (_, row) => rows[row * names.length + c])}));
}

// Of rotation matrix (quaternion w x y z, any length) and sizes.
export function covariance([w, x, y, z], sizes) {
  const n = Math.hypot(w, x, y, z);
  [w, x, y, z] = [w / n, x / n, y / n, z / n];
  const r = [[1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)],
    [2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)],
    [2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)]];
  const at = (i, j) => sizes.reduce((sum, s, k) => sum + s * s * r[i][k] * r[j][k], 0);
  return [at(0, 0), at(0, 1), at(0, 2), at(1, 1), at(1, 2), at(2, 2)];
}

export function readingOfColumns(columns) {
  const named = Object.fromEntries(columns.map((c) => [c.name, c.values]));
  const count = named.x.length;
  let degree = 0;
  while (degree < 3 && `f_rest_${3 * coefficients(degree + 1) - 1}` in named) ++degree;
  const reading = {count, degree, position: [], covariance: [], rgb: [], alpha: [], sh: []};
  for (let row = 0; row < count; ++row) {
    const of = (prefix, n) => Array.from({length: n}, (_, i) => named[`${prefix}_${i}`][row]);
    reading.position.push(named.x[row], named.y[row], named.z[row]);
    reading.covariance.push(...covariance(of('rot', 4), of('scale', 3).map(Math.exp)));
    reading.rgb.push(...of('f_dc', 3).map((v) => 0.5 + SH_C0 * v));
    reading.alpha.push(1 / (1 + Math.exp(-named.opacity[row])));
    const rest = of('f_rest', 3 * coefficients(degree));
    for (let k = 0; k < coefficients(degree); ++k)
      for (let c = 0; c < 3; ++c) reading.sh.push(rest[c * coefficients(degree) + k]);
  }
  return reading;
}

// What the axes' signs do to each coefficient of degree 1 to 3: the letters of the axes that it is odd in.
const ODD_IN = ['y', 'z', 'x', 'xy', 'yz', '', 'xz', '', 'y', 'xyz', 'y', 'z', 'x', 'z', 'x'];

export function turned(reading, signs) {
  const sign = (letters) => [...letters].reduce((product, letter) => product * signs['xyz'.indexOf(letter)], 1);
  const pairs = ['', 'xy', 'xz', '', 'yz', ''];
  return {...reading, position: reading.position.map((v, i) => v * signs[i % 3]),
    covariance: reading.covariance.map((v, i) => v * sign(pairs[i % 6])),
    sh: reading.sh && reading.sh.map((v, i) => v * sign(ODD_IN[Math.floor(i / 3) % coefficients(reading.degree)]))};
}

// Sentences on what differs by more than the steps allow; none where nothing does.
export function differences(expected, got, steps) {
  if (got.count !== expected.count) return [`${got.count} Gaussians, not ${expected.count}`];
  const degree = steps.sh === undefined ? 0 : expected.degree;
  if (got.degree !== degree) return [`degree ${got.degree}, not ${degree}`];
  const nearest = Array.from({length: expected.count}, (_, e) => {
    let best = 0, least = Infinity;
    for (let g = 0; g < got.count; ++g) {
      const d = Math.hypot(...[0, 1, 2].map((i) => got.position[3 * g + i] - expected.position[3 * e + i]));
      if (d < least) [best, least] = [g, d];
    }
    return best;
  });
  const worst = (key, width, scale = () => 1) => Math.max(...nearest.map((g, e) => Math.max(...Array.from({length: width}, (_, i) =>
    Math.abs(got[key][width * g + i] - expected[key][width * e + i]))) / scale(e)));
  const size = (e) => expected.covariance[6 * e] + expected.covariance[6 * e + 3] + expected.covariance[6 * e + 5];
  const found = {position: worst('position', 3), covariance: worst('covariance', 6, size), rgb: worst('rgb', 3), alpha: worst('alpha', 1)};
  if (degree > 0) found.sh = worst('sh', 3 * coefficients(degree));
  return Object.keys(found).filter((key) => !(found[key] <= steps[key]))
    .map((key) => `${key} differs by ${found[key].toPrecision(3)}, ${steps[key].toPrecision(3)} are steps of the format`);
}
