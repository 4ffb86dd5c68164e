// The field's own readers and writers, each as a function from a file to a reading (gaussians.mjs).
import {spawnSync} from 'node:child_process';
import {readFileSync, writeFileSync} from 'node:fs';
import {fileURLToPath} from 'node:url';
import validator from 'gltf-validator';
import {GLTFLoader} from 'three/addons/loaders/GLTFLoader.js';
import {GLTFGaussianSplatLoaderExtension} from 'three/addons/loaders/GLTFGaussianSplatLoaderExtension.js';
import {GaussianSplatPLYLoader} from 'three/addons/loaders/GaussianSplatPLYLoader.js';
import {KSPLATLoader} from 'three/addons/loaders/KSPLATLoader.js';
import {SPLATLoader} from 'three/addons/loaders/SPLATLoader.js';
import {USDAParser} from 'three/addons/loaders/usd/USDAParser.js';
import {SPZLoader} from 'three/addons/loaders/SPZLoader.js';
import {coefficients, columnsOfPly, covariance, fromHalf, readingOfColumns} from './gaussians.mjs';

const SH_C0 = 0.28209479177387814;
const arrayBuffer = (path) => { const b = readFileSync(path); return b.buffer.slice(b.byteOffset, b.byteOffset + b.byteLength); };

// three.js keeps spherical harmonics as bytes, (value - 128) / 128, four to a word, band by band.
function readingOfGeometry(geometry) {
  const attribute = (name) => geometry.getAttribute(name);
  const count = attribute('position').count, colours = attribute('color').array;
  const bands = [1, 2, 3].map((d) => attribute(`sphericalHarmonics${d}`)).filter((band) => band);
  const degree = bands.length, sh = [];
  for (let g = 0; g < count; ++g)
    bands.forEach((band, d) => {
      const bytes = new Uint8Array(band.array.buffer, band.array.byteOffset + 4 * g * band.itemSize, 3 * (2 * d + 3));
      for (const b of bytes) sh.push((b - 128) / 128);
    });
  const every = (i, from, to) => i % 4 >= from && i % 4 < to;
  return {count, degree, sh, position: [...attribute('position').array], covariance: [...attribute('covariance').array],
    rgb: [...colours].filter((_, i) => every(i, 0, 3)).map((b) => b / 255), alpha: [...colours].filter((_, i) => every(i, 3, 4)).map((b) => b / 255)};
}

const three = (Loader) => async (path) => readingOfGeometry(await new Loader().parse(arrayBuffer(path)));

export const threePly = three(GaussianSplatPLYLoader);
export const threeSplat = three(SPLATLoader);
export const threeSpz = three(SPZLoader);
export const threeKsplat = three(KSPLATLoader);

export async function threeGlb(path) {
  const loader = new GLTFLoader().register((parser) => new GLTFGaussianSplatLoaderExtension(parser));
  const gltf = await loader.parseAsync(arrayBuffer(path), '');
  let geometry;
  gltf.scene.traverse((node) => { geometry ??= node.splatGeometry; });
  return readingOfGeometry(geometry);
}

// A field of particles by the values of its attributes, each an array of plain numbers.
function readingOfField({positions, orientations, scales, opacities, degree, coefficients: sh}, real) {
  const count = positions.length / 3, each = 3 * (degree + 1) ** 2;
  const reading = {count, degree, position: [...positions], covariance: [], rgb: [], alpha: [...opacities], sh: []};
  for (let g = 0; g < count; ++g) {
    const q = orientations.slice(4 * g, 4 * g + 4);
    reading.covariance.push(...covariance(real === 'last' ? [q[3], q[0], q[1], q[2]] : q, scales.slice(3 * g, 3 * g + 3)));
    reading.rgb.push(...sh.slice(each * g, each * g + 3).map((v) => 0.5 + SH_C0 * v));
    reading.sh.push(...sh.slice(each * g + 3, each * (g + 1)));
  }
  return reading;
}
const FIELD = {positions: 'positions', orientations: 'orientations', scales: 'scales', opacities: 'opacities',
  degree: 'radiance:sphericalHarmonicsDegree', coefficients: 'radiance:sphericalHarmonicsCoefficients'};

export async function threeUsda(path) {
  const specs = new USDAParser().parseData(readFileSync(path, 'utf8')).specsByPath, root = specs['/'].fields;
  const prim = `/${root.defaultPrim}`;
  if (specs[prim].fields.typeName !== 'ParticleField3DGaussianSplat' || root.upAxis !== 'Y' || root.metersPerUnit !== 1)
    throw new Error(`${specs[prim].fields.typeName}, ${root.upAxis} up, ${root.metersPerUnit} m`);
  return readingOfField(Object.fromEntries(Object.entries(FIELD).map(([key, name]) => [key, specs[`${prim}.${name}`].fields.default])), 'last');
}

