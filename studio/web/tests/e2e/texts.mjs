// Measures every text of the page: cut, over another text, outside of its card, or too small. It runs in the page.

/** The faults of all visible texts, in words. least: pixels of letters. */
export const faultsOfTexts = (least = 9.95) => {
  const found = [];
  const round = (value) => value.toFixed(1);
  const texts = [];
  const scrolls = (style) => /auto|scroll/.test(style.overflowX + style.overflowY);
  // Texts that a list or form has scrolled out of sight are reached by scrolling.
  const isScrolledAway = (owner, line) => {
    for (let around = owner; around && around !== document.body; around = around.parentElement) {
      if (!scrolls(getComputedStyle(around))) continue;
      const frame = around.getBoundingClientRect();
      if (line.bottom > frame.bottom + 1 || line.top < frame.top - 1 || line.left > frame.right || line.right < frame.left)
        return true;
    }
    return false;
  };
  const walk = document.createTreeWalker(document.body, NodeFilter.SHOW_TEXT);
  const range = document.createRange();
  while (walk.nextNode()) {
    const words = walk.currentNode.textContent.trim();
    const owner = walk.currentNode.parentElement;
    if (!words || owner.closest("script, style, title, select, .cm-measure, .visually-hidden")) continue;
    // The name of a button that shows only its icon.
    if (getComputedStyle(owner).clipPath === "inset(50%)") continue;
    if (!owner.checkVisibility({ opacityProperty: true, visibilityProperty: true })) continue;
    range.selectNodeContents(walk.currentNode);
    const lines = [...range.getClientRects()].filter(({ width, height }) => width > 0.5 && height > 0.5);
    const boxes = lines.filter((line) => !isScrolledAway(owner, line));
    if (boxes.length > 0) texts.push({ owner, words: words.slice(0, 50), boxes });
  }
  const drawing = document.querySelector(".react-flow__viewport");
  const zoom = drawing ? new DOMMatrix(getComputedStyle(drawing).transform).a : 1;
  for (const { owner, words, boxes } of texts) {
    const inDrawing = owner.closest(".react-flow__viewport");
    const matrix = owner instanceof SVGGraphicsElement ? owner.getScreenCTM() : null;
    const scale = matrix ? Math.hypot(matrix.a, matrix.b) : inDrawing ? zoom : 1;
    const size = parseFloat(getComputedStyle(owner).fontSize) * scale;
    if (size < least) found.push(`${round(size)} px: ${words}`);
    // The window of the drawing ends anywhere; what scrolls is reached.
    for (let around = owner; around && !around.matches(".react-flow, body"); around = around.parentElement) {
      const { overflowX, textOverflow } = getComputedStyle(around);
      if (scrolls(getComputedStyle(around))) break;
      if (overflowX === "visible") continue;
      const frame = around.getBoundingClientRect();
      const beyond = boxes.some(
        (box) => box.right > frame.right + 1 || box.left < frame.left - 1 || box.bottom > frame.bottom + 2,
      );
      if (beyond || (textOverflow === "ellipsis" && around.scrollWidth > around.clientWidth + 1)) {
        found.push(`cut: ${words} in ${around.className || around.tagName}`);
        break;
      }
    }
    const card =
      inDrawing && owner.closest(".chip, .device-box, .subsystem-box, .agent-box, .channel-label span, .channel-label");
    if (card) {
      const frame = card.getBoundingClientRect();
      const out = boxes.some(
        (box) =>
          box.left < frame.left - 0.5 ||
          box.right > frame.right + 0.5 ||
          box.top < frame.top - 1 ||
          box.bottom > frame.bottom + 1,
      );
      if (out) found.push(`outside of its ${card.className}: ${words}`);
    }
  }
  // Legends and buttons lie over the drawing; texts of one layer may not overlap.
  const layers = [texts.filter(({ owner }) => owner.closest(".react-flow__viewport"))];
  layers.push(texts.filter(({ owner }) => !owner.closest(".react-flow__viewport, .cm-editor, dialog")));
  for (const layer of layers) {
    const all = layer.flatMap(({ words, boxes }) => boxes.map((box) => ({ words, box }))).sort((a, b) => a.box.left - b.box.left);
    all.forEach(({ words, box }, at) => {
      for (let next = at + 1; next < all.length && all[next].box.left < box.right - 1; next += 1) {
        const other = all[next];
        const high = Math.min(box.bottom, other.box.bottom) - Math.max(box.top, other.box.top);
        // Lines of letters have space above and below them.
        if (high > 0.3 * Math.min(box.height, other.box.height)) found.push(`${words} over ${other.words}`);
      }
    });
  }
  return found;
};
