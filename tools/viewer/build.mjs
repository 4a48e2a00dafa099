// Makes two pages of their sources, each one file that needs no other: page.html, and ../web/page.html, which has
// a place for weft itself. `node build.mjs --check` fails if they are not what the sources give.
import { build } from 'esbuild';
import { readFileSync, writeFileSync } from 'node:fs';
import { fileURLToPath } from 'node:url';

const pathOf = (name) => fileURLToPath(new URL(name, import.meta.url));
const read = (name) => readFileSync(pathOf(name), 'utf8');
const put = (page, place, text) => page.replace(place, () => text);

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
  return put(framed, '/* script */', script);
}

for (const folder of ['.', '../web']) {
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
