// Gaussians whose every value is known, as .ply and as readers give them, and how far they are from each other.
//
// A reading: {count, degree, position [3], covariance [6: xx xy xz yy yz zz], rgb [3, 0 to 1 from f_dc alone],
// alpha, sh [3 per coefficient, coefficient by coefficient] or null}, in the axes of a .ply: x right, y down, z forward.
import {writeFileSync} from 'node:fs';
import {deflateRawSync} from 'node:zlib';

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

// The second kind, of two levels: piece 0 in two ranges, and piece 1, which is coarser; in a folder where these are.
export function writeLcc2(folder, pieces, counts) {
  const node = (name, start, count, child) => ({data: {'3dgs': {name, start, count}}, ...(child && {child})});
  const fine = {0: node(0, 0, 60), 1: node(0, 60, counts[0] - 60)};
  const text = {totalSplats: counts[0] + counts[1], totalLevels: 2, lodSplats: counts, splatType: pieces[0].slice(-4),
    root: {splatFiles: pieces, child: [node(1, 0, counts[1], fine)]}};
  writeFileSync(`${folder}/meta.lcc2`, JSON.stringify(text));
}

export function halfOf(value) {
  const [v] = Float32Array.of(Math.abs(value)), sign = value < 0 || Object.is(value, -0) ? 0x8000 : 0;
  const exponent = Math.max(-14, Math.floor(Math.log2(v || 2 ** -30))), step = 2 ** (exponent - 10);
  const steps = Math.round(v / step);
  return sign | (steps < 1024 ? steps : (exponent + 15 << 10) + steps - 1024);
}
export function fromHalf(bits) {
  const exponent = bits >> 10 & 31, fraction = bits & 1023;
  return (bits & 0x8000 ? -1 : 1) * (exponent === 0 ? fraction * 2 ** -24 : (1024 + fraction) * 2 ** (exponent - 25));
}

// How .rad stores values of several components, all of the first one before those of the second.
const planes = (values, width) => Array.from({length: width}, (_, d) => values.filter((_, i) => i % width === d)).flat();
const inSteps = (values, least, most, steps) => values.map((v) => Math.max(0, Math.min(steps, Math.round((v - least) / (most - least) * steps))));
const differencesOf = (bytes, run) => bytes.map((b, i) => b - (i % run ? bytes[i - 1] : 0) & 255);
const splitBytes = (buffer, size) => Buffer.concat(Array.from({length: size}, (_, b) => buffer.filter((_, i) => i % size === b)));
const asFloats = (values) => Buffer.from(Float32Array.from(values).buffer);
const asHalves = (values) => Buffer.from(Uint16Array.from(values, halfOf).buffer);
const ENCODED = {  // (values, all of the first component first; how many of each) to bytes and bounds
  f32: (v) => [asFloats(v)], f16: (v) => [asHalves(v)],
  f32_lebytes: (v) => [splitBytes(asFloats(v), 4)], f16_lebytes: (v) => [splitBytes(asHalves(v), 2)],
  r8: (v) => [Buffer.from(inSteps(v, -1, 2, 255)), {min: -1, max: 2}],
  r8_delta: (v, n) => [Buffer.from(differencesOf(inSteps(v, -1, 2, 255), n)), {min: -1, max: 2}],
  s8: (v) => [Buffer.from(v.map((x) => Math.round(x / 0.5 * 127) & 255)), {min: -0.5, max: 0.5}],
  s8_delta: (v, n) => [Buffer.from(differencesOf(v.map((x) => Math.round(x / 0.5 * 127) & 255), n)), {min: -0.5, max: 0.5}],
  ln_f16: (v) => [asHalves(v.map(Math.log))],
  ln_0r8: (v) => [Buffer.from(inSteps(v.map(Math.log), -12, 9, 254).map((s) => s + 1)), {min: -12, max: 9}],
};
// A rotation of three bytes: where its axis meets an octahedron, unfolded, and its angle.
function octOf([w, x, y, z]) {
  const angle = 2 * Math.acos(Math.min(1, w)), sum = Math.abs(x) + Math.abs(y) + Math.abs(z) || 1, sign = (v) => v < 0 ? -1 : 1;
  let [u, v] = [x / sum, y / sum];
  if (z < 0) [u, v] = [(1 - Math.abs(v)) * sign(u), (1 - Math.abs(u)) * sign(v)];
  return [...inSteps([u, v], -1, 1, 255), ...inSteps([angle], 0, Math.PI, 255)];
}

