/** A zoom not above the real one, which changes seldom: it scales the letters. */
export const steps = (zoom: number, inOctave = 8) => 2 ** (Math.floor(Math.log2(zoom) * inOctave) / inOctave);
