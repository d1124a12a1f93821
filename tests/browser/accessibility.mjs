// Accessibility: all default rules of axe-core, and the contrast of what is in pictures, which axe-core leaves open.

/** The faults of an open page. */
export async function accessibility(page, axe) {
  await page.addScriptTag({ path: axe });
  const found = await page.evaluate(async () => {
    const result = await window.axe.run(document, {
      resultTypes: ['violations', 'incomplete'],
      // On by default; named so that no later default turns it off.
      rules: { 'color-contrast': { enabled: true } },
    });
    const lines = (rule, node) => ({ id: rule.id, target: node.target.join(' '), help: rule.help });
    const open = result.incomplete.filter((rule) => rule.id === 'color-contrast');
    // What is scrolled out of sight has no background where it stands; other widths and the print show it. Text in
    // pictures is computed below instead.
    const elsewhere = (node) => {
      const element = document.querySelector(node.target[0]);
      const box = element.getBoundingClientRect();
      for (let at = element.parentElement; at && at !== document.body; at = at.parentElement) {
        const { overflowX, overflowY } = getComputedStyle(at);
        const edge = at.getBoundingClientRect();
        const scrolls = (overflow) => ['auto', 'scroll'].includes(overflow);
        if (scrolls(overflowX) && (box.right > edge.right || box.left < edge.left)) {
          return true;
        }
        if (scrolls(overflowY) && (box.bottom > edge.bottom || box.top < edge.top)) {
          return true;
        }
      }
      return element.closest('svg') !== null;
    };
    return {
      rules: result.passes.length + result.violations.length + result.inapplicable.length,
      violations: result.violations.flatMap((rule) => rule.nodes.map((node) => lines(rule, node))),
      incomplete: open.flatMap((rule) => rule.nodes.filter((n) => !elsewhere(n)).map((n) => lines(rule, n))),
    };
  });
  const faults = found.violations.map(({ id, target, help }) => ({ kind: id, text: `${target}: ${help}` }));
  for (const { id, target } of found.incomplete) {
    faults.push({ kind: id, text: `${target}: contrast cannot be computed` });
  }
  if (found.rules < 50) {
    faults.push({ kind: 'axe', text: `only ${found.rules} rules were run` });
  }
  faults.push(...(await page.evaluate(pictureContrast)));
  return faults;
}

