/** Nanoseconds as seconds: 12.34 */
export const clock = (nanoseconds: number): string => (nanoseconds / 1e9).toFixed(2);