// A USD library of its own, which reads the whole layer and writes it again; its types and values are taken from that.
export async function tinyUsda(path) {
  [process.type, globalThis.window, globalThis.self] = ['renderer', globalThis, globalThis];  // it only starts as in a browser
  const wasm = readFileSync(new URL('node_modules/tinyusdz/tinyusdz.wasm', import.meta.url));
  const {default: start} = await import('tinyusdz/tinyusdz.js');
  const library = await start({instantiateWasm: (imports, done) => {
    WebAssembly.instantiate(wasm, imports).then(({instance, module}) => done(instance, module));
    return {};
  }});
  const loader = new library.TinyUSDZLoaderNative();
  if (!loader.loadAsLayerFromBinary(readFileSync(path, 'utf8'), path)) throw new Error(loader.error());
  const lines = loader.layerToString().split('\n');
  if (!lines.some((line) => line.startsWith('def ParticleField3DGaussianSplat "Gaussians"'))) throw new Error('holds no field of particles');
  const value = (name) => {
    const line = lines.find((l) => l.includes(` ${name} = `));
    if (!line) throw new Error(`has no ${name}`);
    return line.slice(line.indexOf(' = ') + 3).match(/[-+]?[0-9][0-9.]*(e[-+]?[0-9]+)?/gi).map(Number);
  };
  const field = Object.fromEntries(Object.entries(FIELD).map(([key, name]) => [key, value(name)]));
  return readingOfField({...field, degree: field.degree[0]}, 'first');
}

// Sentences on what is not as the standard has it. The validator does not know the extension: its names of attributes,
// with a colon, are none of the standard's own.
export async function glbFaults(path) {
  const report = await validator.validateBytes(new Uint8Array(readFileSync(path)), {maxIssues: 20});
  return report.issues.messages.filter((m) => m.severity <= 1)
    .filter((m) => !(m.code === 'MESH_PRIMITIVE_INVALID_ATTRIBUTE' && /KHR_gaussian_splatting:/.test(m.pointer))).map((m) => `${m.code} at ${m.pointer}: ${m.message}`);
}

export async function spzLoader(path) {
  [process.type, globalThis.window] = ['renderer', globalThis];  // it only starts as in a browser
  const {loadSpz} = await import('@spz-loader/core');
  const c = await loadSpz(new Uint8Array(readFileSync(path)), {colorScaleFactor: SH_C0});
  const of = (array, width, g) => [...array.subarray(width * g, width * (g + 1))];
  const covariances = [];
  for (let g = 0; g < c.numPoints; ++g) {
    const [x, y, z, w] = of(c.rotations, 4, g);
    covariances.push(...covariance([w, x, y, z], of(c.scales, 3, g)));
  }
  return {count: c.numPoints, degree: c.shDegree, position: [...c.positions], covariance: covariances,
    rgb: [...c.colors], alpha: [...c.alphas],
    sh: [...c.sh].slice(0, 3 * coefficients(c.shDegree) * c.numPoints)};
}

const CONVERTER = fileURLToPath(new URL('node_modules/@playcanvas/splat-transform/bin/cli.mjs', import.meta.url));

export function splatTransform(from, to, options = []) {
  const end = spawnSync(process.execPath, [CONVERTER, '-w', '-q', '-g', 'cpu', from, ...options, to], {encoding: 'utf8'});
  if (end.status !== 0) throw new Error(`splat-transform ${from} ${to}: ${end.stderr || end.stdout || end.error}`);
}

export async function converter(path, options = []) {
  splatTransform(path, `${path}.theirs.ply`, options);
  return readingOfColumns(columnsOfPly(readFileSync(`${path}.theirs.ply`)));
}

// Writes a .ksplat of a compression level, 0 to 2.
export async function writeKsplat(ply, path, level, degree) {
  globalThis.window = globalThis;  // it asks for timers there
  const {PlyLoader} = await import('./gaussian-splats-3d.mjs');
  const buffer = await PlyLoader.loadFromFileData(arrayBuffer(ply), 0, level, true, degree);
  writeFileSync(path, Buffer.from(buffer.bufferData));
}