/** Runs in the page: texts and thick lines in pictures with less contrast than WCAG 2 AA asks for (1.4.3, 1.4.11). */
function pictureContrast() {
  const canvas = new OffscreenCanvas(1, 1).getContext('2d', { willReadFrequently: true });
  /** Any CSS colour as red, green, blue, opacity, each 0 to 1; null when it is no colour. */
  const parse = (text) => {
    if (!CSS.supports('color', text)) {
      return null;
    }
    canvas.clearRect(0, 0, 1, 1);
    canvas.fillStyle = text;
    canvas.fillRect(0, 0, 1, 1);
    return [...canvas.getImageData(0, 0, 1, 1).data].map((x) => x / 255);
  };
  const over = (top, below, opacity) => {
    const a = top[3] * opacity;
    return [0, 1, 2].map((i) => top[i] * a + below[i] * (1 - a)).concat(1);
  };
  const linear = (x) => (x <= 0.04045 ? x / 12.92 : ((x + 0.055) / 1.055) ** 2.4);
  const luminance = ([r, g, b]) => 0.2126 * linear(r) + 0.7152 * linear(g) + 0.0722 * linear(b);
  const ratio = (a, b) => {
    const [high, low] = [luminance(a), luminance(b)].sort((x, y) => y - x);
    return (high + 0.05) / (low + 0.05);
  };
  /** The opacity that an element has through its parents, up to the page. */
  const opacity = (element) => {
    let product = 1;
    for (let at = element; at; at = at.parentElement) {
      product *= Number(getComputedStyle(at).opacity);
    }
    return product;
  };
  const shown = (element) => element.checkVisibility({ visibilityProperty: true });

  /** What lies behind a picture: the backgrounds of what it stands in, from the page inwards. */
  const behind = (svg) => {
    const chain = [];
    for (let at = svg; at; at = at.parentElement) {
      chain.unshift(at);
    }
    const scheme = getComputedStyle(document.documentElement).colorScheme;
    const paper = scheme.includes('dark') && matchMedia('(prefers-color-scheme: dark)').matches ? 'Canvas' : 'white';
    const start = parse(paper) ?? [1, 1, 1, 1];
    return chain.reduce((below, e) => over(parse(getComputedStyle(e).backgroundColor) ?? [0, 0, 0, 0], below, 1), start);
  };
  /** The picture that an element is in, with all that it is nested in. */
  const picture = (element) => {
    let svg = element.ownerSVGElement;
    while (svg.ownerSVGElement) {
      svg = svg.ownerSVGElement;
    }
    return svg;
  };
  /** The colour below a point of the screen: filled shapes of these kinds in the picture, painted before `element`. */
  const below = (element, shapes, x, y) => {
    const svg = picture(element);
    let colour = behind(svg);
    for (const shape of svg.querySelectorAll(shapes)) {
      const first = shape.compareDocumentPosition(element) & Node.DOCUMENT_POSITION_FOLLOWING;
      const matrix = shape.getScreenCTM();
      if (!first || !matrix || !shown(shape) || shape.closest('defs, clipPath, mask, pattern, symbol')) {
        continue;
      }
      const style = getComputedStyle(shape);
      const fill = style.fill === 'none' ? null : parse(style.fill);
      if (fill && shape.isPointInFill(new DOMPoint(x, y).matrixTransform(matrix.inverse()))) {
        colour = over(fill, colour, Number(style.fillOpacity) * opacity(shape));
      }
    }
    return colour;
  };

  const faults = [];
  for (const text of document.querySelectorAll('svg text')) {
    const box = text.getBoundingClientRect();
    if (!shown(text) || box.width === 0 || text.textContent.trim() === '') {
      continue;
    }
    const style = getComputedStyle(text);
    const fill = parse(style.fill);
    const words = text.textContent.trim().slice(0, 40);
    if (!fill) {
      faults.push({ kind: 'picture-contrast', text: `"${words}": fill ${style.fill} is no plain colour` });
      continue;
    }
    const matrix = text.getScreenCTM();
    const size = Number.parseFloat(style.fontSize) * Math.sqrt(Math.abs(matrix.a * matrix.d - matrix.b * matrix.c));
    const large = size >= 24 || (size >= 18.66 && Number(style.fontWeight) >= 700);
    // At both ends and in the middle: a label may reach over the edge of a band.
    for (const at of [0.05, 0.5, 0.95]) {
      const ground = below(text, 'rect, path, polygon, circle, ellipse', box.left + at * box.width, box.top + box.height / 2);
      const got = ratio(over(fill, ground, Number(style.fillOpacity) * opacity(text)), ground);
      if (got < (large ? 3 : 4.5)) {
        faults.push({ kind: 'picture-contrast', text: `"${words}": contrast ${got.toFixed(2)}` });
        break;
      }
    }
  }
  // A thick line is a signal or its key in the legend; thin ones are grid, axes and marks.
  for (const line of document.querySelectorAll('svg path, svg polyline, svg line')) {
    const style = getComputedStyle(line);
    const stroke = style.stroke === 'none' ? null : parse(style.stroke);
    const matrix = line.getScreenCTM();
    const thick = Number.parseFloat(style.strokeWidth) >= 1.5;
    if (!stroke || !matrix || !thick || !shown(line) || line.closest('defs, clipPath') || line.getTotalLength() === 0) {
      continue;
    }
    const start = line.getPointAtLength(0).matrixTransform(matrix);
    // On the paper: the filled paths are signals themselves, often the envelope of this very line.
    const ground = below(line, 'rect', start.x, start.y);
    const got = ratio(over(stroke, ground, Number(style.strokeOpacity) * opacity(line)), ground);
    if (got < 3) {
      faults.push({ kind: 'line-contrast', text: `a line of colour ${style.stroke}: contrast ${got.toFixed(2)}` });
    }
  }
  return faults;
}
