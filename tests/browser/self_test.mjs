// Shows that the checks can fail: a good page has no fault, and each broken twin of it has the one it was given.
//
//     node self_test.mjs --modules DIR --chromium PROGRAM --scratch DIR

import { mkdir, writeFile } from 'node:fs/promises';
import path from 'node:path';
import { start } from './browser.mjs';
import { checkPage, eachOf, options, within } from './page_check.mjs';

const GOOD = `<!doctype html>
<html lang="en">
<head>
<meta charset="utf-8">
<meta name="viewport" content="width=device-width, initial-scale=1">
<title>A good page</title>
<style>
:root { color-scheme: light dark; }
body { margin: 0; background: #fff; color: #222; font: 16px sans-serif; }
svg { display: block; width: 100%; height: auto; }
svg text { font-size: 11px; fill: #333; }
svg path { fill: none; stroke: #06c; stroke-width: 2; }
figure { margin: 0; break-inside: avoid; }
@media (prefers-color-scheme: dark) {
  body { background: #111; color: #eee; }
  svg text { fill: #ddd; }
}
</style>
</head>
<body>
<main>
<h1>A good page</h1>
<img src="data:image/gif;base64,R0lGODlhAQABAIAAAAAAAP///yH5BAEAAAAALAAAAAABAAEAAAIBRAA7" alt="a dot">
<figure>
<svg viewBox="0 0 400 200" role="img" aria-label="a line">
<text x="10" y="20">level</text>
<path d="M40 180 L390 40"/>
</svg>
<figcaption>A line.</figcaption>
</figure>
</main>
</body>
</html>
`;

// Put together here: a page must ask for something outside, but no address stands in the sources.
const outside = (scheme, file) => [`${scheme}:`, '', 'nowhere', file].join('/');
const body = (html) => ['</main>', `${html}</main>`];
const css = (rules) => ['</style>', `${rules}</style>`];

/** Name, the kind of fault that must be found, where, and how the good page is broken: text and its replacement. */
const BROKEN = [
  ['no-alt', 'image-alt', 'light', [' alt="a dot"', '']],
  ['no-picture-name', 'svg-img-alt', 'light', [' aria-label="a line"', '']],
  ['no-language', 'html-has-lang', 'light', [' lang="en"', '']],
  ['no-landmark', 'region', 'light', [/<(\/?)main>/g, '<$1div>']],
  ['pale', 'color-contrast', 'light', css('h1 { color: #bbb; }')],
  ['pale-in-the-dark', 'color-contrast', 'dark', css('h1 { color: #222; }')],
  ['pale-in-print', 'color-contrast', 'print', css('@media print { h1 { color: #bbb; } }')],
  ['no-contrast-known', 'color-contrast', 'light', css('h1 { background: linear-gradient(#fff, #000); }')],
  ['pale-label', 'picture-contrast', 'light', css('svg text { fill: #bbb; }')],
  ['pale-label-in-the-dark', 'picture-contrast', 'dark', css('svg text { fill: #222 !important; }')],
  ['label-on-a-band', 'picture-contrast', 'light', ['<text', '<rect width="200" height="60" fill="#444"/><text']],
  ['faint-group', 'picture-contrast', 'light', ['<text x="10" y="20">level</text>', '<g opacity="0.3"><text x="10" y="20">level</text></g>']],
  ['label-in-a-nested-picture', 'picture-contrast', 'light', ['<text x="10" y="20">level</text>', '<rect width="200" height="60" fill="#444"/><svg><text x="10" y="20">level</text></svg>']],
  ['faint-line', 'line-contrast', 'light', css('svg path { stroke: #bbd; }')],
  ['faint-line-in-the-dark', 'line-contrast', 'dark', css('svg path { stroke: #024; }')],
  ['picture-from-outside', 'request', 'light', body(`<img alt="" src="${outside('http', 'x.png')}">`)],
  ['picture-from-beside', 'request', 'light', body('<img alt="" src="beside.png">')],
  ['style-from-outside', 'request', 'light', css(`h1 { background-image: url(${outside('https', 'x.png')}); }`)],
  ['script-asks', 'request', 'light', body(`<script>fetch('${outside('http', 'x')}').catch(() => 0)</script>`)],
  ['offline-asks', 'request', 'dark', body(`<script>fetch('${outside('http', 'x')}').catch(() => 0)</script>`)],
  ['socket', 'request', 'light', body(`<script>new WebSocket('${outside('ws', 'x')}')</script>`)],
  ['connects-early', 'reference', 'light', ['<title>', `<link rel="preconnect" href="${outside('http', '')}"><title>`]],
  ['leads-outside', 'reference', 'light', body(`<a href="${outside('http', 'x')}">x</a>`)],
  ['complains', 'console', 'light', body('<script>console.error("no")</script>')],
  ['throws', 'script', 'light', body('<script>throw new Error("no")</script>')],
  ['too-wide', 'overflow', 'narrow', body('<div style="width: 600px">wide</div>')],
  ['small-letters', 'small-text', 'narrow', ['0 0 400 200', '0 0 600 300']],
  ['cut-label', 'cut-text', 'narrow', ['x="10"', 'x="-30"']],
  ['labels-collide', 'overlap', 'light', ['<path', '<text x="20" y="22">other</text><path']],
  ['small-chart', 'narrow-chart', 'narrow', ['M40 180 L390 40', 'M40 180 L200 40']],
  ['no-figure', 'figure', 'narrow', [/<(\/?)figure>/g, '<$1div>']],
  ['divided-figure', 'cut-figure', 'print', ['break-inside: avoid', '']],
  ['tall-figure', 'cut-figure', 'print', ['0 0 400 200', '0 0 400 800']],
  ['wide-on-paper', 'print-overflow', 'print', body('<div style="width: 900px">wide</div>')],
  ['empty-sheets', 'sheets', 'print', body('<p style="break-before: page">1<p style="break-before: page">2'.repeat(3))],
];

const { scratch, ...named } = options(process.argv.slice(2));
await mkdir(scratch, { recursive: true });
const write = async (name, text) => {
  const file = path.join(scratch, `${name}.html`);
  await writeFile(file, text);
  return file;
};
const tools = await start(named);
const wrong = [];
try {
  const good = await checkPage(tools, await write('good', GOOD));
  wrong.push(...good.faults.map(({ kind, text }) => `the good page has the fault ${kind}: ${text}`));
  await eachOf(BROKEN, 2, async ([name, kind, variant, [from, to]]) => {
    const text = GOOD.replace(from, to);
    if (text === GOOD) {
      wrong.push(`${name}: the page is not broken`);
      return;
    }
    const { faults } = await within(300, name, checkPage(tools, await write(name, text), { only: [variant] }));
    if (!faults.some((fault) => fault.kind === kind)) {
      wrong.push(`${name}: no fault ${kind} in ${variant}; found: ${faults.map((f) => f.kind).join(', ') || 'none'}`);
    }
  });
} finally {
  await tools.browser.close();
}
console.log(wrong.length === 0 ? `self-test: all ${BROKEN.length} faults are found` : wrong.join('\n'));
process.exitCode = wrong.length === 0 ? 0 : 1;
