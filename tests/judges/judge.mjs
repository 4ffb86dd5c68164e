// node judge.mjs SPLATCUT FOLDER [DEGREES, as 0,3]: what the program writes is read by the field's own programs, what they write by the
// program; by value, spherical harmonics of degree 0 to 3. Prints the matrix; ends with 1 where anything differs.
import {spawnSync} from 'node:child_process';
import {mkdirSync, readFileSync, writeFileSync} from 'node:fs';
import {COUNT, columnsOfPly, differences, knownRows, plyOf, readingOfColumns, radOf, radRowsOf, turned, writeLcc, writeLcc2} from './gaussians.mjs';
import * as readers from './readers.mjs';

const [program, folder, asked = '0,1,2,3'] = process.argv.slice(2);
const DEGREES = asked.split(',').map(Number);
const BYTE = 0.505 / 255, SH_BYTE = 0.505 / 128;

// What a format rounds by, as its layout has it; rgb and covariance follow from f_dc and from sizes and rotation.
const STEPS = {
  ply: {position: 0, covariance: 1e-5, rgb: 1e-6, alpha: 1e-6, sh: 0},
  glb: {position: 0, covariance: 1e-5, rgb: 1e-6, alpha: 1e-6, sh: 0},
  'compressed.ply': {position: 0.005, covariance: 0.01, rgb: BYTE * 1.3, alpha: BYTE, sh: 4 * SH_BYTE},
  splat: {position: 0, covariance: 0.03, rgb: BYTE, alpha: BYTE},
  spz: {position: 0.505 / 4096, covariance: 0.075, rgb: BYTE * 1.9, alpha: BYTE, sh: SH_BYTE},
  'their spz': {position: 0.505 / 4096, covariance: 0.075, rgb: BYTE * 1.9, alpha: BYTE, sh: 17 * SH_BYTE},  // SH in 4 and 5 bits
  sog: {position: 0.002, covariance: 0.06, rgb: 0.005, alpha: BYTE, sh: 0.02},
  'their sog': {position: 2e-6, covariance: 1e-5, rgb: 1e-6, alpha: 1e-6, sh: 1e-6},  // against their own reading
  lcc: {position: 2e-5, covariance: 1e-5, rgb: 1e-6, alpha: 1e-6, sh: 2e-5},  // against their own reading
  rad: {position: 1e-6, covariance: 0.02, rgb: 0.001, alpha: 0.001, sh: 0.51 / 31},  // against Spark's reading, in its halves
  ksplat: {position: 0.01, covariance: 0.01, rgb: 2 * BYTE, alpha: 2 * BYTE, sh: 0.01},  // cut off, not rounded
};
// A reader may round once more: three.js to bytes.
const inBytes = (steps) => ({...steps, position: steps.position + 1e-6, covariance: steps.covariance + 1e-5, rgb: steps.rgb + BYTE, alpha: steps.alpha + BYTE,
  ...(steps.sh === undefined ? {} : {sh: steps.sh + SH_BYTE})});
const same = (steps) => ({...steps, position: steps.position + 1e-6, covariance: steps.covariance + 1e-5, rgb: steps.rgb + 1e-5, alpha: steps.alpha + 1e-5,
  ...(steps.sh === undefined ? {} : {sh: steps.sh + 1e-5})});
const RDF = [1, 1, 1], RUB = [1, -1, -1], LUF = [-1, -1, 1];

