// Starting the browser, and opening a page in it under watch.

import { createRequire } from 'node:module';
import path from 'node:path';
import { pathToFileURL } from 'node:url';

// Nothing of the browser's own may go to a network while the pages are watched.
const FLAGS = [
  '--no-sandbox',
  '--disable-gpu',
  '--disable-quic',
  '--no-first-run',
  '--disable-background-networking',
  '--disable-component-update',
  '--disable-sync',
];

// The room on a sheet of A4 at 96 pixels to the inch, within margins of 15 mm at the sides and 18 mm above and below.
export const A4 = { width: 680, height: 986 };
// The ways a page is looked at; half of them without a network.
export const VARIANTS = {
  light: { colorScheme: 'light', viewport: { width: 1200, height: 900 } },
  dark: { colorScheme: 'dark', viewport: { width: 1200, height: 900 }, offline: true },
  narrow: { colorScheme: 'light', viewport: { width: 400, height: 800 }, offline: true },
  print: { colorScheme: 'light', viewport: A4, offline: true, media: 'print' },
};

/** The installed packages and a running browser; the profile is new, empty and removed at the end. */
export async function start({ modules, chromium }) {
  const load = createRequire(path.join(path.resolve(modules), 'package.json'));
  const axe = load.resolve('axe-core/axe.min.js');
  const browser = await load('playwright-core').chromium.launch({ executablePath: chromium, args: FLAGS });
  return { browser, axe };
}

/**
 * Opens a file in one of the VARIANTS and gives its page with the list of faults that grows while it is open: requests,
 * messages on the console, errors of scripts.
 */
export async function open(browser, file, variant) {
  const { media, ...options } = VARIANTS[variant];
  const context = await browser.newContext({ ...options, deviceScaleFactor: 1, reducedMotion: 'reduce' });
  const faults = [];
  const own = pathToFileURL(path.resolve(file)).href;
  const note = (kind, text) => faults.push({ kind, text: String(text).slice(0, 300) });
  await context.route('**/*', (route) => {
    const url = route.request().url();
    if (url === own || url.startsWith('data:')) {
      return route.continue();
    }
    note('request', url);
    return route.abort();
  });
  // Taken over in the page: the browser itself would tell only of a socket whose other end was found.
  await context.routeWebSocket(/^/, (socket) => {
    note('request', socket.url());
    socket.close();
  });
  const page = await context.newPage();
  page.on('popup', (popup) => note('request', popup.url()));
  page.on('pageerror', (error) => note('script', error.message));
  page.on('console', (message) => {
    if (['error', 'warning'].includes(message.type())) {
      note('console', message.text());
    }
  });
  if (media) {
    await page.emulateMedia({ media, colorScheme: options.colorScheme });
  }
  await page.goto(own, { waitUntil: 'load' });
  return { context, page, faults };
}
