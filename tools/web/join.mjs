// usage: node join.mjs PAGE SCRIPT OUT: the page with the script that holds the WebAssembly (CMakeLists.txt).
import { readFileSync, writeFileSync } from 'node:fs';

const [page, script, out] = process.argv.slice(2);
const place = '/* weft */';
const frame = readFileSync(page, 'utf8');
const weft = readFileSync(script, 'utf8');
if (!frame.includes(place) || weft.includes('</script')) throw new Error(`${script} does not go into ${page}`);
writeFileSync(out, frame.replace(place, () => weft));