// Ours: [file, options of convert, format, [[who, reads, axes of what is read, its rounding], ...]].
const WRITTEN = [
  ['ply', [], 'ply', [['three', readers.threePly, RDF, inBytes], ['splat-transform', readers.converter, RDF, same]]],
  ['compressed.ply', [], 'compressed.ply', [['splat-transform', readers.converter, RDF, same]]],
  ['splat', [], 'splat', [['three', readers.threeSplat, RDF, inBytes], ['splat-transform', readers.converter, RDF, same]]],
  ['3.spz', [], 'spz', [['three', readers.threeSpz, RUB, inBytes], ['spz-loader', readers.spzLoader, RUB, same], ['splat-transform', readers.converter, RUB, same]]],
  ['4.spz', ['--spz-version', '4'], 'spz', [['three', readers.threeSpz, RUB, inBytes], ['splat-transform', readers.converter, RUB, same]]],
  ['sog', [], 'sog', [['splat-transform', readers.converter, RDF, same]]],
  ['glb', [], 'glb', [['three', readers.threeGlb, LUF, inBytes]]],
  ['usda', [], 'glb', [['three', readers.threeUsda, RUB, same], ['tinyusdz', readers.tinyUsda, RUB, same]]],
];
// Theirs: [file, writes, format, highest degree, options of convert]. The converter stores the axes of a .ply in .spz.
const splatTransform = (...options) => async (ply, path) => readers.splatTransform(ply, path, options);
const THEIRS = [
  ['splat-transform', 'compressed.ply', splatTransform(), 'compressed.ply', 3],
  ['splat-transform', '3.spz', splatTransform('--spz-version', '3'), 'their spz', 3, ['--spz-axes', 'ply']],
  ['splat-transform', '4.spz', splatTransform('--spz-version', '4'), 'their spz', 3, ['--spz-axes', 'ply']],
  ['splat-transform', 'sog', splatTransform(), 'their sog', 3],
  ['splat-transform', 'glb', splatTransform(), 'glb', 3],
  ...[0, 1, 2].map((level) => ['gaussian-splats-3d', `${level}.ksplat`,
    async (ply, path, degree) => readers.writeKsplat(ply, path, level, degree), 'ksplat', 2]),
];

let faults = 0;
function say(degree, what, found) {
  faults += found.length;
  console.log(`${found.length ? 'DIFFERS' : 'same   '}  degree ${degree}  ${what}${found.length ? ': ' + found.join('; ') : ''}`);
}
async function judged(degree, what, judge) {
  try {
    say(degree, what, await judge());
  } catch (error) {
    say(degree, what, [String(error.message ?? error)]);
  }
}
function convert(from, to, options = []) {
  const end = spawnSync(program, ['convert', from, '-o', to, '--overwrite', '--quiet', ...options], {encoding: 'utf8'});
  if (end.status !== 0) throw new Error(end.stderr || String(end.error));
}

