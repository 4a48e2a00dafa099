// Makes page.html of source/: one file that needs no other. `node build.mjs --check` fails if page.html is
// not what source/ gives.
import { build } from 'esbuild';
import { readFileSync, writeFileSync } from 'node:fs';

const read = (name) => readFileSync(new URL(name, import.meta.url), 'utf8');

const bundled = await build({
  entryPoints: [new URL('source/main.js', import.meta.url).pathname],
  bundle: true, minify: true, format: 'iife', target: 'es2022', charset: 'ascii', legalComments: 'none', write: false,
});
const styled = await build({
  stdin: { contents: read('source/style.css'), loader: 'css' }, minify: true, target: 'es2022', write: false,
});
const licence = read('LICENSE.three').trim();
const script = `/*\nthis page contains three.js:\n\n${licence}\n*/\n${bundled.outputFiles[0].text.trim()}`;
const put = (page, place, text) => page.replace(place, () => text);
let page = read('source/page.html');
page = put(page, '/* style */', styled.outputFiles[0].text.trim());
page = put(page, '/* script */', script);
if (page.includes(')page_of_weft"')) throw new Error('the page ends the string of C++ that it becomes');

if (process.argv.includes('--check')) {
  if (read('page.html') !== page) throw new Error('page.html is not what source/ gives: run `npm run build`');
} else {
  writeFileSync(new URL('page.html', import.meta.url), page);
}
console.log(`page.html: ${(page.length / 1e3).toFixed(0)} kB`);
