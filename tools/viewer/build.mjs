// Makes two pages of their sources, each one file that needs no other: page.html, and ../web/page.html, which has
// a place for weft itself. Each ends with a hash of all sources and of itself, which the test tools/viewer/pages
// compares: it needs no npm. `node build.mjs --check` makes the pages anew, and fails if they are others.
import { build } from 'esbuild';
import { createHash } from 'node:crypto';
import { readFileSync, readdirSync, writeFileSync } from 'node:fs';
import { fileURLToPath } from 'node:url';

const pathOf = (name) => fileURLToPath(new URL(name, import.meta.url));
const read = (name) => readFileSync(pathOf(name), 'utf8');
const put = (page, place, text) => page.replace(place, () => text);

const FOLDERS = ['.', '../web'];

function sealed(page) {
  const sources = FOLDERS.flatMap((folder) => readdirSync(pathOf(`${folder}/source`)).sort()
    .map((name) => `${folder}/source/${name}`));
  const hash = createHash('sha256');
  for (const name of ['build.mjs', 'package-lock.json', 'LICENSE.three', ...sources]) hash.update(read(name));
  return `${page}<!-- sources and page: ${hash.update(page).digest('hex')} -->\n`;
}

async function pageOf(folder) {
  const options = { bundle: true, minify: true, target: 'es2022', write: false };
  const bundled = await build({
    ...options, entryPoints: [pathOf(`${folder}/source/main.js`)], format: 'iife', charset: 'ascii',
    legalComments: 'none', nodePaths: [pathOf('node_modules')],
  });
  const styled = await build({ ...options, entryPoints: [pathOf(`${folder}/source/style.css`)] });
  const licence = read('LICENSE.three').trim();
  const script = `/*\nthis page contains three.js:\n\n${licence}\n*/\n${bundled.outputFiles[0].text.trim()}`;
  const framed = put(read(`${folder}/source/page.html`), '/* style */', styled.outputFiles[0].text.trim());
  return sealed(put(framed, '/* script */', script));
}

for (const folder of FOLDERS) {
  const page = await pageOf(folder);
  const name = `${folder}/page.html`;
  if (folder === '.' && page.includes(')page_of_weft"')) throw new Error('the page ends the string of C++ that it becomes');
  if (!process.argv.includes('--check')) {
    writeFileSync(pathOf(name), page);
  } else if (read(name) !== page) {
    throw new Error(`${name} is not what its sources give: run \`npm run build\``);
  }
  console.log(`${name}: ${(page.length / 1e3).toFixed(0)} kB`);
}
