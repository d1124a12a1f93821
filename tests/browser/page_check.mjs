// All checks of one page.

import path from 'node:path';
import { accessibility } from './accessibility.mjs';
import { A4, open, VARIANTS } from './browser.mjs';
import { narrow, overlaps, print, references } from './layout.mjs';

/**
 * Opens `file` in every variant, or in those of `only`, and gives its faults, each with the variants it was seen in.
 * With `shots` (a folder) screenshots go there, and the printed document.
 */
export async function checkPage({ browser, axe }, file, { shots, only } = {}) {
  const name = path.basename(file, '.html');
  const faults = new Map();
  const facts = { sheets: 0, load: 0 };
  for (const variant of only ?? Object.keys(VARIANTS)) {
    const { context, page, faults: seen } = await open(browser, file, variant);
    try {
      const found = [...(await references(page)), ...(await overlaps(page))];
      if (variant === 'light') {
        facts.load = await page.evaluate(() => performance.getEntriesByType('navigation')[0].duration);
      }
      if (shots) {
        await page.screenshot({ path: path.join(shots, `${name}-${variant}.png`), fullPage: true });
      }
      if (variant === 'narrow') {
        found.push(...(await narrow(page)));
      }
      if (variant === 'print') {
        const printed = await print(page, A4, shots && path.join(shots, `${name}.pdf`));
        found.push(...printed.faults);
        facts.sheets = printed.sheets;
      }
      // Last: it adds a script to the page.
      found.push(...(await accessibility(page, axe)));
      for (const { kind, text } of [...seen, ...found]) {
        const key = `${kind}: ${text}`;
        const entry = faults.get(key) ?? { kind, text, variants: [] };
        entry.variants = [...new Set([...entry.variants, variant])];
        faults.set(key, entry);
      }
    } finally {
      await context.close();
    }
  }
  return { name, faults: [...faults.values()], ...facts };
}

/** The answer of `work`, or an error when it takes longer than `seconds`: a script of a page may never end. */
export async function within(seconds, what, work) {
  let timer;
  const late = new Promise((_, reject) => {
    timer = setTimeout(() => reject(new Error(`${what} took more than ${seconds} s`)), seconds * 1000);
  });
  return Promise.race([work, late]).finally(() => clearTimeout(timer));
}

/** Calls `work` with every item, `width` of them at a time; the answers in the order of the items. */
export async function eachOf(items, width, work) {
  const answers = new Array(items.length);
  let next = 0;
  const lane = async () => {
    while (next < items.length) {
      const at = next++;
      answers[at] = await work(items[at]);
    }
  };
  await Promise.all(Array.from({ length: Math.min(width, items.length) }, lane));
  return answers;
}

/** The options of a command line `--name value ... rest`. */
export function options(argv) {
  const named = {};
  const rest = [];
  for (let at = 0; at < argv.length; at++) {
    if (argv[at].startsWith('--')) {
      named[argv[at].slice(2)] = argv[++at];
    } else {
      rest.push(argv[at]);
    }
  }
  return { ...named, rest };
}
