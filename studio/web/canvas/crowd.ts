/**
 * If a sheet has more nodes than this, only those in and around the window are drawn, unless they are dots.
 */
export const crowd = 600;
