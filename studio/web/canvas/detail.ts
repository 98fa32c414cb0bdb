/** A zoom not above the real one, which changes seldom: it scales the letters. */
export const steps = (zoom: number, inOctave = 8) => 2 ** (Math.floor(Math.log2(zoom) * inOctave) / inOctave);

/**
 * The distance of a sheet, by the pixels of its unit: 2 means that lines and letters would be four times too large,
 * -1 that they are small, -3 that they are dots.
 */
export const nearness = (pixels: number) => Math.min(5, Math.max(-3, Math.floor(Math.log2(pixels / 0.95))));
