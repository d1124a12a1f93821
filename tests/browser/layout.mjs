// Layout: nothing wider than the screen, pictures that can be read on a phone, no figure cut in print.

/** Smallest height of letters in a picture [CSS px]. */
const LEAST_TEXT = 9;
/** Smallest share of the screen's width for the curves of the main figure. */
const LEAST_CHART = 0.6;

/** The faults of a page on a screen of 400 px. */
export function narrow(page) {
  return page.evaluate(
    ({ leastText, leastChart }) => {
      const faults = [];
      const width = document.documentElement.clientWidth;
      const wide = Math.max(document.documentElement.scrollWidth, document.body.scrollWidth);
      if (wide > width) {
        const guilty = [...document.body.querySelectorAll('*')].filter((e) => e.getBoundingClientRect().right > width + 0.5);
        const names = guilty.slice(0, 3).map((e) => e.tagName.toLowerCase() + (e.id && `#${e.id}`));
        faults.push({ kind: 'overflow', text: `${wide} px on a screen of ${width} px: ${names.join(', ')}` });
      }
      const shown = (e) => e.checkVisibility({ visibilityProperty: true }) && e.getBoundingClientRect().width > 0;
      const figures = [...document.querySelectorAll('figure')].filter((f) => [...f.querySelectorAll('svg')].some(shown));
      if (figures.length === 0) {
        return [...faults, { kind: 'figure', text: 'no figure with a picture' }];
      }
      for (const text of document.querySelectorAll('svg text')) {
        if (!shown(text) || text.textContent.trim() === '') {
          continue;
        }
        const m = text.getScreenCTM();
        const scale = Math.sqrt(Math.abs(m.a * m.d - m.b * m.c));
        const size = Number.parseFloat(getComputedStyle(text).fontSize) * scale;
        const box = text.getBoundingClientRect();
        const words = `"${text.textContent.trim().slice(0, 40)}"`;
        if (size < leastText - 0.01) {
          faults.push({ kind: 'small-text', text: `${words} is ${size.toFixed(1)} px tall` });
        }
        if (box.left < -0.5 || box.right > width + 0.5) {
          faults.push({ kind: 'cut-text', text: `${words} from ${box.left.toFixed(0)} to ${box.right.toFixed(0)} px` });
        }
      }
      // The curves go from one end of the time axis to the other: the widest line is as wide as the chart.
      const lines = [...figures[0].querySelectorAll('svg path, svg polyline, svg line')];
      const boxes = lines.filter((l) => l.checkVisibility() && !l.closest('defs, clipPath')).map((l) => l.getBoundingClientRect());
      const chart = Math.max(0, ...boxes.map((b) => Math.min(b.right, width) - Math.max(b.left, 0)));
      if (chart < leastChart * width) {
        faults.push({ kind: 'narrow-chart', text: `the chart is ${chart.toFixed(0)} px wide of ${width} px` });
      }
      return faults;
    },
    { leastText: LEAST_TEXT, leastChart: LEAST_CHART },
  );
}

/** Labels in pictures that are written over each other. */
export function overlaps(page) {
  return page.evaluate(() => {
    const shown = (e) => e.checkVisibility({ visibilityProperty: true }) && e.textContent.trim() !== '';
    // The box of a text has room for accents and descenders: letters meet only when boxes overlap by more than that.
    const boxes = [...document.querySelectorAll('svg text')].filter(shown).map((e) => {
      const { left, right, top, bottom } = e.getBoundingClientRect();
      const slack = 0.15 * (bottom - top);
      return { words: e.textContent.trim(), left: left + 1, right: right - 1, top: top + slack, bottom: bottom - slack };
    });
    const faults = [];
    boxes.forEach((a, at) => {
      for (const b of boxes.slice(at + 1)) {
        if (a.left < b.right && b.left < a.right && a.top < b.bottom && b.top < a.bottom) {
          faults.push({ kind: 'overlap', text: `"${a.words.slice(0, 40)}" and "${b.words.slice(0, 40)}"` });
        }
      }
    });
    return faults;
  });
}

/** The faults of a page in print; `paper` is the room on a sheet [CSS px]. Writes the document to `pdf`, if given. */
export async function print(page, paper, pdf) {
  const { faults, height } = await page.evaluate((sheet) => {
    const blocks = [...document.querySelectorAll('figure')].filter((f) => f.getBoundingClientRect().height > 0);
    const found = [];
    blocks.forEach((figure, at) => {
      const name = `figure ${at + 1}`;
      if (!getComputedStyle(figure).breakInside.startsWith('avoid')) {
        found.push({ kind: 'cut-figure', text: `${name} may be divided between two sheets` });
      }
      const tall = figure.getBoundingClientRect().height;
      if (tall > sheet.height) {
        found.push({ kind: 'cut-figure', text: `${name} is ${tall.toFixed(0)} px tall, a sheet ${sheet.height} px` });
      }
    });
    const wide = document.documentElement.scrollWidth;
    if (wide > document.documentElement.clientWidth) {
      found.push({ kind: 'print-overflow', text: `${wide} px on a sheet of ${sheet.width} px: all of it is shrunk` });
    }
    return { faults: found, height: document.documentElement.scrollHeight };
  }, paper);
  const margin = { left: '15mm', right: '15mm', top: '18mm', bottom: '18mm' };
  const bytes = await page.pdf({ format: 'A4', printBackground: true, margin, ...(pdf && { path: pdf }) });
  const sheets = (bytes.toString('latin1').match(/\/Type\s*\/Page\b(?!s)/g) ?? []).length;
  // A block that moves to the next sheet leaves less room behind than its own height: twice the height is the most.
  const most = Math.ceil((2 * height) / paper.height) + 1;
  if (sheets < 1 || sheets > most) {
    faults.push({ kind: 'sheets', text: `${sheets} sheets of paper; expected 1 to ${most}` });
  }
  return { faults, sheets };
}

/** Places in the page that name something outside of it, whether it is asked for already or not. */
export function references(page) {
  return page.evaluate(() => {
    const inside = (value) => /^\s*(#|data:|$)/i.test(value);
    const faults = [];
    const note = (element, value) =>
      faults.push({ kind: 'reference', text: `${element.tagName.toLowerCase()}: ${value.slice(0, 80)}` });
    for (const element of document.querySelectorAll('*')) {
      for (const name of ['src', 'srcset', 'href', 'xlink:href', 'poster', 'data', 'action', 'formaction', 'background', 'ping']) {
        const value = element.getAttribute(name);
        // A link that a person follows asks for nothing by itself; it may lead to a file beside the page.
        const link = element.localName === 'a' && name === 'href';
        const outside = link ? /^\s*([a-z][a-z0-9+.-]*:)?\/\//i.test(value ?? '') : !inside(value ?? '');
        if (value !== null && outside) {
          note(element, value);
        }
      }
      const style = (element.localName === 'style' ? element.textContent : '') + (element.getAttribute('style') ?? '');
      for (const [, value] of style.matchAll(/(?:@import|url\()\s*['"]?([^'")\s]*)/gi)) {
        if (!inside(value) || value === '') {
          note(element, value);
        }
      }
      if (element.localName === 'meta' && /refresh/i.test(element.httpEquiv)) {
        note(element, element.content);
      }
    }
    return faults;
  });
}