for (const degree of DEGREES) {
  const columns = knownRows(degree), known = readingOfColumns(columns), ply = `${folder}/known_${degree}.ply`;
  writeFileSync(ply, plyOf(columns, ['up 0 0 1']));  // which all but .splat carry on, and no reader stumbles over
  for (const [ending, options, format, judges] of WRITTEN) {
    const path = `${folder}/ours_${degree}.${ending}`;
    convert(ply, path, options);
    if (ending === 'glb') await judged(degree, 'our .glb is valid', () => readers.glbFaults(path));
    for (const [who, read, axes, rounding] of judges)
      await judged(degree, `our .${ending} read by ${who}`, async () =>
        differences(known, turned(await read(path), axes), rounding(STEPS[format])));
  }
  for (const [who, ending, write, format, highest, options] of THEIRS) {
    if (degree > highest) continue;
    const path = `${folder}/theirs_${degree}.${ending}`;
    await judged(degree, `.${ending} of ${who} read by us`, async () => {
      await write(ply, path, degree);
      convert(path, `${path}.ours.ply`, options);
      // Their palette merges spherical harmonics of so few Gaussians.
      const written = format === 'their sog' ? await readers.converter(path) : known;
      return differences(written, readingOfColumns(columnsOfPly(readFileSync(`${path}.ours.ply`))), same(STEPS[format]));
    });
  }
}
// Nobody here writes .lcc: one of our own making, as the converter reads it and as we do.
for (const degree of DEGREES.filter((d) => d % 3 === 0)) {
  mkdirSync(`${folder}/lcc_${degree}`);
  writeLcc(`${folder}/lcc_${degree}`, degree > 0);
  const path = `${folder}/lcc_${degree}/meta.lcc`;
  await judged(degree, '.lcc read by us and by splat-transform', async () => {
    convert(path, `${path}.ours.ply`);
    return differences(await readers.converter(path), readingOfColumns(columnsOfPly(readFileSync(`${path}.ours.ply`))), same(STEPS.lcc));
  });
}
// Nor .lcc2: pieces that the converter wrote, under a text of our own making, level by level.
for (const degree of DEGREES.filter((d) => d % 3 === 0))
  for (const [ending, options] of [['sog', []], ['3.spz', ['--spz-version', '3']], ['4.spz', ['--spz-version', '4']]]) {
    const below = `${folder}/lcc2_${degree}_${ending}`, coarse = 20, kind = ending.slice(-3);
    mkdirSync(below);
    const few = knownRows(degree).map(({name, values}) => ({name, values: values.slice(0, coarse)}));
    writeFileSync(`${below}/few.ply`, plyOf(few));
    readers.splatTransform(`${folder}/known_${degree}.ply`, `${below}/0.${kind}`, options);
    readers.splatTransform(`${below}/few.ply`, `${below}/1.${kind}`, options);
    writeLcc2(below, [`0.${kind}`, `1.${kind}`], [COUNT, coarse]);
    const path = `${below}/meta.lcc2`;
    for (const level of [0, 1])
      await judged(degree, `.lcc2 of .${ending}, level ${level}, read by us and by splat-transform`, async () => {
        convert(path, `${path}.ours.ply`, ['--lod', String(level)]);
        return differences(await readers.converter(path, ['-L', String(level)]), readingOfColumns(columnsOfPly(readFileSync(`${path}.ours.ply`))), same(STEPS.lcc));
      });
  }
// .rad of our own making, in every encoding that it has, and with the tree that Spark makes; as Spark reads it.
for (const degree of DEGREES)
  for (const variant of [0, 1, 2, 3, 4, 'a tree']) {
    const path = `${folder}/made_${degree}_${variant}.rad`, rows = radRowsOf(knownRows(degree));
    writeFileSync(path, radOf(rows, Number.isInteger(variant) ? variant : 1));
    await judged(degree, `.rad, encodings ${variant}, read by us and by Spark`, async () => {
      if (variant === 'a tree') {
        const [merged, tree] = await readers.sparkTree(path);
        writeFileSync(path, radOf(merged, 1, tree));
      }
      convert(path, `${path}.ours.ply`);
      const ours = readingOfColumns(columnsOfPly(readFileSync(`${path}.ours.ply`)));
      return ours.count === COUNT ? differences(await readers.spark(path), ours, STEPS.rad) : [`${ours.count} Gaussians`];
    });
  }
// The mark of antialiased training, there and back.
const MARK = 'SplatRenderMode: mip', marked = `${folder}/marked.ply`;
writeFileSync(marked, plyOf(knownRows(0), [MARK]));
for (const ending of ['ply', 'compressed.ply', '3.spz', 'sog']) {
  const ours = `${folder}/marked_ours.${ending}`, theirs = `${folder}/marked_theirs.${ending}`;
  await judged(0, `the mark in our .${ending} read by splat-transform`, async () => {
    convert(marked, ours);
    readers.splatTransform(ours, `${ours}.ply`);
    return readFileSync(`${ours}.ply`).includes(MARK) ? [] : ['it is lost'];
  });
  await judged(0, `the mark in .${ending} of splat-transform read by us`, async () => {
    readers.splatTransform(marked, theirs, ending === '3.spz' ? ['--spz-version', '3'] : []);
    const said = spawnSync(program, ['info', '--json', '--quiet', theirs], {encoding: 'utf8'});
    return JSON.parse(said.stdout).antialiased ? [] : ['it is lost'];
  });
}
console.log(faults ? `${faults} differences` : 'all the same');
process.exit(faults ? 1 : 0);
