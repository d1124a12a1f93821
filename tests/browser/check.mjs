// Checks report pages: node check.mjs --modules DIR --chromium PROGRAM --shots DIR PAGE.html ...
// Exit code 1 when a page has a fault.

import { mkdir, stat } from 'node:fs/promises';
import { start } from './browser.mjs';
import { checkPage, eachOf, options, within } from './page_check.mjs';

/** Faults that are shown of one page: the first ones say what to repair. */
const SHOWN = 20;

const { rest: pages, ...named } = options(process.argv.slice(2));
if (pages.length === 0) {
  throw new Error('no page to check');
}
await mkdir(named.shots, { recursive: true });
const tools = await start(named);
let count = 0;
try {
  const results = await eachOf(pages, 2, (page) => within(600, page, checkPage(tools, page, named)));
  for (const [at, { name, faults, sheets, load }] of results.entries()) {
    const { size } = await stat(pages[at]);
    console.log(`${name}: ${(size / 1000).toFixed(0)} kB, loads in ${load.toFixed(0)} ms, ${sheets} sheets of A4`);
    for (const { kind, text, variants } of faults.slice(0, SHOWN)) {
      console.log(`  ${kind} (${variants.join(', ')}): ${text}`);
    }
    if (faults.length > SHOWN) {
      console.log(`  and ${faults.length - SHOWN} more`);
    }
    count += faults.length;
  }
} finally {
  await tools.browser.close();
}
console.log(count === 0 ? `${pages.length} pages without a fault` : `${count} faults`);
process.exitCode = count === 0 ? 0 : 1;
