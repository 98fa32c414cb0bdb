/** The number of rows at the beginning of a list for which `holds` is true; it is false for the rest. */
export function count<Row>(rows: ArrayLike<Row>, holds: (row: Row) => boolean): number {
  let [low, high] = [0, rows.length];
  while (low < high) {
    const middle = (low + high) >> 1;
    if (holds(rows[middle]!)) low = middle + 1;
    else high = middle;
  }
  return low;
}

/** A list that is cut at its beginning before it exceeds `most` entries. */
export function bounded<T>(list: T[], most: number): T[] {
  if (list.length >= most) list.splice(0, Math.ceil(most / 4));
  return list;
}
