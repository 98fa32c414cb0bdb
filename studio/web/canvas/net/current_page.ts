import type { Box } from "../../model/net/geometry";
import type { Placed } from "../../model/net/sheets";

/**
 * The current page: the outermost one in the middle of the window that is completely visible, or
 * else the innermost one there.
 */
export function currentPage(visible: Placed[], window: Box): number {
  const [cx, cy] = [window.x + window.width / 2, window.y + window.height / 2];
  let current = 0;
  for (const { page, sheet, x, y, scale } of visible) {
    const [width, height] = [sheet.width * scale, sheet.height * scale];
    if (cx < x || cx > x + width || cy < y || cy > y + height) continue;
    if (page !== 0 && width < 0.3 * window.width && height < 0.3 * window.height) continue;
    current = page;
    const whole =
      x >= window.x && y >= window.y && x + width <= window.x + window.width && y + height <= window.y + window.height;
    if (whole) break;
  }
  return current;
}