// Spark's worker, which is a text in its module, and speaks by messages.
let sparkAnswers;
async function askSpark(name, args) {
  if (!sparkAnswers) {
    const text = readFileSync(new URL('node_modules/@sparkjsdev/spark/dist/spark.module.js', import.meta.url), 'utf8');
    const worker = text.split('\n').find((line) => line.startsWith('const jsContent = ')).slice('const jsContent = '.length).replace(/;\s*$/, '');
    const module = await WebAssembly.compile(Buffer.from(text.match(/decode64\("(AGFzbQ[^"]+)"/)[1], 'base64'));
    const listeners = new Set(), waiting = {};
    globalThis.self = {addEventListener: (_, f) => listeners.add(f), removeEventListener: (_, f) => listeners.delete(f),
      postMessage: (message) => { if (!message.status) waiting.done(message); }};
    new Function(new Function(`return ${worker}`)())();
    const send = (data) => [...listeners].forEach((f) => f({data}));
    send({name: 'init-wasm', module});
    sparkAnswers = (data) => new Promise((done) => { waiting.done = done; send(data); });
  }
  const said = console.log;
  console.log = () => {};  // it counts
  const {error, result} = await sparkAnswers({id: 1, name, args});
  console.log = said;
  if (error) throw new Error(String(error));
  return result.lodSplats ?? result;
}

// What it keeps of each: halves, logarithms of sizes, rotations in 32 bits. Harmonics in 7, 8 and 6 bits, from its packed
// form (the other one cuts off what is above a power of two).
const SH_BITS = [7, 8, 6];
function rowsOfSpark({numSplats, extArrays: [a, b]}, bands = []) {
  const degree = bands.length;
  const rows = {centre: [], alpha: [], rgb: [], scale: [], rotation: [], sh: Array.from({length: degree}, () => [])};
  const centres = new Float32Array(a.buffer, a.byteOffset, a.length);
  const harmonic = (words, at, bits) => {
    const value = Number(BigInt.asIntN(bits, words.reduceRight((sum, word) => sum << 32n | BigInt(word), 0n) >> BigInt(at * bits)));
    return value / (2 ** (bits - 1) - 1);
  };
  for (let i = 0; i < numSplats; ++i) {
    rows.centre.push(...centres.subarray(4 * i, 4 * i + 3));
    rows.alpha.push(fromHalf(a[4 * i + 3] & 0xffff));
    const halves = [0, 1, 2].flatMap((w) => [fromHalf(b[4 * i + w] & 0xffff), fromHalf(b[4 * i + w] >>> 16)]);
    rows.rgb.push(...halves.slice(0, 3));
    rows.scale.push(...halves.slice(3).map(Math.exp));
    const word = b[4 * i + 3], u = (word & 1023) / 1023 * 2 - 1, v = (word >>> 10 & 1023) / 1023 * 2 - 1, half = (word >>> 20) / 4095 * Math.PI / 2;
    const z = 1 - Math.abs(u) - Math.abs(v), below = Math.max(0, -z), axis = [u - (u < 0 ? -below : below), v - (v < 0 ? -below : below), z];
    rows.rotation.push(Math.cos(half), ...axis.map((c) => c / Math.hypot(...axis) * Math.sin(half)));
    bands.forEach((band, d) => {
      const each = d === 0 ? 2 : 4, words = [...band.subarray(each * i, each * (i + 1))];
      for (let at = 0; at < 6 * d + 9; ++at) rows.sh[d].push(harmonic(words, at, SH_BITS[d]));
    });
  }
  return rows;
}

function readingOfRadRows(rows, taken) {
  const reading = {count: taken.length, degree: rows.sh.length, position: [], covariance: [], rgb: [], alpha: [], sh: []};
  for (const i of taken) {
    const of = (values, width) => values.slice(width * i, width * (i + 1));
    reading.position.push(...of(rows.centre, 3));
    reading.covariance.push(...covariance(of(rows.rotation, 4), of(rows.scale, 3)));
    reading.rgb.push(...of(rows.rgb, 3));
    reading.alpha.push(...of(rows.alpha, 1));
    rows.sh.forEach((sh, d) => reading.sh.push(...of(sh, 6 * d + 9)));
  }
  return reading;
}

const readSpark = async (path, form = 'loadExtSplats') =>
  askSpark(form, {fileBytes: new Uint8Array(readFileSync(path)), fileType: 'rad', pathName: path});
const childrenOf = ({numSplats, extra: {lodTree}}) => ({counts: Array.from({length: numSplats}, (_, i) => lodTree[4 * i + 2]),
  starts: Array.from({length: numSplats}, (_, i) => lodTree[4 * i + 3])});

// All Gaussians of a .rad, or the leaves of its tree.
export async function spark(path) {
  const read = await readSpark(path), all = Array.from({length: read.numSplats}, (_, i) => i);
  const tree = read.extra.lodTree && childrenOf(read);
  const {extra} = await readSpark(path, 'loadPackedSplats'), bands = [extra.sh1, extra.sh2, extra.sh3].filter((band) => band);
  return readingOfRadRows(rowsOfSpark(read, bands), tree ? all.filter((i) => tree.counts[i] === 0) : all);
}

// The tree that it makes of the Gaussians of a .rad: rows and children as radOf() wants them.
export async function sparkTree(path) {
  const {numSplats, extArrays, extra} = await readSpark(path);
  const made = await askSpark('tinyLodExtSplats', {numSplats, extArrays, extra});
  return [rowsOfSpark(made), childrenOf(made)];
}