// A scene of Spark. rows: {centre, alpha, rgb, scale: [..]; rotation: [w x y z ..]; sh: [1 to 3: [..]]}, component by
// component of each. variant: which of the encodings. tree: {counts, starts} of children. In chunks of that size.
export function radOf(rows, variant, tree, chunkSize = 65536) {
  const pick = (...names) => names[variant % names.length], count = rows.alpha.length, chunks = [];
  const padded = (b) => Buffer.concat([b, Buffer.alloc((8 - b.length % 8) % 8)]);
  const withText = (mark, text) => {
    const bytes = Buffer.from(JSON.stringify(text)), head = Buffer.from(`${mark}    `);
    head.writeUInt32LE(bytes.length, 4);
    return Buffer.concat([head, padded(bytes)]);
  };
  for (let base = 0; base < count; base += chunkSize) {
    const n = Math.min(chunkSize, count - base), properties = [], payload = [];
    let offset = 0;
    const add = (property, encoding, bytes, bounds) => {
      const packed = deflateRawSync(bytes);
      properties.push({offset, bytes: packed.length, property, encoding, compression: 'gz', ...bounds});
      payload.push(padded(packed));
      offset += payload.at(-1).length;
    };
    const values = (property, encoding, all, width) =>
      add(property, encoding, ...ENCODED[encoding](planes(all.slice(width * base, width * (base + n)), width), n));
    values('center', pick('f32', 'f32_lebytes', 'f16', 'f16_lebytes'), rows.centre, 3);
    values('alpha', pick('r8', 'f32', 'f16'), rows.alpha, 1);
    values('rgb', pick('r8_delta', 'r8', 'f32', 'f16'), rows.rgb, 3);
    values('scales', pick('ln_0r8', 'ln_f16', 'f32'), rows.scale, 3);
    const rotations = Array.from({length: n}, (_, i) => rows.rotation.slice(4 * (base + i), 4 * (base + i + 1)));
    const rotation = pick('oct88r8', 'f32', 'f16');
    if (rotation === 'oct88r8') add('orientation', rotation, Buffer.from(rotations.map(octOf).flat()));
    else values('orientation', rotation, [...Array(3 * base).fill(0), ...rotations.flatMap((q) => q.slice(1))], 3);
    rows.sh.forEach((all, d) => values(`sh${d + 1}`, pick('s8', 's8_delta', 'f32', 'f16', 'r8'), all, 6 * d + 9));
    if (tree) add('child_count', 'u16', Buffer.from(Uint16Array.from(tree.counts.slice(base, base + n)).buffer));
    if (tree) add('child_start', 'u32', Buffer.from(Uint32Array.from(tree.starts.slice(base, base + n)).buffer));
    const size = Buffer.alloc(8);
    size.writeBigUInt64LE(BigInt(offset));
    chunks.push(Buffer.concat([withText('RADC', {version: 1, base, count: n, payloadBytes: offset, maxSh: rows.sh.length,
      ...(tree && {lodTree: true}), properties}), size, ...payload]));
  }
  let offset = 0;
  const ranges = chunks.map((chunk) => ({offset: (offset += chunk.length) - chunk.length, bytes: chunk.length}));
  return Buffer.concat([withText('RAD0', {version: 1, type: 'gsplat', count, maxSh: rows.sh.length, ...(tree && {lodTree: true}), chunkSize,
    allChunkBytes: offset, chunks: ranges}), ...chunks]);
}
export function radRowsOf(columns) {
  const named = Object.fromEntries(columns.map((c) => [c.name, c.values])), reading = readingOfColumns(columns), count = reading.count;
  const rows = {centre: reading.position, alpha: reading.alpha, rgb: reading.rgb, scale: [], rotation: [], sh: []};
  const each = coefficients(reading.degree);
  for (let d = 1; d <= reading.degree; ++d)
    rows.sh.push(reading.sh.filter((_, i) => Math.floor(i / 3) % each >= coefficients(d - 1) && Math.floor(i / 3) % each < coefficients(d)));
  for (let i = 0; i < count; ++i) {
    rows.scale.push(...[0, 1, 2].map((c) => Math.exp(named[`scale_${c}`][i])));
    const q = [0, 1, 2, 3].map((c) => named[`rot_${c}`][i]), length = Math.hypot(...q) * (q[0] < 0 ? -1 : 1);
    rows.rotation.push(...q.map((v) => v / length));
  }
  return rows;
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
